// Light groups: alone, with global lights, within another, as operands of a difference.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 6, -10> look_at 0 angle 50 }
light_source { <5, 8, -5> rgb 0.4 }
light_group {
  light_source { <-5, 8, -5> rgb x }
  sphere { <-2, 1, 0>, 1 pigment { rgb 1 } }
}
light_group {
  light_source { <0, 8, -5> rgb y }
  sphere { <0, 1, 0>, 1 pigment { rgb 1 } finish { phong 1 } }
  light_group {
    light_source { <0, 3, -8> rgb z }
    sphere { <2, 1, 0>, 1 pigment { rgb 1 } }
  }
  global_lights on
  rotate 10*y
}
difference {
  light_group {
    light_source { <0, 8, -5> rgb <1, 1, 0> }
    sphere { <4, 1, 0>, 1 pigment { rgb 1 } }
    global_lights off
  }
  light_group {
    light_source { <-5, 2, -5> rgb <0, 1, 1> }
    sphere { <3.6, 1.5, -0.6>, 0.8 pigment { rgb 1 } }
  }
  translate 0.3*y
}
plane { y, 0 pigment { rgb 1 } finish { ambient 0.1 diffuse 0.6 reflection 0.3 } }
union { light_source { <0, 10, 0> rgb 0.2 } box { <-5, 0, -1>, <-4, 2, 1> pigment { rgb 1 } } }

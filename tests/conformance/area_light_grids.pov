// Area lights whose numbers of points are no power of two and one, some of them adaptive.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 9, -9> look_at <0, 0, 0> angle 45 }
plane { y, 0 pigment { rgb 1 } }
union {
  box { <-0.3, 0, -0.3>, <0.3, 1.2, 0.3> translate <-2, 0, 1> }
  sphere { <0, 0.7, 0>, 0.6 translate <2, 0, 1.5> }
  torus { 0.6, 0.15 translate <-0.5, 0.8, -1.5> }
  cylinder { <1.5, 0, -1>, <1.5, 1.5, -1>, 0.1 }
  pigment { rgb <1, 0.7, 0.4> }
}
light_source { <-4, 6, 2> rgb <0.6, 0.3, 0.3> area_light 3*x, 3*z, 4, 4 adaptive 1 circular }
light_source { <4, 6, 3> rgb <0.2, 0.5, 0.3> area_light 2*x, 3*z, 7, 3 }
light_source { <0, 7, -5> rgb <0.2, 0.2, 0.5> area_light 3*x, 2*y, 9, 6 adaptive 0 }

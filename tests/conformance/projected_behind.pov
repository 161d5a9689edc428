// A parallel light that shines through an object lights nothing behind its own plane.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 12, -10> look_at <0, -2, -2> right 4/3*x angle 60 }
light_source {
  <0.668, 5.705, -4.677> rgb <0.9, 0.5, 0.9> parallel point_at <-0.654, 0.648, -0.967>
  projected_through { box { -0.6, 0.6 scale <1, 0.1, 1> translate <0.401, 3.423, -2.806> } }
}
light_source { <20, 0.5, -8> rgb <0.2, 0.4, 0.2> parallel point_at <0, 0, -8> projected_through { sphere { <6, 0, -8>, 2 } } }
plane { y, -2 pigment { rgb <0.4, 0.6, 0.5> } }
sphere { <-1.5, -1, -1>, 0.8 pigment { rgb 0.7 } finish { reflection 0.3 } }

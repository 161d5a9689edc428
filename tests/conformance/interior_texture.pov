// Surfaces that look different from inside: cut open, open, flat, in unions, inside out, clear, in solids of solids.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.8, 0.82, 0.85> }
camera { location <0, 3.4, -8> look_at <0, 0.8, 0> angle 52 right x*4/3 }
light_source { <-5, 9, -8>, rgb 1 }
light_source { <6, 4, -6>, rgb 0.3 }
plane { y, 0 pigment { rgb <0.6, 0.6, 0.55> } interior_texture { pigment { rgb x } } }
#declare Inner = texture { pigment { rgb <0.95, 0.75, 0.2> } finish { phong 0.6 } }
sphere { <-2.7, 1, 0.4>, 1 clipped_by { plane { <0.4, 1, -1>, 0.2 translate <-2.7, 1, 0.4> } } pigment { rgb <0.3, 0.4, 0.9> } interior_texture { Inner } }
cylinder { <-0.6, 0.02, 0.6>, <-0.6, 1.7, 0.6>, 0.75 open pigment { rgb <0.4, 0.75, 0.5> } interior_texture { pigment { checker rgb 1, rgb <0.7, 0.2, 0.3> scale 0.3 } rotate y*20 } }
union {
  sphere { <1.4, 0.8, 0.5>, 0.8 clipped_by { plane { -y, -0.5 } plane { <0.3, 1, -0.6>, 1.1 } } pigment { rgb <0.5, 0.3, 0.8> } }
  cone { <2.9, 0.02, 0.4>, 0.3, <2.9, 1.3, 0.4>, 0.8 open }
  texture { pigment { rgb <0.9, 0.5, 0.4> } } interior_texture { Inner }
}
triangle { <-3.4, 0.05, -1.6>, <-2.4, 0.05, -1.6>, <-2.9, 0.9, -1.3> pigment { rgb <0.2, 0.6, 0.8> } interior_texture { Inner } }
triangle { <-1.2, 0.05, -1.6>, <-2.2, 0.05, -1.6>, <-1.7, 0.9, -1.3> pigment { rgb <0.2, 0.6, 0.8> } interior_texture { Inner } }
mesh {
  triangle { <-0.9, 0.05, -1.6>, <-0.1, 0.05, -1.6>, <-0.5, 0.9, -1.3> }
  triangle { <0.8, 0.05, -1.6>, <0, 0.05, -1.6>, <0.4, 0.9, -1.3> }
  pigment { rgb <0.2, 0.6, 0.8> } interior_texture { Inner }
}
disc { <1.5, 0.5, -1.4>, <0, -0.4, 1>, 0.4 pigment { rgb <0.2, 0.6, 0.8> } interior_texture { Inner } }
disc { <2.5, 0.5, -1.4>, <0, 0.4, -1>, 0.4 pigment { rgb <0.2, 0.6, 0.8> } interior_texture { Inner } }
sphere { <3.5, 0.45, -1.3>, 0.45 pigment { rgb <0.9, 0.9, 0.5> transmit 0.6 } interior_texture { pigment { rgb <0.3, 0.3, 0.9> transmit 0.6 } } }
difference {
  box { <-0.5, 0.01, -3>, <0.5, 0.6, -2.2> }
  sphere { <0, 0.6, -2.9>, 0.35 }
  pigment { rgb <0.7, 0.8, 0.3> } interior_texture { pigment { rgb x } }
}
sphere { <1.2, 0.4, -2.6>, 0.4 inverse clipped_by { box { <0, -1, -5>, <3, 0.4, 0> } } pigment { rgb <0.8, 0.3, 0.5> } interior_texture { Inner } }

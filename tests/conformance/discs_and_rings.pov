// Discs and rings seen from both sides, sheared into ellipses, mirrors among them.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.15, 0.2, 0.3> }
camera { location <0, 3, -8> look_at <0, 1, 0> angle 44 right x*4/3 }
light_source { <5, 9, -6>, rgb 1 }
light_source { <-8, 3, -3>, rgb 0.25 }
plane { y, -0.2 pigment { rgb <0.45, 0.5, 0.45> } }
disc { <-2.4, 1.1, 0>, <0.4, 0.3, -1>, 1.1 pigment { checker rgb <0.9, 0.5, 0.3>, rgb 0.9 scale 0.3 } }
disc { <0, 1.2, 0.5>, <-0.2, 1, -1.4>, 1.2, 0.6 pigment { rgb <0.4, 0.8, 0.5> } finish { specular 0.6 } }
disc { 0, y, 1, 0.35 matrix <1.2, 0.3, 0, 0, 1, 0, 0.5, 0.4, 0.8, 2.4, 0.8, 0> pigment { rgb <0.5, 0.5, 0.95> } finish { phong 0.5 } }
disc { <0.6, 0.5, -2>, <0.2, 0.9, -0.5>, 0.7 pigment { rgb 0.1 } finish { reflection 0.75 } }
disc { <-1.1, 0.3, -2>, <-1, 0.6, -1.5>, 0.5, 0.1 pigment { rgbf <0.9, 0.9, 0.3, 0.6> } }

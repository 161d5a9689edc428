// Working in srgb numbers, with srgb colours: nothing is converted but the words.
#version 3.7;
global_settings { assumed_gamma srgb }
background { srgb <0.35, 0.5, 0.65> }
camera { location <0, 2, -6> look_at <0, 0.8, 0> angle 48 right x*4/3 }
light_source { <5, 7, -7>, srgb <1, 0.95, 0.85> }
plane { y, 0 pigment { hexagon srgb 0.7, srgb <0.5, 0.45, 0.4>, srgb 0.35 scale 0.5 } }
sphere { <-1, 0.9, 0>, 0.9 pigment { srgb <0.8, 0.4, 0.2> } finish { phong 0.6 } }
sphere { <1.1, 0.8, 0.3>, 0.8 pigment { srgbf <0.5, 0.7, 0.9, 0.5> } finish { specular 0.5 } }
box { <-0.3, 0, -1.8>, <0.5, 0.6, -1.1> rotate y*20 pigment { srgbt <0.3, 0.8, 0.4, 0.3> } }

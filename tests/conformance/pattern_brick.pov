// Bricks with default and given size and mortar, on walls, floor, ball and a turned box.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.6, 0.7, 0.8> }
camera { location <-1, 3, -9> look_at <0, 1, 0> angle 46 right x*4/3 }
light_source { <-6, 9, -9>, rgb 1 }
plane { y, 0 pigment { brick rgb 0.75, rgb <0.45, 0.4, 0.38> brick_size <1.2, 0.5, 0.8> mortar 0.06 translate y*0.11 rotate y*12 } }
box { <-5, 0, 4>, <5, 3.2, 4.6> pigment { brick scale 0.11 translate <0.013, 0.021, 0.017> } }
sphere { <-2, 1, 0.5>, 1 pigment { brick rgb 0.9, rgb <0.7, 0.3, 0.2> brick_size <0.6, 0.25, 0.3> mortar 0.04 } finish { phong 0.3 } }
box { <-0.8, 0, -0.7>, <0.8, 1.6, 0.7> pigment { brick rgb <0.2, 0.2, 0.2>, rgb <0.85, 0.75, 0.5> brick_size <0.52, 0.21, 0.31> mortar 0.033 translate 0.017 } rotate <0, 40, 0> translate <0.7, 0, 0.6> }
cylinder { <2.8, 0, 0>, <2.8, 2.2, 0>, 0.6 pigment { brick pigment { rgb 0.3 }, pigment { gradient y color_map { [0 rgb <0.9, 0.5, 0.3>] [1 rgb <0.5, 0.2, 0.2>] } scale 2.2 } scale 0.07 translate 0.011 } }

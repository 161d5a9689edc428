// A gradient that takes the place of a default pigment of bricks keeps the bricks' frequency: none.
#version 3.7;
global_settings { assumed_gamma 1 }
#default { texture { pigment { brick rgb <0, 0.7, 0.1> rgb <0.5, 0.1, 0.9> scale 0.3 } finish { ambient 0.4 } } }
camera { location <0, 0, -4> look_at 0 angle 50 }
light_source { <-4, 6, -8>, rgb 1 }
sphere { -0.8*x, 0.75 texture { pigment { gradient y color_map { [0 rgb x] [1 rgb <1, 1, 0.4>] } } } }
box { <0.1, -0.7, -0.3>, <1.4, 0.7, 0.3> pigment { gradient <1, 1, 0> color_map { [0 rgb 0.1] [1 rgb 0.9] } frequency 2 } }

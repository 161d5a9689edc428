// Pictures made of functions and pigments, and the height of a pigment.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 0.4, -5> look_at 0 angle 50 }
light_source { <-3, 5, -6> rgb 1 }
background { rgb <0.1, 0.2, 0.3> }
#declare Shade = function { pigment { gradient x color_map { [0 rgb <1, 0.2, 0>] [1 rgb <0, 0.7, 0.3>] } } }
box { <-0.47, -0.48, 0>, <0.46, 0.47, 0.2> pigment { image_map { function 12, 9 { pigment { onion color_map {
  [0 rgb <0.9, 0.6, 0.2>] [1 rgbt <0.1, 0.3, 0.8, 0.7>] } scale 0.4 } } once } translate -0.5 } scale 1.4 rotate 20*y translate -1.2*x }
sphere { 0, 0.6 pigment { image_map { function 30, 20 { 7.3*x - 2.4*y } interpolate 2 map_type 1 } } translate <0.2, 0.6, 0> }
plane { y, -1 pigment { function { Shade(x, y, z).hf } scale 0.7 } normal { bump_map { function 16, 16 { sin(9*x)*cos(7*y)/2 + 0.5 } bump_size 2 } rotate 90*x } }
box { -0.4, 0.4 pigment { image_pattern { function 8, 8 { x*y } } color_map { [0 rgb 0.1] [1 rgb <1, 0.9, 0.4>] } translate -0.5 } rotate <20, 30, 0> translate <1.6, 0, -0.5> }

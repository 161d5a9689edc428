// Patterns that depend on the angle of the surface, in pigments, textures, layers and normals.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 4, -9> look_at <0, 0.3, 0> angle 38 right x*image_width/image_height }
light_source { <-30, 60, -40>, rgb 0.9 }
#declare Steps = color_map { [0 rgb <0.9, 0.2, 0.1>] [0.5 rgb <0.2, 0.8, 0.2>] [1 rgb <0.1, 0.3, 0.9>] }
plane { y, -1 pigment { aoi color_map { [0.5 rgb 0.2] [1 rgb 0.9] } } }
sphere { <-2.6, 0, 0>, 1 pigment { slope { <1, 2, 0> } color_map { Steps } } }
sphere { 0, 1 pigment { slope { y, 0.2, 0.7 altitude 2*x, -1, 1 } color_map { Steps } rotate 20*z } translate <-0.2, 0, -0.5> }
sphere { <2.2, 0, 0>, 1 pigment { slope { point_at <3, 4, -2> } color_map { Steps } triangle_wave frequency 3 } }
torus { 0.8, 0.3 texture { slope { y } texture_map { [0.45 pigment { rgb <0.8, 0.7, 0.3> }] [0.55 pigment { aoi color_map { Steps } } normal { leopard 0.6 scale 0.06 }] } } translate <-1.4, 1.3, 2> }
box { -0.6, 0.6 texture { pigment { slope { x } color_map { Steps } } } texture { pigment { rgbt 1 } normal { onion 0.8 scale 0.2 } } rotate <20, 40, 0> translate <1.2, 1.4, 2> }

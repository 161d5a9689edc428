// Normals inside patterns of textures at texture coordinates are turned with the object.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -6> look_at 0 angle 50 right x*4/3 }
light_source { <4, 6, -8> rgb 1 }
light_source { <-6, -2, -5> rgb 0.3 shadowless }
#declare Grooved = texture { pigment { rgb <0.8, 0.6, 0.4> } normal { gradient x 0.7 scale 0.2 } finish { specular 0.4 } }
#declare Ringed = texture { pigment { rgb <0.4, 0.6, 0.8> } normal { onion 0.7 scale 0.15 rotate <20, 30, 40> } }
#declare Mixed = texture { uv_mapping gradient y texture_map { [0.4 Grooved] [0.6 Ringed] } scale 0.5 }
#declare Listed = texture { uv_mapping checker texture { Grooved }, texture { Ringed } scale 0.25 rotate z*20 }
#declare Nested = texture { uv_mapping gradient x texture_map { [0.3 Ringed] [0.5 gradient y texture_map { [0 Grooved] [1 Ringed] } rotate z*30] } }
sphere { 0, 0.95 texture { Mixed } rotate z*90 translate <-2, 1.1, 0> }
sphere { 0, 0.95 texture { Listed rotate z*40 } rotate <30, 20, 10> translate <0, 1.1, 0> }
sphere { 0, 0.95 texture { Nested } scale <1, 0.7, 1.2> rotate y*30 translate <2, 1.1, 0> }
box { -0.7, 0.7 texture { Mixed scale 0.6 } rotate <30, 40, 20> translate <-2, -1.1, 0> }
torus { 0.65, 0.3 texture { Nested } scale <1, 1.6, 1> rotate <60, 0, 30> translate <0, -1.1, 0> }
sor { 5, <0.6, -1.3>, <0.613, -0.7>, <0.432, 0.1>, <0.275, 0.7>, <0.2, 1.2> texture { Listed } rotate <-30, 128, -22> translate <2, -1.1, 0> }
// Bumps that keep their slope are not scaled with the map around them.
disc { <0, 0, 2>, z, 9 texture { gradient y texture_map { [0 pigment { rgb 0.5 } normal { leopard 0.8 scale 0.3 no_bump_scale }] [1 pigment { rgb <0.3, 0.5, 0.4> } normal { leopard 0.8 scale 0.3 no_bump_scale }] } scale 2 } }

// Normals at texture coordinates: those of a whole texture are turned with the object, those with a word of their own with their pattern only.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -6> look_at 0 angle 50 right x*4/3 }
light_source { <4, 6, -8> rgb 1 }
light_source { <-6, -2, -5> rgb 0.3 shadowless }
#declare Whole = texture { uv_mapping pigment { rgb <0.8, 0.6, 0.4> } normal { gradient x 0.7 scale 0.2 } finish { specular 0.4 } }
#declare Own = texture { pigment { rgb <0.4, 0.6, 0.8> } normal { uv_mapping gradient x 0.7 scale 0.2 } finish { specular 0.4 } }
sphere { 0, 0.95 texture { Whole } rotate z*90 translate <-2, 1.1, 0> }
sphere { 0, 0.95 texture { Own } rotate z*90 translate <0, 1.1, 0> }
sphere { 0, 0.95 texture { Whole rotate x*60 } rotate y*30 translate <2, 1.1, 0> }
box { -0.7, 0.7 texture { Whole } rotate <30, 40, 20> translate <-2, -1.1, 0> }
torus { 0.65, 0.3 texture { uv_mapping pigment { rgb 0.7 } normal { onion 0.5 scale 0.15 rotate z*50 } } scale <1, 1.6, 1> rotate <60, 0, 30> translate <0, -1.1, 0> }
sor { 5, <0.6, -1.3>, <0.613, -0.7>, <0.432, 0.1>, <0.275, 0.7>, <0.2, 1.2> texture { Whole } rotate <-30, 128, -22> translate <2, -1.1, 0> }
#declare Steep = texture { uv_mapping pigment { rgb <0.5, 0.7, 0.4> } normal { leopard 0.4 scale <0.02, 0.01, 0.03> no_bump_scale } }
sphere { 0, 0.5 texture { Steep } rotate z*20 scale <0.9, 1.2, 0.8> translate <-1, 0, -1> }
sphere { 0, 0.5 pigment { rgb <0.7, 0.5, 0.7> } normal { uv_mapping gradient <1, 2, 0> 0.4 rotate 30*z scale <0.3, 0.2, 0.3> } scale <0.7, 1, 0.9> translate <0, -0.1, -1.2> }
sphere { 0, 0.5 pigment { rgb <0.7, 0.7, 0.4> } normal { uv_mapping leopard 0.2 rotate 30*z scale <0.03, 0.02, 0.03> no_bump_scale } scale <0.7, 1, 0.9> translate <1, 0, -1> }

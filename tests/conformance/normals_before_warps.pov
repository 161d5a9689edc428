// Perturbations of normals are turned and scaled by transformations before a warp, too; waves bend values without a frequency.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -6> look_at 0 angle 50 right x*4/3 }
light_source { <-4, 6, -8> rgb 1 }
light_source { <6, -2, -5> rgb 0.3 shadowless }
#declare Grooved = texture { pigment { rgb <0.8, 0.7, 0.5> } normal { gradient x 0.6 sine_wave scale 0.2 } }
#macro Ball(X, Y) translate <X, Y, 0> #end
sphere { <0.1, 0.05, 0>, 0.9 pigment { rgb <0.8, 0.6, 0.4> } normal { gradient x 0.6 sine_wave scale 0.25 rotate <20, 30, 40> warp { repeat 10*y offset <0.1, 0, 0> } } Ball(-2.1, 1.05) }
sphere { <0.1, 0.05, 0>, 0.9 pigment { rgb <0.6, 0.8, 0.4> } normal { onion 0.6 sine_wave scale <0.1, 0.3, 0.2> warp { repeat 0.7*x flip x } rotate <30, 10, 50> no_bump_scale } scale <1, 0.8, 1> Ball(0, 1.05) }
sphere { <0.1, 0.05, 0>, 0.9 pigment { rgb <0.4, 0.6, 0.8> } normal { gradient y 0.5 sine_wave scale 0.2 rotate 50*z warp { cylindrical } scale <1, 2, 0.7> } Ball(2.1, 1.05) }
box { <-0.75, -0.7, -0.6>, <0.7, 0.75, 0.65> rotate <30, 40, 10> texture { gradient y texture_map { [0 Grooved] [1 Grooved] } rotate <20, 30, 40> warp { repeat 10*y offset <0.1, 0, 0> } rotate 60*x } Ball(-2.1, -1.05) }
sphere { <0.1, 0.05, 0>, 0.9 pigment { quilted control0 0.5 control1 0.9 color_map { [0 rgb <0.9, 0.3, 0.2>] [1 rgb <1, 0.9, 0.6>] } triangle_wave scale 0.4 } Ball(0, -1.05) }
sphere { <0.1, 0.05, 0>, 0.9 pigment { onion color_map { [0 rgb <0.2, 0.3, 0.7>] [1 rgb <0.9, 0.9, 1>] } frequency 0 cubic_wave phase 0.3 scale 0.3 } Ball(2.1, -1.05) }

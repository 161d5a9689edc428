// Normals of patterns that are formulas, with slope maps, normal maps and scaling.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -10> right 4/3*x angle 45 }
light_source { <-10, 15, -20> rgb 1 }
light_source { <20, 5, -10> rgb <0.3, 0.3, 0.4> }
#declare White = pigment { rgb 0.8 }
#macro Ball(X, Y, N) sphere { 0, 0.9 pigment { White } normal { N } finish { specular 0.4 reflection 0.1 } translate <X, Y, 0> } #end
Ball(-3, 2, normal { onion 2 sine_wave scale 0.2 })
Ball(-1, 2, normal { leopard 3 scale 0.1 })
Ball(1, 2, normal { gradient y 1 triangle_wave scale 0.3 })
Ball(3, 2, normal { radial 1 sine_wave frequency 12 })
Ball(-3, 0, normal { gradient x slope_map { [0 <0.5, 1>] [0.25 <1, 0>] [0.5 <0.5, -1>] [0.75 <0, 0>] [1 <0.5, 1>] } bump_size 3 scale 0.4 })
Ball(-1, 0, normal { spiral1 4 slope_map { [0 <0, 1>] [0.5 <1, 1>] [0.5 <1, -1>] [1 <0, -1>] } scale 0.4 })
Ball(1, 0, normal { planar 1 normal_map { [0 onion 2 sine_wave scale 0.2] [0.3 onion 2 sine_wave scale 0.2] [0.6 gradient x 2 sine_wave scale 0.2] } })
Ball(3, 0, normal { average normal_map { [1 gradient x 2 sine_wave scale 0.2] [2 gradient y 2 sine_wave scale 0.3] } })
Ball(-3, -2, normal { onion 1 sine_wave scale <0.2, 0.1, 0.4> rotate 30*z })
Ball(-1, -2, normal { gradient x 1 sine_wave scale 0.2 no_bump_scale })
Ball(1, -2, normal { function { sin(20*x)*sin(20*y)/2 } 2 accuracy 0.001 })
Ball(3, -2, normal { boxed 2 scale 0.9 })

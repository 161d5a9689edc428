// Height fields of functions: flat and smooth, with a water level, scaled and turned.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.4, -4> look_at <0, 0.2, 0> angle 40 right x*4/3 }
light_source { <-3, 5, -4>, rgb 1 }
light_source { <4, 3, -2>, rgb 0.4 }
background { rgb <0.3, 0.5, 0.8> }
#declare Waves = function { 0.5 + 0.35*sin(9*x)*cos(7*y) }
#default { texture { pigment { rgb <0.8, 0.6, 0.4> } finish { ambient 0.1 diffuse 0.8 } } }
height_field { function 200, 150 { Waves(x, y, 0) } translate <-0.5, 0, -0.5> scale <1.3, 0.6, 1.3> rotate y*30 translate <-0.8, 0, 0.6> }
height_field { function 120, 160 { Waves(x, y, 0) } smooth translate <-0.5, 0, -0.5> scale <1.3, 0.6, 1.3> rotate <-10, 20, 5> translate <0.8, 0, 0.6> }
height_field { function 200, 200 { Waves(x, y, 0) } water_level 0.45 translate <-0.5, 0, -0.5> scale <1.2, 0.6, 1.2> translate <-0.7, 0, -0.8> }
height_field { function 5, 4 { x*y } translate <-0.5, 0, -0.5> scale <1.2, 0.6, 1.2> translate <0.7, 0, -0.8> }

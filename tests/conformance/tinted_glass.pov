// Light lost on the way through: fading interiors by three laws, coloured, with and without refraction.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }
background { rgb 0.95 }
camera { location <0, 2.6, -7.5> look_at <0, 0.8, 0> angle 52 right x*4/3 }
light_source { <-3, 9, -5>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb 0.6 scale 0.8 } finish { ambient 0.2 diffuse 0.7 } }
#declare Film = texture { pigment { rgbf 1 } finish { ambient 0 diffuse 0 specular 0.6 roughness 0.01 } }
sphere { <-2.4, 0.9, 0>, 0.85 texture { Film } interior { ior 1.4 fade_distance 0.6 fade_power 1001 fade_color rgb <0.8, 0.3, 0.2> } }
box { <-1, 0.02, -0.5>, <0.3, 1.4, 0.5> rotate y*20 texture { Film } interior { ior 1.3 fade_distance 0.8 fade_power 2 fade_color rgb <0.2, 0.7, 0.3> } }
cylinder { <1.3, 0.02, 0.2>, <1.3, 1.5, 0.2>, 0.5 texture { Film } interior { fade_distance 0.5 fade_power 1 } }
cone { <2.7, 0.02, 0>, 0.7, <2.7, 1.7, 0>, 0.05 texture { Film } interior { ior 1.5 fade_distance 0.4 fade_power 1 fade_color rgb <0.3, 0.4, 0.9> } }
sphere { <0.3, 0.4, -1.9>, 0.38 texture { Film } interior { ior 1.2 fade_distance 0.3 fade_power 1000 fade_color rgb <0.9, 0.8, 0.1> } }

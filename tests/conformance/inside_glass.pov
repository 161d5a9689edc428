// The camera sits inside a ball of glass that fades, looking out at a room.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }
background { rgb <0.9, 0.9, 1> }
camera { location <0, 1.5, -4> look_at <0, 1, 0> angle 60 right x*4/3 }
light_source { <3, 7, -2>, rgb 1 }
sphere { <0.2, 1.4, -3.9>, 1.2 pigment { rgbf <1, 1, 1, 1> } finish { ambient 0 diffuse 0 } interior { ior 1.2 fade_distance 2 fade_power 1 fade_color rgb <0.6, 0.8, 0.9> } }
plane { y, 0 pigment { checker rgb <0.9, 0.8, 0.6>, rgb <0.4, 0.3, 0.3> scale 0.7 } }
sphere { <-1.5, 0.9, 2>, 0.9 pigment { rgb <0.8, 0.3, 0.3> } finish { phong 0.6 } }
cylinder { <1.4, 0, 2>, <1.4, 2, 2.4>, 0.5 pigment { gradient y color_map { [0 rgb <0.2, 0.4, 0.7>] [1 rgb 0.9] } scale 0.7 } }
box { <-0.4, 0.01, 0.2>, <0.4, 0.6, 0.9> rotate y*20 pigment { rgb <0.4, 0.7, 0.4> } }

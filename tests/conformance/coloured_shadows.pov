// Filtering and transmitting solids colour the light behind them; opaque, clear and flagged casters.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 15 }
background { rgb 0.9 }
camera { location <0, 5, -8> look_at <0, 0.4, 0.3> angle 45 right x*4/3 }
light_source { <-3, 8, -3>, rgb 0.8 }
light_source { <6, 5, 2>, rgb <0.35, 0.3, 0.25> }
plane { y, 0 pigment { rgb 0.9 } finish { ambient 0.1 diffuse 0.7 } }
sphere { <-2.6, 0.8, 0>, 0.7 pigment { rgbf <1, 0.3, 0.2, 0.8> } finish { specular 0.4 } }
box { <-1.4, 0.3, -0.6>, <-0.2, 1.1, 0.6> rotate y*15 pigment { rgbf <0.3, 0.9, 0.4, 0.7> } }
cylinder { <0.9, 0.3, 0>, <0.9, 1.5, 0.3>, 0.5 pigment { rgbft <0.3, 0.5, 1, 0.5, 0.3> } }
cone { <2.4, 0.2, 0>, 0.8, <2.4, 1.6, 0>, 0.1 open pigment { rgbt <0.9, 0.6, 0.2, 0.6> } }
disc { <0, 2.2, 1.6>, <0.2, 1, 0>, 0.8, 0.4 pigment { gradient x color_map { [0 rgbf <1, 0, 0, 0.9>] [1 rgbf <0, 0, 1, 0.9>] } scale 1.1 } }
sphere { <-0.8, 0.5, -1.9>, 0.5 pigment { rgb <0.7, 0.7, 0.3> } no_shadow }

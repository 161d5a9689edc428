// Version 3.6 with assumed_gamma 2.2: filter weighs the colour, gamma is corrected.
#version 3.6;
global_settings { assumed_gamma 2.2 max_trace_level 10 }
background { rgb <0.3, 0.3, 0.5> }
camera { location <0, 2.5, -6> look_at <0, 0.7, 0> angle 50 right x*4/3 }
light_source { <3, 8, -6> rgb <1, 1, 0.95> }
light_source { <-7, 4, -5> rgb <0.2, 0.25, 0.4> shadowless }
plane { y, 0 pigment { checker rgb 0.7, rgb 0.4 } }
sphere { <-1.2, 0.9, 0>, 0.9 pigment { rgbf <0.4, 0.8, 0.5, 0.6> } finish { diffuse 0.5 specular 0.5 } }
sphere { <1, 0.7, -0.5>, 0.7 pigment { rgbft <0.9, 0.3, 0.3, 0.3, 0.4> } finish { phong 0.8 reflection 0.15 } }
cone { <0, 0.01, 1.4>, 0.9, <0, 2, 1.4>, 0.2 pigment { rgb <0.8, 0.6, 0.3> } }

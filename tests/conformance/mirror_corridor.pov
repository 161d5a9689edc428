// Two mirrors face to face: the limit of recursion, adc_bailout and tinted reflections show.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 7 adc_bailout 0.02 }
background { rgb <0.8, 0.4, 0.6> }
camera { location <0.7, 1.6, -1.2> look_at <-0.2, 0.9, 3> angle 75 right x*4/3 }
light_source { <0.5, 2.7, 0.5>, rgb 0.8 }
plane { y, 0 pigment { checker rgb <0.8, 0.8, 0.7>, rgb <0.4, 0.3, 0.3> scale 0.5 } }
plane { -y, -3 pigment { rgb 0.8 } }
plane { z, 4 pigment { rgb 0.1 } finish { ambient 0 diffuse 0.2 reflection rgb <0.8, 0.9, 0.85> } }
plane { -z, 2 pigment { rgb 0.1 } finish { ambient 0 diffuse 0.2 reflection 0.9 } }
plane { x, -2 pigment { gradient y color_map { [0 rgb <0.5, 0.3, 0.2>] [1 rgb <0.8, 0.7, 0.5>] } scale 3 } }
plane { -x, -2 pigment { brick rgb 0.7, rgb <0.6, 0.35, 0.3> scale 0.1 translate 0.013 } }
sphere { <-0.5, 0.5, 2>, 0.5 pigment { rgb <0.3, 0.5, 0.8> } finish { phong 0.7 reflection 0.2 } }
cylinder { <0.9, 0, 2.6>, <0.9, 1.3, 2.6>, 0.2 pigment { rgb <0.8, 0.6, 0.3> } }

// Gradients: maps with steps, every wave form, frequency and phase, oblique directions.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb 0.15 }
camera { location <0, 3, -9> look_at <0, 1.1, 0> angle 56 right x*4/3 }
light_source { <-6, 10, -9>, rgb 1 }
#declare Map = color_map { [0 rgb <0.1, 0.2, 0.5>] [0.3 rgb <0.2, 0.6, 0.9>] [0.3 rgb <0.95, 0.9, 0.6>] [0.7 rgb <0.9, 0.4, 0.2>] [1 rgb <0.4, 0.1, 0.1>] }
plane { y, 0 pigment { gradient <1, 0, 0.6> color_map { Map } scale 1.7 } }
plane { z, 5 pigment { gradient y triangle_wave color_map { [0.2 rgb 0.25] [0.8 rgb 0.8] } frequency 1.3 phase 0.2 } }
sphere { <-3, 1, 0>, 1 pigment { gradient y sine_wave color_map { Map } scale 0.6 rotate z*30 } }
sphere { <-1, 1, 0.4>, 1 pigment { gradient x cubic_wave color_map { Map } frequency 2.5 } }
sphere { <1, 1, 0.4>, 1 pigment { gradient z scallop_wave color_map { Map } phase 0.35 } }
sphere { <3, 1, 0>, 1 pigment { gradient <1, 2, 3> poly_wave 2.5 color_map { Map } scale 0.45 } finish { phong 0.5 } }
box { <-2, 0.02, -2.6>, <2, 0.5, -2> pigment { gradient x pigment_map { [0 rgb <0.2, 0.7, 0.3>] [0.4 checker rgb 1, rgb 0 scale 0.1] [0.6 rgb <0.8, 0.3, 0.6>] [1 rgb 1] } scale 1.3 } }
cylinder { <-4.2, 0, 2>, <-4.2, 3, 2>, 0.5 texture { gradient y texture_map { [0.3 pigment { rgb <0.8, 0.6, 0.2> } finish { specular 0.8 metallic }] [0.6 pigment { rgb 0.1 } finish { reflection 0.4 }] } scale 1.1 } }
cylinder { <4.2, 0, 2>, <4.2, 3, 2>, 0.5 pigment { gradient -y ramp_wave color_map { [0 rgb x] [0.5 rgb y] [1 rgb z] } } }

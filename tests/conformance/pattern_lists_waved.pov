// Lists whose numbers a frequency, a phase or a wave changes: blends of two entries, or the same entry everywhere.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.4, -5> look_at <0, 0.7, 0> }
light_source { <6, 9, -8>, 1 }
background { rgb <0.5, 0.6, 0.7> }
plane { y, 0 pigment { hexagon rgb <0.9, 0.8, 0.6>, rgb <0.5, 0.2, 0.2>, rgb <0.1, 0.3, 0.5> frequency 0.45 phase 0.2 scale 0.5 } }
plane { z, 5 pigment { brick rgb 0.9, rgb <0.7, 0.2, 0.1> brick_size <1.2, 0.5, 0.8> mortar 0.08 frequency 0.4 phase 0.3 triangle_wave } }
sphere { <-1.8, 1, 0>, 1 pigment { checker rgb <0.9, 0.9, 0.2>, rgb <0.1, 0.4, 0.7> phase 0.6 scale 0.4 } finish { specular 0.4 } }
sphere { <0.4, 1, 0.4>, 1 pigment { checker rgb <0.9, 0.9, 0.2>, rgb <0.1, 0.4, 0.7> frequency 0.6 scale 0.4 } finish { specular 0.4 } }
box { <1.7, 0, -0.8>, <3, 1.6, 0.5> pigment { hexagon pigment { rgb <0.2, 0.6, 0.3> }, pigment { rgb 0.9 }, pigment { rgb <0.8, 0.4, 0.1> } frequency -0.4 sine_wave scale 0.3 rotate 30*x } rotate -15*y }
cylinder { <-0.8, 0, -1.5>, <-0.8, 0.7, -1.5>, 0.4 pigment { checker rgb <0.7, 0.3, 0.6>, rgb 1 triangle_wave scale 0.2 } }

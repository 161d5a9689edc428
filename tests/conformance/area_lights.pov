// Soft shadows of a square light, of a round one, and of one that turns to what it lights.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 6, -9> look_at 0 right 4/3*x angle 45 }
light_source { <-6, 9, -6> rgb <0.6, 0.5, 0.4> area_light 3*x, 3*z, 9, 9 }
light_source { <6, 8, -3> rgb <0.3, 0.4, 0.6> area_light 2*x, 2*z, 5, 5 circular orient }
plane { y, -1 pigment { rgb 0.9 } }
sphere { <-1.5, 0.5, 0>, 0.8 pigment { rgb <0.9, 0.3, 0.2> } finish { phong 1 } }
box { <0.8, -1, -0.5>, <1.8, 1, 0.5> pigment { rgbt <0.3, 0.8, 0.4, 0.5> } }
cylinder { <0, -1, 2>, <0, 2, 2>, 0.2 pigment { rgb 0.7 } }

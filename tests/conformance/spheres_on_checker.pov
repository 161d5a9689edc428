// Three spheres on a checkered floor under one lamp: diffuse light, highlights, hard shadows.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.55, 0.7, 0.9> }
camera { location <0, 2.4, -6> look_at <0, 0.7, 0> angle 48 right x*4/3 }
light_source { <6, 9, -7>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb <0.2, 0.25, 0.35> } }
sphere { <-1.9, 0.8, 0.4>, 0.8 pigment { rgb <0.9, 0.3, 0.2> } finish { phong 0.7 phong_size 25 } }
sphere { <0, 1.1, 1.2>, 1.1 pigment { rgb <0.3, 0.7, 0.35> } finish { specular 0.8 roughness 0.02 } }
sphere { <1.9, 0.7, -0.2>, 0.7 pigment { rgb <0.25, 0.4, 0.9> } finish { ambient 0.2 diffuse 0.8 brilliance 2 } }

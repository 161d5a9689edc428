// Surfaces, flat ones too, cut away without a cap by boxes, balls, planes and turned cylinders; bounds that bind.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.85, 0.8, 0.75> }
camera { location <0, 3.2, -8> look_at <0, 0.9, 0> angle 52 right x*4/3 }
light_source { <-5, 9, -8>, rgb 1 }
light_source { <6, 4, -6>, rgb 0.3 }
plane { y, 0 pigment { rgb <0.55, 0.6, 0.65> } }
sphere { <-2.6, 1, 0>, 1 clipped_by { plane { <0.5, 1, -0.6>, 0.3 translate <-2.6, 1, 0> } } pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.5 } }
cylinder { <-0.6, 0.02, 0>, <-0.6, 1.9, 0>, 0.7 open clipped_by { sphere { <-0.6, 1.1, -0.3>, 0.95 } } pigment { rgb <0.4, 0.75, 0.5> } finish { specular 0.5 } }
cone { <1.2, 0.02, 0>, 0.9, <1.2, 1.8, 0>, 0.3 clipped_by { box { <-1, 0, -1>, <1, 2, 1> rotate y*30 translate <1.6, -0.2, 0.6> } } pigment { rgb <0.4, 0.5, 0.95> } }
cylinder { <2.7, 0.02, 0>, <2.7, 1.2, 0>, 0.7 clipped_by { sphere { <2.7, 0.7, -0.2>, 0.75 } } pigment { rgb <0.9, 0.8, 0.3> } bounded_by { clipped_by } }
sphere { <0.4, 0.6, -2>, 0.6 clipped_by { cylinder { <0.4, -1, -2>, <0.4, 3, -2.1>, 0.4 inverse } } pigment { checker rgb 1, rgb <0.6, 0.2, 0.4> scale 0.3 } }
union { sphere { 0, 0.6 } cylinder { -y, y, 0.3 } clipped_by { box { <-1, -1, -0.2>, <1, 0.8, 1> } } rotate <-20, 30, 0> translate <-1.6, 0.9, -1.9> pigment { rgb <0.7, 0.5, 0.9> } }
box { <-0.5, 0, -0.5>, <0.5, 0.9, 0.5> clipped_by { plane { <1, 1.2, -0.8>, 0.62 } } rotate y*25 translate <2.2, 0.05, -2.3> pigment { rgb <0.4, 0.8, 0.85> } finish { phong 0.4 } }
plane { z, 3 clipped_by { cylinder { <0, 2.4, 0>, <0, 2.4, 6>, 1.3 } } pigment { checker rgb <0.8, 0.3, 0.3>, rgb <0.95, 0.9, 0.7> scale 0.5 } }

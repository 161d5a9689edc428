// no_shadow, no_image, no_reflection, hollow, inverse and their effects in a mirror.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.5, 0.6, 0.75> }
camera { location <0, 2.6, -7> look_at <0, 0.9, 0.5> angle 48 right x*4/3 }
light_source { <-4, 9, -6>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.8, rgb 0.55 } }
box { <-3, 0.1, 3>, <3, 2.8, 3.1> pigment { rgb 0.05 } finish { ambient 0 diffuse 0.1 reflection 0.85 } }
sphere { <-2, 0.7, 0>, 0.7 no_shadow pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.6 } }
sphere { <0, 0.7, 0.4>, 0.7 no_image pigment { rgb <0.3, 0.8, 0.4> } }
sphere { <2, 0.7, 0>, 0.7 no_reflection pigment { rgb <0.3, 0.4, 0.9> } finish { specular 0.6 } }
box { <-0.4, 0, -1.6>, <0.4, 0.6, -1> rotate y*25 inverse pigment { rgb <0.8, 0.7, 0.3> } }
sphere { <1.2, 0.4, -1.5>, 0.4 hollow pigment { rgbf <0.9, 0.9, 1, 0.8> } finish { specular 0.5 reflection 0.1 } interior { ior 1.3 } }

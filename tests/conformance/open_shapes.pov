// Open cylinders and cones from inside and outside, and shapes that pierce each other.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.3, 0.3, 0.4> }
camera { location <0, 4, -8> look_at <0, 0.8, 0> angle 44 right x*4/3 }
light_source { <-5, 9, -6>, rgb 1 }
light_source { <0, 3, -9>, rgb 0.3 shadowless }
plane { y, -0.1 pigment { rgb 0.6 } }
cylinder { <-2.6, 0, 0>, <-2.3, 1.6, 0.3>, 0.7 open pigment { rgb <0.9, 0.6, 0.3> } finish { phong 0.5 } }
cone { <-0.7, 0, 0.3>, 0.9, <-0.7, 1.4, 0>, 0.5 open pigment { checker rgb 0.9, rgb <0.3, 0.5, 0.3> scale 0.25 translate 0.031 } }
cone { <1, 1.7, 0>, 0.8, <1, 0, 0>, 0 open pigment { rgb <0.5, 0.5, 0.9> } finish { specular 0.6 roughness 0.02 } }
sphere { <1, 1.3, 0>, 0.45 pigment { rgb <0.9, 0.8, 0.4> } }
cylinder { <1.8, 0.4, -0.8>, <3.4, 1.2, 0.6>, 0.35 pigment { rgb <0.8, 0.4, 0.5> } }
cylinder { <1.9, 1.2, 0.5>, <3.3, 0.3, -0.7>, 0.25 pigment { rgb <0.4, 0.7, 0.7> } }
box { <2.2, 0.1, -0.4>, <3, 1.4, 0.3> rotate y*10 pigment { rgb <0.7, 0.7, 0.5> } }

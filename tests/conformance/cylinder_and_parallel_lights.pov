// Light in tubes and in parallel sheets; a lamp without highlights or shadows.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -9> look_at <0, 0.5, 0> angle 45 right x*4/3 }
light_source { <-4, 6, -3>, rgb <1, 0.6, 0.5> cylinder point_at <-2, 0, 0.5> radius 0.9 falloff 1.6 }
light_source { <3, 6, -2>, rgb <0.5, 0.7, 1> cylinder point_at <2.4, 0, 0> radius 0.4 falloff 1.8 tightness 2 }
light_source { <10, 12, -10>, rgb 0.45 parallel point_at <0, 0, 0> }
light_source { <0, 20, 0>, rgb 0.1 shadowless }
plane { y, 0 pigment { rgb 0.85 } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-2.1, 0.7, 0.4>, 0.7 pigment { rgb <0.9, 0.9, 0.8> } finish { specular 0.5 roughness 0.02 } }
cone { <0.2, 0, 1>, 0.8, <0.2, 2, 1>, 0.1 pigment { rgb <0.8, 0.7, 0.9> } finish { phong 0.5 } }
box { <1.8, 0, -0.6>, <3, 0.9, 0.5> rotate y*15 pigment { rgb <0.7, 0.9, 0.8> } }
cylinder { <0.6, 0.3, -2>, <2.2, 0.3, -2.6>, 0.3 pigment { rgb <0.9, 0.7, 0.5> } finish { phong 0.4 } }

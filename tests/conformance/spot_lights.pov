// Spot lamps with soft and hard rims, tightness, and their shadows.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -9> look_at <0, 0.4, 0.5> angle 46 right x*4/3 }
light_source { <-3, 5, -1>, rgb <1, 0.5, 0.4> spotlight point_at <-2.4, 0, 0.5> radius 12 falloff 20 }
light_source { <0, 6, 2>, rgb <0.5, 1, 0.5> spotlight point_at <0.3, 0, 0> radius 15 falloff 15 }
light_source { <4, 4, -3>, rgb <0.5, 0.6, 1> spotlight point_at <2, 0, 1> radius 5 falloff 28 tightness 8 }
light_source { <-6, 3, -6>, rgb 0.35 spotlight point_at <0, 1, 3> radius 25 falloff 40 tightness 1 }
plane { y, 0 pigment { rgb 0.9 } finish { ambient 0.05 diffuse 0.8 } }
plane { z, 4.5 pigment { rgb <0.9, 0.85, 0.8> } finish { ambient 0.05 } }
sphere { <-2.4, 0.6, 0.6>, 0.6 pigment { rgb 1 } finish { specular 0.5 } }
cylinder { <0.2, 0, 0.2>, <0.5, 1.3, 0>, 0.35 pigment { rgb 1 } finish { phong 0.5 } }
cone { <2.1, 0, 0.8>, 0.8, <2.1, 1.5, 0.8>, 0 pigment { rgb 1 } }

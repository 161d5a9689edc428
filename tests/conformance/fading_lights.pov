// Lamps that fade with distance by three laws, and one that shines stronger than its colour near by.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 6, -8> look_at <0, 0, 0.5> angle 48 right x*4/3 }
light_source { <-3, 1.2, 0>, rgb <1, 0.6, 0.3> fade_distance 1.5 fade_power 2 }
light_source { <0, 2, 2>, rgb <0.4, 1, 0.6> fade_distance 2 fade_power 1 }
light_source { <3, 1, -0.5>, rgb <0.4, 0.5, 1> fade_distance 1 fade_power 3 }
light_source { <0, 8, -4>, rgb 0.6 fade_distance 4 fade_power 0.5 spotlight point_at <0, 0, -1> radius 5 falloff 12 }
plane { y, 0 pigment { checker rgb 0.9, rgb 0.6 } finish { ambient 0.02 diffuse 0.9 } }
sphere { <-1.6, 0.5, 0.4>, 0.5 pigment { rgb 1 } finish { specular 0.6 roughness 0.03 } }
sphere { <1.6, 0.5, 0.6>, 0.5 pigment { rgb 1 } finish { phong 0.8 phong_size 60 } }
box { <-0.4, 0, -1>, <0.4, 0.8, -0.2> rotate y*30 pigment { rgb 1 } }
cylinder { <-3, 0.01, 0>, <-3, 0.7, 0>, 0.15 pigment { rgb 0.7 } }

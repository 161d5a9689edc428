// Area lights that light surfaces from each of their points.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 6, -10> look_at 0 angle 50 }
light_source { <0, 3, 0> rgb 0.8 area_light 4*x, 4*z, 3, 3 area_illumination on }
light_source { <5, 4, -4> rgb <0.3, 0.4, 0.6> area_light 2*x, 2*y, 2, 2 area_illumination spotlight point_at 0 radius 20 falloff 40 fade_distance 5 fade_power 2 }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.7 phong 0.3 phong_size 20 specular 0.3 roughness 0.02 } }
sphere { <1, 1, 0>, 0.7 pigment { rgb <1, 0.8, 0.6> } finish { ambient 0 diffuse 0.6 phong 0.9 } }
box { <-2, 0, -1>, <-1, 1.5, 1> pigment { rgb <1, 0.8, 0.6> } finish { ambient 0 diffuse 1 brilliance 2 } }

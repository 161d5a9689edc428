// Lights of which two kinds are told, where the last one counts; parallel light that fades, in front of its plane and behind it; a likeness of caustics.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -9> look_at <0, 0.3, 0.5> angle 50 right x*4/3 }
light_source { <-4, 5, -2>, rgb <0.5, 0.2, 0.1> spotlight point_at <-2.5, 0, 0> radius 8 falloff 14 shadowless }
light_source { <-2, 6, -1>, rgb <0.1, 0.4, 0.2> shadowless spotlight point_at <-1.5, 0, 0> radius 10 falloff 16 }
light_source { <2, 6, -1>, rgb <0.1, 0.2, 0.5> cylinder point_at <2, 0, 1> radius 1 falloff 1.5 shadowless fade_distance 6 fade_power 2 }
light_source { <3, 6, -2>, rgb <0.5, 0.5, 0.2> shadowless cylinder point_at <2.6, 0, -0.5> radius 0.9 falloff 1.4 }
light_source { <0, 3, 4>, rgb <0.12, 0.1, 0.16> parallel point_at <0, 2, 5> fade_distance 3 fade_power 1 }
light_source { <0, 7, 6>, rgb <0.2, 0.1, 0.1> parallel point_at <0, 2, 8> fade_distance 4 fade_power 1.5 }
light_source { <1, 8, -6>, rgb 0.35 }
plane { y, 0 pigment { rgb <0.8, 0.8, 0.75> } finish { ambient 0.12 specular 0.2 } }
sphere { <-2.6, 0.7, 0>, 0.7 pigment { rgb <0.9, 0.7, 0.6> } finish { phong 0.6 } }
cone { <-1, 0, 0.6>, 0.6, <-1, 1.5, 0.6>, 0 pigment { rgb <0.6, 0.9, 0.7> } finish { specular 0.5 } }
sphere { <0.6, 0.9, -0.6>, 0.7 pigment { rgbf <0.9, 0.95, 1, 0.9> } finish { ambient 0 diffuse 0.1 specular 0.6 } interior { ior 1.4 caustics 0.3 } }
box { <1.8, 0.5, -0.2>, <2.9, 1, 0.9> rotate -y*20 pigment { rgbf <1, 0.8, 0.6, 0.8> } finish { ambient 0 diffuse 0.2 } interior { caustics 1.2 } }
smooth_triangle { <-0.4, 0.1, -2>, <0.2, 0.3, -1>, <0.6, 0.1, -2.2>, <-0.3, 0.2, -1>, <0, 1, -1.7>, <0, 0.8, -1> pigment { rgb <0.9, 0.9, 0.4> } finish { phong 0.5 } }
smooth_triangle { <-3.4, 0.1, -2>, <0.2, 0.3, -1>, <-2.6, 0.1, -2.2>, <-0.3, 0.2, 1>, <-3, 1, -1.7>, <0, 0.8, -1> pigment { rgb <0.9, 0.3, 0.4> } }

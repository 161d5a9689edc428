// The exponent of a reflection and bumps change the colours of thin films. A parallel spotlight is dark behind its plane.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -6> look_at <0, 0, 0> angle 50 right x*4/3 }
light_source { <-4, 6, -8> rgb 0.6 area_light 4*x, 4*z, 2, 3 area_illumination on }
light_source { <2, 1.5, 4> rgb <1, 0.8, 0.5> spotlight parallel point_at <0, 0, 0> radius 20 falloff 40 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.9, 0.6, 0.3>] [1 rgb <0.2, 0.4, 0.9>] } } }
plane { y, -1 pigment { rgb 0.3 } finish { diffuse 0.5 reflection { 0.6 exponent 1.5 } irid { 0.5 thickness 0.6 } } }
sphere { <-1.2, 0, 0>, 0.9 pigment { rgb <0.2, 0.2, 0.4> } finish { reflection { 0.2, 0.8 exponent 0.6 } irid { 0.4 thickness 1.1 } } }
sphere { <1.2, 0, 0.5>, 0.9 pigment { rgb <0.4, 0.2, 0.2> } normal { quilted 0.9 scale 0.3 } finish { reflection { 0.7 exponent 2 metallic 0.5 } irid { 0.8 thickness 0.4 } } }

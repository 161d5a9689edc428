// A second reflection keeps the falloff, exponent, metallic and fresnel of the one before.
#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0.2 reflection { rgb <0.3, 0.1, 0.05>, rgb <0.7, 0.5, 0.7> falloff 3 metallic 0.9 exponent 0.8 fresnel on } } }
camera { location <0, 1.5, -6> look_at 0 angle 50 right x*4/3 }
light_source { <3, 5, -6> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <1, 0.5, 0.1>] [1 rgb <0.1, 0.3, 0.8>] } } }
plane { y, -1 pigment { checker rgb 0.2 rgb <0.4, 0.5, 0.3> } finish { reflection { 0.1, 0.5 } } }
sphere { <-2, 0, 0>, 0.9 pigment { rgb <0.3, 0.6, 0.9> } finish { reflection 0.6 } interior { ior 1.5 } }
sphere { 0, 0.9 pigment { rgb <0.3, 0.6, 0.9> } finish { reflection { rgb <0.1, 0.2, 0.3>, rgb <0.8, 0.5, 0.6> } } interior { ior 1.5 } }
sphere { <2, 0, 0>, 0.9 pigment { rgb <0.9, 0.6, 0.3> } interior { ior 1.5 } }

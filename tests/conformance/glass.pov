// Refraction: a ball, a slab, a cylinder and a sheared ellipsoid of glass before a pattern.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }
background { rgb <0.65, 0.8, 0.95> }
camera { location <0, 2, -7> look_at <0, 0.9, 0> angle 46 right x*4/3 }
light_source { <-5, 10, -6>, rgb 1 }
#declare Glass = interior { ior 1.5 }
#declare Clear = texture { pigment { rgbf <0.95, 0.98, 0.97, 0.92> } finish { ambient 0 diffuse 0.05 specular 0.7 roughness 0.005 reflection { 0, 1 fresnel } conserve_energy } }
plane { y, 0 pigment { checker rgb <0.9, 0.85, 0.7>, rgb <0.25, 0.35, 0.3> scale 0.7 } }
plane { z, 7 pigment { gradient x color_map { [0 rgb <0.9, 0.3, 0.2>] [0.5 rgb <0.95, 0.9, 0.6>] [1 rgb <0.2, 0.3, 0.7>] } scale 2 } finish { ambient 0.5 diffuse 0.3 } }
sphere { <-1.6, 1, 0>, 1 texture { Clear } interior { Glass } }
box { <0.1, 0.02, -0.6>, <0.7, 1.8, 0.6> rotate y*25 texture { Clear } interior { Glass } }
cylinder { <2.1, 0.02, 0.2>, <2.1, 1.9, 0.2>, 0.55 texture { Clear } interior { ior 1.33 } }
sphere { 0, 0.5 matrix <1.3, 0.3, 0, 0, 0.8, 0.2, 0, 0, 1, 0.2, 0.56, -2> texture { Clear } interior { ior 1.7 } }

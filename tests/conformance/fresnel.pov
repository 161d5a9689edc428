// Reflection that grows at grazing angles, on water, lacquer and glass.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }
background { rgb <0.6, 0.75, 0.95> }
camera { location <0, 1.2, -7> look_at <0, 0.8, 0> angle 46 right x*4/3 }
light_source { <6, 8, -5>, rgb 1 }
plane { y, 0 pigment { rgb <0.05, 0.12, 0.15> } finish { ambient 0 diffuse 0.4 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.33 } }
sphere { <-2, 1.1, 0.5>, 1 pigment { rgb <0.7, 0.1, 0.1> } finish { diffuse 0.7 reflection { 0.02, 0.9 fresnel } conserve_energy specular 0.5 } interior { ior 1.6 } }
sphere { <0.2, 0.9, 0>, 0.8 pigment { rgbt <0.9, 1, 0.95, 0.95> } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }
box { <1.4, 0.05, -0.5>, <2.6, 1.6, 0.7> rotate y*25 pigment { rgb <0.2, 0.3, 0.6> } finish { reflection { 0.1, 0.7 falloff 2 } conserve_energy } }
cylinder { <-0.9, 0.2, -1.8>, <0.5, 0.25, -2.1>, 0.2 pigment { brick rgb 0.8, rgb <0.6, 0.4, 0.2> scale 0.06 } }

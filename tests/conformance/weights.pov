// What a ray counts for, and where it is given up: filters of one channel, layers, metals, mirrors between two colours, Fresnel's, total reflection.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 9 adc_bailout 0.06 }
background { rgb <0.75, 0.85, 0.95> }
camera { location <0, 2.6, -8> look_at <0, 0.8, 0> angle 52 right x*4/3 }
light_source { <-4, 9, -6>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb <0.6, 0.5, 0.4> scale 0.7 } finish { ambient 0.15 reflection { 0.04, 0.6 falloff 2 } } }
#declare Dark = finish { ambient 0 diffuse 0.1 specular 0.4 }
sphere { <-2.9, 0.7, 0>, 0.7 pigment { rgbf <0.1, 0.1, 1, 0.8> } finish { Dark } }
box { <-1.9, 0.05, -0.4>, <-1.1, 1.3, 0.5> rotate -y*12 pigment { rgbf <1, 0.2, 0.3, 0.7> } finish { Dark reflection <0.1, 0.3, 0.2> } interior { ior 1.4 } }
sphere { <-0.2, 0.75, 0.3>, 0.7 pigment { rgb <0.9, 0.6, 0.2> } finish { ambient 0.05 diffuse 0.3 reflection { 0.08 metallic } } }
cylinder { <1.1, 0.05, 0>, <1.1, 1.5, 0>, 0.5 texture { pigment { rgb <0.3, 0.7, 0.5> } finish { reflection <0.1, 0.5, 0.2> } } texture { pigment { rgbf <0.2, 0.3, 1, 0.9> } finish { Dark } } }
sphere { <2.6, 0.8, 0>, 0.75 pigment { rgbf <0.95, 0.9, 0.4, 0.9> } finish { Dark reflection { <0.02, 0.1, 0>, <0.3, 0.05, 0.2> } } interior { ior 1.5 } }
sphere { <0.5, 0.4, -1.9>, 0.38 pigment { rgbf <0.6, 0.9, 0.7, 0.85> } finish { Dark reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.7 } }
union { box { <-0.3, 0, -0.02>, <0.3, 0.8, 0.02> } box { <-0.3, 0, 0.2>, <0.3, 0.8, 0.24> } box { <-0.3, 0, 0.42>, <0.3, 0.8, 0.46> } rotate y*35 translate <-1, 0.02, -2.2> pigment { rgbf <0.5, 0.9, 0.9, 0.6> } finish { Dark } }

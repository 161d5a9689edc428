// Albedo forms, light from behind, double illumination, ambient colours and emission.
#version 3.7;
global_settings { assumed_gamma 1 ambient_light rgb <0.8, 0.9, 1.2> }
background { rgb <0.2, 0.2, 0.25> }
camera { location <0, 2.5, -8> look_at <0, 0.9, 0> angle 44 right x*4/3 }
light_source { <-6, 8, -6>, rgb 1 }
light_source { <2, 3, 7>, rgb <0.9, 0.6, 0.3> }
plane { y, 0 pigment { rgb 0.5 } finish { ambient rgb <0.1, 0.2, 0.1> } }
sphere { <-2.6, 0.8, 0>, 0.8 pigment { rgb <0.7, 0.5, 0.4> } finish { diffuse albedo 0.6 brilliance 2 specular albedo 0.1 roughness 0.05 } }
sphere { <-0.8, 0.8, 0>, 0.8 pigment { rgb <0.4, 0.6, 0.7> } finish { diffuse 0.6 phong albedo 0.1 phong_size 20 emission 0.1 } }
disc { <0.8, 1, 0>, <0.3, 0, -1>, 0.7 double_illuminate pigment { rgb <0.6, 0.7, 0.4> } }
disc { <2.4, 1, 0>, <-0.3, 0.2, -1>, 0.7 pigment { rgb <0.7, 0.4, 0.7> } finish { diffuse 0.6, 0.4 } }
// An albedo is converted at the end of its block, with the exponents of that time.
#declare Lit = finish { diffuse albedo 0.5 phong albedo 0.05 specular albedo 0.05 roughness 0.1 }
sphere { <-1.7, 0.5, -2>, 0.5 pigment { rgb <0.5, 0.6, 0.4> } finish { Lit brilliance 4 phong_size 10 roughness 0.3 } }
sphere { <1.7, 0.5, -2>, 0.5 pigment { rgb <0.6, 0.5, 0.4> } finish { Lit } finish { brilliance 3 } }
box { <-0.5, 0, -2.2>, <0.5, 0.5, -1.4> rotate y*20 pigment { rgb <0.3, 0.5, 0.9> } finish { ambient 0 emission rgb <0.5, 0.3, 0.2> diffuse 0.3 } }

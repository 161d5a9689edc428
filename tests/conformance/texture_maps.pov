// Textures selected and mixed by patterns.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -7> look_at 0 right 4/3*x }
light_source { <-10, 15, -20> rgb 1 }
#declare Metal = texture { pigment { rgb <0.8, 0.6, 0.3> } finish { metallic specular 0.8 roughness 0.02 reflection 0.3 } }
#declare Clear = texture { pigment { rgbt <0.4, 0.6, 1, 0.7> } finish { phong 1 } }
plane { y, -1 texture { square texture { pigment { rgb 0.9 } } texture { Metal } texture { pigment { rgb 0.3 } } texture { pigment { onion } } } }
sphere { <-2, 0, 0>, 1 texture { radial frequency 6 texture_map { [0.3 Metal] [0.6 Clear] } } }
sphere { <0, 0.2, 0>, 1 texture { spiral1 4 texture_map { [0 Clear] [0.5 pigment { rgb <0.9, 0.1, 0.1> }] [1 Metal] } scale 0.7 rotate 60*x } }
sphere { <2, 0, 0>, 1 texture { average texture_map { [1 Metal] [2 pigment { checker rgb 0.1 rgb 0.9 scale 0.3 }] } } }

// A scene in the manner of the early nineties: no version, no gamma, colours by name and word.
#declare Sky_Color = color red 0.4 green 0.6 blue 0.9;
#declare Gold = texture { pigment { color red 0.85 green 0.65 blue 0.25 } finish { ambient 0.25 diffuse 0.6 metallic specular 0.7 roughness 0.05 reflection 0.25 } }
background { color Sky_Color }
camera { location <0, 2, -7> direction <0, 0, 1.5> up <0, 1, 0> right <1.333, 0, 0> look_at <0, 0.9, 0> }
light_source { <-10, 15, -12> color red 1.0 green 1.0 blue 0.9 }
plane { <0, 1, 0>, 0 pigment { checker color red 0.7 green 0.7 blue 0.6 color red 0.3 green 0.3 blue 0.35 } finish { ambient 0.2 diffuse 0.7 } }
sphere { <-1.3, 1, 0>, 1 texture { Gold } }
sphere { <1.2, 0.8, -0.4>, 0.8 pigment { color red 1 green 1 blue 1 filter 0.85 } finish { ambient 0.05 diffuse 0.1 phong 1 phong_size 60 reflection 0.1 } interior { ior 1.4 } }
cylinder { <0.2, 0, 1.2>, <0.2, 2.4, 1.2>, 0.4 pigment { gradient y color_map { [0.0 color red 0.8] [0.5 color green 0.7 blue 0.2] [1.0 color rgb <0.9, 0.9, 0.2>] } } }
box { <-0.4, 0, -1.6>, <0.4, 0.5, -0.9> rotate <0, 25, 0> pigment { color rgbf <0.3, 0.5, 0.9, 0.5> } }

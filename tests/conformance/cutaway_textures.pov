// Parts without a texture that show those of the other parts: cut, of several at once, placed, clear, nested, taken away, inverse, with a texture for all.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.8, 0.82, 0.85> }
camera { location <0.5, 4.4, -8> look_at <0, 0.7, 0> angle 50 right x*4/3 }
light_source { <-5, 9, -8>, rgb 1 }
light_source { <6, 4, -6>, rgb 0.3 }
plane { y, 0 pigment { rgb <0.6, 0.6, 0.55> } }
#declare Wood = texture { pigment { gradient x color_map { [0 rgb <0.7, 0.45, 0.2>] [1 rgb <0.4, 0.2, 0.1>] } scale 0.23 } }
#declare Tiles = texture { pigment { checker rgb <0.9, 0.9, 0.8>, rgb <0.2, 0.3, 0.6> scale 0.37 } finish { phong 0.7 } }
#declare Green = texture { pigment { rgb <0.3, 0.7, 0.4> } finish { specular 0.5 } }
difference { sphere { 0, 0.9 texture { Wood rotate z*30 } } box { <0, 0, 0>, <2, 2, -2> } cutaway_textures rotate y*25 translate <-2.9, 0.9, 0.5> }
intersection { sphere { 0, 0.9 texture { Wood } } box { -0.75, 0.75 texture { Tiles } } cylinder { -2*y, 2*y, 0.7 } plane { <0.3, 1, -0.4>, 0.35 } cutaway_textures rotate -y*20 translate <-0.9, 0.75, 0.5> }
difference {
  intersection { sphere { 0, 0.9 texture { Tiles } } box { -0.8, 0.8 texture { Wood } } cylinder { -2*x, 2*x, 0.85 texture { Green } } }
  sphere { <0, 0.5, -0.8>, 0.5 } box { <0.2, 0.2, -2>, <2, 2, 2> texture { Wood } }
  cutaway_textures translate <1.1, 0.8, 0.5>
}
difference { union { sphere { <0, 0, 0>, 0.6 } box { -0.5, 0.5 translate -0.3*y } texture { Green } } union { sphere { <0, 0.4, -0.6>, 0.4 } cylinder { <0.3, -2, -0.6>, <0.3, 2, -0.6>, 0.2 } } cutaway_textures translate <2.9, 0.8, 0.3> }
difference { sphere { 0, 0.5 } box { <-0.1, -0.1, 0.1>, <1, 1, -1> texture { Tiles } } cutaway_textures translate <-2.6, 0.5, -1.8> }
difference { sphere { 0, 0.5 texture { Green } } box { <-0.1, -0.1, 0.1>, <1, 1, -1> } cutaway_textures texture { Wood } translate <-1.2, 0.5, -1.8> }
intersection { box { -0.45, 0.45 } sphere { 0, 0.3 inverse texture { Green } } plane { <1, 1, -1>, 0.2 } cutaway_textures translate <0.1, 0.45, -1.8> }
union {
  difference { cylinder { <0, 0.01, 0>, <0, 0.8, 0>, 0.4 texture { pigment { rgb <0.9, 0.4, 0.3> transmit 0.5 } } } cylinder { <0, 0.2, 0>, <0, 1, 0>, 0.3 } cutaway_textures }
  sphere { <0, 1, 0>, 0.15 }
  translate <1.4, 0, -1.8>
}
intersection { sphere { 0, 0.5 texture { Tiles } } difference { box { -0.42, 0.42 } sphere { <0, 0.3, -0.4>, 0.3 } } cutaway_textures rotate y*30 translate <2.6, 0.45, -1.8> }

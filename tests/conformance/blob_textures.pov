// Blobs whose components have textures of their own: each shows by how strong its field is.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.4, -6> look_at <0, 0.9, 0> }
light_source { <-6, 9, -8>, 1 }
background { rgb <0.5, 0.6, 0.7> }
plane { y, 0 pigment { checker rgb 0.8, rgb 0.6 } finish { reflection 0.1 } }
#declare Glaze = texture { pigment { rgb <0.9, 0.6, 0.1> } finish { specular 0.6 roughness 0.02 reflection 0.2 } }
#declare Drop = blob {
  threshold 0.4
  sphere { <-0.5, 0, 0>, 1.1, 1 texture { pigment { gradient x color_map { [0 rgb <1, 0.9, 0.3>] [1 rgb <0.8, 0.1, 0.2>] } scale 0.3 } finish { phong 0.5 } } rotate 20*z }
  sphere { <0.5, 0.1, 0>, 1, 0.8 pigment { checker rgb <0.1, 0.3, 0.9>, rgb 1 scale 0.25 } }
  sphere { <0.1, 0.3, -0.7>, 0.6, -0.5 texture { pigment { rgb <0.1, 0.8, 0.3> } } }
  cylinder { <-0.4, 0.2, 0.2>, <0.5, 1, 0.2>, 0.7, 0.7 scale <1, 1.1, 1> }
}
object { Drop texture { Glaze } translate <-2.4, 0.9, 0> }
union {
  object { Drop rotate 120*y translate <0, 0.8, 0.6> }
  sphere { <0, 2.6, 0.6>, 0.3 }
  pigment { rgb <0.3, 0.3, 0.35> }
}
difference {
  object { Drop rotate -60*y }
  box { <-2, -2, -2>, <2, 2, -0.1> rotate 25*y pigment { rgb <0.9, 0.5, 0.5> } }
  pigment { rgb <0.6, 0.2, 0.7> }
  translate <2.3, 0.9, 0>
}
blob {
  threshold 0.3
  sphere { <-0.35, 0.35, -2>, 0.6, 1 pigment { rgbf <1, 0.3, 0.3, 0.7> } }
  sphere { <0.35, 0.35, -2>, 0.6, 1 pigment { rgbt <0.3, 0.5, 1, 0.6> } }
  component 0.8, 0.5, <0, 0.8, -2>
  pigment { rgb <1, 1, 0.4> }
}

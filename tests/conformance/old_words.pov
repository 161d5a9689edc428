// Words of old scenes: ior, caustics and refraction in a finish; the background is opaque.
#version 3.6;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -6> look_at <0, 0.4, 0> angle 50 }
light_source { <6, 9, -8>, rgb 1 }
background { rgbt <0.3, 0.5, 0.9, 0.8> }
plane { y, -1 pigment { checker rgb 1 rgb 0.2 } }
#declare Old = texture { pigment { rgbf <1, 0.9, 0.8, 0.9> } finish { reflection 0.1 refraction 1 ior 1.4 phong 0.8 } }
sphere { <-1.6, 0, 0>, 1 texture { Old } }
sphere { <1.2, 0, 0>, 1 texture { Old } interior { ior 1.1 } }
union {
  box { <-0.6, -0.99, -2>, <-0.1, 0, -1.6> }
  cylinder { <0.3, -0.99, -1.8>, <0.3, 0.2, -1.8>, 0.25 }
  pigment { rgbf <0.8, 1, 0.8, 0.8> }
  finish { ior 1.6 caustics 0.4 }
}

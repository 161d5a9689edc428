// Faces in common: no skin may be left of what is taken away, and what touches is one.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <3, 5, -8> look_at <0, -0.1, 0> angle 38 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1.001 pigment { rgb 0.6 } }
// The cut begins exactly at the face of what is cut, but is a hair deeper for POV-Ray's sake, which leaves speckle otherwise.
#declare Hair = 1e-4;
difference { box { -1, 1 } box { <-0.5, -0.5, -1 - Hair>, <0.5, 0.5, 1 + Hair> } pigment { rgb <0.9, 0.4, 0.2> } rotate 30*y translate <-1.5, 0, -1> }
merge { box { <-1, -1, -1>, <0, 1, 1> } box { <0, -1, -1>, <1, 0, 1> } cylinder { <0.5, 0, 0>, <0.5, 0.6, 0>, 0.5 } pigment { rgb <0.4, 0.7, 0.4> } rotate 20*y translate <1.6, 0, -0.6> }
difference {
  intersection { box { -1, 1 } sphere { 0, 1.2 } }
  merge { box { <-2, 0, -2>, <0, 2, 0> } box { <0, 0, 0>, <2, 2, 2> } }
  pigment { rgb <0.5, 0.5, 0.9> } translate <0, 0, 2.4>
}

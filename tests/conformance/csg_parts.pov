// Parts with habits: inverse, open, clipped, unions inside, names used twice, clips that are solids of solids.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <4, 6, -9> look_at <0, -0.1, 0.4> angle 42 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1.001 pigment { rgb 0.6 } }
#default { pigment { rgb <0.8, 0.8, 0.3> } }
intersection { box { -1, 1 pigment { rgb <0.8, 0.3, 0.3> } } union { sphere { <0.5, 1, 0>, 0.6 } sphere { <-0.2, 1, 0>, 0.6 } inverse pigment { rgb <0.3, 0.8, 0.4> } } translate <-2.6, 0, -1> }
difference { box { -1, 1 pigment { rgb <0.8, 0.4, 0.3> } } cylinder { -0.5*y, 3*y, 0.6 open pigment { rgb <0.4, 0.4, 0.9> } } translate <0, 0, -1.6> }
intersection { box { -1, 1 pigment { rgb <0.8, 0.5, 0.3> } } cylinder { -0.5*y, 0.5*y, 1.2 open pigment { rgb <0.4, 0.6, 0.9> } } translate <2.8, 0, -0.6> }
difference { box { -1, 1 pigment { rgb <0.7, 0.7, 0.7> } } sphere { y, 0.8 clipped_by { plane { x, 0 } } pigment { rgb <0.9, 0.6, 0.2> } } rotate 20*y translate <-2, 0, 2.4> }
#declare Frame = difference { box { -1, 1 } box { <-0.7, -0.7, -2>, <0.7, 0.7, 2> } box { <-0.7, -2, -0.7>, <0.7, 2, 0.7> } box { <-2, -0.7, -0.7>, <2, 0.7, 0.7> } }
object { Frame pigment { rgb <0.5, 0.8, 0.8> } scale 0.8 rotate 35*y translate <0.8, -0.2, 2.4> }
sphere { 0, 0.95 clipped_by { object { Frame scale 0.8 rotate 10*y } } pigment { rgb <0.9, 0.5, 0.8> } translate <3.2, -0.1, 2.6> }

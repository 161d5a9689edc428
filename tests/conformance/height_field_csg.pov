// Solids of height fields: what lies under them, taken and taken away.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.2, -4> look_at <0, 0.2, 0> angle 34 right x*4/3 }
light_source { <-3, 5, -4>, rgb 1 }
light_source { <4, 3, -2>, rgb 0.4 }
background { rgb <0.3, 0.5, 0.8> }
#default { texture { pigment { rgb <0.5, 0.7, 0.4> } finish { ambient 0.1 diffuse 0.8 } } }
#declare Field = height_field { function 250, 250 { 0.5 + 0.3*sin(11*x)*cos(8*y) } }
intersection { object { Field } box { <0.1, 0.05, 0.1>, <0.9, 2, 0.9> } translate <-1.3, 0, -0.3> }
difference { box { <0.1, -0.1, 0.1>, <0.9, 0.7, 0.9> } object { Field } translate <0.3, 0.3, -0.3> }
object { Field clipped_by { cylinder { <0.5, -1, 0.5>, <0.5, 2, 0.5>, 0.4 } } translate <-0.5, 0, 0.6> }

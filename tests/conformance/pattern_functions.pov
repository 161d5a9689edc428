// Functions of patterns and pigments without a formula, in pigments, normals, height fields and expressions.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 4, -9> look_at <0, 0.3, 0> angle 38 right x*image_width/image_height }
light_source { <-30, 60, -40>, rgb 0.9 }
#declare Cracks = function { pattern { crackle form <1, 0, 0> metric 2 scale 0.5 } }
#declare Cells = function { pattern { cells scale 0.4 } }
#declare Spiral = function { pattern { spiral1 3 rotate 90*x scale 0.7 } }
#declare Mixed = function { pigment { average pigment_map { [2 quilted color_map { [0 rgb x] [1 rgb y] } scale 0.3] [1 square rgb 0 rgb 1 rgb z rgb <1, 1, 0>] } warp { repeat 0.7*x } } }
plane { y, -1 pigment { function { 0.5*Cells(x, y, z) + 0.5*Spiral(x, 0, z) } color_map { [0 rgb <0.3, 0.4, 0.5>] [1 rgb 1] } } }
sphere { <-2.4, 0, 0>, 1 pigment { function { Cracks(x, y, z) } color_map { [0 rgb 0] [1 rgb <1, 0.8, 0.5>] } } }
sphere { <0, 0, 0>, 1 pigment { function { Mixed(x, y, z).gray } color_map { [0 rgb <0.1, 0.1, 0.5>] [1 rgb <1, 0.9, 0.8>] } } }
sphere { <2.4, 0, 0>, 1 pigment { rgb 0.8 } normal { function { Cracks(x, y, z)*0.5 } 1.5 } }
height_field { function 40, 40 { Cracks(3*x, 3*y, 0)*0.6 } pigment { rgb <0.7, 0.8, 0.6> } translate <-0.5, 0, -0.5> scale <4, 1, 2> translate <0, 0.6, 3> }
#declare I = 0;
#while (I < 12)
  sphere { <-2.2 + 0.4*I, -0.85 + 0.5*Cracks(I*0.37, 0.2, 0.6) + 0.2*Mixed(I*0.3, 0, 0.4).red, -1.6>, 0.12 pigment { rgb Mixed(I*0.3, 0, 0.4) } }
  #declare I = I + 1;
#end

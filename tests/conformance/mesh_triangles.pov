// Flat triangles alone and in meshes: a folded strip, an octahedron, a fan, textures per face.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.85, 0.88, 0.9> }
camera { location <0, 3, -8> look_at <0, 0.8, 0> angle 46 right x*4/3 }
light_source { <-5, 10, -7>, rgb 1 }
plane { y, 0 pigment { rgb <0.5, 0.55, 0.5> } }
#declare Red = texture { pigment { rgb <0.9, 0.3, 0.2> } finish { phong 0.5 } }
#declare Blue = texture { pigment { rgb <0.2, 0.4, 0.9> } finish { specular 0.5 } }
mesh {
  triangle { <0, 1.2, 0>, <1, 0, 0>, <0, 0, 1> texture { Red } }
  triangle { <0, 1.2, 0>, <0, 0, 1>, <-1, 0, 0> texture { Blue } }
  triangle { <0, 1.2, 0>, <-1, 0, 0>, <0, 0, -1> texture { Red } }
  triangle { <0, 1.2, 0>, <0, 0, -1>, <1, 0, 0> texture { Blue } }
  triangle { <0, -1.2, 0>, <0, 0, 1>, <1, 0, 0> }
  triangle { <0, -1.2, 0>, <-1, 0, 0>, <0, 0, 1> }
  triangle { <0, -1.2, 0>, <0, 0, -1>, <-1, 0, 0> }
  triangle { <0, -1.2, 0>, <1, 0, 0>, <0, 0, -1> }
  texture { pigment { rgb <0.9, 0.8, 0.3> } }
  rotate <15, 25, 10> translate <-2.2, 1.4, 0>
}
mesh {
  #declare I = 0;
  #while (I < 12)
    #declare A = 2*pi*I/12; #declare B = 2*pi*(I+1)/12;
    triangle { <0, 1, 0>, <cos(A), 0.5+0.4*mod(I, 2), sin(A)>, <cos(B), 0.5+0.4*mod(I+1, 2), sin(B)> }
    #declare I = I+1;
  #end
  pigment { rgb <0.4, 0.75, 0.5> } finish { specular 0.4 }
  scale 1.2 translate <0.6, 0.3, 1>
}
triangle { <1.6, 0.1, -1.5>, <3, 0.2, -0.6>, <2.1, 1.9, -0.8> pigment { checker rgb 1, rgb <0.6, 0.2, 0.5> scale 0.2 } }
triangle { <2.4, 0.05, -1.2>, <3.4, 0.3, 0.6>, <2.8, 1.6, 0.4> pigment { rgb <0.3, 0.6, 0.7> } finish { reflection 0.3 } }
triangle { <-0.5, 0.02, -2>, <0.9, 0.02, -2.3>, <0.3, 0.9, -1.8> pigment { rgbf <0.9, 0.6, 0.5, 0.6> } }

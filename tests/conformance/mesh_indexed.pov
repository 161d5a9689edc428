// mesh2: vertex, normal, uv and texture lists; a torus by loops and a box by hand.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.8, 0.85, 0.95> }
camera { location <0, 3.6, -7.5> look_at <0, 0.7, 0> angle 44 right x*4/3 }
light_source { <6, 10, -7>, rgb 1 }
plane { y, -0.3 pigment { hexagon rgb 0.75, rgb 0.65, rgb 0.55 scale 0.8 } }
#declare N = 20; #declare M = 10;
mesh2 {
  vertex_vectors { N*M #declare I = 0; #while (I < N) #declare J = 0; #while (J < M)
    #declare A = 2*pi*I/N; #declare B = 2*pi*J/M;
    , <(1.1+0.45*cos(B))*cos(A), 0.45*sin(B), (1.1+0.45*cos(B))*sin(A)>
    #declare J = J+1; #end #declare I = I+1; #end }
  normal_vectors { N*M #declare I = 0; #while (I < N) #declare J = 0; #while (J < M)
    #declare A = 2*pi*I/N; #declare B = 2*pi*J/M;
    , <cos(B)*cos(A), sin(B), cos(B)*sin(A)>
    #declare J = J+1; #end #declare I = I+1; #end }
  face_indices { 2*N*M #declare I = 0; #while (I < N) #declare J = 0; #while (J < M)
    #declare A0 = I*M+J; #declare A1 = mod(I+1, N)*M+J; #declare A2 = mod(I+1, N)*M+mod(J+1, M); #declare A3 = I*M+mod(J+1, M);
    , <A0, A1, A2>, <A0, A2, A3>
    #declare J = J+1; #end #declare I = I+1; #end }
  pigment { rgb <0.85, 0.55, 0.25> } finish { specular 0.6 roughness 0.03 }
  rotate <-25, 0, 15> translate <-1.5, 0.9, 0>
}
mesh2 {
  vertex_vectors { 8, <-1, 0, -1>, <1, 0, -1>, <1, 1.4, -1>, <-1, 1.4, -1>, <-1, 0, 1>, <1, 0, 1>, <1, 1.4, 1>, <-1, 1.4, 1> }
  texture_list { 3, texture { pigment { rgb <0.8, 0.3, 0.3> } }, texture { pigment { rgb <0.3, 0.7, 0.4> } finish { phong 0.5 } }, texture { pigment { checker rgb 0.9, rgb <0.3, 0.4, 0.7> scale 0.21 translate 0.03 } } }
  face_indices { 12, <0, 1, 2>, 0, <0, 2, 3>, 0, <1, 5, 6>, 1, <1, 6, 2>, 1, <5, 4, 7>, 2, <5, 7, 6>, 2, <4, 0, 3>, 1, <4, 3, 7>, 1, <3, 2, 6>, 2, <3, 6, 7>, 2, <4, 5, 1>, 0, <4, 1, 0>, 0 }
  scale 0.75 rotate <8, 30, 5> translate <1.7, 0.1, 0.4>
}

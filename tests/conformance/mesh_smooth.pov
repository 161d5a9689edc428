// Smooth triangles: a coarse ball, a wavy sheet, and a lone triangle, with highlights and reflection.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.3, 0.35, 0.45> }
camera { location <0, 3, -8> look_at <0, 0.9, 0> angle 44 right x*4/3 }
light_source { <-6, 9, -8>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.8, rgb 0.4 } }
#macro Ball(M, N)
  #local I = 0;
  #while (I < M)
    #local T0 = pi*I/M; #local T1 = pi*(I+1)/M;
    #local J = 0;
    #while (J < N)
      #local P0 = 2*pi*J/N; #local P1 = 2*pi*(J+1)/N;
      #local A = <sin(T0)*cos(P0), cos(T0), sin(T0)*sin(P0)>;
      #local B = <sin(T1)*cos(P0), cos(T1), sin(T1)*sin(P0)>;
      #local C = <sin(T1)*cos(P1), cos(T1), sin(T1)*sin(P1)>;
      #local D = <sin(T0)*cos(P1), cos(T0), sin(T0)*sin(P1)>;
      #if (I < M-1) smooth_triangle { A, A, B, B, C, C } #end
      #if (I > 0) smooth_triangle { A, A, C, C, D, D } #end
      #local J = J+1;
    #end
    #local I = I+1;
  #end
#end
mesh { Ball(6, 10) pigment { rgb <0.9, 0.5, 0.3> } finish { specular 0.7 roughness 0.02 } rotate <20, 10, 0> translate <-1.9, 1.2, 0> }
mesh { Ball(5, 8) pigment { rgb 0.15 } finish { diffuse 0.3 reflection 0.6 } scale <1, 0.6, 0.8> rotate z*20 translate <0.9, 0.9, 0.3> }
smooth_triangle { <1.8, 0.1, -1.2>, <-0.4, 0.1, -1>, <3.2, 0.1, -0.6>, <0.5, 0, -1>, <2.5, 1.6, -0.4>, <0, 0.6, -1> pigment { rgb <0.4, 0.7, 0.9> } finish { phong 0.8 phong_size 30 } }

// Some hundred atoms and bonds from a seeded random stream: many small shapes and shadows.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb 1 }
camera { location <0, 1, -16> look_at 0 angle 40 right x*4/3 }
light_source { <-12, 16, -14>, rgb 0.9 }
light_source { <14, 4, -10>, rgb 0.3 }
#declare S = seed(1514);
#declare P = <-5, 0, 0>;
#declare I = 0;
#while (I < 150)
  #declare Q = <5*cos(I*0.13)+rand(S)*1.6-0.8, 4*sin(I*0.21)+rand(S)*1.6-0.8, 3*sin(I*0.37)+rand(S)*1.6-0.8>;
  sphere { Q, 0.25+0.25*rand(S) pigment { rgb <rand(S), rand(S), rand(S)> } finish { phong 0.6 phong_size 30 } }
  #if (vlength(Q-P) > 0.01 & vlength(Q-P) < 3) cylinder { P, Q, 0.1 pigment { rgb 0.7 } finish { specular 0.5 } } #end
  #declare P = Q;
  #declare I = I+1;
#end

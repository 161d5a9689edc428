// Seven coloured lamps, their overlapping shadows on white things.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -9> look_at <0, 0.8, 0> angle 44 right x*4/3 }
#for (I, 0, 6)
  light_source { <6*cos(I*0.9), 5+0.4*I, 6*sin(I*0.9)-3>, rgb <0.5+0.5*cos(I), 0.5+0.5*cos(I+2.1), 0.5+0.5*cos(I+4.2)>*0.4 }
#end
plane { y, 0 pigment { rgb 1 } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-1.8, 0.9, 0>, 0.9 pigment { rgb 1 } finish { specular 0.6 roughness 0.01 } }
cylinder { <0, 0.01, 0.8>, <0, 1.8, 0.8>, 0.4 pigment { rgb 1 } }
cone { <1.8, 0.01, 0>, 0.8, <1.8, 1.7, 0>, 0 pigment { rgb 1 } finish { phong 0.5 } }
box { <-0.5, 0.01, -2>, <0.5, 0.7, -1.2> rotate y*30 pigment { rgb 1 } finish { reflection 0.15 } }
disc { <0.9, 2.6, 0.4>, <0.3, 1, 0.2>, 0.6, 0.3 pigment { rgb 1 } }

// Parallel projection under an angle: true lengths, scaled by the distance of what is looked at.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb 0.92 }
camera { orthographic location <6, 5, -8> look_at <0, 0.6, 0> angle 32 right x*4/3 }
light_source { <3, 12, -8>, rgb 1 }
#declare I = -2;
#while (I < 3)
  #declare J = -2;
  #while (J < 3)
    box { <I-0.4, 0, J-0.4>, <I+0.4, 0.4+0.3*abs(I+J), J+0.4> pigment { rgb <0.5+0.2*I, 0.6, 0.5-0.2*J> } }
    #declare J = J+1;
  #end
  #declare I = I+1;
#end
plane { y, -0.05 pigment { checker rgb 0.8, rgb 0.65 } }
sphere { <0, 1.1, 0>, 0.6 pigment { rgb <0.9, 0.3, 0.3> } finish { reflection 0.3 phong 0.5 } }

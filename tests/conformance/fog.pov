// Fog everywhere, and fog on the ground.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -8> look_at <0, 1, 0> right 4/3*x angle 50 }
light_source { <-10, 15, -20> rgb 1 }
fog { distance 30 rgbt <0.6, 0.7, 0.9, 0.1> }
fog { fog_type 2 distance 4 rgb <0.8, 0.8, 0.7> fog_offset 0.2 fog_alt 0.5 up y }
plane { y, -1 pigment { checker rgb 0.9 rgb <0.2, 0.4, 0.2> } }
#declare I = 0;
#while (I < 6)
  sphere { <I*1.2 - 3, I*0.4 - 0.5, I*3 - 2>, 0.7 pigment { rgb <0.8, 0.2, 0.1> } finish { reflection 0.3 } }
  #declare I = I + 1;
#end
sphere { <2, 0, -3>, 0.8 pigment { rgbt 0.9 } interior { ior 1.3 } }

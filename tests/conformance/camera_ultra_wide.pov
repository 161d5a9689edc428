// The camera of kind ultra_wide. Boxes on all sides.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Kind) #declare Kind = 1; #end
camera {
  #switch (Kind)
    #case (0) fisheye angle 200 #break
    #case (1) ultra_wide_angle angle 140 #break
    #case (2) spherical #break
    #case (3) panoramic #break
    #case (4) cylinder 1 angle 150 #break
    #case (5) cylinder 2 angle 150 #break
    #case (6) cylinder 3 angle 150 #break
    #case (7) cylinder 4 angle 150 #break
    #case (8) spherical angle 200, 120 #break
  #end
  right 4/3*x up y location <0.2, 0.5, -0.3> look_at <1, 0.4, 3>
}
sky_sphere { pigment { checker rgb <0.4, 0.6, 0.9> rgb 0.9 scale 0.3 } }
light_source { <2, 9, -4> rgb 1 }
plane { y, -1 pigment { checker rgb 0.8 rgb 0.3 } }
#declare I = 0;
#while (I < 8)
  box { -0.5, 0.5 pigment { rgb <I/8, 1 - I/8, 0.5> } rotate 20*y translate 3*z rotate I*45*y }
  #declare I = I + 1;
#end

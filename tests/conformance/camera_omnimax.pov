// The fisheye of Omnimax theatres. Boxes on all sides.
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
  omnimax
  right 4/3*x up 0.9*y location <0.2, 0.5, -0.3> look_at <1, 0.4, 3>
}
sky_sphere { pigment { checker rgb <0.4, 0.6, 0.9> rgb 0.9 scale 0.3 } }
light_source { <2, 9, -4> rgb 1 }
plane { y, -1 pigment { checker rgb 0.8 rgb 0.3 } }
#declare I = 0;
#while (I < 8)
  box { -0.5, 0.5 pigment { rgb <I/8, 1 - I/8, 0.5> } rotate 20*y translate 3*z rotate I*45*y }
  #declare I = I + 1;
#end

// The surface on which the camera stands is not seen: here a corner of a turned box, and the side of a glass ball.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare At = vrotate(<-2, 1.5, -2>, <10, 20, 5>);
camera { location At look_at <0.3, -0.4, 0.5> angle 75 }
light_source { <0.4, 1, 0.3>, rgb 0.8 }
box { <-2, -1.5, -2>, <2, 1.5, 2> pigment { checker rgb 1 rgb <0.4, 0.6, 0.9> } rotate <10, 20, 5> }
sphere { At, 0.6 pigment { rgbf <1, 0.9, 0.8, 0.9> } translate <0.6, 0, 0> }
sphere { <0.4, -0.7, 0.4>, 0.6 pigment { rgb <1, 0.4, 0.1> } finish { reflection 0.3 } }

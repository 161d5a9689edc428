// Lights that lie on surfaces: on the ceiling, on a turned box of coloured glass, on a ball of clear glass; and one at the camera.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0.6, -6> look_at <0, 0, 0> angle 60 }
light_source { <0.5, 2.5, 0>, rgb 0.4 }
light_source { <0, 0.6, -6>, rgb 0.15 }
plane { y, 2.5 pigment { rgb <1, 0.95, 0.9> } }
plane { y, -1.2 pigment { checker rgb 1 rgb <0.5, 0.6, 0.8> } }
plane { z, 5 pigment { rgb 0.8 } }

box { -0.7, 0.7 pigment { rgbf <0.9, 0.5, 0.3, 0.7> } rotate <20, 30, 40> translate <-1.6, 0, 0.5> }
light_source { vrotate(<0.1, 0.7, -0.2>, <20, 30, 40>) + <-1.6, 0, 0.5>, rgb <0.5, 0.45, 0.3> }

sphere { <1.3, -0.2, 0>, 1 pigment { rgbf <1, 0.9, 0.8, 0.85> } finish { phong 0.5 } interior { ior 1.2 } }
light_source { <1.3, -0.2, -1>, rgb 0.3 }
cylinder { <1.3, -1.1, 0>, <1.3, -0.4, 0>, 0.3 pigment { rgb <0.3, 0.8, 0.4> } }

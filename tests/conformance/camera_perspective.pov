// Every word of the camera: oblique up and right, direction, sky, a mirrored right, and transforms.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.95, 0.9, 0.8> }
camera { location <0, 0, -5> direction <0.1, 0.05, 1.4> up <0.1, 1, 0> right <-1.3, 0.2, 0.1> sky <0.3, 1, 0> rotate <8, -4, -5> translate <0, 0.6, -1.5> }
light_source { <4, 7, -9>, rgb 1 }
plane { y, -1.2 pigment { brick rgb 0.8, rgb <0.5, 0.4, 0.6> scale 0.2 translate <0, 0.3, 0> } }
sphere { <-1.1, 0, 0>, 1 pigment { gradient y color_map { [0 rgb <0.2, 0.4, 0.8>] [1 rgb <0.9, 0.9, 0.5>] } scale 0.5 } }
box { <0.4, -1.1, -0.6>, <1.6, 0.5, 0.6> rotate y*35 pigment { rgb <0.7, 0.3, 0.3> } finish { phong 0.5 } }
cylinder { <-0.2, -1, -1.6>, <1.2, -0.6, -1.4>, 0.25 pigment { rgb <0.3, 0.7, 0.4> } finish { specular 0.5 } }

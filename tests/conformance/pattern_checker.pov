// Checkers of colours, of pigments and of textures; scaled, turned, in planes, boxes and balls.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.2, 0.25, 0.3> }
camera { location <1, 4, -8> look_at <0, 0.5, 0> angle 46 right x*4/3 }
light_source { <-6, 10, -8>, rgb 1 }
plane { y, 0 pigment { checker rgb <0.9, 0.8, 0.6>, rgb <0.3, 0.2, 0.15> scale <1.3, 1, 0.7> rotate y*20 } }
sphere { <-2.2, 1, 0.3>, 1 pigment { checker rgb <0.9, 0.2, 0.2>, rgb 0.95 scale 0.31 rotate <20, 30, 0> } finish { phong 0.4 } }
box { <-0.8, 0.02, -0.8>, <0.8, 1.5, 0.8> pigment { checker pigment { checker rgb 0.9, rgb <0.2, 0.5, 0.7> scale 0.11 }, pigment { rgb <0.9, 0.7, 0.2> } scale 0.437 translate 0.05 } rotate y*33 translate <0.3, 0, 1> }
sphere { <2.4, 0.9, 0>, 0.9
  texture { checker texture { pigment { rgb 0.1 } finish { reflection 0.5 diffuse 0.2 } }, texture { pigment { rgb <0.8, 0.9, 0.5> } finish { phong 0.6 } } scale 0.4 rotate z*35 } }
cylinder { <0.6, 0.35, -2.4>, <2.2, 0.35, -2>, 0.35 pigment { checker scale 0.23 translate <0.1, 0.03, 0.07> } }

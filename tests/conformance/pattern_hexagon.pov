// Hexagons on the floor, on a turned wall, on a ball, and with their default colours.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb 0.2 }
camera { location <0, 3.5, -8> look_at <0, 0.8, 0> angle 48 right x*4/3 }
light_source { <5, 9, -8>, rgb 1 }
plane { y, 0 pigment { hexagon rgb <0.85, 0.8, 0.7>, rgb <0.5, 0.35, 0.3>, rgb <0.25, 0.3, 0.35> scale 0.5 rotate y*15 } }
plane { z, 5 pigment { hexagon rgb <0.3, 0.5, 0.4>, rgb <0.5, 0.7, 0.5>, rgb <0.7, 0.8, 0.6> rotate x*90 scale <1.2, 0.7, 1> } }
sphere { <-1.8, 1.1, 0>, 1.1 pigment { hexagon rgb <0.9, 0.2, 0.3>, rgb <0.9, 0.6, 0.2>, rgb <0.9, 0.9, 0.8> scale 0.25 rotate <50, 0, 20> } finish { specular 0.5 } }
box { <0.4, 0.01, -0.8>, <2.2, 1.4, 0.7> pigment { hexagon scale 0.33 translate 0.17 } rotate y*-25 }
cylinder { <-0.6, 0.3, -2.2>, <1, 0.3, -2.4>, 0.3 pigment { hexagon pigment { rgb 1 }, pigment { checker rgb 0, rgb 1 scale 0.05 }, pigment { rgb <0, 0.4, 0.6> } scale 0.15 } }

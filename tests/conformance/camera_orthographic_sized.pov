// Parallel projection whose window is given by up and right themselves, with sky turned.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.2, 0.25, 0.35> }
camera { orthographic location <-3, 4, -6> up y*4.5 right x*6 sky <0.2, 1, 0> look_at <0.2, 0.5, 0> }
light_source { <-4, 9, -8>, rgb 1 }
plane { y, 0 pigment { hexagon rgb 0.8, rgb 0.6, rgb 0.4 scale 0.4 } }
cylinder { <-1, 0.01, 0>, <-1, 1.4, 0>, 0.6 pigment { rgb <0.8, 0.5, 0.3> } finish { phong 0.4 } }
cone { <0.8, 0.01, 0.4>, 0.8, <0.8, 1.6, 0.4>, 0 pigment { rgb <0.3, 0.6, 0.8> } finish { specular 0.4 } }
sphere { <0.2, 0.4, -1.4>, 0.4 pigment { rgbf <0.9, 1, 0.95, 0.8> } finish { specular 0.8 reflection 0.1 } interior { ior 1.4 } }

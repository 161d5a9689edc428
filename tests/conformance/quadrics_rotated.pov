// Ellipsoid, cylinders and cones, scaled unequally and turned about several axes.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.1, 0.12, 0.2> }
camera { location <0.5, 3, -9> look_at <0, 0.6, 0> angle 52 right x*4/3 }
light_source { <-8, 12, -10>, rgb <1, 0.95, 0.9> }
light_source { <9, 5, -4>, rgb 0.35 }
plane { y, -1.6 pigment { rgb <0.6, 0.6, 0.55> } }
sphere { 0, 1 scale <1.8, 0.6, 1> rotate <20, 35, 50> translate <-2.4, 1, 0>
  pigment { rgb <0.9, 0.6, 0.2> } finish { specular 0.5 roughness 0.03 } }
cylinder { -y, y, 0.7 scale <1.4, 1, 0.5> rotate <-30, 20, 65> translate <0.6, 1.6, 1>
  pigment { rgb <0.3, 0.7, 0.8> } finish { phong 0.4 } }
cone { -1.2*y, 1, 1.2*y, 0.25 scale <0.8, 1, 1.3> rotate <40, -25, -15> translate <2.6, 0.3, -0.4>
  pigment { rgb <0.8, 0.3, 0.5> } finish { phong 0.4 } }
cone { 0, 0, <0.4, 2.1, 0.3>, 0.9 rotate <110, 15, 0> translate <-0.5, -0.3, -1.4>
  pigment { rgb <0.5, 0.8, 0.3> } finish { specular 0.4 } }
box { <-0.7, -0.4, -0.5>, <0.7, 0.4, 0.5> rotate <33, 48, 12> translate <3.3, 2.3, 2>
  pigment { rgb <0.7, 0.7, 0.9> } }

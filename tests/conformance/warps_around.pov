// Flat patterns laid around a cylinder, a sphere and a torus.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -9> look_at 0 right 4/3*x angle 40 }
light_source { <-10, 15, -20> rgb 1 }
#declare Board = pigment { checker rgb 0.9 rgb <0.2, 0.3, 0.8> }
cylinder { -y, y, 0.8 pigment { Board scale <0.1, 0.2, 1> warp { cylindrical } } translate -2.2*x }
sphere { 0, 1 pigment { Board scale <0.1, 0.125, 1> warp { spherical } } rotate 20*z }
torus { 0.8, 0.3 pigment { Board scale <0.1, 0.2, 1> warp { toroidal major_radius 0.8 } } rotate -30*x translate 2.3*x }
sphere { <-1, -1.4, -2>, 0.7 pigment { hexagon scale <0.5/pi, 0.25/pi, 1>*0.1 warp { spherical orientation y dist_exp 1 } translate <-1, -1.4, -2> } }
cylinder { <1, -2, -2>, <1, -0.8, -2>, 0.6 pigment { hexagon scale <0.5/pi, 1, 1>*0.3 warp { cylindrical orientation y dist_exp 1 } translate <1, 0, -2> } }

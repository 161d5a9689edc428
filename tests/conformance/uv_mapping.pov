// Textures by the coordinates of surfaces: u and v of spheres, boxes, tori, lathes, surfaces of revolution and meshes; x and y of others.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 4, -10> look_at <0, 0.5, 0> angle 40 right x*image_width/image_height }
light_source { <-30, 60, -40>, rgb 0.9 }
#declare Squares = pigment { uv_mapping checker rgb <0.9, 0.3, 0.2> rgb <0.9, 0.9, 0.4> scale <0.125, 0.1, 1> }
plane { y, -1.2 pigment { rgb 0.7 } }
sphere { <0.3, 0.2, 0.1>, 1 pigment { Squares } rotate 30*z translate <-3, 0, 0> }
box { <-0.8, -0.9, -0.5>, <0.9, 0.8, 0.6> texture { Squares scale 7 } rotate <20, 40, 10> translate <-0.8, 0, 0> }
torus { 0.8, 0.35 pigment { Squares } rotate <-50, 10, 0> translate <1.5, 0, 0> }
lathe { linear_spline 3, <0.7, -1>, <0.9, 0>, <0.4, 0.8> pigment { Squares } translate <3.4, 0, 0> }
sor { 5, <0.6, -2>, <0.6, -0.8>, <0.8, 0.3>, <0.3, 1>, <0.2, 1.6> pigment { Squares } translate <-2.2, 1.6, 3> }
mesh { triangle { <-1, -1, 0>, <1, -1, 0>, <1, 1, 0> uv_vectors <0, 0>, <1, 0>, <1, 1> } triangle { <-1, -1, 0>, <1, 1, 0>, <-1, 1, 0.5> uv_vectors <0, 0>, <1, 1>, <0, 1> } pigment { Squares } rotate 20*y translate <0.2, 2, 3> }
cylinder { -0.8*y, 0.8*y, 0.7 texture { uv_mapping pigment { checker rgb <0.2, 0.5, 0.8> rgb 0.9 } normal { gradient y 0.5 } scale 0.25 } translate <2.6, 1.6, 3> }
union { sphere { <4, 1.8, 3>, 0.6 } uv_mapping pigment { gradient x color_map { [0 rgb 1] [1 rgb <0.1, 0.5, 0.2>] } scale 0.2 } }

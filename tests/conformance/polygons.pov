// Polygons with holes, a star that crosses itself, and several loops, some turned and see-through.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.7, 0.75, 0.8> }
camera { location <0.4, 2.6, -8> look_at <0, 1, 0> angle 44 right x*4/3 }
light_source { <-4, 8, -9>, rgb 1 }
plane { y, 0 pigment { rgb <0.75, 0.7, 0.6> } }
polygon { 15, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1>, <-0.7, -0.6>, <0.1, -0.6>, <0.1, 0.5>, <-0.7, 0.5>, <-0.7, -0.6>,
  <0.3, -0.3>, <0.8, -0.3>, <0.8, 0.7>, <0.3, 0.1>, <0.3, -0.3>
  pigment { rgb <0.8, 0.4, 0.3> } finish { phong 0.3 } rotate <10, 20, 5> translate <-2.3, 1.2, 0> }
polygon { 6, <0, 1>, <0.5878, -0.8090>, <-0.9511, 0.3090>, <0.9511, 0.3090>, <-0.5878, -0.8090>, <0, 1>
  pigment { rgb <0.95, 0.8, 0.2> } scale 1.2 rotate <-15, -10, 0> translate <0.3, 1.4, 0.5> }
polygon { 9, <-1, -0.8>, <0, -0.2>, <1, -0.8>, <0.3, 0.1>, <1, 0.9>, <0, 0.3>, <-1, 0.9>, <-0.3, 0.1>, <-1, -0.8>
  pigment { rgbf <0.4, 0.7, 0.9, 0.5> } rotate <20, -40, 10> translate <2.4, 1.1, -0.2> }
polygon { 5, <0, 0, 0>, <1.5, 0.2, 0.5>, <1.7, 0.2, 1.6>, <0.2, 0, 1.1>, <0, 0, 0> pigment { checker rgb 1, rgb <0.2, 0.5, 0.3> scale 0.3 } translate <-0.6, 0.25, -2.3> }

// Prisms of Bezier curves: a letter with holes, one whose curve crosses itself, conic ones, one of them of two cones that meet, open ones.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.7, 0.75, 0.8> }
camera { location <0.6, 5, -8> look_at <0, 0.6, 0> angle 42 right x*4/3 }
light_source { <-4, 8, -9>, rgb 1 }
light_source { <6, 5, -4>, rgb 0.3 shadowless }
plane { y, 0 pigment { rgb <0.75, 0.7, 0.6> } }
prism {
  bezier_spline linear_sweep 0, 0.6, 28,
  <-0.8, -1.2>, <0, -1.2>, <0, -1.2>, <0.2, -1.2>, <0.2, -1.2>, <1.2, -1.2>, <1.2, 0>, <0.5, 0.1>, <0.5, 0.1>, <1.1, 0.3>, <0.9, 1.2>, <0.1, 1.2>, <0.1, 1.2>, <-0.2, 1.2>, <-0.6, 1.2>, <-0.8, 1.2>,
  <-0.8, 1.2>, <-0.8, 0.4>, <-0.8, -0.4>, <-0.8, -1.2>
  <-0.3, -0.8>, <0.7, -0.8>, <0.7, -0.1>, <-0.3, -0.1>, <-0.3, -0.1>, <-0.3, -0.3>, <-0.3, -0.6>, <-0.3, -0.8>
  pigment { rgb <0.8, 0.3, 0.25> } finish { phong 0.4 } rotate <-55, 15, 0> translate <-2.4, 1.2, 1> }
prism {
  bezier_spline 0, 0.4, 8, <0, -1>, <2.5, 1.6>, <-2.5, 1.6>, <0, -1>, <0, -1>, <0.5, -1.6>, <-0.5, -1.6>, <0, -1>
  pigment { rgb <0.3, 0.5, 0.8> } finish { phong 0.4 } rotate y*30 translate <-2, 0.1, -2> }
prism {
  bezier_spline 0, 0.4, 8, <-1, 0>, <2, 2>, <-2, 2>, <1, 0>, <1, 0>, <0.5, -1.2>, <-0.5, -1.2>, <-1, 0>
  pigment { rgb <0.9, 0.8, 0.3> } finish { phong 0.4 } rotate x*-30 translate <0.3, 0.6, -1.6> }
prism {
  bezier_spline conic_sweep -0.8, 1, 8, <1, 0>, <1, 1.3>, <-1, 1.3>, <-1, 0>, <-1, 0>, <-1, -0.6>, <1, -0.6>, <1, 0>
  pigment { rgb <0.4, 0.7, 0.35> } finish { phong 0.4 } rotate <20, 0, 25> translate <0.4, 1, 1.2> }
prism {
  bezier_spline conic_sweep 0.3, 1, 8, <1, 0>, <1, 1.3>, <-1, 1.3>, <-1, 0>, <-1, 0>, <-1, -0.6>, <1, -0.6>, <1, 0> open
  pigment { rgb <0.7, 0.4, 0.7> } finish { phong 0.4 } rotate <-25, 0, 0> scale <1, 1.4, 0.9> translate <2.6, 0, 1> }
difference {
  prism { bezier_spline 0, 0.9, 8, <1, 0>, <1, 1.3>, <-1, 1.3>, <-1, 0>, <-1, 0>, <-1, -1.3>, <1, -1.3>, <1, 0> }
  prism { bezier_spline -1, 2, 8, <1, 0>, <1, 1.3>, <-1, 1.3>, <-1, 0>, <-1, 0>, <-1, -1.3>, <1, -1.3>, <1, 0> scale <0.7, 1, 0.7> rotate x*20 translate <0.3, 0, 0> }
  pigment { rgb <0.85, 0.6, 0.4> } finish { phong 0.4 } translate <2.3, 0, -1.8> }

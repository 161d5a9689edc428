// Lathes of the four splines: sheets and solids, and parts cut out of solids.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -9> look_at <0, 0.6, 0> angle 40 }
light_source { <-4, 8, -8>, rgb 1 }
plane { y, -1.2 pigment { checker rgb 0.9, rgb 0.6 } }
#declare Finish = finish { ambient 0.2 diffuse 0.7 }
lathe { linear_spline 5, <0, -1>, <0.8, -0.6>, <0.3, 0.2>, <0.7, 0.9>, <0, 1.1> pigment { rgb <1, 0.5, 0.3> } finish { Finish } translate -2.7*x }
lathe { quadratic_spline 6, <0.3, -1.4>, <0.9, -1>, <0.3, -0.3>, <0.6, 0.4>, <0.2, 0.9>, <0.4, 1.3> pigment { rgb <0.4, 0.8, 0.4> } finish { Finish } rotate x*-25 translate -0.9*x }
lathe { cubic_spline 7, <0.5, -1.5>, <0, -1>, <0.8, -0.5>, <0.1, 0.2>, <0.5, 0.8>, <0, 1.2>, <0.5, 1> sturm pigment { rgb <0.4, 0.5, 1> } finish { Finish } rotate z*15 translate 0.9*x }
difference {
  lathe { bezier_spline 8, <0.4, -0.8>, <1, -0.9>, <1, 0.9>, <0.4, 0.8>, <0.4, 0.8>, <0.1, 0.6>, <0.7, -0.5>, <0.4, -0.8> }
  box { <0, -2, -2>, <2, 0.2, 0> }
  pigment { rgb <1, 0.8, 0.3> } finish { Finish } rotate y*30 translate 2.6*x
}
lathe { linear_spline 4, <0.2, 2>, <0.6, 2>, <0.6, 2.2>, <0.2, 2.4> pigment { rgb 0.8 } finish { Finish } rotate x*20 }

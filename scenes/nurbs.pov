// NURBS
//
// Equation: S(u, v) = Σ N_i(u) N_j(v) w_ij P_ij / Σ N_i(u) N_j(v) w_ij
//
// Surfaces of rational B-splines (`nurbs`): with weights they are exact spheres and tori, of arcs of parabolas with a weight in the middle, and knots that repeat
// join arcs to circles. The cloth is a B-spline without weights (`patch`), the roof a surface of straight lines (`bilinear`).

#include "stage.inc"
// A circle of four arcs, in the plane of y and of a radius: for each of its nine points a circle about the axis.
#macro Round(R, Y, W)
  <R, Y, 0, W>, <R, Y, R, W/sqrt(2)>, <0, Y, R, W>, <-R, Y, R, W/sqrt(2)>, <-R, Y, 0, W>, <-R, Y, -R, W/sqrt(2)>, <0, Y, -R, W>, <R, Y, -R, W/sqrt(2)>, <R, Y, 0, W>
#end
#declare H = 1/sqrt(2);
nurbs {
  degree 2, 2
  points 9, 9,
  Round(1, 0, 1), Round(1, 0.3, H), Round(0.7, 0.3, 1), Round(0.4, 0.3, H), Round(0.4, 0, 1), Round(0.4, -0.3, H), Round(0.7, -0.3, 1), Round(1, -0.3, H), Round(1, 0, 1)
  u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
  v_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
  texture { Gold }
  rotate x*-50 rotate y*-20 translate <-0.85, 1.02, 0.4>
}
nurbs {
  degree 2, 2
  points 9, 5, Round(0, -1, 1), Round(1, -1, H), Round(1, 0, 1), Round(1, 1, H), Round(0, 1, 1)
  u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
  v_knots 8, 0, 0, 0, 1, 1, 2, 2, 2
  texture { Clay }
  scale 0.42 translate <-0.6, 0.42, -0.9>
}
patch {
  b_spline 7, 6,
  <-1, 0.3, -1>, <0, 0.9, -1>, <1, 0.2, -1>, <2, 0.9, -1>, <3, 0.2, -1>, <4, 0.9, -1>, <5, 0.3, -1>
  <-1, 1.1, 0>, <0, 0.1, 0>, <1, 1.3, 0>, <2, 0.1, 0>, <3, 1.2, 0>, <4, 0.1, 0>, <5, 1.1, 0>
  <-1, 0.3, 1>, <0, 1.2, 1>, <1, 0.1, 1>, <2, 1.9, 1>, <3, 0.1, 1>, <4, 1.1, 1>, <5, 0.3, 1>
  <-1, 1.1, 2>, <0, 0.1, 2>, <1, 1.3, 2>, <2, 0.1, 2>, <3, 1.4, 2>, <4, 0.1, 2>, <5, 1.1, 2>
  <-1, 0.3, 3>, <0, 1.1, 3>, <1, 0.1, 3>, <2, 1.5, 3>, <3, 0.1, 3>, <4, 1.1, 3>, <5, 0.3, 3>
  <-1, 0.3, 4>, <0, 0.4, 4>, <1, 0.3, 4>, <2, 0.4, 4>, <3, 0.3, 4>, <4, 0.4, 4>, <5, 0.3, 4>
  texture { Moss }
  translate <-2, 0, -1.5> scale 0.42 rotate y*-25 translate <0.8, 0, -0.45>
}
bilinear { <0.3, 0.75, 1.6>, <1.6, 1.75, 1.5>, <1.75, 0.8, 0.3>, <0.55, 1.7, 0.5> texture { Slate } }

// Sweeps along curves
//
// Equation: S(u, v) = c(u) + size(u) (a(v) X(u) + b(v) Y(u))
//
// A profile moves along a curved path (`sweep`) and turns as little as it can: its frame is carried from knot to knot by double reflection. The band follows a
// trefoil knot, the horn grows and twists along a B-spline, and the beams of the frame meet in the planes that halve their corners.

#include "stage.inc"
#declare Knot = 24;
sweep {
  profile linear_spline 5, <-0.2, -0.06>, <0.2, -0.06>, <0.2, 0.06>, <-0.2, 0.06>, <-0.2, -0.06>
  path cubic_spline Knot + 3,
  #for (I, -1, Knot + 1)
    #local A = 2*pi*I/Knot;
    <sin(A) + 2*sin(2*A), cos(A) - 2*cos(2*A), -sin(3*A)>*0.3,
  #end
  twist 127.484 // brings the frame back to where it began
  texture { Gold }
  rotate x*20 rotate y*25 translate <-0.55, 1.05, 0.5>
}
sweep {
  profile bezier_spline 16, <1, 0>, <1, 1>, <0.4, 0.4>, <0, 1>, <0, 1>, <-0.4, 0.4>, <-1, 1>, <-1, 0>, <-1, 0>, <-1, -1>, <-0.4, -0.4>, <0, -1>,
    <0, -1>, <0.4, -0.4>, <1, -1>, <1, 0>
  path b_spline 7, <0, -0.5, 0>, <0, 0, 0>, <0.05, 0.5, 0>, <0.3, 1, 0.1>, <0.75, 1.2, 0>, <1.1, 0.9, -0.2>, <1.2, 0.5, -0.3>
  size 7, 0.36, 0.33, 0.28, 0.22, 0.15, 0.09, 0.05
  twist 300
  texture { Clay }
  translate <0.75, 0, 0.1>
}
sweep {
  profile linear_spline 5, <-0.09, -0.09>, <0.09, -0.09>, <0.09, 0.09>, <-0.09, 0.09>, <-0.09, -0.09>
  path linear_spline 4, <-0.5, 0.09, 0>, <-0.5, 0.8, 0>, <0.5, 0.8, 0>, <0.5, 0.09, 0>
  texture { Slate }
  rotate y*-20 translate <-0.15, 0, -0.9>
}

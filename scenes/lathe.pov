// Lathe
//
// Equation: x² + z² = r(w)²,  y = y(w)
//
// A profile of lines, parabolas or cubics, turned about the y axis (`lathe`). Where a ray passes the height y(w) is known for each w, so one polynomial of
// degree 6 at most is left, in w. A goblet whose Bezier profile has both ends on the axis, so that it is a solid and a quarter can be cut out of its bowl; a
// baluster of cubics; a bell of parabolas, a sheet; and two closed profiles, a ring of straight lines and one of parabolas.

#include "stage.inc"
#declare Goblet = lathe {
  bezier_spline 24,
  <0, 0>, <0.2, 0>, <0.4, 0>, <0.46, 0.02>,
  <0.46, 0.02>, <0.46, 0.07>, <0.09, 0.06>, <0.07, 0.16>,
  <0.07, 0.16>, <0.05, 0.4>, <0.05, 0.5>, <0.08, 0.6>,
  <0.08, 0.6>, <0.5, 0.66>, <0.62, 1.1>, <0.46, 1.5>,
  <0.46, 1.5>, <0.44, 1.53>, <0.43, 1.53>, <0.42, 1.5>,
  <0.42, 1.5>, <0.56, 1.1>, <0.45, 0.7>, <0, 0.68>
}
difference {
  object { Goblet }
  box { <0, 0.6, -1>, <1, 2, 0> }
  texture { Gold } rotate y*20 translate <-0.15, 0, -0.45>
}
lathe {
  cubic_spline 15,
  <0, -0.2>, <0, 0>, <0.38, 0>, <0.38, 0.12>, <0.2, 0.2>, <0.26, 0.3>, <0.12, 0.42>, <0.3, 0.8>, <0.12, 1.2>, <0.24, 1.3>, <0.16, 1.4>, <0.34, 1.5>,
  <0.34, 1.6>, <0, 1.6>, <0, 1.8>
  texture { Clay } translate <-1.15, 0, 0.75>
}
lathe {
  quadratic_spline 8, <0.02, 1.1>, <0, 1>, <0.22, 0.96>, <0.3, 0.8>, <0.34, 0.5>, <0.42, 0.3>, <0.62, 0.14>, <0.7, 0.1>
  texture { Slate } rotate x*72 translate <1.1, 0.62, 0.55>
}
lathe {
  linear_spline 7, <0.44, 0>, <0.62, 0.06>, <0.7, 0.24>, <0.62, 0.4>, <0.5, 0.34>, <0.4, 0.16>, <0.44, 0>
  texture { Moss } translate <0.95, 0, -0.75>
}
lathe {
  quadratic_spline 6, <0.18, 0>, <0.3, -0.1>, <0.42, 0>, <0.3, 0.1>, <0.18, 0>, <0.3, -0.1>
  texture { Slate } rotate x*-12 translate <-0.95, 0.18, -0.95>
}

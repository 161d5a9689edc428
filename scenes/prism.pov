// Prism
//
// Equation: (x, z) inside the outline,  a ≤ y ≤ b
// Equation: (x/y, z/y) inside the outline,  a ≤ y ≤ b
//
// Outlines swept along y: an L, a nut (an outline within another is a hole), a five-pointed star that crosses itself; below, the same outlines drawn
// together towards a point (`conic_sweep`). What outlines go round an odd number of times is inside. Walls and caps share one exact rule for
// rays through edges and corners, so the solids are closed. J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", 1983.

#include "stage.inc"
#declare S = 0.866;
prism {
  0, 0.55, 7, <0, 0>, <1.3, 0>, <1.3, 0.45>, <0.45, 0.45>, <0.45, 1.3>, <0, 1.3>, <0, 0>
  texture { Slate } rotate y*-20 translate <-1.75, 0, 0.1>
}
prism {
  linear_spline linear_sweep
  0, 0.35, 12,
  <1, 0>, <0.5, S>, <-0.5, S>, <-1, 0>, <-0.5, -S>, <0.5, -S>, <1, 0>
  <0.4, 0.4>, <-0.4, 0.4>, <-0.4, -0.4>, <0.4, -0.4>, <0.4, 0.4>
  texture { Gold } scale <0.62, 1, 0.62> rotate y*12 rotate x*-62 translate <0, 0.55, 1.4>
}
#declare Star = prism {
  conic_sweep
  0.35, 1, 6, <0, 1>, <0.588, -0.809>, <-0.951, 0.309>, <0.951, 0.309>, <-0.588, -0.809>, <0, 1>
}
object { Star texture { Clay } scale <0.75, 0.9, 0.75> rotate x*180 rotate y*20 translate <-0.35, 0.9, -0.55> }
prism {
  0, 0.3, 6, <0, 1>, <0.588, -0.809>, <-0.951, 0.309>, <0.951, 0.309>, <-0.588, -0.809>, <0, 1>
  texture { Moss } scale <0.6, 1, 0.6> rotate x*-75 rotate y*-25 translate <1.35, 0.5, 0.45>
}
difference {
  prism { conic_sweep 0, 1, 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> rotate x*180 translate y }
  prism { -1, 2, 4, <0, 0>, <2, -1>, <2, 1>, <0, 0> rotate y*30 }
  texture { Gold } scale <0.42, 0.75, 0.42> rotate y*25 translate <0.7, 0, -0.85>
}

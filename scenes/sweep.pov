// Sweep
//
// Equation: S(u, v) = c(u) + size(u) (a(v) X + b(v) Y),  c on a line, size linear
//
// Profiles moved along straight paths in any direction: an L-shaped beam that leans, a tube of hexagonal section, a heart of Bezier curves that grows
// along its path, and a spire that tapers. Each is the exact image of a prism or of a conic prism. J. T. Kajiya, "New techniques for ray tracing
// procedurally defined objects", 1983.

#include "stage.inc"
sweep {
  profile linear_spline 7, <0, 0>, <0.7, 0>, <0.7, 0.22>, <0.22, 0.22>, <0.22, 0.7>, <0, 0.7>, <0, 0>
  path linear_spline 2, <-2.2, 0, 0.9>, <-1.0, 1.65, 1.6>
  up y
  texture { Slate }
}
sweep {
  profile
    linear_spline 7, <1, 0>, <0.5, 0.866>, <-0.5, 0.866>, <-1, 0>, <-0.5, -0.866>, <0.5, -0.866>, <1, 0>,
    linear_spline 7, <0.7, 0>, <0.35, 0.606>, <-0.35, 0.606>, <-0.7, 0>, <-0.35, -0.606>, <0.35, -0.606>, <0.7, 0>
  path linear_spline 2, <-1.2, 0.45, 0.2>, <0.35, 0.45, -1.1>
  size 2, 0.45, 0.45
  up y
  texture { Gold }
}
sweep {
  profile bezier_spline 16,
    <0, -1>, <0.3, -0.55>, <1.1, -0.1>, <1.1, 0.45>,  <1.1, 0.45>, <1.1, 1.05>, <0.25, 1.1>, <0, 0.5>,
    <0, 0.5>, <-0.25, 1.1>, <-1.1, 1.05>, <-1.1, 0.45>,  <-1.1, 0.45>, <-1.1, -0.1>, <-0.3, -0.55>, <0, -1>
  path linear_spline 2, <0.3, 1.2, 1.9>, <0.15, 1.45, 0.6>
  size 2, 0.3, 0.75
  up y
  texture { Clay }
}
sweep {
  profile linear_spline 9, <1, 1>, <0, 0.4>, <-1, 1>, <-0.4, 0>, <-1, -1>, <0, -0.4>, <1, -1>, <0.4, 0>, <1, 1>
  path linear_spline 2, <1.5, 0, 0.1>, <1.35, 2, 0.3>
  size 2, 0.55, 0.02
  texture { Moss }
}

// Sphere sweep
//
// Equation: |p − c(u)| ≤ |r(u)|  for some u
//
// All balls whose centres and radii follow a spline (`sphere_sweep`): straight from each to the next, on a cubic through them, and near them on a B-spline. The
// surface is that of the union of all balls, so a sweep that meets itself has no skin inside, as the one that has been cut open shows.

#include "stage.inc"
sphere_sweep {
  linear_spline 5, <-1.75, 0.2, -0.5>, 0.2, <-1.4, 1.25, 0>, 0.1, <-1.1, 0.35, -0.35>, 0.22, <-0.75, 1.1, 0.1>, 0.08, <-0.5, 0.1, -0.2>, 0.1
  texture { Clay }
}
sphere_sweep {
  cubic_spline 9, <-1.2, 0, 2>, 0, <-0.9, 0.12, 1.3>, 0, <-0.2, 0.5, 0.75>, 0.2, <0.45, 0.95, 1.05>, 0.27, <0.3, 1.35, 1.5>, 0.16,
  <-0.1, 1.05, 1.2>, 0.14, <0.35, 0.6, 0.75>, 0.18, <1.1, 0.18, 1.05>, 0, <2, 0, 2>, 0
  texture { Gold }
}
difference {
  sphere_sweep {
    b_spline 9, <0.2, 0.42, 0.4>, 0.12, <0.85, 0.42, 0.4>, 0.22, <1.3, 0.42, 0.0>, 0.25, <0.9, 0.42, -0.65>, 0.27, <0.3, 0.42, -0.5>, 0.25,
    <0.3, 0.42, 0.1>, 0.22, <1.0, 0.42, 0.2>, 0.2, <1.5, 0.42, -0.2>, 0.15, <1.7, 0.42, -0.9>, 0.1
  }
  plane { -y, -0.45 }
  texture { Moss }
}

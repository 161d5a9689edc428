// Curved prism
//
// Equation: (x, z) inside the curves,  a ≤ y ≤ b
// Equation: (x/y, z/y) inside the curves,  a ≤ y ≤ b
//
// Outlines of cubic curves swept along y: a heart of Bezier curves, a ring of parabolas with a hole (`quadratic_spline`), a tile of Catmull-Rom cubics
// (`cubic_spline`); in front, curves drawn together towards a point (`conic_sweep`): a bowl, `open`, and a solid from which another is taken. A ray meets
// a curved wall where a cubic vanishes; caps and walls are decided by the same exact signs, so the solids are closed.
// J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", 1983; J. J. van Wijk, "Ray tracing objects defined by sweeping planar cubic splines", 1984.

#include "stage.inc"
prism {
  bezier_spline
  0, 0.4, 16,
  <0, -1>, <0.3, -0.55>, <1.1, -0.1>, <1.1, 0.45>,  <1.1, 0.45>, <1.1, 1.05>, <0.25, 1.1>, <0, 0.5>,
  <0, 0.5>, <-0.25, 1.1>, <-1.1, 1.05>, <-1.1, 0.45>,  <-1.1, 0.45>, <-1.1, -0.1>, <-0.3, -0.55>, <0, -1>
  texture { Clay } scale <0.85, 1, 0.85> rotate x*-70 rotate y*-14 translate <-1.15, 0.9, 1.1>
}
prism {
  quadratic_spline
  0, 0.5, 14,
  <-0.6, -0.8>, <0.6, -0.8>, <1, 0>, <0.6, 0.8>, <-0.6, 0.8>, <-1, 0>, <-0.6, -0.8>, <0.6, -0.8>
  <-0.3, 0.3>, <0.3, 0.3>, <0.3, -0.3>, <-0.3, -0.3>, <-0.3, 0.3>, <0.3, 0.3>
  texture { Slate } scale <0.75, 1, 0.75> rotate y*30 translate <1.25, 0, 0.9>
}
prism {
  cubic_spline
  0, 0.25, 11,
  <-1, 0.3>, <-1.2, 0>, <-0.5, 0.42>, <0.2, 0.28>, <0.6, 0.5>, <1.2, 0>, <0.6, -0.45>, <0.1, -0.3>, <-0.5, -0.42>, <-1.2, 0>, <-1, -0.3>
  texture { Moss } scale <0.7, 1, 0.9> rotate y*20 translate <-1.6, 0, -0.65>
}
#declare Round = prism {
  cubic_spline conic_sweep
  0, 1, 11,
  <1, 0>, <0.5, 0.5>, <0, 1>, <-0.5, 0.5>, <-1, 0>, <-0.5, -0.5>, <0, -1>, <0.5, -0.5>, <1, 0>, <0.5, 0.5>, <0, 1>
}
difference {
  object { Round rotate x*180 translate y }
  prism { bezier_spline -1, 1, 8, <0.75, 0>, <0.75, 0.45>, <-0.2, 0.45>, <-0.2, 0>, <-0.2, 0>, <-0.2, -0.45>, <0.75, -0.45>, <0.75, 0> rotate x*-90 translate 0.4*y }
  texture { Gold } scale <0.6, 1.1, 0.6> rotate y*35 translate <0.1, 0, -0.3>
}
prism {
  quadratic_spline conic_sweep
  0.35, 1, 8, <0, -1>, <0.9, -0.4>, <0.9, 0.4>, <0, 0.9>, <-0.9, 0.4>, <-0.9, -0.4>, <0, -1>, <0.9, -0.4>
  open
  texture { Clay } scale <0.5, 0.8, 0.5> rotate y*-15 translate <1.15, -0.28, -0.75>
}

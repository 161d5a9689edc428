// Noise
//
// Equation: |p| - r + a n(k p) = 0
// Equation: y - h R(x, z) = 0
//
// A stone, which is a ball with two octaves of lattice noise; and mountains of four octaves of F. K. Musgrave's ridged multifractal.

#include "stage.inc"
#include "functions.inc"
isosurface {
  function { f_sphere(x, y, z, 0.78) + 0.5*(f_noise3d(2*x, 2*y, 2*z) - 0.5) + 0.14*(f_noise3d(6*x, 6*y, 6*z) - 0.5) }
  contained_by { sphere { 0, 1.1 } }
  max_gradient 3
  translate <-0.7, 0.8, 1.1>
  texture { Clay }
}
isosurface {
  function { y - 0.45*f_ridged_mf(1.3*x + 1.6, 0, 1.3*z + 0.3, 1, 2.1, 4, 0.9, 2, 2) }
  contained_by { box { <-1, -0.05, -0.8>, <1, 0.7, 0.8> } }
  max_gradient 6
  rotate -25*y translate <0.6, 0.051, -0.5>
  texture { Slate }
}

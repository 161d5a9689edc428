// Julia sets
//
// Equation: |z_n| ≤ R for n = 0 … N − 1,  z_(n+1) = z_n² + c,  z_0 = (x, y, z, w) in the slice
//
// One of A. Norton's quaternion Julia sets of 1982, as the solid whose points stay within R = 1 + |c| for eight steps.

#include "stage.inc"
julia_fractal {
  <-0.083, 0, -0.83, -0.025>
  quaternion sqr
  max_iteration 8
  precision 15
  rotate <0, 30, 0> scale 0.75 translate <0, 0.85, 0.3>
  texture { Clay }
}

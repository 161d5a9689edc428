// Hyperbolic cylinder
//
// Equation: x²/a² − y²/b² = 1
//
// Two endless troughs back to back, here cut to size by a box.

#include "stage.inc"
hyperbolic_cylinder { <0.3, 0.35>
  clipped_by { box { <-1.1, -1.1, -1>, <1.1, 1.1, 1> } }
  rotate <0, 0, 90> rotate y*35 translate y*1.12 texture { Moss } }

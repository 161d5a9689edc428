// Hyperbolic paraboloid
//
// Equation: x²/a² − y²/b² = z/c
//
// The saddle, cut out of the endless surface by a cylinder. Two families of straight lines lie in it.

#include "stage.inc"
hyperbolic_paraboloid { <1, 1, 0.75>
  clipped_by { cylinder { -3*z, 3*z, 1.15 } }
  rotate x*-90 rotate y*20 translate y*1.1 texture { Gold } }

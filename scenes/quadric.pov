// General quadric
//
// Equation: A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J = 0
//
// Ten coefficients, whatever surface they make; here an oblique ellipsoid and a hyperboloid with mixed terms, cut by a
// ball.

#include "stage.inc"
quadric { <2.2, 3, 2.4>, <1.6, -0.9, 0.8>, <0, 0, 0>, -1 translate <-0.7, 0.72, 0.4> texture { Slate } }
quadric { <1, -0.7, 1>, <0.5, 0.3, -0.4>, <0.1, 0, 0>, -0.05 clipped_by { sphere { 0, 0.75 } } translate <0.7, 0.76, -0.4> texture { Gold } }

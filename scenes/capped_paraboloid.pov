// Capped paraboloid
//
// Equation: x²/a² + y²/b² ≤ z/c, z ≤ z₂
//
// A bowl filled to the brim.

#include "stage.inc"
paraboloid { <0.8, 0.8, 0.9> from 0 to 1.2 rotate x*-90 translate <-0.3, 0.001, 0.3> texture { Moss } }
paraboloid { <0.6, 0.45, 0.9> from 0 to 0.8 rotate x*90 translate <0.8, 0.8, -0.7> texture { Clay } }

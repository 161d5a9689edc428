// Elliptic paraboloid
//
// Equation: x²/a² + y²/b² = z/c
//
// A bowl that is wider one way, open at the rim. Without `open` it would be closed by a flat lid.

#include "stage.inc"
paraboloid { <0.85, 0.55, 1> from 0 to 1.7 open rotate x*-90 rotate <0, 25, 0> translate y*0.03 texture { Clay } }

// Ellipsoid
//
// Equation: x²/a² + y²/b² + z²/c² = 1
//
// Three different semi-axes. Pebbles in a pile.

#include "stage.inc"
ellipsoid { <1.2, 0.75, 0.5> rotate x*-90 rotate <4, 20, 3> translate <0, 0.52, 0.1> texture { Slate } }
ellipsoid { <0.85, 0.6, 0.36> rotate x*-90 rotate <-6, -25, 9> translate <0.05, 1.36, 0.15> texture { Clay } }
ellipsoid { <0.5, 0.36, 0.24> rotate x*-90 rotate <0, 40, -5> translate <-0.05, 1.94, 0.15> texture { Gold } }
ellipsoid { <0.35, 0.25, 0.15> rotate x*-90 rotate y*60 translate <1, 0.15, -0.9> texture { Moss } }

// Elliptic and circular cone
//
// Equation: x²/a² + y²/b² = z²/c²
//
// Both halves of the double cone, up to two planes; the small one is a common cone with an apex.

#include "stage.inc"
elliptic_cone { <0.75, 0.45, 1> from -1 to 1 open rotate x*-90 rotate y*25 translate <-0.15, 1.02, 0.3> texture { Slate } }
cone { <0.85, 0.001, -0.8>, 0.42, <0.85, 0.9, -0.8>, 0 texture { Clay } }

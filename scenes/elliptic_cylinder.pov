// Elliptic cylinder
//
// Equation: x²/a² + y²/b² = 1
//
// Pillars of oval section, one of them a pipe.

#include "stage.inc"
elliptic_cylinder { <0.75, 0.4> from 0 to 1.9 rotate x*-90 rotate y*30 translate <-0.45, 0, 0.4> texture { Slate } }
elliptic_cylinder { <0.5, 0.3> from 0 to 0.8 open rotate x*-90 rotate y*-15 translate <0.75, 0, -0.6> texture { Clay } }

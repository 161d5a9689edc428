// Spheroid
//
// Equation: (x² + y²)/a² + z²/c² = 1
//
// An ellipse turned about an axis: flattened like the earth, or long like a rugby ball.

#include "stage.inc"
spheroid { 1, 0.6 rotate x*-90 rotate z*12 translate <-0.45, 0.66, 0.5> texture { Slate } }
spheroid { 0.42, 0.85 rotate <-20, 65, 0> translate <0.65, 0.47, -0.75> texture { Clay } }

// Spheroid
//
// Equation: (x² + y²)/a² + z²/c² = 1
//
// An ellipse turned about an axis: flattened like the earth, or long like a rugby ball.

#include "stage.inc"
spheroid { 0.85, 0.5 rotate x*-90 rotate z*12 translate <-0.55, 0.56, 0.7> texture { Slate } }
spheroid { 0.42, 0.85 rotate <-20, 65, 0> translate <0.6, 0.52, -0.75> texture { Clay } }

// Clipped by a solid
//
// Equation: { p on S : p inside C }
//
// What lies outside the clipping solids is taken away, and nothing closes the hole.

#include "stage.inc"
sphere { 0, 1 clipped_by { box { <-2, -2, -0.3>, <2, 0.55, 2> rotate <12, 20, 0> } } translate <-0.2, 1, 0.3> texture { Slate } }
sphere { 0, 0.72 clipped_by { plane { <-0.3, 1, -1>, 0.25 } } translate <-0.2, 1, 0.3> texture { Gold } }
cylinder { -y, y, 0.36 open clipped_by { sphere { <0.3, 0, 0>, 0.62 } } translate <0.95, 0.62, -0.7> texture { Clay } }

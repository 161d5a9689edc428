// Box
//
// Equation: a ≤ p ≤ b, in each coordinate
//
// Between two corners, its faces along the axes; then turned, sheared and stretched by its transforms.

#include "stage.inc"
box { <-0.55, 0.001, -0.55>, <0.55, 1.1, 0.55> texture { Slate } rotate y*20 translate <-0.35, 0, 0.4> }
box { -0.32, 0.32 texture { Clay } rotate <45, 0, 0> rotate z*35.2644 rotate y*20 translate <-0.35, 1.66, 0.4> }
box { 0, 1 texture { Gold } matrix <0.8, 0, 0.1, 0.3, 0.45, 0, 0, 0, 0.5, 0.55, 0.001, -0.75> }

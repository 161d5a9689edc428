// Circular cylinder
//
// Equation: x² + y² = r²
//
// Unbounded: three endless beams pass each other.

#include "stage.inc"
circular_cylinder { 0.28 rotate x*-90 translate <-0.6, 0, 0.5> texture { Slate } }
circular_cylinder { 0.28 rotate y*90 translate <0, 0.55, -0.15> texture { Clay } }
circular_cylinder { 0.28 rotate y*-20 translate <0.5, 1.25, 0> texture { Gold } }

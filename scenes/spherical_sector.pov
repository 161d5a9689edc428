// Spherical sector
//
// Equation: |p − c| ≤ r, (p − c) · n ≥ |p − c| cos α
//
// The part of a ball around an axis: a cone with a round lid, up to half a ball.

#include "stage.inc"
spherical_sector { <-0.55, 0.05, 0.4>, 1.5, y, 28 texture { Clay } }
spherical_sector { <0.65, 0.65, -0.5>, 0.65, <-0.5, 0.4, 1>, 55 texture { Slate } }

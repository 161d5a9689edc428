// Capped cylinder
//
// Equation: x² + y² = r², z₁ ≤ z ≤ z₂, and two discs
//
// The solid between its two ends, rims closed.

#include "stage.inc"
cylinder { <-0.4, 0.001, 0.4>, <-0.4, 1.5, 0.4>, 0.55 texture { Slate } }
cylinder { <0.2, 0.32, -0.7>, <1.2, 0.32, -0.2>, 0.32 texture { Clay } }
cylinder { <-1.15, 0.2, -0.9>, <-0.45, 0.2, -1.1>, 0.2 texture { Gold } }

// Triangle
//
// Equation: p = (1 − b₁ − b₂) v₀ + b₁ v₁ + b₂ v₂,  0 ≤ b₁, b₂, b₁ + b₂ ≤ 1
//
// Flat, and smooth: the second has a normal at each corner, interpolated over its face, so that it seems to bulge.

#include "stage.inc"
triangle { <-1.3, 0.05, 0.2>, <0.1, 0.15, 0.5>, <-0.75, 1.9, 0.45> texture { Clay } }
smooth_triangle { <0, 0.05, -0.35>, <-0.9, -0.2, -0.6>, <1.45, 0.15, -0.15>, <0.9, -0.2, -0.6>, <0.7, 1.75, -0.1>, <0, 0.9, -0.5> texture { Slate } }
triangle { <-0.7, 0.02, -1.4>, <0.5, 0.02, -1.5>, <-0.2, 0.6, -1.2> texture { Gold } }

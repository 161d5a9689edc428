// Frustum
//
// Equation: √(x² + y²) = r₁ + (r₂ − r₁)(z − z₁)/(z₂ − z₁), z₁ ≤ z ≤ z₂, and two discs
//
// A cone between two radii, closed.

#include "stage.inc"
cone { <-0.45, 0.001, 0.35>, 0.8, <-0.45, 1.5, 0.35>, 0.35 texture { Clay } }
cone { <0.85, 0.001, -0.45>, 0.22, <0.85, 0.95, -0.45>, 0.45 texture { Slate } }

// Lemon
//
// Equation: (√(x² + z²) + R)² + (y − c)² = r²,  0 ≤ y ≤ h
//
// The spindle: an arc from one end of an axis to the other, turned about that axis (`lemon`). With points for ends, with discs, leaning, open like a barrel without
// lids, and a slice: the inner sheet of a torus that meets itself, cut off by planes.

#include "stage.inc"
lemon { <-1.35, 0.62, 0.5>, 0, <0.15, 0.75, 0.9>, 0, 1.0 texture { Gold } }
lemon { <-0.75, 0, -0.75>, 0.3, <-0.75, 0.95, -0.75>, 0.22, 0.8 texture { Clay } }
lemon { <0.95, 0, 0.5>, 0.36, <0.95, 1.3, 0.5>, 0.36, 1.4 open texture { Slate } }
difference {
  lemon { <-0.75, 0, 0>, 0, <0.75, 0, 0>, 0.1, 1.05 }
  box { <0.1, -1, -1>, <0.35, 1, 1> }
  plane { y, -0.28 }
  texture { Moss } rotate y*30 translate <0.65, 0.28, -1.05>
}

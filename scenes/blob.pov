// Blob
//
// Equation: sum of S max(0, 1 − d²/R²)² = T
//
// A molecule of four balls, a jack of three sausages, and a pebble with a dent, where the strength is negative.

#include "stage.inc"
blob {
  threshold 0.6
  sphere { <0, 0.62, 0>, 0.75, 1 }
  sphere { <0.55, 0.35, 0.1>, 0.55, 1 }
  sphere { <-0.5, 0.4, 0.25>, 0.55, 1 }
  sphere { <0, 1.15, 0.1>, 0.5, 1 }
  translate <-0.75, 0.1, 0.55>
  texture { Clay }
}
blob {
  threshold 0.5
  cylinder { <-0.5, 0, 0>, <0.5, 0, 0>, 0.28, 1 }
  cylinder { <0, -0.5, 0>, <0, 0.5, 0>, 0.28, 1 }
  cylinder { <0, 0, -0.5>, <0, 0, 0.5>, 0.28, 1 }
  rotate <35, 20, 15>
  translate <0.95, 0.55, 0.55>
  texture { Gold }
}
blob {
  threshold 0.4
  sphere { 0, 0.8, 1.2 scale <1, 0.7, 1> }
  sphere { <0.1, 0.42, -0.25>, 0.45, -2 }
  translate <0.25, 0.4, -1.15>
  texture { Slate }
}

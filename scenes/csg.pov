// Solids of solids
//
// Equation: (A & B) - C - D - E
//
// A cube and a ball have the rounded cube in common, and three cylinders are taken out of it. Where surfaces meet there is one edge, and no skin is
// left of what was taken away: crossings whose enclosures overlap change the whole expression at once. S. D. Roth, "Ray casting for modeling
// solids", Computer Graphics and Image Processing 18, 1982.

#include "stage.inc"
difference {
  intersection { box { -1, 1 texture { Slate } } sphere { 0, 1.36 texture { Clay } } }
  cylinder { -2*x, 2*x, 0.62 }
  cylinder { -2*y, 2*y, 0.62 }
  cylinder { -2*z, 2*z, 0.62 }
  texture { Gold }
  rotate <0, 28, 0> scale 0.95 translate <-0.1, 0.97, 0.3>
}
merge { sphere { <-0.2, 0, 0>, 0.34 } sphere { <0.2, 0, 0>, 0.34 } cone { 0, 0.3, 0.75*y, 0 } texture { Moss } rotate <0, -30, 0> translate <1.25, 0.34, -1.3> }

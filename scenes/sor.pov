// Surface of revolution
//
// Equation: x² + z² = a₀ + a₁ y + a₂ y² + a₃ y³  between each two points
//
// A curve through points, turned about the y axis (`sor`): the square of the radius is a cubic of the height, and so is the surface along a ray. A
// vase that is `open`, a pawn, a bowl that a ball is taken out of, a spinning top. At the heights of the points, where one cubic takes over from
// another, a ray is inside or outside by exact signs, so seams neither leak nor count twice.

#include "stage.inc"
#declare Vase = sor {
  9, <0.2, -0.1>, <0.34, 0>, <0.55, 0.35>, <0.6, 0.7>, <0.34, 1.15>, <0.2, 1.4>, <0.24, 1.6>, <0.42, 1.75>, <0.6, 1.8>
  open
}
object { Vase texture { Slate } translate <-1.05, 0, 0.75> }
sor {
  10, <0.4, -0.1>, <0.42, 0>, <0.42, 0.12>, <0.3, 0.22>, <0.16, 0.5>, <0.14, 0.78>, <0.28, 0.84>, <0.14, 0.92>, <0.15, 1>, <0.2, 1.1>
  texture { Gold } translate <0.25, 0, 0.35>
}
sphere { <0.25, 1.14, 0.35>, 0.24 texture { Gold } }
difference {
  sor { 6, <0, -0.2>, <0.12, 0>, <0.5, 0.2>, <0.72, 0.5>, <0.8, 0.75>, <0.8, 1> }
  sphere { <0, 0.95, 0>, 0.72 }
  texture { Clay } translate <-0.6, 0, -1>
}
sor {
  7, <0, -0.2>, <0, 0>, <0.2, 0.2>, <0.55, 0.45>, <0.12, 0.7>, <0.08, 1>, <0.08, 1.2>
  texture { Moss } rotate z*-28 translate <1.05, 0.06, -0.7>
}

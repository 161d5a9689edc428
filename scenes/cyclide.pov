// Cyclide
//
// Equation: (x^2 + y^2 + z^2 - b^2 - d^2)^2 + 4 b^2 y^2 = 4 (a d - c x)^2, b^2 = a^2 - c^2
//
// Two rings, thick on one side; a horn, whose two crescents meet in two points; a spindle cut open: C. Dupin's surfaces, all of whose lines of curvature are circles.

#include "stage.inc"
cyclide { 0.62, 0.2, 0.27 texture { Gold } rotate x*-80 rotate y*-20 translate <-0.75, 0.98, 0.75> }
cyclide { 0.55, 0.3, 0.16 texture { Clay } rotate y*150 translate <0.72, 0.46, 0.5> }
cyclide { 0.36, 0.16, 0.24 texture { Moss } rotate y*-60 translate <-0.62, 0.4, -0.95> }
difference {
  cyclide { 0.16, 0.07, 0.34 }
  box { <-2, 0, -2>, <2, 2, 2> rotate x*-20 }
  texture { Slate }
  rotate y*-35
  translate <0.62, 0.41, -1.0>
}

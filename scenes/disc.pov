// Disc
//
// Equation: (p − c) · n = 0,  |p − c| ≤ r
//
// Flat and round, seen from either side. Three discs share a centre and cut each other.

#include "stage.inc"
union {
  disc { 0, x, 1 texture { Clay } }
  disc { 0, y, 1 texture { Slate } }
  disc { 0, z, 1 texture { Gold } }
  rotate <-28, 20, 25> translate y*1.15 }

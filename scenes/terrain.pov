// Terrain
//
// Equation: h at a new point = (h_a + h_b)/2 + B 2^(-H (l-1)) (2 r - 1), level by level; r a hash of the point's place
//
// A. Fournier, D. Fussell, L. Carpenter, "Computer rendering of stochastic models", Communications of the ACM 25(6), 1982
// J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", ACM Transactions on Graphics 2(3), 1983
//
// Eight million triangles, none of which is stored, and a lake.

#include "stage.inc"
union {
  terrain { levels 11 roughness 0.9 amplitude 0.32 seed 7 corners <0.1, 0.35, 0.6, 0.3> water_level 0.2 texture { Moss } }
  polygon { 5, <0, 0.2, 0>, <1, 0.2, 0>, <1, 0.2, 1>, <0, 0.2, 1>, <0, 0.2, 0> texture { Slate } }
  translate <-0.5, 0, -0.5>
  scale <3.2, 2, 3.2>
  rotate y*25
  translate <0, 0.05, 0.3>
}

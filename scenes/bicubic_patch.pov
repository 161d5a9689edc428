// Bicubic patch
//
// Equation: S(u, v) = Σ B_i(u) B_j(v) P_ij,  B_i(u) = (3 over i) u^i (1 − u)^(3−i)
//
// A surface over the unit square that 16 control points draw after them (`bicubic_patch`): a sail over its corners, and a shell of four patches whose edges meet
// in one point at the top. Where a patch ends in a point its normal is still defined. No patch is made of triangles, at any distance.

#include "stage.inc"
bicubic_patch {
  type 1 flatness 0.01 u_steps 5 v_steps 5
  <-1.9, 0, 0.2>, <-1.4, 0.9, 0.6>, <-0.9, 0.9, 0.2>, <-0.5, 0, 0.9>
  <-1.7, 0.5, 0.7>, <-1.3, 2.6, 0.9>, <-0.9, 0.2, 0.9>, <-0.2, 0.9, 1.1>
  <-1.6, 0.5, 1.2>, <-1.2, 0.1, 1.4>, <-0.8, 2.4, 1.4>, <-0.1, 0.9, 1.5>
  <-1.7, 0, 2.0>, <-1.2, 0.8, 2.0>, <-0.6, 0.8, 1.9>, <0, 0.1, 2.1>
  texture { Gold }
}
// A quarter of a shell: its rows go up, and the last is one point.
#declare K = 0.5523;
#declare Quarter = bicubic_patch {
  type 1 flatness 0.01 u_steps 5 v_steps 5
  <0.45, 0, 0>, <0.45, 0, 0.45*K>, <0.45*K, 0, 0.45>, <0, 0, 0.45>
  <1.3, 0.5, 0>, <1.3, 0.5, 1.3*K>, <1.3*K, 0.5, 1.3>, <0, 0.5, 1.3>
  <0.55, 1.5, 0>, <0.55, 1.5, 0.55*K>, <0.55*K, 1.5, 0.55>, <0, 1.5, 0.55>
  <0, 1.5, 0>, <0, 1.5, 0>, <0, 1.5, 0>, <0, 1.5, 0>
}
union {
  object { Quarter }
  object { Quarter rotate y*90 }
  object { Quarter rotate y*180 }
  object { Quarter rotate y*270 }
  texture { Clay }
  translate <0.75, 0, -0.1>
}

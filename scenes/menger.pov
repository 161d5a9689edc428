// Menger sponge
//
// Equation: A_N = ∪ (A_(N−1) + k) / 3,  k ∈ {−2, 0, 2}³ with at most one 0
//
// The sponge of K. Menger (1926), four times refined: 160 000 cubes, of which none is stored (`ifs { menger 4 }`). The one behind is cut across its diagonal, where
// the holes are stars; the cubes' common faces leave no skin in the cut.

#include "stage.inc"
ifs { menger 4 scale 0.62 rotate y*38 translate <-0.75, 0.63, -0.6> texture { Gold } }
difference {
  ifs { menger 4 }
  plane { <-1, -1, 1>, 0 }
  scale 0.85 rotate y*25 translate <0.75, 0.86, 0.75> texture { Clay }
}

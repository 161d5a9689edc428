// Sierpinski tetrahedron
//
// Equation: A_N = ∪ (A_(N−1) + v) / 2,  v one of four corners
//
// W. Sierpinski's triangle (1915) in space (`ifs { sierpinski 7 }`): each step keeps half of the volume and all of the surface's area. Its 16 384 tetrahedra
// touch at corners only, which rays pass in one point. To the left, the maps of a sponge with balls for leaves.

#include "stage.inc"
ifs {
  sierpinski 7
  matrix <0.4082482904638631, 0.5773502691896258, 0.7071067811865475, 0.4082482904638631, 0.5773502691896258, -0.7071067811865475,
          -0.8164965809277261, 0.5773502691896258, 0, 0, 0, 0>
  rotate y*10 translate <0.25, 0.578, 0.6> texture { Clay }
}
ifs {
  sphere { 0, 1 }
  map { scale 1/3 translate x*2/3 } map { scale 1/3 translate -x*2/3 } map { scale 1/3 translate y*2/3 }
  map { scale 1/3 translate -y*2/3 } map { scale 1/3 translate z*2/3 } map { scale 1/3 translate -z*2/3 } map { scale 1/3 }
  depth 3
  rotate y*25 scale 0.5 translate <-1.25, 0.5, -0.7> texture { Slate }
}

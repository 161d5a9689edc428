// Fern
//
// Equation: A_N = ∪ M_i A_(N−1),  four maps M_i
//
// M. F. Barnsley's fern (1988) in space: a stem, a frond that bends on, and one to each side, to depth 18 with balls for leaves (`ifs`). Of the 4^18 copies none is
// stored: each ray unfolds those that it may meet.

#include "stage.inc"
#declare Fern = ifs {
  sphere { <0, 5, 0>, 5 }
  map { scale <0.03, 0.2, 0.03> }
  map { scale <0.85, 0.85, 0.75> rotate <6, 0, -2.5> translate y*1.6 }
  map { scale <0.34, 0.36, 0.26> rotate <0, 20, 49> translate y*1.5 }
  map { scale <0.34, 0.36, 0.26> rotate <0, -20, -49> translate y*0.9 }
  depth 18
  texture { Moss }
}
object { Fern scale 0.24 rotate <-8, 15, 8> translate <-0.1, 0, 0.5> }
object { Fern scale 0.2 rotate <10, 60, 30> translate <-0.2, 0, 0.35> }
object { Fern scale 0.2 rotate <-20, -30, -25> translate <0.05, 0, 0.35> }

// Capsule
//
// Equation: |p − (A + u (B − A))| ≤ r  for some u from 0 to 1
//
// All points within a radius of a line between two points (`capsule`): a cylinder with round ends. A bundle of rods, one that has been cut open along its length, and a
// pill of two halves.

#include "stage.inc"
#declare Rod = capsule { <-0.7, 0, 0>, <0.7, 0, 0>, 0.16 }
object { Rod texture { Clay } rotate y*25 translate <-0.8, 0.16, 0.55> }
object { Rod texture { Gold } rotate y*-30 translate <-0.75, 0.48, 0.55> }
object { Rod texture { Moss } rotate y*80 translate <-0.75, 0.8, 0.5> }
difference {
  capsule { <0.35, 0.3, 0.75>, <1.35, 0.9, 0.5>, 0.3 }
  capsule { <0.35, 0.3, 0.75>, <1.35, 0.9, 0.5>, 0.22 }
  plane { z, 0 rotate x*25 translate <0, 0.6, 0.55> }
  texture { Slate }
}
intersection {
  capsule { <-0.25, 0.22, -0.75>, <0.4, 0.22, -0.95>, 0.22 }
  plane { x, 0 rotate y*17 translate <0.075, 0, -0.85> }
  texture { Gold }
}
intersection {
  capsule { <-0.25, 0.22, -0.75>, <0.4, 0.22, -0.95>, 0.22 }
  plane { -x, 0 rotate y*17 translate <0.075, 0, -0.85> }
  texture { Clay }
}

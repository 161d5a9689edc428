// Annulus
//
// Equation: (p − c) · n = 0,  r₁ ≤ |p − c| ≤ r₂
//
// A disc with a hole: the rings of a gyroscope.

#include "stage.inc"
#for (I, 0, 4)
  annulus { 0, vrotate(y, <I*36, 0, 18*I>), 1.1-0.17*I, 0.98-0.17*I
    #switch (mod(I, 3)) #case (0) texture { Gold } #break #case (1) texture { Slate } #break #else texture { Clay } #end
    rotate y*25 translate y*1.2 }
#end
sphere { y*1.2, 0.24 texture { Clay } }

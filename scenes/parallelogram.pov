// Parallelogram
//
// Equation: p = p₀ + a u + b v,  0 ≤ a, b ≤ 1
//
// A corner and two edges. A fan of them makes a stair without thickness.

#include "stage.inc"
#for (I, 0, 8)
  parallelogram { <0, 0.12+0.22*I, 0>, vrotate(<1.2, 0, -0.1>, y*-40*I), vrotate(<0.12, 0, 0.45>, y*-40*I)
    #if (mod(I, 2)) texture { Slate } #else texture { Clay } #end }
#end
cylinder { 0, y*2.1, 0.05 texture { Gold } }

// Sierpinski tetrahedron
//
// Equation: A_N = ∪ (A_(N−1) + v) / 2,  v the four corners
//
// W. Sierpinski's triangle (1915) in space: half of the volume is left at each of seven steps, all of the surface's area always (`ifs { sierpinski 7 }`). In front
// the same maps with balls and boxes for leaves.

#include "stage.inc"
#declare Upright = transform { rotate x*-45 rotate z*-35.2643896827547 rotate z*90 }
#declare Half = transform { scale 0.5 }
ifs { sierpinski 7 transform { Upright } scale 1.1 rotate y*20 translate <0, 0.37, 0.5> texture { Clay } }

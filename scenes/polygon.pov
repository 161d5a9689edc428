// Polygon
//
// Equation: (p − p₀) · n = 0,  p inside an odd number of loops
//
// Several loops in one plane: what lies inside an odd number of them is surface. A star that crosses itself has a
// hole, and so has a frame.

#include "stage.inc"
#declare P = array[5]
#for (I, 0, 4) #declare P[I] = <sin(2*pi*I*2/5), cos(2*pi*I*2/5)>; #end
polygon { 6, P[0], P[1], P[2], P[3], P[4], P[0] texture { Gold } rotate <8, 20, 0> translate <-0.5, 1.12, 0.6> }
polygon { 15, <-0.7, 0>, <0.7, 0>, <0.7, 1>, <-0.7, 1>, <-0.7, 0>,  <-0.5, 0.15>, <-0.1, 0.15>, <-0.1, 0.85>, <-0.5, 0.85>, <-0.5, 0.15>,
  <0.1, 0.15>, <0.5, 0.15>, <0.5, 0.5>, <0.3, 0.85>, <0.1, 0.15> texture { Slate } rotate <14, -25, 0> scale 0.85 translate <0.75, 0.02, -0.7> }

// Torus
//
// Equation: (x² + y² + z² − R² − r²)² + 4R² (y² − r²) = 0
//
// A ring on edge, a ring lying flat, a horn (r = R), a spindle (r > R), and an elliptic ring, stretched along one axis.

#include "stage.inc"
torus { 0.62, 0.2 texture { Gold } rotate x*90 rotate y*-28 translate <-0.62, 0.82, 0.75> }
torus { 0.5, 0.13 texture { Clay } translate <-0.55, 0.13, -0.75> }
torus { 0.26, 0.26 texture { Moss } translate <0.62, 0.26, -1.05> }
torus { 0.16, 0.3 texture { Slate } translate <1.05, 0.3, 0.1> }
torus { 0.4, 0.1 texture { Slate } scale <0.6, 1, 1.5> rotate z*-62 translate <0.42, 0.55, 0.95> }

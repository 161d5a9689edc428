// Ovus
//
// Equation: (√(x² + z²) + R)² + (y − c)² = r²  between two spheres
//
// Eggs (`ovus`): two spheres with a piece of a spindle torus between them, so that all three have common tangents; r is twice the larger radius. Whole, upside
// down, with the pointed end below, and one that has been opened.

#include "stage.inc"
ovus { 0.55, 0.3 texture { Clay } translate <-0.95, 0.55, 0.35> }
ovus { 0.42, 0.6 texture { Slate } translate <0.25, 0.42, 0.9> }
ovus { 0.4, 0.12 texture { Gold } rotate x*90 rotate y*35 translate <0.15, 0.4, -0.75> }
difference {
  ovus { 0.5, 0.27 }
  ovus { 0.46, 0.24 }
  plane { -y, -0.32 rotate z*14 }
  texture { Moss } translate <1.25, 0.5, -0.35>
}

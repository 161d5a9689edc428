// Circular paraboloid
//
// Equation: (x² + y²)/a² = z/c
//
// The mirror of a searchlight: parallel light gathers in its focus.

#include "stage.inc"
paraboloid { 1, 0.7 from 0 to 1 open rotate x*-90 rotate <-52, 28, 0> translate <-0.1, 0.95, 0.4>
  pigment { rgb 0.85 } finish { ambient 0.05 diffuse 0.2 specular 0.8 roughness 0.01 reflection 0.65 } }
sphere { 0, 0.12 texture { Clay } translate vrotate(<0, 0, 0.357>, <-90, 0, 0>) rotate <-52, 28, 0> translate <-0.1, 0.95, 0.4> }

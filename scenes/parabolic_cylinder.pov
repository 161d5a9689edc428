// Parabolic cylinder
//
// Equation: x²/a² = y/b
//
// The trough of a solar plant; the pipe runs along the line of foci.

#include "stage.inc"
union {
  parabolic_cylinder { <1, 0.7>
    clipped_by { box { <-1.1, -0.5, -1.3>, <1.1, 0.85, 1.3> } }
    pigment { rgb 0.85 } finish { ambient 0.05 diffuse 0.25 specular 0.8 roughness 0.01 reflection 0.6 } }
  cylinder { <0, 0.357, -1.4>, <0, 0.357, 1.4>, 0.06 texture { Clay } }
  rotate z*-28 rotate y*55 translate y*0.75 }

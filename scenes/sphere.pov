// Sphere
//
// Equation: |p − c|² = r²
//
// A mirror, a ball of glass, and some marbles.

#include "stage.inc"
sphere { <-0.6, 0.9, 0.5>, 0.9 pigment { rgb 0.9 } finish { ambient 0 diffuse 0.1 specular 0.8 roughness 0.004 reflection 0.8 } }
sphere { <0.75, 0.6, -0.5>, 0.6 pigment { rgbt <0.97, 1, 0.99, 0.97> } finish { ambient 0 diffuse 0 specular 0.8 roughness 0.003 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }
sphere { <-0.45, 0.24, -1>, 0.24 texture { Clay } }
sphere { <0.05, 0.16, -1.35>, 0.16 texture { Gold } }
sphere { <-0.9, 0.14, -1.25>, 0.14 texture { Moss } }

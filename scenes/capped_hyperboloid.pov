// Capped hyperboloid
//
// Equation: x²/a² + y²/b² − z²/c² ≤ 1, z₁ ≤ z ≤ z₂
//
// A waisted solid; made of glass beside it.

#include "stage.inc"
hyperboloid { <0.4, 0.4, 0.5>, sheets 1, from -0.9 to 0.9 rotate x*-90 translate <-0.55, 0.901, 0.5> texture { Gold } }
hyperboloid { <0.3, 0.3, 0.45>, sheets 1, from -0.65 to 0.65 rotate x*-90 translate <0.7, 0.651, -0.5>
  pigment { rgbt <0.95, 1, 0.98, 0.95> } finish { ambient 0 diffuse 0.03 specular 0.8 roughness 0.004 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }

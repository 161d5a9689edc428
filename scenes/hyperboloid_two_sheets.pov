// Hyperboloid of two sheets
//
// Equation: z²/c² − x²/a² − y²/b² = 1
//
// Two bowls that never meet, above each other.

#include "stage.inc"
hyperboloid { <0.4, 0.4, 0.3>, sheets 2, from -1 to 1 open rotate x*-90 rotate z*8 scale 0.85 translate y*1.02 texture { Clay } }

// Hyperboloid of one sheet
//
// Equation: x²/a² + y²/b² − z²/c² = 1
//
// The cooling tower. Straight lines lie in it, as the rods around the inner one show.

#include "stage.inc"
hyperboloid { <0.55, 0.55, 0.75>, sheets 1, from -1.05 to 1.05 open rotate x*-90 translate y*1.07 texture { Slate } }
#for (I, 0, 23)
  cylinder { <0.62, -1.05, 0.62*1.05/0.75>, <0.62, 1.05, -0.62*1.05/0.75>, 0.018 rotate y*15*I translate y*1.07 texture { Gold } }
#end

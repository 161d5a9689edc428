// Plane
//
// Equation: (p − p₀) · n = 0
//
// Four planes: the floor, and three that lean against each other behind a ball, one of them a mirror. A plane is a
// solid: everything behind its normal is inside.

#include "stage.inc"
plane { <0.5, 0.15, -1>, -1.5 texture { Slate } }
plane { <-0.9, 0.05, -0.6>, -1.6 texture { Clay finish { reflection 0.55 diffuse 0.3 } } }
plane { <-0.3, 1, -1.1>, -0.75 texture { Moss } }
sphere { <0, 0.6, -0.2>, 0.6 texture { Gold } }

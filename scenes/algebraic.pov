// Algebraic surfaces
//
// Equation: f(x, y, z) = 0, f a polynomial of order 2 to 16; inside where f < 0
//
// Barth's sextic, which has 65 double points (the most that a sextic can have); Cayley's cubic with its four; a quartic whose holes join; and
// Steiner's Roman surface, which meets itself along three lines.

#include "stage.inc"
polynomial { 6, xyz(2,2,2): 67.77708764, xyz(4,2,0): -27.416407865, xyz(2,0,4): -27.416407865, xyz(4,0,2): 10.472135955, xyz(0,4,2): -27.416407865, xyz(2,4,0): 10.472135955, xyz(0,2,4): 10.472135955, xyz(4,0,0): -4.2360679775, xyz(2,2,0): -8.472135955, xyz(2,0,2): -8.472135955, xyz(2,0,0): 8.472135955, xyz(0,4,0): -4.2360679775, xyz(0,2,2): -8.472135955, xyz(0,2,0): 8.472135955, xyz(0,0,4): -4.2360679775, xyz(0,0,2): 8.472135955, xyz(0,0,0): -4.2360679775
    clipped_by { sphere { 0, 1.85 } } texture { Gold } scale 0.5 rotate <8, -34, 0> translate <-0.5, 0.93, 0.75> }
cubic { <0, 0, -1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, -1>
    clipped_by { box { -1.35, 1.35 } } texture { Slate } rotate <-62, 20, 0> scale 0.36 translate <0.95, 0.62, 0.2> }
polynomial { 4, xyz(4,0,0): 1, xyz(2,0,0): -5, xyz(0,4,0): 1, xyz(0,2,0): -5, xyz(0,0,4): 1, xyz(0,0,2): -5, xyz(0,0,0): 11.8
    texture { Clay } scale 0.15 rotate y*28 translate <-0.72, 0.36, -1.05> }
quartic { <0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, -2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0>
    clipped_by { sphere { 0, 1 } } texture { Moss } rotate <0, 20, 0> scale 0.6 translate <0.35, 0.36, -1.1> }

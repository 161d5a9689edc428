// Isosurface
//
// Equation: f(x, y, z) = threshold, in a box or a ball
//
// A gyroid, which divides space into two equal mazes, thickened and cut by a ball; and a fluted ring, cut by a plane that is part of its formula.

#include "stage.inc"
#declare Gyroid = function(x, y, z, k) { sin(k*x)*cos(k*y) + sin(k*y)*cos(k*z) + sin(k*z)*cos(k*x) };
isosurface {
  function { abs(Gyroid(x, y, z, 7)) - 0.35 }
  contained_by { sphere { 0, 0.85 } }
  max_gradient 14
  rotate <20, 30, 0> translate <-0.75, 0.851, 0.4>
  texture { Clay }
}
isosurface {
  function { max(sqrt(pow(sqrt(x*x + z*z) - 0.45, 2) + y*y) - 0.2 - 0.04*sin(9*atan2(z, x) + 4*atan2(y, sqrt(x*x + z*z) - 0.45)), -y - 0.2) }
  contained_by { box { <-0.75, -0.3, -0.75>, <0.75, 0.3, 0.75> } }
  max_gradient 4
  translate <0.95, 0.201, -0.5>
  texture { Slate }
}

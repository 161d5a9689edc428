// Deformations
//
// Equation: f(W(p)) = 0, where f is the solid's own formula and W takes a point of the deformed solid back to where it was
//
// A twisted column, a tapered tower, a bent pipe, a flag that a formula waves: A. H. Barr's deformations of 1984, exact along each ray.

#include "stage.inc"
deform {
  intersection { superellipsoid { <0.3, 0.1> rotate x*90 scale <0.26, 0.8, 0.26> translate y*0.8 } box { <-1, 0, -1>, <1, 1.6, 1> } }
  twist { y, 240, from 0 to 1.6 }
  texture { Gold }
  translate <-1.25, 0, 0.75>
}
deform {
  difference {
    box { <-0.4, 0, -0.4>, <0.4, 1.5, 0.4> }
    box { <-0.22, 0.35, -1>, <0.22, 0.75, 1> }
    cylinder { <0, 1.1, -1>, <0, 1.1, 1>, 0.16 }
  }
  taper { y, 0.45, from 0 to 1.5 }
  twist { y, 40, from 0 to 1.5 }
  texture { Slate }
  rotate y*15
  translate <-0.1, 0, 1.0>
}
deform {
  difference { cylinder { 0, y*2.4, 0.24 } cylinder { -y, y*3, 0.17 } }
  bend { y, x, 150, from 0.5 to 2.0 }
  texture { Clay }
  rotate y*25
  translate <0.35, 0, -0.1>
}
deform {
  box { <-0.8, -0.03, -0.42>, <0.8, 0.03, 0.42> }
  formula {
    function { x }
    function { y - 0.12*sin(4*x + 1.5*z) }
    function { z }
    contained_by { box { <-0.9, -0.3, -0.5>, <0.9, 0.3, 0.5> } }
  }
  texture { Moss }
  rotate <-62, 12, 8>
  translate <-0.45, 0.75, -0.95>
}

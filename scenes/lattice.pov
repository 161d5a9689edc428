// Deformed patches
//
// Equation: D(p) = p + Σ B_i(s) B_j(t) B_k(r) M_ijk,  (s, t, r) = p in the box of the lattice
//
// Surfaces that are given by parameters, deformed as they are met: a NURBS vase in a lattice whose control points move (T. W. Sederberg and S. R. Parry's
// free-form deformation of 1986), a column of four flat sides that is tapered and twisted, a bent strip of Bezier patches, a Moebius strip in a lattice.

#include "stage.inc"
#declare H = 1/sqrt(2);
#macro Round(R, Y, W)
  <R, Y, 0, W>, <R, Y, R, W/sqrt(2)>, <0, Y, R, W>, <-R, Y, R, W/sqrt(2)>, <-R, Y, 0, W>, <-R, Y, -R, W/sqrt(2)>, <0, Y, -R, W>, <R, Y, -R, W/sqrt(2)>, <R, Y, 0, W>
#end
// A vase of four spans along its height: the lattice makes patches of degree 8 by 12 of it.
deform {
  nurbs {
    degree 2, 3
    points 9, 7, Round(0, 0, 1), Round(0.62, 0, 1), Round(0.72, 0.5, 1), Round(0.2, 0.9, 1), Round(0.12, 1.2, 1), Round(0.3, 1.5, 1), Round(0.46, 1.6, 1)
    u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
  }
  lattice {
    <-0.8, 0, -0.8>, <0.8, 1.6, 0.8>, 2, 3, 2
    move <0, 1, 0>, <-0.25, 0.3, -0.3> move <1, 1, 0>, <0.5, 0.1, -0.2>
    move <0, 2, 0>, <0.35, 0.25, 0> move <1, 2, 0>, <0.35, -0.1, 0> move <0, 2, 1>, <0.35, 0.25, 0> move <1, 2, 1>, <0.35, -0.1, 0>
  }
  texture { Clay }
  translate <-1.1, 0, 0.3>
}
deform {
  union {
    bilinear { <-0.3, 0, -0.3>, <0.3, 0, -0.3>, <0.3, 1.7, -0.3>, <-0.3, 1.7, -0.3> }
    bilinear { <0.3, 0, -0.3>, <0.3, 0, 0.3>, <0.3, 1.7, 0.3>, <0.3, 1.7, -0.3> }
    bilinear { <0.3, 0, 0.3>, <-0.3, 0, 0.3>, <-0.3, 1.7, 0.3>, <0.3, 1.7, 0.3> }
    bilinear { <-0.3, 0, 0.3>, <-0.3, 0, -0.3>, <-0.3, 1.7, -0.3>, <-0.3, 1.7, 0.3> }
  }
  taper { y, 0.5, from 0 to 1.7 }
  twist { y, 160, from 0 to 1.7 }
  texture { Gold }
  translate <0.95, 0, 0.55>
}
deform {
  union {
    patch { 4, 2, <-0.24, 0, 0>, <-0.1, 0, -0.2>, <0.1, 0, 0.2>, <0.24, 0, 0>, <-0.24, 1.6, 0>, <-0.1, 1.6, -0.2>, <0.1, 1.6, 0.2>, <0.24, 1.6, 0> }
    patch { 4, 2, <0.24, 0, 0>, <0.38, 0, -0.2>, <0.48, 0, 0>, <0.6, 0, 0>, <0.24, 1.6, 0>, <0.38, 1.6, -0.2>, <0.48, 1.6, 0>, <0.6, 1.6, 0> }
  }
  bend { y, z, 170, from 0.2 to 1.4 }
  texture { Moss }
  rotate y*160 translate <0.25, 0, -0.35>
}
deform {
  parametric {
    function { (0.5 + v*cos(u/2))*cos(u) } function { v*sin(u/2) } function { (0.5 + v*cos(u/2))*sin(u) }
    <0, -0.16>, <2*pi, 0.16>
  }
  lattice { <-0.7, -0.2, -0.7>, <0.7, 0.2, 0.7>, 3, 2, 3 move <1, 0, 0>, <0, 0.9, 0> move <1, 1, 0>, <0, 0.9, 0> move <2, 1, 2>, <0.2, 0.3, 0.2> }
  texture { Slate }
  rotate y*40 translate <0.5, 0.3, -1.35>
}

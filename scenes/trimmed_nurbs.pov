// Trimmed NURBS
//
// Equation: S(u, v) with (u, v) left of the trims; triangle: Σ n!/(i! j! k!) u^i v^j (1 - u - v)^k P_ij
//
// Loops of curves cut a `nurbs` out in the plane of its parameters: a wall with a round window and a bar of a star in it, by polygons, Bezier and NURBS curves.
// Surfaces that share their edges are `sewn` to a solid, here a vase with a lid and a bottom that a box is cut out of. The sail is a triangular patch (`patch { triangular ... }`).

#include "stage.inc"
#macro Round(R, Y, W)
  <R, Y, 0, W>, <R, Y, R, W/sqrt(2)>, <0, Y, R, W>, <-R, Y, R, W/sqrt(2)>, <-R, Y, 0, W>, <-R, Y, -R, W/sqrt(2)>, <0, Y, -R, W>, <R, Y, -R, W/sqrt(2)>, <R, Y, 0, W>
#end
#declare H = 1/sqrt(2);
nurbs {
  degree 3, 1
  points 4, 2, <-1.5, 0.05, 1.2>, <-0.6, 0.05, 0.5>, <0.2, 0.05, 1.9>, <1.3, 0.05, 1.1>, <-1.5, 2, 1.2>, <-0.6, 2, 0.7>, <0.2, 2, 1.7>, <1.3, 2, 1.1>
  trim { bezier_spline 16, <0, 0>, <0.3, 0>, <0.7, 0>, <1, 0>, <1, 0>, <1, 0.3>, <1, 0.5>, <1, 0.7>, <1, 0.7>, <0.8, 1.1>, <0.2, 1.1>, <0, 0.7>, <0, 0.7>, <0, 0.5>, <0, 0.3>, <0, 0> }
  trim {
    nurbs_curve degree 2, 9, <0.75, 0.5>, <0.75, 0.25, H>, <0.5, 0.25>, <0.25, 0.25, H>, <0.25, 0.5>, <0.25, 0.75, H>, <0.5, 0.75>, <0.75, 0.75, H>, <0.75, 0.5>
    knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
  }
  trim {
    linear_spline 10
    #for (K, 0, 9)
      #local R = (mod(K, 2) = 0 ? 0.22 : 0.09);
      <0.5 + R*cos(K*pi/5), 0.5 + R*sin(K*pi/5)>
    #end
  }
  texture { Slate }
}
difference {
  sewn {
    nurbs {
      degree 2, 2
      points 9, 5, Round(0.35, 0, 1), Round(0.95, 0.25, 1), Round(0.45, 0.75, 1), Round(0.1, 1.1, 1), Round(0.4, 1.3, 1)
      u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4
      v_knots 8, 0, 0, 0, 1, 1, 2, 2, 2
    }
    nurbs { degree 2, 1 points 9, 2, Round(0, 0, 1), Round(0.35, 0, 1) u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
    nurbs { degree 2, 1 points 9, 2, Round(0, 1.45, 1), Round(0.4, 1.3, 1) u_knots 12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 }
    closed
  }
  box { <0, -1, -2>, <2, 0.62, 0> }
  texture { Clay }
  rotate y*40 translate <-0.55, 0.01, -0.6>
}
patch {
  triangular 4,
  <-0.5, 0, 0>, <0, 0.3, 0>, <0.5, 0.1, 0>, <1, 0, 0>
  <-0.3, 0.5, 0>, <0.1, 0.7, -1>, <0.7, 0.5, 0>
  <-0.2, 1, 0.2>, <0.3, 1, 0>
  <0, 1.5, 0>
  texture { Gold }
  scale 0.8 rotate y*-20 translate <0.75, 0.05, -0.5>
}

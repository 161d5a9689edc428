// Parametric surfaces
//
// Equation: x = f_x(u, v),  y = f_y(u, v),  z = f_z(u, v)
//
// Three functions of u and v over a rectangle (`parametric`), met without tessellation: a shell that grows by the exponential function, and Klein's bottle, whose
// seams a ray meets once. Neither `accuracy` nor `max_gradient` nor `precompute` is needed: interval arithmetic proves every crossing.

#include "stage.inc"
// A tube that winds about the y axis and grows with each turn.
#declare Growth = function(u) { exp(0.13*u) }
parametric {
  function { Growth(u)*(1 + 0.92*cos(v))*cos(u) }
  function { Growth(u)*(1.05*sin(v) - 2.3) }
  function { Growth(u)*(1 + 0.92*cos(v))*sin(u) }
  <-35, -pi>, <0, pi>
  contained_by { box { <-2, -4, -2>, <2, 1, 2> } }
  texture { Clay }
  scale 0.46 rotate x*20 translate y*1.25 rotate y*70 translate <-0.85, 0.35, -0.2>
}
parametric {
  function { -2/15*cos(u)*(3*cos(v) - 30*sin(u) + 90*pow(cos(u),4)*sin(u) - 60*pow(cos(u),6)*sin(u) + 5*cos(u)*cos(v)*sin(u)) }
  function { -1/15*sin(u)*(3*cos(v) - 3*pow(cos(u),2)*cos(v) - 48*pow(cos(u),4)*cos(v) + 48*pow(cos(u),6)*cos(v) - 60*sin(u)
    + 5*cos(u)*cos(v)*sin(u) - 5*pow(cos(u),3)*cos(v)*sin(u) - 80*pow(cos(u),5)*cos(v)*sin(u) + 80*pow(cos(u),7)*cos(v)*sin(u)) }
  function { 2/15*(3 + 5*cos(u)*sin(u))*sin(v) }
  <0, 0>, <pi, 2*pi>
  contained_by { box { <-4, -4, -4>, <4, 5, 4> } }
  pigment { rgb <0.45, 0.65, 0.8> transmit 0.45 } finish { Glossy }
  rotate z*180 scale 0.46 rotate y*-25 translate <1, 1.98, 0.1>
}

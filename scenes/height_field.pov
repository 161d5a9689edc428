// Height field
//
// Equation: y = h(x, z) over the unit square, two triangles a cell
//
// F. K. Musgrave, "Grid tracing: fast ray tracing for height fields", Yale University, 1988
// A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field rendering", I3D 2008
//
// A ripple of 160000 heights, and the same one as a solid, cut by a cylinder.

#include "stage.inc"
#declare Ripple = function(r) { 0.5 + 0.32*cos(38*r)*exp(-5*r) }
#declare Pond = height_field {
  function 400, 400 { Ripple(sqrt((x - 0.42)*(x - 0.42) + (y - 0.55)*(y - 0.55))) }
  smooth
  translate <-0.5, 0, -0.5>
}
object { Pond scale <2.3, 1, 2.3> rotate y*35 translate <-0.45, 0.1, 0.85> texture { Slate } }
intersection {
  object { Pond }
  cylinder { <0, 0.05, 0>, <0, 2, 0>, 0.42 }
  scale <1.6, 1, 1.6>
  rotate y*-20
  translate <0.7, 0, -1>
  texture { Clay }
}

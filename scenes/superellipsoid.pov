// Superellipsoid
//
// Equation: (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1
//
// A rounded box, a cushion, a coin with a soft rim, an octahedron, and a star: A. H. Barr's superquadrics of 1981.

#include "stage.inc"
superellipsoid { <0.25, 0.25> texture { Slate } scale 0.42 rotate y*30 translate <-0.85, 0.42, 0.7> }
superellipsoid { <1, 0.3> texture { Gold } scale <0.5, 0.5, 0.22> rotate x*90 translate <0.85, 0.22, -0.75> }
superellipsoid { <0.5, 1.4> texture { Clay } scale 0.5 rotate x*90 translate <-0.55, 0.5, -0.85> }
superellipsoid { <2, 2> texture { Moss } scale 0.55 rotate x*90 rotate y*20 translate <0.42, 0.55, 0.35> }
superellipsoid { <3.2, 2.5> texture { Gold } scale <0.7, 0.7, 0.7> rotate y*35 translate <0.1, 1.32, 1.4> }

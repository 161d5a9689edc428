// Colours, shapes and finishes from the standard include files.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "colors.inc"
#include "shapes.inc"
#include "finish.inc"
background { SkyBlue }
camera { location <0, 3, -9> look_at <0, 0.8, 0> angle 52 right x*4/3 }
light_source { <6, 10, -8>, White }
plane { y, -0.2 pigment { checker White, Gray50 } }
object { Ellipsoid scale <1.2, 0.7, 0.8> rotate z*25 translate <-3, 1, 0> pigment { Orange } finish { Shiny } }
object { Hyperboloid_Y clipped_by { box { <-3, -1.1, -3>, <3, 1.1, 3> } } scale <0.4, 0.8, 0.4> translate <-1, 0.8, 0.4> pigment { ForestGreen } finish { Phong_Glossy } }
object { Paraboloid_Y clipped_by { box { <-2, -1, -2>, <2, 1.4, 2> } } scale 0.7 translate <1, 0.1, 0.4> pigment { Violet } finish { Dull } }
object { QCone_Y clipped_by { box { <-2, -0.9, -2>, <2, 0.9, 2> } } scale 0.8 translate <2.9, 0.75, 0> pigment { Firebrick } finish { Mirror diffuse 0.4 } }
object { Cube scale 0.35 rotate <20, 40, 0> translate <0, 0.4, -2> pigment { color Gold } finish { Phong_Shiny reflection 0.2 } }

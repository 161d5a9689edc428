// Functions of functions.inc as surfaces: helices, a spiral, a weave, hexagons, tubes, a revolved curve.
#version 3.7;
#include "functions.inc"
global_settings { assumed_gamma 1 }
camera { location <0, 0, -11> look_at 0 angle 58 right x*16/9 }
light_source { <10, 14, -20>, rgb 0.9 }
light_source { <0, 0, -11>, rgb 0.3 shadowless }
background { rgb <0.2, 0.3, 0.35> }
#default { texture { pigment { rgb <0.9, 0.75, 0.5> } finish { ambient 0.1 diffuse 0.8 } } }

isosurface {
  function { f_helix1(x, y, z, 2, 8, 0.07, 0.6, 1, 1, 0) }
  contained_by { box { <-0.8, -1.1, -0.8>, <0.8, 1.1, 0.8> } } max_gradient 2 accuracy 1e-5
  rotate <-20, 0, 25> translate <-3.6, 1.5, 0>
}
isosurface {
  function { f_helix2(x, y, z, 1, 10, 0.15, 0.3, 1, 0.4, 0) }
  contained_by { box { <-0.8, -1.1, -0.8>, <0.8, 1.1, 0.8> } } max_gradient 6 accuracy 1e-5
  rotate <-20, 0, 25> translate <-1.2, 1.5, 0>
}
isosurface {
  function { f_spiral(x, y, z, 0.35, 0.07, 1.2, 0, 0, 1) }
  contained_by { box { <-1.3, -0.1, -1.3>, <1.3, 0.1, 1.3> } } max_gradient 2 accuracy 1e-5
  rotate x*-55 translate <1.2, 1.5, 0>
}
isosurface {
  function { f_mesh1(x, y, z, 0.4, 0.4, 1, 0.06, 1) - 0.06 }
  contained_by { box { <-1, -0.2, -1>, <1, 0.2, 1> } } max_gradient 2 accuracy 1e-5
  rotate x*-50 translate <3.7, 1.5, 0>
}
isosurface {
  function { 0.25 - f_hex_x(x*2, y*2, z, 0) }
  contained_by { box { <-1, -1, -0.2>, <1, 1, 0.2> } } max_gradient 4 accuracy 1e-5
  rotate <25, 30, 0> translate <-3.6, -1.4, 0>
}
isosurface {
  function { f_polytubes(x, y, z, 5, 0.4, 0, 0.6, 0, 0) - 0.12 }
  contained_by { box { <-1.1, -0.9, -1.1>, <1.1, 0.9, 1.1> } } max_gradient 4 accuracy 1e-5
  rotate <-25, 20, 0> translate <-1.2, -1.4, 0>
}
isosurface {
  function { f_algbr_cyl4(x, y, z, -1, 10, 1, 0, 0) }
  contained_by { box { -1.2, 1.2 } } max_gradient 9 accuracy 1e-5
  rotate <-25, 20, 0> translate <1.2, -1.4, 0>
}
isosurface {
  function { f_cross_ellipsoids(x, y, z, 0.1, 8, 1, 0.3) }
  contained_by { sphere { 0, 1.3 } } max_gradient 4 accuracy 1e-5
  rotate <-25, 20, 0> translate <3.7, -1.4, 0>
}

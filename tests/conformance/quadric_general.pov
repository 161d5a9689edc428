// Unbounded quadrics by their ten coefficients, cut by boxes and spheres.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.9, 0.9, 0.85> }
camera { location <1, 4, -11> look_at <0, 0.4, 0> angle 52 right x*4/3 }
light_source { <8, 12, -10>, rgb 0.9 }
light_source { <-9, 6, -6>, rgb 0.35 }
#declare Shiny = finish { specular 0.4 roughness 0.03 }
// elliptic paraboloid
quadric { <1, 0, 0.5>, <0, 0, 0>, <0, -1, 0>, 0 clipped_by { box { <-3, -1, -3>, <3, 1.6, 3> } }
  translate <-3.2, -0.8, 0> pigment { rgb <0.9, 0.5, 0.3> } finish { Shiny } }
// hyperbolic paraboloid
quadric { <1, 0, -1>, <0, 0, 0>, <0, -1, 0>, 0 clipped_by { sphere { 0, 1.5 } }
  rotate y*30 translate <0, 0.6, 0> pigment { rgb <0.35, 0.6, 0.85> } finish { Shiny } }
// hyperboloid of one sheet
quadric { <1, -0.6, 1>, <0, 0, 0>, <0, 0, 0>, -0.35 clipped_by { box { <-3, -1.3, -3>, <3, 1.3, 3> } }
  rotate <15, 0, -20> translate <3.1, 0.6, 0> pigment { rgb <0.4, 0.75, 0.45> } finish { Shiny } }
// hyperboloid of two sheets
quadric { <1, -0.5, 1>, <0, 0, 0>, <0, 0, 0>, 0.12 clipped_by { box { <-2, -1.4, -2>, <2, 1.4, 2> } }
  rotate <0, 0, 70> translate <0.2, 2.6, 2.2> pigment { rgb <0.8, 0.4, 0.7> } finish { Shiny } }
// parabolic cylinder and mixed terms
quadric { <1, 0, 0>, <0.4, 0, 0.3>, <0, 1, 0.2>, 0 clipped_by { box { <-1.2, -1.6, -1>, <1.2, 1, 1.5> } }
  translate <0, -0.9, -2.6> pigment { rgb <0.7, 0.7, 0.35> } finish { Shiny } }
plane { y, -2.6 pigment { rgb 0.6 } }

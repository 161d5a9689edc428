// Which side of a surface without an inside is its front: triangles, smooth ones (sheared too), polygons that begin with a notch, meshes, discs, open walls.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.7, 0.75, 0.85> }
camera { location <0, 2.2, -7> look_at <0, 0.9, 0> angle 50 right x*4/3 }
light_source { <-4, 7, -6>, rgb 0.9 }
plane { y, 0 pigment { rgb <0.6, 0.6, 0.55> } }
#declare Front = texture { pigment { rgb <0.9, 0.3, 0.2> } finish { ambient 0.35 } }
#declare Back = texture { pigment { rgb <0.2, 0.4, 0.9> } finish { ambient 0.35 } }
triangle { <-3, 0.1, 0>, <-2.2, 0.1, 0>, <-2.6, 0.9, 0> texture { Front } interior_texture { Back } }
triangle { <-3, 1.1, 0>, <-2.6, 1.9, 0>, <-2.2, 1.1, 0> texture { Front } interior_texture { Back } }
smooth_triangle { <-2, 0.1, 0>, <-0.3, 0.1, -1>, <-1.2, 0.1, 0>, <0.3, 0.1, -1>, <-1.6, 0.9, 0>, <0, 0.2, -1> texture { Front } interior_texture { Back } }
smooth_triangle { <-2, 1.1, 0>, <-0.3, 0.1, 1>, <-1.2, 1.1, 0>, <0.3, 0.1, 1>, <-1.6, 1.9, 0>, <0, 0.2, 1> texture { Front } interior_texture { Back } }
smooth_triangle { <-0.4, 0, 0>, <-2, 0.1, -1>, <0.4, 0, 0>, <2, 0.1, -1>, <0, 0.8, 0>, <0, 2, -1> rotate y*65 translate <-0.6, 0.1, 0> texture { Front } interior_texture { Back } }
smooth_triangle { <-0.4, 0, 0>, <-0.2, 0.1, -1>, <0.4, 0, 0>, <0.3, 0.1, -1>, <0, 0.8, 0>, <0, 0.4, -1> matrix <1, 0.3, 0.2, -0.3, 1, 0, 0.4, 0, 1, 0, 0, 0> translate <-0.6, 1.1, 0> texture { Front } interior_texture { Back } }
polygon { 6, <0.1, 0.1>, <0.5, 0.4>, <0.9, 0.1>, <0.9, 0.9>, <0.1, 0.9>, <0.1, 0.1> texture { Front } interior_texture { Back } }
polygon { 6, <0.1, 1.1>, <0.5, 1.1>, <0.9, 1.1>, <0.9, 1.9>, <0.1, 1.9>, <0.1, 1.1> texture { Front } interior_texture { Back } }
mesh { smooth_triangle { <1.1, 0.1, 0>, <0, 0.1, -1>, <1.9, 0.1, 0>, <0, 0.1, -1>, <1.5, 0.9, 0>, <0, 0.2, -1> } texture { Front } interior_texture { Back } }
mesh { smooth_triangle { <1.1, 1.1, 0>, <0, 0.1, 1>, <1.9, 1.1, 0>, <0, 0.1, 1>, <1.5, 1.9, 0>, <0, 0.2, 1> } texture { Front } interior_texture { Back } }
mesh { triangle { <2.1, 0.1, 0>, <2.9, 0.1, 0>, <2.5, 0.9, 0> } triangle { <2.1, 1.1, 0>, <2.5, 1.9, 0>, <2.9, 1.1, 0> } texture { Front } interior_texture { Back } }
disc { <-1.5, 0.6, -2.4>, <0.2, 0.3, -1>, 0.35 texture { Front } interior_texture { Back } }
cylinder { <0, 0.02, -2.4>, <0.1, 0.8, -2.4>, 0.35 open texture { Front } interior_texture { Back } }
cone { <1.6, 0.02, -2.4>, 0.2, <1.6, 0.7, -2.3>, 0.5 open texture { Front } interior_texture { Back } }

// Triangles with a texture for each corner, mixed by barycentric coordinates.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1, -6> look_at <0, 0.4, 0> angle 50 }
light_source { <6, 9, -8>, rgb 1 }
background { rgb <0.1, 0.15, 0.2> }
plane { y, -1.2 pigment { checker rgb 0.8 rgb 0.5 } }
#declare A = texture { pigment { rgb <1, 0.1, 0.1> } finish { specular 0.6 } }
#declare B = texture { pigment { rgb <0.1, 0.9, 0.1> } finish { reflection 0.4 } }
#declare C = texture { pigment { checker rgb <0.1, 0.2, 1> rgb <1, 1, 0.2> scale 0.3 } }
#declare D = texture { pigment { rgbt <1, 1, 1, 0.9> } }
mesh2 {
  vertex_vectors { 4, <-2.4, -1, 0>, <-0.2, -1, 0.5>, <-1.2, 1.6, 0>, <0.4, 1.4, 1> }
  normal_vectors { 4, <-0.4, 0, -1>, <0.3, 0, -1>, <0, 0.4, -1>, <0.5, 0.5, -1> }
  texture_list { 4, texture { A } texture { B } texture { C } texture { D } }
  face_indices { 2, <0, 1, 2>, 0, 1, 2, <2, 1, 3>, 2, 1, 3 }
  rotate 10*y
}
mesh {
  triangle { <0.4, -1, 0>, <2.4, -1, -0.5>, <1.4, 1, 0> texture_list { A C B } }
  smooth_triangle { <1.4, 1, 0>, <0, 0, -1>, <2.4, -1, -0.5>, <0.4, 0, -1>, <2.6, 1.2, 0.5>, <0.5, 0.3, -1> texture_list { A, D, C } }
}

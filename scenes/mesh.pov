// Mesh
//
// Equation: the union of triangles over shared corners
//
// An icosahedron by its twelve corners, and the same corners with normals. Neighbours share their edges exactly: no
// ray slips through between two triangles.

#include "stage.inc"
#declare G = (1+sqrt(5))/2;
#macro Icosahedron(Smooth)
  mesh2 {
    vertex_vectors { 12, <-1, G, 0>, <1, G, 0>, <-1, -G, 0>, <1, -G, 0>, <0, -1, G>, <0, 1, G>, <0, -1, -G>, <0, 1, -G>, <G, 0, -1>, <G, 0, 1>, <-G, 0, -1>, <-G, 0, 1> }
    #if (Smooth)
      normal_vectors { 12, <-1, G, 0>, <1, G, 0>, <-1, -G, 0>, <1, -G, 0>, <0, -1, G>, <0, 1, G>, <0, -1, -G>, <0, 1, -G>, <G, 0, -1>, <G, 0, 1>, <-G, 0, -1>, <-G, 0, 1> }
    #end
    face_indices { 20, <0, 11, 5>, <0, 5, 1>, <0, 1, 7>, <0, 7, 10>, <0, 10, 11>, <1, 5, 9>, <5, 11, 4>, <11, 10, 2>, <10, 7, 6>, <7, 1, 8>,
      <3, 9, 4>, <3, 4, 2>, <3, 2, 6>, <3, 6, 8>, <3, 8, 9>, <4, 9, 5>, <2, 4, 11>, <6, 2, 10>, <8, 6, 7>, <9, 8, 1> }
    scale 0.52
  }
#end
object { Icosahedron(false) texture { Clay } rotate <10, 15, 0> translate <-0.75, 0.98, 0.5> }
object { Icosahedron(true) texture { Slate } scale 0.75 rotate <0, 25, 20> translate <0.85, 0.74, -0.4> }

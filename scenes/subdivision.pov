// Subdivision surfaces
//
// Each step: a point for every face, edge and vertex of a mesh; the surface is what the mesh comes to
//
// Control meshes under Catmull and Clark's rules (`subdivision`), met at their limit and not at any step on the way. Three cubes: their upper and lower
// edges are sharp for ever, for two and a half steps, and not at all. The star has two vertices of ten edges, and the ring is creased along its outer rim.

#include "stage.inc"
#macro Die(S)
  subdivision {
    vertex_vectors { 8, <-1,-1,-1>, <-1,-1,1>, <-1,1,-1>, <-1,1,1>, <1,-1,-1>, <1,-1,1>, <1,1,-1>, <1,1,1> }
    face_indices { 6, <0,1,3,2>, <4,6,7,5>, <0,4,5,1>, <2,3,7,6>, <0,2,6,4>, <1,5,7,3> }
    #if (S > 0) creases { 8, <0,1,S>, <1,3,S>, <3,2,S>, <2,0,S>, <4,5,S>, <5,7,S>, <7,6,S>, <6,4,S> } #end
    scale 0.3
  }
#end
object { Die(10) texture { Slate } rotate z*90 rotate y*-30 translate <-1.35, 0.3, -0.9> }
object { Die(2.5) texture { Moss } rotate z*90 rotate y*-15 translate <-0.45, 0.3, -1.35> }
object { Die(0) texture { Clay } rotate y*20 translate <0.4, 0.24, -1.5> }

// A star of five points: two tips of ten edges, above and below a ring.
#declare Ring = array[10];
#for (K, 0, 9)
  #declare Ring[K] = vrotate(<select(mod(K, 2) - 0.5, 1, 0.45), 0, 0>, y*36*K);
#end
subdivision {
  vertex_vectors { 12, #for (K, 0, 9) Ring[K], #end <0, 0.45, 0>, <0, -0.45, 0> }
  face_indices { 20, #for (K, 0, 9) <K, 10, mod(K + 1, 10)>, <mod(K + 1, 10), 11, K>, #end }
  texture { Gold }
  rotate x*-75 rotate y*-12 scale 1.1 translate <-0.75, 1.15, 0.5>
}

// A ring of eight boxes without their common sides; the outer rim is sharp.
#declare Cut = array[4] { <0.55, -0.25, 0>, <1.15, -0.3, 0>, <1.15, 0.3, 0>, <0.55, 0.25, 0> };
subdivision {
  vertex_vectors { 32, #for (K, 0, 7) #for (J, 0, 3) vrotate(Cut[J], y*45*K), #end #end }
  face_indices { 32,
    #for (K, 0, 7)
      #declare N = 4*mod(K + 1, 8);
      #for (J, 0, 3) #declare M = mod(J + 1, 4); <4*K + J, 4*K + M, N + M, N + J>, #end
    #end
  }
  creases { 16, #for (K, 0, 7) <4*K + 1, 4*mod(K + 1, 8) + 1, 10>, <4*K + 2, 4*mod(K + 1, 8) + 2, 3>, #end }
  pigment { rgb <0.62, 0.3, 0.38> } finish { Glossy }
  rotate x*-60 rotate y*25 scale 0.85 translate <0.95, 0.85, 0.2>
}

// Loop subdivision
//
// Each step: a triangle becomes four; the surface is what the mesh comes to
//
// Triangles under Loop's rules (`subdivision` with `scheme loop`), met at their limit. Three icosahedra: both rings of five edges are sharp for ever, for one
// and a half steps, and not at all. The torus of triangles is sharp along its outer rim. The flower is a sheet with a smooth boundary and one vertex of twelve edges.

#include "stage.inc"
#macro Ico(S)
  subdivision {
    scheme loop
    vertex_vectors { 12, y*1.118,
      #for (K, 0, 4) vrotate(<1, 0.5, 0>, y*72*K), #end
      #for (K, 0, 4) vrotate(<1, -0.5, 0>, y*(72*K + 36)), #end
      -y*1.118
    }
    face_indices { 20,
      #for (K, 0, 4)
        #local N = mod(K + 1, 5);
        <0, 1 + K, 1 + N>, <1 + K, 6 + K, 1 + N>, <6 + K, 6 + N, 1 + N>, <11, 6 + N, 6 + K>,
      #end
    }
    #if (S > 0) creases { 10, #for (K, 0, 4) <1 + K, 1 + mod(K + 1, 5), S>, <6 + K, 6 + mod(K + 1, 5), S>, #end } #end
    scale 0.47
  }
#end
object { Ico(10) texture { Slate } rotate y*20 translate <-1.3, 0.34, -0.7> }
object { Ico(1.5) texture { Moss } rotate y*5 translate <-0.35, 0.4, -1.3> }
object { Ico(0) texture { Clay } rotate y*30 translate <0.6, 0.43, -1.45> }

// A torus of 8 by 4 vertices with six edges each; the outer rim is sharp.
#declare Cut = array[4] { <1.2, 0, 0>, <0.85, 0.4, 0>, <0.5, 0, 0>, <0.85, -0.4, 0> };
subdivision {
  scheme loop
  vertex_vectors { 32, #for (K, 0, 7) #for (J, 0, 3) vrotate(Cut[J], y*45*K), #end #end }
  face_indices { 64,
    #for (K, 0, 7)
      #declare N = 4*mod(K + 1, 8);
      #for (J, 0, 3) #declare M = mod(J + 1, 4); <4*K + J, 4*K + M, N + M>, <4*K + J, N + M, N + J>, #end
    #end
  }
  creases { 8, #for (K, 0, 7) <4*K, 4*mod(K + 1, 8), 10>, #end }
  pigment { rgb <0.62, 0.3, 0.38> } finish { Glossy }
  rotate x*-62 rotate y*25 scale 0.85 translate <1.0, 0.85, 0.2>
}

// A sheet: twelve triangles about one vertex, with a smooth boundary.
#declare Petal = array[12];
#for (K, 0, 11)
  #declare Petal[K] = vrotate(<select(mod(K, 2) - 0.5, 1.15, 0.6), select(mod(K, 2) - 0.5, 0.15, 0.5), 0>, y*30*K);
#end
subdivision {
  scheme loop
  vertex_vectors { 13, #for (K, 0, 11) Petal[K], #end <0, -0.25, 0> }
  face_indices { 12, #for (K, 0, 11) <K, 12, mod(K + 1, 12)>, #end }
  boundary smooth
  texture { Gold }
  rotate x*-62 rotate y*-14 scale 0.95 translate <-0.75, 1.15, 0.6>
}

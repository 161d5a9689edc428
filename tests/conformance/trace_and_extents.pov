// Objects set on others by trace(), with its normal; points kept by inside(); the edges of bounding boxes.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <1, 4, -9> look_at <0, 0.4, 0> angle 45 }
light_source { <-6, 9, -8>, rgb 1 }
light_source { <7, 5, -4>, rgb 0.3 shadowless }

#declare Hill = union {
    sphere { <-1.5, -0.6, 0>, 1.6 }
    cone { <1.5, -1, 0.5>, 1.4, <1.5, 1.2, 0.5>, 0.3 }
    box { <-3, -1, -2>, <3, -0.4, 2> rotate 8*z }
}
object { Hill pigment { rgb <0.5, 0.7, 0.4> } }

#declare R = seed(7);
#for (I, 1, 60)
    #declare N = <0, 0, 0>;
    #declare P = trace(Hill, <6*rand(R) - 3, 5, 4*rand(R) - 2>, -y, N);
    #if (vlength(N) > 0)
        cylinder { P, P + 0.35*N, 0.04 pigment { rgb 0.5 + 0.5*N } }
        sphere { P + 0.35*N, 0.07 pigment { rgb <0.9, 0.3, 0.2> } }
    #end
#end

#declare Body = difference { sphere { <0, 2, 1>, 0.9 } box { <0, 2, 0>, <1, 3, 2> } rotate 20*y }
#for (I, 1, 150)
    #declare P = <4*rand(R) - 2, 1.6*rand(R) + 1.2, 3*rand(R) - 0.5>;
    #if (inside(Body, P)) sphere { P, 0.09 pigment { rgb <0.3, 0.4, 0.9> } } #end
#end

#declare Ring = torus { 0.7, 0.15 rotate 50*x rotate 30*z translate <0, 0.7, -2> }
object { Ring pigment { rgb <0.9, 0.8, 0.3> } }
#declare A = min_extent(Ring);
#declare B = max_extent(Ring);
#macro Edge(P, Q) cylinder { P, Q, 0.02 pigment { rgb 0.9 } } #end
#for (I, 0, 1)
    #for (J, 0, 1)
        #declare U = select(I, 0, A.x, B.x); #declare V = select(J, 0, A.y, B.y);
        Edge(<U, V, A.z>, <U, V, B.z>)
        #declare V = select(J, 0, A.z, B.z);
        Edge(<U, A.y, V>, <U, B.y, V>)
        #declare U = select(I, 0, A.y, B.y);
        Edge(<A.x, U, V>, <B.x, U, V>)
    #end
#end

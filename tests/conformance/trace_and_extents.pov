// What a scene asks about its own objects: trace, inside, min_extent and max_extent.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -9> look_at <0, 0.4, 0> angle 45 }
light_source { <-5, 8, -7>, rgb 1 }
plane { y, -1 pigment { checker rgb 0.5 rgb 0.8 } }

#declare Hill = union {
  sphere { 0, 1 scale <1.4, 0.8, 1.2> }
  difference { box { <0.4, -0.8, -0.6>, <1.8, 0.6, 0.8> } cylinder { <1.1, -1, 0.1>, <1.1, 1, 0.1>, 0.4 } }
  torus { 1.1, 0.25 rotate 30*z translate -0.4*x }
  rotate 20*y
}
object { Hill pigment { rgb <0.4, 0.6, 0.3> } }

// Pins that stand on it.
#declare Low = min_extent(Hill);
#declare High = max_extent(Hill);
#for (I, 0, 8)
  #for (J, 0, 5)
    #declare Start = <Low.x + (High.x - Low.x)*(I + 0.5)/9, High.y + 1, Low.z + (High.z - Low.z)*(J + 0.5)/6>;
    #declare Across = <0, 0, 0>;
    #declare Foot = trace(Hill, Start, -y, Across);
    #if (vlength(Across) != 0)
      cylinder { Foot, Foot + 0.3*Across, 0.04 pigment { rgb <0.9, 0.3, 0.2> } }
    #end
  #end
#end

// Beads where it is solid, drawn apart.
#for (I, 0, 11)
  #declare P = <-1.6 + 0.3*I, 0.2, 0>;
  sphere { P + <0, 1.9, 0>, 0.12 pigment { rgb #if (inside(Hill, P)) <1, 0.8, 0.1> #else <0.1, 0.2, 0.8> #end } }
#end

// A box around something turned.
#declare Turned = box { <-0.4, -0.3, -0.2>, <0.4, 0.3, 0.2> rotate <20, 30, 10> translate <-2.6, 0, -1> }
object { Turned pigment { rgb <0.7, 0.5, 0.8> } }
#declare A = min_extent(Turned);
#declare B = max_extent(Turned);
#for (I, 0, 7)
  sphere { <select(mod(I, 2), A.x, A.x, B.x), select(mod(int(I/2), 2), A.y, A.y, B.y), select(int(I/4), A.z, A.z, B.z)>, 0.07 pigment { rgb 1 } }
#end

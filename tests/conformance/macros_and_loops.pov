// Loops, macros, conditionals, switches and arrays build a spiral stair and a fence.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.75, 0.85, 0.95> }
camera { location <0, 4.5, -9> look_at <0, 1.6, 0> angle 46 right x*4/3 }
light_source { <-8, 12, -8>, rgb 1 }
#declare Palette = array[3] { rgb <0.8, 0.5, 0.3>, rgb <0.6, 0.65, 0.4>, rgb <0.4, 0.5, 0.7> }
#macro Step(K, Total)
  #local A = 360*K/Total*1.5;
  #local H = 3.2*K/Total;
  union {
    box { <0.2, H, -0.18>, <1.6, H+0.08, 0.18> }
    cylinder { <1.5, H+0.08, 0>, <1.5, H+0.7, 0>, 0.04 }
    sphere { <1.5, H+0.75, 0>, 0.08 }
    #switch (mod(K, 3))
      #case (0) pigment { Palette[0] } #break
      #case (1) pigment { Palette[1] } #break
      #else pigment { Palette[2] }
    #end
    #if (K > Total/2) finish { phong 0.5 } #else finish { specular 0.3 } #end
    rotate -y*A
  }
#end
cylinder { 0, y*3.6, 0.2 pigment { rgb 0.7 } }
#for (K, 0, 23) Step(K, 24) #end
#macro Post(P, Height) cylinder { P, P+y*Height, 0.07 pigment { rgb <0.5, 0.35, 0.2> } } #end
#declare S = seed(42);
#local X = -4;
#while (X <= 4) Post(<X, 0, 3>, 0.8+0.6*rand(S)) #local X = X+0.5; #end
#ifdef (Palette) plane { y, 0 pigment { checker Palette[1], rgb 0.7 scale 1.5 } } #end
#ifndef (Nowhere) sphere { <-3, 0.5, -1>, 0.5 pigment { Palette[2] } finish { reflection 0.3 } } #end

// Tilings of the plane, the warp of a cube's sides, and bumps that are lit from behind the plain surface.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 6, -9> look_at <0, 0, 0.5> angle 42 right x*image_width/image_height }
light_source { <-30, 60, -40>, rgb 0.8 }
light_source { <30, 5, 60>, rgb 0.4 shadowless }
#declare Tones = color_map { [0 rgb <0.9, 0.7, 0.4>] [0.3 rgb <0.5, 0.2, 0.1>] [0.6 rgb <0.2, 0.4, 0.7>] [1 rgb 0.95] }
plane { y, -1 pigment { tiling 5 color_map { Tones } scale 0.6 } }
#declare Number = array[8] { 1, 2, 3, 4, 6, 7, 10, 18 }
#declare I = 0;
#while (I < 8)
  box { <-0.8, -1, -0.6>, <0.8, -0.6, 0.6> pigment { tiling Number[I] color_map { Tones } scale 0.35 } translate <-2.9 + 1.9*mod(I, 4), 0, -1.2 + 1.7*int(I/4)> }
  #declare I = I + 1;
#end
box { -0.7, 0.7 pigment { checker rgb <0.9, 0.3, 0.2> rgb 0.9 scale <0.0625, 0.0833, 2> warp { cubic } } rotate <20, 40, 10> translate <-1.5, 0.6, 3> }
sphere { <1.5, 0.4, 3>, 1 pigment { rgb 0.9 } normal { gradient y 2 scale 0.2 } }

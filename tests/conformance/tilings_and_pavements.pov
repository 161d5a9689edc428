// Tilings, those of Penrose among them, and pavements of triangles, squares and hexagons.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <8, 10, 6> direction -y right 16*x up 12*z }
#declare Tones = color_map { [0 rgb <0.9, 0.7, 0.4>] [0.3 rgb <0.5, 0.2, 0.1>] [0.6 rgb <0.2, 0.4, 0.7>] [1 rgb 0.95] }
#macro Show(I, P) box { <-0.93, -1, -0.93>, <0.93, 0, 0.93> pigment { P scale 0.4 } finish { ambient 1 diffuse 0 } translate <1 + 2*mod(I, 8), 0, 1 + 2*int(I/8)> } #end
#declare Number = array[18] { 8, 9, 11, 12, 13, 14, 15, 16, 17, 19, 20, 21, 22, 23, 24, 25, 26, 27 }
#declare I = 0;
#while (I < 18)
  #declare P = pigment { tiling Number[I] color_map { Tones } translate <0.31, 0, 0.17> }
  Show(I, P)
  #declare I = I + 1;
#end
#declare Sides = array[10] { 3, 3, 3, 4, 4, 4, 4, 6, 6, 6 }
#declare Tiles = array[10] { 1, 5, 6, 3, 5, 6, 6, 2, 4, 5 }
#declare Chosen = array[10] { 1, 3, 9, 2, 8, 20, 35, 1, 5, 17 }
#while (I < 46)
  #declare K = mod(I - 18, 10);
  #declare P = pigment { pavement number_of_sides Sides[K] number_of_tiles Tiles[K] pattern Chosen[K] exterior mod(I, 3) interior mod(int(I/3), 3) form mod(I, 4) color_map { Tones } translate <0.31, 0, 0.17> }
  Show(I, P)
  #declare I = I + 1;
#end
plane { y, -2 pigment { rgb 0.2 } finish { ambient 1 diffuse 0 } }

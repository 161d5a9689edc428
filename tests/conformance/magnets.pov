// The two magnets as Mandelbrot sets and Julia sets, in pigments and a normal.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location -10*z right 8*x up 6*y direction z }
light_source { <-30, 60, -40>, rgb 1 }
#declare Tones = color_map { [0 rgb <0.1, 0.1, 0.3>] [0.4 rgb <0.9, 0.5, 0.2>] [1 rgb 1] }
box { <-4, 0, 0>, <0, 3, 1> pigment { magnet 1 mandel 12 interior 1, 1 exterior 1, 1 color_map { Tones } scale 0.8 translate <-3.4, 1.5, 0> } }
box { <0, 0, 0>, <4, 3, 1> pigment { magnet 2 mandel 12 interior 1, 0.7 color_map { Tones } scale 0.8 translate <0.6, 1.5, 0> } }
box { <-4, -3, 0>, <0, 0, 1> pigment { magnet 1 julia <0.5, 0.2>, 8 interior 1, 1 color_map { Tones } translate <-2, -1.5, 0> } }
box { <0, -3, 0>, <4, 0, 1> pigment { rgb 0.9 } normal { magnet 1 mandel 8 1 interior 1, 1 scale 0.8 translate <0.6, -1.5, 0> } }

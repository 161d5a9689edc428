// Patterns of random points and numbers, the pattern of an object, and bumps on mirrors.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <4, 3, -10> direction z right 8*x up 6*y }
light_source { <-30, 60, -90> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.1, 0.2, 0.6>] [1 rgb <0.9, 0.8, 0.6>] } } }
#declare Shown = finish { ambient 0 diffuse 0 emission 1 }
#declare Map = color_map { [0 rgb <0.1, 0.1, 0.5>] [0.5 rgb <0.9, 0.8, 0.2>] [1 rgb <0.7, 0.1, 0.1>] }
#macro Tile(X, Y, P)
  box { <X + 0.03, Y + 0.03, 0.0137>, <X + 1.97, Y + 1.97, 1> pigment { P } finish { Shown } }
#end
Tile(0, 0, pigment { cells color_map { Map } scale 0.3 translate 0.1 })
Tile(2, 0, pigment { crackle color_map { Map } scale 0.4 })
Tile(4, 0, pigment { crackle form <1, 0, 0> metric 1 color_map { Map } scale 0.4 })
Tile(6, 0, pigment { crackle form <0, -1, 1> offset 0.2 color_map { Map } scale 0.4 rotate <10, 20, 30> })
Tile(0, 2, pigment { object { torus { 0.6, 0.2 rotate x*60 translate <1, 3, 0> } rgb <0.2, 0.5, 0.3> rgb <0.9, 0.6, 0.2> } })
Tile(2, 2, pigment { crackle metric 3 form <-0.5, 0.8, 0> frequency 2 color_map { Map } scale 0.5 })
sphere { <5, 3, 0>, 0.95 pigment { rgb 0.3 } normal { gradient x, 4 triangle_wave scale 0.4 rotate z*25 } finish { reflection 0.7 } }
sphere { <7, 3, 0>, 0.95 pigment { rgb 0.3 } normal { quilted 3 control0 0.2 control1 0.8 scale 0.4 } finish { reflection 0.7 } }
box { <0.1, 4.1, 0>, <3.9, 5.9, 1> pigment { rgb 0.6 } normal { quilted 1 scale 0.3 } }
#if (concat("same", "") = "same" & "a" < "b")
  height_field { function 64, 64 { pigment { crackle scale 0.3 } } rotate x*-90 scale <3.8, 1.8, 0.3> translate <4.1, 4.1, 0.4> pigment { rgb <0.7, 0.6, 0.5> } }
#end

// Warps around any direction, angles of spirals, functions above 1, texture maps of lists.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location -10*z look_at 0 right 8*x up 6*y }
light_source { -100*z rgb 1 parallel point_at 0 }
#macro Tile(X, Y, P) box { <-0.95, -0.95, 0>, <0.95, 0.95, 0.1> pigment { P } finish { ambient 0.2 diffuse 0.8 } translate <X, Y, 0> } #end
#declare M = color_map { [0 rgb <0.1, 0.1, 0.4>] [0.5 rgb <0.9, 0.7, 0.3>] [1 rgb <0.3, 0.1, 0.1>] }
Tile(-3, 2, pigment { gradient x color_map { M } frequency 3 warp { cylindrical orientation -y dist_exp 1 } })
Tile(-1, 2, pigment { gradient y color_map { M } frequency 2 warp { spherical orientation <1, 1, 0> } })
Tile(1, 2, pigment { gradient x color_map { M } frequency 2 warp { toroidal orientation -z major_radius 0.5 } })
Tile(3, 2, pigment { gradient x color_map { M } frequency 3 warp { cylindrical orientation <0.3, 0.5, -1> } })
Tile(-3, 0, pigment { spiral1 3 color_map { M } frequency 1.7 })
Tile(-1, 0, pigment { spiral2 2 color_map { M } frequency 2.3 phase 0.2 })
Tile(1, 0, pigment { function { 3*x + 2*y*y } color_map { M } frequency 1.5 })
Tile(3, 0, pigment { planar color_map { M } warp { planar <1, 0, 1>, 0.3 } })
box { <-1.9, -2.95, 0>, <1.9, -1.05, 0.1>
  texture { gradient x texture_map {
    [0.3 checker texture { pigment { rgb <0.8, 0.3, 0.2> } } texture { pigment { rgb <0.9, 0.9, 0.7> } } scale 0.3]
    [0.7 gradient y texture_map { [0.5 pigment { rgb <0.2, 0.5, 0.3> }] [0.5 pigment { rgb <0.2, 0.2, 0.5> }] } scale 0.4] }
    scale 2 } }
sphere { <-3, -2, 0>, 0.9 pigment { rgb <0.7, 0.6, 0.5> } normal { quilted 0.6 slope_map { [0 <0, 1>] [1 <1, 1>] } scale 0.4 } }
sphere { <3, -2, 0>, 0.9 pigment { rgb <0.4, 0.6, 0.7> } finish { reflection { 0.1, 0.8 falloff 2 } } normal { onion 0.8 scale 0.2 } }

// Patterns that are formulas, one on each square of a board.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <4, 3, -10> direction z right 8*x up 6*y }
#declare Shown = finish { ambient 0 diffuse 0 emission 1 }
#declare Map = color_map { [0 rgb <0.1, 0.1, 0.5>] [0.5 rgb <0.9, 0.8, 0.2>] [1 rgb <0.7, 0.1, 0.1>] }
#macro Tile(X, Y, P)
  box { <X + 0.03, Y + 0.03, 0.0137>, <X + 0.97, Y + 0.97, 1>
    texture { pigment { P } finish { Shown } translate <X + 0.5, Y + 0.5, 0> } }
#end
#macro Small(P) pigment { P color_map { Map } scale 0.4 rotate <10, 20, 5> } #end
Tile(0, 0, Small(pigment { spherical }))
Tile(1, 0, Small(pigment { cylindrical }))
Tile(2, 0, Small(pigment { planar }))
Tile(3, 0, Small(pigment { boxed }))
Tile(4, 0, Small(pigment { onion scale 0.5 }))
Tile(5, 0, Small(pigment { leopard scale 0.2 }))
Tile(6, 0, Small(pigment { radial frequency 5 }))
Tile(7, 0, Small(pigment { marble scale 0.4 }))
Tile(0, 1, Small(pigment { wood scale 0.4 }))
Tile(1, 1, Small(pigment { spiral1 3 scale 0.4 }))
Tile(2, 1, Small(pigment { spiral2 5 scale 0.4 }))
Tile(3, 1, Small(pigment { quilted scale 0.4 }))
Tile(4, 1, Small(pigment { quilted control0 0.2 control1 0.6 scale 0.4 frequency 3 }))
Tile(5, 1, Small(pigment { spiral1 2 ramp_wave scale 0.3 }))
Tile(6, 1, pigment { mandel 30 color_map { Map } scale 0.25 })
Tile(7, 1, pigment { mandel 40 exponent 4 interior 1, 1 exterior 2, 0.2 color_map { Map } scale 0.3 })
Tile(0, 2, pigment { julia <0.353, 0.288>, 30 interior 1, 1 color_map { Map } scale 0.3 })
Tile(1, 2, pigment { julia <0.3, 0.5>, 20 exponent 3 exterior 4, 0.1 color_map { Map } scale 0.3 })
Tile(2, 2, pigment { magnet 1 mandel 30 color_map { Map } scale 0.15 })
Tile(3, 2, pigment { magnet 2 mandel 30 color_map { Map } scale 0.15 })
Tile(4, 2, pigment { magnet 1 julia <1.4, 0.3>, 30 color_map { Map } scale 0.15 })
Tile(5, 2, pigment { square scale 0.2 rotate 80*x })
Tile(6, 2, pigment { triangular scale 0.2 rotate 80*x })
Tile(7, 2, pigment { square pigment { radial frequency 8 scale 0.1 } pigment { rgb 1 } pigment { gradient x scale 0.2 } pigment { rgb 0.2 } scale 0.3 rotate 70*x })
Tile(0, 3, Small(pigment { onion sine_wave frequency 2 phase 0.3 }))
Tile(1, 3, Small(pigment { onion triangle_wave frequency 2 }))
Tile(2, 3, Small(pigment { onion scallop_wave frequency 2 }))
Tile(3, 3, Small(pigment { onion cubic_wave frequency 2 }))
Tile(4, 3, Small(pigment { onion poly_wave 3 frequency 2 }))
Tile(5, 3, Small(pigment { function { abs(sin(5*x)*cos(7*y)) } }))
Tile(6, 3, Small(pigment { pigment_pattern { checker rgb 0.2 rgb 0.9 scale 0.3 } }))
Tile(7, 3, pigment { average pigment_map { [1 gradient x scale 0.2] [2 gradient y scale 0.3] [0.5 rgb <1, 0, 0>] } })
Tile(0, 4, pigment { radial frequency 4 pigment_map { [0 rgb 0] [0.5 gradient y scale 0.1] [1 checker rgb 1, rgb <1, 0, 0> scale 0.1] } rotate 90*x })
Tile(1, 4, pigment { wood scale 0.2 warp { repeat 0.3*x offset 0.05*y flip x } color_map { Map } })
Tile(2, 4, pigment { gradient x scale 0.2 warp { black_hole <0.1, 0, 0>, 0.4 strength 1.5 falloff 1 } color_map { Map } })
Tile(3, 4, pigment { gradient y scale 0.2 warp { black_hole <0, 0.1, 0>, 0.3 inverse } color_map { Map } })
Tile(4, 4, pigment { checker rgb 1 rgb <0, 0.4, 0> scale 0.1 warp { black_hole <0.2, 0.2, 0.2>, 0.2 repeat <0.4, 0.4, 0.4> strength 0.6 } })
Tile(5, 4, pigment { checker rgb 1 rgb <0, 0.4, 0> scale 0.1 warp { planar <1, 1, -2>, 0.2 } })
Tile(6, 4, pigment { boxed scale 0.3 warp { repeat 0.6*y flip y } warp { repeat -0.5*x } rotate 20*z color_map { Map } })
Tile(7, 4, pigment { gradient x frequency 3 phase 0.2 color_map { Map } scale 0.5 rotate 30*z })
Tile(0, 5, pigment { brick rgb 0.2, rgb <0.7, 0.3, 0.2> scale 0.061 warp { repeat 0.366*y flip y } })
Tile(1, 5, pigment { hexagon scale 0.1 warp { repeat 0.25*x } rotate 90*x })
Tile(2, 5, pigment { leopard color_map { [0 rgb 0][0.3 rgb 1][0.6 rgb x][1 rgb z] } scale 0.05 })

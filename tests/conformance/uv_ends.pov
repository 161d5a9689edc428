// Texture coordinates on the flat ends of surfaces of revolution: on beyond 0 and 1, to the axis.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.6, -4.4> look_at <0, -0.1, 0> angle 48 right x*4/3 }
light_source { <3, 8, -6> rgb 1 }
background { rgb <0.3, 0.35, 0.4> }
#declare S = sor { 6, <0.9, -1.5> <1, -1> <1.3, -0.3> <0.8, 0.4> <1.2, 1> <1.4, 1.5> scale 0.8 }
#declare Waves = pigment { uv_mapping gradient y color_map { [0 rgb <0.9, 0.8, 0.5>] [0.5 rgb <0.2, 0.4, 0.6>] [1 rgb <0.9, 0.3, 0.3>] } frequency 0.3 phase 0.31 }
#declare Turns = pigment { uv_mapping gradient x color_map { [0 rgb <0.9, 0.9, 0.9>] [1 rgb <0.1, 0.3, 0.2>] } }
object { S pigment { Waves } translate -1.15*x }
object { S pigment { Turns } rotate 160*x rotate 20*z translate 1.15*x }

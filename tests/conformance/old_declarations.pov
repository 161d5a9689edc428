// Words of old scenes: declarations without semicolons, `refraction`, upper layers that do not filter, a late `orthographic`.
#version 3.0;
global_settings { assumed_gamma 1 }
#declare Half = 0.5
#declare Tint = rgbf <1, 0.4, 0.2, Half>
#declare Place = <-1.5, 0.8, 0> #if (Half = 0.5) #declare Size = 0.8 #else #declare Size = 0.3 #end
camera { location <0, 1.5, -6> direction z up y right 4/3*x look_at <0, 0.6, 0> orthographic }
light_source { <-3, 6, -5> rgb 1 }
plane { y, 0 pigment { checker rgb 0.9 rgb <0.3, 0.4, 0.6> scale Half } }
sphere { Place, Size
  texture { pigment { gradient y color_map { [0 rgb <0.2, 0.5, 0.9>] [1 rgb <0.9, 0.9, 0.2>] } scale 0.4 } }
  texture { pigment { Tint } finish { phong 0.5 } } }
sphere { <0.4, 0.8, 0>, Size pigment { rgbf <0.9, 1, 0.9, 0.9> } finish { refraction 0.8 ior 1.4 phong 0.8 } }
disc { <2, 0.8, 0>, <-0.3, 0.2, -1>, 0.7 0.3 pigment { rgb <0.8, 0.5, 0.3> } finish { diffuse 0.6 0.4 } }

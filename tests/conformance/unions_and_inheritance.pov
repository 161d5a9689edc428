// Copies of unions: who keeps its texture, what moves with the object, what is laid on later.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.9, 0.95, 1> }
camera { location <0, 3.5, -9> look_at <0, 0.9, 0> angle 44 right x*4/3 }
light_source { <5, 9, -8>, rgb 1 }
#default { texture { pigment { rgb <0.7, 0.6, 0.5> } finish { ambient 0.15 diffuse 0.7 } } }
plane { y, 0 }
#declare Lamp = union {
  cylinder { 0, y*1.2, 0.12 }
  cone { y*1.1, 0.6, y*1.7, 0.2 open pigment { checker rgb <0.9, 0.7, 0.3>, rgb <0.8, 0.3, 0.2> scale 0.2 } }
  sphere { y*1.25, 0.2 finish { ambient 0.8 } }
  disc { y*0.02, y, 0.5 texture { pigment { rgb <0.3, 0.4, 0.5> } finish { phong 0.5 } } }
}
object { Lamp translate <-3, 0, 0> }
object { Lamp pigment { rgb <0.3, 0.6, 0.4> } scale <1, 1.3, 1> translate <-1, 0, 0.3> }
object { Lamp texture { pigment { gradient y color_map { [0 rgb <0.3, 0.3, 0.8>] [1 rgb 0.9] } } finish { specular 0.5 } } rotate z*12 translate <1.2, 0.1, 0> }
union { object { Lamp } object { Lamp rotate x*25 translate x*1.1 scale 0.7 } pigment { hexagon rgb 0.9, rgb 0.6, rgb 0.3 scale 0.1 } rotate y*30 translate <2.7, 0, 0.5> }
#default { finish { phong 0.8 } }
sphere { <0, 0.4, -2>, 0.4 pigment { rgb <0.8, 0.2, 0.4> } }

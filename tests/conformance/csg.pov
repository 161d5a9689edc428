// Intersections and differences: nested, turned, of boxes, balls, cylinders, cones, planes and quadrics.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <4, 5, -9> look_at <0, 0.4, 0> angle 38 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1 pigment { checker rgb 0.45 rgb 0.85 } }
difference {
  intersection { box { -1, 1 pigment { rgb <0.9, 0.3, 0.2> } } sphere { 0, 1.35 pigment { rgb <0.3, 0.7, 0.3> } } }
  cylinder { -2*x, 2*x, 0.55 pigment { rgb <1, 0.8, 0.3> } }
  cylinder { -2*y, 2*y, 0.55 }
  cylinder { -2*z, 2*z, 0.55 pigment { rgb <0.5, 0.3, 0.8> } }
  pigment { rgb <0.4, 0.5, 1> }
  finish { phong 0.6 }
  rotate 20*y translate <-1.6, 0.2, -0.6>
}
// Half-spaces alone.
intersection {
  plane { <0, -1, 0>, 1 } plane { <1, 0.7, 0>, 0.7 } plane { <-1, 0.7, 0>, 0.7 } plane { <0, 0.7, 1>, 0.7 } plane { <0, 0.7, -1>, 0.7 }
  pigment { rgb <0.85, 0.65, 0.3> } rotate 30*y translate <1.4, 0, -0.8>
}
// A lens, a dish and a pipe.
#declare Lens = intersection { sphere { <0, 0, -1.2>, 1.6 } sphere { <0, 0, 1.2>, 1.6 } };
object { Lens pigment { rgb <0.4, 0.8, 0.8> } rotate <60, 20, 0> translate <1.6, 0.4, 1.6> }
difference { object { Lens } object { Lens translate <0, 0, -0.3> } pigment { rgb <0.9, 0.5, 0.7> } rotate <100, 0, 10> translate <-0.2, -0.4, 2.6> }
difference {
  merge { cylinder { -y, 1.2*y, 0.7 } cone { 0.4*y, 0.7, 1.2*y, 1.1 } }
  merge { cylinder { -2*y, 2*y, 0.55 } cone { 0.4*y, 0.55, 1.3*y, 1.01 } }
  box { <0, -0.2, -2>, <2, 2, 0> }
  pigment { gradient y color_map { [0 rgb <0.3, 0.5, 0.9>] [1 rgb <0.9, 0.9, 0.6>] } scale 0.5 }
  translate <-3, 0, 2.2>
}
difference {
  box { <-0.6, -1, -0.6>, <0.6, 0.6, 0.6> }
  quadric { <1, 0, 1>, <0, 0, 0>, <0, -1, 0>, 0 scale <0.5, 1, 0.5> translate -0.3*y }
  pigment { rgb <0.6, 0.75, 0.4> } rotate -20*y translate <3.4, 0, 1.2>
}

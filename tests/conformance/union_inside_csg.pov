// Clear unions within intersections, differences and merges: their inner faces show. Nested, placed, taken away, clipped, with media and textures of their own.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 20 }
background { rgb <0.8, 0.82, 0.85> }
camera { location <0.3, 3.6, -8> look_at <0, 0.9, 0> angle 52 right x*4/3 }
light_source { <-4, 8, -7>, rgb 1 }
light_source { <6, 5, -5>, rgb 0.3 }
plane { y, -0.4 pigment { checker rgb <0.75, 0.75, 0.7>, rgb <0.45, 0.5, 0.6> scale 0.7 } }
#declare Two = union { sphere { <-0.4, 0, 0>, 0.7 } sphere { <0.4, 0, 0>, 0.7 } }
#declare Red = texture { pigment { rgbt <1, 0.5, 0.4, 0.6> } finish { ambient 0.2 } }
#declare Blue = texture { pigment { rgbf <0.5, 0.7, 1, 0.8> } finish { phong 0.5 } }
// In an intersection, a difference and a merge.
intersection { object { Two } box { <-2, -0.5, -2>, <2, 0.5, 2> } texture { Red } translate <-2.6, 2.2, 1> }
difference { object { Two } box { <-2, 0, -2>, <2, 2, -0.2> } texture { Red } translate <0, 2.2, 1> }
merge { object { Two } box { <-0.2, -1, -0.2>, <0.2, 1, 0.2> } texture { Red } translate <2.6, 2.2, 1> }
// Taken away, as it is and as a complement.
difference { box { <-1, -0.6, -0.6>, <1, 0.6, 0.6> } object { Two scale 0.8 } texture { Blue } translate <-2.6, 0.5, -0.4> }
intersection { box { <-1, -0.6, -0.6>, <1, 0.6, 0.6> } object { Two scale 0.8 inverse } texture { Red } rotate y*20 translate <0, 0.5, -0.4> }
// Unions of cut unions, one with a texture and a medium of its own.
intersection {
  union {
    difference { object { Two rotate z*90 } box { <-2, -0.1, -2>, <2, 0.1, 2> } texture { Blue } interior { ior 1.1 } }
    cylinder { -0.9*x, 0.9*x, 0.4 }
    merge { sphere { <0.3, 0.3, 0>, 0.5 } sphere { <-0.3, 0.3, 0>, 0.5 } }
  }
  sphere { 0, 1.05 }
  texture { Red } translate <2.6, 0.6, -0.4>
}
// Clipped.
difference { object { Two } sphere { <0, 0, -0.7>, 0.5 } clipped_by { plane { y, 0.3 } } texture { Red } scale 0.7 translate <0, 0, -2.6> }

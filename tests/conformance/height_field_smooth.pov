// Smooth height fields: their normals are rounded, and interpolated where the field stands.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 7, -9> look_at <0, 0.4, 0> angle 40 }
light_source { <-8, 9, -6> rgb 1 }
#declare Hills = height_field {
  function 12, 12 { 0.5 + 0.3*sin(9*x)*cos(7*y) }
  smooth
  translate <-0.5, 0, -0.5>
  pigment { rgb <0.7, 0.9, 0.6> }
  finish { specular 0.5 roughness 0.05 }
}
object { Hills scale <2.6, 1, 2.6> translate <-1.5, 0, 1> }
object { Hills scale <2, 3, 4> rotate <10, 40, 5> translate <1.6, -0.8, 1> }
object { Hills rotate 20*y scale <2, 0.5, 1.5> translate <0, 0, -2> }
plane { y, -1 pigment { rgb 0.5 } }

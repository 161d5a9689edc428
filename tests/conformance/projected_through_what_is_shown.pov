// Light through an object that stands in the scene at the same place.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <2, 3, -10> look_at <-0.5, 1.5, 0> angle 50 }
plane { y, 0 pigment { rgb 0.9 } }
plane { z, 0 pigment { rgb <0.3, 0.5, 0.6> } hollow }
#declare Ring = union {
  torus { 1, 0.12 rotate <100, 10, 0> }
  box { <-0.2, -0.2, -0.05>, <0.2, 0.2, 0.05> rotate 30*z }
  translate <-0.6, 3.2, -6.5>
}
object { Ring pigment { rgb <0.6, 0.8, 0.2> } }
light_source { <0, 4, -10> rgb 1.2 projected_through { Ring } }
light_source { <2, 5, -9> rgb 0.6 shadowless }

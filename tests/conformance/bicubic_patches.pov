// Bicubic patches: as they are, placed, mirrored, and with an edge that is one point.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -9> look_at <0, 0.6, 0> angle 40 }
light_source { <-4, 8, -8>, rgb 1 }
plane { y, -1.2 pigment { checker rgb 0.9, rgb 0.6 } }
#declare Finish = finish { ambient 0.2 diffuse 0.7 }
#declare Wave = bicubic_patch {
  type 1 flatness 0 u_steps 6 v_steps 6
  <-1, 0, -1>, <-0.4, 0.9, -1>, <0.4, -0.8, -1>, <1, 0.1, -1>
  <-1, 0.8, -0.3>, <-0.4, 1.4, -0.3>, <0.4, -1, -0.3>, <1, 0.6, -0.3>
  <-1, -0.7, 0.3>, <-0.4, -0.2, 0.3>, <0.4, 1.8, 0.3>, <1, 0.5, 0.3>
  <-1, 0.2, 1>, <-0.4, 0.1, 1>, <0.4, 0.8, 1>, <1, 0, 1>
}
object { Wave pigment { rgb <1, 0.5, 0.3> } finish { Finish } rotate y*25 translate <-2.2, 0.2, 0> }
object { Wave pigment { rgb <0.4, 0.8, 0.4> } finish { Finish } scale <-0.9, 1.2, 0.9> rotate x*-60 translate <0.2, 1.6, 1.5> }
object { Wave pigment { rgb <1, 0.8, 0.3> } finish { Finish } rotate <-30, 30, 0> translate <2.4, 0.4, 0> }
bicubic_patch {
  type 0 u_steps 6 v_steps 6
  <0, 0.9, 0>, <0, 0.9, 0>, <0, 0.9, 0>, <0, 0.9, 0>
  <-0.5, 0.9, 0>, <-0.5, 0.9, -0.6>, <0.5, 0.9, -0.6>, <0.5, 0.9, 0>
  <-0.9, 0.4, 0>, <-0.9, 0.4, -1.2>, <0.9, 0.4, -1.2>, <0.9, 0.4, 0>
  <-0.6, -0.7, 0>, <-0.6, -0.7, -0.8>, <0.6, -0.7, -0.8>, <0.6, -0.7, 0>
  pigment { rgb <0.4, 0.5, 1> } finish { Finish } translate <0, 0, -0.6>
}

// Julia sets: quaternions squared and cubed, hypercomplex numbers squared, a slice beside the origin.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.5, -9> look_at <0, 0, 0> angle 42 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1.6 pigment { checker rgb 0.45 rgb 0.85 } }
julia_fractal {
  <-0.083, 0, -0.83, -0.025>
  quaternion sqr
  max_iteration 6
  precision 400
  pigment { rgb <0.9, 0.5, 0.3> }
  rotate <0, 40, 0> translate <-2.6, 0, 0>
}
julia_fractal {
  <0.3, 0.2, 0.1, 0>
  quaternion cube
  max_iteration 4
  precision 400
  slice <0, 0, 0, 1>, 0.1
  pigment { rgb <0.4, 0.7, 0.4> }
  rotate <30, 0, 20> translate <0.1, 0, -0.5>
}
julia_fractal {
  <-0.5, 0.25, 0.5, -0.125>
  hypercomplex sqr
  max_iteration 5
  precision 400
  pigment { rgb <0.4, 0.5, 0.9> }
  rotate <0, 25, 0> translate <2.8, 0, 0.4>
}

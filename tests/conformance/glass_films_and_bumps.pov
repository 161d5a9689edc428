// Films of colours where glass reflects totally; bumps that bend rays back to the side of the eye.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
camera { right 4/3*x up y location <0, 2, -7> look_at <0, 0, 0> angle 42 }
light_source { <5, 9, -9> rgb 0.4 }
sky_sphere {
  pigment { planar colour_map { [0 rgb <0.8, 0.7, 0.5>] [1 rgb <0.2, 0.4, 0.8>] } translate -y scale 2 translate y }
}
plane { y, -3 pigment { gradient x colour_map { [0 rgb 0.3] [1 rgb 0.9] } scale 6 translate -3 } }
box {
  -1, 1
  rotate <20, 25, 0>
  translate <-1.4, 0, 0>
  pigment { rgbt 1 }
  finish { irid { 0.65 thickness 0.8 } }
  interior { ior 1.5 }
}
disc {
  0, y, 1.5
  pigment { rgbf <1, 0.9, 0.9, 0.9> }
  normal { gradient x 3 sine_wave scale 0.4 }
  interior { ior 1.4 }
  rotate -10*x
  translate <1.6, -0.6, 0>
}

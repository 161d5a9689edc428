// A sky of two layers, declared, rotated and dimmed, seen directly and in a mirror.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location 0 direction z right x*4/3 up y look_at <0, 0.3, 1> }
background { rgb <0.2, 0.4, 0.6> }
#declare Sky = sky_sphere {
  pigment { gradient y color_map { [0 rgb 0] [1 rgb <1, 0.5, 0>] } scale 2 translate -1 }
  pigment { checker rgbt <1, 0, 0, 0.6> rgbf <1, 1, 0.3, 0.8> scale 0.2 }
  emission <1, 1, 0.5>
}
sky_sphere { Sky rotate 20*z }
sphere { <0, 0, 3>, 0.8 pigment { rgb 0.3 } finish { reflection 0.5 } }
light_source { <-5, 5, -5> rgb 1 }

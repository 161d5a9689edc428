// Two rainbows over each other, through fog; one is an arc that fades towards its ends.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.3, 0.4, 0.6> }
camera { right 4/3*x up y location <0, 1, -10> look_at <0, 3, 0> angle 80 }
light_source { <20, 30, -20> rgb 1 }
rainbow {
  direction <-0.1, 0.1, 1> angle 20 width 8 distance 60
  colour_map { [0 rgbft <1, 0, 0.6, 0.2, 0.6>] [0.5 rgbft <0, 1, 0, 0.5, 0.3>] [1 rgbt <1, 0.2, 0, 0.6>] }
}
rainbow {
  direction <0.2, 0, 1> angle 24 width 6
  colour_map { [0 rgbt <1, 1, 0, 0.7>] [1 rgbt <0, 0, 1, 0.4>] }
  up <0.3, 1, 0> arc_angle 200 falloff_angle 60
}
fog { distance 150 rgbt <0.6, 0.6, 0.7, 0.5> }
plane { y, 0 pigment { checker rgb 0.8 rgb 0.3 scale 3 } finish { reflection 0.3 } }
sphere { <0, 4, 10>, 3 pigment { rgb <1, 0.6, 0.3> } }

// The length of the last point of a fractal, outside and inside, and the colours of mandel itself.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location -5*z look_at 0 right 4*x up 3*y }
#declare Tint = rgb <0.3, 0.5, 0.9>;
#macro Sheet(X, Y, Paint)
  box {
    <-0.64, -0.71, 0>, <0.64, 0.71, 0.1>
    pigment { Paint scale 0.6 translate <0.0137, 0.0211, 0> }
    finish { ambient 1 diffuse 0 }
    translate <X, Y, 0>
  }
#end
Sheet(-1.33, 0.75, pigment { mandel 60 })
Sheet(0, 0.75, pigment { mandel 9 interior 6, 1.3 exterior 6, 0.2 color_map { [0 rgb 0] [1 rgb x + y] } })
Sheet(1.33, 0.75, pigment { mandel 20 exponent 4 interior 6, 0.4 })
Sheet(-1.33, -0.75, pigment { julia <0.2, 0.3>, 7 interior 6, 0.7 color_map { [0 rgb z] [1 rgb 1] } })
Sheet(0, -0.75, pigment { magnet 1 julia <0.25, 0.07>, 7 interior 6, 0.7 color_map { [0 rgb 0] [1 rgb <1, 0.6, 0.2>] } })
Sheet(1.33, -0.75, pigment { magnet 2 mandel 9 interior 6, 0.8 exterior 6, 0.01 color_map { [0 rgb 0] [1 rgb y] } })
sphere { <0, 0, -0.2>, 0.3 pigment { uv_mapping Tint } finish { ambient 1 diffuse 0 } }

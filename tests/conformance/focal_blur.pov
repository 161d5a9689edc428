// Focal blur, with so many rays that chance is not seen.
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
  right 4/3*x up y location <0, 1, -6> look_at <0.3, 0.5, 0>
  aperture 0.8 focal_point <0.5, 0, -4>
  #local N = (image_width > 320 ? 20 : 1000);
  blur_samples N, N
}
light_source { <4, 9, -6> rgb 1 shadowless }
plane { y, -1 pigment { gradient z colour_map { [0 rgb 0.2] [1 rgb 0.9] } scale 8 } }
sphere { <0.5, 0, 0>, 1 pigment { gradient x colour_map { [0 rgb <1, 0.6, 0.3>] [1 rgb <0.3, 0.6, 1>] } scale 2 translate -x } }
sphere { <-1.5, 0.5, 4>, 1.2 pigment { rgb <0.3, 0.8, 0.5> } }
cylinder { <2, -1, -2>, <2, 1, -2>, 0.2 pigment { rgb <0.8, 0.3, 0.5> } }

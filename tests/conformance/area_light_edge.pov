// The shadow of a ball across the edge of a spotlight that lights surfaces from all points of its area.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <-2, 10, -1> look_at <-2, -2, -1> up y*6 right x*8 }
light_source { <-3.796, 7.955, 2.19> rgb 1 spotlight point_at <0.83, -0.467, 0.676> radius 9.131 falloff 13.553 tightness 0
  area_light 1.412*x, 1.703*z, 5, 3 area_illumination }
plane { y, -2 pigment { rgb 0.6 } finish { ambient 0 } }
sphere { <-1.8, -0.64, 0.27>, 0.82 pigment { rgb <1, 0.5, 0.3> } no_image }

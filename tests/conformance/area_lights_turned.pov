// Area lights that turn to what they light, round though they are not `circular`.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 9, -9> look_at <0, 0, 0.4> angle 45 }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.8 phong 0.6 phong_size 300 } }
union {
  box { <-0.3, 0, -0.3>, <0.3, 1.2, 0.3> translate <-2, 0, 1> }
  sphere { <0, 0.7, 0>, 0.6 translate <2, 0, 1.5> }
  torus { 0.6, 0.15 translate <-0.5, 0.8, -1.5> }
  pigment { rgb <1, 0.7, 0.4> }
}
light_source { <-4, 6, 2> rgb <0.5, 0.3, 0.2> area_light 3*x, 1.5*z, 3, 3 orient }
light_source { <1, 5, 3> rgb <0.2, 0.4, 0.3> area_light 1.5*x, 3*z, 2, 3 orient area_illumination }
light_source { <4, 6, 3> rgb <0.2, 0.2, 0.4> area_light 2*x, 3*z, 5, 1 orient adaptive 1 }

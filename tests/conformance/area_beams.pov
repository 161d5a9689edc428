// Area lights whose points light surfaces: outside the beam of the middle, without shadows, and along a wall.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.7, 2.6, -10> look_at <0, -0.16, 0> angle 60 right x*4/3 }
light_source { <0, 4, -1> rgb <0.8, 0.2, 0.1> spotlight point_at <-1, -2, 1> radius 10 falloff 20 tightness 5
  area_light 2*x, 2*z, 3, 3 area_illumination on projected_through { sphere { <-0.3, 2.8, -0.6>, 0.6 } } }
light_source { <3, 2, -3> rgb <0.1, 0.4, 0.2> shadowless area_light 2*x, 2*y, 3, 3 area_illumination on }
light_source { <0, 1, 0> rgb <0.1, 0.2, 0.6> parallel point_at <0.5, 0, 1> area_light 2*x, 2*z, 2, 2 area_illumination on }
light_source { <0, 1, 0> rgb <0.3, 0.2, 0.1> parallel point_at <0.5, 0, 1> area_light 2*x, 2*z, 2, 2 }
plane { z, 4 pigment { rgb 0.6 } finish { ambient 0.05 } }
plane { y, -2.0137 pigment { rgb 0.6 } finish { ambient 0.05 } }
sphere { <1, 2.5, -1>, 0.5 pigment { rgb 1 } finish { phong 0.5 } }
sphere { <-1.7, -0.5, 0>, 0.5 pigment { rgb 1 } finish { specular 0.5 } }
sphere { <1.3, -0.8, 1>, 0.5 pigment { rgb 1 } }

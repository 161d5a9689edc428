// Each point of a parallel area light is a parallel light of its own, which is aimed at the same point.
// It throws shadows up to a plane of its own.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 7, -9> look_at <0, 0.3, 0.5> right 4/3*x angle 55 }

light_source { <-7, 6, -2> rgb <1, 0.8, 0.6>*0.5 parallel point_at <1, 0, 1> area_light <3, 1, 0>, <0, 2, 3>, 4, 3 }
light_source { <6, 5, -4> rgb <0.5, 0.7, 1>*0.4
  cylinder point_at <0.5, 0, 0> radius 2 falloff 4 area_light 4*x, 3*y, 3, 3 area_illumination on }
light_source { <1, 7, 6> rgb <0.4, 0.6, 0.4>
  spotlight parallel point_at <0, 0, 1> radius 20 falloff 40 area_light 9*x, 5*z, 5, 5 area_illumination on }
light_source { <0, 1.5, -6> rgb 0.2 parallel point_at <0, 0, -2> area_light 3*x, 4*y, 3, 3 adaptive 1 }

plane { y, 0 pigment { rgb 1 } finish { ambient 0.05 diffuse 0.7 } }
#for (I, -2, 2)
  sphere { <1.6*I, 0.9, 0.7*I + 0.2>, 0.5 pigment { rgb <1, 0.6, 0.5> } finish { ambient 0.05 diffuse 0.7 } }
  box { <-0.15, 0, -0.15>, <0.15, 1.4, 0.15> rotate 30*I*y translate <1.7*I, 0, -1.6>
    pigment { rgb <0.5, 0.7, 1> } finish { ambient 0.05 diffuse 0.7 } }
#end

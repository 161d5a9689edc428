// A wide angle close to the floor, the horizon tilted by sky.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.5, 0.7, 1> }
camera { sky <0.25, 1, 0> location <0, 0.8, -3> right x*4/3 up y angle 105 look_at <0.3, 0.9, 0> }
light_source { <-20, 30, -10>, rgb 1 }
plane { y, 0 pigment { checker rgb <0.9, 0.9, 0.8>, rgb <0.3, 0.4, 0.3> } finish { reflection 0.1 } }
#for (I, -4, 4)
  cylinder { <I*1.3, 0.001, 2+abs(I)*0.4>, <I*1.3, 2.4, 2+abs(I)*0.4>, 0.25 pigment { rgb <0.8, 0.75-0.06*abs(I), 0.5> } finish { phong 0.3 } }
  sphere { <I*1.3, 2.75, 2+abs(I)*0.4>, 0.35 pigment { rgb <0.8, 0.3, 0.2+0.08*abs(I)> } finish { specular 0.6 roughness 0.02 } }
#end
sphere { <0.4, 0.5, -1.3>, 0.5 pigment { rgb 0.1 } finish { reflection 0.8 } }

// srgb colours in a linear scene, beside plain rgb ones.
#version 3.7;
global_settings { assumed_gamma 1 ambient_light rgb <1.5, 1.2, 0.8> }
background { srgb <0.2, 0.3, 0.5> }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> angle 48 right x*4/3 }
light_source { <-5, 7, -7>, color srgb <1, 0.9, 0.8> }
plane { y, 0 pigment { checker srgb <0.9, 0.9, 0.8>, srgb <0.4, 0.45, 0.5> scale 0.8 } }
#for (I, 0, 4)
  sphere { <-2+I, 0.5, 0.3>, 0.45 pigment { srgb <0.1+0.2*I, 0.5, 0.9-0.2*I> } finish { ambient 0.1*I } }
  sphere { <-2+I, 0.4, -1>, 0.35 pigment { rgb <0.1+0.2*I, 0.5, 0.9-0.2*I> } finish { ambient 0 emission 0.08*I } }
#end

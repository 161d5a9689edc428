// Layers of partly clear texture over each other, each with its own finish; shadows through them.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.8, 0.8, 0.9> }
camera { location <0, 3, -7> look_at <0, 0.8, 0> angle 46 right x*4/3 }
light_source { <4, 9, -6>, rgb 1 }
plane { y, 0 texture { pigment { rgb <0.75, 0.7, 0.6> } } texture { pigment { checker rgbt <0.2, 0.3, 0.2, 0.4>, rgbt <0, 0, 0, 1> } finish { reflection 0.08 } } }
sphere { <-1.8, 1, 0>, 1
  texture { pigment { rgb <0.9, 0.3, 0.2> } finish { ambient 0.2 } }
  texture { pigment { gradient y color_map { [0.4 rgbt <1, 1, 1, 1>] [0.4 rgbt <0.2, 0.2, 0.6, 0.2>] } scale 0.4 } finish { phong 0.8 } } }
sphere { <0.5, 0.9, 0.6>, 0.9
  texture { pigment { rgbf <0.9, 0.9, 0.4, 0.5> } finish { diffuse 0.5 } }
  texture { pigment { hexagon rgbt <1, 1, 1, 0.9>, rgbf <0.2, 0.7, 0.4, 0.7>, rgbt <0.4, 0.2, 0.2, 0.5> scale 0.2 } finish { specular 0.5 reflection 0.1 conserve_energy } } }
box { <1.5, 0.01, -1>, <2.7, 1.2, 0.2> rotate y*-10
  texture { pigment { rgb 0.8 } }
  texture { pigment { brick rgbt <0.3, 0.3, 0.3, 0.2>, rgbt <1, 1, 1, 1> scale 0.08 translate 0.013 } } }

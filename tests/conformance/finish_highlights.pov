// A grid of phong and specular highlights, brilliance and metallic from soft to sharp.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb 0.12 }
camera { location <0, 0, -13> look_at 0 angle 42 right x*4/3 }
light_source { <-7, 9, -12>, rgb <1, 1, 0.9> }
light_source { <9, -3, -8>, rgb <0.3, 0.35, 0.5> }
#declare C = array[4] { rgb <0.8, 0.3, 0.3>, rgb <0.3, 0.7, 0.4>, rgb <0.3, 0.4, 0.9>, rgb <0.85, 0.65, 0.25> }
#for (I, 0, 4)
  sphere { <-3.6+1.8*I, 2.4, 0>, 0.75 pigment { C[0] } finish { phong 0.9 phong_size 4*pow(2.6, I) } }
  sphere { <-3.6+1.8*I, 0.8, 0>, 0.75 pigment { C[1] } finish { specular 0.9 roughness 0.3/pow(3, I) } }
  sphere { <-3.6+1.8*I, -0.8, 0>, 0.75 pigment { C[2] } finish { diffuse 0.8 brilliance 0.5*pow(1.9, I) ambient 0.05 } }
  sphere { <-3.6+1.8*I, -2.4, 0>, 0.75 pigment { C[3] } finish { diffuse 0.4 phong 0.8 phong_size 12 specular 0.5 roughness 0.04 metallic 0.25*I } }
#end
plane { z, 4 pigment { rgb 0.3 } }

// The same family under matrices with shear, reflection and unequal scales.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.75, 0.8, 0.85> }
camera { location <0, 2.5, -10> look_at <0, 0.5, 0> angle 50 right x*4/3 }
light_source { <-7, 14, -9>, rgb 1 }
#declare Shear = transform { matrix <1, 0.6, 0, -0.3, 1, 0.4, 0.2, 0, 1, 0, 0, 0> }
#declare Flip = transform { matrix <-1, 0, 0.3, 0.25, 0.8, 0, 0, -0.5, 1.1, 0, 0, 0> }
plane { y, -1.8 pigment { checker rgb 0.8, rgb 0.5 scale 0.9 } }
sphere { 0, 1 transform { Shear } translate <-3, 0.4, 0> pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.6 phong_size 20 } }
cylinder { -y, y, 0.75 transform { Shear } rotate y*30 translate <-0.6, 0.4, 0.5> pigment { rgb <0.4, 0.7, 0.4> } finish { phong 0.5 } }
cone { -y, 1, y, 0.3 transform { Flip } translate <1.9, 0.3, 0.2> pigment { rgb <0.4, 0.5, 0.9> } finish { specular 0.5 roughness 0.04 } }
quadric { <1, 0.3, 1>, <0.2, 0.1, -0.3>, <0, 0.2, 0>, -0.6 transform { Flip } scale 0.9 translate <3.8, 0.6, 0.6>
  pigment { rgb <0.8, 0.7, 0.3> } finish { specular 0.6 roughness 0.05 } }
box { -0.5, 0.5 transform { Shear } scale <1.3, 0.5, 1> translate <0.4, -1.2, -2.2> pigment { rgb <0.7, 0.4, 0.7> } }

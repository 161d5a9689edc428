// The same still life in large units and far from the origin.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.7, 0.8, 0.9> }
#declare O = <4000, 250, -9000>;
#declare K = 120;
camera { location O+<0, 3, -8>*K look_at O+<0, 0.8, 0>*K angle 45 right x*4/3 }
light_source { O+<-6, 10, -8>*K, rgb 1 }
plane { y, 250 pigment { checker rgb 0.85, rgb <0.4, 0.45, 0.4> scale 131 } }
sphere { O+<-1.8, 0.9, 0>*K, 0.9*K pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.6 reflection 0.2 } }
cylinder { O+<0.3, 0.01, 0.4>*K, O+<0.6, 1.7, 0.4>*K, 0.5*K pigment { gradient y color_map { [0 rgb <0.2, 0.5, 0.3>] [1 rgb <0.8, 0.9, 0.6>] } scale 77 } }
cone { O+<2.2, 0.01, 0>*K, 0.9*K, O+<2.2, 1.6, 0>*K, 0.1*K pigment { rgb <0.4, 0.5, 0.9> } finish { specular 0.5 } }
box { O+<-0.6, 0.01, -2>*K, O+<0.4, 0.5, -1.4>*K pigment { rgb <0.8, 0.7, 0.3> } }

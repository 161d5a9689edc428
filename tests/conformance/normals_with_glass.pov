// Bumpy glass, mirrors and layers.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -8> look_at 0 right 4/3*x angle 40 }
light_source { <-10, 15, -20> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.2, 0.3, 0.5>] [1 rgb 1] } } }
disc { -y, y, 4 pigment { checker rgb 0.9 rgb <0.2, 0.4, 0.2> } normal { gradient z 1 sine_wave scale 3 } finish { reflection 0.3 } }
sphere { <-1.5, 0, 0>, 1 pigment { rgbt <1, 1, 1, 0.9> } normal { leopard 1 scale 0.2 } finish { phong 0.5 } interior { ior 1.4 } }
sphere { <1.5, 0, 0>, 1
  texture { pigment { rgb <0.6, 0.2, 0.1> } normal { onion 2 sine_wave scale 0.15 } }
  texture { pigment { rgbt <1, 1, 1, 0.8> } finish { phong 1 reflection 0.2 } } }

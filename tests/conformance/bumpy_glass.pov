// Bumps so steep that they face away from the eye, on glass; films of colours on mirrors.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 4, -6> look_at <0, 0, 0.5> angle 45 }
light_source { <5, 9, -9> rgb 1 }
sky_sphere { pigment { gradient y colour_map { [0 rgb <0.8, 0.7, 0.5>] [1 rgb <0.2, 0.4, 0.8>] } } }
plane { y, -1.5 pigment { gradient x colour_map { [0 rgb 0.3] [1 rgb 0.9] } scale 6 translate -3 } }
#declare Clear = pigment { rgbf <1, 0.9, 0.9, 0.9> }
disc { 0, y, 1.6 pigment { Clear } interior { ior 1.3 } normal { onion 2 sine_wave frequency 2 } translate <-1.4, 0, 1> }
sphere {
  <1.6, 0, 0>, 1.2 pigment { Clear } interior { ior 1.45 }
  finish { reflection 0.3 specular 0.5 irid { 0.65 thickness 0.8 } }
}
box { <-2, -1, -2>, <-0.5, -0.2, -1.8> pigment { rgb 0.2 } finish { reflection 0.6 irid { 0.4 thickness 0.4 } } }

// Rays that are perturbed like normals: waves in x, ripples of wood around the middle.
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
  right 4/3*x up y location <0.2, 0.5, -3> look_at <1, 0.4, 3>
  normal { average normal_map { [1 gradient x 1 sine_wave scale 0.2] [1 wood 1.5 scale 0.15] } }
}
sky_sphere { pigment { checker rgb <0.4, 0.6, 0.9> rgb 0.9 scale 0.3 } }
light_source { <2, 9, -4> rgb 1 }
plane { y, -1 pigment { checker rgb 0.8 rgb 0.3 } }
sphere { <1, 0.5, 2>, 1 pigment { rgb <1, 0.6, 0.3> } }

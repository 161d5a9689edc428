// A normal in a fisheye camera, evaluated at the angles of the picture.
#version 3.7;
global_settings { assumed_gamma 1 }
sky_sphere { pigment { leopard scale 0.2 } }
camera { fisheye angle 120 location <0.2, 1.0, -3> right x*4/3 look_at <0, 0.1, 0> normal { onion 0.1 scale 0.3 } }
sphere { <0.2, 0.1, 0>, 1 pigment { rgb <0.9, 0.5, 0.3> } finish { ambient 0.3 } }
light_source { <3, 8, -6> rgb 1 }

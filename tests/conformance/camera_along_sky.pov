// A camera that looks along its sky, with an `up` that counts as mirrored and a `right` that is oblique.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.3, 6, 0.2> right <4/3, 0.4, 0> up z look_at <0.3, 0, 0.2> angle 50 }
light_source { <3, 8, -6> rgb 1 }
plane { y, -1 pigment { checker rgb 0.9 rgb <0.3, 0.5, 0.7> } }
cone { -y, 0.8, <0.6, 1.2, 0.3>, 0.1 pigment { rgb <0.9, 0.5, 0.2> } }
box { <-2, -1, 0.5>, <-1, 0.3, 1.4> pigment { rgb <0.4, 0.7, 0.3> } }
sphere { <1.4, -0.4, -1.2>, 0.6 pigment { rgb <0.7, 0.3, 0.6> } }

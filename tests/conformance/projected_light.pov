// Light that shines through objects only: a sphere, and for an area light a box.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { right 4/3*x up y location <0, 6, -10> look_at 0 angle 50 }
light_source { <0, 8, 0> rgb 1 projected_through { sphere { <0.5, 5, 0>, 0.8 } } }
light_source { <-4, 8, 0> rgb <0.3, 0.5, 1> area_light 2*x, 2*z, 5, 5 projected_through { box { <-3.5, 4, -0.5>, <-2.5, 4.2, 0.5> } } }
light_source { <4, 8, 0> rgb <0.5, 1, 0.3> shadowless projected_through { union { sphere { <3.6, 5, 0>, 0.4 } box { <4, 5, -1>, <4.2, 5.2, 1> } } } }
plane { y, 0 pigment { rgb 1 } finish { ambient 0.05 diffuse 0.7 phong 0.5 } }
box { <-1, 0, -1>, <1, 1, 1> pigment { rgb <1, 0.8, 0.6> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <0.5, 6.5, 0>, 0.2 pigment { rgb 1 } }
sphere { <0.8, 3, 0>, 0.3 pigment { rgbf <1, 0.8, 1, 0.8> } }
sphere { <0, 5, 0.7>, 0.15 pigment { rgb 1 } }

// Area lights that shine through an object: without shadows, too, each of their points has a way of
// its own through it.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1, -5> look_at 0 right x*4/3 }
#declare Window = disc { <-0.29, 3.063, -3.804>, y, 0.821, 0.2 }
light_source { <-0.484, 5.105, -6.34> rgb <0.9, 0.5, 0.2> shadowless area_light 1.782*x, 1.158*z, 3, 3 projected_through { Window } }
light_source { <-0.484, 5.105, -6.34> rgb <0.1, 0.4, 0.7> area_light 1.2*x, 2*z, 4, 3 adaptive 1 projected_through { Window } }
light_source { <4, 5, -3> rgb <0.1, 0.2, 0.1> shadowless area_light 2*x, 2*z, 3, 3 adaptive 0 }
plane { y, -1 pigment { rgb 1 } finish { ambient 0 diffuse 0.8 } }
sphere { <0.3, -0.4, -1>, 0.4 pigment { rgb 1 } finish { phong 0.5 } }
sphere { <-0.5, -0.4, -0.6>, 0.3 pigment { rgbt <1, 0.5, 0.2, 0.7> } }

// Mirror balls and a standing mirror over a pattern: reflections of reflections.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 8 }
background { rgb <0.4, 0.55, 0.8> }
camera { location <0, 2.2, -6.5> look_at <0, 0.8, 0> angle 50 right x*4/3 }
light_source { <5, 8, -6>, rgb 0.9 }
plane { y, 0 pigment { hexagon rgb 0.85, rgb <0.7, 0.35, 0.25>, rgb <0.3, 0.4, 0.5> scale 0.6 } }
sphere { <-1.3, 1, 0>, 1 pigment { rgb 0.05 } finish { ambient 0 diffuse 0.3 reflection 0.8 } }
sphere { <1.1, 0.8, -0.4>, 0.8 pigment { rgb <0.9, 0.7, 0.3> } finish { diffuse 0.3 reflection { 0.6 metallic } specular 0.6 metallic } }
sphere { <0.1, 0.35, -1.7>, 0.35 pigment { rgb <0.7, 0.1, 0.1> } finish { reflection { 0.05, 0.6 falloff 3 } } }
box { <-3.4, 0.1, 2.4>, <3.4, 2.8, 2.5> rotate y*8 pigment { rgb <0.1, 0.12, 0.1> } finish { ambient 0 diffuse 0.2 reflection 0.7 } }
cylinder { <2.7, 0.01, 0.6>, <2.7, 1.7, 0.6>, 0.3 pigment { rgb <0.2, 0.5, 0.3> } finish { reflection rgb <0.1, 0.4, 0.2> } }

// Fading with one of distance and power missing, zero or negative; spotlights, beams and finishes at the ends of their ranges.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -11> look_at <0, 0.2, 0> angle 45 }
light_source { <-4, 9, -6>, rgb 0.6 }
light_source { <4, 3, -2>, rgb 0.4 fade_distance -4 fade_power 2 }
light_source { <-4, 3, 1>, rgb 0.3 fade_distance 4 fade_power -1 }
light_source { <0, 4, 0>, rgb <0.6, 0.2, 0.1> spotlight point_at <-3, 0, 2> radius 20 falloff 10 }
light_source { <0, 4, 1>, rgb <0.1, 0.2, 0.6> cylinder point_at <0, 0, 3> radius 0 falloff 0.8 tightness 1 }
light_source { <1, 4, 1>, rgb 1 spotlight point_at <1, 4, 1> }
plane { y, -1 pigment { checker rgb 1 rgb 0.7 } }

sphere { <-3.4, 0, 0>, 0.8 pigment { rgbf <1, 0.95, 0.9, 0.9> } interior { fade_distance 1 fade_color <0.3, 0.6, 0.9> } }
sphere { <-1.7, 0, 0>, 0.8 pigment { rgbf <1, 0.95, 0.9, 0.9> } interior { fade_power 2 fade_color <0.3, 0.6, 0.9> } }
sphere { <0, 0, 0>, 0.8 pigment { rgbf <1, 0.95, 0.9, 0.9> } interior { fade_distance 1 fade_power -1 fade_color <0.3, 0.6, 0.9> } }
sphere { <1.7, 0, 0>, 0.8 pigment { rgbf <1, 0.95, 0.9, 0.9> } interior { fade_distance -1 fade_power 2 fade_color <0.3, 0.6, 0.9> } }
sphere { <3.4, 0, 0>, 0.8 pigment { rgbf <1, 0.95, 0.9, 0.9> } interior { fade_distance 1 fade_power 1 fade_color <0.3, 0.6, 0.9> } }

sphere { <-2.6, 0, 2.5>, 0.8 pigment { rgb <0.9, 0.6, 0.3> } finish { phong -1 specular 0.5 metallic -1 } }
sphere { <-0.9, 0, 2.5>, 0.8 pigment { rgb <0.9, 0.6, 0.3> } finish { diffuse -0.5 phong 0.5 } }
sphere { <0.9, 0, 2.5>, 0.8 pigment { rgb <0.9, 0.6, 0.3> } finish { diffuse 0.6, -0.3 specular -1 } }
sphere { <2.6, 0, 2.5>, 0.8 pigment { rgbt <0.9, 0.6, 0.3, 0.4> } finish { diffuse 0, 0.6 } }

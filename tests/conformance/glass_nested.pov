// Interiors within interiors: a glass with water and an air bubble, an eccentric shell, a glass core.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 20 }
background { rgb 0.9 }
camera { location <0, 1.9, -6> look_at <0, 0.9, 0> angle 45 right x*4/3 }
light_source { <4, 9, -6>, rgb 1 }
plane { y, 0 pigment { brick rgb 0.75, rgb <0.6, 0.3, 0.2> scale 0.12 rotate x*90 } }
plane { z, 6 pigment { hexagon rgb <0.8, 0.8, 0.5>, rgb <0.4, 0.6, 0.8>, rgb <0.8, 0.5, 0.4> rotate x*90 scale 0.8 } finish { ambient 0.5 diffuse 0.4 } }
#declare Film = finish { ambient 0 diffuse 0 specular 0.5 roughness 0.01 }
union {
  cylinder { <0, 0.05, 0>, <0, 1.9, 0>, 0.8 pigment { rgbf <0.96, 0.98, 1, 0.95> } finish { Film } interior { ior 1.5 } }
  cylinder { <0, 0.15, 0>, <0, 1.8, 0>, 0.7 pigment { rgbf <0.9, 0.95, 1, 0.95> } finish { Film } interior { ior 1.33 } }
  sphere { <0.15, 0.9, -0.1>, 0.35 pigment { rgbf 1 } finish { Film } interior { ior 1 } }
  translate x*-1.3
}
sphere { <1.2, 1, 0>, 0.95 pigment { rgbf <1, 0.97, 0.95, 0.95> } finish { Film } interior { ior 1.5 } }
sphere { <1.3, 1.1, 0.1>, 0.6 pigment { rgbf <0.95, 1, 0.95, 0.95> } finish { Film } interior { ior 1.2 } }
sphere { <1.1, 0.9, 0>, 0.2 pigment { rgb <0.8, 0.2, 0.2> } }

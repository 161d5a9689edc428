// Everything declared first: cameras, lights, finishes, interiors, materials, maps, then used and changed.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }
#declare View = camera { location <0, 2.4, -7> look_at <0, 0.9, 0> angle 46 right x*4/3 }
#declare Sun = light_source { 0, rgb <1, 0.95, 0.85> translate <-6, 10, -7> }
#declare Ramp = color_map { [0 rgb <0.15, 0.3, 0.5>] [0.6 rgb <0.8, 0.7, 0.5>] [1 rgb <0.7, 0.2, 0.1>] }
#declare Stripes = pigment { gradient x color_map { Ramp } scale 0.6 }
#declare Gloss = finish { specular 0.6 roughness 0.02 diffuse 0.7 }
#declare Lens = material { texture { pigment { rgbf <0.95, 1, 0.97, 0.9> } finish { Gloss diffuse 0.05 reflection 0.08 } } interior { ior 1.45 } }
#declare Move = transform { rotate y*30 translate <0.2, 0, 0> }
#declare Base = box { <-0.6, 0, -0.6>, <0.6, 0.8, 0.6> }
#declare Unit = <0.3, 0.6, 0.9>;
#declare R = 0.75;
camera { View }
light_source { Sun }
background { rgb Unit*0.5 }
plane { y, 0 pigment { checker rgb Unit.x*2, rgb Unit.z*0.4 } finish { Gloss specular 0 } }
object { Base transform { Move } pigment { Stripes rotate z*90 } finish { Gloss } }
sphere { <-2, R, 0>, R material { Lens } }
sphere { <2, R, 0.2>, R pigment { Stripes rotate <0, 45, 20> } finish { Gloss ambient 0.2 } }
object { Base scale <0.4, 1, 0.4> transform { Move } translate <0, 0.8, 0> texture { pigment { color rgb Unit } finish { Gloss } } }
cylinder { <1, 0.02, -1.8>, <1, 0.5, -1.8>, 0.35 material { Lens scale 2 } }

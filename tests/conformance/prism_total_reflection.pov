// Total internal reflection: a prism, a cube seen on edge, and a ball of diamond.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 16 }
background { rgb <0.9, 0.93, 1> }
camera { location <0, 2.2, -7> look_at <0, 0.9, 0> angle 44 right x*4/3 }
light_source { <-4, 9, -8>, rgb 1 }
plane { y, 0 pigment { checker rgb <0.9, 0.6, 0.3>, rgb <0.2, 0.3, 0.4> scale 0.8 } }
plane { z, 8 pigment { gradient y color_map { [0 rgb <0.3, 0.6, 0.3>] [0.5 rgb <0.9, 0.9, 0.6>] [1 rgb <0.4, 0.5, 0.9>] } scale 1.5 } finish { ambient 0.6 diffuse 0.3 } }
#declare Clear = texture { pigment { rgbt <1, 1, 1, 0.98> } finish { ambient 0 diffuse 0 specular 0.4 roughness 0.01 reflection { 0, 0.9 fresnel } } }
mesh {
  triangle { <-1, 0, -0.7>, <1, 0, -0.7>, <0, 1.6, -0.7> } triangle { <-1, 0, 0.7>, <0, 1.6, 0.7>, <1, 0, 0.7> }
  triangle { <-1, 0, -0.7>, <-1, 0, 0.7>, <1, 0, 0.7> } triangle { <-1, 0, -0.7>, <1, 0, 0.7>, <1, 0, -0.7> }
  triangle { <1, 0, -0.7>, <1, 0, 0.7>, <0, 1.6, 0.7> } triangle { <1, 0, -0.7>, <0, 1.6, 0.7>, <0, 1.6, -0.7> }
  triangle { <-1, 0, -0.7>, <0, 1.6, -0.7>, <0, 1.6, 0.7> } triangle { <-1, 0, -0.7>, <0, 1.6, 0.7>, <-1, 0, 0.7> }
  texture { Clear } interior { ior 1.5 } rotate y*35 translate <-1.9, 0.1, 0>
}
box { -0.6, 0.6 rotate <0, 45, 0> rotate x*20 translate <0.4, 1.05, 0.5> texture { Clear } interior { ior 1.52 } }
sphere { <2.2, 0.9, 0>, 0.8 texture { Clear } interior { ior 2.4 } }

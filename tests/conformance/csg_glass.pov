// Light through solids of solids: bent where they begin and end, and nowhere inside.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }
camera { location <0.5, 3, -8> look_at <0, 0.1, 0> angle 38 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
background { rgb <0.5, 0.6, 0.75> }
plane { y, -1.2 pigment { checker rgb <0.3, 0.35, 0.4> rgb <0.9, 0.9, 0.85> scale 0.6 } }
#declare Glass = material {
  texture { pigment { rgbf <0.95, 1, 0.97, 0.92> } finish { ambient 0 diffuse 0.05 specular 0.5 roughness 0.01 reflection { 0.02, 0.6 fresnel on } } }
  interior { ior 1.5 fade_distance 3 fade_power 2 fade_color <0.5, 0.9, 0.7> }
}
merge { sphere { <-0.5, 0, 0>, 0.9 } sphere { <0.5, 0, 0>, 0.9 } material { Glass } translate <-1.9, 0, 0> }
difference { sphere { 0, 0.8 } sphere { <0.2, 0.2, 0>, 0.4 } material { Glass } translate <0.5, -0.2, 0.8> }
intersection { sphere { <0, 0, -1.2>, 1.6 } sphere { <0, 0, 1.2>, 1.6 } material { Glass } rotate 25*y translate <1.9, 0, -1.2> }
sphere { <0, -0.6, 3>, 0.6 pigment { rgb <0.9, 0.3, 0.2> } }
sphere { <-2, -0.6, 2.4>, 0.6 pigment { rgb <0.2, 0.4, 0.9> } }

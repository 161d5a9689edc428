// Surfaces of `crackle`: distances to random points, with several forms and metrics.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.2, -6> look_at <0, 0, 0> angle 44 right x*4/3 }
light_source { <4, 6, -8> rgb 1 }
light_source { <-6, 2, -5> rgb 0.3 shadowless }
plane { y, -1.4 pigment { rgb <0.8, 0.75, 0.7> } }

#macro Rock(At, Cracks, Depth, Colour)
  isosurface {
    function { sqrt(x*x + y*y + z*z) - 1 + Depth*Cracks(x, y, z) }
    contained_by { sphere { 0, 1.05 } }
    accuracy 0.00001
    max_gradient 4
    pigment { rgb Colour }
    finish { ambient 0.1 diffuse 0.8 }
    translate At
  }
#end

Rock(<-1.6, 0.5, 0.6>, function { pattern { crackle scale 0.5 } }, 0.2, <0.8, 0.5, 0.3>)
Rock(<0.7, 0.5, 0.8>, function { pattern { crackle form <1, 0, 0> metric 3 scale 0.4 rotate 20*z } }, -0.1, <0.4, 0.6, 0.8>)
Rock(<-0.7, -0.7, -0.8>, function { pattern { crackle metric 1 offset 0.2 scale 0.6 } }, 0.2, <0.5, 0.7, 0.4>)
Rock(<1.4, -0.7, -0.8>, function { pattern { crackle form <-0.4, -0.2, 0.6> scale 0.5 sine_wave frequency 2 } }, 0.15, <0.7, 0.6, 0.3>)

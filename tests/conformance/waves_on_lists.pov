// A frequency and a wave on lists: an entry is blended with the next.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -5> look_at 0 right x*4/3 }
light_source { <2, 3, -5> rgb 1 }
plane { z, 0
  texture {
    checker
    texture { pigment { gradient x color_map { [0 rgb 1] [1 rgb <0.3, 0.5, 1>] } } finish { phong 0.5 } }
    texture { pigment { rgb <0.8, 0.2, 0.1> } normal { onion 0.4 scale 0.2 } }
    frequency 0.7 sine_wave
  }
}
sphere { <-1, 0, -1>, 0.8
  pigment { hexagon pigment { radial color_map { [0 rgb 0] [1 rgb 1] } } pigment { rgb <1, 0.6, 0> } pigment { rgb <0, 0.4, 0.2> } frequency 0.9 phase 0.35 triangle_wave scale 0.3 }
}
sphere { <1, 0, -1>, 0.8
  pigment { rgb 0.8 }
  normal { square normal { onion 0.4 scale 0.1 } normal { gradient y 1 scale 0.2 } normal { gradient x 0.5 scale 0.1 } normal { leopard 0.5 scale 0.03 } frequency 0.6 phase 0.2 scale 0.4 }
}

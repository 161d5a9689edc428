// Letters of the fonts that come with POV-Ray, as solids.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <3, 1, -9> look_at <3, 0.4, 0> right 4/3*x angle 45 }
light_source { <-10, 15, -20> rgb 1 }
light_source { <10, 5, -20> rgb 0.4 shadowless }
text { ttf "timrom.ttf" "AVAST, g&8%" 0.4, 0 pigment { rgb <0.9, 0.6, 0.2> } translate <-0.5, 1.6, 0> }
text { ttf "cyrvetic.ttf" "Durer 1525" 0.3, 0.1*x pigment { rgb <0.3, 0.5, 0.9> } finish { phong 1 } rotate <0, 20, 0> }
text { ttf "crystal.ttf" "fixed {8}" 0.2, <0.05, 0.05, 0> pigment { rgb <0.4, 0.8, 0.4> } translate <-0.5, -1.2, 0> }
difference {
  box { <0, 0, 0.1>, <3, 1.2, 0.6> }
  text { ttf "timrom.ttf" "Bog" 1, 0 scale 1.3 translate <0.3, 0.3, 0> }
  pigment { rgb 0.8 } rotate -20*x translate <3.6, -1.9, -0.5> }

// Blobs: balls and cylinders, dents, placed components, many small ones.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -10> look_at <0, 0.2, 0> angle 38 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1 pigment { checker rgb 0.45 rgb 0.85 } }
blob {
  threshold 0.6
  sphere { <0.75, 0, 0>, 1, 1 }
  sphere { <-0.375, 0.64952, 0>, 1, 1 }
  sphere { <-0.375, -0.64952, 0>, 1, strength 1 }
  pigment { rgb <0.9, 0.3, 0.2> } finish { phong 0.5 }
  rotate <20, 30, 0> translate <-2.2, 0.2, -0.5>
}
blob {
  threshold 0.5
  cylinder { <-1, 0, 0>, <1, 0, 0>, 0.5, 1 }
  cylinder { <0, -1, -0.3>, <0, 1, 0.3>, 0.4, strength 1.5 }
  sphere { 0, 1, -0.6 scale <0.6, 0.6, 1.2> rotate 30*z }
  sturm
  pigment { rgb <0.3, 0.7, 0.3> } finish { phong 0.5 }
  rotate <0, -30, 0> translate <0.4, 0.3, -1.2>
}
blob {
  threshold 0.4
  component 1.2, 0.8, <0, 0, 0>
  component 0.8, 0.6, <0.6, 0.3, 0>
  component -1, 0.5, <-0.3, 0.3, -0.5>
  hierarchy off
  pigment { rgb <0.4, 0.5, 1> } scale <1.2, 1, 1>
  translate <2.6, 0, -1>
}
#declare R = seed(7);
blob {
  threshold 0.45
  #declare I = 0;
  #while (I < 100)
    sphere { <6*rand(R) - 3, 0.8*rand(R) - 0.7, 2*rand(R)>, 0.3 + 0.3*rand(R), 1 }
    #declare I = I + 1;
  #end
  pigment { rgb <0.85, 0.65, 0.3> } finish { phong 0.5 }
  translate <0, 0, 1.2>
}

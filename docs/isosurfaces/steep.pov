// A gyroid whose function rises by up to 13.9 per unit, said to rise by no more than 0.139.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <1.2, 1.4, -2.9> look_at <0, -0.05, 0> angle 40 right x*4/3 }
light_source { <-5, 8, -6>, rgb 1 }
background { rgb <0.77, 0.82, 0.87> }
isosurface {
  function { abs(sin(7*x)*cos(7*y) + sin(7*y)*cos(7*z) + sin(7*z)*cos(7*x)) - 0.35 }
  contained_by { sphere { 0, 0.85 } }
  max_gradient 0.139
  pigment { rgb <0.8, 0.42, 0.26> } finish { phong 0.4 }
}

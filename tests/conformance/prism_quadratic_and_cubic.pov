// Prisms of quadratic and cubic splines: linear and conic sweeps, several outlines, see-through ones, sheared ones.
#version 3.7;
global_settings { assumed_gamma 1 }
background { rgb <0.7, 0.75, 0.8> }
camera { location <-0.6, 5, -8> look_at <0, 0.5, 0> angle 42 right x*4/3 }
light_source { <-4, 8, -9>, rgb 1 }
plane { y, 0 pigment { rgb <0.75, 0.7, 0.6> } }
prism { quadratic_spline 0, 0.5, 12, <0.2, -1>, <0.2, 0.2>, <1, -0.2>, <1, 0.2>, <0.2, 1>, <-0.2, 1>, <-1, 0.2>, <-1, -0.2>, <-0.2, 0.2>, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>
  pigment { rgb <0.8, 0.3, 0.25> } finish { phong 0.4 } rotate <-50, 10, 0> translate <-2.3, 1, 1.2> }
prism { cubic_spline 0, 0.5, 13, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>, <1, -0.2>, <1, 0.2>, <0.2, 1>, <-0.2, 1>, <-1, 0.2>, <-1, -0.2>, <-0.2, 0.2>, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>
  pigment { rgb <0.3, 0.5, 0.8> } finish { phong 0.4 } rotate <-50, -10, 0> translate <0.2, 1, 1.2> }
prism { quadratic_spline conic_sweep 0.25, 1, 12, <0.2, -1>, <0.2, 0.2>, <1, -0.2>, <1, 0.2>, <0.2, 1>, <-0.2, 1>, <-1, 0.2>, <-1, -0.2>, <-0.2, 0.2>, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>
  pigment { rgb <0.4, 0.7, 0.35> } finish { phong 0.4 } scale <1, 1.5, 1> rotate <-30, 0, 0> translate <2.5, 0, 0.6> }
prism { cubic_spline conic_sweep 0, 1, 13, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>, <1, -0.2>, <1, 0.2>, <0.2, 1>, <-0.2, 1>, <-1, 0.2>, <-1, -0.2>, <-0.2, 0.2>, <-0.2, -1>, <0.2, -1>, <0.2, 0.2>
  pigment { rgb <0.9, 0.8, 0.3> } finish { phong 0.4 } rotate <180, 20, 0> translate <-2.4, 1, -1.6> }
prism { cubic_spline 0, 0.4, 16,
  <-1.2, 0>, <0, -1.2>, <1.2, 0>, <0, 1.2>, <-1.2, 0>, <0, -1.2>, <1.2, 0>,
  <-0.5, 0.2>, <-0.4, -0.4>, <0.3, -0.5>, <0.6, 0>, <0.4, 0.5>, <-0.2, 0.4>, <-0.5, 0.2>, <-0.4, -0.4>, <0.3, -0.5>
  pigment { rgb <0.7, 0.4, 0.7> } finish { phong 0.4 } matrix <1, 0, 0.2, 0.3, 1, 0, 0, 0, 1, 0.1, 0.05, -1.7> }
prism { quadratic_spline 0, 0.7, 6, <0, -1.1>, <-0.5, -0.5>, <0.5, -0.65>, <0.75, 0.5>, <-0.5, 0.35>, <-0.5, -0.5>
  pigment { rgbf <0.8, 0.9, 0.95, 0.6> } finish { phong 0.4 } scale 1.3 translate <2.4, 0.1, -1.9> }

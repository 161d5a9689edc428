// Parametric surfaces: a torus, a twisted strip with functions of its own, a graph, and one that its container cuts.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3.2, -8> look_at <0, 0.1, 0> angle 40 }
light_source { <-4, 8, -8>, rgb 1 }
plane { y, -1.3 pigment { checker rgb 0.9, rgb 0.6 } }
#declare Finish = finish { ambient 0.2 diffuse 0.7 }
parametric {
  function { (0.8 + 0.3*cos(v))*cos(u) } function { 0.3*sin(v) } function { (0.8 + 0.3*cos(v))*sin(u) }
  <0, 0>, <2*pi, 2*pi>
  contained_by { box { <-1.2, -0.4, -1.2>, <1.2, 0.4, 1.2> } }
  max_gradient 1.2 accuracy 0.0001 precompute 14 x, y, z
  pigment { rgb <1, 0.5, 0.3> } finish { Finish } rotate x*-50 translate <-1.6, 0.2, 0.3>
}
#declare Wind = function(u, v) { v*cos(u) }
parametric {
  function { Wind(u, v) } function { 0.35*u - 1.1 } function { v*sin(u) }
  <0, -0.7>, <2*pi, 0.7>
  contained_by { box { <-0.8, -1.2, -0.8>, <0.8, 1.2, 0.8> } }
  max_gradient 1 accuracy 0.0001 precompute 14 x, y, z
  pigment { rgb <0.4, 0.8, 0.4> } finish { Finish } rotate y*20 translate <1.7, 0.1, 0.4>
}
parametric {
  function { u } function { 0.25*sin(4*u)*cos(3*v) } function { v }
  <-1, -1>, <1, 1>
  contained_by { sphere { 0, 1 } }
  max_gradient 1.3 accuracy 0.0001 precompute 14 x, y, z
  pigment { rgb <1, 0.8, 0.3> } finish { Finish } rotate <-25, 30, 0> translate <0.2, -0.4, -1.3>
}

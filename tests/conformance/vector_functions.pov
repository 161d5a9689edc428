// Functions that give vectors: splines of each kind as profiles and as curves in space, and a transform.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -11> look_at 0 angle 58 right x*16/9 }
light_source { <10, 14, -20>, rgb 0.9 }
light_source { <0, 0, -11>, rgb 0.3 shadowless }
background { rgb <0.2, 0.3, 0.35> }
#default { texture { pigment { rgb <0.9, 0.75, 0.5> } finish { ambient 0.1 diffuse 0.8 } } }

// A vase by each kind of spline: its radius at each height.
#declare Points = spline { -1.2, <0.5, 0>, -0.8, <0.7, 0>, -0.3, <0.25, 0>, 0.3, <0.55, 0>, 0.8, <0.3, 0>, 1.2, <0.6, 0> };
#declare Linear = function { spline { Points } };
#declare Quadratic = function { spline { Points quadratic_spline } };
#declare Cubic = function { spline { Points cubic_spline } };
#declare Natural = function { spline { Points natural_spline } };
isosurface {
  function { sqrt(x*x + z*z) - Linear(y).x }
  contained_by { box { <-0.9, -1.3, -0.9>, <0.9, 1.3, 0.9> } } max_gradient 4 accuracy 1e-5
  rotate <-20, 0, 0> translate <-4, 1.5, 0>
}
isosurface {
  function { sqrt(x*x + z*z) - Quadratic(y).x }
  contained_by { box { <-0.9, -1.3, -0.9>, <0.9, 1.3, 0.9> } } max_gradient 4 accuracy 1e-5
  rotate <-20, 0, 0> translate <-1.4, 1.5, 0>
}
isosurface {
  function { sqrt(x*x + z*z) - Cubic(y).u }
  contained_by { box { <-0.9, -1.3, -0.9>, <0.9, 1.3, 0.9> } } max_gradient 4 accuracy 1e-5
  rotate <-20, 0, 0> translate <1.4, 1.5, 0>
}
isosurface {
  function { sqrt(x*x + z*z) - Natural(y).red }
  contained_by { box { <-0.9, -1.3, -0.9>, <0.9, 1.3, 0.9> } } max_gradient 4 accuracy 1e-5
  rotate <-20, 0, 0> translate <4, 1.5, 0>
}
// A tube around a curve in space.
#declare Way = function { spline { natural_spline -1.6, <0, 0, 0.2>, -0.8, <0.5, 0.4, 0.3>, 0, <-0.4, -0.3, 0.25>, 0.8, <0.3, -0.4, 0.12>, 1.6, <0, 0.4, 0.3> } };
isosurface {
  function { sqrt(pow(x - Way(y).x, 2) + pow(z - Way(y).y, 2)) - Way(y).z }
  contained_by { box { <-1.1, -1.6, -1.1>, <1.1, 1.6, 1.1> } } max_gradient 4 accuracy 1e-5
  rotate <0, 30, 80> translate <-3, -1.5, 0>
}
// A box that a transform has turned inside its container, and one that it mirrors at a plane.
#declare Turned = function { transform { rotate <30, 40, 20> scale <1, 1.6, 1> translate <0.1, 0, 0> } };
isosurface {
  function { max(abs(Turned(x, y, z).x), abs(Turned(x, y, z).y), abs(Turned(x, y, z).z)) - 0.7 }
  contained_by { sphere { 0, 1.4 } } max_gradient 2 accuracy 1e-5
  translate <0.6, -1.5, 0>
}
#declare Folded = function { transform { translate <-0.5, 0.2, 0> rotate 45*z } };
isosurface {
  function { pow(abs(Folded(abs(x), y, z).x), 3) + pow(Folded(abs(x), y, z).y, 4) + z*z - 0.3 }
  contained_by { sphere { 0, 1.4 } } max_gradient 8 accuracy 1e-5
  translate <3.8, -1.5, 0>
}

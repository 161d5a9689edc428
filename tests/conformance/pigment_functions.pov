// Pigments as functions: what a pigment's colours are worth is how far a surface stands out.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -11> look_at 0 angle 58 right x*16/9 }
light_source { <10, 14, -20>, rgb 0.9 }
light_source { <0, 0, -11>, rgb 0.3 shadowless }
background { rgb <0.2, 0.3, 0.35> }
#default { texture { pigment { rgb <0.9, 0.75, 0.5> } finish { ambient 0.1 diffuse 0.8 } } }

// Leopard's spots, with a steep rim.
#declare Spots = function { pigment { leopard color_map { [0.1 rgb 0] [0.3 rgb 0.3] [0.45 rgb 1] } scale 0.1 } };
isosurface {
  function { sqrt(x*x + y*y + z*z) - 1 - 0.1*Spots(x, y, z).gray }
  contained_by { sphere { 0, 1.2 } } max_gradient 6 accuracy 1e-5
  translate <-4, 1.5, 0>
}
// Waves of an onion around a point of the wall.
#declare Rings = function { pigment { onion sine_wave color_map { [0 rgb x] [0.5 rgb y] [1 rgb z] } scale 0.6 translate <0.3, 0.2, -0.4> } };
isosurface {
  function { z + 0.15*Rings(x, y, z).red - 0.2*Rings(x, y, 0).blue }
  contained_by { box { <-1.2, -1.2, -0.5>, <1.2, 1.2, 0.8> } } max_gradient 6 accuracy 1e-5
  rotate <-160, 20, 0> translate <-1.3, 1.5, 0>
}
// Roofs and steps along one axis, blended along the other.
#declare Fields = function {
  pigment {
    gradient x triangle_wave scale 0.8
    pigment_map {
      [0.2 gradient y triangle_wave scale 0.5]
      [0.8 gradient y triangle_wave color_map { [0.3 rgb 0] [0.4 rgb 1] } scale 0.8]
    }
  }
};
isosurface {
  function { z - 0.2*Fields(x, y, 0.1).green }
  contained_by { box { <-1.2, -1.2, -0.3>, <1.2, 1.2, 0.8> } } max_gradient 3 accuracy 1e-5
  rotate <-160, 20, 0> translate <1.4, 1.5, 0>
}
// Pigments blended by a pattern.
#declare Blend = function {
  pigment { spherical pigment_map { [0 rgb 0.2] [0.3 leopard scale 0.05 cubic_wave] [0.9 rgbt <1, 1, 1, 0.5>] } scale 1.3 }
};
isosurface {
  function { y - 0.7*Blend(x, y, z).gray + 0.3*Blend(x, y, z).transmit }
  contained_by { box { <-1.2, -0.2, -1.2>, <1.2, 1, 1.2> } } max_gradient 14 accuracy 1e-5
  rotate x*-40 translate <4, 1.3, 0>
}
// Terraces.
#declare Terraces = function {
  pigment { cylindrical color_map { [0.2 rgb 0] [0.24 rgb 0.3] [0.5 rgb 0.4] [0.54 rgb 0.7] [0.8 rgb 0.7] [0.84 rgb 1] } scale 1.4 }
};
isosurface {
  function { y - Terraces(x, 0, z).green }
  contained_by { box { <-1.2, -0.2, -1.2>, <1.2, 1.2, 1.2> } } max_gradient 20 accuracy 1e-5
  rotate x*-35 translate <-3, -1.8, 0>
}
// Bands of marble, and a cube of boxes.
#declare Plain = function { pigment { marble color_map { [0 rgb 0] [0.6 rgb <0, 1, 0>] [0.9 rgb <0, 0.2, 0>] } scale 0.5 rotate 30*z } };
isosurface {
  function { sqrt(x*x + z*z) - 0.9 + 0.3*Plain(x, y, z).green }
  contained_by { box { <-1, -1.1, -1>, <1, 1.1, 1> } } max_gradient 4 accuracy 1e-5
  rotate <-20, 0, 15> translate <0.4, -1.6, 0>
}
#declare Boxes = function { pigment { boxed scale 1.4 rotate <30, 20, 40> color_map { [0.3 rgbf <1, 0, 0, 0.9>] [0.6 rgbf <0, 1, 0, 0.1>] } } };
isosurface {
  function { Boxes(x, y, z).filter - 0.5 }
  contained_by { sphere { 0, 1.3 } } max_gradient 4 accuracy 1e-5
  translate <3.8, -1.6, 0>
}

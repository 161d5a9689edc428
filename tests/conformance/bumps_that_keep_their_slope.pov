// Bumps that keep their slope count in means and maps by the length of their normals. A bumped normal
// may point below the surface; a direction that it mirrors to the outside is kept.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.4, -6> look_at <0, 0.3, 0> angle 48 }
light_source { <3, 6, -5> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.9, 0.6, 0.3>] [0.5 rgb <0.2, 0.4, 0.8>] } } }
#declare Steep = normal { onion 0.9 scale <0.3, 0.6, 0.3> no_bump_scale }
#declare Flat = normal { leopard 0.5 scale 0.15 }
sphere {
  <-1.7, 0.9, 0>, 0.9
  pigment { rgb 0.8 }
  normal { average normal_map { [1 onion 0.9 scale <0.3, 0.6, 0.3> no_bump_scale] [2 leopard 0.5 scale 0.15] } }
}
sphere {
  <0, 0.9, 0.4>, 0.9
  pigment { rgb <0.9, 0.7, 0.3> }
  normal { gradient x normal_map { [0.2 Steep] [0.8 Flat] } scale 0.7 rotate 40*z }
  finish { phong 0.6 }
}
sphere {
  <1.7, 0.9, 0>, 0.9
  pigment { rgb <0.5, 0.8, 0.5> }
  normal {
    average
    normal_map { [1 checker normal { Steep } normal { wood 0.6 scale 0.4 no_bump_scale } scale 0.31] [1 Flat] }
    scale <1, 0.7, 1.3>
    rotate 20
  }
}
plane {
  y, 0.0137
  pigment { rgb 0.1 }
  normal { function { y*4 + 0.7*sin(3*x)*cos(2*z) + 0.3 } bump_size 2.2 }
  finish { reflection 0.6 irid { 0.3 thickness 0.6 } }
}

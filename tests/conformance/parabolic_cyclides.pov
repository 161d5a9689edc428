// Parabolic cyclides of Dupin: (x² + y² + z² - k²)(p - k - x) = p y², swept by spheres whose centres go along the parabola y² = 2 p x and whose radii are x + k there.
// They are cubics. Where a sphere has the radius 0 the surface meets itself (the first, k < 0); the second is smooth, with two passages through it. Balls cut them.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -10> look_at <0, -0.3, 0> angle 50 right x*16/9 }
light_source { <-6, 10, -9>, rgb 0.9 }
light_source { <8, 3, -6>, rgb 0.25 shadowless }
background { rgb <0.75, 0.8, 0.85> }
#macro Parabolic(P, K)
  polynomial {
    3, xyz(3, 0, 0): -1, xyz(1, 2, 0): -1, xyz(1, 0, 2): -1, xyz(2, 0, 0): P - K, xyz(0, 2, 0): -K, xyz(0, 0, 2): P - K, xyz(1, 0, 0): K*K, xyz(0, 0, 0): -K*K*(P - K)
  }
#end
#default { finish { ambient 0.12 diffuse 0.8 } }
intersection {
  object { Parabolic(0.8, -0.55) rotate -90*z }
  sphere { -0.9*y, 2 }
  pigment { rgb <0.8, 0.45, 0.28> }
  rotate <0, 25, 0> translate <-2.3, 0, 0>
}
intersection {
  object { Parabolic(0.8, 0.35) rotate -90*z }
  sphere { 0, 2 }
  pigment { rgb <0.3, 0.45, 0.6> }
  rotate <0, 25, 0> translate <2.3, 0, 0>
}
plane { y, -2.1 pigment { rgb <0.7, 0.68, 0.65> } }

// Patterns of noise
//
// Equation: colour = map(noise(p)),  noise(p) = Σ interpolated values at the corners of the unit cell around p
//
// From below: bozo, granite, agate, wrinkles; dents, crackle, cells, ripples; waves, marble and wood stirred by turbulence, a stirred spiral.
// K. Perlin, "An image synthesizer", 1985; S. Worley, "A cellular texture basis function", 1996.

#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <2, 1.5, -10> direction z right 4*x up 3*y }
#declare Shown = finish { ambient 0 diffuse 0 emission 1 }
#macro Tile(X, Y, P)
  box { <X + 0.02, Y + 0.02, 0.01>, <X + 0.98, Y + 0.98, 1>
    texture { pigment { P scale 0.1 translate <X, Y, 0> } finish { Shown } } }
#end
Tile(0, 0, pigment { bozo })
Tile(1, 0, pigment { granite scale 3 })
Tile(2, 0, pigment { agate scale 2 })
Tile(3, 0, pigment { wrinkles scale 2 })
Tile(0, 1, pigment { dents })
Tile(1, 1, pigment { crackle scale 1.5 })
Tile(2, 1, pigment { cells })
Tile(3, 1, pigment { ripples scale 0.6 })
Tile(0, 2, pigment { waves scale 0.5 })
Tile(1, 2, pigment { marble turbulence 0.8 scale 2 })
Tile(2, 2, pigment { wood turbulence 0.1 scale 2 })
Tile(3, 2, pigment { spiral1 3 turbulence 0.5 scale 2 })

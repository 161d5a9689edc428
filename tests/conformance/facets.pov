// Facets of curved surfaces: normals take the nearest of a grid of directions.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -10> right 4/3*x angle 45 }
light_source { <-10, 15, -20> rgb 1 }
light_source { <20, 5, -10> rgb <0.3, 0.3, 0.4> }
#macro Egg(X, Y, N)
  sphere { 0, 0.95 scale <1, 0.8, 1> rotate 20*z pigment { rgb 0.8 } normal { N } finish { specular 0.4 reflection 0.1 } translate <X, Y, 0> }
#end
Egg(-3, 2, normal { facets size 0.3 })
Egg(-1, 2, normal { facets size 0.8 rotate <10, 20, 30> })
Egg(1, 2, normal { facets size 0.4 scale <1, 3, 0.5> })
Egg(3, 2, normal { facets size 0.4 no_bump_scale scale <1, 3, 0.5> })
Egg(-3, 0, normal { facets size 0.4 bump_size 3 })
Egg(-1, 0, normal { facets size 0.4 turbulence 1 translate 5 })
Egg(1, 0, normal { gradient y normal_map { [0 facets size 0.5] [0.5 facets size 0.5] [1 onion 2 sine_wave scale 0.2] } scale 2 translate -0.8*y })
torus { 0.6, 0.3 rotate -40*x pigment { rgb <1, 0.8, 0.6> } normal { facets size 0.3 } translate 3*x }
cone { -0.8*y, 0.9, 0.7*y, 0.2 pigment { rgb 0.8 } normal { facets size 0.2 scale 0.5 } rotate 20*x translate <-2, -2, 0> }
superellipsoid { <0.4, 0.6> scale 0.8 rotate <20, 30, 0> pigment { rgb 0.8 } normal { facets size 0.2 } translate <1, -2, 0> }

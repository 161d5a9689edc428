// Parts of one object that have no interior share one: a ray in the first sphere leaves it where it meets
// the second one in the glass. The last part says whether it is hollow.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 20 }
camera { location <0, 0.6, -6> look_at 0 angle 42 right x*4/3 }
light_source { <4, 9, -6>, rgb 1 }
fog { distance 14 rgb <0.5, 0.6, 0.9> }
plane { z, 4 hollow pigment { checker rgb <0.9, 0.8, 0.4>, rgb <0.3, 0.4, 0.7> scale 0.4 } }
plane { y, -2 hollow pigment { checker rgb <0.9, 0.9, 0.9>, rgb <0.4, 0.6, 0.4> scale 0.5 } }
#declare Paint = pigment { rgbt <0.95, 0.98, 1, 0.85> }
#declare Film = finish { ambient 0.05 diffuse 0.3 reflection 0.1 }
// One interior for both spheres.
union {
  sphere { <-1.3, 0.3, 0>, 1 }
  sphere { <-1.15, 0.35, 0.1>, 0.85 interior { ior 1.5 } }
  union { sphere { <-1.45, 0.5, 0.3>, 0.8 } }
  pigment { Paint }
  finish { Film }
}
// Each has its own.
sphere { <1.3, 0.3, 0>, 1 pigment { Paint } finish { Film } }
sphere { <1.45, 0.35, 0.1>, 0.85 interior { ior 1.5 } pigment { Paint } finish { Film } }
sphere { <1.15, 0.5, 0.3>, 0.8 pigment { Paint } finish { Film } }
// Without fog in both spheres, with fog in both spheres.
union {
  sphere { <-1.6, -1.2, -1>, 0.45 hollow }
  sphere { <-0.6, -1.2, -1>, 0.45 }
  pigment { rgbt 1 }
  finish { specular 0.6 }
}
union {
  sphere { <0.6, -1.2, -1>, 0.45 }
  merge { sphere { <1.6, -1.2, -1>, 0.35 } box { <1.3, -1.6, -1.3>, <1.9, -1.2, -0.7> } hollow }
  pigment { rgbt 1 }
  finish { specular 0.6 }
}

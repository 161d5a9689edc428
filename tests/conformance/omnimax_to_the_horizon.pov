// An omnimax camera over a pattern that becomes finer towards the horizon: it shows small errors of
// directions.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { omnimax location <0.282, 2.152, -3.27> right x*4/3 look_at <0, 0.022, 0> sky <0.061, 1, 0.1> }
plane { y, -2.0137
  pigment { function { 0.5 + 0.5*cos(30*x)*cos(30*z) } colour_map { [0 rgb <0.58, 0.11, 0.13>] [1 rgb <0.09, 0.53, 0.46>] } }
  finish { ambient 1 diffuse 0 }
}

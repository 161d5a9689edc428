// A mesh camera whose rays are found by texture coordinates, with smooth normals and an end.
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
  mesh_camera {
    1 3 6
    mesh {
      smooth_triangle { <-1, -1, 0>, <-0.4, -0.3, 1>, <1, -1, 0>, <0.4, -0.3, 1>, <-1, 1, 0>, <-0.4, 0.3, 1>
        uv_vectors <0, 0>, <1, 0>, <0, 1> }
      smooth_triangle { <1, -1, 0>, <0.4, -0.3, 1>, <1, 1, 0>, <0.4, 0.3, 1>, <-1, 1, 0>, <-0.4, 0.3, 1>
        uv_vectors <1, 0>, <0.95, 0.95>, <0, 1> }
      rotate 10*y
    }
    smooth
  }
}
sky_sphere { pigment { checker rgb <0.4, 0.6, 0.9> rgb 0.9 scale 0.3 } }
light_source { <2, 9, -4> rgb 1 }
plane { y, -2 pigment { checker rgb 0.8 rgb 0.3 } }
sphere { <0.5, 0.5, 4>, 1 pigment { rgb <1, 0.6, 0.3> } }
box { <-2, -2, 5>, <-1, 1, 6> pigment { rgb <0.3, 0.8, 0.5> } }

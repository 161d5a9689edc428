// A mesh camera: each pixel is the mean of two faces, and the second mesh has too few of them. Larger
// pictures than 240 rows have no faces below.
#version 3.7;
global_settings { assumed_gamma 1 }
#macro Grid(Rows, Move)
  mesh {
    #local J = 0;
    #while (J < Rows)
      #local I = 0;
      #while (I < image_width)
        #local P = <(I + 0.5)/image_width - 0.5, 0.5 - (J + 0.5)/image_height, 0>;
        #local E = <P.x*0.5, P.y*0.4, 1>;
        #local U = vnormalize(vcross(y, E));
        #local V = vcross(E, U);
        triangle { 4*P + 0.02*U, 4*P + 0.02*V, 4*P - 0.02*(U + V) }
        #local I = I + 1;
      #end
      #local J = J + 1;
    #end
    translate Move*0.1*x rotate Move*5*y
  }
#end
camera {
  mesh_camera {
    2 0
    Grid(min(image_height, 240), 0)
    Grid(min(floor(image_height/2), 120), 1)
  }
  location <0, 0, 0.25>
  direction -z
}
sky_sphere { pigment { checker rgb <0.4, 0.6, 0.9> rgb 0.9 scale 0.3 } }
light_source { <2, 9, -4> rgb 1 }
plane { y, -2 pigment { checker rgb 0.8 rgb 0.3 scale 3 } }
sphere { <0.5, 0.5, 4>, 1 pigment { rgb <1, 0.6, 0.3> } }
box { <-2, -2, 5>, <-1, 1, 6> pigment { rgb <0.3, 0.8, 0.5> } }

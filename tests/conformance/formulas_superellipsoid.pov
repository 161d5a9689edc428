// Superellipsoids from boxes to stars, placed, sheared, cut and in a solid of solids.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -11> look_at <0, 0.1, 0> angle 36 right x*image_width/image_height }
light_source { <10, 20, -15>, rgb 1 }
light_source { <-12, 9, -6>, rgb 0.3 shadowless }
background { rgb <0.3, 0.4, 0.55> }
plane { y, -1 pigment { checker rgb 0.45 rgb 0.85 } }
#declare Row = 0;
#while (Row < 4)
  #declare Column = 0;
  #while (Column < 4)
    superellipsoid {
      <0.25 + 0.5*Column, 0.25 + 0.5*Row>
      pigment { rgb <0.3 + 0.2*Column, 0.5, 1 - 0.25*Row> }
      finish { phong 0.4 }
      scale 0.6 rotate <50, 25, 0> translate <1.6*Column - 2.4, 0.3, 1.6*Row - 2.2>
    }
    #declare Column = Column + 1;
  #end
  #declare Row = Row + 1;
#end

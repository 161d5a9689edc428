// Most of the language in one scene.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 8 adc_bailout 0.01 ambient_light rgb <1, 0.9, 0.8> }
#default { finish { ambient 0.2 diffuse 0.7 } }
#declare Red = rgb <1, 0, 0>;
#declare Glass = material { texture { pigment { rgbt <1, 1, 1, 0.9> } finish { reflection { 0, 1 fresnel } conserve_energy } } interior { ior 1.5 fade_distance 2 fade_power 1001 fade_color <0, 1, 0> } }
#declare Stripes = color_map { [0.0 Red] [0.5 Red*0.5] [0.5 color rgb 1 transmit 0.5] [1.0 rgb <0, 0, 1>] }
#declare Turned = transform { rotate <10, 20, 30> translate y*2 scale <1, 2, 3> inverse }
#declare Places = array[2][2] { { <0, 0, 0>, <1, 0, 0> }, { <0, 1, 0>, <1, 1, 0> } }
#macro Ball(Place, Radius, Look)
  sphere { Place, Radius texture { Look } #if (Radius > 0.5) no_shadow #else no_image #end }
#end
#declare Look = texture { pigment { gradient <1, 1, 0> color_map { Stripes } frequency 2 phase 0.25 triangle_wave scale 0.5 } finish { phong 0.8 phong_size 60 metallic } }
camera { location <0, 2, -10> right x*image_width/image_height up y sky <0.1, 1, 0> angle 40 look_at <0, 1, 0> }
background { color rgb <0.1, 0.2, 0.3> }
light_source { <10, 20, -10>, rgb 1 fade_distance 20 fade_power 2 }
light_source { <-10, 20, -10> color rgb <0.5, 0.5, 1> spotlight point_at 0 radius 10 falloff 20 tightness 2 shadowless }
light_source { y*10 rgb 0.3 cylinder point_at <0, 0, 0> radius 1 falloff 2 parallel looks_like { sphere { 0, 0.1 } } }
#for (I, 0, 1)
  #local J = 0;
  #while (J < 2)
    Ball(Places[I][J], 0.25 + I/4 + rand(seed(J))/10, Look)
    #local J = J + 1;
  #end
#end
box { -1, <1, 2, 3> material { Glass } transform { Turned } }
cylinder { 0, y, 0.5 open pigment { checker rgb 0, rgb 1 scale 0.2 } }
cone { 0, 1, y*2, 0.2 pigment { hexagon Red, rgb y, rgb z } hollow }
plane { y, -1 pigment { brick rgb 0.5, rgb <0.6, 0.1, 0.1> brick_size <8, 3, 4> mortar 0.4 scale 0.1 } inverse }
disc { y, z, 2, 0.5 texture { checker texture { Look } texture { pigment { Red } } } }
triangle { 0, x, y pigment { gradient y pigment_map { [0 Red] [1 checker rgb 0, rgb 1] } sine_wave } }
smooth_triangle { 0, z, x, z+x, y, z+y texture { pigment { Red } } texture { pigment { rgbt 0.5 } } }
polygon { 9, <-1,-1>, <1,-1>, <1,1>, <-1,1>, <-1,-1>, <0.5,0.5>, <0.5,-0.5>, <-0.5,-0.5>, <0.5,0.5> fill_rule even_odd }
quadric { <1, 1, 0.5>, <0, 0.1, 0>, <0, 0, 0>, -1 clipped_by { box { -1, 1 } } bounded_by { clipped_by } }
mesh { triangle { 0, x, y } smooth_triangle { 0, z, x, z, y, z } triangle { x, y, z texture { Look } } inside_vector y }
mesh2 { vertex_vectors { 4, 0, x, y, z } texture_list { 2, texture { Look }, texture { pigment { Red } } } face_indices { 2, <0,1,2>, 0, <1,2,3>, 1 } }
union { sphere { 0, 1 } union { box { 0, 1 } translate x pigment { Red } } object { Ball(x, 1, Look) } rotate y*45 no_reflection }
ellipsoid { <1, 2, 3>, from -1 to 2 open }
spheroid { 1, 2 }
paraboloid { <1, 2, 3>, from 0 to 2 }
hyperbolic_paraboloid { <1, 1, 1>, from -1 to 1 }
hyperboloid { <1, 1, 1>, sheets 1, from -1 to 1 }
hyperboloid { <1, 1, 1>, sheets 2 }
elliptic_cone { <1, 2, 1>, from -1 to 1 } circular_cone { 1, 1 }
elliptic_cylinder { <1, 2> from 0 to 1 } circular_cylinder { 0.5 } hyperbolic_cylinder { <1, 1> } parabolic_cylinder { <1, 1> }
spherical_sector { 0, 1, y, 30 } annulus { 0, y, 1, 0.5 } parallelogram { 0, x, y }
#switch (version) #case (3.7) #debug concat("version ", str(version, 0, 1), "\n") #break #range (1, 3) #warning "old" #else #error "?" #end
#declare Later = torus { 1, 0.2 }
#undef Later

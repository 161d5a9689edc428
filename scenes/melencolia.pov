// Melencolia
//
// The solid of Dürer's engraving *Melencolia I* (1514) stands on a terrace above the sea: a rhombohedron of edge angle
// 72° whose two sharp corners are cut off so that all twelve vertices lie on one sphere. Around it are the engraving's
// sphere (here a mirror), its ladder, scales, hourglass (a hyperboloid of one sheet), comet and rainbow, and its magic
// square, told in discs whose areas are the numbers. On the table is the perspective machine of the *Underweysung*
// (1525): a thread runs from a ring in the wall through a frame to a point of the lute, and where it crosses the frame a
// dot is drawn on the hinged panel. It is the first ray tracer.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }

camera { location <0.7, 2.9, -9.8> look_at <0.72, 1.72, 0> angle 47 right x*4/3 }
light_source { <-13, 10.5, -6.5>, rgb <1.3, 1.08, 0.8> }
light_source { <7, 6, -12>, rgb <0.13, 0.16, 0.23> shadowless }
light_source { <0.6, 5.6, -3.4>, rgb <0.75, 0.55, 0.3> spotlight point_at <2.6, 1.3, 0.9> radius 11 falloff 24 fade_distance 6 fade_power 2 }

// ---------------------------------------------------------------- materials
#declare Stone = texture { pigment { rgb <0.62, 0.59, 0.54> } finish { ambient 0.06 diffuse 0.75 specular 0.12 roughness 0.08 } }
#declare Wood = texture { pigment { rgb <0.42, 0.24, 0.12> } finish { ambient 0.06 diffuse 0.75 specular 0.25 roughness 0.05 } }
#declare Pale_Wood = texture { pigment { rgb <0.68, 0.47, 0.26> } finish { ambient 0.06 diffuse 0.75 specular 0.25 roughness 0.04 } }
#declare Brass = texture { pigment { rgb <0.82, 0.6, 0.25> } finish { ambient 0.08 diffuse 0.45 specular 0.8 roughness 0.03 metallic reflection { 0.25 metallic } } }
#declare Iron = texture { pigment { rgb <0.16, 0.17, 0.19> } finish { diffuse 0.6 specular 0.5 roughness 0.06 } }
#declare Thread = texture { pigment { rgb <1, 0.85, 0.5> } finish { ambient 0.55 diffuse 0.5 } }
#declare Paper = texture { pigment { rgb <0.9, 0.85, 0.72> } finish { ambient 0.12 diffuse 0.75 } }
#declare Glass = texture { pigment { rgbt <0.96, 0.99, 0.98, 0.97> } finish { ambient 0 diffuse 0 specular 0.9 roughness 0.003 reflection { 0, 1 fresnel } conserve_energy } }
#declare Thin_Glass = texture { pigment { rgbt <0.85, 0.93, 0.95, 0.88> } finish { ambient 0 diffuse 0.1 specular 0.9 roughness 0.004 reflection { 0.03, 0.4 falloff 3 } } }

// ---------------------------------------------------------------- sky, sea, rainbow, comet
sphere { 0, 1000 hollow no_shadow
  pigment { gradient y color_map {
    [0 rgb <0.98, 0.78, 0.55>] [0.05 rgb <0.93, 0.72, 0.58>] [0.14 rgb <0.6, 0.62, 0.68>] [0.32 rgb <0.27, 0.38, 0.55>] [1 rgb <0.1, 0.18, 0.35>] } scale 1030 translate -y*10 }
  finish { ambient 0 diffuse 0 emission 0.92 } }
plane { y, -1.3 hollow pigment { rgb <0.05, 0.13, 0.16> } finish { ambient 0.1 diffuse 0.5 reflection { 0.02, 0.62 fresnel } } interior { ior 1.33 } }
#declare Spectrum = array[7] { rgb <0.55, 0.2, 0.75>, rgb <0.25, 0.3, 0.9>, rgb <0.2, 0.65, 0.9>, rgb <0.25, 0.8, 0.35>, rgb <0.95, 0.9, 0.25>, rgb <1, 0.6, 0.2>, rgb <0.95, 0.25, 0.2> }
#for (I, 0, 6)
  disc { <-108, -30, 600>, <0.1, 0, -1>, 112+5*I, 107+5*I hollow no_shadow pigment { Spectrum[I] transmit 0.78 } finish { ambient 0 diffuse 0 emission 0.9 } }
#end
union { // the comet and its rays
  sphere { 0, 7 }
  #for (I, -3, 3) cone { 0, 5, <-95-30*cos(I*1.4), 26*I, 0>, 0 } #end
  hollow no_shadow scale 0.55 rotate z*24 translate <-52, 62, 590>
  pigment { rgbt <1, 0.95, 0.8, 0.45> } finish { ambient 0 diffuse 0 emission 1 } }
union { // islands
  sphere { 0, 1 scale <64, 9, 30> translate <-150, -3, 560> }
  sphere { 0, 1 scale <24, 19, 30> translate <-172, -3, 565> }
  sphere { 0, 1 scale <15, 13, 30> translate <-142, -2, 570> }
  sphere { 0, 1 scale <40, 7, 20> translate <-38, -3, 620> }
  sphere { 0, 1 scale <14, 14, 20> translate <-26, -4, 630> }
  pigment { rgb <0.36, 0.36, 0.42> } finish { ambient 0.4 diffuse 0.4 } }

// ---------------------------------------------------------------- terrace, wall
box { <-14, -1.2, -14>, <14, 0, 6> texture {
  pigment { hexagon rgb <0.46, 0.26, 0.18>, rgb <0.58, 0.42, 0.31>, rgb <0.33, 0.21, 0.18> scale 0.42 rotate y*7 }
  finish { ambient 0.06 diffuse 0.75 reflection 0.05 } } }
box { <-14, 0, 5.5>, <1.1, 0.55, 6> texture { Stone } }
box { <-14.1, 0.55, 5.42>, <1.1, 0.68, 6.08> texture { Stone } }
box { <1.1, 0, 3.2>, <9, 6.4, 4.2> texture {
  pigment { brick rgb <0.52, 0.48, 0.43>, rgb <0.63, 0.55, 0.46> brick_size <0.9, 0.36, 0.5> mortar 0.025 translate <0.13, 0.07, 0.11> }
  finish { ambient 0.06 diffuse 0.75 } } }
box { <1.0, 4.55, 3.1>, <9, 4.75, 4.3> texture { Stone } }

// ---------------------------------------------------------------- the solid
// Edges from the lower apex at 0: E[k]. cos 72° = (h² - s²/2) / (h² + s²) gives h/s; the cut at (2h² - s²)/(h² + s²),
// the golden section, puts the corners of the cut on the sphere through the others.
#declare S = 1.2;
#declare H = S*sqrt((0.5+cos(radians(72)))/(1-cos(radians(72))));
#declare F = (2*H*H-S*S)/(H*H+S*S);
#declare E = array[3] { <S, H, 0>, <S*cos(2*pi/3), H, S*sin(2*pi/3)>, <S*cos(4*pi/3), H, S*sin(4*pi/3)> }
#declare Apex = E[0]+E[1]+E[2];
union {
  polygon { 4, F*E[0], F*E[1], F*E[2], F*E[0] }
  polygon { 4, Apex-F*E[0], Apex-F*E[1], Apex-F*E[2], Apex-F*E[0] }
  #for (K, 0, 2)
    #declare A = E[K]; #declare B = E[mod(K+1, 3)];
    polygon { 6, F*A, A, A+B, B, F*B, F*A }
    polygon { 6, Apex-F*A, Apex-A, Apex-A-B, Apex-B, Apex-F*B, Apex-F*A }
  #end
  texture { Stone finish { reflection 0.04 } }
  translate -y*F*H rotate y*25 translate <-1.75, 0, 2.1> }

// ---------------------------------------------------------------- the spheres
sphere { <-2.3, 0.66, -0.9>, 0.66 pigment { rgb <0.9, 0.92, 0.95> } finish { ambient 0.02 diffuse 0.08 specular 0.9 roughness 0.004 reflection 0.82 } }
sphere { <0.35, 0.56, -1.7>, 0.56 texture { Glass } interior { ior 1.5 } }
sphere { <-1.25, 0.16, -2.4>, 0.16 texture { Brass } }
sphere { <-0.85, 0.11, -2.15>, 0.11 texture { Stone } }

// ---------------------------------------------------------------- the ladder
#declare Foot = <-0.75, 0, 2.3>;
#declare Head = <0.95, 6.1, 3.45>;
#declare Across = <0.62, 0, -0.35>;
union {
  cylinder { Foot, Head, 0.07 }
  cylinder { Foot+Across, Head+Across, 0.07 }
  #for (I, 1, 11) cylinder { Foot+(Head-Foot)*I/12-Across*0.15, Foot+(Head-Foot)*I/12+Across*1.15, 0.045 } #end
  texture { Wood } }

// ---------------------------------------------------------------- the magic square: each row, column and diagonal is 34
#declare Square = array[16] { 16, 3, 2, 13, 5, 10, 11, 8, 9, 6, 7, 12, 4, 15, 14, 1 }
union {
  box { <-0.78, -0.78, 0>, <0.78, 0.78, 0.12> texture { Stone pigment { rgb <0.5, 0.46, 0.42> } } }
  #for (I, 0, 15)
    box { <-0.68+0.35*mod(I, 4), 0.68-0.35*int(I/4), -0.02>, <-0.37+0.35*mod(I, 4), 0.37-0.35*int(I/4), 0.05> texture { Stone } }
    disc { <-0.525+0.35*mod(I, 4), 0.525-0.35*int(I/4), -0.035>, -z, 0.034*sqrt(Square[I]) texture { Brass } }
  #end
  translate <3.55, 3.55, 3.05> }

// ---------------------------------------------------------------- the scales
#macro Pan(P)
  union {
    quadric { <1, 0, 1>, <0, 0, 0>, <0, -0.55, 0>, 0 clipped_by { box { <-1, -0.1, -1>, <1, 0.12, 1> } } texture { Brass } }
    #for (I, 0, 2) cylinder { <0.257*cos(I*2*pi/3+0.4), 0.12, 0.257*sin(I*2*pi/3+0.4)>, <0, 0.85, 0>, 0.008 texture { Iron } } #end
    translate P }
#end
union {
  cylinder { <-0.62, 0.09, 0>, <0.62, -0.09, 0>, 0.025 texture { Brass } }
  cylinder { <0, 0, 0>, <0, 0.45, 0>, 0.02 texture { Iron } }
  cylinder { <0, 0.45, 0>, <0, 0.45, 0.4>, 0.03 texture { Iron } }
  sphere { 0, 0.06 texture { Brass } }
  Pan(<-0.62, -0.76, 0>)
  Pan(<0.62, -0.94, 0>)
  translate <1.95, 3.7, 2.8> }

// ---------------------------------------------------------------- the table
union {
  box { <0.95, 1.06, -0.35>, <4.7, 1.18, 1.75> }
  box { <1.1, 0.92, -0.2>, <4.55, 1.06, 1.6> }
  #for (I, 0, 1) #for (J, 0, 1)
    cone { <1.25+3.15*I, 0, -0.05+1.5*J>, 0.07, <1.25+3.15*I, 0.92, -0.05+1.5*J>, 0.11 }
    sphere { <1.25+3.15*I, 0.5, -0.05+1.5*J>, 0.13 }
  #end #end
  texture { Wood } }

// ---------------------------------------------------------------- the perspective machine
#declare Ring = <5.05, 3.05, 3.1>;
#declare Touch = <1.62, 1.66, 0.35>;
#declare Middle = <3.2, 1.18, 1.22>;
#declare Turn = 36;
union { // frame, in its own plane z = 0
  box { <-0.72, 0, -0.05>, <-0.61, 1.7, 0.05> }
  box { <0.61, 0, -0.05>, <0.72, 1.7, 0.05> }
  box { <-0.72, 1.59, -0.05>, <0.72, 1.7, 0.05> }
  box { <-0.85, 0, -0.15>, <0.85, 0.1, 0.15> }
  cylinder { <-0.61, 1.06, 0>, <0.61, 1.06, 0>, 0.009 texture { Thread } }
  cylinder { <-0.26, 0.1, 0>, <-0.26, 1.59, 0>, 0.009 texture { Thread } }
  texture { Pale_Wood }
  rotate y*(90-Turn) translate Middle }
union { // the hinged panel with the drawing so far
  box { <0, 0.12, -0.02>, <1.2, 1.57, 0.02> texture { Paper } }
  box { <-0.04, 0.06, -0.03>, <1.26, 0.12, 0.03> texture { Pale_Wood } }
  box { <-0.04, 1.57, -0.03>, <1.26, 1.63, 0.03> texture { Pale_Wood } }
  #for (I, 0, 28)
    sphere { <0.72+0.3*cos(radians(28+I*10.8)), 0.85+0.36*sin(radians(28+I*10.8)), -0.022>, 0.017 texture { Iron } }
  #end
  #for (I, 0, 4) sphere { <0.99-0.012*I, 1.06+0.085*I, -0.022>, 0.017 texture { Iron } } #end
  rotate y*-50 translate <0.73, 0, 0> rotate y*(90-Turn) translate Middle }
union { // the thread, the ring it runs through, and the weight that keeps it tight
  cylinder { Touch, Ring-<0, 0, 0.15>, 0.011 texture { Thread } }
  cylinder { Ring-<0, 0, 0.15>, Ring-<0, 0.95, 0.15>, 0.011 texture { Thread } }
  cylinder { Ring, Ring-<0, 0, 0.22>, 0.035 texture { Iron } }
  sphere { Ring-<0, 0, 0.15>, 0.06 texture { Brass } }
  cone { Ring-<0, 1.35, 0.15>, 0.15, Ring-<0, 0.95, 0.15>, 0.05 texture { Brass } }
  sphere { Touch, 0.025 texture { Brass } } }

// ---------------------------------------------------------------- the lute: half an ellipsoid, a face with its rose, a neck
union {
  sphere { 0, 1 clipped_by { plane { y, 0 } } scale <0.62, 0.36, 0.42>
    texture { gradient z texture_map { [0.5 Pale_Wood] [0.5 Wood] } scale 0.14 } }
  disc { 0, y, 1, 0.3 scale <0.62, 1, 0.42> texture { Pale_Wood pigment { rgb <0.85, 0.68, 0.42> } } }
  disc { -y*0.01, y, 0.31 scale <0.62, 1, 0.42> texture { Iron } }
  box { <0.5, -0.05, -0.07>, <1.25, 0.02, 0.07> texture { Wood } }
  box { <-0.32, 0, -0.13>, <-0.27, 0.03, 0.13> texture { Wood } }
  box { <1.18, -0.28, -0.09>, <1.26, 0.02, 0.09> texture { Wood } }
  #for (I, -2, 2) cylinder { <-0.3, 0.035, 0.045*I>, <1.2, 0.03, 0.024*I>, 0.006 texture { Thread } } #end
  scale 1.12 rotate x*38 rotate y*160 rotate z*5 translate <2.12, 1.62, 0.35> }

// ---------------------------------------------------------------- the hourglass
union {
  quadric { <1, -0.16, 1>, <0, 0, 0>, <0, 0, 0>, -0.0016 clipped_by { box { <-0.4, -0.5, -0.4>, <0.4, 0.5, 0.4> } } hollow texture { Thin_Glass } }
  cone { <0, -0.5, 0>, 0.19, <0, -0.2, 0>, 0.015 pigment { rgb <0.85, 0.6, 0.35> } }
  cone { <0, 0.06, 0>, 0.028, <0, 0.3, 0>, 0.115 pigment { rgb <0.85, 0.6, 0.35> } }
  cylinder { <0, -0.3, 0>, <0, 0.08, 0>, 0.008 pigment { rgb <0.85, 0.6, 0.35> } }
  cylinder { <0, 0.5, 0>, <0, 0.57, 0>, 0.3 texture { Wood } }
  cylinder { <0, -0.57, 0>, <0, -0.5, 0>, 0.3 texture { Wood } }
  #for (I, 0, 3) cylinder { <0.25*cos(I*pi/2+0.5), -0.5, 0.25*sin(I*pi/2+0.5)>, <0.25*cos(I*pi/2+0.5), 0.5, 0.25*sin(I*pi/2+0.5)>, 0.022 texture { Brass } } #end
  cylinder { <0, 0.57, 0>, <0, 0.8, 0>, 0.02 texture { Iron } }
  cylinder { <0, 0.78, 0>, <0, 0.78, 0.5>, 0.03 texture { Iron } }
  translate <5.2, 3.75, 2.75> }

// ---------------------------------------------------------------- a goblet, the dividers and the rule
union {
  quadric { <1, 0, 1>, <0, 0, 0>, <0, -0.085, 0>, 0 clipped_by { box { <-1, -0.1, -1>, <1, 0.42, 1> } } translate y*0.24 }
  quadric { <1, -0.35, 1>, <0, 0, 0>, <0, 0, 0>, -0.0012 clipped_by { box { <-1, -0.1, -1>, <1, 0.13, 1> } } translate y*0.12 }
  cone { <0, 0, 0>, 0.16, <0, 0.03, 0>, 0.07 }
  texture { Brass } translate <4.47, 1.18, -0.12> }
union {
  cone { <0, 0.06, 0>, 0.055, <-1.15, 0.02, -0.28>, 0.008 }
  cone { <0, 0.06, 0>, 0.055, <-1.1, 0.02, 0.3>, 0.008 }
  cylinder { <0, 0.005, 0>, <0, 0.14, 0>, 0.075 }
  texture { Brass } rotate y*24 translate <3.05, 0, -2.0> }
box { <-0.95, 0, -0.06>, <0.95, 0.03, 0.06> texture { gradient x texture_map { [0.5 Pale_Wood] [0.5 Wood] } scale 0.2 } rotate y*-13 translate <-0.1, 0.003, -3.05> }

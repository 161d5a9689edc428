//! Objects: their shapes, their order, their placements, and what they inherit.

mod support;

use durer_math::{Point3, Vec3};
use durer_scene::{
    Cells, FillRule, Pattern, Pigment, PigmentBody, QuadricKind, Scene, Shape, SweepSpline, TextureBody,
};
use support::scene;

/// The pigment of the top layer of object `index`.
fn pigment(scene: &Scene, index: usize) -> Pigment {
    let texture = scene.objects[index].texture.as_ref().unwrap();
    match &texture.body {
        TextureBody::Layers(layers) => layers.last().unwrap().pigment.clone(),
        TextureBody::Pattern(_) | TextureBody::Fields(_) => panic!("a patterned texture"),
    }
}

fn solid(scene: &Scene, index: usize) -> [f64; 3] {
    match pigment(scene, index).body {
        PigmentBody::Solid(colour) => [colour.rgb.r, colour.rgb.g, colour.rgb.b],
        _ => panic!("no solid pigment"),
    }
}

fn ambient(scene: &Scene, index: usize) -> f64 {
    match &scene.objects[index].texture.as_ref().unwrap().body {
        TextureBody::Layers(layers) => layers.last().unwrap().finish.ambient.r,
        TextureBody::Pattern(_) | TextureBody::Fields(_) => panic!("a patterned texture"),
    }
}

#[test]
fn shapes_keep_the_numbers_of_the_text() {
    let scene = scene(
        "sphere { <1,2,3>, 4 } box { -1, <1,2,3> } quadric { <1,2,3>, <4,5,6>, <7,8,9>, 10 } plane { y*2, 3 } cone { 0, 1, y, 0 }",
    );
    assert_eq!(scene.objects[0].shape, Shape::Sphere { centre: Point3::new(1.0, 2.0, 3.0), radius: 4.0 });
    assert_eq!(
        scene.objects[1].shape,
        Shape::Box { a: Point3::new(-1.0, -1.0, -1.0), b: Point3::new(1.0, 2.0, 3.0) }
    );
    let coefficients = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];
    assert_eq!(scene.objects[2].shape, Shape::Quadric(Box::new(coefficients)));
    assert_eq!(scene.objects[3].shape, Shape::Plane { normal: Vec3::new(0.0, 2.0, 0.0), distance: 3.0 });
    assert!(matches!(scene.objects[4].shape, Shape::Cone { base_radius: 1.0, cap_radius: 0.0, .. }));
    assert!(scene.objects.iter().all(|object| object.placement.is_identity()));
}

#[test]
fn transforms_apply_in_their_order() {
    let scene =
        scene("sphere { 0, 1 translate x rotate y*90 scale <1,1,2> matrix <1,0,0,0,1,0,0,0,1,5,0,0> }");
    let image = scene.objects[0].placement.affine().point(Point3::new(0.0, 0.0, 0.0));
    assert_eq!(image, Point3::new(5.0, 0.0, -2.0));
    let scene = support::scene(
        "#declare T = transform { translate x scale 2 } sphere { 0, 1 transform { T inverse } } sphere { 0, 1 transform T }",
    );
    assert_eq!(
        scene.objects[0].placement.affine().point(Point3::new(2.0, 0.0, 0.0)),
        Point3::new(0.0, 0.0, 0.0)
    );
    assert_eq!(
        scene.objects[1].placement.affine().point(Point3::new(0.0, 0.0, 0.0)),
        Point3::new(2.0, 0.0, 0.0)
    );
}

#[test]
fn a_texture_moves_with_what_is_written_after_it() {
    let scene = scene(
        "sphere { 0, 1 pigment { checker } translate x } sphere { 0, 1 translate x pigment { checker } }
         sphere { 0, 1 pigment { checker scale 2 } translate x }",
    );
    let origin = Point3::new(0.0, 0.0, 0.0);
    let place = |i: usize| {
        let texture = scene.objects[i].texture.as_ref().unwrap();
        texture.placement.affine().point(pigment(&scene, i).placement.affine().point(origin))
    };
    assert_eq!(
        [place(0), place(1), place(2)],
        [Point3::new(1.0, 0.0, 0.0), origin, Point3::new(1.0, 0.0, 0.0)]
    );
    assert_eq!(
        pigment(&scene, 2).placement.affine().vector(Vec3::new(1.0, 0.0, 0.0)),
        Vec3::new(2.0, 0.0, 0.0)
    );
}

#[test]
fn top_level_objects_are_numbered_as_they_are_finished() {
    let scene = scene(
        "#declare Hidden = sphere { 0, 9 } light_source { 0 rgb 1 } union { sphere { 0, 1 } box { 0, 1 } }
         union { light_source { y rgb 1 } } Hidden object { Hidden translate x }",
    );
    assert_eq!((scene.objects.len(), scene.lights.len()), (3, 2));
    assert!(matches!(&scene.objects[0].shape, Shape::Union(parts) if parts.len() == 2));
    assert!(matches!(scene.objects[1].shape, Shape::Sphere { radius: 9.0, .. }));
}

#[test]
fn parts_of_a_union_keep_their_own_look_and_lights_move_with_it() {
    let scene = scene(
        "union { sphere { 0, 1 pigment { rgb x } } sphere { 0, 1 } light_source { 0 rgb 1 } pigment { rgb y } translate z no_shadow }",
    );
    let Shape::Union(parts) = &scene.objects[0].shape else { panic!("no union") };
    assert!(parts[0].texture.is_some() && parts[1].texture.is_none());
    assert_eq!(solid(&scene, 0), [0.0, 1.0, 0.0]);
    assert!(scene.objects[0].flags.no_shadow);
    assert_eq!(scene.lights[0].location, Point3::new(0.0, 0.0, 1.0));
}

#[test]
fn the_default_texture_is_taken_when_the_object_is_finished() {
    let text = "#declare O = sphere { 0, 1 } #declare P = sphere { 0, 1 pigment { rgb 1 } }
        #default { finish { ambient 1 } pigment { rgb 0.5 } } object { O } object { P }
        sphere { 0, 1 finish { diffuse 0 } } union { sphere { 0, 1 } #default { finish { ambient 0.3 } } }";
    let scene = scene(text);
    assert_eq!((solid(&scene, 0), ambient(&scene, 0)), ([0.5; 3], 1.0));
    assert_eq!((solid(&scene, 1), ambient(&scene, 1)), ([1.0; 3], 0.1));
    assert_eq!((solid(&scene, 2), ambient(&scene, 2)), ([0.5; 3], 1.0));
    assert_eq!(ambient(&scene, 3), 0.3);
}

#[test]
fn parts_of_a_look_change_the_top_layer() {
    let layers = "texture { pigment { rgb x } finish { ambient 1 } } texture { pigment { rgb y } finish { ambient 0.7 } }";
    let scene = scene(&format!(
        "sphere {{ 0, 1 {layers} pigment {{ rgb z }} }} sphere {{ 0, 1 {layers} finish {{ ambient 0.5 }} }}"
    ));
    assert_eq!((solid(&scene, 0), ambient(&scene, 0)), ([0.0, 0.0, 1.0], 0.7));
    assert_eq!((solid(&scene, 1), ambient(&scene, 1)), ([0.0, 1.0, 0.0], 0.5));
    match &scene.objects[0].texture.as_ref().unwrap().body {
        TextureBody::Layers(layers) => assert_eq!(layers.len(), 2),
        TextureBody::Pattern(_) | TextureBody::Fields(_) => panic!("a patterned texture"),
    }
}

#[test]
fn lists_are_filled_up_with_the_languages_colours() {
    let scene = scene(
        "sphere { 0, 1 pigment { checker rgb x } } sphere { 0, 1 pigment { brick rgb x brick_size 2 mortar 0.1 } } sphere { 0, 1 pigment { hexagon } }",
    );
    let PigmentBody::Colours(pattern) = pigment(&scene, 0).body else { panic!("no colours") };
    let Pattern::Cells { cells, entries } = *pattern else { panic!("no cells") };
    assert_eq!((cells, entries.len()), (Cells::Checker, 2));
    assert_eq!([entries[1].rgb.r, entries[1].rgb.g, entries[1].rgb.b], [0.0, 1.0, 0.0]);
    let PigmentBody::Colours(pattern) = pigment(&scene, 1).body else { panic!("no colours") };
    let Pattern::Cells { cells, entries } = *pattern else { panic!("no cells") };
    assert_eq!(cells, Cells::Brick { size: Vec3::new(2.0, 2.0, 2.0), mortar: 0.1 });
    assert_eq!([entries[1].rgb.r, entries[1].rgb.g, entries[1].rgb.b], [0.6, 0.15, 0.15]);
}

#[test]
fn maps_keep_the_order_of_the_text() {
    let scene = scene(
        "sphere { 0, 1 pigment { gradient x color_map { [0.5 rgb x] [0.2, rgb y] [0.2, 0.9 color rgb z color rgb 1] } } } sphere { 0, 1 pigment { gradient y } }",
    );
    let values = |i: usize| match pigment(&scene, i).body {
        PigmentBody::Colours(pattern) => match *pattern {
            Pattern::Map { entries, .. } => entries.iter().map(|(at, _)| *at).collect::<Vec<_>>(),
            Pattern::Cells { .. } | Pattern::Image { .. } | Pattern::Mean(_) | Pattern::Warped { .. } => {
                panic!("no map")
            }
        },
        _ => panic!("no colours"),
    };
    assert_eq!(values(0), [0.5, 0.2, 0.2, 0.9]);
    assert_eq!(values(1), [0.0, 1.0]);
    assert!(
        support::fault("sphere { 0, 1 pigment { checker color_map { [0 rgb 0][1 rgb 1] } } }")
            .2
            .contains("does not go")
    );
    assert!(
        support::fault("sphere { 0, 1 pigment { checker rgb x pigment { rgb y } } }").2.contains("expected")
    );
}

#[test]
fn meshes_share_corners_and_keep_all_faces() {
    let text = "mesh { triangle { 0, x, y } triangle { x, y, x+y } triangle { 0, 0, x } }
        mesh2 { vertex_vectors { 4, 0, x, y, x+y } normal_vectors { 4, z, z, z, z } face_indices { 2, <0,1,2>, <1,2,3> } }";
    let scene = scene(text);
    let mesh = |i: usize| match &scene.objects[i].shape {
        Shape::Mesh(mesh) => mesh.clone(),
        _ => panic!("no mesh"),
    };
    assert_eq!((mesh(0).vertices.len(), mesh(0).faces.len()), (4, 3));
    assert_eq!((mesh(1).faces[1].vertices, mesh(1).faces[1].normals), ([1, 2, 3], Some([1, 2, 3])));
}

#[test]
fn normals_at_corners_are_mixed_at_length_one() {
    let scene = scene(
        "smooth_triangle { 0, z*4, x, <0,3,4>, y, -z } mesh { smooth_triangle { 0, z*4, x, <0,3,4>, y, -z } }
        mesh2 { vertex_vectors { 3, 0, x, y } normal_vectors { 3, z*4, <0,3,4>, -z } face_indices { 1, <0,1,2> } }",
    );
    for object in &scene.objects {
        let normals = match &object.shape {
            Shape::SmoothTriangle(both) => both.1.to_vec(),
            Shape::Mesh(mesh) => mesh.normals.clone(),
            other => panic!("{other:?}"),
        };
        assert_eq!(normals, [Vec3::Z, Vec3::new(0.0, 0.6, 0.8), -Vec3::Z]);
    }
}

#[test]
fn a_polygon_has_the_loops_that_its_points_close() {
    let scene = scene(
        "polygon { 9, <-1,-1>, <1,-1>, <1,1>, <-1,1>, <-1,-1>, <0.5,0.5>, <0.5,-0.5>, <-0.5,-0.5>, <0.5,0.5> }",
    );
    let Shape::Polygon { loops, rule } = &scene.objects[0].shape else { panic!("no polygon") };
    assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [4, 3]);
    assert_eq!(*rule, FillRule::EvenOdd);
}

#[test]
fn a_polygons_first_corners_tell_its_front() {
    let corners = |points: &str| {
        let scene = scene(&format!("polygon {{ 6, {points} pigment {{ rgb 1 }} }}"));
        let Shape::Polygon { loops, .. } = &scene.objects[0].shape else { panic!("no polygon") };
        loops[0].iter().map(|p| (p.x, p.y)).collect::<Vec<_>>()
    };
    // Counterclockwise, except for the notch at the second corner.
    let notched = corners("<-1,0>, <0,0.5>, <1,0>, <1,2>, <-1,2>, <-1,0>");
    assert_eq!(notched, [(-1.0, 0.0), (-1.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.5)]);
    let straight = corners("<-1,0>, <0,0>, <1,0>, <1,2>, <-1,2>, <-1,0>");
    assert_eq!(straight, [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (-1.0, 2.0)]);
}

#[test]
fn a_polygon_takes_a_fill_rule() {
    let rule = |words: &str| {
        let scene = scene(&format!("polygon {{ 4, 0, x, y, 0 {words} pigment {{ rgb 1 }} }}"));
        match &scene.objects[0].shape {
            Shape::Polygon { rule, .. } => *rule,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(rule(""), FillRule::EvenOdd);
    assert_eq!(rule("fill_rule even_odd"), FillRule::EvenOdd);
    assert_eq!(rule("fill_rule non_zero"), FillRule::NonZero);
}

#[test]
fn clips_and_bounds_may_stand_for_each_other() {
    let scene = scene(
        "sphere { 0, 1 clipped_by { plane { y, 0 } } translate x } sphere { 0, 1 bounded_by { box { 0, 1 } } clipped_by { bounded_by } }",
    );
    assert_eq!(scene.objects[0].clips.len(), 1);
    let clip = &scene.objects[0].clips[0];
    assert_eq!(clip.placement.affine().point(Point3::new(0.0, 0.0, 0.0)), Point3::new(1.0, 0.0, 0.0));
    assert!(matches!(scene.objects[1].clips[0].shape, Shape::Box { .. }));
}

#[test]
fn quadrics_have_names() {
    let named = |text: &str| match &scene(text).objects[0].shape {
        Shape::Named(named) => **named,
        _ => panic!("no named quadric"),
    };
    let shape = named("hyperboloid { <1, 2, 3>, sheets 2, from -1 to 5 }");
    assert_eq!((shape.kind, shape.semi_axes), (QuadricKind::HyperboloidTwoSheets, [1.0, 2.0, 3.0]));
    assert_eq!(shape.extent, Some([-1.0, 5.0]));
    assert_eq!(named("spheroid { 2, 3 }").semi_axes, [2.0, 2.0, 3.0]);
    assert_eq!(named("paraboloid { 2, 1 from 0 to 1 open }").kind, QuadricKind::EllipticParaboloid);
    assert_eq!(named("circular_cylinder { 2 }").semi_axes[..2], [2.0, 2.0]);
    assert_eq!(named("parabolic_cylinder { <2, 3> }").kind, QuadricKind::ParabolicCylinder);
    assert!(support::fault("hyperboloid { <1, 2, 3> }").2.contains("sheets"));
    assert!(support::fault("hyperboloid { <1, 2, 3>, sheets 3 }").2.contains("1 or 2 sheets"));
    assert!(support::fault("ellipsoid { <1, 2, 0> }").2.contains("positive"));
    assert!(support::fault("ellipsoid { <1, 2, 3> from 1 to 0 }").2.contains("a below b"));
}

#[test]
fn a_users_own_name_wins_over_durers_words() {
    let scene = scene(
        "#declare ellipsoid = sphere { 0, 7 } object { ellipsoid } #macro annulus() box { 0, 1 } #end annulus()",
    );
    assert!(matches!(scene.objects[0].shape, Shape::Sphere { radius: 7.0, .. }));
    assert!(matches!(scene.objects[1].shape, Shape::Box { .. }));
    let scene = support::scene(
        "#declare E = ellipsoid { <1, 2, 3> } object { E } #declare sheets = 4; sphere { 0, sheets }",
    );
    assert!(matches!(scene.objects[0].shape, Shape::Named(_)));
}

#[test]
fn equal_textures_are_shared() {
    let scene = scene(
        "#declare T = texture { pigment { rgb x } } sphere { 0, 1 texture { T } } sphere { y, 1 texture { T } }",
    );
    let texture = |i: usize| scene.objects[i].texture.as_ref().unwrap();
    assert!(std::sync::Arc::ptr_eq(texture(0), texture(1)));
}

#[test]
fn solids_are_deformed_in_the_order_of_the_text() {
    use durer_math::Vec3;
    use durer_scene::Warp;
    let scene = scene(
        "deform { cylinder { 0, 3*y, 0.2 } twist { y, 90, from 0 to 2 } taper { <1, 2, 2>, 0.5, from -1 to 1 },
         bend { y, -x, -45, from 0.5 to 2.5, } translate 2*z pigment { rgb 1 } }",
    );
    let object = &scene.objects[0];
    let Shape::Deform(deform) = &object.shape else { panic!("{object:?}") };
    assert!(matches!(deform.solid.shape, Shape::Cylinder { .. }));
    let axis = Vec3::Y;
    assert_eq!(
        deform.warps,
        [
            Warp::Twist { axis, degrees: 90.0, from: 0.0, to: 2.0 },
            Warp::Taper { axis: Vec3::new(1.0, 2.0, 2.0), factor: 0.5, from: -1.0, to: 1.0 },
            Warp::Bend { axis, toward: -Vec3::X, degrees: -45.0, from: 0.5, to: 2.5 },
        ]
    );
    assert_eq!(object.placement.affine().centre().z, 2.0);
}

#[test]
fn a_deformed_union_is_a_union_whose_parts_keep_their_looks() {
    let scene = scene(
        "deform { union { sphere { 0, 1 pigment { rgb <1, 0, 0> } } object { box { 0, 1 } inverse } translate y } twist { y, 9, from 0 to 1 }
         pigment { rgb <0, 0, 1> } translate 3*x }",
    );
    let Shape::Union(parts) = &scene.objects[0].shape else { panic!("{:?}", scene.objects[0]) };
    assert!(scene.objects[0].texture.is_some() && parts[0].texture.is_some() && parts[1].texture.is_none());
    for part in parts {
        let Shape::Deform(deform) = &part.shape else { panic!("{part:?}") };
        assert!(deform.solid.texture.is_none() && deform.solid.placement.affine().centre().y == 1.0);
        assert!(part.placement.is_identity());
    }
    assert!(parts[1].flags.inverse);
}

#[test]
fn a_users_own_names_win_over_deform_and_its_small_words() {
    let scene =
        scene("#declare deform = sphere { 0, 1 }; #declare twist = 3; object { deform translate twist*x }");
    assert!(matches!(scene.objects[0].shape, Shape::Sphere { .. }));
    assert_eq!(scene.objects[0].placement.affine().centre().x, 3.0);
}

#[test]
fn parts_of_a_deformed_difference_keep_their_looks() {
    let scene = scene(
        "deform { difference { sphere { 0, 1 } box { 0, 1 pigment { rgb 1 } } } twist { y, 90, from 0 to 1 } }
         deform { difference { sphere { 0, 1 } box { 0, 1 } pigment { rgb 1 } } twist { y, 90, from 0 to 1 } }",
    );
    let Shape::Csg(_, parts) = &scene.objects[0].shape else { panic!("{:?}", scene.objects[0]) };
    assert!(parts.iter().all(|part| matches!(part.shape, Shape::Deform(_))));
    assert!(parts[0].texture.is_none() && parts[1].texture.is_some());
    assert!(matches!(scene.objects[1].shape, Shape::Deform(_)) && scene.objects[1].texture.is_some());
}

#[test]
fn a_map_is_three_functions_and_a_box() {
    use durer_scene::Warp;
    let scene = scene(
        "#declare F = function(x, y, z) { y - 0.1*sin(x) }
         deform { sphere { 0, 1 } formula { function { x }, function { F(x, y, z) } function { z }, contained_by { box { -2, 2 } } } }",
    );
    let Shape::Deform(deform) = &scene.objects[0].shape else { panic!("{:?}", scene.objects[0]) };
    let [Warp::Inverse { functions, within }] = deform.warps.as_slice() else { panic!("{:?}", deform.warps) };
    assert_eq!(functions[0].value(&[0.5, 1.0, 2.0]), 0.5);
    assert!(
        (functions[1].value(&[0.5, 1.0, 2.0]) - (1.0 - 0.1 * durer_math::elementary::sin(0.5))).abs() < 1e-12
    );
    assert_eq!((within.min.x, within.max.z), (-2.0, 2.0));
}

#[test]
fn a_cyclide_has_three_numbers() {
    let scene = scene("cyclide { 0.6, 0.2, 0.25 rotate x*90 }");
    assert_eq!(scene.objects[0].shape, Shape::Cyclide { a: 0.6, c: 0.2, d: 0.25 });
}

#[test]
fn a_capsule_is_the_sweep_of_two_balls() {
    let scene = scene("capsule { <0, 1, 2>, <3, 4, 5>, 0.5 }");
    let balls = [[0.0, 1.0, 2.0, 0.5], [3.0, 4.0, 5.0, 0.5]];
    assert_eq!(scene.objects[0].shape, Shape::SphereSweep(SweepSpline::Linear, balls.into()));
}

#[test]
fn what_cannot_be_deformed_is_refused_with_its_place() {
    use support::fault;
    let refused = |text: &str, says: &str| {
        let (_, column, said) = fault(text);
        assert!(said.contains(says) && column > 0, "{text}: {said}");
        (column, said)
    };
    refused("deform { twist { y, 90, from 0 to 1 } }", "the object that is deformed");
    refused("deform { sphere { 0, 1 } }", "`twist`, `taper`, `bend`, `lattice` or `formula`");
    refused(
        "deform { sphere { 0, 1 } shear { y, 9, from 0 to 1 } }",
        "`twist`, `taper`, `bend`, `lattice` or `formula`",
    );
    refused("deform { sphere { 0, 1 } twist { 90, from 0 to 1 } }", "expected a direction");
    refused("deform { sphere { 0, 1 } twist { from 0 to 1 } }", "expected a direction");
    refused("deform { sphere { 0, 1 } twist { 0*y, 90, from 0 to 1 } }", "no length");
    refused("deform { sphere { 0, 1 } twist { y, from 0 to 1 } }", "the angle of the twist");
    refused("deform { sphere { 0, 1 } twist { y, 90 } }", "`from A to B`");
    refused("deform { sphere { 0, 1 } bend { y, x, 90, from 1 to 1 } }", "a below b");
    refused(
        "deform { sphere { 0, 1 } bend { y, 2*y, 90, from 0 to 1 } }",
        "must not be parallel to its axis",
    );
    refused("deform { sphere { 0, 1 } taper { y, 0, from 0 to 1 } }", "greater than 0");
    refused("deform { sphere { 0, 1 } formula { function { x } function { y } } }", "which z");
    refused(
        "deform { sphere { 0, 1 } formula { function { x } function { y } function { z } } }",
        "contained_by",
    );
    refused(
        "deform { sphere { 0, 1 } formula { function { x } function { y } function { z } contained_by { sphere { 0, 1 } } } }",
        "by a box",
    );
    refused("deform { disc { 0, y, 1 } twist { y, 90, from 0 to 1 } }", "a disc has no formula");
    refused(
        "deform { union { sphere { 0, 1 } torus { 1, 0.2 clipped_by { box { 0, 1 } } } } twist { y, 90, from 0 to 1 } }",
        "clipped",
    );
    refused("deform { cylinder { 0, y, 1 open } twist { y, 90, from 0 to 1 } }", "open");
    let (column, _) = refused(
        "deform { difference { sphere { 0, 1 } sor { 4, <1, 0>, <1, 1>, <1, 2>, <1, 3> } } twist { y, 90, from 0 to 1 } }",
        "a sor",
    );
    assert_eq!(column, 39);
    refused("cyclide { 1, 1, 0.5 }", "less than its semi-axis");
}

#[test]
fn what_is_seen_from_inside_is_handed_down_and_moves_along() {
    let scene = scene(
        "union { sphere { 0, 1 pigment { rgb z } } sphere { 0, 1 interior_texture { pigment { rgb 1 } } pigment { rgb z } }
           pigment { rgb x } interior_texture { pigment { gradient x } } translate 3*x }
         sphere { 0, 1 } triangle { 0, x, y pigment { rgb x } interior_texture { pigment { rgb y } } }",
    );
    let Shape::Union(parts) = &scene.objects[0].shape else { panic!("a union") };
    assert!(parts[0].interior_texture.is_none() && parts[1].interior_texture.is_some());
    assert!(scene.objects[0].interior_texture.is_some() && scene.objects[1].interior_texture.is_none());
    let lowered = scene.lower().unwrap();
    let look = |object, primitive| &lowered.looks[lowered.look_of(object, primitive).unwrap().0 as usize];
    let inside = |object, primitive| {
        let inside = look(object, primitive).inside.map(|i| &lowered.looks[i.0 as usize]);
        inside.map(|look| look.texture.clone())
    };
    // A part without a texture has the union's, moved as the union is; a part's own takes
    // precedence.
    let handed_down = scene.objects[0].interior_texture.clone();
    assert_eq!(inside(0, 0), handed_down);
    assert_eq!(inside(0, 1), parts[1].interior_texture);
    assert_ne!(inside(0, 1), handed_down);
    assert_eq!(inside(1, 0), None);
    // The corners of a triangle are in the opposite order.
    assert_eq!(Some(look(2, 0).texture.clone()), scene.objects[2].interior_texture);
    assert_eq!(inside(2, 0), scene.objects[2].texture);
    let (_, _, text) = support::fault("sphere { 0, 1 interior_texture { pigment { rgb 1 } } }");
    assert!(text.contains("needs a texture"), "{text}");
}

#[test]
fn what_is_cut_lends_its_texture_to_what_cuts() {
    let red = "texture { pigment { rgb x } }";
    let scene = scene(&format!(
        "difference {{ sphere {{ 0, 1 {red} }} box {{ 0, 2 }} sphere {{ x, 1 pigment {{ rgb y }} }} cutaway_textures }}
         intersection {{ sphere {{ 0, 1 {red} }} intersection {{ sphere {{ 0, 2 pigment {{ rgb z }} }} box {{ -1, 1 }} }} plane {{ x, 0 }} cutaway_textures }}
         difference {{ sphere {{ 0, 1 }} box {{ 0, 2 {red} }} cutaway_textures }}
         difference {{ sphere {{ 0, 1 {red} }} box {{ 0, 2 }} cutaway_textures pigment {{ rgb y }} }}
         difference {{ union {{ sphere {{ 0, 1 }} sphere {{ x, 1 }} {red} }} union {{ box {{ 0, 2 }} box {{ -1, 1 }} }} intersection {{ box {{ 0, 2 }} box {{ -1, 1 }} }}
           cutaway_textures }}
         sphere {{ 0, 1 }}",
    ));
    let lowered = scene.lower().unwrap();
    let of = |object, primitive| {
        let look = &lowered.looks[lowered.look_of(object, primitive).unwrap().0 as usize];
        look.texture.clone()
    };
    let Shape::Csg(_, parts) = &scene.objects[0].shape else { panic!("a difference") };
    let red = parts[0].texture.clone().unwrap();
    let green = parts[2].texture.clone().unwrap();
    let none = scene.objects[5].texture.clone().unwrap();
    assert_eq!([of(0, 0), of(0, 1), of(0, 2)], [red.clone(), red.clone(), green.clone()]);
    // All others in equal amounts: a nested part has the textures of the parts beside its parent.
    let Shape::Csg(_, parts) = &scene.objects[1].shape else { panic!("an intersection") };
    let Shape::Csg(_, inner) = &parts[1].shape else { panic!("an intersection") };
    let blue = inner[0].texture.clone().unwrap();
    assert_eq!([of(1, 0), of(1, 1), of(1, 2)], [red.clone(), blue.clone(), red.clone()]);
    let TextureBody::Pattern(pattern) = &of(1, 3).body else { panic!("a pattern") };
    assert_eq!(**pattern, Pattern::Mean(vec![(1.0, red.clone()), (1.0, blue)]));
    // Subtracted parts lend no texture, and a texture around everything takes precedence.
    assert_eq!([of(2, 0), of(2, 1)], [none.clone(), red.clone()]);
    assert_eq!([of(3, 0), of(3, 1)], [red.clone(), green]);
    // A subtracted union is an intersection of complements, and the other way round.
    assert_eq!([of(4, 2), of(4, 3), of(4, 4), of(4, 5)], [red.clone(), red, none.clone(), none]);

    let (_, _, text) = support::fault("union { sphere { 0, 1 } box { 0, 1 } cutaway_textures }");
    assert!(text.contains("intersection or a difference"), "{text}");
    let two = "union { sphere { 0, 1 pigment { rgb x } } box { 0, 1 pigment { rgb y } } }";
    for refused in [
        format!("difference {{ {two} plane {{ x, 0 }} cutaway_textures }}"),
        "merge { difference { sphere { 0, 1 } plane { x, 0 } cutaway_textures } box { 0, 1 } }".into(),
    ] {
        let fault = support::scene(&refused).lower().unwrap_err();
        assert!(fault.to_string().contains("cutaway_textures") && fault.place.is_some(), "{fault}");
    }
}

#[test]
fn components_of_blobs_may_have_textures_of_their_own() {
    let scene = scene(
        "blob { threshold 0.5 sphere { 0, 1, 1 pigment { checker rgb x } translate 2*y } cylinder { 0, x, 1, 1 } component 1, 1, <0, 0, 0> pigment { rgb y } } blob { sphere { 0, 1, 2 } }",
    );
    let blob = |index: usize| match &scene.objects[index].shape {
        Shape::Blob(blob) => blob.clone(),
        other => panic!("{other:?}"),
    };
    let [Some(own), None, None] = &blob(0).textures[..] else { panic!("{:?}", blob(0).textures) };
    let TextureBody::Layers(layers) = &own.body else { panic!("{own:?}") };
    // The component's transformations move everything written before them, including the texture.
    assert_eq!(layers[0].pigment.placement.affine().centre(), Point3::new(0.0, 2.0, 0.0));
    assert_eq!(solid(&scene, 0), [0.0, 1.0, 0.0]);
    assert_eq!(blob(1).textures, []);
}

/// In POV-Ray the inside of a disc is that of its plane.
#[test]
fn a_disc_in_a_solid_is_a_plane_with_a_warning() {
    let text = "intersection { sphere { 0, 1 } disc { <0, 1, 0>, y*2, 3 } }";
    let scene = scene(text);
    let Shape::Csg(_, parts) = &scene.objects[0].shape else { panic!("no solid") };
    assert!(matches!(parts[1].shape, Shape::Plane { .. }), "{:?}", parts[1].shape);
    let warning = "the border of a disc in a solid is not supported yet";
    assert!(support::notices(text).iter().any(|notice| notice.contains(warning)));
    let flat = "merge { sphere { 0, 1 } box { <-1, 0, -1>, <1, 0, 1> } }";
    assert!(support::notices(flat).iter().any(|notice| notice.contains("without thickness")));
}

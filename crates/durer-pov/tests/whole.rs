//! Cameras, lights, settings, and the standard include files.

mod support;

use durer_math::{Point3, Vec3};
use durer_scene::{AssumedGamma, Camera, LightKind, Projection, Rgb};
use support::{Folder, notices, scene};

fn camera(text: &str) -> Camera {
    scene(text).camera.unwrap()
}

fn close(a: Vec3, b: [f64; 3]) -> bool {
    (a - Vec3::new(b[0], b[1], b[2])).length() < 1e-12
}

#[test]
fn a_camera_is_built_in_one_order_whatever_the_order_of_its_words() {
    let one = camera("camera { location <1,2,-5> right x*1.5 angle 70 look_at <0,0.5,1> }");
    let other = camera("camera { look_at <0,0.5,1> location <1,2,-5> angle 70 right x*1.5 }");
    assert_eq!(one, other);
    let old = scene("#version 3.1; camera { look_at <0,0.5,1> location <1,2,-5> angle 70 right x*1.5 }");
    assert_ne!(old.camera.unwrap(), one);
}

#[test]
fn look_at_keeps_lengths_and_handedness() {
    let plain = camera("camera { location -z*5 look_at 0 }");
    assert!(close(plain.direction, [0.0, 0.0, 1.0]) && close(plain.right, [1.33, 0.0, 0.0]));
    assert!(close(plain.up, [0.0, 1.0, 0.0]));
    let mirrored = camera("camera { location -z*5 right -x*1.33 look_at 0 }");
    assert!(close(mirrored.right, [-1.33, 0.0, 0.0]) && close(mirrored.up, [0.0, 1.0, 0.0]));
    // `up` parallel to the direction, before it is turned, makes a mirrored camera.
    assert_eq!(camera("camera { up z location -z*5 look_at 0 }"), mirrored);
    let side = camera("camera { location x*5 direction z*2 look_at 0 }");
    assert!(close(side.direction, [-2.0, 0.0, 0.0]) && close(side.right, [0.0, 0.0, 1.33]));
}

/// Measured from POV-Ray's pictures.
#[test]
fn a_camera_that_looks_along_its_sky_keeps_its_right_vector_or_turns_it_round() {
    let plain = camera("camera { location y*6 right x up y look_at 0 }");
    assert!(close(plain.right, [1.0, 0.0, 0.0]) && close(plain.up, [0.0, 0.0, 1.0]));
    let mirrored = camera("camera { location y*6 right x up z look_at 0 }");
    assert!(close(mirrored.right, [-1.0, 0.0, 0.0]) && close(mirrored.up, [0.0, 0.0, 1.0]));
    let from_below = camera("camera { location y*-6 right x up z look_at 0 }");
    assert!(close(from_below.right, [-1.0, 0.0, 0.0]) && close(from_below.up, [0.0, 0.0, -1.0]));
    let oblique = camera("camera { location y*6 right <1, 1, 0> up z look_at 0 }");
    assert!(close(oblique.right, [-1.0, -1.0, 0.0]));
    assert!(close(oblique.up, [0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2]), "{oblique:?}");
}

#[test]
fn an_orthographic_camera_shows_what_the_perspective_one_would_at_look_at() {
    let fitted = camera("camera { orthographic location -z*5 look_at 0 }");
    assert_eq!(fitted.projection, Projection::Orthographic);
    assert!(close(fitted.right, [1.33 * 5.0, 0.0, 0.0]) && close(fitted.up, [0.0, 5.0, 0.0]));
    let given = camera("camera { orthographic location -z*5 right x*4 up y*3 look_at 0 }");
    assert!(close(given.right, [4.0, 0.0, 0.0]) && close(given.up, [0.0, 3.0, 0.0]));
    let angled = camera("camera { orthographic location -z*5 right x*2 up y*2 angle 90 look_at 0 }");
    assert!(close(angled.right, [10.0, 0.0, 0.0]), "{angled:?}");
}

#[test]
fn transforms_of_a_camera_come_last() {
    let moved = camera("camera { translate x location -z*5 look_at 0 rotate y*90 }");
    assert_eq!(moved.location, Point3::new(-5.0, 0.0, -1.0));
    assert!(close(moved.direction, [1.0, 0.0, 0.0]));
    let named = camera("#declare C = camera { location -z*5 } camera { C translate x }");
    assert_eq!(named.location, Point3::new(1.0, 0.0, -5.0));
    assert!(notices("camera { location -z } camera { location -x }")[0].contains("more than one camera"));
}

#[test]
fn lights_have_their_defaults() {
    let scene = scene(
        "light_source { 0, rgb 1 spotlight } light_source { 0 color rgb <1,0,0> cylinder point_at x }
         light_source { y, 0.5 parallel shadowless fade_distance 3 fade_power 2 translate x } light_source { 0 rgb 1 fade_power 2 }",
    );
    match scene.lights[0].kind {
        LightKind::Spot { radius, falloff, tightness } => {
            assert!(
                (radius.to_degrees() - 30.0).abs() < 1e-12 && (falloff.to_degrees() - 45.0).abs() < 1e-12
            );
            assert_eq!(tightness, 0.0);
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(scene.lights[1].kind, LightKind::Cylinder { radius: 0.75, falloff: 1.0, tightness: 0.0 });
    let third = &scene.lights[2];
    assert!(third.parallel && third.shadowless && third.fade.is_some());
    assert_eq!((third.location, third.point_at), (Point3::new(1.0, 1.0, 0.0), Point3::new(1.0, 0.0, 1.0)));
    assert_eq!(third.colour, Rgb::grey(0.5));
    assert!(scene.lights[3].fade.is_none());
}

#[test]
fn what_a_light_looks_like_is_an_object_without_a_shadow() {
    let scene = scene("light_source { y rgb 1 looks_like { sphere { 0, 1 } } }");
    assert!(scene.objects[0].flags.no_shadow);
    assert_eq!(
        scene.objects[0].placement.affine().point(Point3::new(0.0, 0.0, 0.0)),
        Point3::new(0.0, 1.0, 0.0)
    );
}

#[test]
fn gamma_depends_on_the_version() {
    let gamma = |text: &str| {
        let folder = Folder::new();
        folder.write("scene.pov", text);
        let settings = folder.read("scene.pov").unwrap().scene.settings;
        (settings.assumed_gamma, settings.version)
    };
    assert_eq!(gamma("sphere { 0, 1 }"), (AssumedGamma::None, 3.62));
    assert_eq!(gamma("#version 3.6;"), (AssumedGamma::None, 3.6));
    assert_eq!(gamma("#version 3.7;"), (AssumedGamma::Power(1.0), 3.7));
    assert_eq!(gamma("global_settings { assumed_gamma 2.2 }"), (AssumedGamma::Power(2.2), 3.62));
    assert_eq!(gamma("#version 3.7; global_settings { assumed_gamma srgb }"), (AssumedGamma::Srgb, 3.7));
    assert_eq!(notices("global_settings { assumed_gamma 2 }"), ["a second assumed_gamma is ignored"]);
}

#[test]
fn settings_are_taken() {
    let settings = scene("global_settings { charset utf8 max_intersections 64 noise_generator 2 number_of_waves 5 max_trace_level 9 ambient_light rgb 2 adc_bailout 0.1 }").settings;
    assert_eq!(
        (settings.max_trace_level, settings.adc_bailout, settings.ambient_light),
        (9, 0.1, Rgb::grey(2.0))
    );
    assert_eq!(settings.number_of_waves, 5);
}

/// Every standard file, read after the colours and shapes that some of them expect.
#[test]
fn the_standard_include_files_are_read() {
    let installed = ["/usr/share/povray-3.7/include", "/usr/local/share/povray-3.7/include"];
    let Some(folder) = installed.iter().map(std::path::Path::new).find(|folder| folder.is_dir()) else {
        println!("not run: POV-Ray's include files are not installed");
        return;
    };
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        // Not a library but a scene: it has objects of its own.
        if !name.ends_with(".inc") || name == "stdcam.inc" {
            continue;
        }
        scene(&format!(
            "#include \"colors.inc\"\n#include \"shapes.inc\"\n#include \"{name}\"\n#include \"{name}\""
        ));
        read += 1;
    }
    assert!(read > 30, "{read}");
}

#[test]
fn what_the_standard_files_define_can_be_used() {
    if !std::path::Path::new("/usr/share/povray-3.7/include/colors.inc").is_file() {
        println!("not run: POV-Ray's include files are not installed");
        return;
    }
    let scene = scene(
        "#include \"COLORS.INC\"\n#include \"metals.inc\"\n#include \"glass.inc\"\n#include \"golds.inc\"\n#include \"shapes_old.inc\"
         #include \"transforms.inc\"\n#include \"math.inc\"\n#include \"rand.inc\"\n#include \"arrays.inc\"\n#include \"strings.inc\"
         sphere { 0, 1 pigment { NeonBlue } finish { F_MetalA } } sphere { 0, 1 texture { T_Gold_1A } } sphere { 0, 1 interior { I_Glass } }
         object { Cone_Y texture { T_Chrome_2B } Rotate_Around_Trans(y*90, x) } object { QCone_Y } object { Ellipsoid scale 2 }
         #debug concat(str(VDist(0, x*3), 0, 0), Str(2), \" \", VStr(<1,2,3>))
         #declare R = seed(1); #declare P = VRand_In_Box(-1, 1, R); sphere { P, 0.1 }",
    );
    assert_eq!(scene.objects.len(), 7);
}

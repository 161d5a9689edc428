//! Cameras with lenses and meshes, light groups, rainbows.

mod support;

use durer_scene::{Distribution, LightGroup, Projection};
use support::{read, scene};

const MESH: &str = "mesh { triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> } }";

#[test]
fn a_lens_is_focused_where_the_camera_is_moved_from() {
    let made = scene(
        "camera { location -10*z look_at 0 aperture 0.5 focal_point <3, 4, -10> blur_samples 20
           confidence 0.5 variance 0.01 scale 2 translate 5*z }",
    );
    let lens = made.camera.unwrap().lens.unwrap();
    assert_eq!((lens.aperture, lens.focus, lens.samples), (0.5, 5.0, [7, 20]));
    assert_eq!((lens.confidence, lens.variance, lens.bokeh), (0.5, 0.01, None));
    let lens =
        scene("camera { aperture 1 blur_samples 3, 9 bokeh { pigment { rgb 1 } } }").camera.unwrap().lens;
    assert!(lens.is_some_and(|lens| lens.samples == [3, 9] && lens.bokeh.is_some()));
    assert!(scene("camera { aperture 1 }").camera.unwrap().lens.is_none());
}

#[test]
fn mesh_cameras_have_meshes_and_a_distribution() {
    let mesh = |words: &str| {
        let made = scene(&format!("camera {{ mesh_camera {{ {words} }} location <0, 0, 0.5> }}"));
        match made.camera.unwrap().projection {
            Projection::Mesh(camera) => (*camera).clone(),
            other => panic!("{other:?}"),
        }
    };
    let one = mesh(&format!("1 3 2.5 {MESH} smooth"));
    assert_eq!((one.distribution, one.max_distance), (Distribution::Uv { smooth: true }, Some(2.5)));
    assert_eq!((one.meshes[0].0.uv.len(), one.meshes[0].0.uv_faces[0]), (3, Some([0, 1, 2])));
    let two = mesh(&format!("2, 0 {MESH} object {{ {MESH} translate x }}"));
    assert_eq!((two.distribution, two.max_distance, two.meshes.len()), (Distribution::Each(2), None, 2));
    assert_eq!(mesh(&format!("3 1 {MESH}")).distribution, Distribution::Joined(3));
    assert_eq!(mesh(&format!("1 2 0 {MESH}")).max_distance, None);
}

#[test]
fn what_mesh_cameras_cannot_do_is_said() {
    for (words, why) in [
        (format!("0 0 {MESH}"), "1 ray per pixel at least"),
        (format!("2 0 {MESH}"), "need 2 meshes"),
        (format!("2 3 {MESH}"), "a pixel has 1 ray"),
        (format!("1 4 {MESH}"), "0, 1, 2 or 3"),
        ("1 0".to_owned(), "no mesh"),
        ("1 0 sphere { 0, 1 }".to_owned(), "consists of meshes"),
    ] {
        let fault = read(&format!("camera {{ mesh_camera {{ {words} }} }}")).unwrap_err().to_string();
        assert!(fault.contains(why), "{words}: {fault}");
    }
}

#[test]
fn lights_of_a_group_light_its_objects() {
    let made = scene(
        "light_source { y rgb 1 }
         light_group { light_source { x rgb 1 } sphere { 0, 1 }
           light_group { light_source { z rgb 1 } sphere { x, 1 } global_lights off } global_lights on }
         sphere { z, 1 }",
    );
    let groups = &made.light_groups;
    assert_eq!(groups, &[LightGroup { global_lights: true }; 2]);
    let lit = |light: usize, group| LightGroup::lights(groups, made.lights[light].group, group);
    assert_eq!([0, 1, 2].map(|light| lit(light, None)), [true, false, false]);
    assert_eq!([0, 1, 2].map(|light| lit(light, Some(0))), [true, true, false]);
    assert_eq!([0, 1, 2].map(|light| lit(light, Some(1))), [true, false, true]);
    assert_eq!(made.objects[0].flags.light_group, Some(0));
}

#[test]
fn rainbows_are_read() {
    let made = scene(
        "#declare Bow = rainbow { direction 2*z angle 30 width 10 color_map { [0 rgb 1] [1 rgb 0] } }
         rainbow { Bow arc_angle 90 up <0, 1, 5> } rainbow { width 1 color_map { [0 rgb 1] } }",
    );
    let [bow] = &made.rainbows[..] else { panic!("{:?}", made.rainbows) };
    assert_eq!((bow.axis.z, bow.up.y, bow.colours.len()), (1.0, 1.0, 2));
    assert!((bow.half_arc - 45_f64.to_radians()).abs() < 1e-15 && bow.half_full == bow.half_arc);
    assert!(read("rainbow { direction z }").unwrap_err().to_string().contains("no color_map"));
}

//! Pictures in textures.

mod support;

use durer_pov::{Read, ReadOptions};
use durer_scene::{Between, Colour, ImageMap, Layout, Pattern, PigmentBody, TextureBody};
use support::Folder;

/// A PPM of two columns: red 64, and blue 192 half dark.
const PPM: &str = "P3 2 1 255 64 0 0 0 0 192";

fn with(head: &str, scene: &str) -> Result<Read, durer_pov::PovError> {
    let folder = Folder::new();
    folder.write("a.ppm", PPM);
    folder.write("cut.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
    folder.write("scene.pov", format!("{head}\n{scene}"));
    durer_pov::read(&folder.0.join("scene.pov"), &ReadOptions::default())
}

const NEW: &str = "#version 3.7; global_settings { assumed_gamma 1 }";

fn image(head: &str, block: &str) -> std::sync::Arc<ImageMap> {
    let read = with(head, &format!("sphere {{ 0, 1 pigment {{ image_map {{ {block} }} }} }}"));
    let scene = read.unwrap_or_else(|error| panic!("{error}")).scene;
    let texture = scene.objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("no layers") };
    let PigmentBody::Image(_, map) = &layers[0].pigment.body else { panic!("no picture") };
    map.clone()
}

fn close(colour: Colour, [r, g, b, f, t]: [f64; 5]) -> bool {
    let own = [colour.rgb.r, colour.rgb.g, colour.rgb.b, colour.filter, colour.transmit];
    own.iter().zip([r, g, b, f, t]).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn a_picture_is_read_with_all_that_is_said_of_it() {
    let map = image(NEW, "ppm \"a.ppm\" map_type 1 once interpolate 2 filter all 0.25");
    assert_eq!((map.layout, map.once, map.between), (Layout::Sphere, true, Between::Linear));
    assert_eq!((map.image.columns(), map.image.rows()), (2, 1));
    // A PPM file states no gamma, so its numbers are used unchanged.
    assert!(close(map.image.colour(0, 0), [64.0 / 255.0, 0.0, 0.0, 0.25, 0.0]));
}

#[test]
fn the_numbers_of_a_file_are_brought_to_the_scale_of_the_scene() {
    let power = durer_math::elementary::pow;
    let blue = |head: &str, block: &str| image(head, block).image.colour(1, 0).rgb.b;
    let x = 192.0 / 255.0;
    assert!((blue(NEW, "\"a.ppm\" gamma 2.2") - power(x, 2.2)).abs() < 1e-6);
    let srgb = power((x + 0.055) / 1.055, 2.4);
    assert!((blue(NEW, "\"a.ppm\" gamma srgb") - srgb).abs() < 1e-6);
    let other = "#version 3.7; global_settings { assumed_gamma 2.2 }";
    assert!((blue(other, "\"a.ppm\" gamma srgb") - power(srgb, 1.0 / 2.2)).abs() < 1e-6);
    assert!((blue("#version 3.6;", "\"a.ppm\"") - x).abs() < 1e-6);
}

#[test]
fn material_maps_choose_textures() {
    let text = "sphere { 0, 1 texture { material_map { ppm \"a.ppm\" texture { pigment { rgb 1 } } texture { pigment { rgb x } } } } }";
    let scene = with(NEW, text).unwrap().scene;
    let texture = scene.objects[0].texture.clone().unwrap();
    let TextureBody::Pattern(pattern) = &texture.body else { panic!("no pattern") };
    let Pattern::Image { map, entries } = &**pattern else { panic!("no picture") };
    assert_eq!((entries.len(), map.image.index(0, 0), map.image.index(1, 0)), (2, 64, 0));
}

#[test]
fn wrong_pictures_are_refused_in_words() {
    for (block, part) in [
        ("\"nowhere.png\"", "there is no picture \"nowhere.png\""),
        ("\"a\"", "does not tell what it is"),
        ("png \"a.ppm\"", "is not a PNG file"),
        ("png \"cut.png\"", "cannot be unpacked"),
        ("ppm \"a.ppm\" map_type 3", "map_type is 0, 1, 2 or 5"),
        ("ppm \"a.ppm\" gamma 0", "must be positive"),
        ("iff \"a.iff\"", "not supported yet: a picture of the type iff"),
        ("ppm \"a.ppm\" sphere", "expected a part of a picture, found `sphere`"),
    ] {
        let error =
            with(NEW, &format!("sphere {{ 0, 1 pigment {{ image_map {{ {block} }} }} }}")).unwrap_err();
        assert!(error.text.contains(part), "{block}: {error}");
    }
    let read = with(NEW, "sphere { 0, 1 texture { material_map { ppm \"a.ppm\" } } }");
    assert!(read.unwrap_err().text.contains("needs textures"));
}

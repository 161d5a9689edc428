//! Patterns, warps, normals, the sky, fog, area lights, text, and what is left out of pictures.

mod support;

use durer_pov::ReadOptions;
use durer_scene::{NormalBody, Pattern, PigmentBody, PointWarp, Push, Ramp, TextureBody};
use support::{Folder, fault, notices, scene};

fn pigment(text: &str) -> durer_scene::Pigment {
    let scene = scene(&format!("sphere {{ 0, 1 pigment {{ {text} }} }}"));
    let texture = scene.objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    layers[0].pigment.clone()
}

#[test]
fn warps_come_from_the_last_to_the_first_and_turbulence_last() {
    let text =
        "granite turbulence 0.3 scale 2 warp { repeat 3*x } rotate 90*y warp { turbulence 1 } translate x";
    let pigment = pigment(text);
    let PigmentBody::Colours(pattern) = &pigment.body else { panic!("colours") };
    let Pattern::Warped { warps, pattern } = &**pattern else { panic!("warps") };
    assert!(matches!(
        warps[..],
        [
            PointWarp::Turbulence(_),
            PointWarp::Placed(_),
            PointWarp::Repeat { axis: 0, width: 3.0, .. },
            PointWarp::Placed(_),
            PointWarp::Turbulence(_)
        ]
    ));
    assert!(matches!(**pattern, Pattern::Map { .. }));
    assert!(pigment.placement.affine().as_translation().is_some());
}

#[test]
fn marble_and_wood_stir_themselves() {
    for text in ["marble turbulence 1", "wood turbulence 1"] {
        let pigment = pigment(text);
        let PigmentBody::Colours(pattern) = &pigment.body else { panic!("colours") };
        let Pattern::Map { value, .. } = &**pattern else { panic!("{text}: warps") };
        let stirred = match &value.ramp {
            Ramp::Marble(stir) | Ramp::Wood(stir) => stir.is_some(),
            _ => false,
        };
        assert!(stirred, "{text}");
    }
}

#[test]
fn turbulence_moves_and_shifts_spirals() {
    let pigment = pigment("spiral1 2 turbulence 0.3");
    let PigmentBody::Colours(pattern) = &pigment.body else { panic!("colours") };
    let Pattern::Warped { warps, pattern } = &**pattern else { panic!("warps") };
    assert!(matches!(warps[..], [PointWarp::Turbulence(_)]));
    let Pattern::Map { value, .. } = &**pattern else { panic!("map") };
    assert!(matches!(value.ramp, Ramp::Spiral { turbulence: Some(_), .. }));
}

#[test]
fn an_entry_of_a_texture_map_may_have_a_pattern_of_its_own() {
    let text = "sphere { 0, 1 texture { gradient x texture_map {
        [0 checker texture { pigment { rgb 0 } } texture { pigment { rgb 1 } } scale 2]
        [1 gradient y texture_map { [0 pigment { rgb 0 }] [1 pigment { rgb 1 }] } rotate 30*z] } } }";
    let texture = scene(text).objects[0].texture.clone().unwrap();
    assert!(!matches!(texture.body, TextureBody::Layers(_)));
}

#[test]
fn weights_of_an_average_may_be_left_out() {
    let pigment = pigment("average pigment_map { [rgb 1] [2 rgb 0] }");
    let PigmentBody::Pigments(pattern) = &pigment.body else { panic!("pigments") };
    let Pattern::Mean(entries) = &**pattern else { panic!("mean") };
    assert_eq!(entries.iter().map(|(weight, _)| *weight).collect::<Vec<_>>(), [1.0, 2.0]);
}

#[test]
fn normals_are_read_with_their_amounts() {
    let text = "sphere { 0, 1 normal { bumps 0.7 scale 2 bump_size 0.9 } }";
    let texture = scene(text).objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    let normal = layers[0].normal.as_ref().unwrap();
    assert!(matches!(normal.body, NormalBody::Push { push: Push::Bumps, amount: 0.9, .. }));
    // A slope map has no effect on patterns that push the normal in their own way.
    let text = "sphere { 0, 1 normal { quilted 0.7 slope_map { [0 <0, 1>] [1 <1, 1>] } } }";
    let texture = scene(text).objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    assert!(matches!(layers[0].normal.as_ref().unwrap().body, NormalBody::Push { .. }));
    let declared =
        "#declare S = slope_map { [0 <0, 1>] [1 <1, 1>] } #declare N = normal { onion 2 slope_map { S } }
        sphere { 0, 1 texture { pigment { rgb 1 } normal { N } } }";
    let texture = scene(declared).objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    let NormalBody::Height(height) = &layers[0].normal.as_ref().unwrap().body else { panic!("height") };
    assert_eq!((height.amount, height.slopes.len()), (2.0, 2));
}

#[test]
fn the_normal_of_a_texture_at_texture_coordinates_is_turned() {
    let turn_of = |text: &str| {
        let texture = scene(text).objects[0].texture.clone().unwrap();
        let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
        let normal = layers[0].normal.as_ref().unwrap();
        assert!(normal.on_chart);
        normal.turn.as_ref().map(|turn| turn.affine().linear()[1][0].round())
    };
    let whole = "texture { uv_mapping pigment { rgb 1 } normal { bumps } }";
    assert_eq!(turn_of(&format!("sphere {{ 0, 1 {whole} }}")), Some(0.0));
    assert_eq!(turn_of(&format!("sphere {{ 0, 1 {whole} rotate z*90 }}")), Some(1.0));
    assert_eq!(turn_of("sphere { 0, 1 normal { uv_mapping bumps } rotate z*90 }"), None);
}

#[test]
fn quilted_has_no_frequency_unless_one_is_given() {
    let frequency_of = |text: &str| {
        let pigment = pigment(text);
        let PigmentBody::Colours(pattern) = &pigment.body else { panic!("colours") };
        let Pattern::Map { value, .. } = &**pattern else { panic!("map") };
        value.frequency
    };
    assert_eq!(frequency_of("quilted phase 0.3"), 0.0);
    assert_eq!(frequency_of("quilted frequency 2"), 2.0);
    assert_eq!(frequency_of("onion"), 1.0);
}

#[test]
fn the_sky_and_fog_are_read() {
    let scene = scene(
        "#declare F = fog { distance 5 rgb 1 } fog { F } fog { F fog_type 2 fog_alt 2 up y } fog { distance 0 }
        #declare S = sky_sphere { pigment { gradient y } pigment { rgbt 1 } } sky_sphere { S rotate x*9 }",
    );
    assert_eq!((scene.fogs.len(), scene.sky.unwrap().pigments.len()), (2, 2));
    assert!(scene.fogs[1].ground.is_some());
}

#[test]
fn what_is_left_out_is_told_once_or_refused() {
    let text = "global_settings { radiosity { count 5 } photons { spacing 1 } }
        sphere { 0, 1 interior { media { emission 1 } media { scattering { 1, 1 } } } finish { subsurface { } } }";
    let told = notices(text);
    for word in ["radiosity", "photons", "media", "subsurface"] {
        let start = format!("{word} is not supported yet");
        assert_eq!(told.iter().filter(|text| text.starts_with(&start)).count(), 1, "{told:?}");
    }
    let folder = Folder::new();
    let path = folder.write("scene.pov", text);
    let strict = ReadOptions { strict: true, ..ReadOptions::default() };
    let refused = durer_pov::read(&path, &strict).unwrap_err().to_string();
    assert!(refused.contains("not supported yet: radiosity"), "{refused}");
}

#[test]
fn an_object_is_a_pattern_of_two_entries() {
    let pigment = pigment("object { sphere { 0, 2 translate x } rgb 0.25 rgb 0.75 } scale 2");
    let PigmentBody::Colours(pattern) = &pigment.body else { panic!("colours") };
    let Pattern::Map { value, entries } = &**pattern else { panic!("map") };
    assert!(matches!(value.ramp, Ramp::Inside(_)) && value.frequency == 0.0);
    let shown: Vec<(f64, f64)> = entries.iter().map(|(at, colour)| (*at, colour.rgb.r)).collect();
    assert_eq!(shown, [(0.0, 0.25), (1.0, 0.75)]);
    let texture = "sphere { 0, 1 texture { object { box { 0, 1 } texture { pigment { rgb 0 } } texture { pigment { rgb 1 } } } } }";
    assert!(matches!(
        &scene(texture).objects[0].texture.as_ref().unwrap().body,
        TextureBody::Pattern(pattern) if pattern.entries().count() == 2
    ));
}

#[test]
fn a_density_file_is_read() {
    let folder = Folder::new();
    folder.write("two.df3", [0, 2, 0, 1, 0, 1, 0, 255]);
    folder.write("cut.df3", [0, 2, 0, 1, 0, 1, 0]);
    let text =
        |name: &str| format!("sphere {{ 0, 1 pigment {{ density_file df3 \"{name}\" interpolate 1 }} }}");
    folder.write("scene.pov", text("two.df3"));
    let read = folder.read("scene.pov").unwrap();
    let texture = read.scene.objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    let PigmentBody::Colours(pattern) = &layers[0].pigment.body else { panic!("colours") };
    let Pattern::Map { value, .. } = &**pattern else { panic!("map") };
    let Ramp::Density(grid, between) = &value.ramp else { panic!("density") };
    assert_eq!(grid.value([0.25, 0.5, 0.5], *between), 0.5);
    folder.write("scene.pov", text("cut.df3"));
    let refused = folder.read("scene.pov").unwrap_err().to_string();
    assert!(refused.contains("this is no density file"), "{refused}");
}

#[test]
fn entries_of_normal_maps_start_from_the_default_normal() {
    let scene = scene(
        "#default { normal { bump_size 1.5 } }
        sphere { 0, 1 pigment { rgb 1 } normal { gradient x normal_map { [0 bumps] [1 bumps 0.25] } } }",
    );
    let texture = scene.objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("layers") };
    let NormalBody::Normals(map) = &layers[0].normal.as_ref().unwrap().body else { panic!("normals") };
    let amounts: Vec<f64> = map
        .entries()
        .map(|normal| match normal.body {
            NormalBody::Push { amount, .. } => amount,
            _ => f64::NAN,
        })
        .collect();
    assert_eq!(amounts, [1.5, 0.25]);
}

#[test]
fn a_height_field_of_a_pigment_has_its_grey_values() {
    // POV-Ray's heights of a red, a green and a blue one.
    for (colour, want) in [("0.5, 0, 0", 0.1485), ("0, 0.5, 0", 0.2945), ("0, 0, 0.5", 0.057)] {
        let text = format!("height_field {{ function 4, 4 {{ pigment {{ rgb <{colour}> }} }} }}");
        let scene = scene(&text);
        let durer_scene::Shape::HeightField(field) = &scene.objects[0].shape else { panic!("field") };
        assert!(field.range().iter().all(|height| (height - want).abs() < 1e-4), "{:?}", field.range());
    }
}

#[test]
fn bad_numbers_are_named() {
    for (text, part) in [
        ("sphere { 0, 1 pigment { crackle metric -1 } }", "must be positive, not -1"),
        ("sphere { 0, 1 pigment { mandel 20 exponent 40 } }", "2 to 33, not 40"),
        ("sphere { 0, 1 pigment { magnet 3 mandel 5 } }", "1 or 2, not 3"),
        ("sphere { 0, 1 pigment { mandel 0 } }", "iterations, not 0"),
        ("sphere { 0, 1 pigment { mandel 9 interior 9, 1 } }", "0 to 6, not 9"),
        ("sphere { 0, 1 pigment { bozo warp { repeat <1, 1, 0> } } }", "along one axis"),
        ("sphere { 0, 1 pigment { bozo warp { planar 0, 1 } } }", "cannot be zero"),
        ("sphere { 0, 1 normal { onion accuracy 0 } }", "must be positive, not 0"),
        ("sphere { 0, 1 pigment { average pigment_map { [0 rgb 1] [0 rgb 0] } } }", "zero in sum"),
        ("fog { fog_type 3 }", "1 or 2, not 3"),
        ("light_source { 0 rgb 1 area_light x, y, 0, 2 }", "along a side, not 0"),
        ("camera { cylinder 7 }", "kind 1 to 4, not 7"),
        ("sphere { 0, 1 pigment { density_file df3 \"no.df3\" } }", "there is no picture \"no.df3\""),
        ("sphere { 0, 1 pigment { object { box { 0, <1, 0, 1> } rgb 0 rgb 1 } } }", "without volume"),
        ("global_settings { number_of_waves 0 }", "1 to 1000, not 0"),
        ("text { ttf \"nosuch.ttf\" \"a\" 1, 0 }", "there is no font \"nosuch.ttf\""),
        ("text { internal 9 \"a\" 1, 0 }", "0 to 3, not 9"),
    ] {
        let (_, _, message) = fault(text);
        assert!(message.contains(part), "{text}: {message}");
    }
}

#[test]
fn a_font_cut_in_half_is_a_message() {
    let folder = Folder::new();
    folder.write("half.ttf", "\u{0}\u{1}\u{0}\u{0}\u{0}\u{9}glyf");
    folder.write("scene.pov", "text { ttf \"half.ttf\" \"a\" 1, 0 }");
    let said = folder.read("scene.pov").unwrap_err().to_string();
    assert!(said.contains("not a font that can be read"), "{said}");
}

//! What holds in scenes of old versions of the language, and what is read as POV-Ray reads it although no manual
//! says so. All values were measured with POV-Ray 3.7.

mod support;

use durer_scene::{Colour, NoiseGenerator, Pattern, PigmentBody, Ramp, Rgb, Scene, Shape, TextureBody};
use support::{Folder, debug, fault, notices, scene};

/// The colours of the layers of the first object's texture, the innermost first.
fn layers(scene: &Scene) -> Vec<Colour> {
    let texture = scene.objects[0].texture.clone().unwrap();
    let TextureBody::Layers(layers) = &texture.body else { panic!("no layers") };
    let colour = |pigment: &durer_scene::Pigment| match &pigment.body {
        PigmentBody::Solid(colour) => *colour,
        other => panic!("{other:?}"),
    };
    layers.iter().map(|layer| colour(&layer.pigment)).collect()
}

#[test]
fn a_declaration_before_3_5_ends_without_a_semicolon() {
    let old = |text: &str| debug(&format!("#version 3.1; {text}"));
    assert_eq!(old("#declare A = 1; #declare A = 2 #debug str(A, 0, 0)"), "2");
    assert_eq!(old("#declare I = 0 #while (I < 3) #debug str(I, 0, 0) #declare I = I + 1 #end"), "012");
    assert_eq!(old("#declare B = -5 #if (B = -5) #debug \"yes\" #else #debug \"no\" #end"), "yes");
    assert_eq!(old("#declare C = <1, 2, 3> #declare D = C*2 #debug str(D.y, 0, 0)"), "4");
    assert_eq!(old("#switch (5) #case (5) #declare F = 7 #break #end #debug str(F, 0, 0)"), "7");
    assert_eq!(old("#macro M(Q) #declare Z = Q*2 #end M(3) #debug str(Z, 0, 0)"), "6");
    assert_eq!(old("#macro M(Q) Q*2 #end #declare Z = M(3) + 1 #debug str(Z, 0, 0)"), "7");
    assert_eq!(old("#declare S = 1 #ifdef (S) #debug \"known\" #end"), "known");
    assert_eq!(old("#declare A = 4 sphere { 0, A } #debug str(A, 0, 0)"), "4");
    // Directives within brackets belong to the value.
    assert_eq!(old("#declare V = <1, #if (0) 2 #else 3 #end, 4>; #debug str(V.y, 0, 0)"), "3");
    for block in [
        "pigment { rgb 1 #if (1) scale 2 #end }",
        "finish { phong 1 #if (1) ambient 0 #end }",
        "fog { distance 5 #if (1) rgb 1 #end }",
        "interior { ior 1.5 #if (1) fade_distance 2 #end }",
        "sphere { 0, 1 #if (1) pigment { rgb 1 } #end }",
        "array[2] { 1, #if (1) 2 #end }",
        "transform { scale 2 #if (1) rotate 30*y #end }",
    ] {
        assert_eq!(old(&format!("#declare B = {block} #debug \"read\"")), "read", "{block}");
    }
    let wanted = "a declaration of a float, vector or colour ends with `;`";
    assert_eq!(fault("#version 3.5; #declare A = 1 sphere { 0, A }").2, wanted);
}

#[test]
fn a_second_semicolon_may_stand_behind_a_declaration() {
    assert_eq!(debug("#declare A = 1;; #debug str(A, 0, 0)"), "1");
    assert_eq!(debug("#macro M() #declare A = 2; #end M(); #debug str(A, 0, 0)"), "2");
    assert_eq!(debug("#macro M() 3 #declare A = 2; #end #declare B = M(); #debug str(A + B, 0, 0)"), "5");
    let folder = Folder::new();
    folder.write("colour.inc", "#declare A = rgb <1, 0, 0>;");
    folder.write("scene.pov", "#include \"colour.inc\"; sphere { 0, 1 pigment { A } }");
    assert!(folder.read("scene.pov").is_ok());
    assert!(fault("sphere { 0, 1 };").2.contains("found `;`"));
}

#[test]
fn division_by_zero_is_infinite() {
    let text = "#declare A = <1, 2, 3>/<0, 2, 0>; #if (-1/0 > 5) #debug \"big\" #end";
    assert_eq!(debug(text), "big");
    assert_eq!(notices("#declare A = 1/0;"), ["division by zero gives an infinite number"]);
}

#[test]
fn commas_are_optional_and_one_diffuse_value_resets_the_other() {
    let diffuse = |finish: &str| {
        let made = scene(&format!("#default {{ finish {{ diffuse 0.3, 0.2 }} }} sphere {{ 0, 1 {finish} }}"));
        let texture = made.objects[0].texture.clone().unwrap();
        let TextureBody::Layers(layers) = &texture.body else { panic!("no layers") };
        (layers[0].finish.diffuse, layers[0].finish.diffuse_back)
    };
    assert_eq!(diffuse("finish { diffuse 0.8 0.5 }"), (0.8, 0.5));
    assert_eq!(diffuse("finish { diffuse 0.8, 0.5 }"), (0.8, 0.5));
    assert_eq!(diffuse("finish { diffuse 0.8 }"), (0.8, 0.0));
    assert_eq!(diffuse("finish { phong 1 }"), (0.3, 0.2));
    let made = scene("disc { 0, z, 1 0.5 }");
    assert!(matches!(made.objects[0].shape, Shape::Disc { hole: 0.5, .. }));
}

#[test]
fn a_colour_of_an_object_has_no_effect() {
    for colour in ["color rgb <1, 0, 0>", "colour red 1", "rgb 0.5", "filter 0.5", "Tint"] {
        let text = format!("#declare Tint = rgbf 1; sphere {{ 0, 1 {colour} pigment {{ rgb 0.5 }} }}");
        assert_eq!(notices(&text)[0], "a colour outside of a pigment has no effect", "{colour}");
        assert_eq!(layers(&scene(&text)), [Colour::opaque(Rgb::grey(0.5))]);
    }
    assert!(fault("sphere { 0, 1 <1, 0, 0> }").2.contains("a modifier of the object"));
}

#[test]
fn upper_layers_of_old_scenes_do_not_filter() {
    let two =
        "texture { pigment { rgbf <1, 1, 1, 0.3> } } texture { pigment { rgbft <1, 0, 0, 0.5, 0.25> } }";
    let cleared = [(0.3, 0.0), (0.0, 0.75)];
    let kept = [(0.3, 0.0), (0.5, 0.25)];
    let amounts = |text: &str| {
        let colours = layers(&scene(text));
        colours.iter().map(|colour| (colour.filter, colour.transmit)).collect::<Vec<_>>()
    };
    assert_eq!(amounts(&format!("sphere {{ 0, 1 {two} }}")), kept);
    assert_eq!(amounts(&format!("#version 3.2; sphere {{ 0, 1 {two} }}")), kept);
    assert_eq!(amounts(&format!("#version 3.1; sphere {{ 0, 1 {two} }}")), cleared);
    let declared = format!("#declare T = {two}");
    assert_eq!(
        amounts(&format!("#version 3; {declared} #version 3.7; sphere {{ 0, 1 texture {{ T }} }}")),
        cleared
    );
    assert_eq!(amounts(&format!("{declared} #version 3; sphere {{ 0, 1 texture {{ T }} }}")), cleared);
    let object = format!("#declare S = sphere {{ 0, 1 {two} }} #version 3; object {{ S }}");
    assert_eq!(amounts(&object), kept);
}

#[test]
fn refraction_is_that_of_the_outermost_layer() {
    let refraction = |textures: &str| {
        let made = scene(&format!("sphere {{ 0, 1 {textures} }}"));
        made.objects[0].interior.as_ref().map_or(1.0, |interior| interior.refraction)
    };
    let layer = |value: &str| format!("texture {{ pigment {{ rgbt 1 }} finish {{ refraction {value} }} }}");
    assert_eq!(refraction(&layer("0.5")), 0.5);
    assert_eq!(refraction(&(layer("0.5") + &layer("0.8"))), 0.8);
    assert_eq!(refraction(&(layer("0.5") + "texture { pigment { rgbt 1 } }")), 1.0);
    assert_eq!(refraction(&(layer("0.5") + "interior { ior 1.5 }")), 0.5);
}

#[test]
fn an_index_of_refraction_of_zero_counts_as_one() {
    let made = scene("sphere { 0, 1 interior { ior 0 } }");
    assert_eq!(made.objects[0].interior.as_ref().map(|interior| interior.ior), Some(1.0));
    assert!(fault("sphere { 0, 1 interior { ior -1 } }").2.contains("as -1 is"));
}

#[test]
fn orthographic_sizes_what_an_old_camera_has_so_far() {
    let sizes = |text: &str| {
        let camera = scene(&format!("#version 3.0; camera {{ {text} }}")).camera.unwrap();
        (camera.right.length(), camera.up.length())
    };
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-12 && (b - d).abs() < 1e-12;
    // The distance from <0, 8, 0> to <0, 0, 1>, where a camera looks that is not told otherwise.
    let far = 65.0_f64.sqrt();
    let late = sizes("location <0, 8, 0> direction -y up 3*z right 4*x orthographic");
    assert!(near(late, (4.0 * far, 3.0 * far)));
    let between = sizes("location <0, 8, 0> direction -y up 3*z orthographic right 4*x");
    assert!(near(between, (4.0, 3.0 * far)));
    let first = sizes("orthographic location <0, 8, 0> direction -y up 3*z right 4*x");
    assert!(near(first, (4.0, 3.0)));
}

#[test]
fn the_noise_generator_is_that_at_the_end_of_the_scene() {
    let generators = |text: &str| {
        let made = scene(text);
        let texture = made.objects[0].texture.clone().unwrap();
        let TextureBody::Layers(layers) = &texture.body else { panic!("no layers") };
        let PigmentBody::Colours(pattern) = &layers[0].pigment.body else { panic!("no pattern") };
        let Pattern::Map { value, .. } = &**pattern else { panic!("no map") };
        let Ramp::Noise(grain) = &value.ramp else { panic!("{:?}", value.ramp) };
        (grain.generator, made.settings.noise_generator)
    };
    let sphere = "sphere { 0, 1 pigment { bozo } }";
    assert_eq!(generators(sphere), (None, NoiseGenerator::Second));
    assert_eq!(generators(&format!("{sphere} #version 3.1;")), (None, NoiseGenerator::First));
    assert_eq!(generators(&format!("#version 3.1; {sphere} #version 3.5;")), (None, NoiseGenerator::Second));
    let later = format!("{sphere} global_settings {{ noise_generator 3 }} #version 3.1;");
    assert_eq!(generators(&later), (None, NoiseGenerator::Third));
    let own = "sphere { 0, 1 pigment { bozo noise_generator 1 } }";
    assert_eq!(generators(own), (Some(NoiseGenerator::First), NoiseGenerator::Second));
    // In expressions the noise is that of the place where it is evaluated.
    let noise = "#declare N = function { internal(76) };";
    let value = |text: &str| debug(&format!("{noise} {text} #debug str(N(0.31, 0.42, 0.55), 0, 6)"));
    assert_ne!(value(""), value("#version 3.1;"));
    assert_eq!(value("#version 3.1;"), value("global_settings { noise_generator 1 }"));
}

#[test]
fn a_height_is_a_part_of_a_pigment() {
    let pigment = "#declare F = function { pigment { rgb <0.5, 0.25, 1> } };";
    let text = format!("{pigment} #declare G = function {{ F(x, y, z).hf }}; #debug str(G(0, 0, 0), 0, 9)");
    assert_eq!(debug(&text), format!("{:.9}", (255.0 * 0.5 + 0.25) / 256.0));
    assert!(
        fault("#declare F = function { transform { scale 2 } }; #declare G = function { F(x, y, z).hg };")
            .2
            .contains("a part such as")
    );
}

#[test]
fn a_picture_may_be_made_of_a_function() {
    let pixel = |block: &str, column: usize, row: usize| {
        let made = scene(&format!("sphere {{ 0, 1 pigment {{ image_map {{ {block} }} }} }}"));
        let texture = made.objects[0].texture.clone().unwrap();
        let TextureBody::Layers(layers) = &texture.body else { panic!("no layers") };
        let PigmentBody::Image(_, map) = &layers[0].pigment.body else { panic!("no picture") };
        map.image.colour(column, row)
    };
    let near = |colour: Colour, rgb: [f64; 3], transmit: f64| {
        let Rgb { r, g, b } = colour.rgb;
        [r, g, b, colour.transmit]
            .iter()
            .zip([rgb[0], rgb[1], rgb[2], transmit])
            .all(|(a, b)| (a - b).abs() < 1e-5)
    };
    let pigment =
        "function 4, 3 { pigment { gradient x color_map { [0 rgb 0] [1 rgbft <1, 0.5, 3, 0.5, 0.75>] } } }";
    assert!(near(pixel(pigment, 1, 0), [1.0 / 3.0, 1.0 / 6.0, 1.0], 0.25));
    // The top row is at y = 0, and of values beyond 0 to 1 the fraction counts.
    let function = "function 5 3 { 2*x - 0.5 + y } interpolate 2";
    assert!(near(pixel(function, 0, 0), [0.5; 3], 0.0));
    assert!(near(pixel(function, 1, 1), [0.5; 3], 0.0));
    assert!(near(pixel(function, 3, 2), [0.0; 3], 0.0));
    let fault = |block: &str| fault(&format!("sphere {{ 0, 1 pigment {{ image_map {{ {block} }} }} }}")).2;
    assert!(fault("function 0, 3 { x }").contains("from 1 to 16384 pixels a side, not 0"));
    assert!(fault("function 2, 2 { x } gamma 2").contains("has no gamma"));
}

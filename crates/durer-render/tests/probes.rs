//! One-pixel scenes with the answers of POV-Ray 3.7, each for one fact of the shading model.

use durer_math::{Affine, Point3, Vec3};
use durer_render::{Progress, RenderSettings, World, render};
use durer_scene::{
    AssumedGamma, Background, Camera, Colour, Fade, Finish, Flags, Interior, Layer, Light, Object, Pigment,
    Reflection, Rgb, Scene, Settings, Shape, Texture,
};

/// The light in the middle of a small picture.
fn seen(scene: &Scene) -> [f64; 3] {
    let world = World::new(scene).unwrap();
    let settings = RenderSettings { width: 41, height: 31, threads: Some(1), ..Default::default() };
    let rendered = render(&world, &settings, &Progress::none()).unwrap();
    rendered.film.light(20, 15).unwrap()
}

#[track_caller]
fn check(scene: &Scene, want: [f64; 3]) {
    let got = seen(scene);
    let error = got.iter().zip(want).map(|(g, w)| (g - w).abs()).fold(0.0, f64::max);
    assert!(error < 1e-4, "{got:?} instead of {want:?}");
}

#[track_caller]
fn check_grey(scene: &Scene, want: f64) {
    check(scene, [want; 3]);
}

/// A camera at (0, 0, -3) that looks along z through an angle of one degree.
fn camera() -> Camera {
    Camera {
        location: Point3::new(0.0, 0.0, -3.0),
        direction: Vec3::new(0.0, 0.0, 76.19),
        ..Camera::default()
    }
}

fn plane_at(z: f64, texture: Texture) -> Object {
    Object::new(Shape::Plane { normal: Vec3::Z, distance: z }).with_texture(texture)
}

fn plane(texture: Texture) -> Object {
    plane_at(0.0, texture)
}

fn paint(colour: [f64; 5], finish: Finish) -> Texture {
    Texture::plain(Pigment::solid(Colour::from_terms(colour)), finish)
}

const WHITE: [f64; 5] = [1.0, 1.0, 1.0, 0.0, 0.0];
const GREY: [f64; 5] = [0.5, 0.5, 0.5, 0.0, 0.0];
const BLACK: [f64; 5] = [0.0; 5];

/// A finish without any effect.
fn dark() -> Finish {
    Finish { ambient: Rgb::BLACK, diffuse: 0.0, ..Finish::default() }
}

fn glowing() -> Finish {
    Finish { ambient: Rgb::WHITE, ..dark() }
}

fn matt() -> Finish {
    Finish { diffuse: 1.0, ..dark() }
}

fn mirror(reflection: Reflection) -> Finish {
    Finish { reflection: Some(Box::new(reflection)), ..dark() }
}

fn scene(objects: Vec<Object>) -> Scene {
    Scene { objects, camera: Some(camera()), ..Scene::default() }
}

fn lit(objects: Vec<Object>, light: [f64; 3]) -> Scene {
    Scene { lights: vec![Light::point(light.into(), Rgb::WHITE)], ..scene(objects) }
}

/// A light behind the camera.
const BEHIND: [f64; 3] = [0.0, 0.0, -1000.0];
/// A light at 45 degrees to the line of sight.
const ASIDE: [f64; 3] = [1000.0, 0.0, -1000.0];

fn before(mut scene: Scene, rgb: [f64; 3]) -> Scene {
    scene.background = Background(Colour::opaque(Rgb::new(rgb[0], rgb[1], rgb[2])));
    scene
}

#[test]
fn gamma_relates_numbers_to_light() {
    let with = |assumed_gamma| {
        let settings = Settings { assumed_gamma, ..Settings::default() };
        Scene { settings, ..scene(vec![plane(paint(GREY, glowing()))]) }
    };
    check_grey(&with(AssumedGamma::Power(1.0)), 0.5);
    check_grey(&with(AssumedGamma::Power(2.2)), 0.2176);
    check_grey(&with(AssumedGamma::Srgb), 0.2140);
    check_grey(&with(AssumedGamma::None), 0.2140);
}

#[test]
fn the_default_finish_has_ambient_and_diffuse_light() {
    check_grey(&scene(vec![plane(paint(WHITE, Finish::default()))]), 0.1);
    let finish = Finish { ambient: Rgb::BLACK, ..Finish::default() };
    check_grey(&lit(vec![plane(paint(WHITE, finish))], BEHIND), 0.6);
}

#[test]
fn ambient_light_and_emission() {
    let finish = Finish { emission: Rgb::grey(0.25), ambient: Rgb::grey(0.5), ..dark() };
    let mut scene = scene(vec![plane(paint(WHITE, finish))]);
    scene.settings.ambient_light = Rgb::new(1.0, 0.5, 0.0);
    check(&scene, [0.75, 0.5, 0.25]);
}

#[test]
fn light_fades() {
    let mut scene = lit(vec![plane(paint(WHITE, matt()))], [0.0, 0.0, -10.0]);
    scene.lights[0].fade = Some(Fade { distance: 5.0, power: 2.0 });
    check_grey(&scene, 0.4);
}

#[test]
fn the_background_is_black_unless_it_is_said() {
    check_grey(&scene(vec![]), 0.0);
    let mut half = scene(vec![]);
    half.background = Background(Colour::from_terms([0.5; 5]));
    check_grey(&half, 0.25);
}

#[test]
fn facing_mirrors_end_in_black() {
    let at = |z| plane_at(z, paint(BLACK, mirror(Reflection::constant(Rgb::WHITE))));
    let mut behind = at(-5.0);
    behind.flags.inverse = true;
    check_grey(&before(scene(vec![at(1.0), behind]), [1.0; 3]), 0.0);
}

#[test]
fn facing_mirrors_show_as_many_images_as_there_are_levels() {
    let finish = Finish { ambient: Rgb::grey(0.05), ..mirror(Reflection::constant(Rgb::WHITE)) };
    let at = |z| plane_at(z, paint(WHITE, finish.clone()));
    for levels in [1, 2, 5, 8] {
        let mut scene = scene(vec![at(1.0), at(-5.0)]);
        scene.settings.max_trace_level = levels;
        check_grey(&scene, 0.05 * f64::from(levels));
    }
}

#[test]
fn rays_that_count_for_little_are_not_traced() {
    let finish = Finish { ambient: Rgb::grey(0.05), ..mirror(Reflection::constant(Rgb::grey(0.5))) };
    let at = |z| plane_at(z, paint(WHITE, finish.clone()));
    for (bailout, terms) in [(0.1, 4), (0.06, 5), (1.0 / 255.0, 8)] {
        let mut scene = scene(vec![at(1.0), at(-5.0)]);
        scene.settings.max_trace_level = 100;
        scene.settings.adc_bailout = bailout;
        check_grey(&scene, (0..terms).map(|i| 0.05 / f64::from(1 << i)).sum());
    }
}

#[test]
fn highlights_of_phong_and_blinn() {
    let finish = Finish { phong: 1.0, phong_size: 2.0, ..dark() };
    check_grey(&lit(vec![plane(paint(BLACK, finish))], ASIDE), 0.5);
    let finish = Finish { specular: 1.0, roughness: 0.5, ..dark() };
    check_grey(&lit(vec![plane(paint(BLACK, finish))], ASIDE), 0.8536);
    let finish = Finish { phong: 0.8, phong_size: 5.0, metallic: 1.0, ..dark() };
    check(&lit(vec![plane(paint([1.0, 0.5, 0.0, 0.0, 0.0], finish))], BEHIND), [0.8, 0.4, 0.0]);
}

#[test]
fn clear_paint_filters_and_transmits() {
    let white = |colour| before(scene(vec![plane(paint(colour, dark()))]), [1.0; 3]);
    check(&white([0.5, 0.25, 1.0, 0.5, 0.25]), [0.5, 0.375, 0.75]);
    check_grey(&white([0.5; 5]), 0.75);
    let glow = plane(paint([0.2, 0.4, 0.6, 0.0, 0.0], glowing()));
    check(&before(scene(vec![glow]), [1.0; 3]), [0.2, 0.4, 0.6]);
}

#[test]
fn clear_paint_scatters_less_but_shines_as_much() {
    let clear = [1.0, 1.0, 1.0, 0.0, 0.75];
    let shine = Finish { phong: 0.5, phong_size: 5.0, ..dark() };
    check_grey(&lit(vec![plane(paint(clear, shine))], BEHIND), 0.5);
    check_grey(&lit(vec![plane(paint(clear, matt()))], BEHIND), 0.25);
}

#[test]
fn the_opacity_of_filtering_paint_depends_on_the_version() {
    let mut scene = lit(vec![plane(paint([0.5, 0.5, 0.5, 0.5, 0.0], matt()))], BEHIND);
    check_grey(&scene, 0.25);
    scene.settings.version = 3.6;
    check_grey(&scene, 0.375);
}

#[test]
fn what_is_reflected_passes_too_unless_energy_is_conserved() {
    let clear = [1.0, 1.0, 1.0, 0.0, 1.0];
    let finish = mirror(Reflection::constant(Rgb::grey(0.25)));
    check(&before(scene(vec![plane(paint(clear, finish.clone()))]), [0.4, 0.0, 0.0]), [0.5, 0.0, 0.0]);
    let finish = Finish { conserve_energy: true, ..finish };
    check(&before(scene(vec![plane(paint(clear, finish))]), [1.0, 0.0, 0.0]), [1.0, 0.0, 0.0]);
}

#[test]
fn energy_is_conserved_in_each_channel() {
    let finish = Finish { conserve_energy: true, ..mirror(Reflection::constant(Rgb::new(0.5, 0.25, 0.0))) };
    let mut scene = before(scene(vec![plane(paint([1.0, 1.0, 1.0, 0.0, 0.5], finish))]), [1.0; 3]);
    check(&scene, [0.75, 0.625, 0.5]);
    // With one level only, the mirror shows the background too.
    scene.settings.max_trace_level = 1;
    check(&scene, [0.0; 3]);
}

#[test]
fn layers_are_seen_through_each_other() {
    let layer = |c, finish: Finish| Layer {
        pigment: Pigment::solid(Colour::from_terms(c)),
        finish: finish.into(),
        normal: None,
    };
    let red = layer([1.0, 0.0, 0.0, 0.0, 0.0], glowing());
    let green = layer([0.0, 1.0, 0.0, 0.0, 0.5], glowing());
    check(&scene(vec![plane(Texture::layers(vec![red, green]))]), [0.5, 0.5, 0.0]);
}

#[test]
fn fresnel_reflects_four_percent_head_on() {
    let reflection = Reflection { min: Rgb::BLACK, fresnel: true, ..Reflection::constant(Rgb::WHITE) };
    let glass =
        plane(paint(BLACK, mirror(reflection))).with_interior(Interior { ior: 1.5, ..Interior::default() });
    check_grey(&before(scene(vec![glass]), [1.0; 3]), 0.04);
}

#[test]
fn clear_things_tint_shadows() {
    let window = Object {
        flags: Flags { no_image: true, hollow: true, ..Flags::default() },
        ..Object::new(Shape::Plane { normal: Vec3::new(0.0, 1.0, -1.0), distance: 5.0 })
            .with_texture(paint([1.0, 0.5, 0.0, 0.5, 0.25], Finish::default()))
    };
    let wall = plane(paint(WHITE, matt()));
    check(&lit(vec![wall, window], [0.0, 100.0, -100.0]), [0.5303, 0.3536, 0.1768]);
}

#[test]
fn light_fades_in_a_medium_when_it_leaves_it() {
    let medium = Interior { fade_distance: 1.0, fade_power: 1.0, ..Interior::default() };
    let ball = |colour, medium: &Interior| {
        Object::new(Shape::Sphere { centre: Point3::new(0.0, 0.0, -3.0), radius: 2.0 })
            .with_texture(paint(colour, glowing()))
            .with_interior(medium.clone())
    };
    // The camera is inside; the surface's own light does not fade.
    let half = [1.0, 1.0, 1.0, 0.0, 0.5];
    check_grey(&before(scene(vec![ball(half, &medium)]), [1.0; 3]), 0.5 + 0.5 / 3.0);
    let clear = [1.0, 1.0, 1.0, 0.0, 1.0];
    let flat = Interior { fade_power: 0.0, ..medium };
    check_grey(&before(scene(vec![ball(clear, &flat)]), [1.0; 3]), 0.5);
}

#[test]
fn parts_of_a_union_share_its_medium_and_objects_do_not() {
    let clear = paint([1.0, 1.0, 1.0, 0.0, 1.0], dark());
    let medium = Interior { fade_distance: 1.0, fade_power: 2.0, ..Interior::default() };
    let ball = |z| Object::new(Shape::Sphere { centre: Point3::new(0.0, 0.0, z), radius: 1.0 });
    let union = Object::new(Shape::Union(vec![ball(0.0), ball(0.5)]))
        .with_texture(clear.clone())
        .with_interior(medium.clone());
    check_grey(&before(scene(vec![union]), [1.0; 3]), 0.64);
    let alone = |z| ball(z).with_texture(clear.clone()).with_interior(medium.clone());
    check_grey(&before(scene(vec![alone(0.0), alone(0.5)]), [1.0; 3]), 0.24616);
}

#[test]
fn clear_things_of_one_index_cost_no_level_but_need_one() {
    let disc = |z| {
        Object::new(Shape::Disc { centre: Point3::new(0.0, 0.0, z), normal: Vec3::Z, radius: 9.0, hole: 0.0 })
            .with_texture(paint([1.0, 1.0, 1.0, 0.0, 1.0], dark()))
    };
    let many = scene((0..50).map(|i| disc(f64::from(i) * 0.01)).collect());
    check_grey(&before(many, [1.0; 3]), 1.0);
    let mut one = before(scene(vec![disc(0.0)]), [1.0; 3]);
    one.settings.max_trace_level = 1;
    check_grey(&one, 0.0);
}

#[test]
fn textures_of_a_union_are_handed_down_and_move_with_it() {
    let glow = |rgb: [f64; 3]| paint([rgb[0], rgb[1], rgb[2], 0.0, 0.0], glowing());
    let ball = Object::new(Shape::Sphere { centre: Point3::new(50.0, 0.0, 0.0), radius: 1.0 });
    let mut union = Object::new(Shape::Union(vec![ball.clone()])).with_texture(glow([1.0, 0.0, 0.0]));
    union.transform(&Affine::translation(Vec3::new(-50.0, 0.0, 0.0)).unwrap()).unwrap();
    check(&scene(vec![union.clone()]), [1.0, 0.0, 0.0]);
    union.shape = Shape::Union(vec![ball.with_texture(glow([0.0, 1.0, 0.0]))]);
    check(&scene(vec![union]), [0.0, 1.0, 0.0]);
}

#[test]
fn flags_hide_from_the_camera_from_mirrors_and_from_lights() {
    let glass = |flags| Object {
        flags,
        ..Object::new(Shape::Sphere { centre: Point3::ORIGIN, radius: 0.5 })
            .with_texture(paint(WHITE, glowing()))
    };
    let hidden = glass(Flags { no_image: true, ..Flags::default() });
    let wall = plane_at(1.0, paint(WHITE, matt()));
    check_grey(&lit(vec![hidden, wall.clone()], BEHIND), 0.0); // its shadow is left
    let shadowless = glass(Flags { no_image: true, no_shadow: true, ..Flags::default() });
    check_grey(&lit(vec![shadowless, wall], BEHIND), 1.0);
    let glow = plane_at(-5.0, paint(GREY, glowing()));
    let looking_glass = plane_at(1.0, paint(BLACK, mirror(Reflection::constant(Rgb::WHITE))));
    let unseen = Object { flags: Flags { no_reflection: true, ..Flags::default() }, ..glow.clone() };
    check_grey(&scene(vec![looking_glass.clone(), glow]), 0.5);
    check_grey(&scene(vec![looking_glass, unseen]), 0.0);
}

//! Laws of optics with known answers, to many digits: mirrors, Snell's law, total reflection and
//! the conservation of light.

use durer_math::elementary::{asin, atan, cos, sin};
use durer_math::{Affine, Point3, Vec3};
use durer_render::{AntiAliasing, Progress, Region, RenderSettings, World, render};
use durer_scene::{
    Background, Camera, Cells, Colour, Finish, Flags, Interior, Light, Object, Pattern, Pigment, Reflection,
    Rgb, Scene, Shape, Texture,
};

fn paint(rgb: f64, transmit: f64, finish: Finish) -> Texture {
    let colour = Colour { rgb: Rgb::grey(rgb), filter: 0.0, transmit };
    Texture::plain(Pigment::solid(colour), finish)
}

fn dark() -> Finish {
    Finish { ambient: Rgb::BLACK, diffuse: 0.0, ..Finish::default() }
}

fn glow() -> Texture {
    paint(1.0, 0.0, Finish { ambient: Rgb::WHITE, ..dark() })
}

fn mirror() -> Texture {
    let reflection = Some(Box::new(Reflection::constant(Rgb::WHITE)));
    paint(0.0, 0.0, Finish { reflection, ..dark() })
}

fn clear() -> Texture {
    paint(1.0, 1.0, dark())
}

fn glass(ior: f64) -> Interior {
    Interior { ior, ..Interior::default() }
}

fn ball(centre: Point3, radius: f64) -> Object {
    Object::new(Shape::Sphere { centre, radius })
}

fn plane(normal: Vec3, distance: f64) -> Object {
    Object::new(Shape::Plane { normal, distance })
}

/// The light seen from `eye` in exactly one direction.
fn seen(objects: Vec<Object>, background: f64, eye: Point3, direction: Vec3, levels: u32) -> f64 {
    let (right, up) = direction.normalized().unwrap().orthonormal_basis();
    let camera = Camera { location: eye, direction, right, up, ..Camera::default() };
    let mut scene = Scene { objects, camera: Some(camera), ..Scene::default() };
    scene.background = Background(Colour::opaque(Rgb::grey(background)));
    scene.settings.max_trace_level = levels;
    scene.settings.adc_bailout = 0.0;
    let settings = RenderSettings { width: 1, height: 1, threads: Some(1), ..Default::default() };
    render(&World::new(&scene).unwrap(), &settings, &Progress::none()).unwrap().film.light(0, 0).unwrap()[0]
}

/// Evenly spread directions around -y.
fn downward(i: u32) -> Vec3 {
    let (a, b) = (f64::from(i) * 2.399_963, 0.2 + 0.06 * f64::from(i % 10));
    Vec3::new(sin(b) * cos(a), -cos(b), sin(b) * sin(a))
}

#[test]
fn a_mirror_shows_an_object_where_its_image_is() {
    let (eye, spot) = (Point3::new(0.3, 2.0, -1.0), Point3::new(4.0, 3.0, 2.5));
    let image = Point3::new(spot.x, -spot.y, spot.z);
    let scene = || vec![plane(Vec3::Y, 0.0).with_texture(mirror()), ball(spot, 1e-9).with_texture(glow())];
    assert_eq!(seen(scene(), 0.0, eye, image - eye, 5), 1.0);
    let beside = image - eye + Vec3::new(1e-8, 0.0, 0.0);
    assert_eq!(seen(scene(), 0.0, eye, beside, 5), 0.0);
}

#[test]
fn a_corner_of_mirrors_sends_rays_back() {
    for i in 0..20 {
        let d = downward(i);
        let d = Vec3::new(-d.x.abs() - 0.1, d.y, -d.z.abs() - 0.1);
        let eye = Point3::new(3.0, 2.5, 2.0);
        // Far behind the eye. Only a ray that is parallel to the first one to seven digits hits it.
        let away = 1e8;
        let target = eye - d * (away / d.length());
        let mut objects: Vec<_> =
            [Vec3::X, Vec3::Y, Vec3::Z].map(|n| plane(n, 0.0).with_texture(mirror())).into();
        objects.push(ball(target, 10.0).with_texture(glow()));
        assert_eq!(seen(objects, 0.0, eye, d, 5), 1.0, "{d:?}");
    }
}

#[test]
fn a_glass_plate_shifts_a_ray_sideways() {
    let n = 1.5;
    for i in 1..12 {
        let angle = 0.1 * f64::from(i);
        let inner = asin(sin(angle) / n);
        let d = Vec3::new(sin(angle), -cos(angle), 0.0);
        // The plate is between y = 0 and y = 1; without it the ray would leave at x = tan(angle).
        let out = Point3::new(sin(inner) / cos(inner), 0.0, 0.0);
        let plate =
            Object::new(Shape::Box { a: Point3::new(-50.0, 0.0, -50.0), b: Point3::new(50.0, 1.0, 50.0) });
        let objects = vec![
            plate.with_texture(clear()).with_interior(glass(n)),
            ball(out + d * 3.0, 1e-9).with_texture(glow()),
        ];
        let eye = Point3::new(0.0, 1.0, 0.0) - d * 2.0;
        assert_eq!(seen(objects, 0.0, eye, d, 5), 1.0, "{angle}");
    }
}

#[test]
fn a_glass_ball_turns_a_ray_by_twice_the_bend() {
    let n = 1.33;
    for i in 0..10 {
        let height = 0.095 * f64::from(i);
        let angle = asin(height);
        let inner = asin(height / n);
        // In at the angle `pi - angle` around the ball, out after a chord that spans
        // `pi - 2 inner`.
        let turn = 2.0 * (angle - inner);
        let around = 2.0 * inner - angle;
        let exit = Point3::new(cos(around), sin(around), 0.0);
        let d = Vec3::new(cos(turn), -sin(turn), 0.0);
        let objects = vec![
            ball(Point3::ORIGIN, 1.0).with_texture(clear()).with_interior(glass(n)),
            ball(exit + d * 2.0, 1e-9).with_texture(glow()),
        ];
        assert_eq!(seen(objects, 0.0, Point3::new(-5.0, height, 0.0), Vec3::X, 5), 1.0, "{height}");
    }
}

#[test]
fn total_reflection_begins_at_the_critical_angle() {
    let n = 1.5;
    let critical = asin(1.0 / n);
    for (shift, want) in [(-1e-9, 1.0), (1e-9, 0.0)] {
        let angle = critical + shift;
        // The camera is inside a block whose floor is black; above it is white.
        let block =
            Object::new(Shape::Box { a: Point3::new(-99.0, -9.0, -99.0), b: Point3::new(99.0, 0.0, 99.0) });
        let floor = plane(Vec3::Y, -5.0).with_texture(paint(0.0, 0.0, dark()));
        let objects = vec![block.with_texture(clear()).with_interior(glass(n)), floor];
        let d = Vec3::new(sin(angle), cos(angle), 0.0);
        assert_eq!(seen(objects, 1.0, Point3::new(0.0, -1.0, 0.0), d, 5), want, "{shift}");
    }
}

/// Parts of one object that have no interior share one: a ray that is in the outer ball leaves it at
/// the inner one, which lies in glass. Leaving what was not entered last bends no ray.
#[test]
fn parts_without_an_interior_share_one() {
    let outer = || ball(Point3::ORIGIN, 3.0).with_texture(clear());
    let inner = || ball(Point3::ORIGIN, 1.0).with_texture(clear());
    let between = || ball(Point3::ORIGIN, 2.0).with_texture(clear()).with_interior(glass(1.5));
    // The ray meets the glass where its surface leans by `lean`, and bends to the middle.
    let lean = 0.4;
    let eye = Point3::new(2.0 * sin(lean), 10.0, 0.0);
    let bent = lean - asin(sin(lean) / 1.5);
    let along = Vec3::new(-sin(bent), -cos(bent), 0.0);
    let target = Point3::new(eye.x, 2.0 * cos(lean), 0.0) + along * 1.7;
    let spot = || ball(target, 1e-6).with_texture(glow());
    let one = Object::new(Shape::Union(vec![outer(), between(), inner()]));
    assert_eq!(seen(vec![one, spot()], 0.0, eye, -Vec3::Y, 9), 1.0);
    assert_eq!(seen(vec![outer(), between(), inner(), spot()], 0.0, eye, -Vec3::Y, 9), 0.0);
}

#[test]
fn a_lossless_mirror_in_a_white_world_is_white() {
    for i in 0..10 {
        let objects = vec![
            ball(Point3::new(0.0, -3.0, 0.0), 1.5).with_texture(mirror()),
            ball(Point3::new(2.0, -4.0, 1.0), 1.5).with_texture(mirror()),
        ];
        assert_eq!(seen(objects, 1.0, Point3::ORIGIN, downward(i), 50), 1.0);
    }
}

#[test]
fn glass_that_conserves_energy_loses_none() {
    let reflection = Reflection { min: Rgb::BLACK, fresnel: true, ..Reflection::constant(Rgb::WHITE) };
    let finish = Finish { reflection: Some(Box::new(reflection)), conserve_energy: true, ..dark() };
    for (i, shape) in [
        ball(Point3::new(0.0, -3.0, 0.0), 2.0),
        Object::new(Shape::Box { a: Point3::new(-3.0, -3.0, -3.0), b: Point3::new(3.0, -2.0, 3.0) }),
    ]
    .into_iter()
    .enumerate()
    {
        let object = shape.with_texture(paint(1.0, 1.0, finish.clone())).with_interior(glass(1.5));
        let light = seen(vec![object], 1.0, Point3::ORIGIN, Vec3::new(0.3, -1.0, 0.1), 24);
        // What is still inside after 24 levels is at most R^20, and R < 0.05 here.
        assert!((light - 1.0).abs() < 1e-12, "shape {i}: {light}");
    }
}

#[test]
fn brewsters_angle_leaves_half_of_the_other_half() {
    let n: f64 = 1.5;
    let angle = atan(n);
    let reflection = Reflection { min: Rgb::BLACK, fresnel: true, ..Reflection::constant(Rgb::WHITE) };
    let finish = Finish { reflection: Some(Box::new(reflection)), ..dark() };
    let water = plane(Vec3::Y, 0.0).with_texture(paint(0.0, 0.0, finish)).with_interior(glass(n));
    let d = Vec3::new(sin(angle), -cos(angle), 0.0);
    let light = seen(vec![water], 1.0, Point3::new(0.0, 1.0, 0.0), d, 5);
    let s = (n * n - 1.0) / (n * n + 1.0);
    assert!((light - 0.5 * s * s).abs() < 1e-14);
}

/// Points on a surface lit at grazing angles neither shade themselves nor see through.
#[test]
fn no_surface_shades_itself_and_none_leaks() {
    for scale in [1e-6, 1.0, 1e6] {
        let floor = plane(Vec3::Y, 0.0).with_texture(paint(1.0, 0.0, Finish { diffuse: 1.0, ..dark() }));
        let pearl = ball(Point3::new(0.0, 2.0 * scale, 0.0), scale).with_texture(paint(
            1.0,
            0.0,
            Finish { diffuse: 1.0, ..dark() },
        ));
        let scene = Scene {
            objects: vec![floor, pearl],
            lights: vec![Light::point(Point3::new(900.0 * scale, 30.0 * scale, 0.0), Rgb::WHITE)],
            camera: Some(Camera {
                location: Point3::new(0.0, 2.0 * scale, -6.0 * scale),
                direction: Vec3::new(0.0, -0.2, 1.0),
                ..Camera::default()
            }),
            ..Scene::default()
        };
        let settings = RenderSettings { width: 120, height: 90, ..Default::default() };
        let film = render(&World::new(&scene).unwrap(), &settings, &Progress::none()).unwrap().film;
        for y in 0..90 {
            for x in 0..120 {
                let light = film.light(x, y).unwrap()[0];
                // On the right of the picture nothing stands between the floor and the light, which
                // arrives with a cosine of at least 30/900.
                if x > 80 && y > 60 {
                    assert!(light > 0.02, "acne at {x}, {y}, scale {scale}: {light}");
                }
            }
        }
    }
}

fn busy() -> Scene {
    let checker = Pattern::Cells {
        cells: Cells::Checker,
        entries: vec![Colour::opaque(Rgb::WHITE), Colour::opaque(Rgb::new(0.2, 0.3, 0.8))],
    };
    let floor = plane(Vec3::Y, -1.0)
        .with_texture(Texture::plain(Pigment::colours(checker), Finish { crand: 0.3, ..Finish::default() }));
    let glassy = ball(Point3::new(-0.7, 0.0, 4.0), 1.0).with_texture(clear()).with_interior(glass(1.4));
    let mirrored = ball(Point3::new(1.3, 0.0, 5.0), 1.0).with_texture(mirror());
    let mut turned =
        Object::new(Shape::Box { a: Point3::new(-0.5, -0.5, -0.5), b: Point3::new(0.5, 0.5, 0.5) })
            .with_texture(paint(0.8, 0.0, Finish { phong: 0.6, ..Finish::default() }));
    turned.flags = Flags::default();
    let turn =
        Affine::rotation_y(0.6).unwrap().then(&Affine::translation(Vec3::new(0.2, -0.4, 2.6)).unwrap());
    turned.transform(&turn.unwrap()).unwrap();
    Scene {
        objects: vec![floor, glassy, mirrored, turned],
        lights: vec![Light::point(Point3::new(-5.0, 8.0, -3.0), Rgb::grey(0.9))],
        camera: Some(Camera::default()),
        ..Scene::default()
    }
}

#[test]
fn the_picture_does_not_depend_on_the_threads() {
    let world = World::new(&busy()).unwrap();
    for anti_aliasing in [
        AntiAliasing::Off,
        AntiAliasing::Method1 { threshold: 0.2, depth: 2 },
        AntiAliasing::Method2 { threshold: 0.2, depth: 2 },
    ] {
        let with = |threads| {
            let settings = RenderSettings {
                width: 90,
                height: 70,
                anti_aliasing,
                threads: Some(threads),
                ..Default::default()
            };
            render(&world, &settings, &Progress::none()).unwrap().film
        };
        let one = with(1);
        assert!(one.is_complete());
        assert_eq!(one, with(5), "{anti_aliasing:?}");
    }
}

#[test]
fn a_region_is_a_part_of_the_whole() {
    let world = World::new(&busy()).unwrap();
    let whole = RenderSettings { width: 80, height: 60, ..Default::default() };
    let region = Region { x0: 13, y0: 20, x1: 57, y1: 41 };
    let all = render(&world, &whole, &Progress::none()).unwrap().film;
    let part = render(&world, &RenderSettings { region: Some(region), ..whole }, &Progress::none()).unwrap();
    assert_eq!((part.status.pixels, part.status.pixels_done), (44 * 21, 44 * 21));
    for y in 0..60 {
        for x in 0..80 {
            let inside = (13..57).contains(&x) && (20..41).contains(&y);
            let got = part.film.pixel(x, y).unwrap();
            if inside {
                assert_eq!(got, all.pixel(x, y).unwrap());
            } else {
                assert_eq!(got.alpha, 0.0);
            }
        }
    }
}

#[test]
fn what_is_cancelled_keeps_what_is_done() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let world = World::new(&busy()).unwrap();
    let cancel = AtomicBool::new(false);
    let stop = |_: &durer_render::Status| cancel.store(true, Ordering::Relaxed);
    let settings = RenderSettings { width: 320, height: 200, threads: Some(1), ..Default::default() };
    let progress = Progress::none().reporting(&stop).cancelled_by(&cancel);
    let rendered = render(&world, &settings, &progress).unwrap();
    assert!(rendered.cancelled && !rendered.film.is_complete());
    assert_eq!(rendered.status.pixels_done, 32 * 32);
    assert_eq!(rendered.film.pixels().filter(|p| p.alpha == 1.0).count(), 32 * 32);
}

/// Ctrl-C takes effect within about a second, however long one pixel takes.
#[test]
fn a_pixel_that_takes_years_can_be_cancelled() {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::{Duration, Instant};
    // Each surface reflects everything and lets everything pass: two rays become four, and so on.
    let reflection = Some(Box::new(Reflection::constant(Rgb::WHITE)));
    let both = || paint(1.0, 1.0, Finish { reflection: reflection.clone(), ..dark() });
    let shell = |i: i32| ball(Point3::new(2.0, 0.0, 5.0), 0.02 * f64::from(i)).with_texture(both());
    let mut scene = Scene {
        objects: (1..=60).map(shell).collect(),
        camera: Some(Camera::default()),
        background: Background(Colour::opaque(Rgb::WHITE)),
        ..Scene::default()
    };
    scene.settings.max_trace_level = 200;
    scene.settings.adc_bailout = 0.0;
    let world = World::new(&scene).unwrap();
    for anti_aliasing in [AntiAliasing::Off, AntiAliasing::Method2 { threshold: 0.3, depth: 3 }] {
        let cancel = AtomicBool::new(false);
        let (settings, progress) = (
            RenderSettings { width: 64, height: 60, anti_aliasing, threads: Some(2), ..Default::default() },
            Progress::none().cancelled_by(&cancel),
        );
        let start = Instant::now();
        let (rendered, waited) = std::thread::scope(|scope| {
            let work = scope.spawn(|| render(&world, &settings, &progress).unwrap());
            std::thread::sleep(Duration::from_millis(500));
            cancel.store(true, Ordering::Relaxed);
            (work.join().unwrap(), start.elapsed())
        });
        assert!(waited < Duration::from_secs(3), "{waited:?}");
        assert!(rendered.cancelled && !rendered.film.is_complete());
        // The pixels finished before are white and start at the top left.
        let done = rendered.film.pixels().filter(|p| p.alpha == 1.0).count();
        assert!(done > 20 && rendered.film.pixel(0, 0).unwrap().rgb == Rgb::WHITE, "{done}");
        assert_eq!(rendered.status.pixels_done, done as u64);
    }
}

/// Rays that pass unbent do not raise the level: thousands of sheets in a row must neither exhaust
/// a thread's stack nor turn black.
#[test]
fn thousands_of_clear_sheets_are_seen_through() {
    let disc =
        |z: f64| Shape::Disc { centre: Point3::new(0.0, 0.0, z), normal: Vec3::Z, radius: 1.0, hole: 0.0 };
    let sheet = |i: i32| Object::new(disc(f64::from(i))).with_texture(clear());
    let background = |objects: Vec<Object>| seen(objects, 0.5, Point3::new(0.0, 0.0, -1.0), Vec3::Z, 5);
    assert_eq!(background((0..4000).map(sheet).collect()), background(Vec::new()));
    assert_eq!(background((0..4200).map(sheet).collect()), 0.0);
}

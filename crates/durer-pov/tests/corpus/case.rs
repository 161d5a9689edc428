//! Laws that hold for any text that is read as a scene.

use durer_formula::I8;
use durer_formula::{Formula, Tape};
use durer_math::{Interval, Point3, Ray, Vec3};
use durer_pov::{Limits, PovError, Read, ReadOptions};
use durer_scene::{Lowered, Shape};

/// A tenth of a second's work, and little memory. Any text is read or refused within these limits.
const LIMITS: Limits = Limits {
    include_depth: 8,
    macro_depth: 64,
    steps: 100_000,
    memory: 32 << 20,
    file_size: 1 << 20,
    nesting: 512,
};

/// Reads a scene in a folder of its own, beside `others`, its other files.
fn read(text: &[&[u8]], others: &[(&str, &[u8])]) -> Option<Result<Read, PovError>> {
    let name = format!("durer-case-{}-{:?}", std::process::id(), std::thread::current().id());
    let folder = std::env::temp_dir().join(name.replace(['(', ')'], ""));
    std::fs::create_dir_all(&folder).ok()?;
    let path = folder.join("scene.pov");
    std::fs::write(&path, text.concat()).ok()?;
    for (name, bytes) in others {
        std::fs::write(folder.join(name), bytes).ok()?;
    }
    let read = durer_pov::read(&path, &ReadOptions { limits: LIMITS, ..ReadOptions::default() });
    // A folder that cannot be removed says nothing about the scene.
    let _ = std::fs::remove_dir_all(&folder);
    Some(read)
}

fn said(error: &dyn std::fmt::Display) {
    let said = error.to_string();
    assert!(!said.is_empty() && said.len() < 20_000, "{said}");
}

/// Rays through a scene: from outside along no axis, and from the origin along one.
const RAYS: [([f64; 3], [f64; 3]); 4] = [
    ([0.3, 0.4, -7.0], [-0.02, -0.05, 1.0]),
    ([4.0, 5.0, -6.0], [-0.7, -0.9, 1.1]),
    ([0.0; 3], [0.0, 1.0, 0.0]),
    ([-3.0, 0.11, 0.07], [1.0, 0.01, 0.02]),
];

/// Any text as a scene: it is refused, or it is prepared for rays and the answers along each ray
/// agree with each other.
///
/// # Panics
///
/// Panics if this law does not hold.
pub(crate) fn scene(text: &[u8]) {
    judge(read(&[text], &[]));
}

/// Any bytes as a picture of any format: as heights and as colours.
///
/// # Panics
///
/// Panics if the law of [`scene`] does not hold.
pub(crate) fn picture(bytes: &[u8]) {
    let formats = ["png", "gif", "tga", "jpeg", "ppm", "pgm", "bmp", "tiff", "exr", "hdr", "sys"];
    let Some((&first, rest)) = bytes.split_first() else { return };
    let format = formats[usize::from(first) % formats.len()];
    let name = format!("picture.{format}");
    for text in [
        format!("height_field {{ {format} \"{name}\" }}"),
        format!("box {{ -1, 1 pigment {{ image_map {{ {format} \"{name}\" interpolate 2 }} }} }}"),
    ] {
        judge(read(&[text.as_bytes()], &[(&name, rest)]));
    }
}

/// Any bytes as a font.
///
/// # Panics
///
/// Panics if the law of [`scene`] does not hold.
pub(crate) fn font(bytes: &[u8]) {
    let text = "text { ttf \"letters.ttf\" \"AVgi8&\u{e4}\" 0.2, 0 translate <-1, 0, -0.1> }";
    judge(read(&[text.as_bytes()], &[("letters.ttf", bytes)]));
}

fn judge(read: Option<Result<Read, PovError>>) {
    match read {
        None => {}
        Some(Err(error)) => said(&error),
        Some(Ok(read)) => match read.scene.lower() {
            Err(error) => said(&read.sources.error(error.place, error.to_string())),
            Ok(lowered) => {
                for (origin, direction) in RAYS {
                    answers_agree(&lowered, &Ray::new(Point3::from(origin), Vec3::from(direction)));
                }
            }
        },
    }
}

/// Checks that the hits of a ray are in order and in their brackets, and that the first of them is
/// the closest one.
fn answers_agree(lowered: &Lowered, ray: &Ray) {
    let all = lowered.geometry.all(ray);
    for hit in &all {
        assert!(hit.t_lo <= hit.t && hit.t <= hit.t_hi, "{hit:?} along {ray:?}");
    }
    assert!(all.is_sorted_by(|a, b| a.t <= b.t), "{all:?} along {ray:?}");
    let closest = lowered.geometry.closest(ray);
    assert_eq!(closest.map(|hit| hit.t), all.first().map(|hit| hit.t), "along {ray:?}");
    assert_eq!(lowered.geometry.any(ray), closest.is_some(), "along {ray:?}");
}

/// Any text as the body of a function: it is refused, or it becomes a formula whose bounds contain
/// its values.
///
/// # Panics
///
/// Panics if this law does not hold.
pub(crate) fn function(text: &[u8]) {
    let read = read(&[
        b"#version 3.7;\n#declare F = function(x, y, z) { ",
        text,
        b" };\n#declare V = F(0.1, 0.2, 0.3);\nisosurface { function { F(x, y, z) } contained_by { box { -1, 1 } } }\n",
    ], &[]);
    match read {
        None => {}
        Some(Err(error)) => said(&error),
        Some(Ok(read)) => {
            for object in &read.scene.objects {
                if let Shape::Isosurface(surface) = &object.shape {
                    bounds_hold(&surface.function);
                }
            }
        }
    }
}

/// Checks that the bounds of a formula on boxes contain its values at points of the boxes.
fn bounds_hold(formula: &Formula) {
    let tape = Tape::new(formula);
    let between = |lo: f64, hi: f64| I8::splat(Interval { lo, hi });
    for (lo, hi) in [([-1.0; 3], [1.0; 3]), ([0.0; 3], [0.0; 3]), ([0.1, -0.3, 0.5], [0.10001, -0.2, 0.5])] {
        let boxes = core::array::from_fn(|i| between(lo[i], hi[i]));
        let range = tape.bounds(&boxes);
        for k in [0.0, 0.25, 0.5, 1.0] {
            let p = core::array::from_fn(|i| (lo[i] + (hi[i] - lo[i]) * k).clamp(lo[i], hi[i]));
            let value = tape.value(Point3::from(p));
            // An infinite or undefined value may result from an intermediate overflow, so it says
            // nothing about the formula.
            if value.is_finite() {
                assert!(range.lane(0).contains(value), "{formula:?} at {p:?} is {value}, not in {range:?}");
            }
        }
    }
}

//! Laws that hold for any text that is read as a scene.

use durer_formula::{Formula, Tape};
use durer_math::{I8, Interval, Point3};
use durer_pov::{Limits, PovError, Read, ReadOptions};
use durer_scene::Shape;
use std::path::Path;

/// A tenth of a second's work, and little memory. Any text is read or refused within these limits.
const LIMITS: Limits = Limits {
    include_depth: 8,
    macro_depth: 64,
    steps: 100_000,
    memory: 32 << 20,
    file_size: 1 << 20,
    nesting: 512,
};

fn read(text: &[&[u8]]) -> Option<Result<Read, PovError>> {
    let name = format!("durer-case-{}-{:?}.pov", std::process::id(), std::thread::current().id());
    let path = std::env::temp_dir().join(name.replace(['(', ')'], ""));
    std::fs::write(&path, text.concat()).ok()?;
    let read = durer_pov::read(&path, &ReadOptions { limits: LIMITS, ..ReadOptions::default() });
    // Another run writes a file of its own.
    let _ = std::fs::remove_file(Path::new(&path));
    Some(read)
}

fn said(error: &dyn std::fmt::Display) {
    let said = error.to_string();
    assert!(!said.is_empty() && said.len() < 20_000, "{said}");
}

/// Any text as a scene: it is read and prepared for rays, or refused.
///
/// # Panics
///
/// Panics if this law does not hold.
pub(crate) fn scene(text: &[u8]) {
    match read(&[text]) {
        None => {}
        Some(Err(error)) => said(&error),
        Some(Ok(read)) => {
            if let Err(error) = read.scene.lower() {
                said(&read.sources.error(error.place, error.to_string()));
            }
        }
    }
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
    ]);
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

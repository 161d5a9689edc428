//! `cargo xtask test`: the checks that must pass before a change goes in.

use crate::command::{Durer, Shot, cargo, root, scratch, step};
use crate::compare::compare;
use crate::picture::Picture;
use crate::{Outcome, conformance, python, scenes};
use std::path::Path;

/// Two pixels that differ by more than this are visibly different.
const CONTRAST: u8 = 24;

/// Runs formatting, lints, documentation, tests, the scenes and the Python package. Stops at the
/// first failure.
pub(crate) fn run() -> Outcome {
    step("cargo fmt --all --check", cargo().args(["fmt", "--all", "--check"]))?;
    step(
        "cargo clippy --workspace --all-targets",
        cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
    )?;
    step(
        "cargo doc --workspace --no-deps",
        cargo().args(["doc", "--workspace", "--no-deps", "--quiet"]).env("RUSTDOCFLAGS", "-D warnings"),
    )?;
    // The examples have been checked above; compiling them takes as long as a crate's tests.
    step(
        "cargo test --workspace --lib --bins --tests",
        cargo().args(["test", "--workspace", "--lib", "--bins", "--tests", "--quiet"]),
    )?;
    step("cargo test --workspace --doc", cargo().args(["test", "--workspace", "--doc", "--quiet"]))?;

    // Uses the program that the tests have just built. Another build, for release, would take a
    // quarter of the total time.
    let durer = Durer::tested()?;
    gallery_scenes(&durer)?;
    reference_pictures(&durer)?;
    python::run(&[])?;
    println!("==> everything passed");
    Ok(())
}

/// Every scene of the gallery must render, show something, and be the same on one thread as on all.
fn gallery_scenes(durer: &Durer) -> Outcome {
    let scenes = scenes::list(&root().join("scenes"), &[])?;
    println!("==> {} scenes of scenes/", scenes.len());
    let folder = scratch("scenes")?;
    let size = Shot { width: 96, height: 72, aa: "off", threads: None };
    for scene in &scenes {
        let parallel = folder.join(format!("{}.png", scene.name));
        let serial = folder.join(format!("{}-1.png", scene.name));
        durer.render(&scene.path, &parallel, size)?;
        durer.render(&scene.path, &serial, Shot { threads: Some(1), ..size })?;
        let picture = Picture::read(&parallel)?;
        if (picture.width, picture.height) != (size.width, size.height) {
            return Err(format!("{}: the picture has the wrong size", scene.name));
        }
        if picture.is_blank(CONTRAST) {
            return Err(format!("{}: the picture is blank", scene.name));
        }
        if bytes(&parallel)? != bytes(&serial)? {
            return Err(format!("{}: one thread and many threads make different pictures", scene.name));
        }
    }
    Ok(())
}

fn bytes(path: &Path) -> Outcome<Vec<u8>> {
    std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// Compares our pictures with reference pictures by POV-Ray. These are kept beside their scenes, so
/// the comparison works without POV-Ray.
fn reference_pictures(durer: &Durer) -> Outcome {
    let scenes = conformance::scenes(&[])?;
    println!("==> {} scenes against their reference pictures", scenes.len());
    let folder = scratch("references")?;
    let (width, height) = conformance::REFERENCE_SIZE;
    let mut failures = Vec::new();
    for scene in &scenes {
        let ours = folder.join(format!("{}.png", scene.name));
        durer.render(&scene.path, &ours, Shot { width, height, aa: "off", threads: None })?;
        let reference = Picture::read(&conformance::reference(&scene.name))?;
        let (difference, drawn) = compare(&Picture::read(&ours)?, &reference)?;
        if !difference.passes() {
            drawn.write(&folder.join(format!("{}-difference.png", scene.name)))?;
            failures.push(format!("{}: {:.2} %", scene.name, 100.0 * difference.agreeing));
        }
    }
    if failures.is_empty() {
        return Ok(());
    }
    Err(format!(
        "fewer than 99 % of the pixels agree (see {}):\n  {}",
        folder.display(),
        failures.join("\n  ")
    ))
}

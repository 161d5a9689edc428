//! `cargo xtask conformance`: renders the same scenes with durer and with POV-Ray.

use crate::command::{Durer, Shot, root, scratch, step};
use crate::compare::{Difference, REQUIRED, TOLERANCE, compare};
use crate::picture::Picture;
use crate::povray::{self, Povray};
use crate::scenes::{self, Scene};
use crate::{Outcome, report};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// The folder of the scenes made for the comparison, and of all reference pictures.
const SCENES: &str = "tests/conformance";

/// The size of the pictures that are kept beside the scenes.
pub(crate) const REFERENCE_SIZE: (u32, u32) = (160, 120);

const SIZES: [(u32, u32); 2] = [REFERENCE_SIZE, (320, 240)];
const TIMED_SIZE: (u32, u32) = (1280, 720);

/// The scenes that both programs can read, all of them or the named ones. They are the scenes made
/// for the comparison, and the gallery's composition.
pub(crate) fn scenes(names: &[String]) -> Outcome<Vec<Scene>> {
    let mut all = scenes::list(&root().join(SCENES), &[])?;
    all.extend(scenes::list(&root().join("scenes"), &["melencolia".to_owned()])?);
    if let Some(unknown) = names.iter().find(|name| all.iter().all(|s| s.name != **name)) {
        return Err(format!("conformance: no scene named {unknown}"));
    }
    all.retain(|s| names.is_empty() || names.contains(&s.name));
    Ok(all)
}

/// The path of POV-Ray's picture of a scene, under version control.
pub(crate) fn reference(name: &str) -> PathBuf {
    root().join(SCENES).join("reference").join(format!("{name}.png"))
}

/// The measurements of one scene.
#[derive(Debug)]
pub(crate) struct Row {
    pub(crate) name: String,
    /// The scene's file, relative to the top folder.
    pub(crate) file: String,
    /// One for each size.
    pub(crate) differences: Vec<Difference>,
    /// `None` if only pictures were requested.
    pub(crate) cost: Option<Cost>,
}

/// Processor seconds of the whole program at the timed size, on one thread.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    pub(crate) ours: f64,
    pub(crate) theirs: f64,
}

/// Runs the comparison; fails if a picture does not agree well enough.
pub(crate) fn run(words: &[String]) -> Outcome {
    if let Some((_, rest)) = words.split_first().filter(|(first, _)| *first == "--distribution") {
        return distribution(rest);
    }
    let check = words.iter().any(|w| w == "--check");
    let names: Vec<String> = words.iter().filter(|w| *w != "--check").cloned().collect();
    if let Some(unknown) = names.iter().find(|n| n.starts_with('-')) {
        return Err(format!("conformance: unknown option {unknown}"));
    }
    let Some(povray) = Povray::find() else {
        println!("conformance: {}", povray::MISSING);
        return Ok(());
    };
    let scenes = scenes(&names)?;
    let durer = Durer::build()?;
    println!("{}", report::heading(&SIZES, !check));
    let mut rows = Vec::new();
    for scene in &scenes {
        let row = measure(&durer, &povray, scene, !check)?;
        println!("{}", report::line(&row));
        rows.push(row);
    }
    println!("{}", report::summary(&rows));
    if !check && names.is_empty() {
        keep_references(&scenes)?;
        let text = report::document(&rows, &SIZES, TIMED_SIZE, &povray.version);
        let path = root().join("docs/conformance.md");
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        println!("written: docs/conformance.md");
    }
    let failed: Vec<&str> =
        rows.iter().filter(|r| !r.differences.iter().all(|d| d.passes())).map(|r| r.name.as_str()).collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(format!(
        "fewer than {:.0} % of the pixels within {TOLERANCE}/255: {} (pictures in {})",
        100.0 * REQUIRED,
        failed.join(", "),
        scratch("conformance")?.display(),
    ))
}

/// Compares the scenes that come with POV-Ray, all of them or those with a word in their path, with its noise.
fn distribution(words: &[String]) -> Outcome {
    let folder = scratch("distribution")?;
    let durer = Durer::build()?.with_learned_noise(&folder.join("data"))?;
    let mut command = Command::new("python3");
    command.arg(root().join("tests/outside/check_distribution.py"));
    command.arg("--durer").arg(durer.program()).arg("--work").arg(&folder);
    match words {
        [] => {}
        [word] => drop(command.args(["--only", word])),
        _ => return Err("conformance: --distribution takes one word of the scenes' paths".into()),
    }
    command.env("XDG_DATA_HOME", folder.join("data"));
    step("python3 tests/outside/check_distribution.py", &mut command)
}

/// Renders one scene with both programs at all sizes.
fn measure(durer: &Durer, povray: &Povray, scene: &Scene, timed: bool) -> Outcome<Row> {
    let folder = scratch("conformance")?;
    let file = |size: (u32, u32), what: &str| folder.join(format!("{}-{}-{what}.png", scene.name, size.0));
    let mut differences = Vec::new();
    for size in SIZES {
        let (ours, theirs) = (file(size, "durer"), file(size, "povray"));
        let shot = Shot { width: size.0, height: size.1, aa: "off", threads: None };
        durer.render(&scene.path, &ours, shot)?;
        povray.render(&scene.path, &theirs, shot)?;
        let (difference, drawn) = compare(&Picture::read(&ours)?, &Picture::read(&theirs)?)?;
        drawn.write(&file(size, "difference"))?;
        differences.push(difference);
    }
    let cost = if timed {
        let shot = Shot { width: TIMED_SIZE.0, height: TIMED_SIZE.1, aa: "off", threads: Some(1) };
        let ours = cost_of(|| durer.render(&scene.path, &file(TIMED_SIZE, "durer"), shot))?;
        let theirs = cost_of(|| povray.render(&scene.path, &file(TIMED_SIZE, "povray"), shot))?;
        Some(Cost { ours, theirs })
    } else {
        None
    };
    let file = scene.path.strip_prefix(root()).unwrap_or(&scene.path).display().to_string();
    Ok(Row { name: scene.name.clone(), file, differences, cost })
}

/// Copies POV-Ray's small pictures to the folder of the scenes, for `cargo xtask test` where
/// POV-Ray is not installed.
fn keep_references(scenes: &[Scene]) -> Outcome {
    let folder = scratch("conformance")?;
    for scene in scenes {
        let made = folder.join(format!("{}-{}-povray.png", scene.name, REFERENCE_SIZE.0));
        let kept = reference(&scene.name);
        if let Some(parent) = kept.parent() {
            std::fs::create_dir_all(parent).map_err(|e| format!("{}: {e}", parent.display()))?;
        }
        Picture::read(&made)?.write(&kept)?;
    }
    Ok(())
}

/// The processor seconds used by the programs that `work` started. If the system does not report
/// them, the elapsed time.
fn cost_of(work: impl FnOnce() -> Outcome) -> Outcome<f64> {
    let (start, before) = (Instant::now(), children_seconds());
    work()?;
    Ok(match (before, children_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => start.elapsed().as_secs_f64(),
    })
}

/// The processor seconds of all ended child processes, from Linux' process table.
fn children_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string(Path::new("/proc/self/stat")).ok()?;
    // Field 2 is the program's name in parentheses and may contain spaces. Fields 16 and 17 are
    // cutime and cstime, in ticks of 1/100 s on every Linux.
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_whitespace().skip(13);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_its_reference_picture() {
        for scene in scenes(&[]).unwrap() {
            assert!(reference(&scene.name).is_file(), "{}: run `cargo xtask conformance`", scene.name);
        }
    }

    #[test]
    fn a_busy_child_costs_processor_time() {
        if children_seconds().is_none() {
            println!("not run: this system does not tell the time of ended processes");
            return;
        }
        let busy = || {
            let script = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done";
            let status = Command::new("sh").args(["-c", script]).status();
            status.map(|_| ()).map_err(|e| e.to_string())
        };
        let cost = cost_of(busy).unwrap();
        assert!((0.01..60.0).contains(&cost), "{cost}");
    }
}

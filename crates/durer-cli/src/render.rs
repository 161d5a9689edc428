//! `durer render`: renders a scene to a picture.

use crate::args::{RenderArgs, SceneArgs};
use crate::failure::Failure;
use crate::input;
use durer::render::film::{Bits, FileFormat, Film, SaveError};
use durer::render::{Progress, Region, RenderError, RenderSettings, Rendered, Status, World, render};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let output = args.output.clone().unwrap_or_else(|| default_output(&args.scene.scene));
    let bits = if args.bits == 16 { Bits::Sixteen } else { Bits::Eight };
    let format = FileFormat::of(&output, bits).map_err(|e| Failure::Usage(e.to_string()))?;
    check_place(&output)?;
    let region = args.part()?;
    let frames = args.frames.frames(&output)?;
    let Some(frames) = frames else {
        return one(args, &args.scene, (&output, format), region);
    };
    frames.into_iter().try_for_each(|frame| {
        let mut scene = args.scene.clone();
        scene.clock = frame.clock;
        // Names declared on the command line replace those of the sequence.
        scene.declare = frame.names.into_iter().chain(scene.declare).collect();
        one(args, &scene, (&frame.output, format), region)
    })
}

/// Renders one picture.
fn one(
    args: &RenderArgs,
    scene: &SceneArgs,
    (output, format): (&Path, FileFormat),
    region: Option<Region>,
) -> Result<(), Failure> {
    let (width, height) = args.size.size();
    input::with_threads(args.threads, || {
        let loaded = input::load(scene, (width, height))?;
        loaded.save_written()?;
        if loaded.scene().camera.is_none() {
            return Err(Failure::file(&args.scene.scene, "the scene has no camera, and a picture needs one"));
        }
        let world = loaded.world()?;
        let settings = RenderSettings {
            width,
            height,
            anti_aliasing: args.aa,
            region,
            depth: format.depth(),
            threads: None,
        };
        // Without a handler, Ctrl-C ends the program as usual, and only the partial picture is
        // lost. Later pictures of a sequence keep the handler of the first.
        let _ = ctrlc::set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
        let rendered = watched(&world, &settings, args.no_progress);
        let rendered = rendered.map_err(|e| Failure::file(&args.scene.scene, e))?;
        if rendered.cancelled {
            let partial = partial_name(output);
            save(&rendered.film, &partial, format)?;
            return Err(Failure::Interrupted(partial));
        }
        if args.stats {
            report(&rendered.status);
        }
        save(&rendered.film, output, format)
    })
}

/// Reports on stderr what a picture took.
fn report(status: &Status) {
    let (rays, steps) = (status.rays, status.steps);
    eprintln!(
        "  rays        {}: {} from the camera, {} reflected, {} transmitted, {} to lights",
        rays.total(),
        rays.camera,
        rays.reflected,
        rays.transmitted,
        rays.shadow
    );
    if steps.rays > 0 {
        let per_ray = |n: u64| n as f64 / steps.rays as f64;
        eprintln!("  steps       of {} rays near patches, sweeps or parametric surfaces:", steps.rays);
        eprintln!("    {:>10.3}  evaluations per ray", per_ray(steps.evaluations));
        eprintln!("    {:>10.3}  subdivisions per ray", per_ray(steps.cuts));
        eprintln!("    {:>10}  evaluations and subdivisions of a single ray, at most", steps.most);
        eprintln!("    {:>10}  crossings proven to exist and to be unique", steps.proven);
        eprintln!(
            "    {:>10}  crossings not proven: grazing rays and crossings close together",
            steps.unproven
        );
    }
    eprintln!("  time        {:.3} s", status.elapsed.as_secs_f64());
}

/// Renders the picture, with a progress bar on stderr if that is a terminal.
fn watched(world: &World, settings: &RenderSettings, quiet: bool) -> Result<Rendered, RenderError> {
    let progress = Progress::none().cancelled_by(&INTERRUPTED);
    if quiet || !std::io::stderr().is_terminal() {
        return render(world, settings, &progress);
    }
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}");
    if let Ok(style) = style {
        bar.set_style(style);
    }
    let report = |status: &Status| {
        bar.set_length(status.pixels);
        bar.set_position(status.pixels_done);
        let left = status.remaining().map_or(0, |d| d.as_secs());
        let rate = status.rays_per_second() / 1e6;
        bar.set_message(format!("{rate:.2} Mrays/s, {}:{:02} left", left / 60, left % 60));
    };
    let rendered = render(world, settings, &progress.reporting(&report));
    bar.finish_and_clear();
    rendered
}

fn save(film: &Film, path: &Path, format: FileFormat) -> Result<(), Failure> {
    film.save(path, format).map_err(|e| match e {
        SaveError::Io { path, source } => Failure::file(&path, format_args!("cannot write: {source}")),
        other => Failure::Usage(other.to_string()),
    })
}

/// The scene's name with `.png`, in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    PathBuf::from(scene.file_name().unwrap_or_default()).with_extension("png")
}

/// `NAME.partial.png` for `NAME.png`.
fn partial_name(output: &Path) -> PathBuf {
    let ending = output.extension().unwrap_or_default().to_string_lossy().into_owned();
    output.with_extension(format!("partial.{ending}"))
}

/// Checks before the work whether the output can be written.
fn check_place(output: &Path) -> Result<(), Failure> {
    let folder = output.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if output.is_dir() {
        Err(Failure::file(output, "cannot write: this is a directory"))
    } else if folder.is_dir() {
        Ok(())
    } else {
        Err(Failure::file(output, format_args!("cannot write: there is no folder '{}'", folder.display())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_pictures_follow_the_scene() {
        assert_eq!(default_output(Path::new("a/b/knot.pov")), Path::new("knot.png"));
        assert_eq!(partial_name(Path::new("x/knot.png")), Path::new("x/knot.partial.png"));
        assert_eq!(partial_name(Path::new("knot.exr")), Path::new("knot.partial.exr"));
    }
}

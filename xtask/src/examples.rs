//! `cargo xtask examples`: renders the scenes that come with POV-Ray with both programs, with
//! POV-Ray's noise.

use crate::Outcome;
use crate::command::{Durer, Shot, root, scratch};
use crate::compare::{Difference, compare};
use crate::picture::Picture;
use crate::povray::{self, Povray};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The folder where Debian's `povray-examples` installs the scenes of objects.
const INSTALLED: &str = "/usr/share/doc/povray/examples/objects";

/// The subfolders that are used.
const FOLDERS: [&str; 3] = ["", "csg", "quartic"];

const SIZE: (u32, u32) = (320, 240);

/// The reasons why pictures differ, where they are known.
const NOTES: [(&str, &str); 4] = [
    (
        "bezier",
        "POV-Ray draws two triangles for each of the patch's parts, durer the patch: highlights and borders differ.",
    ),
    (
        "csg/hfclip",
        "The solid below a height field has no bottom, so clipping an endless cylinder with it keeps the lower part, in both programs. POV-Ray bounds such a cylinder by the height field's box and cuts it there; durer draws it over the disc that continues it.",
    ),
    (
        "quartic/hyptorus",
        "`bounded_by` promises that nothing lies outside of a ball, which this surface leaves. POV-Ray does not look outside; durer draws all of it.",
    ),
    (
        "fractal",
        "POV-Ray goes along the ray in steps of an estimated distance, durer brackets each crossing between certain signs ([language.md](language.md) states the solid). Pixels on the finest folds differ; the speckled pieces at the upper left of `fractal2` are lost in POV-Ray's picture.",
    ),
];

/// The result for a scene.
struct Row {
    name: String,
    /// The comparison, or why there is none.
    outcome: Outcome<Difference>,
}

/// Compares all scenes, or the named ones (`csg/intee1`), and writes docs/examples.md, with
/// pictures of those that differ.
pub(crate) fn run(names: &[String]) -> Outcome {
    let installed = Path::new(INSTALLED);
    if !installed.is_dir() {
        println!("examples: not run: {INSTALLED} is missing (on Debian `apt-get install povray-examples`)");
        return Ok(());
    }
    let Some(povray) = Povray::find() else {
        println!("examples: {}", povray::MISSING);
        return Ok(());
    };
    let scenes = scenes(installed, names)?;
    let durer = Durer::build()?.with_learned_noise(&scratch("examples")?.join("data"))?;
    let pictures = root().join("docs/examples");
    std::fs::create_dir_all(&pictures).map_err(|e| format!("{}: {e}", pictures.display()))?;
    let mut rows = Vec::new();
    for name in scenes {
        let row = measure(&durer, &povray, installed, name, &pictures)?;
        println!("{}", line(&row));
        rows.push(row);
    }
    if names.is_empty() {
        let path = root().join("docs/examples.md");
        std::fs::write(&path, document(&rows, &povray.version))
            .map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

/// The names of the scenes, relative to the folder of all objects.
fn scenes(installed: &Path, names: &[String]) -> Outcome<Vec<String>> {
    let mut found = Vec::new();
    for folder in FOLDERS {
        let path = installed.join(folder);
        let fail = |e: std::io::Error| format!("{}: {e}", path.display());
        for entry in std::fs::read_dir(&path).map_err(fail)? {
            let file = entry.map_err(fail)?.path();
            if file.extension().is_some_and(|e| e == "pov") {
                let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                found.push(if folder.is_empty() { stem } else { format!("{folder}/{stem}") });
            }
        }
    }
    found.sort();
    found.retain(|name| names.is_empty() || names.contains(name));
    Ok(found)
}

fn measure(durer: &Durer, povray: &Povray, from: &Path, name: String, pictures: &Path) -> Outcome<Row> {
    let scene = from.join(format!("{name}.pov"));
    let flat = name.replace('/', "_");
    let folder = scratch("examples")?;
    let [ours, theirs] = ["durer.png", "povray.png"].map(|end| folder.join(format!("{flat}.{end}")));
    let library = scene.parent().unwrap_or(from);
    if let Err(said) = render(durer, &scene, &ours) {
        return Ok(Row { name, outcome: Err(first_line(&said, &scene)) });
    }
    let (width, height) = SIZE;
    povray.render_with(&scene, &theirs, Shot { width, height, aa: "off", threads: None }, library)?;
    let (a, b) = (Picture::read(&ours)?, Picture::read(&theirs)?);
    let (difference, drawn) = compare(&a, &b)?;
    let shown = pictures.join(format!("{flat}.png"));
    if difference.passes() {
        // A picture of an earlier comparison is out of date.
        let _ = std::fs::remove_file(&shown);
    } else {
        beside(&[&a, &b, &drawn]).write(&shown)?;
    }
    Ok(Row { name, outcome: Ok(difference) })
}

/// Renders a scene. The error is the output of the command.
fn render(durer: &Durer, scene: &Path, picture: &Path) -> Outcome {
    let mut command = durer.command();
    command.arg("render").arg(scene).arg("-o").arg(picture);
    command.args(["--width", &SIZE.0.to_string(), "--height", &SIZE.1.to_string()]);
    let output = command
        .args(["--aa", "off", "--no-progress"])
        .output()
        .map_err(|e| format!("{}: {e}", durer.program().display()))?;
    if output.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&output.stderr).into_owned())
}

/// A message without the name of the folder.
fn first_line(said: &str, scene: &Path) -> String {
    let line = said.lines().find(|l| !l.contains(": warning: ")).unwrap_or("it failed and did not say why");
    let name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    line.replace(&scene.display().to_string(), &name)
}

/// Pictures of the same size, side by side.
fn beside(pictures: &[&Picture]) -> Picture {
    let (width, height) = (pictures[0].width, pictures[0].height);
    let mut pixels = Vec::new();
    for y in 0..height as usize {
        for picture in pictures {
            let start = y * width as usize;
            pixels.extend_from_slice(&picture.pixels[start..start + width as usize]);
        }
    }
    Picture { width: width * pictures.len() as u32, height, pixels }
}

/// The percentage, rounded down to hundredths, so that 100.00 means all pixels.
fn percent(difference: &Difference) -> f64 {
    (difference.agreeing * 1e4).floor() / 100.0
}

fn line(row: &Row) -> String {
    let told = match &row.outcome {
        Ok(difference) => format!("{:>8.2} %", percent(difference)),
        Err(reason) => reason.clone(),
    };
    format!("{:<24}{told}", row.name)
}

/// The text of docs/examples.md.
fn document(rows: &[Row], version: &str) -> String {
    let read = rows.iter().filter(|r| r.outcome.is_ok()).count();
    let agree = rows.iter().filter(|r| r.outcome.as_ref().is_ok_and(|d| d.passes())).count();
    let mut text = format!(
        "# POV-Ray's own scenes of objects\n\n\
         Written by `cargo xtask examples`. The scenes of `objects`, `objects/csg` and `objects/quartic` that come with POV-Ray (Debian's `povray-examples`), \
         at {}x{}, one ray through the centre of each pixel, beside POV-Ray {version} and with its noise (`durer learn-noise`). \
         A pixel agrees if no channel differs by more than 2/255.\n\n\
         {read} of {} scenes are read; in {agree} of them at least 99 % of the pixels agree. The others are shown: durer's picture, POV-Ray's, and where they differ.\n\n\
         | scene | agreement |\n|---|---:|\n",
        SIZE.0,
        SIZE.1,
        rows.len(),
    );
    for row in rows {
        let told = match &row.outcome {
            Ok(difference) => format!("{:.2} %", percent(difference)),
            Err(reason) => reason.clone(),
        };
        let _ = writeln!(text, "| {} | {told} |", row.name);
    }
    for row in rows.iter().filter(|r| r.outcome.as_ref().is_ok_and(|d| !d.passes())) {
        let path = PathBuf::from("examples").join(format!("{}.png", row.name.replace('/', "_")));
        let _ = write!(text, "\n## {}\n\n![durer, POV-Ray, difference]({})\n", row.name, path.display());
        if let Some((_, note)) = NOTES.iter().find(|(start, _)| row.name.starts_with(start)) {
            let _ = write!(text, "\n{note}\n");
        }
    }
    text
}

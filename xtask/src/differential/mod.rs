//! `cargo xtask differential`: renders random small scenes with durer and with POV-Ray, and reduces
//! the scenes whose pictures differ.

mod known;
mod looks;
mod random;
mod reduce;
mod solids;
mod tree;

use crate::Outcome;
use crate::command::{Durer, Shot};
use crate::compare::{REQUIRED, compare, differs_at, reproducible_differences};
use crate::picture::Picture;
use crate::povray::{self, Povray};

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use tree::Scene;

const SHOT: Shot<'static> = Shot { width: 96, height: 72, aa: "off", threads: Some(1) };

/// The number of pixels of a scene that POV-Ray renders alone, at most.
const ALONE: usize = 24;

/// The number of smaller scenes to try for a scene that differs.
const TRIES: usize = 400;

/// A kind of random scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Family {
    /// Solids and plain textures.
    Solids,
    /// Textures, patterns, cameras, lights, atmosphere and the words of the language.
    Looks,
}

impl Family {
    fn scene(self, seed: u64, number: u64) -> Scene {
        match self {
            Self::Solids => solids::scene(seed, number),
            Self::Looks => looks::scene(seed, number),
        }
    }

    /// The first part of the names of its files.
    fn prefix(self) -> &'static str {
        match self {
            Self::Solids => "seed",
            Self::Looks => "looks",
        }
    }
}

/// The request on the command line.
#[derive(Debug, PartialEq)]
struct Request {
    family: Family,
    /// The `durer` command to use in place of one built for release.
    durer: Option<PathBuf>,
    scenes: u64,
    seed: u64,
    first: u64,
    reduce: bool,
    /// The number of scenes at once.
    threads: Option<u64>,
}

/// The result of rendering a scene with both programs.
#[derive(Clone, Debug, PartialEq)]
enum Verdict {
    Agrees,
    /// The fraction of pixels that differ.
    Differs(f64),
    /// durer does not render it, for this reason.
    Refused(String),
    /// POV-Ray does not render it, for this reason.
    NoScene(String),
    /// The pixels that differ also change in POV-Ray's own picture when the whole scene is moved by
    /// a thousandth, or agree when it renders nothing but the pixel. Then they depend on rounding,
    /// or on the object that POV-Ray remembers from earlier shadow rays and tests twice.
    Noise,
    /// They agree without what these entries of docs/differences.md describe.
    Known(String),
}

impl Verdict {
    fn is_fault(&self) -> bool {
        matches!(self, Self::Differs(_) | Self::Refused(_))
    }

    /// Whether it is the same kind of failure.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Differs(_), Self::Differs(_)) => true,
            (Self::Refused(a), Self::Refused(b)) => a.get(..20) == b.get(..20),
            _ => false,
        }
    }
}

/// The two programs, and the folder for their pictures.
struct Bench<'a> {
    durer: &'a Durer,
    povray: &'a Povray,
    folder: PathBuf,
}

impl Bench<'_> {
    fn judge(&self, shown: &Scene, name: &str) -> Outcome<Verdict> {
        self.judge_reworded(shown, shown, name)
    }

    /// As `judge`; POV-Ray renders the scene in other words.
    fn judge_reworded(&self, shown: &Scene, reworded: &Scene, name: &str) -> Outcome<Verdict> {
        let file = |ending: &str| self.folder.join(format!("{name}{ending}"));
        let (ours, theirs) = (file("-durer.png"), file("-povray.png"));
        // Both programs read one file, which holds the scene for one of them after the other.
        let scene = file(".pov");
        write(&scene, &reworded.text())?;
        if let Err(why) = self.povray.render(&scene, &theirs, SHOT) {
            let said: Vec<&str> = why.lines().skip(1).flat_map(str::split_whitespace).collect();
            return Ok(Verdict::NoScene(said.join(" ")));
        }
        write(&scene, &shown.text())?;
        if let Err(why) = self.durer.render(&scene, &ours, SHOT) {
            let text = why.lines().nth(1).unwrap_or_default();
            let text = text.split_once(": ").map_or(text, |(_, text)| text);
            return Ok(Verdict::Refused(text.to_owned()));
        }
        let (difference, drawn) = compare(&Picture::read(&ours)?, &Picture::read(&theirs)?)?;
        if difference.passes() {
            return Ok(Verdict::Agrees);
        }
        let pictures = (Picture::read(&ours)?, Picture::read(&theirs)?);
        if self.reproducible(reworded, name, &pictures)? <= 1.0 - REQUIRED {
            return Ok(Verdict::Noise);
        }
        drawn.write(&file("-difference.png"))?;
        Ok(Verdict::Differs(1.0 - difference.agreeing))
    }

    /// The entries of docs/differences.md that explain why the pictures of a scene differ.
    fn known(&self, shown: &Scene, name: &str) -> Outcome<Option<String>> {
        let name = &format!("{name}-without");
        if let Some(entries) = self.known_reworded(shown, name)? {
            return Ok(Some(entries.join(" ")));
        }
        if let Some(entry) = self.known_alone(shown, name)? {
            return Ok(Some(entry.to_owned()));
        }
        // One entry is enough for most scenes, two for nearly all others.
        let without =
            |scene: &Scene| known::ALL.iter().filter_map(|k| Some((k.entry, (k.without)(scene)?))).collect();
        let singles: Vec<(&str, Scene)> = without(shown);
        let mut all: Vec<(Vec<&str>, Scene)> = singles.iter().map(|(e, s)| (vec![*e], s.clone())).collect();
        for (at, (first, scene)) in singles.iter().enumerate() {
            let pairs: Vec<(&str, Scene)> = without(scene);
            let later = pairs.into_iter().filter(|(e, _)| singles[at + 1..].iter().any(|(f, _)| f == e));
            all.extend(later.map(|(second, scene)| (vec![*first, second], scene)));
        }
        for (mut entries, scene) in all {
            if self.agree(&scene, &scene, name)? {
                return Ok(Some(entries.join(" ")));
            }
            if let Some(more) = self.known_reworded(&scene, name)? {
                entries.extend(more);
                return Ok(Some(entries.join(" ")));
            }
        }
        Ok(None)
    }

    /// The entries about surfaces in other words, if POV-Ray draws these as durer draws the scene:
    /// one that explains all, or else all of them.
    fn known_reworded(&self, shown: &Scene, name: &str) -> Outcome<Option<Vec<&'static str>>> {
        let Some((reworded, entries)) = known::all_reworded(shown) else { return Ok(None) };
        if !self.agree(shown, &reworded, name)? {
            return Ok(None);
        }
        let one = if entries.len() > 1 { self.known_alone(shown, name)? } else { None };
        Ok(Some(one.map_or(entries, |entry| vec![entry])))
    }

    /// The entry about surfaces in other words that explains all.
    fn known_alone(&self, shown: &Scene, name: &str) -> Outcome<Option<&'static str>> {
        for words in &known::REWORDED {
            if let Some(reworded) = (words.reworded)(shown)
                && self.agree(shown, &reworded, name)?
            {
                return Ok(Some(words.entry));
            }
        }
        Ok(None)
    }

    /// Whether durer's picture of a scene and POV-Ray's of the same one in other words agree.
    fn agree(&self, shown: &Scene, reworded: &Scene, name: &str) -> Outcome<bool> {
        let verdict = self.judge_reworded(shown, reworded, name)?;
        self.remove_all(name);
        Ok(matches!(verdict, Verdict::Agrees | Verdict::Noise))
    }

    /// Removes the scene and the pictures of this name.
    fn remove_all(&self, name: &str) {
        for ending in [".pov", "-durer.png", "-povray.png", "-difference.png"] {
            remove(&self.folder.join(format!("{name}{ending}")));
        }
    }

    /// An estimate of the fraction of pixels on which the pictures (ours, POV-Ray's) differ though
    /// POV-Ray's has the same colour if the whole scene is moved by a thousandth, and on which ours
    /// also differs from POV-Ray's when that renders nothing but the pixel.
    fn reproducible(&self, shown: &Scene, name: &str, (ours, theirs): &(Picture, Picture)) -> Outcome<f64> {
        let file = |ending: &str| self.folder.join(format!("{name}{ending}"));
        let (alone, moved, picture) = (file("-alone.pov"), file("-moved.pov"), file("-again.png"));
        write(&moved, &shown.moved().text())?;
        let mut again = Vec::new();
        if self.povray.render(&moved, &picture, SHOT).is_ok() {
            again.push(Picture::read(&picture)?);
        }
        remove(&moved);
        let disputed = reproducible_differences(ours, theirs, &again);
        let sample: Vec<usize> =
            disputed.iter().copied().step_by(disputed.len().div_ceil(ALONE).max(1)).collect();
        let mut still = 0;
        write(&alone, &shown.text())?;
        for &pixel in &sample {
            let place = (pixel as u32 % SHOT.width, pixel as u32 / SHOT.width);
            self.povray.render_pixel(&alone, &picture, SHOT, place)?;
            still += usize::from(differs_at(&Picture::read(&picture)?, ours, pixel));
        }
        remove(&alone);
        remove(&picture);
        let share = still as f64 / sample.len().max(1) as f64;
        Ok(share * disputed.len() as f64 / theirs.pixels.len() as f64)
    }

    /// The smallest scene found with the same kind of failure.
    fn reduced(&self, mut scene: Scene, verdict: &Verdict, name: &str) -> Outcome<Scene> {
        let mut tries = 0;
        'smaller: loop {
            for less in reduce::smaller(&scene) {
                tries += 1;
                if tries > TRIES {
                    break 'smaller;
                }
                if self.judge(&less, name)?.is_like(verdict) {
                    scene = less;
                    continue 'smaller;
                }
            }
            break;
        }
        // Renders the scene once more, since the pictures on disk may be those of a smaller one.
        self.judge(&scene, name)?;
        Ok(scene)
    }
}

/// Renders scenes and writes those that differ to target/differential.
pub(crate) fn run(words: &[String]) -> Outcome {
    let request = Request::read(words)?;
    let Some(povray) = Povray::find() else {
        println!("differential: {}", povray::MISSING);
        return Ok(());
    };
    let durer = request.durer.clone().map_or_else(Durer::build, |program| Ok(Durer::at(program)))?;
    let folder = crate::command::root().join("target/differential");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    // With POV-Ray's grains, patterns of noise can be compared.
    let durer = durer.with_learned_noise(&folder.join("data"))?;
    let bench = Bench { durer: &durer, povray: &povray, folder: folder.clone() };
    let next = AtomicU64::new(request.first);
    let (last, found) = (request.first + request.scenes, Mutex::new(Vec::new()));
    let failed = Mutex::new(None);
    let [skipped, noisy, known] = [const { AtomicU64::new(0) }; 3];
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= last || failed.lock().is_ok_and(|f| f.is_some()) {
                return;
            }
            match one(&bench, &request, number) {
                Ok(Verdict::NoScene(why)) => {
                    println!("scene {number}: no scene for POV-Ray: {why}");
                    skipped.fetch_add(1, Ordering::Relaxed);
                }
                Ok(Verdict::Noise) => {
                    noisy.fetch_add(1, Ordering::Relaxed);
                }
                Ok(Verdict::Known(entry)) => {
                    println!("scene {number}: {entry}");
                    known.fetch_add(1, Ordering::Relaxed);
                }
                Ok(verdict) if verdict.is_fault() => {
                    println!("scene {number}: {}", said(&verdict));
                    if let Ok(mut found) = found.lock() {
                        found.push(number);
                    }
                }
                Ok(_) => {}
                Err(why) => {
                    if let Ok(mut failed) = failed.lock() {
                        *failed = Some(why);
                    }
                }
            }
        }
    };
    let cores = || std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let threads = request.threads.unwrap_or_else(cores);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    if let Ok(Some(why)) = failed.into_inner() {
        return Err(why);
    }
    let mut found = found.into_inner().unwrap_or_default();
    found.sort_unstable();
    let skipped = skipped.into_inner();
    println!(
        "{} scenes of seed {}: {} differ; {} more differ as docs/differences.md says; {} are noise in POV-Ray{}",
        request.scenes - skipped,
        request.seed,
        found.len(),
        known.into_inner(),
        noisy.into_inner(),
        if skipped > 0 { format!("; {skipped} were no scenes for POV-Ray") } else { String::new() }
    );
    if found.is_empty() { Ok(()) } else { Err(format!("scenes that differ are in {}", folder.display())) }
}

/// Judges one scene. If the programs differ, its file and pictures are kept.
fn one(bench: &Bench<'_>, request: &Request, number: u64) -> Outcome<Verdict> {
    let scene = request.family.scene(request.seed, number);
    let name = format!("{}-{}-{number}", request.family.prefix(), request.seed);
    let mut verdict = bench.judge(&scene, &name)?;
    if let Verdict::Differs(_) = verdict
        && let Some(entry) = bench.known(&scene, &name)?
    {
        verdict = Verdict::Known(entry);
    }
    if verdict.is_fault() {
        if request.reduce {
            bench.reduced(scene, &verdict, &format!("{name}-small"))?;
        }
    } else {
        bench.remove_all(&name);
    }
    Ok(verdict)
}

fn write(path: &Path, text: &str) -> Outcome {
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Removes a picture; it may not exist.
fn remove(path: &Path) {
    let _ = std::fs::remove_file(path);
}

fn said(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Differs(share) => format!("{:.2} % of the pixels differ", 100.0 * share),
        Verdict::Refused(why) => format!("refused: {why}"),
        _ => String::new(),
    }
}

impl Request {
    fn read(words: &[String]) -> Outcome<Self> {
        let mut request = Self {
            family: Family::Solids,
            durer: None,
            scenes: 100,
            seed: 1,
            first: 0,
            reduce: true,
            threads: None,
        };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("differential: {word} needs a value"));
            if word == "--durer" {
                request.durer = Some(PathBuf::from(value()?));
                continue;
            }
            let mut number = || {
                let n = value()?;
                n.parse().map_err(|_| format!("differential: {n:?} is no number"))
            };
            match word.as_str() {
                "--scenes" => request.scenes = number()?,
                "--seed" => request.seed = number()?,
                "--threads" => request.threads = Some(number()?),
                "--first" => request.first = number()?,
                "--looks" => request.family = Family::Looks,
                "--whole" => request.reduce = false,
                _ => return Err(format!("differential: there is no option {word}")),
            }
        }
        Ok(request)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAMILIES: [Family; 2] = [Family::Solids, Family::Looks];

    #[test]
    fn a_number_gives_one_scene() {
        for family in FAMILIES {
            for number in 0..50 {
                let scene = family.scene(7, number);
                assert_eq!(scene.text(), family.scene(7, number).text());
                let text = scene.text();
                assert_eq!(text.matches('{').count(), text.matches('}').count(), "{text}");
            }
            assert_ne!(family.scene(7, 1).text(), family.scene(8, 1).text());
        }
    }

    #[test]
    fn every_smaller_scene_is_smaller() {
        for scene in FAMILIES.iter().flat_map(|family| (0..20).map(|number| family.scene(3, number))) {
            let all = reduce::smaller(&scene);
            assert!(!all.is_empty() && all.iter().all(|less| less.size() < scene.size()));
        }
    }
}

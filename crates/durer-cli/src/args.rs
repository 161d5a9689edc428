//! The arguments of the command line.

use crate::frames::{FrameArgs, PartArgs};
use clap::{Args, Parser, Subcommand, ValueEnum};
use durer::math::{Point3, Ray, Vec3};
use durer::render::{AntiAliasing, Region};
use std::path::PathBuf;

/// Where does this ray meet that surface? Renders scenes, and answers for rays.
#[derive(Debug, Parser)]
#[command(name = "durer", version, about)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a picture.
    Render(RenderArgs),
    /// Shoot an array of rays at a scene and write what they hit.
    Trace(TraceArgs),
    /// Tell in words what happens to one ray.
    Explain(ExplainArgs),
    /// Read a scene, build it, and report counts, bounds, memory and warnings.
    Check(CheckArgs),
    /// Show a scene in the browser: turn it, and click a pixel to see what its ray met.
    View(ViewArgs),
    /// Measure the noise of an installed POV-Ray, so that noisy textures have its grains.
    LearnNoise(LearnNoiseArgs),
}

#[derive(Debug, Args)]
pub(crate) struct LearnNoiseArgs {
    /// The program. [default: povray on the search path]
    #[arg(long, value_name = "PATH")]
    pub(crate) povray: Option<PathBuf>,
}

/// The noise of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum NoiseChoice {
    /// durer's own.
    Own,
    /// The one that `durer learn-noise` has measured.
    Learned,
}

/// How to read a scene.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArgs {
    /// The scene: a .pov file, or a mesh as .obj, .ply, .stl, .gltf or .glb, which is framed and
    /// lit by itself.
    pub(crate) scene: PathBuf,
    /// A folder to search for included files; may be given several times.
    #[arg(short = 'L', value_name = "DIR")]
    pub(crate) library: Vec<PathBuf>,
    /// The value of `clock`.
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_negative_numbers = true, value_parser = finite)]
    pub(crate) clock: f64,
    /// Declares a number before the scene is read; may be given several times.
    #[arg(long, value_name = "NAME=NUMBER", value_parser = declaration)]
    pub(crate) declare: Vec<(String, f64)>,
    /// Changes a limit of the reader, for example `macro-depth=2000`; may be given several times.
    #[arg(long, value_name = "NAME=N", value_parser = limit)]
    pub(crate) limit: Vec<(String, u64)>,
    /// Takes the polygons of an .obj file as a control mesh, and shows the limit surface of this
    /// subdivision.
    #[arg(long, value_name = "SCHEME")]
    pub(crate) subdivide: Option<Subdivide>,
    /// The noise of textures and functions. [default: the learned one where there is one]
    #[arg(long, value_enum, value_name = "WHICH")]
    pub(crate) noise: Option<NoiseChoice>,
    /// The folder of the files that the scene writes with `#fopen`. [default: the scene's own]
    #[arg(long, value_name = "DIR")]
    pub(crate) write_folder: Option<PathBuf>,
    /// Lets the names of these files lead out of their folder.
    #[arg(long)]
    pub(crate) allow_io: bool,
    /// Refuses a scene with features that would be left out of the picture: radiosity, photons,
    /// media, subsurface.
    #[arg(long)]
    pub(crate) strict: bool,
}

/// How polygons are refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Subdivide {
    /// Catmull and Clark's: any polygons.
    CatmullClark,
    /// Loop's: triangles.
    Loop,
}

/// The size of the picture.
#[derive(Debug, Args)]
pub(crate) struct SizeArgs {
    /// Width in pixels; if only one of width and height is given, the other follows by 4:3.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_535))]
    width: Option<u32>,
    /// Height in pixels.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_535))]
    height: Option<u32>,
}

impl SizeArgs {
    /// Width and height, 800x600 unless said otherwise.
    pub(crate) fn size(&self) -> (u32, u32) {
        let three_quarters = |a: u32, n: u32, d: u32| ((a * n + d / 2) / d).max(1);
        match (self.width, self.height) {
            (None, None) => (800, 600),
            (Some(w), None) => (w, three_quarters(w, 3, 4)),
            (None, Some(h)) => (three_quarters(h, 4, 3), h),
            (Some(w), Some(h)) => (w, h),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The picture; its ending says the format: .png, .exr or .ppm.
    /// [default: SCENE's name with .png, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
    /// How many threads work. [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Anti-aliasing: off, method1[,THRESHOLD[,DEPTH]], method2[,THRESHOLD[,DEPTH]], or NxN.
    #[arg(long, value_name = "HOW", default_value = "off", value_parser = anti_aliasing)]
    pub(crate) aa: AntiAliasing,
    /// Bits per channel of a PNG or PPM.
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = bits)]
    pub(crate) bits: u8,
    /// Renders only the pixels from X0,Y0 up to but not including X1,Y1, from the top left; the
    /// rest is transparent.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = region)]
    pub(crate) region: Option<Region>,
    #[command(flatten)]
    pub(crate) part: PartArgs,
    #[command(flatten)]
    pub(crate) frames: FrameArgs,
    /// Shows no progress bar.
    #[arg(long)]
    pub(crate) no_progress: bool,
    /// Reports on stderr how many rays were traced, and what they needed on patches, NURBS,
    /// parametric surfaces and the like.
    #[arg(long)]
    pub(crate) stats: bool,
}

/// What to ask of each ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Query {
    /// The first hit.
    Closest,
    /// Whether there is a hit.
    Any,
    /// Every crossing.
    All,
    /// The intervals inside the union of all solids.
    Spans,
    /// The intervals inside each object.
    SpansByObject,
}

#[derive(Debug, Args)]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The rays: an .npy file of f64, shape (n, 6) [origin, direction] or (n, 8)
    /// [origin, direction, t_min, t_max].
    #[arg(long, value_name = "RAYS.npy")]
    pub(crate) rays: PathBuf,
    /// What to ask of each ray.
    #[arg(long, value_enum, default_value_t = Query::Closest)]
    pub(crate) query: Query,
    /// How many threads work. [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// The answers, an .npz file.
    #[arg(short, long, value_name = "HITS.npz")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false, id = "which")]
pub(crate) struct WhichRay {
    /// The ray through the centre of this pixel.
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub(crate) pixel: Option<(u32, u32)>,
    /// The ray with this origin and direction.
    #[arg(long, value_name = "OX,OY,OZ,DX,DY,DZ", value_parser = ray, allow_hyphen_values = true)]
    pub(crate) ray: Option<Ray>,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) which: WhichRay,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) size: SizeArgs,
    /// How many threads render. [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Anti-aliasing of the finished picture, as for `render`; the page can change it.
    #[arg(long, value_name = "HOW", default_value = "off", value_parser = anti_aliasing)]
    pub(crate) aa: AntiAliasing,
    /// The port to listen on. [default: any free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) port: u16,
    /// Opens the page in the browser.
    #[arg(long)]
    pub(crate) open: bool,
}

/// What [`numbers`] of type `u32` must be.
const WHOLE: &str = "a whole number from 0 to 4294967295";

/// `N` numbers with commas between them, each of which must be `what`.
fn numbers<const N: usize, T: std::str::FromStr>(text: &str, what: &str) -> Result<[T; N], String> {
    let parsed: Vec<T> = text
        .split(',')
        .map(|word| word.trim().parse().map_err(|_| format!("'{word}' is not {what}")))
        .collect::<Result<_, _>>()?;
    let count = parsed.len();
    parsed.try_into().map_err(|_| format!("expected {N} numbers with commas between them, got {count}"))
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite())
        .ok_or_else(|| format!("'{text}' is not a finite number"))
}

fn declaration(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=NUMBER")?;
    let mut letters = name.chars();
    let starts_well = letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !starts_well || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!("'{name}' is not an identifier"));
    }
    Ok((name.to_owned(), finite(value)?))
}

fn limit(text: &str) -> Result<(String, u64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=N")?;
    let value = value.parse().map_err(|_| format!("'{value}' is not a whole number"))?;
    Ok((name.to_owned(), value))
}

fn bits(text: &str) -> Result<u8, String> {
    match text {
        "8" => Ok(8),
        "16" => Ok(16),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

fn pixel(text: &str) -> Result<(u32, u32), String> {
    numbers::<2, u32>(text, WHOLE).map(|[x, y]| (x, y))
}

fn region(text: &str) -> Result<Region, String> {
    let [x0, y0, x1, y1] = numbers::<4, u32>(text, WHOLE)?;
    if x0 >= x1 || y0 >= y1 {
        return Err("the region is empty: it needs X0 < X1 and Y0 < Y1".to_owned());
    }
    Ok(Region { x0, y0, x1, y1 })
}

fn ray(text: &str) -> Result<Ray, String> {
    let [ox, oy, oz, dx, dy, dz] = numbers::<6, f64>(text, "a number")?;
    let ray = Ray::new(Point3::new(ox, oy, oz), Vec3::new(dx, dy, dz));
    if ray.is_valid() {
        Ok(ray)
    } else {
        Err("a ray needs finite numbers and a direction that is not zero".to_owned())
    }
}

fn anti_aliasing(text: &str) -> Result<AntiAliasing, String> {
    let usage = || {
        format!("'{text}': expected off, method1[,THRESHOLD[,DEPTH]], method2[,THRESHOLD[,DEPTH]], or NxN")
    };
    if text == "off" {
        return Ok(AntiAliasing::Off);
    }
    if let Some((a, b)) = text.split_once('x') {
        let n = a.parse().ok().filter(|n| (1..=64).contains(n)).ok_or_else(usage)?;
        return if a == b { Ok(AntiAliasing::Grid(n)) } else { Err(usage()) };
    }
    let mut words = text.split(',');
    let method = words.next().unwrap_or_default();
    let threshold = words
        .next()
        .map_or(Ok(AntiAliasing::THRESHOLD), |w| finite(w).ok().filter(|t| *t >= 0.0).ok_or_else(usage))?;
    let depth = words.next().map_or(Ok(AntiAliasing::DEPTH), |w| {
        w.parse().ok().filter(|d| (1..=AntiAliasing::MAX_DEPTH).contains(d)).ok_or_else(usage)
    })?;
    match (method, words.next()) {
        ("method1", None) => Ok(AntiAliasing::Method1 { threshold, depth }),
        ("method2", None) => Ok(AntiAliasing::Method2 { threshold, depth }),
        _ => Err(usage()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn one_side_of_the_picture_gives_the_other_by_four_to_three() {
        let size = |width, height| SizeArgs { width, height }.size();
        assert_eq!(size(None, None), (800, 600));
        assert_eq!(size(Some(160), None), (160, 120));
        assert_eq!(size(None, Some(240)), (320, 240));
        assert_eq!(size(Some(1), None), (1, 1));
        assert_eq!(size(Some(7), Some(9)), (7, 9));
    }

    #[test]
    fn anti_aliasing_is_read_to_the_letter() {
        assert_eq!(anti_aliasing("off"), Ok(AntiAliasing::Off));
        assert_eq!(anti_aliasing("3x3"), Ok(AntiAliasing::Grid(3)));
        assert_eq!(anti_aliasing("method1"), Ok(AntiAliasing::Method1 { threshold: 0.3, depth: 3 }));
        assert_eq!(anti_aliasing("method2,0.1,2"), Ok(AntiAliasing::Method2 { threshold: 0.1, depth: 2 }));
        for bad in ["", "2x3", "0x0", "method3", "method1,x", "method1,0.1,0", "method1,0.1,2,5", "on"] {
            assert!(anti_aliasing(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn rays_regions_and_declarations_refuse_nonsense() {
        assert!(ray("0,0,0,0,0,0").is_err());
        assert!(ray("0,0,0,0,0,inf").is_err());
        assert!(ray("0,0,-5,0,0,1").is_ok());
        assert!(region("4,4,4,8").is_err());
        assert!(declaration("9a=1").is_err());
        assert!(declaration("a=b").is_err());
        assert_eq!(declaration("Turn=0.5"), Ok(("Turn".to_owned(), 0.5)));
    }
}

//! Traces the rays of the comparison with other ray kernels. The output has the format of the other
//! programs.
//!
//! ```text
//! cargo run --release -p durer-bvh --example peer_rays -- MESH.tri --load DIR [--threads N]
//!     [--repeats N] [--builds N] [--modes single,batch] [--quality fast|good|best] [--json]
//! ```
//!
//! `DIR` holds `primary ao diffuse random` as `.rays` and the reference answers as `.hits`. The
//! answers here are those of exact arithmetic on the coordinates of the file. Without `--threads`
//! it runs with one thread, then with all. `--json` leaves out the table. Batch mode traces several
//! rays at the same time; the answers are those of single mode.

mod files;
mod memory;
mod report;
mod world;

use durer_math::Isa;
use files::{FileError, Hits, PeerRay};
use report::{Rate, Report};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use world::World;

const WORKLOADS: [&str; 4] = ["primary", "ao", "diffuse", "random"];
/// How many rays a thread takes at once.
const BLOCK: usize = 4096;

struct Options {
    mesh: PathBuf,
    load: PathBuf,
    threads: Option<usize>,
    repeats: usize,
    builds: usize,
    modes: String,
    quality: String,
    json: bool,
}

fn options() -> Result<Options, String> {
    let usage = "usage: peer_rays MESH.tri --load DIR [--threads N] [--repeats N] [--builds N] [--modes single,batch] [--quality fast|good|best] [--json]";
    let mut args = std::env::args().skip(1);
    let (mut mesh, mut load) = (None, None);
    let (mut threads, mut repeats, mut builds, mut json) = (None, 5, 3, false);
    let (mut modes, mut quality) = ("single,batch".to_owned(), "good".to_owned());
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{arg} wants a value\n{usage}"));
        let number = |text: String| match text.parse::<usize>() {
            Ok(n) if n > 0 => Ok(n),
            _ => Err(format!("{text:?} is no number above 0\n{usage}")),
        };
        match arg.as_str() {
            "--load" => load = Some(PathBuf::from(value()?)),
            "--threads" => threads = Some(number(value()?)?),
            "--repeats" => repeats = number(value()?)?,
            "--builds" => builds = number(value()?)?,
            "--modes" => modes = value()?,
            "--quality" => quality = value()?,
            "--json" => json = true,
            _ if arg.starts_with('-') => return Err(format!("unknown option {arg}\n{usage}")),
            _ => mesh = Some(PathBuf::from(arg)),
        }
    }
    let (Some(mesh), Some(load)) = (mesh, load) else { return Err(usage.to_owned()) };
    Ok(Options { mesh, load, threads, repeats, builds, modes, quality, json })
}

/// Traces some rays and stores `t` and the triangle of each. For any-hit queries `t` is 0 or
/// infinite.
type Tracer<'a> = dyn Fn(&[PeerRay], &mut [f32], &mut [u32]) + Sync + 'a;

/// Traces all rays `repeats` times, after one run to warm up.
fn time_trace(rays: &[PeerRay], threads: usize, repeats: usize, trace: &Tracer<'_>) -> (Rate, Hits) {
    let mut hits = Hits { t: vec![0.0; rays.len()], triangle: vec![0; rays.len()] };
    let mut rate = report::Samples::default();
    for round in 0..=repeats {
        let blocks: Vec<_> = rays
            .chunks(BLOCK)
            .zip(hits.t.chunks_mut(BLOCK).zip(hits.triangle.chunks_mut(BLOCK)))
            .map(|(r, (t, p))| std::sync::Mutex::new((r, t, p)))
            .collect();
        let next = AtomicUsize::new(0);
        let start = Instant::now();
        let work = || {
            let before = report::thread_cpu_ns();
            while let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                let mut block = block.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                let (r, t, p) = &mut *block;
                trace(r, t, p);
            }
            report::thread_cpu_ns() - before
        };
        let cpu: f64 = if threads == 1 {
            work()
        } else {
            std::thread::scope(|scope| {
                let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
                workers.into_iter().map(|w| w.join().unwrap_or(f64::NAN)).sum()
            })
        };
        if round > 0 {
            rate.add(rays.len(), start.elapsed().as_secs_f64(), cpu);
        }
    }
    (rate.rate(), hits)
}

fn run() -> Result<(), String> {
    let options = options()?;
    let text = |e: FileError| e.to_string();
    let mesh = files::mesh(&options.mesh).map_err(text)?;
    let settings = world::quality(&options.quality)
        .ok_or_else(|| format!("the quality is fast, good or best, got {:?}", options.quality))?;
    let isa = Isa::detect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads =
        options.threads.map_or_else(|| if cores > 1 { vec![1, cores] } else { vec![1] }, |n| vec![n]);
    let name = options.mesh.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let engine = format!("durer {} {} {}", env!("CARGO_PKG_VERSION"), options.quality, isa.path().name());
    let mut report = Report::new(engine, name, mesh.faces.len(), !options.json);

    let exact = World::exact(&mesh)?;
    // Only the first build: later ones reuse freed memory.
    let (world, most) = memory::most_held(|| World::build(&mesh, exact, &settings));
    let mut exact = world.into_exact();
    for &n in &threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().map_err(|e| e.to_string())?;
        let mut times = Vec::new();
        for _ in 0..options.builds {
            let start = Instant::now();
            let world = pool.install(|| World::build(&mesh, exact, &settings));
            times.push(start.elapsed().as_secs_f64() * 1e3);
            exact = world.into_exact();
        }
        report.build(n, times);
    }
    let world = World::build(&mesh, exact, &settings);
    report.memory(world.bytes(), most);

    for mode in ["single", "batch"].into_iter().filter(|&mode| options.modes.split(',').any(|m| m == mode)) {
        for work in WORKLOADS {
            let file = |ending: &str| options.load.join(format!("{work}.{ending}"));
            let rays = files::rays(&file("rays")).map_err(text)?;
            let reference =
                if file("hits").exists() { Some(files::hits(&file("hits")).map_err(text)?) } else { None };
            let any = work == "ao";
            let trace: &Tracer<'_> = match (mode, any) {
                ("single", false) => &|r, t, p| world.closest(isa, r, t, p),
                ("single", true) => &|r, t, p| world.any(isa, r, t, p),
                (_, false) => &|r, t, p| world.closest_batch(isa, r, t, p),
                (_, true) => &|r, t, p| world.any_batch(isa, r, t, p),
            };
            let mut hits = Hits::default();
            for &n in &threads {
                let (rate, found) = time_trace(&rays, n, options.repeats, trace);
                report.row(mode, work, n, &rate);
                hits = found;
            }
            report.compare(work, &hits, reference.as_ref(), any);
        }
    }
    report.json();
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

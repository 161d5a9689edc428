//! A molecule of a million atoms: build time, memory, and rays per second.
//!
//! ```text
//! cargo run --release -p durer-geometry --example molecule [-- ATOMS]
//! ```

use durer_geometry::Geometry;
use durer_math::{Isa, Point3, Ray, Vec3};
use durer_surfaces::Sphere;
use std::time::Instant;

/// A pseudorandom number: the n-th output of G. L. Steele, D. Lea, C. H. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA (2014).
fn hash(n: u64) -> u64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// In `[0, 1)`.
fn unit(n: u64) -> f64 {
    (hash(n) >> 11) as f64 / (1_u64 << 53) as f64
}

fn point(n: u64, side: f64) -> Point3 {
    Point3::new(unit(3 * n) * side, unit(3 * n + 1) * side, unit(3 * n + 2) * side)
}

/// Atoms at the density of a protein (about one per 20 cubic angstrom, hydrogen not counted), with
/// van der Waals radii.
fn molecule(atoms: u64) -> (Vec<Sphere>, f64) {
    let side = (20.0 * atoms as f64).cbrt_by_newton();
    let radius = |n: u64| [1.7, 1.7, 1.7, 1.55, 1.52, 1.8][(hash(!n) % 6) as usize];
    let sphere = |n: u64| Sphere::new(point(n, side), radius(n)).expect("finite, and radii above zero");
    ((0..atoms).map(sphere).collect(), side)
}

trait CubeRoot {
    fn cbrt_by_newton(self) -> f64;
}

impl CubeRoot for f64 {
    fn cbrt_by_newton(self) -> f64 {
        (0..200).fold(1.0_f64.max(self / 1e4), |x, _| (2.0 * x + self / (x * x)) / 3.0)
    }
}

/// Camera rays, a frame of 1024 x 1024.
fn primary(side: f64) -> Vec<Ray> {
    let eye = Point3::new(0.5 * side, 0.6 * side, -1.4 * side);
    let ray = |i: u32| {
        let (x, y) = (f64::from(i % 1024) / 512.0 - 1.0, f64::from(i / 1024) / 512.0 - 1.0);
        Ray::new(eye, Vec3::new(0.42 * x, 0.42 * y - 0.05, 1.0))
    };
    (0..1 << 20).map(ray).collect()
}

/// Rays from random points to random points of the molecule.
fn random(side: f64) -> Vec<Ray> {
    let ray = |i: u64| {
        let (a, b) = (point(i + (1 << 40), side), point(i + (2 << 40), side));
        Ray::new(a, b - a)
    };
    (0..1 << 20).map(ray).collect()
}

/// The processor time of all this process's threads so far, in seconds, if the system reports it;
/// else the elapsed time.
fn processor_seconds(since: Instant) -> f64 {
    let ticks = || {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        // After the name in parentheses; user and system time are fields 14 and 15, in hundredths
        // of a second.
        let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(11);
        Some(fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?)
    };
    ticks().map_or_else(|| since.elapsed().as_secs_f64(), |t| t / 100.0)
}

/// The peak memory of this process, in bytes, if the system reports it.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}

fn main() {
    let atoms = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(1_000_000);
    println!("{atoms} spheres, instruction set {:?}", Isa::detect().path());
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| measure(atoms, threads));
    }
    if let Some(peak) = peak() {
        println!("peak memory of the process, rays and hits included: {:.0} MB", peak / 1e6);
    }
}

fn measure(atoms: u64, threads: usize) {
    let (spheres, side) = molecule(atoms);
    let start = Instant::now();
    let before = processor_seconds(start);
    let mut builder = Geometry::builder();
    for sphere in spheres {
        builder.add(sphere);
    }
    let geometry = builder.build().expect("a million fit");
    let (seconds, worked) = (start.elapsed().as_secs_f64(), processor_seconds(start) - before);
    let stats = geometry.stats();
    let per = stats.bytes as f64 / atoms as f64;
    println!(
        "{threads} thread(s): built in {seconds:.2} s ({worked:.2} s of processor time), {per:.1} bytes per sphere"
    );
    if threads == 1 {
        let peak = peak().map_or(f64::NAN, |p| p / atoms as f64);
        println!("    peak while building (the caller's list included): {peak:.0} bytes per sphere");
        println!("    {:?}", stats.tree);
    }
    for (name, rays) in [("primary", primary(side)), ("random", random(side))] {
        let rate = |f: &dyn Fn() -> usize| {
            let (start, repeats) = (Instant::now(), 3);
            let before = processor_seconds(start);
            let hits = (0..repeats).map(|_| f()).last().unwrap_or(0);
            let count = f64::from(repeats) * rays.len() as f64 / 1e6;
            let (seconds, worked) = (start.elapsed().as_secs_f64(), processor_seconds(start) - before);
            format!(
                "{:.3} Mrays/s, {:.3} per second of processor time ({hits} hits)",
                count / seconds,
                count / worked
            )
        };
        let closest = rate(&|| geometry.batch(&rays).closest().iter().flatten().count());
        let any = rate(&|| geometry.batch(&rays).any().iter().filter(|hit| **hit).count());
        println!("    {name:8} closest: {closest}\n             any:     {any}");
    }
}

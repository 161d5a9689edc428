//! Nanoseconds per ray and torus, in one thread: rays that miss its ball, that miss only the torus,
//! that hit; with brackets of preview width and with narrow brackets.
//!
//! `cargo run --release -p durer-surfaces --example torus_speed`

use durer_math::{Isa, Point3, Ray, Vec3};
use durer_surfaces::algebraic::{coefficient_count, place_of};
use durer_surfaces::{AlgebraicSurface, Axis, Closest, LocalRay, Surface, Torus};
use std::hint::black_box;
use std::sync::LazyLock;
use std::time::Instant;

/// A number in [-1, 1) from a counter.
fn signed(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 * f64::EPSILON - 1.0
}

/// Seconds of CPU time of this thread on Linux (other programs do not count), else of the clock.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let ran = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = ran.as_deref().and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    // Some Linux kernels do not count CPU time.
    let nanoseconds = nanoseconds.filter(|ns| *ns > 0.0);
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// The time per ray, the best of some rounds, and how many rays hit.
fn measure<S: Surface>(name: &str, surface: &S, rays: &[Ray], rough: bool) {
    let isa = Isa::detect();
    let (mut best, mut hits) = (f64::INFINITY, 0);
    for _ in 0..41 {
        hits = 0;
        let start = seconds();
        for ray in rays {
            let local = if rough { LocalRay::new(ray).roughly() } else { LocalRay::new(ray) };
            let mut closest = Closest::default();
            isa.run(
                #[inline(always)]
                || surface.roots(&local, &mut closest),
            );
            hits += usize::from(black_box(closest).root.is_some());
        }
        best = best.min((seconds() - start) / rays.len() as f64);
    }
    println!("{name:<34} {:8.1} ns   {hits} of {} rays hit", best * 1e9, rays.len());
}

fn main() {
    let torus = Torus::new(Point3::ORIGIN, Axis::Y, 1.0, 0.3).unwrap();
    let aimed = |at: f64| -> Vec<Ray> {
        (0..4096)
            .map(|i| {
                let v = |k: u64| Vec3::new(signed(6 * i + k), signed(6 * i + k + 1), signed(6 * i + k + 2));
                let from = v(0);
                let from = (from * (6.0 / from.length())).to_point();
                Ray::new(from, (v(3) * at).to_point() - from)
            })
            .collect()
    };
    let near = aimed(1.0);
    let hit_by = |want: bool| -> Vec<Ray> {
        let hits = |ray: &&Ray| {
            let mut closest = Closest::default();
            torus.roots(&LocalRay::new(ray), &mut closest);
            closest.root.is_some() == want
        };
        near.iter().filter(hits).copied().collect()
    };
    measure("torus, far away", &torus, &aimed(8.0), true);
    measure("torus, missed within its ball", &torus, &hit_by(false), true);
    measure("torus, hit, to see by", &torus, &hit_by(true), true);
    measure("torus, hit, to measure by", &torus, &hit_by(true), false);
    let mut list = vec![0.0; coefficient_count(4)];
    let (big, small) = (1.0, 0.09);
    for (n, c) in [
        ([4, 0, 0], 1.0),
        ([0, 4, 0], 1.0),
        ([0, 0, 4], 1.0),
        ([2, 2, 0], 2.0),
        ([2, 0, 2], 2.0),
        ([0, 2, 2], 2.0),
        ([2, 0, 0], -2.0 * (big + small)),
        ([0, 2, 0], 2.0 * (big - small)),
        ([0, 0, 2], -2.0 * (big + small)),
        ([0, 0, 0], (big - small) * (big - small)),
    ] {
        list[place_of(4, n)] = c;
    }
    let quartic = AlgebraicSurface::new(4, &list).unwrap();
    measure("torus as a quartic, missed", &quartic, &hit_by(false), true);
    measure("torus as a quartic, hit", &quartic, &hit_by(true), true);
}

//! Nanoseconds per ray and sphere, in one thread: misses, hits, and how often f64 does not suffice.
//!
//! `cargo run --release -p durer-surfaces --example sphere_speed`

use durer_math::{Isa, Point3, Ray, Vec3};
use durer_surfaces::{Any, CappedCylinder, Closest, LocalRay, Placed, Sphere, Surface};
use std::hint::black_box;
use std::sync::LazyLock;
use std::time::Instant;

/// A number in [0, 1) from a counter.
fn unit(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 * (f64::EPSILON / 2.0)
}

/// Seconds of CPU time of this thread on Linux (other programs do not count), else of the clock.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let ran = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = ran.as_deref().and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Tests each ray against each surface, `rounds` times; prints the time per test.
fn measure<S: Surface>(name: &str, surfaces: &[S], rays: &[Ray], rounds: u32) {
    // Arguments on the command line select the measurements.
    if std::env::args().len() > 1 && !std::env::args().any(|word| name.contains(&word)) {
        return;
    }
    let isa = Isa::detect();
    let mut best = f64::INFINITY;
    let mut hits = 0;
    for _ in 0..rounds {
        hits = 0;
        let start = seconds();
        for ray in rays {
            let local = LocalRay::new(ray);
            let mut closest = Closest::default();
            isa.run(
                #[inline(always)]
                || {
                    for s in surfaces {
                        s.roots(&local, &mut closest);
                    }
                },
            );
            hits += usize::from(black_box(closest).root.is_some());
        }
        best = best.min((seconds() - start) / (rays.len() * surfaces.len()) as f64);
    }
    println!("{name:<28} {:7.2} ns   {hits} of {} rays hit", best * 1e9, rays.len());
}

fn main() {
    let n = 4096;
    let place = |i: u64, k: f64| Point3::new(unit(3 * i) * k, unit(3 * i + 1) * k, unit(3 * i + 2) * k);
    let few: Vec<Sphere> = (0..n).map(|i| Sphere::new(place(i, 100.0), 0.1).unwrap()).collect();
    let one: Vec<Sphere> =
        (0..n).map(|_| Sphere::new(Point3::new(50.0, 50.0, 50.0), 30.0).unwrap()).collect();
    let rays: Vec<Ray> = (0..400)
        .map(|i| {
            let o = Point3::new(50.0, 50.0, -200.0);
            let target = place(n + i, 20.0) + Vec3::new(40.0, 40.0, 40.0);
            Ray::new(o, target - o)
        })
        .collect();
    measure("spheres, nearly all missed", &few, &rays, 5);
    // All spheres are the same, so that each test computes the crossing again (the closest one was
    // found by the first).
    measure("spheres, all hit", &one, &rays, 5);
    let rods: Vec<CappedCylinder> = (0..n)
        .map(|i| {
            let p = place(i, 100.0);
            CappedCylinder::new(p, p + Vec3::new(0.3, 0.2, 0.1), 0.05).unwrap()
        })
        .collect();
    measure("rods, nearly all missed", &rods, &rays, 5);
    let rod =
        CappedCylinder::new(Point3::new(50.0, 50.0, 20.0), Point3::new(50.0, 55.0, 90.0), 25.0).unwrap();
    measure("rods, all hit", &vec![rod; 512], &rays, 5);
    let map = durer_math::Affine::scaling(30.0, 25.0, 20.0)
        .and_then(|m| m.then(&durer_math::Affine::translation(Vec3::new(50.0, 50.0, 50.0))?))
        .unwrap();
    let placed = Placed::new(Sphere::new(Point3::ORIGIN, 1.0).unwrap(), map);
    measure("placed spheres, all hit", &vec![placed; 512], &rays, 5);
    let mut any = Any::default();
    one[0].roots(&LocalRay::new(&rays[0]), &mut any);
    assert!(any.hit);
}

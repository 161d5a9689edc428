//! How long a subdivision surface takes to build, and 1e6 rays at it one by one, in processor time.
//!
//! ```text
//! cargo run --release -p durer --example subdivision_speed -- MESH.obj RAYS
//! ```
//!
//! `RAYS` holds rows of seven numbers of 8 bytes, as little-endian f64: origin, direction, and one that
//! is not read. Each hit of the first rays then starts diffuse ones, as many as there were rays.

use durer::geometry::Geometry;
use durer::math::elementary::sin_cos;
use durer::math::{Ray, Vec3};
use durer::surfaces::{Steps, SubdivisionSurface};
use std::error::Error;

/// Numbers that look random: the n-th output of G. L. Steele, D. Lea, C. H. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA (2014), in `[0, 1)`.
fn unit(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// The processor time of this thread in nanoseconds, where the system tells.
fn now() -> Result<f64, Box<dyn Error>> {
    let text = std::fs::read_to_string("/proc/self/schedstat")?;
    Ok(text.split_whitespace().next().ok_or("no time")?.parse()?)
}

/// A direction about a normal, with the cosine of its angle as density.
fn diffuse(normal: Vec3, n: u64) -> Vec3 {
    let (sin, cos) = sin_cos(std::f64::consts::TAU * unit(2 * n));
    let r = unit(2 * n + 1).sqrt();
    let aside = if normal.x.abs() < 0.5 { Vec3::X } else { Vec3::Y };
    let u = normal.cross(aside);
    let u = u * (1.0 / u.length());
    u * (r * cos) + normal.cross(u) * (r * sin) + normal * (1.0 - r * r).max(0.0).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(mesh), Some(rays)) = (arguments.next(), arguments.next()) else {
        return Err("subdivision_speed MESH.obj RAYS".into());
    };
    let (data, _) = durer::mesh::control_mesh(&std::fs::read(mesh)?)?;
    let bytes = std::fs::read(rays)?;
    let number = |b: &[u8]| b.try_into().map_or(f64::NAN, f64::from_le_bytes);
    let rays: Vec<Ray> = bytes
        .chunks_exact(56)
        .map(|row| {
            let at = |k: usize| number(&row[8 * k..8 * k + 8]);
            Ray::new(Vec3::new(at(0), at(1), at(2)).to_point(), Vec3::new(at(3), at(4), at(5)))
        })
        .collect();
    let start = now()?;
    let mut builder = Geometry::builder();
    builder.add(SubdivisionSurface::new(data)?);
    let world = builder.build()?;
    let built = now()?;
    let mut hits = Vec::new();
    for ray in &rays {
        if let Some(hit) = world.closest(ray) {
            hits.push((*ray, hit));
        }
    }
    let met = now()?;
    let first = Steps::take();
    let starts = hits.iter().map(|(ray, hit)| {
        let point = world.resolve(ray, hit);
        let n = point.ng.to_vec();
        (point, if n.dot(ray.direction) > 0.0 { -n } else { n })
    });
    let starts: Vec<_> = starts.collect();
    let away: Vec<Ray> = (0..rays.len() as u64)
        .filter_map(|k| starts.get(k as usize % starts.len().max(1)).map(|(p, n)| p.spawn(diffuse(*n, k))))
        .collect();
    let drawn = now()?;
    let again = away.iter().filter(|ray| world.closest(ray).is_some()).count();
    let end = now()?;
    let second = Steps::take();
    let count = rays.len() as f64;
    println!(
        "{} hits; build {:.1} ms, primary {:.0} ns, resolve {:.0} ns a hit, diffuse {:.0} ns ({again} hits); {} bytes told",
        hits.len(),
        (built - start) * 1e-6,
        (met - built) / count,
        (drawn - met) / hits.len().max(1) as f64,
        (end - drawn) / count,
        world.stats().bytes
    );
    for (name, steps) in [("primary", first), ("diffuse", second)] {
        println!(
            "{name}: {:.2} evaluations and {:.3} subdivisions per ray",
            steps.evaluations as f64 / count,
            steps.cuts as f64 / count
        );
    }
    let status = std::fs::read_to_string("/proc/self/status")?;
    println!("{}", status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or(""));
    Ok(())
}

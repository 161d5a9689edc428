//! The time of a ray that meets a formula:
//! `cargo run --release -p durer-surfaces --example isosurface_speed`.

use durer_formula::Function;
use durer_formula::{Builder, FormulaError, Op};
use durer_math::{Point3, Ray, RaySide, Vec3};
use durer_surfaces::{Any, AxisBox, Closest, Container, Isosurface, LocalRay, Need, Surface, superellipsoid};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let block = AxisBox::new(Point3::new(-1.1, -1.1, -1.1), Point3::new(1.1, 1.1, 1.1))?;
    for (name, formula) in [("sphere", bumpy(0.0)?), ("bumpy sphere", bumpy(0.03)?)] {
        timed(name, || Ok(Isosurface::new(&formula, 0.0, Container::Box(block))?))?;
    }
    for (e, n) in [(1.0, 1.0), (0.25, 0.25), (0.1, 1.0), (1.5, 0.7), (2.0, 2.0), (3.2, 2.5)] {
        timed(&format!("superellipsoid <{e}, {n}>"), || Ok(superellipsoid(e, n)?))?;
    }
    Ok(())
}

/// Times the rays of a picture: all of them, and for those that hit the surface the points and the
/// rays that leave them.
fn timed(
    name: &str,
    make: impl Fn() -> Result<Isosurface, Box<dyn std::error::Error>>,
) -> Result<(), Box<dyn std::error::Error>> {
    let started = Instant::now();
    let surface = make()?;
    let built = started.elapsed();
    let (cells, steps, whole) = surface.cells();
    let mut rays: Vec<Ray> = Vec::new();
    for i in 0..200 {
        for j in 0..200 {
            let (u, v) = (f64::from(i) / 100.0 - 1.0, f64::from(j) / 100.0 - 1.0);
            rays.push(Ray::new(Point3::new(0.3, 0.2, -4.0), Vec3::new(u * 0.4, v * 0.4, 1.0)));
        }
    }
    let started = Instant::now();
    let mut met = Vec::new();
    for ray in &rays {
        let mut closest = Closest::default();
        surface.roots(&LocalRay::new(ray).roughly(), &mut closest);
        met.extend(closest.root.map(|root| (ray, root)));
    }
    let ns = |started: Instant, n: usize| started.elapsed().as_nanos() as f64 / n.max(1) as f64;
    let roots = ns(started, rays.len());
    let started = Instant::now();
    let points: Vec<_> = met
        .iter()
        .map(|(ray, root)| surface.resolve(&LocalRay::new(ray).roughly(), root, Need::POINT))
        .collect();
    let resolved = ns(started, points.len());
    let shadows: Vec<Ray> = points.iter().map(|point| point.spawn_to(Point3::new(5.0, 9.0, -7.0))).collect();
    let started = Instant::now();
    let mut blocked = 0;
    for (ray, point) in shadows.iter().zip(&points) {
        let mut any = Any::default();
        let side = if point.ng.to_vec().dot(ray.direction) < 0.0 { RaySide::Back } else { RaySide::Front };
        surface.roots(&LocalRay::new(ray).roughly().from_side(Some(side)), &mut any);
        blocked += usize::from(any.hit);
    }
    let shadow = ns(started, shadows.len());
    println!(
        "{name}: {whole} steps; {cells} cells of {steps:.1} steps in {built:.1?}; {} of {} rays meet it, {roots:.0} ns a ray, {resolved:.0} a point, {shadow:.0} a \
         shadow ray ({blocked} blocked)",
        points.len(),
        rays.len(),
    );
    Ok(())
}

/// `sqrt(x^2 + y^2 + z^2) - 0.9 + a sin(20 x) sin(20 y) sin(20 z)`.
fn bumpy(a: f64) -> Result<durer_formula::Formula, FormulaError> {
    let mut b = Builder::new();
    let (mut sum, mut product) = (b.constant(0.0)?, b.constant(a)?);
    for i in 0..3 {
        let x = b.input(i)?;
        let square = b.push(Op::Sqr(x))?;
        sum = b.push(Op::Add(sum, square))?;
        let twenty = b.constant(20.0)?;
        let x = b.push(Op::Mul(x, twenty))?;
        let wave = b.push(Op::Function(Function::Sin, x))?;
        product = b.push(Op::Mul(product, wave))?;
    }
    let root = b.push(Op::Sqrt(sum))?;
    let r = b.constant(0.9)?;
    let f = b.push(Op::Sub(root, r))?;
    let f = if a == 0.0 { f } else { b.push(Op::Add(f, product))? };
    Ok(b.finish(f, 3))
}

//! What a ray costs that meets a formula: `cargo run --release -p durer-surfaces --example isosurface_speed`.

use durer_math::{Function, Point3, Ray, Vec3};
use durer_surfaces::tape::{Builder, FormulaError, Op};
use durer_surfaces::{AxisBox, Closest, Container, Isosurface, LocalRay, Need, Surface};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let block = AxisBox::new(Point3::new(-1.1, -1.1, -1.1), Point3::new(1.1, 1.1, 1.1))?;
    for (name, formula) in [("sphere", bumpy(0.0)?), ("bumpy sphere", bumpy(0.03)?)] {
        let started = Instant::now();
        let surface = Isosurface::new(&formula, 0.0, Container::Box(block))?;
        let built = started.elapsed();
        let (cells, steps, whole) = surface.cells();
        let (mut met, mut rays) = (0, 0);
        let started = Instant::now();
        for i in 0..400 {
            for j in 0..400 {
                let (u, v) = (f64::from(i) / 200.0 - 1.0, f64::from(j) / 200.0 - 1.0);
                let ray = Ray::new(Point3::new(0.3, 0.2, -4.0), Vec3::new(u * 0.4, v * 0.4, 1.0));
                let local = LocalRay::new(&ray).roughly();
                let mut closest = Closest::default();
                surface.roots(&local, &mut closest);
                rays += 1;
                if let Some(root) = closest.root {
                    met += 1;
                    let _ = surface.resolve(&local, &root, Need::POINT);
                }
            }
        }
        let ns = started.elapsed().as_nanos() as f64 / f64::from(rays);
        println!(
            "{name}: {whole} steps; {cells} cells of {steps:.1} steps in {built:.1?}; {met} of {rays} rays meet it, {ns:.0} ns a ray"
        );
    }
    Ok(())
}

/// `sqrt(x^2 + y^2 + z^2) - 0.9 + a sin(20 x) sin(20 y) sin(20 z)`.
fn bumpy(a: f64) -> Result<durer_surfaces::tape::Formula, FormulaError> {
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

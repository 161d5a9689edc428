//! Fractals in the plane `z = 0`: how fast points escape when a function is iterated.

use durer_math::{Point3, elementary};
use durer_scene::{Fractal, FractalMap};

/// A complex number.
type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    let (re, im) = times(a, (b.0, -b.1));
    (re / square, im / square)
}

fn square_of(z: Complex) -> f64 {
    z.0 * z.0 + z.1 * z.1
}

fn power(z: Complex, n: u32) -> Complex {
    (1..n).fold(z, |power, _| times(power, z))
}

/// One iteration.
fn next(map: FractalMap, z: Complex, c: Complex) -> Complex {
    match map {
        FractalMap::Power(n) => {
            let (re, im) = power(z, n);
            (re + c.0, im + c.1)
        }
        FractalMap::Magnet1 => {
            let (re, im) = times(z, z);
            let root = over((re + c.0 - 1.0, im + c.1), (2.0 * z.0 + c.0 - 2.0, 2.0 * z.1 + c.1));
            times(root, root)
        }
        FractalMap::Magnet2 => {
            let one = (c.0 - 1.0, c.1);
            let two = (c.0 - 2.0, c.1);
            let both = times(one, two);
            let square = times(z, z);
            let (cube, first) = (times(square, z), times(one, z));
            let second = times(two, z);
            let above = (cube.0 + 3.0 * first.0 + both.0, cube.1 + 3.0 * first.1 + both.1);
            let below = (3.0 * (square.0 + second.0) + both.0 + 1.0, 3.0 * (square.1 + second.1) + both.1);
            let root = over(above, below);
            times(root, root)
        }
    }
}

/// The value at a point.
pub(super) fn value(set: &Fractal, p: Point3) -> f64 {
    let (mut z, mut least) = match (set.map, set.constant) {
        // Magnets start from 0, which does not count as the least.
        (FractalMap::Magnet1 | FractalMap::Magnet2, None) => ((0.0, 0.0), f64::INFINITY),
        _ => ((p.x, p.y), square_of((p.x, p.y))),
    };
    let c = set.constant.unwrap_or((p.x, p.y));
    for k in 0..set.iterations {
        z = next(set.map, z, c);
        let square = square_of(z);
        least = least.min(square);
        let escapes = match set.map {
            FractalMap::Power(_) => square > 4.0,
            // Magnets also have a fixed point, 1.
            _ => square > 1e4 || square_of((z.0 - 1.0, z.1)) < 1e-4,
        };
        if escapes {
            return match set.exterior {
                (1, _) => f64::from(k) / f64::from(set.iterations),
                (6, factor) => factor * elementary::hypot(z.0, z.1),
                (kind, factor) => factor * of_last(kind, z),
            };
        }
    }
    match set.interior {
        (1, factor) => least.sqrt() * factor,
        // Unlike outside, not the root of the sum, and the factor counts for one part alone (facts of
        // the scene language).
        (6, factor) => z.0 * z.0 + factor * (z.1 * z.1),
        (kind, factor) => factor * of_last(kind, z),
    }
}

/// A number made of the last point, alike inside and outside.
fn of_last(kind: u8, (re, im): Complex) -> f64 {
    match kind {
        2 => re,
        3 => im,
        4 => re * re,
        5 => im * im,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of POV-Ray.
    #[test]
    fn the_start_of_magnets_is_not_their_least() {
        let value = |map, constant, x, y| {
            let (exterior, interior) = ((1, 1.0), (1, 1.0));
            value(&Fractal { map, constant, iterations: 5, exterior, interior }, Point3::new(x, y, 0.0))
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} instead of {b}");
        close(value(FractalMap::Magnet1, None, 0.0, 0.0), 0.25);
        close(value(FractalMap::Magnet2, None, 0.01, 0.02), 0.440146819496);
        close(value(FractalMap::Magnet2, Some((0.5, 0.2)), 0.01, 0.02), 0.022360679775);
    }

    /// Values of POV-Ray.
    #[test]
    fn the_last_point_counts_by_its_length_outside_and_by_squares_inside() {
        let value = |constant, iterations, x, y, factor| {
            let (exterior, interior) = ((6, factor), (6, factor));
            let map = FractalMap::Power(2);
            value(&Fractal { map, constant, iterations, exterior, interior }, Point3::new(x, y, 0.0))
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} instead of {b}");
        close(value(None, 2, 0.3, 0.2, 1.0), 0.28224001);
        close(value(None, 2, 0.3, 0.2, 0.5), 0.19235201);
        close(value(None, 2, 0.3, 0.2, 1.3), 0.33617281);
        close(value(Some((0.3, 0.2)), 3, 0.3, 0.2, 1.0), 0.2718501492448);
        close(value(Some((0.3, 0.2)), 3, 1.6, 1.3, 1.0) % 1.00001, 0.5142151988);
    }
}

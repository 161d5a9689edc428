//! Hexagonal columns along y in three colours, like floor tiles.
//!
//! Sides have length 1. The hexagon around the origin has corners on the x axis; centres are at
//! `(x, z) = (1.5 a, (sqrt 3 / 2)(a + 2 b))` for whole `a`, `b`, and a point belongs to the
//! nearest. The colour is `(b + 2 a) mod 3`, so that no two neighbours share it.

use crate::vector::{floor, floor_lanes};
use durer_math::{F8, Point3};

const HALF_HEIGHT: f64 = 0.866_025_403_784_438_6; // sqrt(3) / 2

/// The kind of the hexagon that contains a point: 0, 1 or 2.
pub(super) fn kind(p: Point3) -> usize {
    // Fractional coordinates in the lattice of centres. The nearest centre is a corner of the
    // point's cell or of a neighbouring cell.
    let a = p.x / 1.5;
    let b = (p.z / HALF_HEIGHT - a) * 0.5;
    let (a0, b0) = (floor(a), floor(b));
    let mut best = (f64::INFINITY, 0.0);
    for da in -1..=2 {
        for db in -1..=2 {
            let (a, b) = (a0 + f64::from(da), b0 + f64::from(db));
            let (x, z) = (p.x - 1.5 * a, p.z - HALF_HEIGHT * (a + 2.0 * b));
            let distance = x * x + z * z;
            if distance < best.0 {
                best = (distance, b + 2.0 * a);
            }
        }
    }
    (best.1 - 3.0 * floor(best.1 / 3.0)) as usize
}

/// [`kind`] for eight points.
#[inline(always)]
pub(super) fn kinds(p: Point3<F8>) -> F8 {
    let a = p.x / 1.5;
    let b = (p.z / HALF_HEIGHT - a) * 0.5;
    let (a0, b0) = (floor_lanes(a), floor_lanes(b));
    let (mut nearest, mut best) = (F8::splat(f64::INFINITY), F8::ZERO);
    for da in -1..=2 {
        for db in -1..=2 {
            let (a, b) = (a0 + F8::splat(f64::from(da)), b0 + F8::splat(f64::from(db)));
            let (x, z) = (p.x - a * 1.5, p.z - (a + b * 2.0) * HALF_HEIGHT);
            let distance = x * x + z * z;
            best = distance.lt(nearest).select(b + a * 2.0, best);
            nearest = distance.min(nearest);
        }
    }
    best - floor_lanes(best / 3.0) * 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_the_origin() {
        let at = |x, z| kind(Point3::new(x, 7.0, z));
        assert_eq!(at(0.0, 0.0), 0);
        assert_eq!([at(0.0, 1.7), at(0.0, -1.7)], [1, 2]);
        assert_eq!([at(1.5, 0.9), at(-1.5, 0.9)], [2, 2]);
        assert_eq!([at(1.5, -0.9), at(-1.5, -0.9)], [1, 1]);
        // The corners of the middle hexagon lie on the x axis at distance 1.
        assert_eq!([at(0.99, 0.0), at(-0.99, 0.0)], [0, 0]);
        assert_ne!(at(1.01, 0.01), 0);
    }
}

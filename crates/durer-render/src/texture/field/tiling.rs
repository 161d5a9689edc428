//! Tilings of the plane `y = 0` by polygons.
//!
//! ```text
//!   value = (k + max(1 - d/D, 0))/N
//! ```
//!
//! at a point of a tile of kind `k` of `N`, at the distance `d` from its border; the bevel is `D`
//! wide. The tiles are those of POV-Ray's patterns of the same numbers: all values that were
//! compared are equal to their last digits.

use durer_math::Point3;

use crate::vector::floor;

/// Half the height of a hexagon with sides of 1, `sqrt(3)/2`.
const H: f64 = 0.866_025_403_784_438_6;
/// The width of an octagon with sides of 1, `1 + sqrt(2)`, and half of it.
const Q: f64 = 2.414_213_562_373_095;
const Q2: f64 = 0.5 * Q;
/// Half the diagonal of a unit square.
const R: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// A convex tile: its kind, and its corners against the clock, seen with x to the
/// left and z up.
type Tile = (u8, &'static [[f64; 2]]);

struct Tiling {
    /// The translations that map the tiling to itself.
    steps: [[f64; 2]; 2],
    kinds: u8,
    /// The width of the bevel.
    bevel: f64,
    /// The tiles of which all others are translations.
    tiles: &'static [Tile],
}

macro_rules! rectangle {
    ($x0:expr, $z0:expr, $x1:expr, $z1:expr) => {
        &[[$x0, $z0], [$x1, $z0], [$x1, $z1], [$x0, $z1]]
    };
}

/// The tiling with a number; the caller has checked that there is one.
fn tiling(number: u8) -> Tiling {
    let (steps, kinds, bevel, tiles): ([[f64; 2]; 2], u8, f64, &'static [Tile]) = match number {
        // Squares.
        1 => ([[1.0, 0.0], [0.0, 1.0]], 1, 0.5, &[(0, rectangle!(0.0, 0.0, 1.0, 1.0))]),
        // Hexagons.
        2 => (
            [[1.5, H], [0.0, 2.0 * H]],
            1,
            H,
            &[(0, &[[2.0, 0.0], [1.5, H], [0.5, H], [0.0, 0.0], [0.5, -H], [1.5, -H]])],
        ),
        // Triangles.
        3 => (
            [[1.0, 0.0], [0.5, H]],
            2,
            H / 3.0,
            &[(0, &[[0.0, 0.0], [1.0, 0.0], [0.5, H]]), (1, &[[1.0, 0.0], [1.5, H], [0.5, H]])],
        ),
        // Rhombi side by side.
        4 => ([[1.0, 0.0], [-0.5, H]], 1, 0.5 * H, &[(0, &[[0.0, 0.0], [1.0, 0.0], [0.5, H], [-0.5, H]])]),
        // Rhombi that look like cubes.
        5 => (
            [[1.5, H], [0.0, 2.0 * H]],
            3,
            0.5 * H,
            &[
                (0, &[[0.5, H], [1.5, H], [1.0, 2.0 * H], [0.0, 2.0 * H]]),
                (1, &[[0.5, H], [0.0, 2.0 * H], [-0.5, H], [0.0, 0.0]]),
                (2, &[[0.5, H], [0.0, 0.0], [1.0, 0.0], [1.5, H]]),
            ],
        ),
        // Rectangles in the pattern of a parquet.
        6 => (
            [[1.0, -1.0], [2.0, 2.0]],
            2,
            0.5,
            &[(0, rectangle!(0.0, 1.0, 2.0, 2.0)), (1, rectangle!(-1.0, 0.0, 0.0, 2.0))],
        ),
        // Octagons and squares.
        7 => (
            [[Q, 0.0], [0.0, Q]],
            2,
            0.5,
            &[
                (
                    1,
                    &[
                        [Q2, 0.5],
                        [0.5, Q2],
                        [-0.5, Q2],
                        [-Q2, 0.5],
                        [-Q2, -0.5],
                        [-0.5, -Q2],
                        [0.5, -Q2],
                        [Q2, -0.5],
                    ],
                ),
                (0, &[[Q2 + R, Q2], [Q2, Q2 + R], [Q2 - R, Q2], [Q2, Q2 - R]]),
            ],
        ),
        // Squares in rows, each shifted by half a square.
        10 => ([[1.0, 0.0], [0.5, 1.0]], 1, 0.5, &[(0, rectangle!(0.0, 0.0, 1.0, 1.0))]),
        // Pairs of rectangles.
        _ => (
            [[2.0, 2.0], [2.0, -2.0]],
            2,
            0.5,
            &[
                (0, rectangle!(0.0, 0.0, 2.0, 1.0)),
                (0, rectangle!(0.0, 1.0, 2.0, 2.0)),
                (1, rectangle!(2.0, 0.0, 3.0, 2.0)),
                (1, rectangle!(3.0, 0.0, 4.0, 2.0)),
            ],
        ),
    };
    Tiling { steps, kinds, bevel, tiles }
}

/// How far a point lies inside of a convex polygon: the least distance from the lines of its sides.
fn depth([x, z]: [f64; 2], corners: &[[f64; 2]]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let side = [b[0] - a[0], b[1] - a[1]];
        let length = (side[0] * side[0] + side[1] * side[1]).sqrt();
        least = least.min((side[0] * (z - a[1]) - side[1] * (x - a[0])) / length);
    }
    least
}

/// The value of a tiling at a point.
pub(super) fn value(number: u8, p: Point3) -> f64 {
    let Tiling { steps: [a, b], kinds, bevel, tiles } = tiling(number);
    let (x, z) = (-p.x, p.z);
    let determinant = a[0] * b[1] - a[1] * b[0];
    let i = floor((x * b[1] - z * b[0]) / determinant);
    let j = floor((a[0] * z - a[1] * x) / determinant);
    // The tile in which the point lies, or the nearest one if rounding puts it in none.
    let (mut kind, mut inside) = (0, f64::NEG_INFINITY);
    for (di, dj) in (-2_i8..=2).flat_map(|di| (-2_i8..=2).map(move |dj| (di, dj))) {
        let (i, j) = (i + f64::from(di), j + f64::from(dj));
        let own = [x - i * a[0] - j * b[0], z - i * a[1] - j * b[1]];
        for &(of, corners) in tiles {
            let depth = depth(own, corners);
            if depth > inside {
                (kind, inside) = (of, depth);
            }
        }
    }
    (f64::from(kind) + (1.0 - inside.max(0.0) / bevel).max(0.0)) / f64::from(kinds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_fill_the_plane_without_overlaps() {
        for number in [1, 2, 3, 4, 5, 6, 7, 10, 18] {
            let Tiling { steps: [a, b], tiles, .. } = tiling(number);
            let area = |corners: &[[f64; 2]]| {
                (0..corners.len())
                    .map(|i| {
                        let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
                        0.5 * (p[0] * q[1] - p[1] * q[0])
                    })
                    .sum::<f64>()
            };
            let all: f64 = tiles.iter().map(|(_, corners)| area(corners)).sum();
            assert!((all - (a[0] * b[1] - a[1] * b[0]).abs()).abs() < 1e-12, "{number}: {all}");
            for k in 0..2000 {
                let p = Point3::new(f64::from(k) * 0.0137 - 13.0, 0.0, 9.0 - f64::from(k) * 0.0091);
                assert!((0.0..=1.0).contains(&value(number, p)), "{number} at {p:?}");
            }
        }
    }
}

//! Tilings of the plane `y = 0` by polygons.
//!
//! ```text
//!   value = (k + max(1 - d/D, 0))/N
//! ```
//!
//! at a point of a tile of kind `k` of `N`, at the distance `d` from its border; the bevel is `D`
//! wide. The tiles are those of POV-Ray's patterns of the same numbers: all values that were
//! compared are equal to their last digits.

mod penrose;
mod tiles;

use std::sync::LazyLock;

use durer_math::Point3;

pub(super) use self::tiles::{H, T};
use self::tiles::{Tile, Tiling, tiling};
use crate::vector::floor;

/// The directions at whole twelfths of a turn.
pub(super) const DIRECTIONS: [[f64; 2]; 12] = [
    [1.0, 0.0],
    [H, 0.5],
    [0.5, H],
    [0.0, 1.0],
    [-0.5, H],
    [-H, 0.5],
    [-1.0, 0.0],
    [-H, -0.5],
    [-0.5, -H],
    [0.0, -1.0],
    [0.5, -H],
    [H, -0.5],
];

/// A side of a tile, which lies on the left of its direction.
struct Side {
    /// A point of the side.
    at: [f64; 2],
    along: [f64; 2],
    /// The length of the direction; depths are divided by it.
    length: f64,
}

/// A tile as it is searched for.
struct Outline {
    kind: u8,
    middle: [f64; 2],
    /// The square of a distance from the middle beyond which nothing is in the tile or near it.
    reach: f64,
    sides: Vec<Side>,
}

impl Outline {
    fn new(kind: u8, tile: &Tile) -> Self {
        match *tile {
            Tile::Corners(corners) => Self::of_corners(kind, corners),
            Tile::Regular(sides, middle, turn) => Self::regular(kind, sides, middle, turn),
            Tile::Uneven(middle) => {
                let mut outline = Self::regular(kind, 12, middle, 0);
                for i in [0, 6, 9] {
                    // T divided by this is 1/3.
                    outline.sides[i].length = 1.0 / (3.0 * T);
                }
                outline
            }
        }
    }

    fn of_corners(kind: u8, corners: &[[f64; 2]]) -> Self {
        let mean = |axis: usize| corners.iter().map(|c| c[axis]).sum::<f64>() / corners.len() as f64;
        let middle = [mean(0), mean(1)];
        let farthest = corners.iter().map(|&c| square_distance(c, middle)).fold(0.0, f64::max);
        let sides = corners.iter().enumerate().map(|(i, &a)| {
            let b = corners[(i + 1) % corners.len()];
            let along = [b[0] - a[0], b[1] - a[1]];
            Side { at: a, along, length: (along[0] * along[0] + along[1] * along[1]).sqrt() }
        });
        Self { kind, middle, reach: square(farthest.sqrt() + 0.5), sides: sides.collect() }
    }

    fn regular(kind: u8, sides: u8, middle: [f64; 2], turn: u8) -> Self {
        // The radius of the circle in the polygon.
        let radius = match sides {
            3 => T,
            4 => 0.5,
            6 => H,
            _ => 1.0 + H,
        };
        let side = |i: u8| {
            let [x, z] = DIRECTIONS[usize::from((turn + i * (12 / sides)) % 12)];
            Side { at: [middle[0] + radius * x, middle[1] + radius * z], along: [-z, x], length: 1.0 }
        };
        Self { kind, middle, reach: square(radius + 1.0), sides: (0..sides).map(side).collect() }
    }

    /// How far a point lies inside: the least distance from the lines of the sides.
    fn depth(&self, [x, z]: [f64; 2]) -> f64 {
        let depths = self
            .sides
            .iter()
            .map(|side| (side.along[0] * (z - side.at[1]) - side.along[1] * (x - side.at[0])) / side.length);
        depths.fold(f64::INFINITY, f64::min)
    }
}

fn square(x: f64) -> f64 {
    x * x
}

fn square_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    square(a[0] - b[0]) + square(a[1] - b[1])
}

/// The periodic tilings by their numbers, with their outlines.
static TILINGS: LazyLock<Vec<(Tiling, Vec<Outline>)>> = LazyLock::new(|| {
    let with_outlines = |number| {
        let tiling = tiling(number);
        let outlines = tiling.tiles.iter().map(|(kind, tile)| Outline::new(*kind, tile)).collect();
        (tiling, outlines)
    };
    (0..=24).map(with_outlines).collect()
});

/// The value of a tiling at a point.
pub(super) fn value(number: u8, p: Point3) -> f64 {
    let ((kind, inside), (kinds, bevel)) = match number {
        25 => (penrose::pentagons([p.x, p.z]), penrose::kinds_and_bevel(number)),
        26 => (penrose::kites_and_darts([p.x, p.z]), penrose::kinds_and_bevel(number)),
        27 => (penrose::rhombi([p.x, p.z]), penrose::kinds_and_bevel(number)),
        _ => {
            let (Tiling { steps, kinds, bevel, .. }, outlines) = &TILINGS[usize::from(number)];
            (tile_at(*steps, outlines, [-p.x, p.z]), (*kinds, *bevel))
        }
    };
    (f64::from(kind) + (1.0 - inside.max(0.0) / bevel).max(0.0)) / f64::from(kinds)
}

/// The kind of the tile in which a point lies, or of the nearest one if rounding puts it in none,
/// and how far inside it lies.
fn tile_at([a, b]: [[f64; 2]; 2], outlines: &[Outline], [x, z]: [f64; 2]) -> (u8, f64) {
    let determinant = a[0] * b[1] - a[1] * b[0];
    let i = floor((x * b[1] - z * b[0]) / determinant);
    let j = floor((a[0] * z - a[1] * x) / determinant);
    let (mut kind, mut inside, mut height) = (0, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (di, dj) in (-2_i8..=2).flat_map(|di| (-2_i8..=2).map(move |dj| (di, dj))) {
        let (i, j) = (i + f64::from(di), j + f64::from(dj));
        let own = [x - i * a[0] - j * b[0], z - i * a[1] - j * b[1]];
        for outline in outlines {
            if square_distance(own, outline.middle) > outline.reach {
                continue;
            }
            let depth = outline.depth(own);
            if depth > 0.0 {
                return (outline.kind, depth);
            }
            // On a border the tile above counts.
            let middle = z - own[1] + outline.middle[1];
            if depth > inside || depth == inside && middle > height {
                (kind, inside, height) = (outline.kind, depth, middle);
            }
        }
    }
    (kind, inside)
}

#[cfg(test)]
mod tests {
    use durer_scene::Ramp;

    use super::*;

    /// Points (x, z) and the values of POV-Ray there, in 65535ths, by the number of the tiling.
    const MEASURED: [(u8, [[f64; 3]; 4]); 18] = [
        (
            8,
            [
                [-14.45075, -0.37275, 28254.0],
                [-16.76325, -0.87275, 65026.0],
                [-16.26325, 0.00225, 65365.0],
                [-13.13825, 0.37725, 55073.0],
            ],
        ),
        (
            9,
            [
                [-15.40175, -15.84025, 46481.0],
                [-16.71425, -16.71525, 61361.0],
                [-17.71425, -16.27775, 43690.0],
                [-17.15175, -13.40275, 43690.0],
            ],
        ),
        (
            11,
            [
                [5.04525, -10.39425, 63558.0],
                [7.67025, -8.39425, 26465.0],
                [7.17025, -7.95675, 19955.0],
                [6.54525, -8.83175, 58184.0],
            ],
        ),
        (
            12,
            [
                [14.57525, 0.05675, 41211.0],
                [11.51275, 3.43175, 24827.0],
                [12.88775, 2.74425, 32516.0],
                [12.57525, 0.68175, 46978.0],
            ],
        ),
        (
            13,
            [
                [-6.90025, 2.75775, 39323.0],
                [-4.65025, 3.32025, 30388.0],
                [-4.40025, 2.13275, 42984.0],
                [-7.33775, 1.82025, 3243.0],
            ],
        ),
        (
            14,
            [
                [-2.97325, -6.94525, 7738.0],
                [0.27675, -10.82025, 20533.0],
                [-1.59825, -8.13275, 26252.0],
                [-2.72325, -7.88275, 22315.0],
            ],
        ),
        (
            15,
            [
                [8.52775, -12.19225, 34586.0],
                [5.77775, -13.87975, 57654.0],
                [5.09025, -12.37975, 59620.0],
                [5.71525, -10.62975, 46874.0],
            ],
        ),
        (
            16,
            [
                [-5.38875, -1.77525, 14976.0],
                [-7.51375, -0.46275, 21096.0],
                [-4.20125, 0.72475, 8380.0],
                [-6.32625, 0.41225, 54539.0],
            ],
        ),
        (
            17,
            [
                [5.79825, -17.78175, 54613.0],
                [9.04825, -16.59425, 55729.0],
                [7.98575, -16.09425, 54613.0],
                [6.86075, -15.90675, 28271.0],
            ],
        ),
        (
            19,
            [
                [-8.58625, -17.52475, 28234.0],
                [-9.21125, -16.39975, 43690.0],
                [-5.96125, -14.52475, 6886.0],
                [-7.46125, -14.46225, 43690.0],
            ],
        ),
        (
            20,
            [
                [-16.13075, 7.60125, 43690.0],
                [-16.69325, 7.85125, 43690.0],
                [-14.50575, 10.97625, 11549.0],
                [-13.31825, 8.10125, 21551.0],
            ],
        ),
        (
            21,
            [
                [-20.14075, 12.11125, 7149.0],
                [-20.57825, 11.48625, 40743.0],
                [-20.82825, 11.42375, 50550.0],
                [-19.76575, 12.73625, 43690.0],
            ],
        ),
        (
            22,
            [
                [10.49025, 0.57075, 53108.0],
                [7.92775, -2.05425, 43690.0],
                [8.36525, 0.75825, 43690.0],
                [8.11525, -0.17925, 43690.0],
            ],
        ),
        (
            23,
            [
                [18.47575, 17.60875, 4395.0],
                [18.85075, 15.92125, 43690.0],
                [18.41325, 16.54625, 52768.0],
                [20.10075, 15.67125, 43690.0],
            ],
        ),
        (
            24,
            [
                [-18.80525, -17.45825, 52428.0],
                [-19.43025, -19.20825, 56115.0],
                [-16.99275, -15.95825, 5869.0],
                [-17.43025, -16.52075, 11796.0],
            ],
        ),
        (
            25,
            [
                [-11.18575, 19.58875, 57582.0],
                [-11.24825, 19.08875, 62687.0],
                [-10.56075, 17.52625, 10923.0],
                [-11.06075, 17.96375, 3759.0],
            ],
        ),
        (
            26,
            [
                [8.41175, -14.05325, 19085.0],
                [8.22425, -14.67825, 55953.0],
                [4.84925, -16.55325, 64682.0],
                [6.97425, -15.30325, 42.0],
            ],
        ),
        (
            27,
            [
                [-16.06975, -9.08825, 2656.0],
                [-15.88225, -11.02575, 22338.0],
                [-14.00725, -10.65075, 24806.0],
                [-16.69475, -8.52575, 22359.0],
            ],
        ),
    ];

    #[test]
    fn values_are_those_of_pov_ray() {
        for (number, points) in MEASURED {
            for [x, z, measured] in points {
                let own = 65535.0 * value(number, Point3::new(x, 3.0, z));
                assert!((own - measured).abs() < 0.6, "tiling {number} at {x}, {z}: {own}, not {measured}");
            }
        }
    }

    #[test]
    fn tilings_of_penrose_have_all_kinds_and_no_gaps() {
        for number in 25..=27 {
            let mut kinds = [false; 6];
            for k in 0..20_000 {
                let p = [f64::from(k) * 0.0137 - 130.0, 90.0 - f64::from(k) * 0.0091];
                let (kind, depth) = match number {
                    25 => penrose::pentagons(p),
                    26 => penrose::kites_and_darts(p),
                    _ => penrose::rhombi(p),
                };
                kinds[usize::from(kind)] = true;
                assert!(depth > -1e-12 && depth < 0.9, "{number} at {p:?}: {depth}");
            }
            let (count, _) = penrose::kinds_and_bevel(number);
            assert_eq!(kinds.iter().filter(|&&found| found).count(), usize::from(count));
        }
        for number in Ramp::TILINGS {
            for far in [1e18, -1e300, f64::INFINITY, f64::NAN] {
                let v = value(number, Point3::new(far, 0.0, 0.3));
                assert!((0.0..=1.0).contains(&v), "{number} at {far}: {v}");
            }
        }
    }

    #[test]
    fn tiles_fill_the_plane_without_overlaps() {
        for number in 1..=24_u8 {
            let (Tiling { steps: [a, b], .. }, outlines) = &TILINGS[usize::from(number)];
            for k in 0..40 {
                let [x, z] = [f64::from(k) * 0.6837 - 12.97, 9.03 - f64::from(k) * 0.4191];
                let tiles = (-40..=40).flat_map(|i| (-40..=40).map(move |j| (i, j))).map(|(i, j)| {
                    let (i, j) = (f64::from(i), f64::from(j));
                    let own = [x - i * a[0] - j * b[0], z - i * a[1] - j * b[1]];
                    outlines.iter().filter(|outline| outline.depth(own) > 0.0).count()
                });
                assert_eq!(tiles.sum::<usize>(), 1, "{number} at {x}, {z}");
            }
        }
    }
}

//! The tiles of the tilings.

use Tile::{Corners, Regular, Uneven};

/// Half the height of a hexagon with sides of 1, `sqrt(3)/2`.
pub(in super::super) const H: f64 = 0.866_025_403_784_438_6;
/// The width of an octagon with sides of 1, `1 + sqrt(2)`, and half of it.
const Q: f64 = 2.414_213_562_373_095;
const Q2: f64 = 0.5 * Q;
/// Half the diagonal of a unit square.
const R: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// The radius of the circle in a triangle with sides of 1, a third of its height.
pub(in super::super) const T: f64 = H / 3.0;
/// From the middle of a hexagon with sides of 1 to that of a square at its side.
const P: f64 = 0.5 + H;

/// The shape of a convex tile, seen with x to the left and z up.
pub(super) enum Tile {
    /// Corners against the clock.
    Corners(&'static [[f64; 2]]),
    /// A regular polygon with sides of 1: the number of its sides (3, 4, 6 or 12), its middle, and
    /// the direction of one of its sides from there, in twelfths of a turn against the clock.
    Regular(u8, [f64; 2], u8),
    /// A regular dodecagon with sides of 1 around a middle, with a bevel of 1/3 at its sides in
    /// the directions 0, 6 and 9 (a fact of POV-Ray).
    Uneven([f64; 2]),
}

/// Tiles with their kinds.
type Tiles = &'static [(u8, Tile)];

pub(super) struct Tiling {
    /// The translations that map the tiling to itself.
    pub(super) steps: [[f64; 2]; 2],
    pub(super) kinds: u8,
    /// The width of the bevel.
    pub(super) bevel: f64,
    /// The tiles of which all others are translations.
    pub(super) tiles: Tiles,
}

macro_rules! rectangle {
    ($x0:expr, $z0:expr, $x1:expr, $z1:expr) => {
        Corners(&[[$x0, $z0], [$x1, $z0], [$x1, $z1], [$x0, $z1]])
    };
}

/// Four trapezia between squares, and the steps of their tilings.
const ABOVE: Tile = Corners(&[[0.0, 0.0], [4.0 * R, 0.0], [3.0 * R, R], [R, R]]);
const BELOW: Tile = Corners(&[[0.0, 0.0], [R, -R], [3.0 * R, -R], [4.0 * R, 0.0]]);
const RIGHT: Tile = Corners(&[[0.0, 0.0], [R, R], [R, 3.0 * R], [0.0, 4.0 * R]]);
const LEFT: Tile = Corners(&[[0.0, 0.0], [0.0, 4.0 * R], [-R, 3.0 * R], [-R, R]]);
const TRAPEZIA_STEPS: [[f64; 2]; 2] = [[4.0 * R, 0.0], [0.0, 4.0 * R]];

/// The tiling with a number; 18 if there is none with that number.
pub(super) fn tiling(number: u8) -> Tiling {
    let (steps, kinds, bevel, tiles): ([[f64; 2]; 2], u8, f64, Tiles) = match number {
        // Squares.
        1 => ([[1.0, 0.0], [0.0, 1.0]], 1, 0.5, &[(0, rectangle!(0.0, 0.0, 1.0, 1.0))]),
        // Hexagons.
        2 => (
            [[1.5, H], [0.0, 2.0 * H]],
            1,
            H,
            &[(0, Corners(&[[2.0, 0.0], [1.5, H], [0.5, H], [0.0, 0.0], [0.5, -H], [1.5, -H]]))],
        ),
        // Triangles.
        3 => (
            [[1.0, 0.0], [0.5, H]],
            2,
            H / 3.0,
            &[
                (0, Corners(&[[0.0, 0.0], [1.0, 0.0], [0.5, H]])),
                (1, Corners(&[[1.0, 0.0], [1.5, H], [0.5, H]])),
            ],
        ),
        // Rhombi side by side.
        4 => (
            [[1.0, 0.0], [-0.5, H]],
            1,
            0.5 * H,
            &[(0, Corners(&[[0.0, 0.0], [1.0, 0.0], [0.5, H], [-0.5, H]]))],
        ),
        // Rhombi that look like cubes.
        5 => (
            [[1.5, H], [0.0, 2.0 * H]],
            3,
            0.5 * H,
            &[
                (0, Corners(&[[0.5, H], [1.5, H], [1.0, 2.0 * H], [0.0, 2.0 * H]])),
                (1, Corners(&[[0.5, H], [0.0, 2.0 * H], [-0.5, H], [0.0, 0.0]])),
                (2, Corners(&[[0.5, H], [0.0, 0.0], [1.0, 0.0], [1.5, H]])),
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
                    Corners(&[
                        [Q2, 0.5],
                        [0.5, Q2],
                        [-0.5, Q2],
                        [-Q2, 0.5],
                        [-Q2, -0.5],
                        [-0.5, -Q2],
                        [0.5, -Q2],
                        [Q2, -0.5],
                    ]),
                ),
                (0, Corners(&[[Q2 + R, Q2], [Q2, Q2 + R], [Q2 - R, Q2], [Q2, Q2 - R]])),
            ],
        ),
        // Squares in rows, each shifted by half a square.
        10 => ([[1.0, 0.0], [0.5, 1.0]], 1, 0.5, &[(0, rectangle!(0.0, 0.0, 1.0, 1.0))]),
        // Rows of squares and rows of triangles.
        8 => (
            [[1.0, 0.0], [0.5, 1.0 + H]],
            3,
            T,
            &[
                (2, Regular(4, [0.5, 0.5], 0)),
                (1, Regular(3, [0.5, -T], 3)),
                (0, Regular(3, [0.0, -2.0 * T], 1)),
            ],
        ),
        // Hexagons with triangles at their corners.
        9 => (
            [[2.0, 0.0], [1.0, -2.0 * H]],
            3,
            T,
            &[(2, Regular(6, [-0.5, H], 1)), (0, Regular(3, [0.5, T], 1)), (1, Regular(3, [-0.5, -T], 3))],
        ),
        // Squares and rectangles.
        11 => (
            [[3.0, 0.0], [0.0, 3.0]],
            3,
            0.5,
            &[
                (0, rectangle!(1.0, 1.0, 2.0, 2.0)),
                (1, rectangle!(0.0, 0.0, 2.0, 1.0)),
                (1, rectangle!(-2.0, -1.0, 0.0, 0.0)),
                (2, rectangle!(-1.0, 0.0, 0.0, 2.0)),
                (2, rectangle!(0.0, -2.0, 1.0, 0.0)),
            ],
        ),
        // Squares and fours of rectangles.
        12 => (
            [[3.0, 3.0], [3.0, -3.0]],
            3,
            0.5,
            &[
                (0, rectangle!(1.0, 1.0, 2.0, 2.0)),
                (0, rectangle!(-2.0, 1.0, -1.0, 2.0)),
                (1, rectangle!(1.0, 0.0, 3.0, 1.0)),
                (1, rectangle!(1.0, -1.0, 3.0, 0.0)),
                (1, rectangle!(-3.0, 0.0, -1.0, 1.0)),
                (1, rectangle!(-3.0, -1.0, -1.0, 0.0)),
                (2, rectangle!(0.0, 0.0, 1.0, 2.0)),
                (2, rectangle!(0.0, -2.0, 1.0, 0.0)),
                (2, rectangle!(-1.0, 0.0, 0.0, 2.0)),
                (2, rectangle!(-1.0, -2.0, 0.0, 0.0)),
            ],
        ),
        // Squares with a trapezium at each side.
        13 => (
            TRAPEZIA_STEPS,
            3,
            0.5 * R,
            &[(1, ABOVE), (1, BELOW), (2, RIGHT), (2, LEFT), (0, rectangle!(R, R, 3.0 * R, 3.0 * R))],
        ),
        // Squares with a trapezium at each side, five colours.
        14 => (
            TRAPEZIA_STEPS,
            5,
            0.5 * R,
            &[(2, ABOVE), (3, BELOW), (0, RIGHT), (1, LEFT), (4, rectangle!(R, R, 3.0 * R, 3.0 * R))],
        ),
        // Squares of two sizes.
        15 => (
            [[2.0, -1.0], [1.0, 2.0]],
            2,
            0.5,
            &[(0, rectangle!(-1.0, 0.0, 0.0, 1.0)), (1, rectangle!(-1.0, -2.0, 1.0, 0.0))],
        ),
        // Hexagons with squares at their sides and triangles at their corners.
        16 => (
            [[1.0 + P, P], [0.0, 2.0 * P]],
            3,
            T,
            &[
                (2, Regular(6, [1.0, 0.0], 1)),
                (1, Regular(3, [-2.0 * T, 0.0], 2)),
                (1, Regular(3, [2.0 + 2.0 * T, 0.0], 0)),
                (0, Regular(4, [1.0, P], 0)),
                (0, Regular(4, [1.0 - H * P, 0.5 * P], 2)),
                (0, Regular(4, [1.0 - H * P, -0.5 * P], 1)),
            ],
        ),
        17 => (
            [[1.0 + P, P], [0.0, 2.0 * P]],
            6,
            T,
            &[
                (5, Regular(6, [1.0, 0.0], 1)),
                (4, Regular(3, [-2.0 * T, 0.0], 2)),
                (3, Regular(3, [2.0 + 2.0 * T, 0.0], 0)),
                (0, Regular(4, [1.0, P], 0)),
                (1, Regular(4, [1.0 - H * P, 0.5 * P], 2)),
                (2, Regular(4, [1.0 - H * P, -0.5 * P], 1)),
            ],
        ),
        // Hexagons among triangles.
        19 => (
            [[2.5, H], [-2.0, 2.0 * H]],
            3,
            T,
            &[
                (2, Regular(6, [1.0, 0.0], 1)),
                (0, Regular(3, [-0.5, T], 1)),
                (0, Regular(3, [0.0, -2.0 * T], 1)),
                (0, Regular(3, [0.0, 4.0 * T], 1)),
                (0, Regular(3, [1.0, 4.0 * T], 1)),
                (1, Regular(3, [-0.5, -T], 3)),
                (1, Regular(3, [0.0, 2.0 * T], 3)),
                (1, Regular(3, [0.0, -4.0 * T], 3)),
                (1, Regular(3, [-1.0, 2.0 * T], 3)),
            ],
        ),
        // Its mirror image.
        20 => (
            [[2.0, 2.0 * H], [2.5, -H]],
            3,
            T,
            &[
                (2, Regular(6, [-0.5, -H], 1)),
                (0, Regular(3, [0.5, T], 1)),
                (0, Regular(3, [-0.5, T], 1)),
                (0, Regular(3, [0.0, 4.0 * T], 1)),
                (0, Regular(3, [1.0, -2.0 * T], 1)),
                (1, Regular(3, [0.5, -T], 3)),
                (1, Regular(3, [0.0, 2.0 * T], 3)),
                (1, Regular(3, [-1.0, 2.0 * T], 3)),
                (1, Regular(3, [1.0, -4.0 * T], 3)),
            ],
        ),
        // Squares and triangles in turns.
        21 => (
            [[P, P], [P, -P]],
            6,
            T,
            &[
                (0, Regular(3, [-T, 0.0], 0)),
                (1, Regular(3, [0.0, P - T], 3)),
                (2, Regular(3, [T, 0.0], 2)),
                (3, Regular(3, [0.0, T - P], 1)),
                (4, Regular(4, [-0.5 * P, 0.5 * P], 1)),
                (5, Regular(4, [0.5 * P, 0.5 * P], 2)),
            ],
        ),
        // Dodecagons and triangles.
        22 => (
            [[1.0 + H, 1.5 + 2.0 * H], [2.0 + 2.0 * H, 0.0]],
            3,
            T,
            &[(2, Uneven([0.0, -P])), (0, Regular(3, [0.0, 0.5 + T], 1)), (1, Regular(3, [1.0 + H, -T], 3))],
        ),
        // Dodecagons, hexagons and squares.
        23 => (
            [[1.0 + P, 3.0 * P], [3.0 + 2.0 * H, 0.0]],
            3,
            0.5,
            &[
                (2, Regular(12, [0.0, -P], 0)),
                (0, Regular(6, [0.0, P], 1)),
                (0, Regular(6, [1.0 + P, 0.0], 1)),
                (1, Regular(4, [1.0 + P, -P], 0)),
                (1, Regular(4, [H * P, 0.5 * P], 2)),
                (1, Regular(4, [-H * P, 0.5 * P], 1)),
            ],
        ),
        24 => (
            [[1.0 + P, 3.0 * P], [3.0 + 2.0 * H, 0.0]],
            5,
            0.5,
            &[
                (4, Regular(12, [0.0, -P], 0)),
                (0, Regular(6, [0.0, P], 1)),
                (0, Regular(6, [1.0 + P, 0.0], 1)),
                (1, Regular(4, [1.0 + P, -P], 0)),
                (2, Regular(4, [-H * P, 0.5 * P], 1)),
                (3, Regular(4, [H * P, 0.5 * P], 2)),
            ],
        ),
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

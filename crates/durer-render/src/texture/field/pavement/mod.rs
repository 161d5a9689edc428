//! Pavements: the plane `y = 0` in tiles that are made of equal triangles, squares or hexagons.
//!
//! The value is 1 on the borders of the tiles and falls to 0 inside. A cell is cut into parts, one
//! for each of its corners, and the value in a part follows from which sides at that corner are
//! borders. All formulas were found from POV-Ray's pictures and agree with them to the last digit.

mod layouts;

use durer_math::Point3;
use durer_scene::{CornerLook, Pavement};

use self::layouts::{HEXAGONS, Layout, SQUARES, TRIANGLES};
use super::tiling::{DIRECTIONS, H, T};
use crate::vector::floor;

/// Coordinates beyond this are shown as if they were here; whole numbers of cells stay exact.
const FAR: f64 = 1e15;

/// The value of a pavement at a point.
pub(super) fn value(pavement: &Pavement, p: Point3) -> f64 {
    let (x, z) = (p.x.clamp(-FAR, FAR), p.z.clamp(-FAR, FAR));
    let (tiles, pattern) = (usize::from(pavement.tiles) - 1, usize::from(pavement.pattern) - 1);
    let value = match pavement.sides {
        3 => triangles(pavement, &TRIANGLES[tiles][pattern], x, z),
        4 => squares(pavement, &SQUARES[tiles][pattern], x, z),
        _ => hexagons(pavement, &HEXAGONS[tiles][pattern], x, z),
    };
    value.clamp(0.0, 1.0)
}

/// Whether a cell has the border with a number.
fn has(&(rows, shift, digits): &Layout, row: i64, column: i64, border: u8) -> bool {
    let columns = digits.len() as i64 / rows;
    let period = row.div_euclid(rows);
    let column = (column - period * shift).rem_euclid(columns);
    let at = row.rem_euclid(rows) * columns + column;
    (digits.as_bytes()[at as usize] - b'0') & border != 0
}

fn inner_product([ax, az]: [f64; 2], [bx, bz]: [f64; 2]) -> f64 {
    ax * bx + az * bz
}

fn length(v: [f64; 2]) -> f64 {
    inner_product(v, v).sqrt()
}

/// `p - q`.
fn from_to([qx, qz]: [f64; 2], [px, pz]: [f64; 2]) -> [f64; 2] {
    [px - qx, pz - qz]
}

/// Unit squares with corners at whole numbers.
fn squares(pavement: &Pavement, layout: &Layout, x: f64, z: f64) -> f64 {
    let (i, j) = (floor(x) as i64, floor(z) as i64);
    let (x, z) = (x - floor(x) - 0.5, z - floor(z) - 0.5);
    let beside = |i: i64, right: bool| has(layout, j, i + i64::from(right), 2);
    let above = |i: i64, up: bool| has(layout, j + i64::from(up), i, 1);
    let step = |forward: bool| if forward { 1 } else { -1 };
    // The look of the corner of two borders, and of one into which only other cells' borders run.
    let (mut outer, mut inner) = (pavement.exterior, pavement.interior);
    let (right, up) = (beside(i, true), above(i, true));
    if right != beside(i, false) && up != above(i, false) && above(i + step(!right), !up) {
        // The tile turns here around the corner between the sides without borders.
        let free = [0.5 * step(!right) as f64, 0.5 * step(!up) as f64];
        let [s, t] = from_to([x, z], free).map(f64::abs);
        match pavement.form {
            Some(CornerLook::Sharp) => (outer, inner) = (CornerLook::Sharp, CornerLook::Sharp),
            Some(CornerLook::Cut) => return (2.0 * (s + t) - 1.0).abs(),
            Some(CornerLook::Round) => return (2.0 * length([s, t]) - 1.0).abs(),
            None => {}
        }
    }
    let (a, b) = (2.0 * x.abs(), 2.0 * z.abs());
    match (beside(i, x >= 0.0), above(i, z >= 0.0)) {
        (true, true) => match outer {
            CornerLook::Sharp => a.max(b),
            CornerLook::Cut => a + b,
            CornerLook::Round => length([a, b]),
        },
        (true, false) => a,
        (false, true) => b,
        (false, false) if above(i + step(x >= 0.0), z >= 0.0) => match inner {
            CornerLook::Sharp => a.min(b),
            CornerLook::Cut => a + b - 1.0,
            CornerLook::Round => 1.0 - length([1.0 - a, 1.0 - b]),
        },
        (false, false) => 0.0,
    }
}

/// The value at a depth below a border of triangles or hexagons.
fn bevel(depth: f64) -> f64 {
    1.0 - depth / T
}

/// The value at a corner of 120 degrees of a tile of triangles or hexagons: at a depth below a
/// border, at an offset from the middle of the hexagon with that corner, which lies in a direction.
fn wide_corner(look: CornerLook, depth: f64, offset: [f64; 2], direction: [f64; 2]) -> f64 {
    match look {
        CornerLook::Sharp => bevel(depth),
        CornerLook::Cut => 4.0 * inner_product(offset, direction) - 2.0,
        CornerLook::Round => length(offset) / T - 2.0,
    }
}

/// The value between two directions at 60 degrees from a corner, around which a tile reaches by
/// half a turn or more.
fn inner_corner(look: CornerLook, offset: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (a, b) = (inner_product(offset, a), inner_product(offset, b));
    match look {
        CornerLook::Sharp => 1.0 - 2.0 * (a + b),
        CornerLook::Cut => 1.0 - 3.0 * a.max(b),
        CornerLook::Round => 1.0 - 3.0 * length(offset),
    }
}

/// Triangles with sides of 1 between the points `i(1, 0) + j(1/2, H)`.
fn triangles(pavement: &Pavement, layout: &Layout, x: f64, z: f64) -> f64 {
    let (u, v) = (x - z / (2.0 * H), z / H);
    let (i, j) = (floor(u) as i64, floor(v) as i64);
    let points_down = (u - floor(u)) + (v - floor(v)) > 1.0;
    // The corners, with the sixth of a turn in which the triangle lies there.
    let corners = if points_down {
        [(i + 1, j + 1, 3), (i, j + 1, 5), (i + 1, j, 1)]
    } else {
        [(i, j, 0), (i + 1, j, 2), (i, j + 1, 4)]
    };
    let offsets = corners.map(|(i, j, _)| [x - (i as f64 + 0.5 * j as f64), z - H * j as f64]);
    let is_nearer = |k: usize, than: usize| length(offsets[k]) < length(offsets[than]);
    let nearest = (1..3).fold(0, |best, k| if is_nearer(k, best) { k } else { best });
    let ((i, j, sector), offset) = (corners[nearest], offsets[nearest]);
    // Whether the side that leaves the corner in a direction is a border.
    let is_border = |sixth: usize| match sixth % 6 {
        0 => has(layout, j, i, 1),
        1 => has(layout, j, i, 4),
        2 => has(layout, j, i - 1, 2),
        3 => has(layout, j, i - 1, 1),
        4 => has(layout, j - 1, i, 4),
        _ => has(layout, j - 1, i, 2),
    };
    let direction = |sixth: usize| DIRECTIONS[2 * sixth % 12];
    let (a, b) = (direction(sector), direction(sector + 1));
    let depth = |[dx, dz]: [f64; 2]| (offset[0] * dz - offset[1] * dx).abs();
    // Beside one border: the side that the triangle shares with the next one, and that one's other.
    let beside = |border: [f64; 2], shared: [f64; 2], next: usize| {
        if is_border(next) {
            let look = pavement.form.unwrap_or(CornerLook::Sharp);
            wide_corner(look, depth(border), from_to(shared, offset), [-shared[0], -shared[1]])
        } else {
            bevel(depth(border))
        }
    };
    match (is_border(sector), is_border(sector + 1)) {
        (true, true) => {
            let sharp = bevel(depth(a).min(depth(b)));
            let middle = DIRECTIONS[2 * sector + 1];
            match pavement.exterior {
                CornerLook::Sharp => sharp,
                CornerLook::Cut => sharp.max(2.0 - inner_product(offset, middle) / T),
                CornerLook::Round => length(from_to(middle.map(|m| 2.0 * T * m), offset)) / T,
            }
        }
        (true, false) => beside(a, b, sector + 2),
        (false, true) => beside(b, a, sector + 5),
        (false, false) if (0..6).any(is_border) => inner_corner(pavement.interior, offset, [a, b]),
        (false, false) => 0.0,
    }
}

/// Hexagons with sides of 1 around the points `(1, 0) + i(3/2, H) + j(0, 2H)`.
fn hexagons(pavement: &Pavement, layout: &Layout, x: f64, z: f64) -> f64 {
    let column = floor((x - 1.0) / 1.5 + 0.5) as i64;
    let (mut i, mut j, mut own) = (0, 0, [f64::INFINITY; 2]);
    for near in column - 1..=column + 1 {
        let across = near as f64;
        let up = floor((z / H - across) * 0.5 + 0.5);
        let offset = [x - 1.0 - 1.5 * across, z - H * (across + 2.0 * up)];
        if length(offset) < length(own) {
            (i, j, own) = (near, up as i64, offset);
        }
    }
    let is_border = |side: usize| match side {
        0 => has(layout, i, j, 1),
        1 => has(layout, i, j, 2),
        2 => has(layout, i, j, 4),
        3 => has(layout, i - 1, j, 1),
        4 => has(layout, i, j - 1, 2),
        _ => has(layout, i + 1, j - 1, 4),
    };
    let normal = |side: usize| DIRECTIONS[2 * side + 1];
    let height = |side: usize| inner_product(own, normal(side));
    // The nearest side, and the nearer one of its neighbours.
    let side = (1..6).fold(0, |best, k| if height(k) > height(best) { k } else { best });
    let (left, right) = ((side + 1) % 6, (side + 5) % 6);
    let is_left = height(left) >= height(right);
    let other = if is_left { left } else { right };
    // The corner between them.
    let corner = DIRECTIONS[(2 * side + if is_left { 2 } else { 0 }) % 12];
    match (is_border(side), is_border(other)) {
        (true, true) => {
            let look = pavement.form.unwrap_or(CornerLook::Sharp);
            wide_corner(look, H - height(side), own, corner)
        }
        (true, false) => bevel(H - height(side)),
        (false, true) => {
            let along = DIRECTIONS[(2 * side + if is_left { 10 } else { 4 }) % 12];
            inner_corner(pavement.interior, from_to(corner, own), [[-corner[0], -corner[1]], along])
        }
        (false, false) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pavements: sides, tiles, pattern, exterior, interior, form; points (x, z) and the values of
    /// POV-Ray there, in 65535ths.
    const MEASURED: [([u8; 6], [[f64; 3]; 4]); 18] = [
        (
            [3, 5, 2, 0, 0, 1],
            [
                [12.48225, 17.13175, 4653.0],
                [9.60725, 15.63175, 28115.0],
                [10.91975, 17.50675, 23254.0],
                [10.10725, 15.25675, 41709.0],
            ],
        ),
        (
            [3, 6, 3, 1, 0, 2],
            [
                [19.35825, -15.70775, 38453.0],
                [20.48325, -13.58275, 3410.0],
                [20.42075, -13.14525, 30377.0],
                [18.85825, -13.70775, 54540.0],
            ],
        ),
        (
            [3, 4, 1, 2, 1, 0],
            [
                [-19.17275, -14.04625, 22437.0],
                [-17.86025, -15.35875, 13387.0],
                [-19.04775, -13.92125, 50814.0],
                [-19.92275, -13.73375, 37690.0],
            ],
        ),
        (
            [3, 6, 6, 0, 1, 1],
            [
                [-5.73575, -2.59525, 19185.0],
                [-7.17325, -5.84525, 16288.0],
                [-5.54825, -4.90775, 9455.0],
                [-5.73575, -3.78275, 24095.0],
            ],
        ),
        (
            [3, 6, 11, 1, 2, 2],
            [
                [8.72875, -19.23625, 1128.0],
                [6.60375, -17.29875, 60595.0],
                [7.85375, -18.42375, 34595.0],
                [6.22875, -18.54875, 53321.0],
            ],
        ),
        (
            [3, 6, 6, 2, 2, 0],
            [
                [13.29375, 8.40125, 6736.0],
                [13.10625, 7.40125, 32729.0],
                [11.04375, 9.33875, 22962.0],
                [11.60625, 10.58875, 20938.0],
            ],
        ),
        (
            [4, 6, 29, 0, 0, 1],
            [
                [0.38275, -9.72325, 51642.0],
                [1.13275, -7.09825, 48135.0],
                [-0.42975, -9.09825, 9208.0],
                [-1.05475, -8.22325, 36274.0],
            ],
        ),
        (
            [4, 6, 24, 1, 0, 2],
            [
                [18.45625, -16.62675, 22347.0],
                [19.39375, -14.56425, 8421.0],
                [20.39375, -16.43925, 7963.0],
                [20.33125, -17.37675, 38272.0],
            ],
        ),
        (
            [4, 6, 12, 2, 1, 3],
            [
                [4.69775, 17.66575, 21725.0],
                [6.07275, 16.60325, 3998.0],
                [4.82275, 14.60325, 13533.0],
                [6.44775, 16.10325, 52002.0],
            ],
        ),
        (
            [4, 6, 32, 0, 1, 0],
            [
                [-3.07675, -14.65125, 19824.0],
                [-3.82675, -12.46375, 4751.0],
                [-3.63925, -14.65125, 19824.0],
                [-4.38925, -14.65125, 14516.0],
            ],
        ),
        (
            [4, 6, 7, 1, 2, 1],
            [
                [11.59925, -3.86625, 48004.0],
                [9.59925, -1.24125, 33914.0],
                [11.53675, -1.11625, 2934.0],
                [12.59925, -3.49125, 14156.0],
            ],
        ),
        (
            [4, 5, 2, 2, 2, 2],
            [
                [8.19075, 12.15725, 44924.0],
                [9.75325, 12.46975, 55203.0],
                [6.62825, 12.03225, 61308.0],
                [7.69075, 10.78225, 36995.0],
            ],
        ),
        (
            [6, 5, 8, 0, 0, 1],
            [
                [-14.95475, 5.74175, 13139.0],
                [-15.89225, 3.74175, 53915.0],
                [-17.82975, 6.30425, 44629.0],
                [-14.89225, 5.61675, 49709.0],
            ],
        ),
        (
            [6, 5, 11, 1, 0, 2],
            [
                [-13.30725, -20.75975, 26299.0],
                [-11.24475, -18.07225, 48408.0],
                [-14.99475, -19.25975, 18498.0],
                [-12.30725, -20.94725, 28612.0],
            ],
        ),
        (
            [6, 4, 3, 2, 1, 0],
            [
                [0.69225, -7.70075, 44313.0],
                [3.12975, -6.82575, 35336.0],
                [2.75475, -6.88825, 56465.0],
                [1.37975, -9.32575, 20011.0],
            ],
        ),
        (
            [6, 4, 2, 0, 1, 1],
            [
                [-1.87375, 9.65525, 52804.0],
                [-5.12375, 7.90525, 40331.0],
                [-4.24875, 8.15525, 57118.0],
                [-5.68625, 8.03025, 7040.0],
            ],
        ),
        (
            [6, 5, 12, 1, 2, 2],
            [
                [-17.91775, -1.20025, 21342.0],
                [-16.54275, -2.26275, 27961.0],
                [-18.41775, -1.70025, 59234.0],
                [-16.35525, -2.70025, 30701.0],
            ],
        ),
        (
            [6, 5, 5, 2, 2, 0],
            [
                [3.22775, 8.71725, 27228.0],
                [2.91525, 6.77975, 32022.0],
                [4.66525, 8.59225, 7441.0],
                [3.04025, 8.21725, 23163.0],
            ],
        ),
    ];

    fn look(number: u8) -> Option<CornerLook> {
        [Some(CornerLook::Sharp), Some(CornerLook::Cut), Some(CornerLook::Round), None][usize::from(number)]
    }

    fn made([sides, tiles, pattern, exterior, interior, form]: [u8; 6]) -> Pavement {
        let sharp = CornerLook::Sharp;
        let (exterior, interior) = (look(exterior).unwrap_or(sharp), look(interior).unwrap_or(sharp));
        Pavement { sides, tiles, pattern, exterior, interior, form: look(form) }
    }

    #[test]
    fn values_are_those_of_pov_ray() {
        for (pavement, points) in MEASURED {
            for [x, z, measured] in points {
                let own = 65535.0 * value(&made(pavement), Point3::new(x, 3.0, z));
                assert!((own - measured).abs() < 0.6, "{pavement:?} at {x}, {z}: {own}, not {measured}");
            }
        }
    }

    #[test]
    fn there_is_a_layout_for_each_pattern() {
        for (sides, layouts) in [(3, TRIANGLES), (4, SQUARES), (6, HEXAGONS)] {
            assert_eq!(Pavement::patterns(sides, layouts.len() as u8 + 1), 0);
            for (tiles, layouts) in (1..).zip(layouts) {
                assert_eq!(usize::from(Pavement::patterns(sides, tiles)), layouts.len());
                for (pattern, &(rows, _, digits)) in (1..).zip(*layouts) {
                    // One or two tiles in a period.
                    let cells = digits.len() * if sides == 3 { 2 } else { 1 };
                    let count = cells / usize::from(tiles);
                    assert!([1, 2].contains(&count) && cells.is_multiple_of(usize::from(tiles)));
                    assert_eq!(digits.len() as i64 % rows, 0);
                    for far in [0.0, 1e300, -1e18, f64::INFINITY] {
                        let v = value(&made([sides, tiles, pattern, 2, 2, 2]), Point3::new(far, 0.0, -0.3));
                        assert!((0.0..=1.0).contains(&v));
                    }
                }
            }
        }
    }
}

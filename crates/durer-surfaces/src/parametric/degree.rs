//! How often a line crosses a map within a box in which rounding hides the single crossings.
//!
//! Along the border of a box of parameters, `F` turns around zero as many times as the signs of its
//! zeros in the box add up to: its degree, for any number of zeros (R. B. Kearfott, "An efficient
//! degree-computation method for a generalized method of bisection", *Numerische Mathematik* 32
//! (1979) 109-127). So the border decides what is hidden inside: 0 beside a tangent, whether the
//! line meets the map twice there or misses it, and 1 or -1 where it leads through.
//!
//! The border has to be so far away that `F` is certainly not zero there: the box is doubled until it
//! is. The turns are counted by the combination of both functions that changes most slowly, and by
//! the one across it: where the former changes its sign, the latter has a certain one.

use super::line::{Found, View};
use super::piece::Domain;
use super::subdivide::slowest;
use durer_formula::lanes;
use durer_math::U;

/// The border is examined at so many points of each side; at more if these leave the turns open.
const POINTS: [usize; 2] = [32, 512];
/// By how much the box is enlarged. Twice as large, `F` beside a tangent is four times as large as
/// in the unproven box.
const SIZES: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// What an unproven crossing stands for.
pub(super) enum Sum {
    /// The sum of the signs of all crossings there.
    Certain(i8),
    /// Only together with another unproven one, of this index, there may be a sum.
    With(usize),
    Unknown,
}

/// The sum of the signs of the crossings that the unproven one `found[i]` stands for. `turned` says
/// whether signs are those of the map with the opposite normal.
#[cold]
#[inline(never)]
pub(super) fn sum_of_signs(view: &View<'_>, found: &[Found], i: usize, turned: bool) -> Sum {
    let own = &found[i];
    let others = || found.iter().enumerate().filter(|&(j, other)| j != i && other.face == own.face);
    for size in SIZES {
        let around = [0, 1].map(|k: usize| {
            let by = size * own.radius[k];
            [own.uv[k] - by, own.uv[k] + by]
        });
        let Some(degree) = degree(view, &around) else { continue };
        // Whether another one's box is in this one, made smaller by a part of the other's radius.
        let holds = |other: &Found, part: f64| {
            (0..2).all(|k: usize| {
                let ([from, to], room) = (around[k], part * other.radius[k]);
                from + room <= other.uv[k] && other.uv[k] <= to - room
            })
        };
        if let Some((j, _)) = others().find(|(_, other)| other.sign == 0 && holds(other, -1.0)) {
            return Sum::With(j);
        }
        if others().any(|(_, other)| holds(other, -1.0) && !holds(other, 1.0)) {
            continue;
        }
        let proven: i32 =
            others().filter(|(_, other)| holds(other, 1.0)).map(|(_, other)| i32::from(other.sign)).sum();
        let sum = if (view.line.d_z < 0.0) == turned { degree } else { -degree } - proven;
        return match i8::try_from(sum) {
            Ok(sum @ -1..=1) => Sum::Certain(sum),
            _ => Sum::Unknown,
        };
    }
    Sum::Unknown
}

/// How many times `F` turns around zero along the border of a box, by the orientation of the
/// parameters.
fn degree(view: &View<'_>, around: &Domain) -> Option<i32> {
    if !view.face.knows(around) {
        return None;
    }
    let middle = around.map(|[from, to]| 0.5 * from + 0.5 * to);
    let width = around.map(|[from, to]| to - from);
    let slow = slowest(&view.slopes_at(middle, width));
    POINTS.into_iter().find_map(|points| turns(&signs_along(view, slow, &border(around, points))?))
}

/// The certain signs of both combinations at points, that across `slow` first; `None` if the map is
/// undefined at one of them.
fn signs_along(view: &View<'_>, slow: [f64; 2], points: &[[f64; 2]]) -> Option<Vec<[i8; 2]>> {
    let mut signs = Vec::with_capacity(points.len());
    for points in points.chunks(8) {
        let boxes: [Domain; 8] = core::array::from_fn(|k| points[k.min(points.len() - 1)].map(|x| [x, x]));
        let values = view.face.tape.bounds(&lanes(&boxes));
        for lane in 0..points.len() {
            let (mut p, mut p_err) = ([0.0; 3], [0.0; 3]);
            for c in 0..3 {
                if values[c].empty >> lane & 1 == 1 {
                    return None;
                }
                (p[c], p_err[c]) = view.unit.place(values[c].lane(lane), c);
            }
            let (f, e) = view.values(&p, &p_err);
            signs.push([certain_sign([slow[1], -slow[0]], f, e), certain_sign(slow, f, e)]);
        }
    }
    Some(signs)
}

/// Points of a box's border in their order, the first parameter growing first: `count` of each side.
fn border(around: &Domain, count: usize) -> Vec<[f64; 2]> {
    let [[left, right], [low, high]] = *around;
    let corners = [[left, low], [right, low], [right, high], [left, high]];
    let mut points = Vec::with_capacity(4 * count);
    for (from, to) in corners.into_iter().zip([corners[1], corners[2], corners[3], corners[0]]) {
        points.extend((0..count).map(|n| {
            let part = n as f64 / count as f64;
            [0, 1].map(|k: usize| from[k] + part * (to[k] - from[k]))
        }));
    }
    points
}

/// The sign of a combination of both functions, 0 if the errors hide it.
fn certain_sign(by: [f64; 2], f: [f64; 2], e: [f64; 2]) -> i8 {
    let terms = [by[0] * f[0], by[1] * f[1]];
    let size = terms[0].abs() + terms[1].abs();
    let err = (by[0].abs() * e[0] + by[1].abs() * e[1] + 2.0 * U * size) * (1.0 + 8.0 * U);
    let value = terms[0] + terms[1];
    i8::from(value > err) - i8::from(value < -err)
}

/// How often a closed curve in the plane turns around the origin, by the signs of its points'
/// coordinates, 0 where they are unknown: the number of times that it crosses the positive half of
/// the first axis. `None` if it may pass through the origin.
fn turns(signs: &[[i8; 2]]) -> Option<i32> {
    let begin = signs.iter().position(|[_, y]| *y != 0)?;
    let (mut last, mut turns) = (signs[begin], 0);
    // The sign of the first coordinate since the second one was last known.
    let mut side = last[0];
    for k in 1..=signs.len() {
        let [x, y] = signs[(begin + k) % signs.len()];
        if y == last[1] {
            (last, side) = ([x, y], x);
            continue;
        }
        // Between here and `last` the curve crosses the first axis, or may do so.
        if x == 0 || x != side {
            return None;
        }
        if y != 0 {
            turns += i32::from(x > 0) * i32::from(y);
            last = [x, y];
        }
    }
    Some(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_of_polygons_around_the_origin() {
        let circle = [[1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1]];
        assert_eq!(turns(&circle), Some(1));
        let mut back = circle;
        back.reverse();
        assert_eq!(turns(&back), Some(-1));
        assert_eq!(turns(&[circle, circle].concat()), Some(2));
        // Beside the origin, and past it both ways.
        assert_eq!(turns(&[[1, -1], [1, 1], [1, 0], [1, -1]]), Some(0));
        assert_eq!(turns(&[[-1, -1], [-1, 1], [0, 1], [1, 1], [0, 1]]), None);
        assert_eq!(turns(&[[1, 1], [0, 0], [-1, 1]]), None);
        assert_eq!(turns(&[[1, 0], [1, 0]]), None);
    }
}

//! Outlines of prisms: closed polygons in a plane, and the side of each edge on which the inside
//! lies.

use super::PrismError;
use core::cmp::Ordering;
use durer_math::{Dyadic, U};

/// A point of the base plane, by its x and z.
pub(super) type Point = [f64; 2];

/// With more edges the sides are not computed: the time grows with the square of their number.
const MOST_EDGES: usize = 4096;

/// The outlines without repeated points.
pub(super) fn cleaned(outlines: &[impl AsRef<[Point]>]) -> Result<Vec<Vec<Point>>, PrismError> {
    if outlines.is_empty() {
        return Err(PrismError::Empty);
    }
    let clean = |(outline, points): (usize, &[Point])| {
        if let Some(&[x, z]) = points.iter().find(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(PrismError::Point { x, z });
        }
        let mut points = points.to_vec();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            return Err(PrismError::TooShort { outline, len: points.len() });
        }
        Ok(points)
    };
    outlines.iter().map(AsRef::as_ref).enumerate().map(clean).collect()
}

/// The edges of all outlines.
pub(super) fn edges(outlines: &[Vec<Point>]) -> Vec<[Point; 2]> {
    let around = |points: &Vec<Point>| {
        let next = points.iter().skip(1).chain(points.first()).copied().collect::<Vec<_>>();
        points.iter().copied().zip(next).map(|(a, b)| [a, b]).collect::<Vec<_>>()
    };
    outlines.iter().flat_map(around).collect()
}

/// For each edge, whether the inside (where outlines go round an odd number of times) lies to its
/// left, with x to the right and z up. `None` if that may change along an edge, because edges meet
/// at other points than their ends.
pub(super) fn inside_is_left(edges: &[[Point; 2]]) -> Option<Vec<bool>> {
    if edges.len() > MOST_EDGES {
        return None;
    }
    for (i, e) in edges.iter().enumerate() {
        if edges[..i].iter().any(|f| meet_within(e, f)) {
            return None;
        }
    }
    Some((0..edges.len()).map(|i| left_of(edges, i)).collect())
}

/// The sign of `(b - a) x (c - a)`, exactly.
fn turn(a: Point, b: Point, c: Point) -> Ordering {
    let (left, right) = ((b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0]));
    let value = left - right;
    // Two roundings of differences and one of the product on each side, and one of the result;
    // subnormal products are computed exactly.
    if value.abs() > 8.0 * U * (left.abs() + right.abs()) + f64::MIN_POSITIVE {
        return if value > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    let from_a = |p: Point, i: usize| Dyadic::from(p[i]) - Dyadic::from(a[i]);
    (from_a(b, 0) * from_a(c, 1) - from_a(b, 1) * from_a(c, 0)).exact_sign()
}

/// Whether two edges have a point in common that is not an end of both.
fn meet_within(e: &[Point; 2], f: &[Point; 2]) -> bool {
    let apart =
        |k: usize| e[0][k].max(e[1][k]) < f[0][k].min(f[1][k]) || f[0][k].max(f[1][k]) < e[0][k].min(e[1][k]);
    if apart(0) || apart(1) {
        return false;
    }
    let sides =
        [turn(e[0], e[1], f[0]), turn(e[0], e[1], f[1]), turn(f[0], f[1], e[0]), turn(f[0], f[1], e[1])];
    if sides[0] == sides[1] && sides[0].is_ne() || sides[2] == sides[3] && sides[2].is_ne() {
        return false;
    }
    let shared = e.iter().filter(|p| f.contains(p)).count();
    if sides.iter().all(|s| s.is_eq()) {
        // On one line: they overlap, unless they only touch at one end of each, on opposite sides
        // of it.
        let Some(&at) = e.iter().find(|p| f.contains(p)) else { return overlaps(e, f) };
        let other = |edge: &[Point; 2]| if edge[0] == at { edge[1] } else { edge[0] };
        return shared == 2 || same_way(at, other(e), other(f));
    }
    shared == 0
}

/// Whether two edges on one line, without a common end, have points in common.
fn overlaps(e: &[Point; 2], f: &[Point; 2]) -> bool {
    (0..2)
        .all(|k| e[0][k].max(e[1][k]) >= f[0][k].min(f[1][k]) && f[0][k].max(f[1][k]) >= e[0][k].min(e[1][k]))
}

/// Whether two points on one line through `at` lie on one side of it.
fn same_way(at: Point, p: Point, q: Point) -> bool {
    (0..2).all(|k| p[k].partial_cmp(&at[k]) == q[k].partial_cmp(&at[k]))
}

/// The parity of crossings along a half-line that starts just beside the middle of an edge, along x
/// (along z for an edge along x), decides whether that side is inside.
fn left_of(edges: &[[Point; 2]], i: usize) -> bool {
    let [a, b] = edges[i];
    // The coordinate along the half-line, and the one across.
    let (along, across) = if a[1] == b[1] { (1, 0) } else { (0, 1) };
    let twice = |k: usize| Dyadic::from(a[k]) + Dyadic::from(b[k]);
    let level = twice(across);
    let above = |p: Point| Dyadic::from(p[across]) + Dyadic::from(p[across]) > level;
    let mut odd = false;
    for (j, &[p, q]) in edges.iter().enumerate() {
        if j == i || above(p) == above(q) {
            continue;
        }
        // The edge crosses the half-line's line; it is ahead of the middle if the middle lies on
        // its lesser side.
        let (low, high) = if above(q) { (p, q) } else { (q, p) };
        let at = |p: Point, k: usize| Dyadic::from(p[k]) + Dyadic::from(p[k]);
        let rise = at(high, across) - at(low, across);
        let run = at(high, along) - at(low, along);
        let ahead = (at(low, along) - twice(along)) * rise + run * (level.clone() - at(low, across));
        odd ^= ahead.exact_sign().is_gt();
    }
    // A half-line along x starts to the left of the edge if the edge goes down; one along z, if the
    // edge goes to the right.
    let looks_left = if along == 0 { b[1] < a[1] } else { b[0] > a[0] };
    odd == looks_left
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(outlines: &[Vec<Point>]) -> Option<Vec<bool>> {
        inside_is_left(&edges(&cleaned(outlines).unwrap()))
    }

    #[test]
    fn the_inside_of_a_ring_is_between_its_outlines() {
        let square = |r: f64| vec![[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]];
        // Counter-clockwise: the inside is left of the outer outline, right of the inner one, left
        // of the innermost.
        let found = sides(&[square(3.0), square(2.0), square(1.0)]).unwrap();
        assert_eq!(found, [[true; 4], [false; 4], [true; 4]].concat());
        let turned: Vec<_> = square(2.0).into_iter().rev().collect();
        let found = sides(&[square(3.0), turned]).unwrap();
        assert_eq!(found, [true; 8]);
    }

    #[test]
    fn edges_that_cross_touch_or_overlap_are_noticed() {
        let square = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let moved = |by: Point| square.iter().map(|p| [p[0] + by[0], p[1] + by[1]]).collect::<Vec<_>>();
        assert_eq!(sides(&[square.clone(), moved([2.0, 2.0])]), None, "crossing");
        assert_eq!(sides(&[square.clone(), moved([4.0, 2.0])]), None, "overlapping in part");
        assert_eq!(sides(&[square.clone(), moved([4.0, 0.0])]), None, "a common edge");
        assert_eq!(
            sides(&[square.clone(), vec![[2.0, 0.0], [1.0, -2.0], [3.0, -2.0]]]),
            None,
            "a vertex on an edge"
        );
        assert!(sides(&[square.clone(), moved([4.0, 4.0])]).is_some(), "a common vertex");
        assert!(sides(&[square.clone(), moved([4.0_f64.next_up(), 0.0])]).is_some(), "an ulp apart");
        assert_eq!(sides(&[vec![[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]]), None, "a bow tie");
        assert_eq!(sides(&[vec![[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, 3.0]]]), None, "back on itself");
    }

    #[test]
    fn bad_outlines_are_named() {
        assert_eq!(cleaned(&[] as &[Vec<Point>]), Err(PrismError::Empty));
        let two = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
        assert_eq!(cleaned(&[two]), Err(PrismError::TooShort { outline: 0, len: 2 }));
        let far = vec![[0.0, 0.0], [f64::INFINITY, 0.0], [1.0, 1.0]];
        assert_eq!(cleaned(&[far]), Err(PrismError::Point { x: f64::INFINITY, z: 0.0 }));
    }
}

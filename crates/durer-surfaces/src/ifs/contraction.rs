//! Which maps contract, and what holds their copies.

use durer_math::eft::scale2;
use durer_math::rounding::{add_down, add_up, mul_up, sub_down, sub_up};
use durer_math::{Aabb, Affine, Dyadic, Point3, Ring, Vec3};

/// `limit^2 I - L^T L`, exactly.
fn room(map: &Affine, limit: f64) -> [[Dyadic; 3]; 3] {
    let l = map.linear().map(|row| row.map(Dyadic::from));
    let limit = Dyadic::from(limit).square();
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let sum = (0..3).fold(Dyadic::ZERO, |sum, k| &sum + &(&l[k][i] * &l[k][j]));
            if i == j { &limit - &sum } else { -sum }
        })
    })
}

/// Whether the largest singular value is below `limit`: whether all leading minors of `limit^2 I -
/// L^T L` are positive (J. J. Sylvester), exactly.
fn is_below(map: &Affine, limit: f64) -> bool {
    let m = room(map, limit);
    let minor = |a: usize, b: usize, c: usize, d: usize| &(&m[a][b] * &m[c][d]) - &(&m[a][d] * &m[c][b]);
    let first = &m[0][0];
    let second = minor(0, 0, 1, 1);
    let third = &(&(&m[0][0] * &minor(1, 1, 2, 2)) - &(&m[0][1] * &minor(1, 0, 2, 2)))
        + &(&m[0][2] * &minor(1, 0, 2, 1));
    first.exact_sign().is_gt() && second.exact_sign().is_gt() && third.exact_sign().is_gt()
}

/// Whether a map's largest singular value is below 1, exactly.
pub(super) fn contracts(map: &Affine) -> bool {
    is_below(map, 1.0)
}

/// The largest singular value, rounded: the largest eigenvalue of `L^T L` by rotations (C. G. J.
/// Jacobi, *Crelle's Journal* 30, 1846).
pub(super) fn singular_value(map: &Affine) -> f64 {
    let l = map.linear();
    // To unit size, so that squares neither overflow nor vanish.
    let k = durer_math::eft::exponent(l.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs())));
    let l = l.map(|row| row.map(|x| scale2(x, -k)));
    let mut a = [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| l[k][i] * l[k][j]).sum::<f64>()));
    // Each round squares what is left off the diagonal.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + theta.mul_add(theta, 1.0).sqrt());
            let c = 1.0 / t.mul_add(t, 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (first, second) = (a[p], a[q]);
            a[p] = [0, 1, 2].map(|k| c * first[k] - s * second[k]);
            a[q] = [0, 1, 2].map(|k| s * first[k] + c * second[k]);
        }
    }
    scale2(a[0][0].max(a[1][1]).max(a[2][2]).sqrt(), k)
}

/// An upper bound on a contraction's largest singular value: the rounded one with a margin, if it
/// is proven, else 1.
fn singular_bound(map: &Affine) -> f64 {
    const MARGIN: f64 = 1.0 + durer_math::scale::pow2(-40);
    let guess = singular_value(map) * MARGIN;
    if guess < 1.0 && is_below(map, guess) { guess } else { 1.0 }
}

/// A bound on the distance of two points.
fn distance_up(a: Point3, b: Point3) -> f64 {
    Aabb::new(b, b).reach_from(a)
}

/// Boxes that hold the copies of a leaf under all products of 0, 1, ... `depth` maps.
///
/// Each is the box of the images of the one before, and no larger than a ball about a point `p`,
/// whose radius becomes `max_i |M_i p - p| + s_i r` (Hart and DeFanti).
pub(super) fn node_bounds(leaf: Aabb, maps: &[Affine], depth: u32) -> Vec<Aabb> {
    let singular: Vec<f64> = maps.iter().map(singular_bound).collect();
    let mut about = leaf.centre();
    let mut boxes: Vec<Aabb> = vec![];
    // A better middle makes a smaller ball.
    for _ in 0..3 {
        let mut radius = leaf.reach_from(about);
        let mut next = vec![leaf];
        for k in 0..depth as usize {
            let (from, mut to) = (next[k], Aabb::EMPTY);
            let mut grown = 0.0_f64;
            for (map, &s) in maps.iter().zip(&singular) {
                to = to.union(map.bounds(&from));
                let image = map.bounds(&Aabb::new(about, about));
                let away = distance_up(about, image.min).max(distance_up(about, image.max));
                let away = away.max(image.reach_from(about));
                grown = grown.max(add_up(away, mul_up(s, radius)));
            }
            radius = grown;
            let ball = Aabb::centred(about, Vec3::ZERO).expanded(Vec3::new(radius, radius, radius));
            to = to.intersection(ball);
            if let Some(known) = boxes.get(k + 1) {
                to = to.intersection(*known);
            }
            next.push(to);
        }
        boxes = next;
        about = boxes[depth as usize].centre();
    }
    boxes
}

/// A box relative to a centre, in units of `2^scale`, rounded outward.
pub(super) fn seen_from(b: &Aabb, centre: Point3, scale: i32) -> Aabb {
    let unit = |x: f64| scale2(x, -scale);
    let tiny = super::frame::TINY;
    let low = |i: usize| {
        add_down(unit(sub_down(b.min[i], centre[i])), if b.min[i] == centre[i] { 0.0 } else { -tiny })
    };
    let high =
        |i: usize| add_up(unit(sub_up(b.max[i], centre[i])), if b.max[i] == centre[i] { 0.0 } else { tiny });
    Aabb::new(Point3::new(low(0), low(1), low(2)), Point3::new(high(0), high(1), high(2)))
}

//! Applies a placement to a shape's own numbers, if that is exact.
//!
//! The exact surface is `{ c + L x }` with the numbers of the text and the stored map. If each new
//! number is *exactly* the image of the old one, the folded shape is the same set and needs no
//! inverse map. Sums and products are checked by their error terms.

use durer_math::eft::{two_prod, two_sum};
use durer_math::{Affine, Point3, Vec3};

/// Magnitudes whose products cannot overflow and whose error terms cannot underflow.
const SAFE: core::ops::Range<f64> = 1e-140..1e140;

fn is_safe(x: f64) -> bool {
    x == 0.0 || SAFE.contains(&x.abs())
}

/// `a + b`, if the sum is exact.
pub(super) fn sum(a: f64, b: f64) -> Option<f64> {
    let (s, e) = two_sum(a, b);
    (e == 0.0 && s.is_finite()).then_some(s)
}

/// `a b`, if the product is exact.
pub(super) fn product(a: f64, b: f64) -> Option<f64> {
    let (p, e) = two_prod(a, b);
    (is_safe(a) && is_safe(b) && e == 0.0).then_some(p)
}

/// The image of a vector, if every step is exact.
pub(super) fn vector(map: &Affine, v: Vec3) -> Option<Vec3> {
    let row = |r: [f64; 3]| {
        let [x, y, z] = [product(r[0], v.x)?, product(r[1], v.y)?, product(r[2], v.z)?];
        sum(sum(x, y)?, z)
    };
    let [a, b, c] = map.linear();
    Some(Vec3::new(row(a)?, row(b)?, row(c)?))
}

/// The image of a point, if every step is exact.
pub(super) fn point(map: &Affine, p: Point3) -> Option<Point3> {
    let (v, c) = (vector(map, p.to_vec())?, map.centre());
    Some(Point3::new(sum(v.x, c.x)?, sum(v.y, c.y)?, sum(v.z, c.z)?))
}

/// The image of a length under a uniform scale or a translation, if every step is exact.
pub(super) fn length(map: &Affine, l: f64) -> Option<f64> {
    if map.as_translation().is_some() {
        return Some(l);
    }
    product(map.as_uniform_scale()?, l)
}

/// Whether the map keeps the directions of the axes.
pub(super) fn is_diagonal(map: &Affine) -> bool {
    let l = map.linear();
    (0..3).all(|i| (0..3).all(|j| i == j || l[i][j] == 0.0))
}

/// The axis to which a map takes the axis `of`, and the scale, if the map takes axes to axes (in
/// either direction) and scales uniformly.
pub(super) fn axis(map: &Affine, of: usize) -> Option<(usize, f64)> {
    let l = map.linear();
    let (mut image, mut size) = (None, None);
    for (i, row) in l.iter().enumerate() {
        let mut entries = row.iter().enumerate().filter(|(_, x)| **x != 0.0);
        let (j, x) = entries.next()?;
        if entries.next().is_some() || size.is_some_and(|s: f64| s != x.abs()) {
            return None;
        }
        size = Some(x.abs());
        if j == of {
            image = Some(i);
        }
    }
    // An invertible matrix has a nonzero entry in each column.
    Some((image?, size?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounds_is_not_folded() {
        assert_eq!(sum(1.0, 0.5), Some(1.5));
        assert_eq!(sum(1.0, 1e-20), None);
        assert_eq!(sum(0.1, 0.2), None);
        assert_eq!(product(3.0, 0.5), Some(1.5));
        assert_eq!(product(0.1, 0.1), None);
        assert_eq!(product(1e-200, 0.5), None);
    }

    #[test]
    fn quarter_turns_of_small_numbers_are_exact() {
        let turn =
            Affine::new([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]], Point3::new(1.0, 2.0, 3.0));
        let image = point(&turn.unwrap(), Point3::new(0.25, 0.5, 8.0));
        assert_eq!(image, Some(Point3::new(9.0, 2.5, 2.75)));
        let third = Affine::rotation_y(1.0).unwrap();
        assert_eq!(point(&third, Point3::new(0.1, 0.0, 0.3)), None);
    }

    #[test]
    fn axes_go_to_axes_under_quarter_turns_only() {
        let turn =
            Affine::new([[0.0, 0.0, 2.0], [-2.0, 0.0, 0.0], [0.0, -2.0, 0.0]], Point3::ORIGIN).unwrap();
        assert_eq!([0, 1, 2].map(|i| axis(&turn, i)), [Some((1, 2.0)), Some((2, 2.0)), Some((0, 2.0))]);
        assert_eq!(axis(&Affine::scaling(2.0, 2.0, 1.0).unwrap(), 1), None);
        assert_eq!(axis(&Affine::rotation_x(0.5).unwrap(), 1), None);
    }

    #[test]
    fn lengths_need_the_same_scale_everywhere() {
        let even = Affine::scaling(2.0, 2.0, 2.0).unwrap();
        assert_eq!(length(&even, 0.3), Some(0.6));
        assert_eq!(length(&Affine::scaling(2.0, 2.0, 1.0).unwrap(), 0.3), None);
        assert!(is_diagonal(&even) && !is_diagonal(&Affine::rotation_x(0.5).unwrap()));
    }
}

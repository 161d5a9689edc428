//! Square columns along y in four colours.

use super::cells::cell;
use durer_math::Point3;

/// The kind of the square that contains a point: by whether its x and its z are odd.
pub(super) fn kind(p: Point3) -> usize {
    let is_odd = |x: f64| {
        let half = cell(x) * 0.5;
        half != crate::vector::floor(half)
    };
    match (is_odd(p.x), is_odd(p.z)) {
        (false, false) => 0,
        (false, true) => 1,
        (true, true) => 2,
        (true, false) => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_squares_go_around() {
        let at = |x, z| kind(Point3::new(x, 0.0, z));
        assert_eq!([at(0.5, 0.5), at(0.5, 1.5), at(1.5, 1.5), at(1.5, 0.5)], [0, 1, 2, 3]);
        assert_eq!([at(-1.5, 0.5), at(-0.5, 0.5), at(0.5, -1.5)], [0, 3, 0]);
    }
}

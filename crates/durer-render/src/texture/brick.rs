//! Bricks: courses along y, every other one shifted by half a brick.

use super::cells::{cell, cell_lanes};
use crate::vector::floor_lanes;
use durer_math::{F8, M8, Point3, Vec3};

/// The dimensions of the bricks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Brick {
    /// The reciprocal of the size of a brick with its mortar.
    per: Vec3,
    /// Where mortar begins in each unit.
    start: Vec3,
}

impl Brick {
    pub(super) fn new(size: Vec3, mortar: f64) -> Self {
        Self { per: size.map(|s| 1.0 / s), start: size.map(|s| (s - mortar) / s) }
    }

    /// 0 in mortar, which is at the end of each unit along each axis; 1 in brick.
    pub(super) fn kind(&self, p: Point3) -> usize {
        let part = |x: f64| x - cell(x);
        let y = p.y * self.per.y;
        let even = {
            let half = cell(y) * 0.5;
            half == crate::vector::floor(half)
        };
        // Even courses are shifted along z, odd ones along x.
        let x = p.x * self.per.x + if even { 0.0 } else { 0.5 };
        let z = p.z * self.per.z + if even { 0.5 } else { 0.0 };
        let mortar = part(y) >= self.start.y || part(x) >= self.start.x || part(z) >= self.start.z;
        usize::from(!mortar)
    }

    /// The lanes where the kind is 1.
    #[inline(always)]
    pub(super) fn brick_lanes(&self, p: Point3<F8>) -> M8 {
        let y = p.y * self.per.y;
        let half = cell_lanes(y) * 0.5;
        let even = half.equals(floor_lanes(half));
        let half_brick = F8::splat(0.5);
        let x = p.x * self.per.x + (!even).keep(half_brick);
        let z = p.z * self.per.z + even.keep(half_brick);
        !(in_mortar(y, self.start.y) | in_mortar(x, self.start.x) | in_mortar(z, self.start.z))
    }
}

/// The lanes where `x` is in mortar, which begins at `start` in each unit.
#[inline(always)]
fn in_mortar(x: F8, start: f64) -> M8 {
    (F8::splat(start)).le(x - cell_lanes(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_and_bricks() {
        let wall = Brick::new(Vec3::new(8.0, 3.0, 4.5), 0.5);
        let at = |x, y, z| wall.kind(Point3::new(x, y, z));
        assert_eq!(at(4.0, 1.5, 2.0), 0);
        assert_eq!([at(4.0, 1.5, 0.6), at(4.0, 3.7, 2.0)], [1, 1]);
        assert_eq!([at(7.4, 1.0, 0.0), at(7.6, 1.0, 0.0)], [1, 0]);
        assert_eq!([at(1.0, 2.4, 0.0), at(1.0, 2.6, 0.0)], [1, 0]);
        // The second course is shifted by 4 along x.
        assert_eq!([at(3.4, 4.0, 1.0), at(3.6, 4.0, 1.0), at(7.6, 4.0, 1.0)], [1, 0, 1]);
    }
}

//! Where in a node a ray's near and far planes begin on each axis, which depends on its octant.

use crate::node::WIDTH;

/// The size of a row of [`Node::planes`](crate::node::Node::planes), in bytes.
const ROW: usize = size_of::<f32>() * WIDTH;

/// Offsets in bytes from the beginning of [`Node::planes`](crate::node::Node::planes). Each is the
/// beginning of one of its six rows, as only [`Planes::of`] makes them.
#[derive(Clone, Copy)]
pub(super) struct Planes {
    near: [usize; 3],
    far: [usize; 3],
}

static TABLE: [[[u16; 3]; 2]; 8] = {
    const ROW16: u16 = ROW as u16;
    let mut table = [[[0, ROW16, 2 * ROW16], [3 * ROW16, 4 * ROW16, 5 * ROW16]]; 8];
    let mut octant = 0;
    while octant < 8 {
        let mut axis = 0;
        while axis < 3 {
            if octant >> axis & 1 == 1 {
                (table[octant][0][axis], table[octant][1][axis]) =
                    (table[octant][1][axis], table[octant][0][axis]);
            }
            axis += 1;
        }
        octant += 1;
    }
    table
};

impl Planes {
    /// The offsets for rays of an octant.
    #[inline(always)]
    pub(super) fn of(octant: usize) -> Self {
        let [near, far] = &TABLE[octant & 7];
        let three = |at: &[u16; 3]| [usize::from(at[0]), usize::from(at[1]), usize::from(at[2])];
        Self { near: three(near), far: three(far) }
    }

    #[inline(always)]
    pub(super) fn near(&self) -> [usize; 3] {
        self.near
    }

    #[inline(always)]
    pub(super) fn far(&self) -> [usize; 3] {
        self.far
    }

    /// The number of the row that begins at this offset.
    #[inline(always)]
    pub(super) fn row(begins: usize) -> usize {
        begins / ROW % 6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_planes_are_low_where_the_ray_rises() {
        for octant in 0..8 {
            let planes = Planes::of(octant);
            for axis in 0..3 {
                let falls = octant >> axis & 1;
                assert_eq!(Planes::row(planes.near()[axis]), axis + 3 * falls);
                assert_eq!(Planes::row(planes.far()[axis]), axis + 3 * (1 - falls));
                assert_eq!((planes.near()[axis] % ROW, planes.far()[axis] % ROW), (0, 0));
            }
        }
    }
}

//! Which leaves does a shaft meet?

use crate::batch::each;
use crate::kernels::MAX_DEPTH;
use crate::node::{ChildRef, Leaf, Node, WIDTH};
use crate::tree::Bvh;
use arrayvec::ArrayVec;
use durer_math::scale::pow2;
use durer_math::{F8, Isa, Point3, Shaft, Shaft8, U, Vec3};

impl Bvh {
    /// Passes the leaves that a bundle of rays may meet to `visit`, in no particular order, until
    /// it returns true; returns whether it did. Every leaf that a ray of the bundle meets is
    /// visited; an entry in several leaves may be visited several times.
    pub fn in_shaft(&self, isa: Isa, shaft: &Shaft, mut visit: impl FnMut(Leaf) -> bool) -> bool {
        if self.is_empty() {
            return false;
        }
        let lanes = shaft.lanes();
        // Two factors, as the unit of a tree may exceed the range of one f64.
        let exponent = self.frame.units().outward_exponent();
        let units = [pow2(exponent / 2), pow2(exponent - exponent / 2)];
        let centre = self.frame.is_moved().then(|| self.frame.centre());
        let mut waiting = ArrayVec::<ChildRef, { MAX_DEPTH * WIDTH }>::new();
        waiting.push(ChildRef::node(0));
        while let Some(child) = waiting.pop() {
            if child.is_leaf() {
                if self.leaves(child, &mut visit) {
                    return true;
                }
                continue;
            }
            let node = &self.nodes[child.index()];
            for slot in each(node.in_shaft(isa, &lanes, units, centre)) {
                waiting.push(node.child[slot]);
            }
        }
        false
    }
}

impl Node {
    /// The mask of children that a bundle may meet. Lengths are to be multiplied by both units.
    #[inline(never)]
    fn in_shaft(&self, isa: Isa, shaft: &Shaft8, units: [f64; 2], centre: Option<Point3>) -> u32 {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let [x0, y0, z0, x1, y1, z1] = &self.planes;
                let mut met = 0;
                for half in 0..WIDTH / 8 {
                    let mut min =
                        Vec3::new(wide(x0, half, units), wide(y0, half, units), wide(z0, half, units));
                    let mut max =
                        Vec3::new(wide(x1, half, units), wide(y1, half, units), wide(z1, half, units));
                    // The planes of an empty slot are in the wrong order.
                    let is_there = min.x.le(max.x);
                    if let Some(centre) = centre {
                        (min, max) = from_origin(&min, &max, centre);
                    }
                    met |= u32::from((is_there & shaft.may_meet(&min, &max)).bits()) << (8 * half);
                }
                met
            },
        )
    }
}

/// Planes in the caller's units, as f64.
#[inline(always)]
fn wide(planes: &[f32; WIDTH], half: usize, [first, second]: [f64; 2]) -> F8 {
    let planes = core::array::from_fn(
        #[inline(always)]
        |slot| f64::from(planes[8 * half + slot]),
    );
    F8(planes) * first * second
}

/// Boxes whose corners are relative to `centre`, in the caller's units.
///
/// A sum rounds by `U |x + c|`, and so does the subtraction of the slack from it; `4 U (|x| + |c|)`
/// is more than both and the rounding of the slack.
#[inline(always)]
fn from_origin(min: &Vec3<F8>, max: &Vec3<F8>, centre: Point3) -> (Vec3<F8>, Vec3<F8>) {
    let slack = F8::splat(4.0 * U);
    let low = |x: F8, c: F8| (x + c) - (x.abs() + c.abs()) * slack;
    let high = |x: F8, c: F8| (x + c) + (x.abs() + c.abs()) * slack;
    let c = Vec3::<F8>::splat(centre.to_vec());
    (
        Vec3::new(low(min.x, c.x), low(min.y, c.y), low(min.z, c.z)),
        Vec3::new(high(max.x, c.x), high(max.y, c.y), high(max.z, c.z)),
    )
}

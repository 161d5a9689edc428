//! The definition.

use super::{Kernel, Stack};
use crate::node::{Node8, WIDTH};
use crate::ray::CullRay;

/// One lane after the other; fused, or for CPUs without fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar<const FUSED: bool>;

/// Each child's entry, and which are met.
pub(crate) struct Slabs {
    pub(crate) near: [f32; WIDTH],
    pub(crate) met: [bool; WIDTH],
}

/// The greater; the second if neither is (`maxps`).
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser; the second if neither is (`minps`).
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl<const FUSED: bool> Scalar<FUSED> {
    /// Slabs: enter at the last near plane, leave at the first far plane.
    #[inline(always)]
    pub(crate) fn slabs(self, node: &Node8, ray: &CullRay, t_far: f32) -> Slabs {
        let at = |plane: f32, r: f32, c: f32| if FUSED { plane.mul_add(r, c) } else { plane * r + c };
        let side =
            |axis: usize| if ray.octant >> axis & 1 == 0 { (axis, axis + 3) } else { (axis + 3, axis) };
        let [(nx, fx), (ny, fy), (nz, fz)] = [side(0), side(1), side(2)];
        let mut slabs = Slabs { near: [0.0; WIDTH], met: [false; WIDTH] };
        for i in 0..WIDTH {
            let near = |plane: usize, axis: usize| at(node.planes[plane][i], ray.r[axis], ray.near[axis]);
            let far = |plane: usize, axis: usize| at(node.planes[plane][i], ray.r[axis], ray.far[axis]);
            let enter = max(max(near(nx, 0), near(ny, 1)), max(near(nz, 2), 0.0));
            let leave = min(min(far(fx, 0), far(fy, 1)), min(far(fz, 2), t_far));
            slabs.near[i] = enter;
            slabs.met[i] = enter <= leave;
        }
        slabs
    }
}

impl<const FUSED: bool> Kernel for Scalar<FUSED> {
    type Lanes = CullRay;

    #[inline(always)]
    fn lanes(self, ray: &CullRay) -> CullRay {
        *ray
    }

    #[inline(always)]
    fn push_ordered(self, node: &Node8, ray: &CullRay, t_far: f32, stack: &mut Stack) {
        let slabs = self.slabs(node, ray, t_far);
        for word in node.order {
            let i = (word >> (3 * ray.octant) & 7) as usize;
            if slabs.met[i] {
                stack.push(node.child[i], slabs.near[i]);
            }
        }
    }

    #[inline(always)]
    fn push_unordered(self, node: &Node8, ray: &CullRay, t_far: f32, stack: &mut Stack) {
        let slabs = self.slabs(node, ray, t_far);
        for i in 0..WIDTH {
            if slabs.met[i] {
                stack.push(node.child[i], slabs.near[i]);
            }
        }
    }
}

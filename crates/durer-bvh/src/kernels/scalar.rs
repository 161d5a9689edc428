//! The scalar kernel, which defines the results of all kernels.

use super::{Kernel, Stack};
use crate::node::{ChildRef, Node, SLOT_BITS, WIDTH};
use crate::ray::{ClippedRay, CullRay, Packet32, Rounding, TreeRay};
use crate::tree::Bvh;
use crate::triangles::{Block, FAR, FLAT, Filter, LANES, NEAR, Verdict};

/// One lane after the other; fused, or for CPUs without fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar<const FUSED: bool>;

/// The entry parameter of each child, and which children are met.
pub(crate) struct Slabs {
    pub(crate) near: [f32; WIDTH],
    pub(crate) met: [bool; WIDTH],
}

/// The greater number; the second if they are equal or one is NaN (`maxps`).
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser number; the second if they are equal or one is NaN (`minps`).
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl<const FUSED: bool> Scalar<FUSED> {
    /// The slab test: the ray enters a box at the last near plane and leaves it at the first far
    /// plane.
    #[inline(always)]
    pub(crate) fn slabs(self, node: &Node, ray: &CullRay, t_far: f32) -> Slabs {
        let at = |plane: f32, r: f32, c: f32| if FUSED { plane.mul_add(r, c) } else { plane * r + c };
        let side =
            |axis: usize| if ray.octant >> axis & 1 == 0 { (axis, axis + 3) } else { (axis + 3, axis) };
        let [(nx, fx), (ny, fy), (nz, fz)] = [side(0), side(1), side(2)];
        let mut slabs = Slabs { near: [0.0; WIDTH], met: [false; WIDTH] };
        for i in 0..WIDTH {
            let near = |plane: usize, axis: usize| at(node.planes[plane][i], ray.r[axis], ray.near[axis]);
            let far = |plane: usize, axis: usize| at(node.planes[plane][i], ray.r[axis], ray.far[axis]);
            let enter = max(max(near(nx, 0), near(ny, 1)), max(near(nz, 2), ray.way.t_near));
            let leave = min(min(far(fx, 0), far(fy, 1)), min(far(fz, 2), t_far));
            slabs.near[i] = enter;
            slabs.met[i] = enter <= leave;
        }
        slabs
    }
}

/// A packet that does not exist.
pub(crate) enum NoPacket {}

/// Implements [`Together`] for a kernel that has no packets of this size.
macro_rules! no_packets {
    ([$($of:tt)*] $kernel:ty, $n:tt) => {
        impl<$($of)*> $crate::kernels::Together<$n> for $kernel {
            type Packet = $crate::kernels::scalar::NoPacket;
            type Filters = $crate::kernels::scalar::NoPacket;

            const EXISTS: bool = false;

            #[inline(always)]
            fn gather(self, _: &Bvh, _: &[&Packet32]) -> Option<Self::Packet> {
                None
            }

            #[inline(always)]
            fn ends(self, packet: &Self::Packet) -> [f32; $n] {
                match *packet {}
            }

            #[inline(always)]
            fn one(self, _: &Bvh, packet: &Self::Packet, _: usize) -> (Self::Ray, ClippedRay) {
                match *packet {}
            }

            #[inline(always)]
            fn way(self, _: &Bvh, packet: &Self::Packet, _: usize) -> ClippedRay {
                match *packet {}
            }

            #[inline(always)]
            fn awake(self, _: &[f32; $n], _: &[f32; $n]) -> u32 {
                0
            }

            #[inline(always)]
            fn filters(self, _: &Bvh, packet: &Self::Packet) -> Self::Filters {
                match *packet {}
            }

            #[inline(always)]
            fn judge_together(
                self,
                _: &Block,
                filters: &Self::Filters,
                _: u32,
                _: &[f32; $n],
                _: &mut [Verdict; $n],
            ) -> u32 {
                match *filters {}
            }

            #[inline(always)]
            fn descend_together<const ORDERED: bool>(
                self,
                _: &Node,
                packet: &Self::Packet,
                _: &[f32; $n],
                _: (&[f32; $n], f32),
                _: &mut $crate::kernels::Rows<$n>,
            ) {
                match *packet {}
            }
        }
    };
}
pub(super) use no_packets;

// With one lane a packet gains nothing.
no_packets!([const FUSED: bool, const N: usize] Scalar<FUSED>, N);

impl<const FUSED: bool> Kernel for Scalar<FUSED> {
    type Ray = CullRay;
    type Lanes = CullRay;

    #[inline(always)]
    fn nearby(self, _: &Bvh, _: &impl TreeRay) -> Option<(CullRay, ClippedRay)> {
        None
    }

    #[inline(always)]
    fn afar(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(CullRay, ClippedRay)> {
        let ray =
            tree.cull(&tree.local_line(sight), if FUSED { Rounding::Fused } else { Rounding::Unfused })?;
        Some((ray, ray.way))
    }

    #[inline(always)]
    fn spread(self, ray: &CullRay) -> CullRay {
        *ray
    }

    #[inline(always)]
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        ray: &CullRay,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef {
        let slabs = self.slabs(node, ray, t_far);
        for i in 0..WIDTH {
            let i = if ORDERED { (node.order[i] >> (SLOT_BITS * ray.octant)) as usize % WIDTH } else { i };
            if slabs.met[i] {
                stack.push(node.child[i], slabs.near[i]);
            }
        }
        stack.pop()
    }

    #[inline(always)]
    fn meets(self, node: &Node, slot: usize, ray: &CullRay, t_far: f32) -> bool {
        self.slabs(node, ray, t_far).met[slot]
    }

    #[inline(always)]
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict {
        let fma = |a: f32, b: f32, c: f32| if FUSED { a.mul_add(b, c) } else { a * b + c };
        let dot = |a: &[f32; 3], b: &[f32; 3]| fma(a[2], b[2], fma(a[1], b[1], a[0] * b[0]));
        let cross = |a: &[f32; 3], b: &[f32; 3]| {
            let minor = |i: usize, j: usize| fma(a[i], b[j], -(a[j] * b[i]));
            [minor(1, 2), minor(2, 0), minor(0, 1)]
        };
        let size = block.size();
        let square = size * size;
        let slack = fma(size, fma(filter.b, size, filter.a), filter.g);
        let nearby = fma(NEAR, size, filter.p);
        let certain = fma(4.0, slack, fma(filter.flat, square, FLAT));
        let ([o @ .., _], [d @ .., _]) = (filter.o, filter.d);
        let mut verdict = Verdict::NOTHING;
        for i in 0..LANES {
            let row = |r: usize| [block.rows[r][i], block.rows[r + 1][i], block.rows[r + 2][i]];
            let (v, v1, v2) = (row(0), row(3), row(6));
            let minus = |a: &[f32; 3], b: &[f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            let (c, e1, e2) = (minus(&v, &o), minus(&v1, &v), minus(&v2, &v));
            let (r, n) = (cross(&c, &d), cross(&e1, &e2));
            let (u, v) = (dot(&r, &e2), -dot(&r, &e1));
            let along = dot(&d, &n);
            let w = (along - u) - v;
            let (least, most) = (min(min(u, v), w), max(max(u, v), w));
            let possible = least >= -slack || most <= slack;
            if !possible {
                continue;
            }
            let inverse = 1.0 / along;
            let t = dot(&c, &n) * inverse;
            let length = |e: &[f32; 3]| e[0].abs() + e[1].abs() + e[2].abs();
            let spread = inverse.abs() * (length(&e1) * length(&e2));
            let far = fma(filter.q, t.abs(), nearby) * spread;
            let tau = far + fma(FAR, t.abs(), filter.s);
            let known = along.abs() > certain;
            let (lo, hi) = if known { (t - tau, t + tau) } else { (f32::NEG_INFINITY, f32::INFINITY) };
            let alive = hi >= filter.t_near && lo <= t_far;
            let sure = known && (least > slack || most < -slack) && lo >= filter.first && hi <= filter.last;
            verdict.alive |= u32::from(alive) << i;
            verdict.sure |= u32::from(alive && sure) << i;
            (verdict.lo[i], verdict.hi[i]) = (lo, hi);
        }
        verdict
    }

    #[inline(never)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }

    #[inline(never)]
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }

    #[inline(always)]
    fn fetch(self, _: &Bvh, _: ChildRef) {}
}

//! The kernel for AVX2 and FMA: eight lanes; nodes and blocks are tested in two halves.
#![expect(unsafe_code, reason = "vector loads and stores, and functions compiled for CPU features")]

mod blocks;
mod node;
mod setup;

pub(super) use blocks::{edges, judge_halves};
pub(super) use node::{Numbers, slabs};
pub(super) use setup::{OUTWARD, SLACK};

use super::packet8::{self, Filters, Packet};
use super::scalar::no_packets;
use super::{Kernel, Rows, Stack, Together};
use crate::node::{ChildRef, Node};
use crate::ray::{ClippedRay, CullRay, PACKET, Packet32, Rounding, TWICE, TreeRay};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, Verdict};
use blocks::judge;
use core::arch::x86_64::*;
use durer_math::kernels::Path;
use durer_math::{Isa, Vec3};
use node::{Lanes, descend, meets};
use setup::{Clipped, clip, nearby};

/// Proof that this CPU has all features of [`Path::Avx2`]: AVX2, FMA, BMI1 and 2, LZCNT and POPCNT.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// The kernel, if `isa` proves the features.
    #[inline(always)]
    pub(crate) fn of(isa: Isa) -> Option<Self> {
        matches!(isa.path(), Path::Avx2 | Path::Avx512).then_some(Self(()))
    }

    #[inline(always)]
    fn clipped(self, tree: &Bvh, sight: &impl TreeRay) -> Option<CullRay> {
        self.apart(
            #[inline(always)]
            || {
                let line = tree.local_line(sight);
                if line.origin_error != Vec3::ZERO || line.direction_error != Vec3::ZERO {
                    return tree.cull(&line, Rounding::Fused);
                }
                // SAFETY: as below.
                match unsafe { clip(tree, &line) } {
                    Clipped::Missed => None,
                    Clipped::Enters(ray) => Some(ray),
                    Clipped::Unusual => tree.cull(&line, Rounding::Fused),
                }
            },
        )
    }
}

impl Kernel for Avx2 {
    type Ray = Numbers;
    type Lanes = Lanes;

    #[inline(always)]
    fn nearby(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Numbers, ClippedRay)> {
        // SAFETY: as below.
        unsafe { nearby(tree, &tree.glance(sight)) }
    }

    #[inline(always)]
    fn afar(self, tree: &Bvh, sight: &impl TreeRay) -> Option<(Numbers, ClippedRay)> {
        let ray = self.clipped(tree, sight)?;
        Some((Numbers::of(&ray), ray.way))
    }

    #[inline(always)]
    fn spread(self, ray: &Numbers) -> Lanes {
        // SAFETY: as below.
        unsafe { Lanes::of(ray) }
    }

    #[inline(always)]
    fn descend<const ORDERED: bool>(
        self,
        node: &Node,
        lanes: &Lanes,
        t_far: f32,
        stack: &mut Stack,
    ) -> ChildRef {
        // SAFETY: as above.
        unsafe { descend::<ORDERED>(node, lanes, t_far, stack) }
    }

    #[inline(always)]
    fn meets(self, node: &Node, slot: usize, lanes: &Lanes, t_far: f32) -> bool {
        // SAFETY: as above.
        unsafe { meets(node, slot, lanes, t_far) }
    }

    #[inline(always)]
    fn judge(self, block: &Block, filter: &Filter, t_far: f32) -> Verdict {
        // SAFETY: as above.
        unsafe { judge(block, filter, t_far) }
    }

    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        // SAFETY: as above.
        unsafe { apart(f) }
    }

    #[inline(always)]
    fn apart_in_lanes<R>(self, f: impl FnOnce() -> R) -> R {
        self.apart(f)
    }

    #[inline(always)]
    fn fetch(self, tree: &Bvh, child: ChildRef) {
        let place = tree.place(child);
        for line in 0..size_of::<Block>() / 64 {
            // SAFETY: a prefetch has no effect that the program can observe, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(place.wrapping_add(64 * line).cast()) };
        }
    }
}

impl Together<PACKET> for Avx2 {
    type Packet = Packet;
    type Filters = Filters;

    #[inline(always)]
    fn gather(self, tree: &Bvh, rays: &[&Packet32]) -> Option<Packet> {
        let [rays] = rays else { return None };
        // SAFETY: as above.
        unsafe { packet8::gather(tree, rays) }
    }

    #[inline(always)]
    fn ends(self, packet: &Packet) -> [f32; PACKET] {
        // SAFETY: as above.
        unsafe { packet.ends() }
    }

    #[inline(always)]
    fn one(self, tree: &Bvh, packet: &Packet, ray: usize) -> (Numbers, ClippedRay) {
        // SAFETY: as above.
        unsafe { (packet.numbers(ray), packet.way(tree, ray)) }
    }

    #[inline(always)]
    fn way(self, tree: &Bvh, packet: &Packet, ray: usize) -> ClippedRay {
        // SAFETY: as above.
        unsafe { packet.way(tree, ray) }
    }

    #[inline(always)]
    fn awake(self, row: &[f32; PACKET], t_far: &[f32; PACKET]) -> u32 {
        // SAFETY: as above.
        unsafe { packet8::awake(row, t_far) }
    }

    #[inline(always)]
    fn filters(self, tree: &Bvh, packet: &Packet) -> Filters {
        // SAFETY: as above.
        unsafe { packet.filters(tree.rounded) }
    }

    #[inline(always)]
    fn judge_together(
        self,
        block: &Block,
        filters: &Filters,
        awake: u32,
        t_far: &[f32; PACKET],
        verdicts: &mut [Verdict; PACKET],
    ) -> u32 {
        // SAFETY: as above.
        unsafe { packet8::judge(block, filters, awake, t_far, verdicts) }
    }

    #[inline(always)]
    fn descend_together<const ORDERED: bool>(
        self,
        node: &Node,
        packet: &Packet,
        row: &[f32; PACKET],
        (t_far, far): (&[f32; PACKET], f32),
        rows: &mut Rows<PACKET>,
    ) {
        // SAFETY: as above.
        unsafe { packet8::descend::<ORDERED>(node, packet, row, (t_far, far), rows) }
    }
}

// Sixteen rays in two vectors would be as much work as two packets of eight.
no_packets!([] Avx2, TWICE);

#[inline(never)]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn apart<R>(f: impl FnOnce() -> R) -> R {
    f()
}

//! Packet kernels of solids `g < 0` whose `g` is not a polynomial. Each of eight rays advances at
//! its own pace.
//!
//! ```text
//!   g(o + s d) for eight lines:  its sign on a segment, whether it rises or falls there,
//!                                its value at a point
//! ```
//!
//! The answers of an [`ImplicitKernel`] for a segment hold for the exact ray: they include its
//! rounding error. A ray whose sign is known passes a segment on which `g` keeps that sign: because
//! `g` has one sign there, or moves away from zero, or moves towards zero and has kept its sign at
//! the end. If the sign has changed by the end of a segment on which `g` is monotonic, the segment
//! holds exactly one crossing, a simple one, and it is the first. Rounded values narrow it down,
//! and two certain signs on either side prove it (`rays.rs`).
//!
//! Rays of many packets change lanes on the way, so that no lane is idle while rays remain
//! (`compaction.rs`).
//!
//! A segment on which nothing is certain is tried again at a shorter length. A ray that is not
//! finished after a fixed number of segments is a doubt, and so is one whose sign rounding leaves
//! open.

mod compaction;
mod container;
mod rays;

pub(super) use self::compaction::Stream;

use super::closest::PacketQuery;
use super::crossings::Crossings;
use super::kernel::{FacePoints, KernelRays, KernelScratch, PacketKernel};
use super::local_frame::{Own, largest};
use super::rays::{Nearest, SLACK};
use super::skin::{Skin, Slant};
use core::slice;
use durer_math::{F8, Isa, M8, U, Vec3};
use std::sync::Arc;

/// Eight lines `o + s d` in the solid's own coordinates, relative to their closest approach to its
/// centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line8 {
    pub(crate) isa: Isa,
    pub(crate) o: Vec3<F8>,
    /// Of length 1, up to rounding.
    pub(crate) d: Vec3<F8>,
    /// The errors of each coordinate of `o` and of `d`.
    pub(crate) e_o: F8,
    pub(crate) e_d: F8,
}

/// The part of each line that may meet the solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineExtent8 {
    /// The start of the part.
    pub(crate) from: F8,
    /// Its end.
    pub(crate) to: F8,
    /// Lines whose part is unknown.
    pub(crate) unsure: M8,
}

/// How a solid ends where a line leaves the region in which it is described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Everything beyond is outside.
    Free,
    /// The container's faces cut the solid and close it.
    Capped,
    /// The container's faces cut the solid and leave it open.
    Open,
}

/// The certain properties of `g` on one segment of each line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment8 {
    /// The lanes to classify, and those of them that were classified.
    pub(crate) lanes: M8,
    pub(crate) seen: M8,
    /// The start of the segment.
    pub(crate) a: F8,
    /// Its end. The kernel may move `b`, and may move both on as far as `g` keeps its sign.
    pub(crate) b: F8,
    /// The end of the line's part.
    pub(crate) last: F8,
    /// Lanes where `g` is positive, or negative, on the whole segment.
    pub(crate) out: M8,
    pub(crate) within: M8,
    /// Lanes where `g` strictly rises, or falls.
    pub(crate) rises: M8,
    pub(crate) falls: M8,
    /// The sign of `g` at `a`, 1 or -1.
    pub(crate) sign: F8,
    /// A number that the kernel may keep for each line: infinite at first, and `next` once a
    /// segment is passed.
    pub(crate) hint: F8,
    /// The value of `hint` after this segment; infinite unless the kernel sets it.
    pub(crate) next: F8,
}

/// `g` at a point of each line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value8 {
    /// Rounded.
    pub(crate) g: F8,
    /// Lanes where `g` is certainly positive, or negative.
    pub(crate) above: M8,
    pub(crate) below: M8,
}

/// The kernel of a solid `g < 0`.
pub(crate) trait ImplicitKernel: core::fmt::Debug + Send + Sync {
    /// A bound on the distance of the solid's points from the centre.
    fn reach(&self) -> f64;
    /// How the solid ends. The filter of a solid in a container includes the container's faces
    /// (`FilterSource::contained`), and the kernel must describe the solid up to `slack` beyond
    /// them.
    fn ends(&self) -> (Ends, f64) {
        (Ends::Free, 0.0)
    }
    /// Computes the part of each line that may meet the solid.
    fn part(&self, line: &Line8, part: &mut LineExtent8);
    /// Classifies a segment of each line.
    fn classify(&self, line: &Line8, told: &mut Segment8);
    /// Computes the values at `s`; only the lanes in `lanes` matter.
    fn values(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8);
    /// Computes `g` at `s`, rounded, NaN if it is unknown. Root refinement uses it and needs no
    /// bounds. Only the lanes in `lanes` matter.
    fn about(&self, line: &Line8, s: &F8, lanes: M8, g: &mut F8);
    /// Computes `g` and half its gradient at points, rounded as in [`ImplicitKernel::about`].
    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        let mut skin = Skin::NONE;
        self.skin(isa, (y, &F8::ZERO), &mut skin);
        *slant = Slant { f: skin.f, half: skin.half };
    }
    /// Computes `g` and half its gradient at points known within `e` along any axis, and a bound on
    /// its second derivatives in the region where rays start.
    fn skin(&self, isa: Isa, at: (&Vec3<F8>, &F8), skin: &mut Skin);
    /// Computes the covectors for shading. Returns false if these are the surface's own.
    fn shading(&self, _isa: Isa, _y: &Vec3<F8>, _g: &mut Vec3<F8>) -> bool {
        false
    }
}

/// A solid that is classified segment by segment, as a packet kernel.
#[derive(Clone, Debug)]
pub(crate) struct Segments(pub(crate) Arc<dyn ImplicitKernel>);

impl PacketKernel for Segments {
    fn face_of(&self, number: u32) -> u32 {
        number
    }

    fn is_contained(&self) -> bool {
        self.0.ends().0 != Ends::Free
    }

    fn is_operand(&self) -> bool {
        false
    }

    fn segments(&self) -> Option<&dyn ImplicitKernel> {
        Some(&*self.0)
    }

    fn first(
        &self,
        &KernelRays { own, leaving, start, cell, .. }: &KernelRays<'_>,
        query: &PacketQuery<'_>,
        nearest: &mut Nearest,
        scratch: &mut KernelScratch,
    ) {
        let stream: &mut Stream = scratch.of();
        let turned = leaving.is_some_and(|(_, turned)| turned);
        stream.clear();
        stream.add(0, (&*self.0, own, turned), query, (start, cell), nearest);
        stream.meet(&*self.0, slice::from_ref(query), slice::from_mut(nearest));
    }

    fn crossings(&self, seen: &KernelRays<'_>, to: &mut Crossings, _scratch: &mut KernelScratch) {
        to.doubt_from(*seen.rays.live, F8::ZERO);
    }

    fn holds(&self, _: &KernelRays<'_>, _: (F8, F8), _: u8, _: &mut KernelScratch) -> (u8, u8) {
        (0, 0)
    }

    fn skin(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Skin) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let y = own.point(at.h);
                // For rays that start there, the kernel begins at a place that may be this far from
                // the start (`rays.rs`).
                let e = own.point_error(at.h1) + (largest(y) + self.0.reach()) * (128.0 * U);
                self.0.skin(isa, (&y, &e), to);
                let e_half = (to.e_half + largest(to.half) * (16.0 * U)) * own.norm;
                let bend = to.bend * (own.norm * own.norm * SLACK);
                // Doubled, so that rays that start there are certain of their side.
                let e_f = to.e_f * 2.0;
                let room = to.room * (1.0 / own.norm);
                *to = Skin { f: to.f, half: own.covector(to.half), e_f, e_half, bend, room };
            },
        );
    }

    fn slant(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Slant) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.0.slant(isa, &own.point(at.h), to);
                to.half = own.covector(to.half);
            },
        );
    }

    fn shading(&self, isa: Isa, own: &Own, h: &mut Vec3<F8>) -> bool {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let y = own.point(*h);
                let differs = self.0.shading(isa, &y, h);
                *h = own.covector(*h);
                differs
            },
        )
    }
}

impl Line8 {
    /// The points at `s`.
    #[inline(always)]
    pub(crate) fn point(&self, s: F8) -> Vec3<F8> {
        super::local_frame::on(self.o, s, self.d)
    }

    /// A bound on the errors of these points along any axis, for `|s|` up to `far`.
    #[inline(always)]
    pub(crate) fn error(&self, far: F8) -> F8 {
        far.mul_add(self.e_d, self.e_o) + (largest(self.o) + far) * (4.0 * U)
    }
}

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

use super::local_frame::{Own, largest};
use super::rays::SLACK;
use super::revolution::{Skin, Slant};
use durer_math::{F8, Isa, M8, U, Vec3};

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

impl Skin {
    const NONE: Self = Self {
        f: F8::ZERO,
        half: Vec3::splat(Vec3::ZERO),
        e_f: F8::ZERO,
        e_half: F8::ZERO,
        bend: F8::ZERO,
        room: F8::ZERO,
    };
}

/// The value and half the gradient at points `h`, rounded.
#[inline(always)]
pub(super) fn slant(level: &dyn ImplicitKernel, isa: Isa, own: &Own, h: Vec3<F8>) -> Slant {
    let mut slant = Slant { f: F8::ZERO, half: h };
    level.slant(isa, &own.point(h), &mut slant);
    Slant { half: own.covector(slant.half), ..slant }
}

/// `g` and half its gradient at points `h` of the surface, with `|h|₁`.
#[inline(always)]
pub(super) fn skin(level: &dyn ImplicitKernel, isa: Isa, own: &Own, h: Vec3<F8>, h1: F8) -> Skin {
    let y = own.point(h);
    // For rays that start there, the kernel begins at a place that may be this far from the start
    // (`rays.rs`).
    let e = own.point_error(h1) + (largest(y) + level.reach()) * (128.0 * U);
    let mut skin = Skin::NONE;
    level.skin(isa, (&y, &e), &mut skin);
    let Skin { f, half, e_f, e_half, bend, room } = skin;
    let e_half = (e_half + largest(half) * (16.0 * U)) * own.norm;
    let bend = bend * (own.norm * own.norm * SLACK);
    // Doubled, so that rays that start there are certain of their side.
    Skin { f, half: own.covector(half), e_f: e_f * 2.0, e_half, bend, room: room * (1.0 / own.norm) }
}

/// The covectors for shading at points `h`, if they differ from the surface's own.
#[inline(always)]
pub(super) fn shading(level: &dyn ImplicitKernel, isa: Isa, own: &Own, h: Vec3<F8>) -> Option<Vec3<F8>> {
    let y = own.point(h);
    let mut g = y;
    level.shading(isa, &y, &mut g).then(|| own.covector(g))
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

//! Solids `g < 0` as lanes see them whose `g` is no polynomial: each of eight rays goes ahead at
//! its own pace.
//!
//! ```text
//!   g(o + s d) for eight lines at once:  its sign on a stretch, whether it rises or falls there, its value at a point
//! ```
//!
//! What a [`Level`] says of a stretch is certain, of the exact ray: it knows how far lines are off.
//! A ray whose sign is known goes on over stretches on which `g` keeps it: because it has one sign
//! there, or goes away from zero, or goes towards zero and has kept its sign at the end. Where it
//! has changed by the end of a stretch on which `g` only goes one way there is exactly one
//! crossing, a simple one, and it is the first. It is closed in by rounded values, and proven by
//! two certain signs around it (`rays.rs`).
//!
//! Rays of many eights change their lanes on the way, so that none is empty as long as there are
//! any (`compaction.rs`).
//!
//! A stretch of which nothing is certain is tried again shorter. What is left after so many
//! stretches, or where rounding leaves a sign open, is a doubt.

mod compaction;
mod container;
mod rays;

pub(super) use self::compaction::Stream;

use super::local_frame::{Own, largest};
use super::rays::SLACK;
use super::revolution::{Skin, Slant};
use durer_math::{F8, Isa, M8, U, Vec3};

/// Eight lines in the solid's own coordinates, `o + s d`, about where they are closest to its
/// centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line8 {
    pub(crate) isa: Isa,
    pub(crate) o: Vec3<F8>,
    /// Of length 1, about.
    pub(crate) d: Vec3<F8>,
    /// How far each coordinate of `o` and of `d` may be off.
    pub(crate) e_o: F8,
    pub(crate) e_d: F8,
}

/// The part of each line that may be in the solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineExtent8 {
    /// From here...
    pub(crate) from: F8,
    /// ...to here.
    pub(crate) to: F8,
    /// Lines of which that cannot be said.
    pub(crate) unsure: M8,
}

/// What is where a line leaves the part of space that a solid is told in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// All is outside there.
    Free,
    /// A container's face cuts off what is inside, and closes the solid.
    Capped,
    /// It cuts that off, and leaves it open.
    Open,
}

/// What is certain of `g` on a stretch of each line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment8 {
    /// The lanes that are asked, and those of them that were looked at.
    pub(crate) lanes: M8,
    pub(crate) seen: M8,
    /// From here...
    pub(crate) a: F8,
    /// ...to here; whoever is asked may move it, and move both on as far as `g` keeps its sign.
    pub(crate) b: F8,
    /// Here it ends.
    pub(crate) last: F8,
    /// Where `g` is positive, or negative, on all of it.
    pub(crate) out: M8,
    pub(crate) within: M8,
    /// Where it strictly rises, or falls.
    pub(crate) rises: M8,
    pub(crate) falls: M8,
    /// The sign of `g` at `a`, 1 or -1.
    pub(crate) sign: F8,
    /// For whoever is asked to remember of each line: infinite at first, and `next` once a stretch
    /// is passed.
    pub(crate) hint: F8,
    /// What `hint` is after this stretch; infinite if nobody sets it.
    pub(crate) next: F8,
}

/// `g` at a point of each line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value8 {
    /// Rounded.
    pub(crate) g: F8,
    /// Where it is certainly positive, or negative.
    pub(crate) above: M8,
    pub(crate) below: M8,
}

/// A solid `g < 0`.
pub(crate) trait ImplicitKernel: core::fmt::Debug + Send + Sync {
    /// A bound on the distance from the centre of what is in the solid.
    fn reach(&self) -> f64;
    /// What is where it ends: a solid in a container comes with that one's faces
    /// (`FilterSource::contained`), and is told a bit beyond them, by `slack`.
    fn ends(&self) -> (Ends, f64) {
        (Ends::Free, 0.0)
    }
    /// Where lines may meet it.
    fn part(&self, line: &Line8, part: &mut LineExtent8);
    /// Tells what is certain of a stretch of each line.
    fn classify(&self, line: &Line8, told: &mut Segment8);
    /// The values at `s`; only those of some lanes matter.
    fn values(&self, line: &Line8, s: &F8, lanes: M8, value: &mut Value8);
    /// `g` at `s`, rounded, NaN where that is not known: for closing in, which needs no bounds.
    /// Only some lanes matter.
    fn about(&self, line: &Line8, s: &F8, lanes: M8, g: &mut F8);
    /// `g` and half its gradient at points, rounded, as [`Level::about`] is.
    fn slant(&self, isa: Isa, y: &Vec3<F8>, slant: &mut Slant) {
        let mut skin = Skin::NONE;
        self.skin(isa, (y, &F8::ZERO), &mut skin);
        *slant = Slant { f: skin.f, half: skin.half };
    }
    /// `g` and its gradient at points known within `e` along any axis, and a bound on its second
    /// derivatives as far around as rays start.
    fn skin(&self, isa: Isa, at: (&Vec3<F8>, &F8), skin: &mut Skin);
    /// The covectors that points are shaded by, if those are others.
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

/// What is at points `h` of the surface, with `|h|₁`.
#[inline(always)]
pub(super) fn skin(level: &dyn ImplicitKernel, isa: Isa, own: &Own, h: Vec3<F8>, h1: F8) -> Skin {
    let y = own.point(h);
    // Rays that start there are looked at from a place that may be this far from it (`rays.rs`).
    let e = own.point_error(h1) + (largest(y) + level.reach()) * (128.0 * U);
    let mut skin = Skin::NONE;
    level.skin(isa, (&y, &e), &mut skin);
    let Skin { f, half, e_f, e_half, bend, room } = skin;
    let e_half = (e_half + largest(half) * (16.0 * U)) * own.norm;
    let bend = bend * (own.norm * own.norm * SLACK);
    // Twice, so that rays from there are certain of their side.
    Skin { f, half: own.covector(half), e_f: e_f * 2.0, e_half, bend, room: room * (1.0 / own.norm) }
}

/// The covectors that points `h` are shaded by, if those are not those of the surface.
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

    /// How far those may be off along any axis, for `|s|` up to `far`.
    #[inline(always)]
    pub(crate) fn error(&self, far: F8) -> F8 {
        far.mul_add(self.e_d, self.e_o) + (largest(self.o) + far) * (4.0 * U)
    }
}

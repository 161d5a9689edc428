//! Packet kernels: surfaces that are not faces of degree two, in coordinates of their own.
//!
//! Each kernel stands beside its surface (`revolution/packet/`, `prism/packet/`, `blob/packet/`,
//! `algebraic/packet/`, and `implicit/` here for solids that are classified segment by segment).
//! A filter knows it as a [`PacketKernel`].

use super::closest::PacketQuery;
use super::convex::Hull;
use super::crossings::Crossings;
use super::implicit::ImplicitKernel;
use super::local_frame::{Own, OwnSketch};
use super::quadric::Start;
use super::rays::{From8, Nearest, RayLanes};
use super::sink::{First, Sink8};
use super::skin::{Skin, Slant};
use crate::faces::form::Form;
use core::any::{Any, TypeId};
use core::fmt::Debug;
use durer_math::{Dd, EFloat, F8, Isa, Point3, Vec3};
use std::sync::Arc;

/// Eight rays before a surface: what every kernel starts from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KernelRays<'a> {
    /// The surface's own coordinates.
    pub(crate) own: &'a Own,
    pub(crate) rays: &'a RayLanes<'a>,
    /// Rays that start on the surface, and whether the surface is turned.
    pub(crate) leaving: Option<(&'a From8, bool)>,
    pub(crate) start: &'a Start,
    /// The convex cell that clips or contains the surface.
    pub(crate) cell: Option<&'a Hull>,
}

/// Points of a face: its number, the tag that [`Nearest`] stores, the points relative to the
/// filter's centre, and upper bounds of their `|h|₁`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacePoints {
    pub(crate) face: usize,
    pub(crate) tag: F8,
    pub(crate) h: Vec3<F8>,
    pub(crate) h1: F8,
}

/// A surface for eight rays at a time, in its own coordinates.
///
/// Answers of a kernel are certain; where rounding leaves something open it reports a doubt, and
/// the ray is tested against the surface itself. Calls go through a table of functions, so each
/// method enters the instruction set of its rays by itself.
pub(crate) trait PacketKernel: Debug + Send + Sync {
    /// The `Root::face` of the face with this number.
    fn face_of(&self, number: u32) -> u32;

    /// Whether the surface is unbounded except for what clips it.
    fn is_unbounded(&self) -> bool {
        false
    }

    /// Whether the surface lies in a container with faces of its own. These are numbered after the
    /// surface's own face.
    fn is_contained(&self) -> bool {
        false
    }

    /// Whether the kernel finds all crossings, and the side of points.
    fn is_operand(&self) -> bool {
        true
    }

    /// The kernel that classifies segments, if it is one: several packets are then advanced
    /// together.
    fn segments(&self) -> Option<&dyn ImplicitKernel> {
        None
    }

    /// Passes the first crossing of each ray, and the doubts, to `nearest`; of an unbounded or
    /// contained surface, the first one inside the cell.
    fn first(
        &self,
        seen: &KernelRays<'_>,
        query: &PacketQuery<'_>,
        nearest: &mut Nearest,
        scratch: &mut KernelScratch,
    );

    /// Stores all crossings of a solid; of an unbounded one, those inside the cell.
    fn crossings(&self, seen: &KernelRays<'_>, to: &mut Crossings, scratch: &mut KernelScratch);

    /// For the `asked` rays, as bit masks: points at `t`, known within `e`, that are certainly
    /// inside the solid, and those that are certainly outside.
    fn holds(&self, seen: &KernelRays<'_>, at: (F8, F8), asked: u8, scratch: &mut KernelScratch) -> (u8, u8);

    /// `f`, half its gradient and their errors at points of a face.
    fn skin(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Skin);

    /// `f` and half its gradient, rounded, near a face.
    fn slant(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Slant);

    /// Replaces points by covectors for shading there. Returns false if these are the surface's
    /// own.
    fn shading(&self, _isa: Isa, _own: &Own, _h: &mut Vec3<F8>) -> bool {
        false
    }
}

/// A kernel that finds the first crossings and all crossings by the same steps and passes them to
/// any sink: that of surfaces of revolution, of blobs and of polynomials. So it is a
/// [`PacketKernel`].
pub(crate) trait SinkKernel: Debug + Send + Sync {
    /// Working memory.
    type Scratch: Any + Default + Send + Sync;

    /// See [`PacketKernel::face_of`].
    fn face_of(&self, _number: u32) -> u32 {
        0
    }

    /// See [`PacketKernel::is_unbounded`].
    fn is_unbounded(&self) -> bool {
        false
    }

    /// See [`PacketKernel::is_operand`].
    fn is_operand(&self) -> bool {
        true
    }

    /// Passes the crossings of each ray, or only the first one of each face, and the doubts to `to`.
    fn pass<K: Sink8>(&self, seen: &KernelRays<'_>, to: &mut K, scratch: &mut Self::Scratch);

    /// See [`PacketKernel::holds`], for all rays.
    fn sides(&self, seen: &KernelRays<'_>, at: (F8, F8)) -> (u8, u8);

    /// See [`PacketKernel::skin`], within the rays' instruction set.
    fn points(&self, own: &Own, at: &FacePoints) -> Skin;
}

impl<T: SinkKernel> PacketKernel for T {
    fn face_of(&self, number: u32) -> u32 {
        SinkKernel::face_of(self, number)
    }

    fn is_unbounded(&self) -> bool {
        SinkKernel::is_unbounded(self)
    }

    fn is_operand(&self) -> bool {
        SinkKernel::is_operand(self)
    }

    fn first(
        &self,
        seen: &KernelRays<'_>,
        query: &PacketQuery<'_>,
        nearest: &mut Nearest,
        scratch: &mut KernelScratch,
    ) {
        self.pass(seen, &mut query.first(nearest), scratch.of());
    }

    fn crossings(&self, seen: &KernelRays<'_>, to: &mut Crossings, scratch: &mut KernelScratch) {
        self.pass(seen, to, scratch.of());
    }

    fn holds(&self, seen: &KernelRays<'_>, at: (F8, F8), _asked: u8, _: &mut KernelScratch) -> (u8, u8) {
        self.sides(seen, at)
    }

    fn skin(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Skin) {
        isa.run_in_lanes(
            #[inline(always)]
            || *to = self.points(own, at),
        );
    }

    fn slant(&self, isa: Isa, own: &Own, at: &FacePoints, to: &mut Slant) {
        isa.run_in_lanes(
            #[inline(always)]
            || *to = Slant::of(&self.points(own, at)),
        );
    }
}

/// The kernel and its coordinates before rounding.
#[derive(Clone, Debug)]
pub(super) struct DetailSketch {
    own: OwnSketch,
    kernel: Arc<dyn PacketKernel>,
}

/// The kernel and its coordinates, rounded to f64.
#[derive(Clone, Debug)]
pub(super) struct Detail {
    pub(super) own: Own,
    pub(super) kernel: Arc<dyn PacketKernel>,
}

/// Working memory of kernels: one value of each type that a kernel has used, the last one in front.
#[derive(Debug, Default)]
pub(crate) struct KernelScratch(Vec<(TypeId, Box<dyn Any + Send + Sync>)>);

impl KernelScratch {
    /// The value of this type. It is kept between calls.
    #[inline]
    pub(crate) fn of<T: Any + Default + Send + Sync>(&mut self) -> &mut T {
        let id = TypeId::of::<T>();
        if self.0.first().is_none_or(|(front, _)| *front != id) {
            self.bring_to_front(id, || Box::new(T::default()));
        }
        match self.0[0].1.downcast_mut() {
            Some(value) => value,
            None => unreachable!("the value in front has this type"),
        }
    }

    #[cold]
    #[inline(never)]
    fn bring_to_front(&mut self, id: TypeId, new: fn() -> Box<dyn Any + Send + Sync>) {
        let place = self.0.iter().position(|(other, _)| *other == id).unwrap_or_else(|| {
            self.0.push((id, new()));
            self.0.len() - 1
        });
        self.0.swap(0, place);
    }
}

impl DetailSketch {
    /// A kernel for coordinates in units of `2^scale` about `origin`; see [`OwnSketch::new`].
    pub(super) fn new(
        kernel: Arc<dyn PacketKernel>,
        centre: Point3,
        origin: Point3,
        scale: i32,
        order: [usize; 3],
    ) -> Self {
        Self { own: OwnSketch::new(centre, origin, scale, order), kernel }
    }

    /// See [`PacketKernel::is_unbounded`].
    pub(super) fn is_unbounded(&self) -> bool {
        self.kernel.is_unbounded()
    }

    /// See [`OwnSketch::moved`].
    pub(super) fn moved(self, det: EFloat<Dd>, moved: impl Fn(Form<EFloat<Dd>>) -> Form<EFloat<Dd>>) -> Self {
        Self { own: self.own.moved(det, moved), ..self }
    }

    pub(super) fn round(&self) -> Option<Detail> {
        Some(Detail { own: self.own.round()?, kernel: self.kernel.clone() })
    }
}

impl Detail {
    /// See [`PacketKernel::is_contained`].
    pub(super) fn is_contained(&self) -> bool {
        self.kernel.is_contained()
    }

    /// See [`PacketKernel::first`]. `turned` is whether the surface is turned.
    pub(super) fn first(
        &self,
        (query, turned): (&PacketQuery<'_>, bool),
        nearest: &mut Nearest,
        (start, cell): (&Start, Option<&Hull>),
        scratch: &mut KernelScratch,
    ) {
        let leaving = query.from.map(|from| (from, turned));
        let seen = KernelRays { own: &self.own, rays: query.rays, leaving, start, cell };
        self.kernel.first(&seen, query, nearest, scratch);
    }
}

impl<'a> PacketQuery<'a> {
    /// `nearest` as the receiver of this query's crossings.
    pub(crate) fn first<'n>(&self, nearest: &'n mut Nearest) -> First<'n> {
        First { nearest, number: self.number }
    }
}

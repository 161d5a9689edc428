//! Packet kernels: equations of degree above two, in the surface's own coordinates.

use super::PacketFilter;
use super::blob::{self, Fields};
use super::closest::PacketQuery;
use super::convex::Hull;
use super::crossings::Crossings;
use super::implicit::{self, Ends, ImplicitKernel};
use super::local_frame::{Own, OwnSketch};
use super::polynomial::{self, Terms};
use super::prism::{self, Swept};
use super::quadric::Start;
use super::rays::{From8, Nearest, RayLanes};
use super::revolution::{self, RevolutionKernel, Skin, Slant};
use super::sink::{First, Sink8};
use crate::quadric::form::Form;
use core::slice;
use durer_math::{Dd, EFloat, F8, Isa, Point3, Vec3};
use std::sync::Arc;

/// The kinds of packet kernel.
#[derive(Clone, Debug)]
pub(crate) enum PacketKernel {
    /// A surface of revolution.
    Revolution(Arc<RevolutionKernel>),
    /// A part of a swept solid.
    Swept(Arc<Swept>),
    /// The zero set of a polynomial of degree up to four.
    Quartic(Arc<Terms<5>>),
    /// The zero set of a polynomial of degree up to eight.
    Octic(Arc<Terms<9>>),
    /// The zero set of a polynomial of degree up to sixteen.
    High(Arc<Terms<17>>),
    /// A blob.
    Fields(Arc<Fields>),
    /// A solid that is classified segment by segment.
    Level(Arc<dyn ImplicitKernel>),
}

/// The kernel and its coordinates before rounding.
#[derive(Clone, Debug)]
pub(super) struct DetailSketch {
    own: OwnSketch,
    shape: PacketKernel,
}

/// The kernel and its coordinates, rounded to f64.
#[derive(Clone, Debug)]
pub(super) struct Detail {
    own: Own,
    shape: PacketKernel,
}

/// Working memory for one kernel.
#[derive(Debug, Default)]
pub(super) struct KernelScratch {
    lathe: revolution::RevolutionScratch,
    swept: prism::PrismScratch,
    quartic: polynomial::PolynomialScratch<5>,
    octic: polynomial::PolynomialScratch<9>,
    high: polynomial::PolynomialScratch<17>,
    fields: blob::BlobScratch,
    pub(super) level: implicit::Stream,
}

impl DetailSketch {
    /// A surface of revolution; see [`OwnSketch::new`].
    pub(super) fn new(
        shape: PacketKernel,
        centre: Point3,
        origin: Point3,
        scale: i32,
        order: [usize; 3],
    ) -> Self {
        Self { own: OwnSketch::new(centre, origin, scale, order), shape }
    }

    /// Whether the surface is unbounded except for what clips it.
    pub(super) fn is_endless(&self) -> bool {
        self.shape.is_endless()
    }

    /// See [`OwnSketch::moved`].
    pub(super) fn moved(self, det: EFloat<Dd>, moved: impl Fn(Form<EFloat<Dd>>) -> Form<EFloat<Dd>>) -> Self {
        Self { own: self.own.moved(det, moved), ..self }
    }

    pub(super) fn round(&self) -> Option<Detail> {
        Some(Detail { own: self.own.round()?, shape: self.shape.clone() })
    }
}

impl PacketKernel {
    fn is_contained(&self) -> bool {
        matches!(self, Self::Level(level) if level.ends().0 != Ends::Free)
    }

    fn is_endless(&self) -> bool {
        matches!(self, Self::Quartic(_) | Self::Octic(_) | Self::High(_))
    }
}

impl Detail {
    /// Whether the surface lies in a container with faces of its own. These are numbered after the
    /// surface's own face.
    pub(super) fn is_contained(&self) -> bool {
        self.shape.is_contained()
    }

    /// See [`DetailSketch::is_endless`].
    pub(super) fn is_endless(&self) -> bool {
        self.shape.is_endless()
    }

    /// The `Root::face` of the face with this number.
    #[inline]
    pub(super) fn face_of(&self, face: u32) -> u32 {
        match &self.shape {
            PacketKernel::Revolution(lathe) => lathe.name(face),
            PacketKernel::Swept(swept) => swept.face(face),
            PacketKernel::Quartic(_)
            | PacketKernel::Octic(_)
            | PacketKernel::High(_)
            | PacketKernel::Fields(_) => 0,
            PacketKernel::Level(_) => face,
        }
    }

    /// Passes the first crossing of each ray to `nearest`; of an unbounded or contained surface,
    /// the first one inside a convex cell.
    pub(super) fn meet(
        &self,
        (asked, turned): (&PacketQuery<'_>, bool),
        nearest: &mut Nearest,
        (start, cell): (&Start, Option<&Hull>),
        memory: &mut KernelScratch,
    ) {
        if let PacketKernel::Swept(swept) = &self.shape {
            swept.meet(&self.own, asked, start, nearest, &mut memory.swept);
            return;
        }
        if let Some(level) = self.level() {
            memory.level.clear();
            memory.level.add(0, (level, &self.own, turned), asked, (start, cell), nearest);
            memory.level.meet(level, slice::from_ref(asked), slice::from_mut(nearest));
            return;
        }
        let mut to = First { nearest, number: asked.number };
        let leaving = asked.from.map(|from| (from, turned));
        self.show((asked.rays, leaving), (start, cell), &mut to, memory);
    }

    /// The segment-by-segment kernel, if it is one.
    #[inline]
    pub(super) fn level(&self) -> Option<&dyn ImplicitKernel> {
        if let PacketKernel::Level(level) = &self.shape { Some(&**level) } else { None }
    }

    /// The kernel's coordinates.
    pub(super) fn own(&self) -> &Own {
        &self.own
    }

    /// Whether the kernel finds all crossings, and the side of points.
    pub(super) fn is_operand(&self) -> bool {
        match &self.shape {
            PacketKernel::Revolution(lathe) => lathe.faces() <= PacketFilter::FACES,
            PacketKernel::Swept(swept) => swept.is_operand(),
            PacketKernel::Quartic(_)
            | PacketKernel::Octic(_)
            | PacketKernel::High(_)
            | PacketKernel::Fields(_) => true,
            PacketKernel::Level(_) => false,
        }
    }

    /// Stores all crossings of a solid; of an unbounded one, those inside a convex cell.
    pub(super) fn crossings(
        &self,
        rays: (&RayLanes<'_>, Option<(&From8, bool)>),
        (start, cell): (&Start, Option<&Hull>),
        to: &mut Crossings,
        memory: &mut KernelScratch,
    ) {
        if let PacketKernel::Swept(swept) = &self.shape {
            swept.crossings(&self.own, rays, start, to, &mut memory.swept);
            return;
        }
        self.show(rays, (start, cell), to, memory);
    }

    fn show<K: Sink8>(
        &self,
        rays: (&RayLanes<'_>, Option<(&From8, bool)>),
        (start, cell): (&Start, Option<&Hull>),
        to: &mut K,
        memory: &mut KernelScratch,
    ) {
        match &self.shape {
            PacketKernel::Revolution(lathe) => lathe.meet(&self.own, rays, start, to, &mut memory.lathe),
            PacketKernel::Swept(_) | PacketKernel::Level(_) => {}
            PacketKernel::Quartic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.quartic),
            PacketKernel::Octic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.octic),
            PacketKernel::High(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.high),
            PacketKernel::Fields(fields) => fields.meet(&self.own, rays, start, to, &mut memory.fields),
        }
    }

    /// For the `asked` rays, as bit masks: points at `t`, known within `e`, that are certainly
    /// inside the solid, and those that are certainly outside.
    pub(super) fn holds(
        &self,
        rays: &RayLanes<'_>,
        start: &Start,
        (at, asked): ((F8, F8), u8),
        memory: &mut KernelScratch,
    ) -> (u8, u8) {
        match &self.shape {
            PacketKernel::Revolution(lathe) => lathe.holds(&self.own, rays, start, at),
            PacketKernel::Swept(swept) => swept.holds(&self.own, rays, start, (at, asked), &mut memory.swept),
            PacketKernel::Quartic(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::Octic(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::High(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::Fields(fields) => fields.holds(&self.own, rays, start, at),
            PacketKernel::Level(_) => (0, 0),
        }
    }

    /// Rounded data near a face.
    #[inline(always)]
    pub(super) fn slant(&self, isa: Isa, (face, tag): (usize, F8), h: Vec3<F8>, h1: F8) -> Slant {
        match &self.shape {
            PacketKernel::Level(level) => implicit::slant(&**level, isa, &self.own, h),
            _ => {
                let Skin { f, half, .. } = self.skin(isa, (face, tag), h, h1);
                Slant { f, half }
            }
        }
    }

    /// Data at points of a face; `tag` is the one that [`Nearest`] stores for them.
    #[inline(always)]
    pub(super) fn skin(&self, isa: Isa, (face, tag): (usize, F8), h: Vec3<F8>, h1: F8) -> Skin {
        match &self.shape {
            PacketKernel::Revolution(lathe) => lathe.skin(&self.own, face, h, h1),
            PacketKernel::Swept(swept) => swept.spot(&self.own, (face, tag), h, h1),
            PacketKernel::Quartic(f) => f.skin(&self.own, h, h1),
            PacketKernel::Octic(f) => f.skin(&self.own, h, h1),
            PacketKernel::High(f) => f.skin(&self.own, h, h1),
            PacketKernel::Fields(fields) => fields.skin(&self.own, h, h1),
            PacketKernel::Level(level) => implicit::skin(&**level, isa, &self.own, h, h1),
        }
    }

    /// Covectors for shading, if they differ from the surface's own.
    #[inline(always)]
    pub(super) fn shading(&self, isa: Isa, h: Vec3<F8>) -> Option<Vec3<F8>> {
        let PacketKernel::Level(level) = &self.shape else { return None };
        implicit::shading(&**level, isa, &self.own, h)
    }
}

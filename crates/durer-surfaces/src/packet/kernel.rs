//! What lanes know of surfaces whose faces are of a degree above two: an equation in coordinates of the surface's own.

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
use super::revolution::{self, Lathe, Skin, Slant};
use super::sink::{First, Sink8};
use crate::quadric::form::Form;
use core::slice;
use durer_math::{Dd, EFloat, F8, Isa, Point3, Vec3};
use std::sync::Arc;

/// What kind of surface it is.
#[derive(Clone, Debug)]
pub(crate) enum PacketKernel {
    /// A surface of revolution.
    Lathe(Arc<Lathe>),
    /// A part of a swept solid.
    Swept(Arc<Swept>),
    /// The zero set of a polynomial of degree up to four.
    Quartic(Arc<Terms<5>>),
    /// Of degree up to eight.
    Octic(Arc<Terms<9>>),
    /// Of degree up to sixteen.
    High(Arc<Terms<17>>),
    /// A blob.
    Fields(Arc<Fields>),
    /// A solid that is told a stretch at a time.
    Level(Arc<dyn ImplicitKernel>),
}

/// The surface, and its coordinates before they are rounded.
#[derive(Clone, Debug)]
pub(super) struct DetailSketch {
    own: OwnSketch,
    shape: PacketKernel,
}

/// The surface and its coordinates.
#[derive(Clone, Debug)]
pub(super) struct Detail {
    own: Own,
    shape: PacketKernel,
}

/// Memory for one of them on the way.
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

    /// Whether nothing holds the surface but what clips it.
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
    /// Whether it lies in a container with faces of its own, which have the numbers after that of its only face.
    pub(super) fn is_contained(&self) -> bool {
        self.shape.is_contained()
    }

    /// See [`DetailSketch::is_endless`].
    pub(super) fn is_endless(&self) -> bool {
        self.shape.is_endless()
    }

    /// The face of roots on the face that lanes call by a number.
    #[inline]
    pub(super) fn face_of(&self, face: u32) -> u32 {
        match &self.shape {
            PacketKernel::Lathe(lathe) => lathe.name(face),
            PacketKernel::Swept(swept) => swept.face(face),
            PacketKernel::Quartic(_)
            | PacketKernel::Octic(_)
            | PacketKernel::High(_)
            | PacketKernel::Fields(_) => 0,
            PacketKernel::Level(_) => face,
        }
    }

    /// Offers the first crossing of each ray to `nearest`; of an endless surface, and of one in a container, what is within a convex cell.
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

    /// The solid that is told a stretch at a time, if it is one.
    #[inline]
    pub(super) fn level(&self) -> Option<&dyn ImplicitKernel> {
        if let PacketKernel::Level(level) = &self.shape { Some(&**level) } else { None }
    }

    /// Its coordinates.
    pub(super) fn own(&self) -> &Own {
        &self.own
    }

    /// Whether it can tell all crossings, and on which side points are.
    pub(super) fn is_operand(&self) -> bool {
        match &self.shape {
            PacketKernel::Lathe(lathe) => lathe.faces() <= PacketFilter::FACES,
            PacketKernel::Swept(swept) => swept.is_operand(),
            PacketKernel::Quartic(_)
            | PacketKernel::Octic(_)
            | PacketKernel::High(_)
            | PacketKernel::Fields(_) => true,
            PacketKernel::Level(_) => false,
        }
    }

    /// Puts down all crossings of a solid; of an endless one, what is within a convex cell.
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
            PacketKernel::Lathe(lathe) => lathe.meet(&self.own, rays, start, to, &mut memory.lathe),
            PacketKernel::Swept(_) | PacketKernel::Level(_) => {}
            PacketKernel::Quartic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.quartic),
            PacketKernel::Octic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.octic),
            PacketKernel::High(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.high),
            PacketKernel::Fields(fields) => fields.meet(&self.own, rays, start, to, &mut memory.fields),
        }
    }

    /// Which points at `t` within `e` are surely in the solid, and which surely not, of the rays that are `asked` about: as bits.
    pub(super) fn holds(
        &self,
        rays: &RayLanes<'_>,
        start: &Start,
        (at, asked): ((F8, F8), u8),
        memory: &mut KernelScratch,
    ) -> (u8, u8) {
        match &self.shape {
            PacketKernel::Lathe(lathe) => lathe.holds(&self.own, rays, start, at),
            PacketKernel::Swept(swept) => swept.holds(&self.own, rays, start, (at, asked), &mut memory.swept),
            PacketKernel::Quartic(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::Octic(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::High(f) => f.holds(&self.own, rays, start, at),
            PacketKernel::Fields(fields) => fields.holds(&self.own, rays, start, at),
            PacketKernel::Level(_) => (0, 0),
        }
    }

    /// What is next to a face, rounded.
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

    /// What is at points of a face; `tag` is what [`Nearest`] keeps of them.
    #[inline(always)]
    pub(super) fn skin(&self, isa: Isa, (face, tag): (usize, F8), h: Vec3<F8>, h1: F8) -> Skin {
        match &self.shape {
            PacketKernel::Lathe(lathe) => lathe.skin(&self.own, face, h, h1),
            PacketKernel::Swept(swept) => swept.spot(&self.own, (face, tag), h, h1),
            PacketKernel::Quartic(f) => f.skin(&self.own, h, h1),
            PacketKernel::Octic(f) => f.skin(&self.own, h, h1),
            PacketKernel::High(f) => f.skin(&self.own, h, h1),
            PacketKernel::Fields(fields) => fields.skin(&self.own, h, h1),
            PacketKernel::Level(level) => implicit::skin(&**level, isa, &self.own, h, h1),
        }
    }

    /// The covectors that points are shaded by, if those are not those of the surface.
    #[inline(always)]
    pub(super) fn shading(&self, isa: Isa, h: Vec3<F8>) -> Option<Vec3<F8>> {
        let PacketKernel::Level(level) = &self.shape else { return None };
        implicit::shading(&**level, isa, &self.own, h)
    }
}

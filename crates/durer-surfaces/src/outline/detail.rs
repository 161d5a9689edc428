//! What lanes know of surfaces whose faces are of a degree above two: an equation in coordinates of the surface's own.

use super::Outline;
use super::algebraic::{self, Terms};
use super::face::Start;
use super::fields::{self, Fields};
use super::hull::Hull;
use super::lathe::{self, Lathe, Skin, Slant};
use super::level::{self, Ends, Level};
use super::meet::Question;
use super::offer::{First, Offer};
use super::operand::Crossings;
use super::own::{Own, OwnSketch};
use super::rays::{From8, Nearest, RayLanes};
use super::swept::{self, Swept};
use crate::quadric::form::Form;
use core::slice;
use durer_math::{Dd, F8, Isa, Point3, Run, Vec3};
use std::sync::Arc;

/// What kind of surface it is.
#[derive(Clone, Debug)]
pub(crate) enum Kind8 {
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
    Level(Arc<dyn Level>),
}

/// The surface, and its coordinates before they are rounded.
#[derive(Clone, Debug)]
pub(super) struct DetailSketch {
    own: OwnSketch,
    shape: Kind8,
}

/// The surface and its coordinates.
#[derive(Clone, Debug)]
pub(super) struct Detail {
    own: Own,
    shape: Kind8,
}

/// Memory for one of them on the way.
#[derive(Debug, Default)]
pub(super) struct Memory {
    lathe: lathe::Memory,
    swept: swept::Memory,
    quartic: algebraic::Memory<5>,
    octic: algebraic::Memory<9>,
    high: algebraic::Memory<17>,
    fields: fields::Memory,
    pub(super) level: level::Stream,
}

impl DetailSketch {
    /// A surface of revolution; see [`OwnSketch::new`].
    pub(super) fn new(shape: Kind8, centre: Point3, origin: Point3, scale: i32, order: [usize; 3]) -> Self {
        Self { own: OwnSketch::new(centre, origin, scale, order), shape }
    }

    /// Whether nothing holds the surface but what clips it.
    pub(super) fn is_endless(&self) -> bool {
        self.shape.is_endless()
    }

    /// See [`OwnSketch::moved`].
    pub(super) fn moved(self, det: Run<Dd>, moved: impl Fn(Form<Run<Dd>>) -> Form<Run<Dd>>) -> Self {
        Self { own: self.own.moved(det, moved), ..self }
    }

    pub(super) fn round(&self) -> Option<Detail> {
        Some(Detail { own: self.own.round()?, shape: self.shape.clone() })
    }
}

impl Kind8 {
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
            Kind8::Lathe(lathe) => lathe.name(face),
            Kind8::Swept(swept) => swept.face(face),
            Kind8::Quartic(_) | Kind8::Octic(_) | Kind8::High(_) | Kind8::Fields(_) => 0,
            Kind8::Level(_) => face,
        }
    }

    /// Offers the first crossing of each ray to `nearest`; of an endless surface, and of one in a container, what is within a convex cell.
    pub(super) fn meet(
        &self,
        (asked, turned): (&Question<'_>, bool),
        nearest: &mut Nearest,
        (start, cell): (&Start, Option<&Hull>),
        memory: &mut Memory,
    ) {
        if let Kind8::Swept(swept) = &self.shape {
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
    pub(super) fn level(&self) -> Option<&dyn Level> {
        if let Kind8::Level(level) = &self.shape { Some(&**level) } else { None }
    }

    /// Its coordinates.
    pub(super) fn own(&self) -> &Own {
        &self.own
    }

    /// Whether it can tell all crossings, and on which side points are.
    pub(super) fn is_operand(&self) -> bool {
        match &self.shape {
            Kind8::Lathe(lathe) => lathe.faces() <= Outline::FACES,
            Kind8::Swept(swept) => swept.is_operand(),
            Kind8::Quartic(_) | Kind8::Octic(_) | Kind8::High(_) | Kind8::Fields(_) => true,
            Kind8::Level(_) => false,
        }
    }

    /// Puts down all crossings of a solid; of an endless one, what is within a convex cell.
    pub(super) fn crossings(
        &self,
        rays: (&RayLanes<'_>, Option<(&From8, bool)>),
        (start, cell): (&Start, Option<&Hull>),
        to: &mut Crossings,
        memory: &mut Memory,
    ) {
        if let Kind8::Swept(swept) = &self.shape {
            swept.crossings(&self.own, rays, start, to, &mut memory.swept);
            return;
        }
        self.show(rays, (start, cell), to, memory);
    }

    fn show<K: Offer>(
        &self,
        rays: (&RayLanes<'_>, Option<(&From8, bool)>),
        (start, cell): (&Start, Option<&Hull>),
        to: &mut K,
        memory: &mut Memory,
    ) {
        match &self.shape {
            Kind8::Lathe(lathe) => lathe.meet(&self.own, rays, start, to, &mut memory.lathe),
            Kind8::Swept(_) | Kind8::Level(_) => {}
            Kind8::Quartic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.quartic),
            Kind8::Octic(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.octic),
            Kind8::High(f) => f.meet(&self.own, rays, (start, cell), to, &mut memory.high),
            Kind8::Fields(fields) => fields.meet(&self.own, rays, start, to, &mut memory.fields),
        }
    }

    /// Which points at `t` within `e` are surely in the solid, and which surely not, of the rays that are `asked` about: as bits.
    pub(super) fn holds(
        &self,
        rays: &RayLanes<'_>,
        start: &Start,
        (at, asked): ((F8, F8), u8),
        memory: &mut Memory,
    ) -> (u8, u8) {
        match &self.shape {
            Kind8::Lathe(lathe) => lathe.holds(&self.own, rays, start, at),
            Kind8::Swept(swept) => swept.holds(&self.own, rays, start, (at, asked), &mut memory.swept),
            Kind8::Quartic(f) => f.holds(&self.own, rays, start, at),
            Kind8::Octic(f) => f.holds(&self.own, rays, start, at),
            Kind8::High(f) => f.holds(&self.own, rays, start, at),
            Kind8::Fields(fields) => fields.holds(&self.own, rays, start, at),
            Kind8::Level(_) => (0, 0),
        }
    }

    /// What is next to a face, rounded.
    #[inline(always)]
    pub(super) fn slant(&self, isa: Isa, (face, tag): (usize, F8), h: Vec3<F8>, h1: F8) -> Slant {
        match &self.shape {
            Kind8::Level(level) => level::slant(&**level, isa, &self.own, h),
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
            Kind8::Lathe(lathe) => lathe.skin(&self.own, face, h, h1),
            Kind8::Swept(swept) => swept.spot(&self.own, (face, tag), h, h1),
            Kind8::Quartic(f) => f.skin(&self.own, h, h1),
            Kind8::Octic(f) => f.skin(&self.own, h, h1),
            Kind8::High(f) => f.skin(&self.own, h, h1),
            Kind8::Fields(fields) => fields.skin(&self.own, h, h1),
            Kind8::Level(level) => level::skin(&**level, isa, &self.own, h, h1),
        }
    }

    /// The covectors that points are shaded by, if those are not those of the surface.
    #[inline(always)]
    pub(super) fn shading(&self, isa: Isa, h: Vec3<F8>) -> Option<Vec3<F8>> {
        let Kind8::Level(level) = &self.shape else { return None };
        level::shading(&**level, isa, &self.own, h)
    }
}

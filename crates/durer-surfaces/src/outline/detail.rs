//! What lanes know of surfaces whose faces are of a degree above two: an equation in coordinates of the surface's own.

use super::face::Start;
use super::lathe::{self, First, Lathe, Skin};
use super::meet::Question;
use super::operand::Crossings;
use super::own::{Own, OwnSketch};
use super::rays::{From8, Nearest, RayLanes};
use super::swept::{self, Swept};
use crate::quadric::form::Form;
use durer_math::{Dd, F8, M8, Point3, Run, Vec3};
use std::sync::Arc;

/// What kind of surface it is.
#[derive(Clone, Debug)]
pub(super) enum Kind8 {
    /// A surface of revolution.
    Lathe(Arc<Lathe>),
    /// A part of a swept solid.
    Swept(Arc<Swept>),
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
}

impl DetailSketch {
    /// A surface of revolution; see [`OwnSketch::new`].
    pub(super) fn new(shape: Kind8, centre: Point3, origin: Point3, scale: i32, order: [usize; 3]) -> Self {
        Self { own: OwnSketch::new(centre, origin, scale, order), shape }
    }

    /// See [`OwnSketch::moved`].
    pub(super) fn moved(self, det: Run<Dd>, moved: impl Fn(Form<Run<Dd>>) -> Form<Run<Dd>>) -> Self {
        Self { own: self.own.moved(det, moved), ..self }
    }

    pub(super) fn round(&self) -> Option<Detail> {
        Some(Detail { own: self.own.round()?, shape: self.shape.clone() })
    }
}

impl Detail {
    /// The face of roots on the face that lanes call by a number.
    #[inline]
    pub(super) fn face_of(&self, face: u32) -> u32 {
        match &self.shape {
            Kind8::Lathe(lathe) => lathe.name(face),
            Kind8::Swept(swept) => swept.face(face),
        }
    }

    /// Offers the first crossing of each ray to `nearest`.
    pub(super) fn meet(
        &self,
        (asked, turned): (&Question<'_>, bool),
        nearest: &mut Nearest,
        start: &Start,
        memory: &mut Memory,
    ) {
        match &self.shape {
            Kind8::Lathe(lathe) => {
                let mut to = First { nearest, number: asked.number };
                let leaving = asked.from.map(|from| (from, turned));
                lathe.meet(&self.own, (asked.rays, leaving), start, &mut to, &mut memory.lathe);
            }
            Kind8::Swept(swept) => swept.meet(&self.own, asked, start, nearest, &mut memory.swept),
        }
    }

    /// What it can tell as an operand; see [`Detail::crossings`].
    pub(super) fn operand(&self) -> Option<&Lathe> {
        /// So many faces have numbers.
        const MOST: usize = 16;
        match &self.shape {
            Kind8::Lathe(lathe) if lathe.faces() <= MOST => Some(lathe),
            _ => None,
        }
    }

    /// Puts down all crossings of a solid.
    pub(super) fn crossings(
        &self,
        lathe: &Lathe,
        rays: (&RayLanes<'_>, Option<(&From8, bool)>),
        start: &Start,
        to: &mut Crossings,
        memory: &mut Memory,
    ) {
        lathe.meet(&self.own, rays, start, to, &mut memory.lathe);
    }

    /// Which points at `t` within `e` are surely in the solid, and which surely not.
    pub(super) fn holds(&self, lathe: &Lathe, rays: &RayLanes<'_>, start: &Start, at: (F8, F8)) -> (M8, M8) {
        lathe.holds(&self.own, rays, start, at)
    }

    /// What is at points of a face; `tag` is what [`Nearest`] keeps of them.
    #[inline(always)]
    pub(super) fn skin(&self, face: usize, tag: F8, h: Vec3<F8>, h1: F8) -> Skin {
        match &self.shape {
            Kind8::Lathe(lathe) => lathe.skin(&self.own, face, h, h1),
            Kind8::Swept(swept) => swept.spot(&self.own, (face, tag), h, h1),
        }
    }
}

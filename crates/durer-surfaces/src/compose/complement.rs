//! A solid turned inside out.

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, HalfSpace, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::{Aabb, Dd, Dyadic, EFloat, RaySide};
use durer_roots::quadratic::Quadratic;

/// The complement of the solid `S`, with its boundary: entering becomes leaving, and normals point
/// the other way. An open surface keeps its place and turns its normal.
#[derive(Clone, Debug, PartialEq)]
pub struct Complement<S>(pub S);

/// Turns the sign of each root that passes.
struct Turning<'k, K: ?Sized>(&'k mut K);

impl<K: Sink + ?Sized> Sink for Turning<'_, K> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        self.0.range()
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        self.0.push(Root { sign: -root.sign, ..root })
    }
}

fn turned(ray: &LocalRay<'_>) -> Option<RaySide> {
    ray.source.map(|side| if side == RaySide::Front { RaySide::Back } else { RaySide::Front })
}

impl<S: Surface> Surface for Complement<S> {
    /// The surface's bounds for a sheet; none for a solid, whose inside is all the rest.
    fn bounds(&self) -> Aabb {
        match self.solidity() {
            Solidity::Open => self.0.bounds(),
            Solidity::Solid => Aabb::UNBOUNDED,
        }
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.0.roots(&ray.from_side(turned(ray)), &mut Turning(sink));
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let root = Root { sign: -root.sign, ..*root };
        let p = self.0.resolve(&ray.from_side(turned(ray)), &root, need);
        SurfacePoint { ng: -p.ng, ns: -p.ns, dndu: -p.dndu, dndv: -p.dndv, ..p }
    }

    fn solidity(&self) -> Solidity {
        self.0.solidity()
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        match (self.solidity(), self.0.side(point)) {
            (Solidity::Open, side) => side,
            (_, Side::In) => Side::Out,
            (_, Side::Out) => Side::In,
            (_, Side::On) => Side::On,
        }
    }
}

impl<S: Accelerate> Accelerate for Complement<S> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn half_space(&self) -> Option<HalfSpace> {
        Some(self.0.half_space()?.complement())
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        self.0.packet_filter(part).turned()
    }

    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        let (sketch, parts) = self.0.solid_packet_filter();
        (sketch.turned(), parts)
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        self.0.is_in_parts()
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        // The surface itself is where it was, so a tree may still hold it.
        self.0.parts(f);
    }

    #[inline(always)]
    fn primitive_of(&self, part: PartId) -> u32 {
        self.0.primitive_of(part)
    }

    #[inline(always)]
    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        self.0.part_roots(part, &ray.from_side(turned(ray)), &mut Turning(sink));
    }
}

impl<S: Algebraic> Algebraic for Complement<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let Quadratic { a, b, c } = self.0.polynomial(face, ray)?;
        Some(Quadratic { a: -a, b: -b, c: -c })
    }

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        let Quadratic { a, b, c } = self.0.wide_polynomial(face, ray)?;
        Some(Quadratic { a: -a, b: -b, c: -c })
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        self.0.sign_at_root(ray, &Root { sign: -root.sign, ..*root }, q)
    }
}

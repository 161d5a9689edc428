//! Lowering of quadrics that are given by name and semi-axes.

use durer_math::{Aabb, Affine};
use durer_surfaces::quadric::axial::Wall;
use durer_surfaces::{
    Accelerate, Axial, AxialError, Cone, Ellipsoid, EllipticCylinder, EllipticParaboloid, HyperbolicCylinder,
    HyperbolicParaboloid, HyperboloidOfOneSheet, HyperboloidOfTwoSheets, ParabolicCylinder, Region, Surface,
};

use super::build::Target;
use super::shapes::{Result, shape_error};
use crate::{NamedQuadric, QuadricKind};

/// Adds a named quadric, placed by `map`.
pub(super) fn build(
    q: &NamedQuadric,
    open: bool,
    map: Option<&Affine>,
    target: &mut Target<'_>,
) -> Result<()> {
    visit(q, Adder { open, map, extent: q.extent, target })
}

/// The region that a named quadric encloses. It includes the caps, whether they are drawn or not.
pub(super) fn region(q: &NamedQuadric) -> Result<Region> {
    visit(q, Enclosed { extent: q.extent })
}

/// A box around a named quadric that is placed by `place`; unbounded if the quadric is.
pub(super) fn bounds(q: &NamedQuadric, place: &Affine) -> Result<Aabb> {
    visit(q, Bounded { extent: q.extent, place })
}

/// An operation on a quadric, generic in the kind of quadric.
trait Visitor {
    type Output;

    fn visit<W: Wall + 'static>(self, whole: Axial<W>) -> Result<Self::Output>;

    /// [`Visitor::visit`], after a check of the semi-axes.
    fn made<W: Wall + 'static>(self, whole: std::result::Result<Axial<W>, AxialError>) -> Result<Self::Output>
    where
        Self: Sized,
    {
        self.visit(whole.map_err(shape_error)?)
    }
}

fn visit<V: Visitor>(q: &NamedQuadric, visitor: V) -> Result<V::Output> {
    let [a, b, c] = q.semi_axes;
    match q.kind {
        QuadricKind::Ellipsoid => visitor.made(Ellipsoid::new(a, b, c)),
        QuadricKind::HyperboloidOneSheet => visitor.made(HyperboloidOfOneSheet::new(a, b, c)),
        QuadricKind::HyperboloidTwoSheets => visitor.made(HyperboloidOfTwoSheets::new(a, b, c)),
        QuadricKind::EllipticCone => visitor.made(Cone::new(a, b, c)),
        QuadricKind::EllipticCylinder => visitor.made(EllipticCylinder::new(a, b)),
        QuadricKind::HyperbolicCylinder => visitor.made(HyperbolicCylinder::new(a, b)),
        QuadricKind::EllipticParaboloid => visitor.made(EllipticParaboloid::new(a, b, c)),
        QuadricKind::HyperbolicParaboloid => visitor.made(HyperbolicParaboloid::new(a, b, c)),
        QuadricKind::ParabolicCylinder => visitor.made(ParabolicCylinder::new(a, b)),
    }
}

fn closed<W: Wall>(whole: Axial<W>, extent: Option<[f64; 2]>) -> Result<Axial<W>> {
    match extent {
        None => Ok(whole),
        Some([from, to]) => whole.between(from, to).map_err(shape_error),
    }
}

/// Adds a quadric to the geometry.
struct Adder<'a, 'b> {
    open: bool,
    map: Option<&'a Affine>,
    extent: Option<[f64; 2]>,
    target: &'a mut Target<'b>,
}

impl Visitor for Adder<'_, '_> {
    type Output = ();

    fn visit<W: Wall + 'static>(self, whole: Axial<W>) -> Result<()> {
        let shown = match self.extent {
            Some([from, to]) if self.open => Some(whole.open_between(from, to).map_err(shape_error)?),
            _ => None,
        };
        let closed = closed(whole, self.extent)?;
        self.target.contain(&closed, self.map);
        self.target.add_rare(shown.unwrap_or(closed), self.map);
        Ok(())
    }
}

/// Makes a region of a quadric.
struct Enclosed {
    extent: Option<[f64; 2]>,
}

impl Visitor for Enclosed {
    type Output = Region;

    fn visit<W: Wall + 'static>(self, whole: Axial<W>) -> Result<Region> {
        Ok(Region::solid(*closed(whole, self.extent)?.shape()))
    }
}

/// Makes a box around a quadric.
struct Bounded<'a> {
    extent: Option<[f64; 2]>,
    place: &'a Affine,
}

impl Visitor for Bounded<'_> {
    type Output = Aabb;

    fn visit<W: Wall + 'static>(self, whole: Axial<W>) -> Result<Aabb> {
        let closed = closed(whole, self.extent)?;
        Ok(if closed.bounds().is_bounded() { closed.bounds_through(self.place) } else { Aabb::UNBOUNDED })
    }
}

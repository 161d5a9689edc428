//! Quadrics by their names.

use durer_math::Affine;
use durer_surfaces::quadric::axial::Wall;
use durer_surfaces::{
    Axial, AxialError, Cone, Ellipsoid, EllipticCylinder, EllipticParaboloid, HyperbolicCylinder,
    HyperbolicParaboloid, HyperboloidOfOneSheet, HyperboloidOfTwoSheets, ParabolicCylinder,
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
    let [a, b, c] = q.semi_axes;
    let mut add = Adder { open, map, extent: q.extent, target };
    match q.kind {
        QuadricKind::Ellipsoid => add.piece(Ellipsoid::new(a, b, c)),
        QuadricKind::HyperboloidOneSheet => add.piece(HyperboloidOfOneSheet::new(a, b, c)),
        QuadricKind::HyperboloidTwoSheets => add.piece(HyperboloidOfTwoSheets::new(a, b, c)),
        QuadricKind::EllipticCone => add.piece(Cone::new(a, b, c)),
        QuadricKind::EllipticCylinder => add.piece(EllipticCylinder::new(a, b)),
        QuadricKind::HyperbolicCylinder => add.piece(HyperbolicCylinder::new(a, b)),
        QuadricKind::EllipticParaboloid => add.piece(EllipticParaboloid::new(a, b, c)),
        QuadricKind::HyperbolicParaboloid => add.piece(HyperbolicParaboloid::new(a, b, c)),
        QuadricKind::ParabolicCylinder => add.piece(ParabolicCylinder::new(a, b)),
    }
}

/// A surface on its way into the geometry.
struct Adder<'a, 'b> {
    open: bool,
    map: Option<&'a Affine>,
    extent: Option<[f64; 2]>,
    target: &'a mut Target<'b>,
}

impl Adder<'_, '_> {
    fn piece<W: Wall + 'static>(&mut self, whole: std::result::Result<Axial<W>, AxialError>) -> Result<()> {
        let whole = whole.map_err(shape_error)?;
        let (closed, shown) = match self.extent {
            None => (whole.clone(), whole),
            Some([from, to]) => {
                let closed = whole.between(from, to).map_err(shape_error)?;
                let shown = if self.open {
                    whole.open_between(from, to).map_err(shape_error)?
                } else {
                    closed.clone()
                };
                (closed, shown)
            }
        };
        self.target.contain(&closed, self.map);
        self.target.add_rare(shown, self.map);
        Ok(())
    }
}

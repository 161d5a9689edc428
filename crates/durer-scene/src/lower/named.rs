//! Quadrics by their names.

use durer_math::{Affine, Point3};
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
        // Those of degree one in z (or y) have that axis in units of their last semi-axis.
        QuadricKind::EllipticParaboloid => add.stretched([1.0, 1.0, c], EllipticParaboloid::new(a, b)),
        QuadricKind::HyperbolicParaboloid => add.stretched([1.0, 1.0, c], HyperbolicParaboloid::new(a, b)),
        QuadricKind::ParabolicCylinder => add.stretched([1.0, b, 1.0], ParabolicCylinder::new(a)),
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

    /// The surface stretched along the axes before it is placed. Its ends are rounded once where the stretch is no power of two.
    fn stretched<W: Wall + 'static>(
        &mut self,
        by: [f64; 3],
        whole: std::result::Result<Axial<W>, AxialError>,
    ) -> Result<()> {
        if by == [1.0; 3] {
            return self.piece(whole);
        }
        let [x, y, z] = by;
        if let Some(bad) = by.into_iter().find(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(shape_error(format!("the semi-axes must be finite and positive, got {bad}")));
        }
        let stretch = Affine::new([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]], Point3::ORIGIN)?;
        let map = match self.map {
            None => stretch,
            Some(map) => stretch.then(map)?,
        };
        let extent = self.extent.map(|ends| ends.map(|end| end / z));
        Adder { open: self.open, map: Some(&map), extent, target: self.target }.piece(whole)
    }
}

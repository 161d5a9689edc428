//! Transformations from the world to a texture's space.

use super::warp::Warp;
use super::{Around, Around8};
use durer_math::{Affine, AffineError, F8, Point3, Vec3};
use durer_scene::{Pattern, PointWarp};

/// The inverse of a placement, for shading.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Place {
    Identity,
    Moved(Vec3),
    /// The rows of the inverse matrix, and the centre.
    Mapped(Box<([[f64; 3]; 3], Point3)>),
    /// Maps after the inverse of a placement.
    Warped(Box<Warps>),
    /// The texture coordinates in place of the point, seen through another place.
    Chart(Box<Place>),
}

/// A placement and the maps after its inverse.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Warps {
    place: Place,
    warps: Box<[Warp]>,
}

impl Warps {
    fn image(&self, p: Point3) -> Point3 {
        self.warps.iter().fold(self.place.inside(p, Around::NOWHERE), |p, warp| warp.image(p))
    }

    #[inline(never)]
    fn images(&self, p: Point3<F8>) -> Point3<F8> {
        self.warps.iter().fold(self.place.inside_lanes(p, &Around8::NOWHERE), |p, warp| warp.images(p))
    }
}

/// The product of the placements before the given warps, without the warps. Placements between
/// warps rotate normals, but warps do not (a fact of the scene language).
pub(crate) fn placement_before(warps: &[PointWarp]) -> Result<Affine, AffineError> {
    warps.iter().rev().try_fold(Affine::IDENTITY, |map, warp| match warp {
        PointWarp::Placed(placement) => map.then(placement.affine()),
        _ => Ok(map),
    })
}

/// The maps of the point behind the placement of a pattern.
pub(crate) fn warps_of<T>(pattern: &Pattern<T>) -> &[PointWarp] {
    match pattern {
        Pattern::Warped { warps, .. } => warps,
        _ => &[],
    }
}

impl Place {
    pub(crate) fn new(map: &Affine) -> Self {
        match map.as_translation() {
            Some(v) if v == Vec3::ZERO => Self::Identity,
            Some(v) => Self::Moved(v),
            None => Self::Mapped(Box::new((map.inverse_linear(), map.centre()))),
        }
    }

    /// The place of a pattern that is placed by `map`, with its warps.
    pub(crate) fn warped<T>(map: &Affine, pattern: &Pattern<T>) -> Self {
        Self::through(map, warps_of(pattern))
    }

    /// The place of a pattern that is placed by `map` and has warps.
    pub(crate) fn through(map: &Affine, warps: &[PointWarp]) -> Self {
        let place = Self::new(map);
        if warps.is_empty() {
            return place;
        }
        Self::Warped(Box::new(Warps { place, warps: warps.iter().map(Warp::new).collect() }))
    }

    /// Places texture coordinates instead of points if `on_chart` is set.
    pub(crate) fn on_chart(self, on_chart: bool) -> Self {
        if on_chart { Self::Chart(Box::new(self)) } else { self }
    }

    /// The point of the texture's space that is placed at `p`.
    #[inline]
    pub(crate) fn inside(&self, p: Point3, around: Around) -> Point3 {
        match self {
            Self::Identity => p,
            Self::Moved(v) => p - *v,
            Self::Mapped(map) => {
                let (rows, centre) = &**map;
                let v = p - *centre;
                let row = |r: &[f64; 3]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
                Point3::new(row(&rows[0]), row(&rows[1]), row(&rows[2]))
            }
            Self::Warped(all) => all.image(p),
            Self::Chart(place) => place.inside(around.uv(), around),
        }
    }

    /// [`Place::inside`] for eight points.
    #[inline]
    pub(crate) fn inside_lanes(&self, p: Point3<F8>, around: &Around8) -> Point3<F8> {
        match self {
            Self::Identity => p,
            Self::Moved(v) => p - Vec3::<F8>::splat(*v),
            Self::Mapped(map) => {
                let (rows, centre) = &**map;
                let v = p.to_vec() - Vec3::<F8>::splat(centre.to_vec());
                Point3::new(row(&rows[0], v), row(&rows[1], v), row(&rows[2], v))
            }
            Self::Warped(all) => all.images(p),
            Self::Chart(place) => {
                let [u, v] = around.uv;
                place.inside_lanes(Point3::new(u, v, F8::ZERO), around)
            }
        }
    }
}

#[inline(always)]
fn row(row: &[f64; 3], v: Vec3<F8>) -> F8 {
    v.x * row[0] + v.y * row[1] + v.z * row[2]
}

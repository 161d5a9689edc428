//! The annulus: a disc with a round hole.
//!
//! ```text
//!        n
//!        ^            n . (p - c) = 0,   hole <= |p - c| <= r
//!   ────   ────
//!       c hole r
//! ```
//!
//! Decided as the [disc](crate::Disc) is, against two circles; both rims belong to the annulus.

use crate::compose::clip::Algebraic;
use crate::disc::RoundSheet;
use crate::packet::FilterSource;
use crate::planar::{self, scaled_to_one};
use crate::{Accelerate, LocalRay, Need, PartId, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use durer_math::{Aabb, Dyadic, Point3, Vec3};
use durer_roots::quadratic::Quadratic;

/// A round sheet with a round hole about the same centre.
///
/// # Invariants
///
/// Centre, normal and radii are finite, the normal is not zero, and `0 <= hole < radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Annulus {
    sheet: RoundSheet,
    hole: f64,
}

/// Why an [`Annulus`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AnnulusError {
    /// The centre is infinite or NaN.
    #[error("annulus: the centre must be finite, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Centre(Point3),
    /// The normal has no direction.
    #[error("annulus: the normal must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Normal(Vec3),
    /// The radius is zero, negative, infinite or NaN.
    #[error("annulus: the radius must be finite and positive, got {0}")]
    Radius(f64),
    /// The hole's radius is negative, infinite, NaN, or leaves nothing of the disc.
    #[error("annulus: the hole's radius must be at least 0 and less than the radius {radius}, got {hole}")]
    Hole {
        /// The hole's radius.
        hole: f64,
        /// The disc's radius.
        radius: f64,
    },
}

impl Annulus {
    /// The part of the disc of radius `radius` about `centre` that lies at least `hole` away from
    /// it; the normal has any length.
    pub fn new(centre: Point3, normal: Vec3, hole: f64, radius: f64) -> Result<Self, AnnulusError> {
        if !centre.is_finite() {
            return Err(AnnulusError::Centre(centre));
        }
        let n = scaled_to_one(normal).ok_or(AnnulusError::Normal(normal))?;
        if !(radius.is_finite() && radius > 0.0) {
            return Err(AnnulusError::Radius(radius));
        }
        if !(0.0 <= hole && hole < radius) {
            return Err(AnnulusError::Hole { hole, radius });
        }
        Ok(Self { sheet: RoundSheet::new(centre, n, radius), hole })
    }

    /// The centre.
    pub fn centre(&self) -> Point3 {
        self.sheet.centre
    }

    /// The normal, scaled by a power of two.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        self.sheet.normal
    }

    /// The radius of the hole.
    pub fn hole(&self) -> f64 {
        self.hole
    }

    /// The outer radius.
    pub fn radius(&self) -> f64 {
        self.sheet.radius
    }
}

impl Surface for Annulus {
    fn bounds(&self) -> Aabb {
        self.sheet.bounds()
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        let probe = self.sheet.probe(ray);
        // An inexact ray that cannot be kept off the annulus meets it.
        if let Some(crossing) = self.sheet.crossing(&probe, sink.range())
            && self.sheet.beyond(&probe, &crossing, self.sheet.radius).is_none_or(Ordering::is_le)
            && self.sheet.beyond(&probe, &crossing, self.hole).is_none_or(Ordering::is_ge)
            && probe.admits(&self.sheet, &crossing)
        {
            let _ = sink.push(probe.root(&crossing, 0, [0.0; 2]));
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, _root: &Root, need: Need) -> SurfacePoint {
        self.sheet.resolve(ray, need, self.hole)
    }
}

impl Accelerate for Annulus {
    fn name(&self) -> &'static str {
        "annulus"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::ring(self.centre(), self.normal(), self.hole, self.radius())
    }
}

impl Algebraic for Annulus {
    fn polynomial(&self, _face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        planar::plane_along(&planar::exact3(self.normal()), self.centre(), ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::tests::{FRAMES, ball, features};
    use crate::laws::{ExactBody, ExactForm, TestRng, check_many, exact3};

    #[test]
    fn annuli_obey_the_laws() {
        let mut roots = 0;
        for seed in 0..40 {
            let mut dice = TestRng::new(seed);
            let frame = dice.pick(&FRAMES).map(Vec3::from);
            let unit = dice.power(-30, 30);
            let centre = if seed % 2 == 0 { Point3::ORIGIN } else { (dice.lattice(100) * unit).to_point() };
            // One of the rims, or none, goes through the features.
            let rim = 5.0 * frame[1].length() * unit;
            let (hole, radius) =
                dice.pick(&[(rim, 2.0 * rim), (0.5 * rim, rim), (0.0, rim), (0.9 * rim, 1.1 * rim)]);
            let annulus = Annulus::new(centre, frame[0], hole, radius).unwrap();
            let plane = ExactForm::half_space(exact3(frame[0].to_array()), exact3(centre.to_array()));
            let faces = vec![plane, ball(centre, radius), ball(centre, hole).negated()];
            let oracle = ExactBody { faces, walls: 1, size: radius, convex: false };
            roots += check_many(&annulus, &oracle, &features(centre, frame, unit), seed, 300).roots;
        }
        assert!(roots > 2000, "{roots}");
    }

    #[test]
    fn a_bad_annulus_is_named() {
        let made = |hole, radius| Annulus::new(Point3::ORIGIN, Vec3::Y, hole, radius);
        assert_eq!(made(1.0, 1.0), Err(AnnulusError::Hole { hole: 1.0, radius: 1.0 }));
        assert_eq!(made(0.0, 0.0), Err(AnnulusError::Radius(0.0)));
    }
}

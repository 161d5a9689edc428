//! The lathe: a profile that is turned about the y axis.
//!
//! ```text
//!    y ▲ ┊  .--.            A profile (r(w), y(w)) of lines, parabolas or cubics sweeps
//!      │ ┊ (    )             x² + z² = r(w)²,   y = y(w).
//!      │ ┊  `.  .'          Closed, or with both ends on the axis, it bounds a solid:
//!      │ ┊   )  (           inside is where a half line away from the axis meets it an
//!      │ ┊  '----'          odd number of times. Otherwise it is a sheet.
//!      └─┊──────────▶ r
//! ```
//!
//! A ray that is not at one height passes the height `y(w)` at a parameter that is a polynomial in
//! `w`, and one polynomial of degree 6 at most in `w` is left (`forms.rs`); of degree 2 for a line,
//! whose surface is a cone, a cylinder or a disc. Its roots are found and decided on the ladder
//! f64, double-double, exact numbers (`crossings.rs`, `exact.rs`). Where the profile has a negative
//! radius, it counts as a positive one.
//!
//! J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", SIGGRAPH 1983; J.
//! J. van Wijk, "Ray tracing objects defined by sweeping planar cubic splines", *ACM Transactions
//! on Graphics* 3, 1984.

mod boxes;
mod crossings;
mod exact;
mod forms;
mod point;
mod profile;
mod side;

use crate::planar::Probe;
use crate::prism::curved::profile_curve::extent;
use crate::{
    Accelerate, Algebraic, Forward, LocalPoint, LocalRay, Need, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use boxes::{Boxes, Hollow};
use core::cmp::Ordering;
use crossings::{Crossed, Pass};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, Point3, U};
use durer_roots::quadratic::Quadratic;
pub use profile::LatheSpline;
use profile::{Piece, Profile};

/// A surface of revolution about the y axis with a spline as its profile.
///
/// It is a solid if the profile is closed, or if both ends are on the axis.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{All, Lathe, LatheSpline, LocalRay, Surface};
///
/// // A cone on a disc.
/// let profile = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]];
/// let cone = Lathe::new(LatheSpline::Linear, &profile)?;
/// let ray = Ray::new(Point3::new(-4.0, 1.0, 0.0), Vec3::new(1.0, 0.0, 0.0));
/// let mut crossings = All::default();
/// cone.roots(&LocalRay::new(&ray), &mut crossings);
/// let t: Vec<f64> = crossings.roots.iter().map(|root| root.t).collect();
/// assert_eq!(t, [3.5, 4.5]);
/// # Ok::<(), durer_surfaces::LatheError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lathe {
    profile: Profile,
    pieces: Vec<Piece>,
    boxes: Boxes,
    /// For hits that do not cross the surface: whether the outside is to the right of the profile.
    outside_is_right: bool,
    /// An upper bound of the distance from the centre.
    reach: f64,
    bounds: Aabb,
}

/// Why a lathe cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LatheError {
    /// There are fewer points than one piece needs.
    #[error("lathe: its spline needs {least} points at least, and has {got}")]
    TooFew {
        /// The least number of points.
        least: usize,
        /// The number of points given.
        got: usize,
    },
    /// A Bezier spline takes four points for each piece.
    #[error("lathe: a bezier_spline takes four points for each piece, and has {0}")]
    NotFours(usize),
    /// A coordinate is infinite or NaN.
    #[error("lathe: a radius and a height are finite numbers; point {number} is <{radius}, {height}>")]
    Point {
        /// Its number, from 1.
        number: usize,
        /// The radius.
        radius: f64,
        /// The height.
        height: f64,
    },
    /// The profile is a point, or all of it lies on the axis.
    #[error("lathe: its profile sweeps no surface: it lies on the axis, or is a single point")]
    Empty,
    /// The numbers are beyond the range in which the surface can be described.
    #[error("lathe: its radii and heights are too large or too small: its size must be from 1e-50 to 1e50")]
    Range,
}

impl Lathe {
    /// The lathe with these points, each a radius and a height.
    pub fn new(spline: LatheSpline, points: &[[f64; 2]]) -> Result<Self, LatheError> {
        let mut profile = Profile::new(spline, points)?;
        // The box of each piece in the plane of the profile, rounded outward.
        let extents: Vec<[[f64; 2]; 2]> = (0..profile.len())
            .map(|i| {
                let ([r, y], e) = profile.bezier(i);
                let found = extent(&[0, 1, 2, 3].map(|j: usize| [r[j], y[j]]));
                [0, 1].map(|k| {
                    let [lo, hi] = found[k];
                    if e[k] == 0.0 { [lo, hi] } else { [(lo - e[k]).next_down(), (hi + e[k]).next_up()] }
                })
            })
            .collect();
        let (mut low, mut high, mut widest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for [r, y] in &extents {
            if !r.iter().chain(y).all(|x| x.is_finite()) {
                return Err(LatheError::Range);
            }
            (low, high) = (low.min(y[0]), high.max(y[1]));
            widest = widest.max(r[0].abs()).max(r[1].abs());
        }
        profile.centre = 0.5 * low + 0.5 * high;
        let half = (high - profile.centre).max(profile.centre - low).next_up();
        let size = half.max(widest);
        // The sixth power of the size, and its inverse, are well within range.
        if size.is_nan() || size >= 1e50 {
            return Err(LatheError::Range);
        }
        if widest == 0.0 {
            return Err(LatheError::Empty);
        }
        if size < 1e-50 {
            return Err(LatheError::Range);
        }
        profile.scale = exponent(size) + 1;
        let pieces: Vec<Piece> = (0..profile.len()).map(|i| profile.piece(i)).collect();
        if !pieces.iter().any(|piece| piece.is_surface) {
            return Err(LatheError::Empty);
        }
        // Their margin pays for the rounding.
        let hollow = |[r, y]: &[[f64; 2]; 2]| {
            let unit = |x: f64| scale2(x, -profile.scale);
            let (a, b) = (r[0].abs(), r[1].abs());
            let least = if r[0] <= 0.0 && r[1] >= 0.0 { 0.0 } else { a.min(b) };
            Hollow { y: y.map(|y| unit(y - profile.centre)), r: [unit(least), unit(a.max(b))] }
        };
        let boxes = Boxes::new(extents.iter().map(hollow).collect());
        let bounds = Aabb::new(Point3::new(-widest, low, -widest), Point3::new(widest, high, widest));
        let reach = (widest * widest + half * half).sqrt() * (1.0 + 8.0 * U);
        let outside_is_right = pieces.iter().map(volume).sum::<f64>() >= 0.0;
        Ok(Self { profile, pieces, boxes, outside_is_right, reach, bounds })
    }

    fn centre(&self) -> Point3 {
        Point3::new(0.0, self.profile.centre, 0.0)
    }

    #[inline(always)]
    fn probe<'a>(&self, ray: &'a LocalRay<'a>) -> Probe<'a> {
        Probe::with_scale(ray, self.centre(), self.profile.scale, 1.0)
    }
}

/// `∫ r² y' dw`: what a piece adds to the volume, by π, if the inside is to its left; by the rule of
/// C. F. Gauss with four points, which is exact for degree 7 and close for degree 8.
fn volume(piece: &Piece) -> f64 {
    const NODES: [(f64, f64); 2] = [
        (0.169_990_521_792_428_13, 0.326_072_577_431_273_05),
        (0.430_568_155_797_026_3, 0.173_927_422_568_726_93),
    ];
    let at = |w: f64| {
        let [[r, _], [_, y1], _] = piece.slopes(w);
        r * r * y1
    };
    NODES.iter().map(|&(w, weight)| weight * (at(w) + at(-w))).sum()
}

impl Surface for Lathe {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.centre(), self.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    /// Texture coordinates: once round the axis, and along the control points.
    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.resolve_root(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        if self.profile.is_closed { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.profile.is_closed { self.side_of(point) } else { Side::Out }
    }
}

impl Accelerate for Lathe {
    fn name(&self) -> &'static str {
        "lathe"
    }
}

impl Algebraic for Lathe {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let exact = ray.in_ring_from::<Dyadic>(self.centre(), self.profile.scale)?;
        let probe = self.probe(ray);
        let pass = Pass::new(self, &probe);
        let piece = root.tag[0] as usize / 2;
        if piece >= self.pieces.len() {
            return None;
        }
        // Find the crossing again: the same numbers give the same root; if this ray has other
        // errors, take the nearest.
        let mut found: Option<Crossed> = None;
        pass.crossings(piece, |crossed| {
            let way = |c: &Crossed| (c.at.s - root.s).abs();
            if found.as_ref().is_none_or(|best| way(&crossed) < way(best)) {
                found = Some(crossed);
            }
        });
        exact::sign_at(&pass, &found?, &exact, [&q.a, &q.b, &q.c])
    }
}

#[cfg(test)]
mod tests;

//! The sphere sweep: all balls whose centres and radii follow a spline.
//!
//! ```text
//!    .-''-._                      the union over u of  |x - c(u)| <= |r(u)|
//!   (   ●───`-─.●.                a ray  x = o + s d  meets the ball of u where
//!    `-..-'      `'               |s - m(u)| <= √D(u) / d²,   m = d·(c - o) / d²,
//!                                 D = (d·(c - o))² - d² (|c - o|² - r²)
//! ```
//!
//! Where `D >= 0` on an interval of `u`, those intervals of `s` overlap from each ball to the next,
//! so their union is one interval, from the least `m - √D / d²` to the greatest `m + √D / d²`. So
//! the line meets the solid in one interval for each run of `D >= 0`, and the solid is the union of
//! these: inner skins do not exist, and a line that touches the boundary from inside has no crossing
//! there, since bodies that touch are one (as in CSG). Runs go on from a piece to the next through
//! the ball they share, without any comparison.
//!
//! * `line.rs`: the runs of one piece, by the signs of `D` in Bernstein form, and the ends of their
//!   intervals. An end is proven: beyond it `|x - c(u)|² - r(u)²`, a polynomial in `u`, is positive
//!   for all balls of the run, before it negative for one.
//! * `unite.rs`: the runs of all pieces that the ray meets, joined and united.
//! * `capsule.rs`: both ends of the interval of two balls of one size, in closed form.
//! * `exact.rs`: the same by exact arithmetic, where double-double does not suffice.
//! * `point.rs`: points of the surface, and on which side of it a point is.
//!
//! J. J. van Wijk, "Ray tracing objects defined by sweeping a sphere", *Eurographics* 1984; its
//! equation for the ends, of degree ten, eliminates `s` and needs no square root, but has more roots
//! than the surface has points.

mod capsule;
mod exact;
mod line;
mod point;
mod spline;
mod unite;

use crate::blob::Tree;
use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use capsule::Capsule;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, Isa, Point3, U, Vec3};
use durer_roots::quadratic::Quadratic;
use spline::{B_SPLINE, Basis, CUBIC, LINEAR};
use std::sync::Arc;

pub use spline::SweepSpline;

/// Why a [`SphereSweep`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereSweepError {
    /// There are too few spheres for this spline.
    #[error("sphere sweep: {what} needs {least} spheres at least, got {len}")]
    TooFew {
        /// The spline.
        what: &'static str,
        /// How many it needs.
        least: usize,
        /// How many there are.
        len: usize,
    },
    /// There are more spheres than can be numbered.
    #[error("sphere sweep: {0} spheres are too many")]
    TooMany(usize),
    /// A centre is infinite or NaN.
    #[error("sphere sweep: the centre of sphere {sphere} must be finite, got <{x}, {y}, {z}>")]
    Centre {
        /// The sphere, from 0.
        sphere: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its z.
        z: f64,
    },
    /// A radius is infinite or NaN.
    #[error("sphere sweep: the radius of sphere {sphere} must be finite, got {radius}")]
    Radius {
        /// The sphere, from 0.
        sphere: usize,
        /// Its radius.
        radius: f64,
    },
    /// All radii are zero: there is a curve, but no solid.
    #[error("sphere sweep: all radii are 0, so it has no surface")]
    Nothing,
    /// A number is too large.
    #[error("sphere sweep: the coordinate or radius {0:?} is too large; the limit is 1.6e60")]
    TooLarge(f64),
}

/// The union of all balls whose centres and radii follow a spline. A negative radius counts by its
/// magnitude. It has one face.
///
/// # Invariants
///
/// All numbers are finite, and there are spheres enough for a piece. Not all radii are zero.
#[derive(Clone, Debug)]
pub struct SphereSweep {
    spline: SweepSpline,
    /// Centre and radius each.
    spheres: Arc<[[f64; 4]]>,
    bounds: Aabb,
    centre: Point3,
    scale: i32,
    /// The radius of a ball about the centre that holds the sweep.
    reach: f64,
    tree: Arc<Tree>,
    /// The pieces in the order of the tree.
    order: Arc<[u32]>,
    /// The numbers of a sweep of two balls of one size.
    capsule: Option<Capsule>,
}

/// Products of larger numbers could leave the range of f64.
const LARGEST: f64 = durer_math::scale::pow2(200);
/// With more pieces their boxes are those of their control points.
const FEW: usize = 4096;

/// Calls `$do` with the basis of a spline.
macro_rules! with_basis {
    ($spline:expr, $basis:ident => $do:expr) => {
        match $spline {
            SweepSpline::Linear => {
                let $basis = &LINEAR;
                $do
            }
            SweepSpline::BSpline => {
                let $basis = &B_SPLINE;
                $do
            }
            SweepSpline::Cubic => {
                let $basis = &CUBIC;
                $do
            }
        }
    };
}

impl SphereSweep {
    /// The sweep of these spheres: centre and radius each.
    pub fn new(spline: SweepSpline, spheres: &[[f64; 4]]) -> Result<Self, SphereSweepError> {
        let (len, least) = (spheres.len(), spline.least());
        if len < least {
            return Err(SphereSweepError::TooFew { what: spline.name(), least, len });
        }
        if u32::try_from(len).is_err() {
            return Err(SphereSweepError::TooMany(len));
        }
        for (sphere, &[x, y, z, radius]) in spheres.iter().enumerate() {
            if ![x, y, z].iter().all(|x| x.is_finite()) {
                return Err(SphereSweepError::Centre { sphere, x, y, z });
            }
            if !radius.is_finite() {
                return Err(SphereSweepError::Radius { sphere, radius });
            }
            if let Some(&large) = [x, y, z, radius].iter().find(|x| x.abs() >= LARGEST) {
                return Err(SphereSweepError::TooLarge(large));
            }
        }
        let boxes = with_basis!(spline, basis => boxes(basis, spheres)).ok_or(SphereSweepError::Nothing)?;
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let centre = bounds.centre();
        let reach = bounds.reach_from(centre);
        let scale = exponent(reach) + 1;
        let unit = |p: Point3| (p - centre).map(|x| scale2(x, -scale)).to_point();
        let units: Vec<Aabb> = boxes.iter().map(|b| Aabb::new(unit(b.min), unit(b.max))).collect();
        let (tree, order) = Tree::new(&units);
        let (tree, order) = (Arc::new(tree), order.into());
        let capsule = match spheres {
            [one, other] => Capsule::new(&[*one, *other], centre.to_array(), scale),
            _ => None,
        };
        Ok(Self { spline, spheres: spheres.into(), bounds, centre, scale, reach, tree, order, capsule })
    }

    /// All points within `radius` of the line from `base` to `cap`.
    pub fn capsule(base: Point3, cap: Point3, radius: f64) -> Result<Self, SphereSweepError> {
        let ball = |p: Point3| [p.x, p.y, p.z, radius];
        Self::new(SweepSpline::Linear, &[ball(base), ball(cap)])
    }

    /// The spline.
    pub fn spline(&self) -> SweepSpline {
        self.spline
    }

    /// Its spheres: centre and radius each.
    pub fn spheres(&self) -> &[[f64; 4]] {
        &self.spheres
    }

    /// The control spheres of a piece.
    #[inline(always)]
    fn piece<const K: usize>(&self, number: usize) -> Option<&[[f64; 4]; K]> {
        self.spheres.get(number..)?.first_chunk::<K>()
    }

    fn pieces(&self) -> usize {
        self.spheres.len() + 1 - self.spline.least()
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || with_basis!(self.spline, basis => unite::roots(self, basis, ray, sink)),
        );
    }
}

/// The boxes of all pieces; `None` if no piece has a radius.
fn boxes<const K: usize, const M: usize>(basis: &Basis<K, M>, spheres: &[[f64; 4]]) -> Option<Vec<Aabb>> {
    let tight = spheres.len() < FEW && K == 4;
    let mut thick = false;
    let boxes = spheres
        .windows(K)
        .map(|window| {
            let mut p = [[0.0; K]; 4];
            for (i, sphere) in window.iter().enumerate() {
                for (p, &x) in p.iter_mut().zip(sphere) {
                    p[i] = x;
                }
            }
            thick |= p[3].iter().any(|&r| r != 0.0);
            // The convex hull of the control spheres of the Bezier form holds the piece. They round
            // four times.
            let size = p.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
            let room = if K == 2 { 2.0 * U } else { 16.0 * U } * size;
            let b = p.map(|p| basis.bezier(&p));
            let side = |axis: usize, sign: f64| {
                let mut far = [[0.0; K]; 2];
                for i in 0..K {
                    let (x, r) = (sign * b[axis][i], b[3][i]);
                    (far[0][i], far[1][i]) = (x + r, x - r);
                }
                let most = |b: &[f64; K]| match b.first_chunk::<4>() {
                    Some(b) if tight => crate::prism::curved::greatest(*b),
                    _ => b.iter().fold(f64::NEG_INFINITY, |m, &x| m.max(x)),
                };
                most(&far[0]).max(most(&far[1])) + room
            };
            let [low, high] = [-1.0, 1.0].map(|sign| [0, 1, 2].map(|axis| sign * side(axis, sign)));
            Aabb::new(Vec3::from(low).to_point(), Vec3::from(high).to_point())
        })
        .collect();
    thick.then_some(boxes)
}

/// Sweeps are equal if their splines and spheres are.
impl PartialEq for SphereSweep {
    fn eq(&self, other: &Self) -> bool {
        self.spline == other.spline && self.spheres == other.spheres
    }
}

impl Surface for SphereSweep {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.centre, self.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    /// Texture coordinates: `u` along the sweep, `v` round it.
    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || with_basis!(self.spline, basis => self.point(basis, ray, root, need)),
        )
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        with_basis!(self.spline, basis => self.side_of(basis, point))
    }
}

impl Accelerate for SphereSweep {
    fn name(&self) -> &'static str {
        "sphere sweep"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds)
    }
}

impl Algebraic for SphereSweep {
    /// It has no polynomial of its own along a ray: one piece after another.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }
}

#[cfg(test)]
mod tests;

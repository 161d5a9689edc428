//! Linear forms in the plane of the outlines: the trace of a ray, and the order of points along it.

use super::Sweep;
use crate::RingRay;
use crate::planar::{AlongRay, PlaneForm};
use crate::revolution::level::HeightPlane;
use durer_math::Ring;

/// A linear form `f·(x, 1, z)` in the plane of the outlines.
pub(super) type Form<T> = [T; 3];

/// The set that cuts the curves: a line, and a point on it.
#[derive(Clone, Copy)]
pub(super) enum Cut<'a> {
    /// The trace of a ray, without a point.
    Ray,
    /// The trace of a ray, and the ray's point at a height; `positive` is the sign of that point's
    /// denominator.
    Height { level: &'a HeightPlane, positive: bool },
    /// For a ray whose trace is a point: the point, and a line through it along x.
    Point { level: &'a HeightPlane, positive: bool },
    /// A point by itself, the start of the line, and a line through it along x.
    Start { positive: bool },
}

/// The trace of a ray: zero on it, greater to its left (x to the right, z up).
#[inline(always)]
fn trace<T: Ring>(sweep: Sweep, ray: &RingRay<T>) -> Form<T> {
    let ([ox, oy, oz], [dx, dy, dz]) = (ray.o.clone(), ray.d.clone());
    match sweep {
        Sweep::Linear => [ray.w.clone() * dz.clone(), dx.clone() * oz - dz * ox, -(ray.w.clone() * dx)],
        Sweep::Conic => [
            oy.clone() * dz.clone() - oz.clone() * dy.clone(),
            oz * dx.clone() - ox.clone() * dz,
            ox * dy - oy * dx,
        ],
    }
}

/// A point `(x, z) / w` of the plane, `w` positive.
struct Spot<T> {
    x: T,
    z: T,
    w: T,
}

impl<T: Ring> Spot<T> {
    #[inline(always)]
    fn new(x: T, z: T, w: T, positive: bool) -> Self {
        if positive { Self { x, z, w } } else { Self { x: -x, z: -z, w: -w } }
    }

    /// The ray's point at a height.
    #[inline(always)]
    fn at_height(sweep: Sweep, ray: &RingRay<T>, level: &HeightPlane, positive: bool) -> Option<Self> {
        let above = level.height(ray)?;
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.o.clone(), ray.d.clone());
        let w = match sweep {
            Sweep::Linear => ray.w.clone(),
            Sweep::Conic => oy - above.clone(),
        };
        let x = ox * dy.clone() - above.clone() * dx;
        let z = oz * dy.clone() - above * dz;
        Some(Self::new(x, z, w * dy, positive))
    }

    /// The form that vanishes at this point and grows along the line `n`.
    #[inline(always)]
    fn ahead(self, n: &Form<T>) -> Form<T> {
        let Self { x, z, w } = self;
        [-(w.clone() * n[2].clone()), n[2].clone() * x - n[0].clone() * z, w * n[0].clone()]
    }

    /// A line through the point, and the form that grows along it.
    #[inline(always)]
    fn across(self) -> (Form<T>, Form<T>) {
        let zero = || T::exact(0.0);
        let Self { x, z, w } = self;
        ([zero(), -z, w.clone()], [-w, x, zero()])
    }
}

impl Cut<'_> {
    /// The form of the line, and the form that grows along it from the point.
    #[inline(always)]
    pub(super) fn forms<T: Ring>(self, sweep: Sweep, ray: &RingRay<T>) -> Option<(Form<T>, Form<T>)> {
        let zero = || T::exact(0.0);
        Some(match self {
            Self::Ray => (trace(sweep, ray), [zero(), zero(), zero()]),
            Self::Height { level, positive } => {
                let n = trace(sweep, ray);
                let r = Spot::at_height(sweep, ray, level, positive)?.ahead(&n);
                (n, r)
            }
            Self::Point { level, positive } => Spot::at_height(sweep, ray, level, positive)?.across(),
            Self::Start { positive } => {
                let [x, y, z] = ray.o.clone();
                let w = if sweep == Sweep::Linear { ray.w.clone() } else { y };
                Spot::new(x, z, w, positive).across()
            }
        })
    }
}

/// The value of a form at a point.
#[inline(always)]
pub(super) fn value<T: Ring>(f: &Form<T>, [x, z]: [T; 2]) -> T {
    f[0].clone() * x + f[2].clone() * z + f[1].clone()
}

/// A form along a piece, in powers of `y = u - 1/2`.
#[inline(always)]
pub(super) fn along<T: Ring>(f: &Form<T>, powers: &[[T; 2]; 4]) -> [T; 4] {
    #[inline(always)]
    fn term<T: Ring>(f: &Form<T>, [x, z]: &[T; 2]) -> T {
        f[0].clone() * x.clone() + f[2].clone() * z.clone()
    }
    let [a, b, c, d] = powers;
    [term(f, a) + f[1].clone(), term(f, b), term(f, c), term(f, d)]
}

/// A coordinate of the start of a line.
pub(super) struct Coordinate(pub(super) usize);

impl AlongRay for Coordinate {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(ray.o[self.0].clone())
    }
}

/// A coefficient of a trace.
pub(super) struct Coefficient(pub(super) Sweep, pub(super) usize);

impl AlongRay for Coefficient {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(trace(self.0, ray)[self.1].clone())
    }
}

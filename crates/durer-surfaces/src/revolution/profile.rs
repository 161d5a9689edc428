//! Walls of solids of revolution: `x² + z² = p(y)` with a cubic `p`, and the sheets of a torus that
//! meets itself.

use crate::faces::chart::{Chart, Frame};
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::{CentredRay, RingRay};
use durer_math::eft::scale2;
use durer_math::{Point3, Ring, U, Vec3, elementary};
use durer_roots::quadratic::Quadratic;

/// The part that both kinds share: the position on the axis, the frame, and the heights between
/// which the wall is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stand {
    /// The frame's centre is on the axis; `reach` holds the whole solid.
    pub(super) frame: Frame,
    /// The height from which the wall's own height is counted.
    pub(super) at: f64,
    /// The heights between which the wall is used, relative to the centre, in units.
    pub(super) slab: [f64; 2],
    /// The heights of the whole solid, relative to the centre, in units.
    pub(super) extent: [f64; 2],
}

impl Stand {
    /// `at` relative to the centre, in units.
    #[inline(always)]
    fn height<T: Ring>(&self) -> T {
        (T::exact(self.at) - T::exact(self.frame.centre.y)).scale2(-self.frame.scale)
    }

    /// The origin of a ray with its height relative to `at`.
    #[inline(always)]
    fn seen<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let [x, y, z] = ray.o.clone();
        [x, y - self.height::<T>() * ray.w.clone(), z]
    }

    /// `at` relative to the centre, in units, rounded.
    #[inline(always)]
    pub(super) fn at_height(&self) -> f64 {
        scale2(self.at - self.frame.centre.y, -self.frame.scale)
    }

    /// A point in f64 with its height relative to `at`.
    #[inline(always)]
    fn point(&self, y: Vec3) -> Vec3 {
        Vec3::new(y.x, y.y - self.at_height(), y.z)
    }

    /// The part of a ray within the slab and within the ball that holds the solid, both a little
    /// enlarged.
    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        /// By how much both are enlarged, in units, so that no rounding matters.
        const MARGIN: f64 = 1.0 / 1024.0;
        let reach = self.frame.reach * (1.0 + MARGIN) + MARGIN;
        let slab = (self.slab[0] - MARGIN, self.slab[1] + MARGIN);
        polynomial_surface::ball_and_slab(ray, reach, (ray.o.y, ray.d.y), slab, MARGIN)
    }

    /// `u` once round the axis, `v` from the bottom of the solid to its top.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let rho = elementary::hypot(y.x, y.z);
        let longitude = if rho > 0.0 { elementary::atan2(y.z, y.x) / TURN } else { 0.0 };
        let longitude = if longitude < 0.0 { longitude + 1.0 } else { longitude };
        let out = if rho > 0.0 { Vec3::new(y.x / rho, 0.0, y.z / rho) } else { Vec3::X };
        let east = Vec3::new(-out.z, 0.0, out.x);
        let height = self.extent[1] - self.extent[0];
        // Up along the profile: across the normal and the direction east, as far as the height
        // grows. At a pole the profile does not rise.
        let north = east.cross(n);
        let up = if north.y.abs() > 1e-9 { height / north.y } else { height };
        Chart {
            uv: [longitude, ((y.y - self.extent[0]) / height).clamp(0.0, 1.0)],
            dpdu: east * (TURN * if rho > 0.0 { rho } else { 1.0 }),
            dpdv: north * up,
        }
    }
}

/// `x² + z² = a₀ + a₁ v + a₂ v² + a₃ v³` with the height `v` above a point of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cubic {
    pub(super) stand: Stand,
    /// The coefficients, in units.
    pub(super) a: [f64; 4],
}

impl PolynomialSurface<4> for Cubic {
    fn frame(&self) -> Frame {
        self.stand.frame
    }

    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; 4] {
        let [x, v, z] = self.stand.seen(ray);
        let ([dx, dv, dz], w) = (ray.d.clone(), ray.w.clone());
        let [a0, a1, a2, a3] = self.a.map(T::exact);
        // w (x² + z²) - (a₀ w³ + a₁ w² v + a₂ w v² + a₃ v³) with v + s dv for v.
        let (a1, a2) = (a1 * w.clone().square(), a2 * w.clone());
        let a0 = a0 * w.clone().square() * w.clone();
        let three = || T::exact(3.0);
        let (v2, dv2) = (v.clone().square(), dv.clone().square());
        let p0 = a0 + a1.clone() * v.clone() + a2.clone() * v2.clone() + a3.clone() * v2.clone() * v.clone();
        let p1 = (a1 + (a2.clone() * v.clone()).scale2(1) + three() * a3.clone() * v2) * dv.clone();
        let p2 = (a2 + three() * a3.clone() * v) * dv2.clone();
        let p3 = a3 * dv2 * dv;
        [
            (x.clone().square() + z.clone().square()) * w.clone() - p0,
            ((x * dx.clone() + z * dz.clone()) * w.clone()).scale2(1) - p1,
            (dx.square() + dz.square()) * w - p2,
            -p3,
        ]
    }

    #[inline(always)]
    fn at<T: Ring>(&self, p: &[T; 3], w: &T) -> T {
        let [x, y, z] = p.clone();
        let v = y - self.stand.height::<T>() * w.clone();
        let [a0, a1, a2, a3] = self.a.map(T::exact);
        let w2 = w.clone().square();
        let square =
            ((a3 * v.clone() + a2 * w.clone()) * v.clone() + a1 * w2.clone()) * v + a0 * w2 * w.clone();
        (x.square() + z.square()) * w.clone() - square
    }

    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        self.stand.stretch(ray)
    }

    fn slopes(&self, y: Vec3) -> (Vec3, f64) {
        let (v, [_, a1, a2, a3]) = (self.stand.point(y).y, self.a);
        let p1 = (3.0 * a3).mul_add(v, 2.0 * a2).mul_add(v, a1);
        let p2 = (6.0 * a3).mul_add(v, 2.0 * a2);
        // H = diag(2, -p″, 2), a 64th further along the axis.
        let bend = 2.0_f64.max(p2.abs() + 6.0 * a3.abs() * (v.abs() * (8.0 * U) + 1.0 / 64.0));
        (Vec3::new(2.0 * y.x, -p1, 2.0 * y.z), bend * (1.0 + 1.0 / 1024.0))
    }

    fn turn(&self, y: Vec3, d: Vec3) -> Vec3 {
        let (v, [_, _, a2, a3]) = (self.stand.point(y).y, self.a);
        Vec3::new(2.0 * d.x, -(6.0 * a3).mul_add(v, 2.0 * a2) * d.y, 2.0 * d.z)
    }

    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        self.stand.chart(y, n)
    }

    fn tip(&self, _: Vec3) -> Vec3 {
        Vec3::Y
    }
}

impl Cubic {
    /// An upper bound of the radius anywhere in the slab, in units: the squared radius is no larger
    /// than the largest of its Bernstein coefficients.
    pub(super) fn widest(&self) -> f64 {
        let shift = scale2(self.stand.at - self.stand.frame.centre.y, -self.stand.frame.scale);
        let [l, r] = self.stand.slab.map(|y| y - shift);
        let [a0, a1, a2, a3] = self.a;
        let far = l.abs().max(r.abs());
        let size = ((a3.abs() * far + a2.abs()) * far + a1.abs()) * far + a0.abs();
        // The blossom at (l, l, l), (l, l, r), (l, r, r), (r, r, r).
        let blossom = |x: f64, y: f64, z: f64| {
            a0 + a1 * (x + y + z) / 3.0 + a2 * (x * y + y * z + z * x) / 3.0 + a3 * (x * y * z)
        };
        let most = blossom(l, l, l).max(blossom(l, l, r)).max(blossom(l, r, r)).max(blossom(r, r, r));
        (most.max(0.0) + 64.0 * U * size).sqrt() * (1.0 + 4.0 * U)
    }
}

/// The inner sheet of the torus with a tube of radius `r` about a circle of radius `R < r`, at the
/// height `v` above the circle's plane:
///
/// ```text
///   (√(x² + z²) + R)² + v² = r²
/// ```
///
/// With `Q = x² + v² + z² + R² - r²` both sheets are `Q² = 4R² (x² + z²)`; on the inner one
/// `Q <= 0`, zero only on the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spindle {
    pub(super) stand: Stand,
    /// The radius `R`, in units.
    pub(super) major: f64,
    /// The radius `r`, in units.
    pub(super) minor: f64,
}

impl Spindle {
    /// `Q` along a ray, negative on the inner sheet.
    #[inline(always)]
    pub(super) fn inner<T: Ring>(&self, ray: &RingRay<T>) -> Quadratic<T> {
        let [x, v, z] = self.stand.seen(ray);
        let [dx, dv, dz] = ray.d.clone();
        let reach = (T::exact(self.major).square() - T::exact(self.minor).square()) * ray.w.clone().square();
        Quadratic {
            a: dx.clone().square() + dv.clone().square() + dz.clone().square(),
            b: x.clone() * dx + v.clone() * dv + z.clone() * dz,
            c: x.square() + v.square() + z.square() + reach,
        }
    }

    /// An upper bound of the radius, in units.
    pub(super) fn widest(&self) -> f64 {
        ((self.minor - self.major) * (1.0 + 4.0 * U)).next_up()
    }
}

impl PolynomialSurface<5> for Spindle {
    fn frame(&self) -> Frame {
        self.stand.frame
    }

    /// `4R² (x² + z²) - Q²`: negative inside the inner sheet.
    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; 5] {
        let Quadratic { a: q2, b: q1, c: q0 } = self.inner(ray);
        let [x, _, z] = ray.o.clone();
        let [dx, _, dz] = ray.d.clone();
        let big = (T::exact(self.major).square() * ray.w.clone().square()).scale2(2);
        let across = [
            x.clone().square() + z.clone().square(),
            (x * dx.clone() + z * dz.clone()).scale2(1),
            dx.square() + dz.square(),
        ];
        let [n0, n1, n2] = across.map(|n| big.clone() * n);
        [
            n0 - q0.clone().square(),
            n1 - (q1.clone() * q0.clone()).scale2(2),
            n2 - (q2.clone() * q0).scale2(1) - q1.clone().square().scale2(2),
            -(q2.clone() * q1).scale2(2),
            -q2.square(),
        ]
    }

    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        self.stand.stretch(ray)
    }

    fn slopes(&self, y: Vec3) -> (Vec3, f64) {
        let p = self.stand.point(y);
        let (big, square) = (self.major * self.major, p.dot(p));
        let gap = (self.minor - self.major) * (self.minor + self.major);
        let q = square - gap;
        let g = Vec3::new(8.0 * big * p.x, 0.0, 8.0 * big * p.z) - p * (4.0 * q);
        // H = 8R² diag(1, 0, 1) - 4 Q I - 8 p pᵀ, a 64th further out.
        let far = (square.sqrt() + 1.0 / 64.0) * (1.0 + 1.0 / 1024.0);
        let bend = 8.0 * big + 4.0 * (q.abs() + 0.125 * far) + 8.0 * far * far;
        (g, bend * (1.0 + 1.0 / 1024.0))
    }

    fn turn(&self, y: Vec3, d: Vec3) -> Vec3 {
        let p = self.stand.point(y);
        let q = p.dot(p) - (self.minor - self.major) * (self.minor + self.major);
        let big = 8.0 * self.major * self.major;
        Vec3::new(big * d.x, 0.0, big * d.z) - d * (4.0 * q) - p * (8.0 * p.dot(d))
    }

    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        self.stand.chart(y, n)
    }

    fn tip(&self, _: Vec3) -> Vec3 {
        Vec3::Y
    }
}

/// The point of the axis at a height.
pub(super) fn on_axis(y: f64) -> Point3 {
    Point3::new(0.0, y, 0.0)
}

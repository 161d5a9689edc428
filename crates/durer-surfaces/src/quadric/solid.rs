//! A [`Shape`] as a [`Surface`].

use crate::quadric::body::{Frame, Shape, View, rounded};
use crate::quadric::form::Rounded;
use crate::{LocalPoint, LocalRay, Need, Root, Side, Sink, Solidity, Surface, SurfacePoint};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Aabb, Point3, U, Vec3};

/// Pays for results below the normal range.
const TINY: f64 = f64::from_bits(4);

/// A shape with its rounded polynomials: a surface.
#[derive(Clone, Debug)]
pub struct Body<S> {
    shape: S,
    forms: Box<[Rounded]>,
    frame: Frame,
}

impl<S: Shape> Body<S> {
    /// Rounds the polynomials of the shape once.
    pub(crate) fn of(shape: S) -> Self {
        Self { forms: rounded(&shape), frame: shape.frame(), shape }
    }

    /// The numbers that define it.
    pub fn shape(&self) -> &S {
        &self.shape
    }

    #[inline(always)]
    pub(crate) fn view(&self) -> View<'_, S> {
        View { shape: &self.shape, forms: &self.forms, frame: self.frame, walls: self.shape.walls() }
    }
}

impl<S: Shape> Surface for Body<S> {
    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.view().roots(ray, sink);
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.view().resolve(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        if self.shape.walls() < self.shape.faces() { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.solidity() == Solidity::Open { Side::Out } else { self.view().side(point) }
    }
}

impl<S: Shape> View<'_, S> {
    /// All crossings in the ray's range, ascending.
    #[inline(always)]
    pub(crate) fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        let ray = ray.recentre(self.frame.centre, self.frame.scale);
        let events = self.events(&ray, sink.range());
        self.push(&events, &ray, sink);
    }

    /// The point of a root: projected once onto the face by Newton's method, with its bounds.
    pub(crate) fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let Frame { centre, scale, .. } = self.frame;
        let face = root.face as usize;
        let form = &self.forms[face];
        let at = ray.recentre(centre, scale);
        let s = root.s;
        let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;

        let (f, half) = form.at(y, Vec3::ZERO);
        let slope = half.dot(half);
        let newton = if slope > 0.0 { f.v / (2.0 * slope) } else { 0.0 };
        // Where the gradient all but vanishes a step may overshoot: not taken.
        let y1 = y - half * newton;
        let y1 = if newton.is_finite() && form.at(y1, Vec3::ZERO).0.v.abs() <= f.v.abs() { y1 } else { y };

        // The world's numbers; what their rounding loses is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
        let (px, lx) = axis(centre.x, y1.x);
        let (py, ly) = axis(centre.y, y1.y);
        let (pz, lz) = axis(centre.z, y1.z);
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);

        let off = self.off(form, p, y1, lost);
        let (ng, gradient) = off.normal;
        let back = |x: f64| scale2(x, scale);
        let width = at.width(root.lo, root.hi);
        let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);
        let mut point =
            SurfacePoint::new(p, dp.map(|x| back(x) + TINY), back(off.distance) + TINY, ng.to_normal());
        point.bend = scale2(form.bend / gradient, -scale);
        if need.contains(Need::UV) || need.contains(Need::DERIVATIVES) {
            let chart = self.shape.chart(face, y1, ng);
            point.uv = chart.uv;
            if need.contains(Need::DERIVATIVES) {
                // The normal is G / |G|, so it changes with v by (H v - n (n·H v)) / |G|.
                let turn = |v: Vec3| {
                    let hv = form.times(v) * 2.0;
                    (hv - ng * ng.dot(hv)) * (1.0 / gradient)
                };
                point.dpdu = chart.dpdu.map(back);
                point.dpdv = chart.dpdv.map(back);
                point.dndu = turn(chart.dpdu);
                point.dndv = turn(chart.dpdv);
            }
        }
        point
    }

    /// A distance along the normal that leaves the face on either side, for the point `y` of which the world's numbers `p` miss `lost`.
    ///
    /// From `|f(p)| <= η`, gradient `G` and `|Hessian| <= h`: a start at `p ± off n + τ`, where `τ` is what
    /// rounding adds away from the surface, has `|f| >= off |G| - h (off² + |τ|²) - η`; this is positive from
    /// `off = 2 η' / (|G| + √(|G|² - 4 h η'))` on, with `η' = η + h|τ|²`. `η` includes twice the error of an evaluation of `f`, so
    /// that a ray that starts there finds the sign of `f` in f64.
    fn off(&self, form: &Rounded, p: Point3, y: Vec3, lost: Vec3) -> Off {
        let (f, half) = form.at(y, y.abs() * U);
        let g = half * 2.0;
        let gradient = g.length();
        let h = form.bend;
        // Each coordinate moves at most 1.5 ulp, so 3 U, further than asked.
        let tau = scale2(p.to_vec().length(), -self.frame.scale) * (4.0 * U) + TINY;
        let eta = f.v.abs() + 2.0 * f.e + g.abs().dot(lost) + h * lost.dot(lost);
        let eta = (eta + h * tau * tau) * (1.0 + 32.0 * U);
        let square = gradient * gradient - 4.0 * h * eta;
        if square > 0.0 && gradient > 0.0 {
            let distance = 2.0 * eta / (gradient + square.sqrt()) * (1.0 + 32.0 * U);
            return Off { distance, normal: (g * (1.0 / gradient), gradient) };
        }
        // A tip: f grows with the square of the distance along the axis.
        let n = self.shape.tip_normal();
        let growth = n.dot(form.times(n)).abs();
        let distance = if growth > 0.0 { (8.0 * eta / growth).sqrt() } else { eta.sqrt() };
        Off { distance, normal: (n, gradient.max(h * distance)) }
    }
}

/// What [`View::off`] finds.
struct Off {
    distance: f64,
    /// The unit normal and the length of the gradient.
    normal: (Vec3, f64),
}

//! A [`QuadricFaces`] as a [`Surface`].

use crate::faces::boolean_faces::{QuadricFaces, View, rounded};
use crate::faces::chart::{Frame, Tip, tangents};
use crate::faces::form::Rounded;
use crate::packet::FilterSource;
use crate::{
    Accelerate, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface, SurfacePoint,
};
use durer_math::eft::{scale2, two_sum};
use durer_math::{Aabb, Affine, Dd, EFloat, Isa, Point3, Ring, U, Vec3, elementary};

/// Covers results below the normal range, in units of the shape's size. Far more than needed, so
/// that it and its square are normal numbers: on many CPUs an operation with a subnormal operand
/// takes a hundred times as long.
const TINY: f64 = durer_math::scale::pow2(-500);

/// A surface with quadric faces: a shape with its rounded polynomials.
#[derive(Clone, Debug)]
pub struct QuadricSolid<S> {
    shape: S,
    forms: Box<[Rounded]>,
    frame: Frame,
}

impl<S: QuadricFaces> QuadricSolid<S> {
    /// Rounds the polynomials of the shape once.
    pub(crate) fn of(shape: S) -> Self {
        Self { forms: rounded(&shape), frame: shape.frame(), shape }
    }

    /// The numbers that define the surface.
    pub fn shape(&self) -> &S {
        &self.shape
    }

    #[inline(always)]
    pub(crate) fn view(&self) -> View<'_> {
        View { shape: &self.shape, forms: &self.forms, frame: self.frame, walls: self.shape.walls() }
    }
}

impl<S: QuadricFaces> Surface for QuadricSolid<S> {
    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        let view = self.view();
        if !view.is_passed_by(ray) {
            view.roots(ray, sink);
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.view().resolve(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        if self.shape.walls() < self.shape.faces() { Solidity::Open } else { Solidity::Solid }
    }

    #[inline(always)]
    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.solidity() == Solidity::Open { Side::Out } else { self.view().side(point) }
    }
}

impl<S: QuadricFaces> Accelerate for QuadricSolid<S> {
    fn name(&self) -> &'static str {
        self.shape.name()
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        self.shape.bounds_through(map)
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::of_shape(&self.shape)
    }
}

impl View<'_> {
    /// Whether the line certainly misses the shape.
    #[inline(always)]
    pub(crate) fn is_passed_by(&self, ray: &LocalRay<'_>) -> bool {
        let Frame { centre, scale, reach } = self.frame;
        reach < f64::INFINITY && ray.passes_by(centre, scale2(reach, scale))
    }

    /// All crossings in the ray's range, ascending.
    #[inline(never)]
    pub(crate) fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        Isa::detect().run(
            #[inline(always)]
            || {
                let ray = ray.recentre(self.frame.centre, self.frame.scale);
                let events = self.events(&ray, sink.range());
                let _ = self.push(&events, &ray, sink);
            },
        );
    }

    /// The point of a root: projected once onto the face by Newton's method, with its bounds.
    #[inline(never)]
    pub(crate) fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        Isa::detect().run(
            #[inline(always)]
            || self.resolve_here(ray, root, need),
        )
    }

    #[inline(always)]
    fn resolve_here(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let Frame { centre, scale, .. } = self.frame;
        let face = root.face as usize;
        let form = &self.forms[face];
        let at = ray.recentre(centre, scale);
        let s = root.s;
        let y = Vec3::new(s.mul_add(at.d.x, at.o.x), s.mul_add(at.d.y, at.o.y), s.mul_add(at.d.z, at.o.z));
        let e_y = at.o_err + at.d_err * s.abs() + y.abs() * U;

        let (y1, f, half) = project(form, y);

        // The world's coordinates; their rounding is known exactly.
        let axis = |c: f64, y: f64| two_sum(c, scale2(y, scale));
        let (px, lx) = axis(centre.x, y1.x);
        let (py, ly) = axis(centre.y, y1.y);
        let (pz, lz) = axis(centre.z, y1.z);
        let p = Point3::new(px, py, pz);
        let lost = Vec3::new(lx, ly, lz).map(|l| scale2(l.abs(), -scale) + TINY);

        let width = at.width(root);
        let dp = (e_y + at.d.abs() * width + (y1 - y).abs() * (1.0 + 4.0 * U) + lost) * (1.0 + 16.0 * U);
        let off = self.off(face, p, (f, half), lost, dp.x + dp.y + dp.z);
        let (ng, gradient) = off.normal;
        let back = |x: f64| scale2(x, scale);
        let mut point = SurfacePoint::new(
            p,
            dp.map(|x| back(x) + f64::MIN_POSITIVE),
            back(off.distance) + f64::MIN_POSITIVE,
            ng.to_normal(),
        );
        (point.bend, point.slack) = match off.slack > 0.0 {
            true => (f64::INFINITY, back(off.slack)),
            false => (scale2(form.bend / gradient, -scale), 0.0),
        };
        point.aside = off.aside.map(back);
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

    /// A distance along the normal that leaves the face on either side, for a point at which `f`
    /// and half its gradient are given. `lost` is the rounding of the world's coordinates `p`.
    ///
    /// From `|f(p)| <= η`, gradient `G` and `|Hessian| <= h`: a start at `p ± off n + τ`, where `τ`
    /// is what rounding adds away from the surface, has `|f| >= off |G| - h (off² + |τ|²) - η`;
    /// this is positive from `off = 2 η' / (|G| + √(|G|² - 4 h η'))` on, with `η' = η + h|τ|²`. `η`
    /// includes twice the error of an evaluation of `f`, so that a ray that starts there finds the
    /// sign of `f` in f64.
    ///
    /// `err` bounds the distance from `y` to the crossing. If a tip lies within that and a few
    /// roundings of the coordinates, the point counts as the tip: no point near it could be
    /// distinguished from the tip.
    #[inline(always)]
    fn off(&self, face: usize, p: Point3, (f, half): (EFloat, Vec3), lost: Vec3, err: f64) -> Off {
        let form = &self.forms[face];
        let g = half * 2.0;
        let gradient = g.length();
        let h = form.bend;
        // Each coordinate moves by up to 1.5 ulp, so 3 U, more than intended.
        let tau = scale2(p.to_vec().max_abs(), -self.frame.scale) * (6.0 * U) + TINY;
        let away = 2.0 * (g.abs().dot(lost) + h * (lost.dot(lost) + tau * tau));
        let normal = (g * (1.0 / gradient), gradient);
        // On a cone `G / h` is about the distance from its axis. This near the tip the normal may
        // turn by a sixteenth within those errors.
        let near_tip = gradient <= 16.0 * h * (err + tau);
        let tip = if near_tip { self.shape.tip(face) } else { None };
        if tip.is_none() {
            let eta = f.v.abs() + 2.0 * f.e + away;
            // Where f64 has a large error (a thin needle), the exact f at the rounded p gives a
            // smaller bound.
            let eta =
                if 4.0 * h * eta < 1e-3 * gradient * gradient { eta } else { self.value_at(face, p) + away };
            let square = gradient * gradient - 4.0 * h * eta;
            if square > 0.0 {
                let distance = 2.0 * eta / (gradient + square.sqrt()) * (1.0 + 64.0 * U);
                return Off { distance, normal, slack: 0.0, aside: Vec3::ZERO };
            }
            if gradient > 0.0 && gradient.is_finite() {
                let distance = (4.0 * eta / gradient).max((4.0 * eta / h).sqrt());
                return Off { distance, normal, slack: 0.0, aside: Vec3::ZERO };
            }
        }
        // A tip: f changes with the square of the distance a along the axis n, and for any
        // displacement e with |e| <= ε
        // |f(p + a n + e)| >= a² |n·Qn| - a (|G| + 2 ε |Qn|) - (η + ε |G| + ε² h / 2).
        let Tip { normal: n, is_double } = tip.unwrap_or(Tip { normal: Vec3::Z, is_double: false });
        // As much again for a placement, and the rounding of starts aside. The point is about `err`
        // away from the tip, so a slack of that size costs little.
        let slack = err + tau + lost.length() + TIP_SLACK;
        let e = 3.0 * slack;
        let c = f.v.abs() + 2.0 * f.e + away + e * gradient + 0.5 * e * e * h;
        let clear = |n: Vec3| {
            let qn = form.times(n);
            let growth = n.dot(qn).abs().max(f64::MIN_POSITIVE);
            let b = gradient + 2.0 * e * qn.length();
            let distance = (b + (b * b + 4.0 * growth * c).sqrt()) / (2.0 * growth) * (1.0 + 32.0 * U);
            distance.min(f64::MAX)
        };
        let (distance, gradient) = (clear(n), gradient.max(TIP_SLACK * h));
        let across = if is_double { across(form, n) } else { None };
        let Some(across) = across else {
            return Off { distance, normal: (n, gradient), slack, aside: Vec3::ZERO };
        };
        // Both halves: one start is on the axis and the other across it, each as far from the tip
        // as the longer of both ways.
        let way = distance.max(clear(across));
        let (inside, outside) = if n.dot(form.times(n)) < 0.0 { (n, across) } else { (across, n) };
        let apart = outside - inside;
        let length = apart.length();
        Off {
            distance: 0.5 * way * length * (1.0 + 8.0 * U),
            normal: (apart * (1.0 / length), gradient),
            slack,
            aside: (inside + outside) * (0.5 * way),
        }
    }

    /// An upper bound of `|f|` at a point in the world's coordinates.
    #[cold]
    fn value_at(&self, face: usize, p: Point3) -> f64 {
        type N = EFloat<Dd>;
        let Frame { centre, scale, .. } = self.frame;
        let y = [0, 1, 2].map(|i| (N::exact(p[i]) - N::exact(centre[i])).scale2(-scale));
        self.shape.double(face).at(&y, &N::exact(1.0)).magnitude()
    }
}

/// Moves `y` onto the face by Newton's method along the gradient: usually one step; more if the ray
/// came from so far away that the error of `y` exceeds the face's size. Returns the point with `f`
/// and half its gradient there.
#[inline(always)]
fn project(form: &Rounded, mut y: Vec3) -> (Vec3, EFloat, Vec3) {
    let (first, mut half) = form.at(y, y.abs() * U);
    // The point is on the face within the error of f64: a step would follow rounding, and would be
    // long where the gradient is small.
    if first.v.abs() <= first.e {
        return (y, first, half);
    }
    let mut f = first.v;
    for _ in 0..64 {
        let step = f / (2.0 * half.dot(half));
        let next = y - half * step;
        let (f1, half1) = form.at(next, next.abs() * U);
        // Where the gradient almost vanishes a step may overshoot; then it is not taken.
        if !(step.is_finite() && f1.v.abs() < f.abs()) {
            break;
        }
        if f1.v.abs() <= 4.0 * f1.e {
            return (next, f1, half1);
        }
        (y, f, half) = (next, f1.v, half1);
    }
    let (f, half) = form.at(y, y.abs() * U);
    (y, f, half)
}

/// The direction across `n` along which the quadratic part of the form has the other sign than along
/// `n`, and the largest value; `None` if there is none.
fn across(form: &Rounded, n: Vec3) -> Option<Vec3> {
    let (u, v) = tangents(n);
    let (qu, qv) = (form.times(u), form.times(v));
    let (a, b, c) = (u.dot(qu), u.dot(qv), v.dot(qv));
    // The eigenvalues of the form across `n`, and their eigenvectors.
    let (middle, half) = (0.5 * (a + c), 0.5 * elementary::hypot(a - c, 2.0 * b));
    let sign = -n.dot(form.times(n)).signum();
    let value = middle + sign * half;
    let (one, other) = (u * b + v * (value - a), u * (value - c) + v * b);
    let way = if one.length() > other.length() { one } else { other };
    let way = way.normalized().unwrap_or(u);
    (value * sign > 0.0).then_some(way)
}

/// How far, in units, a point may at least be moved near a tip.
const TIP_SLACK: f64 = 1.0 / (1u64 << 40) as f64;

/// The result of [`View::off`].
struct Off {
    distance: f64,
    /// The unit normal and the length of the gradient.
    normal: (Vec3, f64),
    /// Where the gradient vanishes, or almost vanishes, see [`SurfacePoint::slack`]; else zero.
    slack: f64,
    /// See [`SurfacePoint::aside`].
    aside: Vec3,
}

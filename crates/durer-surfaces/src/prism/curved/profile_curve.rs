//! One piece of a curved outline: a cubic curve in the plane.

use super::super::packet::ProfileCurve8;
use super::Sweep;
use super::spline::Bezier;
use crate::LocalRay;
use durer_math::eft::scale2;
use durer_math::{EFloat, Point3, Ring, U, Vec3};
use durer_roots::bernstein::Bernstein;

/// The origin and the unit of length of a prism's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    pub(super) sweep: Sweep,
    /// The middle of a linear sweep, the apex of a conic one.
    pub(super) centre: Point3,
    pub(super) scale: i32,
}

impl View {
    /// A point of the outlines in these coordinates. For a conic sweep they are ratios of lengths,
    /// and have no unit.
    #[inline(always)]
    pub(super) fn seen<T: Ring>(&self, [x, z]: [f64; 2]) -> [T; 2] {
        match self.sweep {
            Sweep::Linear => [
                (T::exact(x) - T::exact(self.centre.x)).scale2(-self.scale),
                (T::exact(z) - T::exact(self.centre.z)).scale2(-self.scale),
            ],
            Sweep::Conic => [T::exact(x), T::exact(z)],
        }
    }
}

/// A cubic curve `c(u)`, `u` from 0 to 1, in the plane of the outlines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ProfileCurve {
    /// Its control points, `[x, z]`.
    pub(super) points: Bezier,
    /// The control points in the view's coordinates: all x, all z, within `slack` of the exact
    /// ones.
    pub(super) seen: [[f64; 4]; 2],
    pub(super) slack: [f64; 2],
    /// Upper bounds of their magnitudes.
    pub(super) reach: [f64; 2],
    /// The coefficients of the powers of `y = u - 1/2` in x and z, in the view's coordinates.
    pub(super) powers: [[EFloat; 2]; 4],
}

impl ProfileCurve {
    pub(super) fn new(points: Bezier, view: &View) -> Self {
        let near: [[EFloat; 2]; 4] = points.map(|p| view.seen(p));
        let axis = |k: usize| near.map(|p| p[k].v);
        let most =
            |f: &dyn Fn(EFloat) -> f64| [0, 1].map(|k| near.iter().fold(0.0, |m: f64, p| m.max(f(p[k]))));
        let mut piece = Self {
            points,
            seen: [axis(0), axis(1)],
            slack: most(&|x| x.e),
            reach: most(&EFloat::magnitude),
            powers: [[EFloat::zero(); 2]; 4],
        };
        piece.powers = piece.in_powers(view);
        piece
    }

    /// Whether a ray certainly misses everything that the piece sweeps: all control points are on
    /// one side of its trace. This is the first and cheapest test.
    ///
    /// With `R` the largest `|x - ox| + |z - oz|` and `D = |dx| + |dz|`, the values round by
    /// `4 U D R`, and the ray's own errors add `D e_o + R e_d` and their product, twice. The form
    /// of a conic sweep is a cross product, of which each component rounds by `3 U |o|₁ |d|₁`,
    /// times `1 + |x| + |z|`.
    #[inline(always)]
    pub(super) fn is_passed_by(&self, ray: &LocalRay<'_>, sweep: Sweep) -> bool {
        let (o, d) = (ray.o, ray.d);
        let (e_o, e_d) = (ray.o_err.max_abs(), ray.d_err.max_abs());
        let (mut least, mut most, mut far) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        let (size, own) = match sweep {
            Sweep::Linear => {
                for [x, z] in self.points {
                    let (x, z) = (x - o.x, z - o.z);
                    let g = d.z * x - d.x * z;
                    (least, most) = (least.min(g), most.max(g));
                    far = far.max(x.abs() + z.abs());
                }
                let size = d.x.abs() + d.z.abs();
                (size * far, 2.0 * (size * e_o + far * e_d + e_o * e_d))
            }
            Sweep::Conic => {
                let [a, b, c] = [o.y * d.z - o.z * d.y, o.z * d.x - o.x * d.z, o.x * d.y - o.y * d.x];
                for [x, z] in self.points {
                    let g = a * x + c * z + b;
                    (least, most) = (least.min(g), most.max(g));
                    far = far.max(x.abs() + z.abs());
                }
                let sum = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
                let (o, d, far) = (sum(o.to_vec()), sum(d), 1.0 + far);
                (o * d * far, 2.0 * far * (d * e_o + o * e_d + e_o * e_d))
            }
        };
        // False if one of them is NaN.
        let e = (size * (16.0 * U) + own) * (1.0 + 32.0 * U) + durer_math::scale::pow2(-900);
        least > e || most < -e
    }

    /// The curve for packets.
    pub(super) fn for_lanes(&self) -> ProfileCurve8 {
        let larger = |[x, z]: [f64; 2]| x.max(z);
        ProfileCurve8::new(self.seen, larger(self.slack), larger(self.reach))
    }

    /// The coefficients of the powers of `y = u - 1/2`, in any ring.
    ///
    /// `(1-u)³ = 1/8 - 3/4 y + 3/2 y² - y³` and `3u(1-u)² = 3/8 - 3/4 y - 3/2 y² + 3 y³`; the
    /// others by symmetry.
    #[inline(always)]
    pub(super) fn in_powers<T: Ring>(&self, view: &View) -> [[T; 2]; 4] {
        #[inline(always)]
        fn axis<T: Ring>(a: T, b: T, c: T, d: T) -> [T; 4] {
            let three = || T::exact(3.0);
            let (ends, inner) = (a.clone() + d.clone(), b.clone() + c.clone());
            let (way, step) = (d - a, c - b);
            [
                (ends.clone() + three() * inner.clone()).scale2(-3),
                three() * (way.clone() + step.clone()).scale2(-2),
                three() * (ends - inner).scale2(-1),
                way - three() * step,
            ]
        }
        let p = &self.points;
        let ([ax, az], [bx, bz]) = (view.seen(p[0]), view.seen(p[1]));
        let ([cx, cz], [dx, dz]) = (view.seen(p[2]), view.seen(p[3]));
        let ([x0, x1, x2, x3], [z0, z1, z2, z3]) = (axis(ax, bx, cx, dx), axis(az, bz, cz, dz));
        [[x0, z0], [x1, z1], [x2, z2], [x3, z3]]
    }

    /// The point at `y = u - 1/2`, in the view's coordinates.
    #[inline(always)]
    pub(super) fn at<T: Ring>(powers: &[[T; 2]; 4], y: &T) -> [T; 2] {
        // A closure might be compiled by itself, without fused operations.
        #[inline(always)]
        fn axis<T: Ring>(powers: &[[T; 2]; 4], y: &T, k: usize) -> T {
            let [a, b, c, d] = [&powers[0][k], &powers[1][k], &powers[2][k], &powers[3][k]];
            ((d.clone() * y.clone() + c.clone()) * y.clone() + b.clone()) * y.clone() + a.clone()
        }
        [axis(powers, y, 0), axis(powers, y, 1)]
    }

    /// The first and second derivative at `y = u - 1/2`, rounded. They are computed from
    /// differences of control points, so that they are precise where they are small at an end of
    /// the curve.
    pub(super) fn slopes(&self, view: &View, y: f64) -> ([f64; 2], [f64; 2]) {
        let (u, v) = (0.5 + y, 0.5 - y);
        let unit = |x: f64| if view.sweep == Sweep::Linear { scale2(x, -view.scale) } else { x };
        let step = |i: usize, k: usize| unit(self.points[i + 1][k] - self.points[i][k]);
        let first = |k: usize| {
            let [a, b, c] = [0, 1, 2].map(|i| step(i, k));
            3.0 * (v * v * a + 2.0 * u * v * b + u * u * c)
        };
        let second = |k: usize| {
            let [a, b, c] = [0, 1, 2].map(|i| step(i, k));
            6.0 * (v * (b - a) + u * (c - b))
        };
        ([first(0), first(1)], [second(0), second(1)])
    }
}

/// The least and the greatest x and z of a curve: `[[x, x], [z, z]]`, rounded outward.
pub(crate) fn extent(points: &Bezier) -> [[f64; 2]; 2] {
    [0, 1].map(|k| {
        let b = points.map(|p| p[k]);
        [-greatest(b.map(|x| -x)), greatest(b)]
    })
}

/// An upper bound of the greatest value of a polynomial with these Bernstein coefficients, and
/// close to it. The part with the greatest coefficient is halved until that coefficient does not
/// exceed the greatest value found at an end.
pub(crate) fn greatest(b: [f64; 4]) -> f64 {
    let most = |b: &Bernstein<f64, 4>| b.b.iter().fold(f64::NEG_INFINITY, |m, &x| m.max(x)) + b.e;
    let ends = b[0].max(b[3]);
    let whole = Bernstein { b, e: 0.0 };
    if most(&whole) <= ends {
        return ends;
    }
    // All ends so far are values of the curve, up to rounding.
    let (mut open, mut least) = (vec![whole], ends);
    for _ in 0..64 {
        let Some((at, top)) = open.iter().map(most).enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return ends;
        };
        if top <= least {
            break;
        }
        let (l, r) = open.swap_remove(at).split(0.5);
        least = least.max(l.b[3]);
        open.extend([l, r]);
    }
    let top = open.iter().map(most).fold(ends, f64::max);
    // Adding the error rounds.
    if top > ends { top.next_up() } else { ends }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extents_hold_the_curve_and_little_more() {
        let cases: [[f64; 4]; 6] = [
            [0.0, 1.0, 2.0, 3.0],
            [0.0, 4.0, 4.0, 0.0],
            [1.0, -3.0, 7.0, 0.5],
            [5.0, 5.0, 5.0, 5.0],
            [0.0, 1e6, -1e6, 1.0],
            [1.0, 1.0 + 1e-9, 1.0 + 1e-9, 1.0],
        ];
        for b in cases {
            let at = |u: f64| {
                let v = 1.0 - u;
                v * v * v * b[0] + 3.0 * u * v * (v * b[1] + u * b[2]) + u * u * u * b[3]
            };
            let seen = (0..=100_000).map(|i| at(f64::from(i) / 100_000.0)).fold(f64::NEG_INFINITY, f64::max);
            let size = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let found = greatest(b);
            assert!(found >= seen - 1e-15 * size && found <= seen + 1e-8 * size, "{found} {seen} {b:?}");
        }
        assert_eq!(greatest([0.0, 1.0, 1.0, 0.0]).max(0.75), greatest([0.0, 1.0, 1.0, 0.0]));
    }
}

//! Eight rays in a surface's own coordinates, in which its equation is short.
//!
//! ```text
//!   y_i = row_i · h + c_i,   h counted from the filter's centre
//! ```
//!
//! Maps move the three linear functions in double-double, as they move the faces of a filter. Then
//! the functions are rounded to f64 once. Let `M` be the largest entry, `e_b` the error of an entry
//! from rounding and maps, and `e_c` that of a constant. A point's coordinates are wrong by at most
//! `|h|₁ k_b + k_c` and a direction's by `|d|₁ k_b`,
//!
//! ```text
//!   k_b = 8 U M + e_b,   k_c = 4 U |c| + e_c
//! ```
//!
//! which covers three fused products, the sum and the rounding of `h`.

use crate::faces::form::Form;
use durer_math::{Dd, EFloat, F8, Point3, Ring, U, Vec3};

type N = EFloat<Dd>;

/// The three functions before rounding, times one common number.
#[derive(Clone, Debug)]
pub(crate) struct OwnSketch {
    axes: [Form<N>; 3],
    gain: N,
}

/// The three functions in f64.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own {
    rows: [Vec3; 3],
    c: [f64; 3],
    k_b: f64,
    k_c: f64,
    /// An upper bound of the norm of the matrix of the rows.
    pub(crate) norm: f64,
}

impl OwnSketch {
    /// Coordinates in units of `2^scale` about `origin`, with the axes in this order, for points
    /// relative to `centre`.
    pub(crate) fn new(centre: Point3, origin: Point3, scale: i32, order: [usize; 3]) -> Self {
        let zero = || N::exact(0.0);
        let axes = order.map(|axis| {
            let mut n = [zero(), zero(), zero()];
            n[axis] = N::exact(1.0).scale2(-scale);
            let c = (N::exact(centre[axis]) - N::exact(origin[axis])).scale2(-scale);
            Form::half_space(n, c)
        });
        Self { axes, gain: N::exact(1.0) }
    }

    /// The coordinates of a surface moved by a map with this determinant. `moved` maps planes and
    /// multiplies them by the determinant.
    pub(crate) fn moved(self, det: N, moved: impl Fn(Form<N>) -> Form<N>) -> Self {
        Self { axes: self.axes.map(moved), gain: self.gain * det }
    }

    /// The rounded coordinates; `None` if the numbers are too large for f64 packets.
    pub(crate) fn round(&self) -> Option<Own> {
        let (mut largest, mut e_b, mut big_c, mut e_c) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let round = |x: N, largest: &mut f64, error: &mut f64| {
            let x = x / self.gain;
            *largest = largest.max(x.v.hi.abs());
            *error = error.max((x.v.lo.abs() + x.e) * (1.0 + 8.0 * U));
            x.v.hi
        };
        let mut rows = [Vec3::ZERO; 3];
        let mut c = [0.0; 3];
        for (i, form) in self.axes.iter().enumerate() {
            let mut row = [0.0; 3];
            for (x, b) in row.iter_mut().zip(&form.b) {
                *x = round(b.scale2(1), &mut largest, &mut e_b);
            }
            rows[i] = row.into();
            c[i] = round(form.c, &mut big_c, &mut e_c);
        }
        let most = super::source::LARGEST;
        let fits = |x: f64| x < most;
        if !(fits(largest) && fits(e_b) && fits(big_c) && fits(e_c)) {
            return None;
        }
        let square = rows.iter().map(|r| r.dot(*r)).sum::<f64>();
        Some(Own {
            rows,
            c,
            k_b: (8.0 * U * largest + e_b) * (1.0 + 8.0 * U),
            k_c: (4.0 * U * big_c + e_c) * (1.0 + 8.0 * U) + durer_math::scale::pow2(-500),
            norm: (square.sqrt() + 3.0 * e_b) * (1.0 + 16.0 * U),
        })
    }
}

impl Own {
    /// The coordinates of points.
    #[inline(always)]
    pub(crate) fn point(&self, h: Vec3<F8>) -> Vec3<F8> {
        let [x, y, z] = Vec3::splats(self.rows);
        let [a, b, c] = F8::splats(self.c);
        Vec3::new(plus(x, h, a), plus(y, h, b), plus(z, h, c))
    }

    /// The coordinates of directions.
    #[inline(always)]
    pub(crate) fn vector(&self, d: Vec3<F8>) -> Vec3<F8> {
        let [x, y, z] = Vec3::splats(self.rows);
        Vec3::new(dot(x, d), dot(y, d), dot(z, d))
    }

    /// The covector in the filter's coordinates that corresponds to one in these coordinates.
    #[inline(always)]
    pub(crate) fn covector(&self, g: Vec3<F8>) -> Vec3<F8> {
        let [x, y, z] = Vec3::splats(self.rows);
        Vec3::new(
            x.x.mul_add(g.x, y.x.mul_add(g.y, z.x * g.z)),
            x.y.mul_add(g.x, y.y.mul_add(g.y, z.y * g.z)),
            x.z.mul_add(g.x, y.z.mul_add(g.y, z.z * g.z)),
        )
    }

    /// A bound on the error of the coordinates of points with this `|h|₁`.
    #[inline(always)]
    pub(crate) fn point_error(&self, h1: F8) -> F8 {
        h1 * self.k_b + self.k_c
    }

    /// A bound on the error of the coordinates of directions with this `|d|₁`.
    #[inline(always)]
    pub(crate) fn vector_error(&self, d1: F8) -> F8 {
        d1 * self.k_b
    }
}

#[inline(always)]
pub(crate) fn dot(a: Vec3<F8>, b: Vec3<F8>) -> F8 {
    a.x.mul_add(b.x, a.y.mul_add(b.y, a.z * b.z))
}

/// `o + t d`.
#[inline(always)]
pub(crate) fn on(o: Vec3<F8>, t: F8, d: Vec3<F8>) -> Vec3<F8> {
    Vec3::new(t.mul_add(d.x, o.x), t.mul_add(d.y, o.y), t.mul_add(d.z, o.z))
}

/// The largest magnitude of a coordinate.
#[inline(always)]
pub(crate) fn largest(v: Vec3<F8>) -> F8 {
    v.x.abs().max(v.y.abs()).max(v.z.abs())
}

#[inline(always)]
fn plus(a: Vec3<F8>, b: Vec3<F8>, c: F8) -> F8 {
    a.x.mul_add(b.x, a.y.mul_add(b.y, a.z.mul_add(b.z, c)))
}

//! The side on which a ray passes an edge: the rule that triangles, meshes and polygons share.
//!
//! The sign of `U = d . ((b - o) x (a - o))` is the side. Where it is exactly zero, the ray is
//! moved symbolically (see [`durer_math::predicates`]): then it never meets an edge, two faces that
//! share one have opposite signs, and a closed mesh is crossed an even number of times. `U` does
//! not change when the origin moves along the ray, so the re-centred ray serves as a filter for
//! every ray, and what it leaves open is decided on the exact ray: the given one, or the exact
//! preimage of one under a placement.

use crate::RingRay;
use crate::planar::{AlongRay, Line, TINY, cross, dot, towards};
use core::cmp::Ordering;
use durer_math::{EFloat, EdgeRay, Isa, Point3, Ring, U, Vec3};

/// `U` for the edge from `a` to `b`.
pub(crate) struct EdgeForm {
    pub(crate) a: Point3,
    pub(crate) b: Point3,
    pub(crate) centre: Point3,
    pub(crate) scale: i32,
}

impl AlongRay for EdgeForm {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (a, b) =
            (towards(ray, self.a, self.centre, self.scale), towards(ray, self.b, self.centre, self.scale));
        Some(dot(&ray.d, &cross(&b, &a)))
    }
}

/// `((b - a) x d)_axis`.
pub(crate) struct MinorForm {
    pub(crate) a: Point3,
    pub(crate) b: Point3,
    pub(crate) axis: usize,
}

impl AlongRay for MinorForm {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (j, k) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let (ej, ek) = (T::exact(self.b[j]) - T::exact(self.a[j]), T::exact(self.b[k]) - T::exact(self.a[k]));
        Some(ej * ray.d[k].clone() - ek * ray.d[j].clone())
    }
}

/// The axes of the symbolic displacement: all but the first on which `|d|` is largest.
#[inline(always)]
pub(crate) fn displacement(d: Vec3) -> [usize; 2] {
    let m = d.abs();
    if m.x >= m.y && m.x >= m.z {
        [1, 2]
    } else if m.y >= m.z {
        [0, 2]
    } else {
        [0, 1]
    }
}

/// The side on which a ray passes the edge from `a` to `b`: `Some(0)` only if the edge is parallel
/// to the ray or has no length, `None` only if the ray is not exactly known.
#[cold]
#[inline(never)]
pub(crate) fn exact_side<L: Line>(line: &L, a: Point3, b: Point3) -> Option<i8> {
    Isa::detect().run(
        #[inline(always)]
        || {
            if let Some((o, d)) = line.given() {
                return Some(EdgeRay::new(o, d).edge(a, b).sign);
            }
            let (centre, scale) = line.view();
            let side = line.sign(&EdgeForm { a, b, centre, scale })?;
            if side.is_ne() {
                return Some(side as i8);
            }
            let [x, y, z] = line.running().d;
            for axis in displacement(Vec3::new(x.v, y.v, z.v)) {
                let minor = line.sign(&MinorForm { a, b, axis })?;
                if minor.is_ne() {
                    return Some(minor as i8);
                }
            }
            Some(0)
        },
    )
}

/// The sign of `U` for the edge from `a` to `b`, zero if the ray meets the edge's line; `None` only
/// if the ray is not exactly known.
#[cold]
#[inline(never)]
pub(crate) fn undisplaced_side<L: Line>(line: &L, a: Point3, b: Point3) -> Option<Ordering> {
    Isa::detect().run(
        #[inline(always)]
        || {
            if let Some((o, d)) = line.given() {
                let edge = EdgeRay::new(o, d).edge(a, b);
                let is_zero = edge.value == 0.0 && edge.error == 0.0;
                return Some(if is_zero { Ordering::Equal } else { edge.sign.cmp(&0) });
            }
            let (centre, scale) = line.view();
            line.sign(&EdgeForm { a, b, centre, scale })
        },
    )
}

/// The re-centred ray in plain f64, with bounds on the error of `U`: the filter before
/// [`exact_side`].
pub(crate) struct EdgeFilter {
    o: Vec3,
    d: Vec3,
    centre: Point3,
    scale: i32,
    o_err: f64,
    d_max: f64,
    d_err: f64,
}

impl EdgeFilter {
    #[inline(always)]
    pub(crate) fn new<L: Line>(line: &L) -> Self {
        let ray = line.running();
        let (centre, scale) = line.view();
        let most = |x: &[EFloat; 3]| x[0].e.max(x[1].e).max(x[2].e);
        let (o, d) = (Vec3::from(ray.o.map(|x| x.v)), Vec3::from(ray.d.map(|x| x.v)));
        Self { o, d, centre, scale, o_err: most(&ray.o), d_max: d.max_abs(), d_err: most(&ray.d) }
    }

    /// A vertex relative to the ray's point of closest approach.
    #[inline(always)]
    pub(crate) fn seen(&self, v: Point3) -> Vec3 {
        (v - self.centre).map(|x| durer_math::eft::scale2(x, -self.scale)) - self.o
    }

    /// A bound on the error of [`EdgeFilter::side`] for vertices whose coordinates relative to the
    /// ray are at most `reach`.
    ///
    /// The error of such a coordinate is at most `e = o_err + u (2 reach + |o|)`: one rounding of
    /// the difference, one of the subtraction of `o`, and the error of `o`. Each of the six terms
    /// `d_k b_i a_j` of `U` is a product of three such numbers and passes through at most four
    /// roundings.
    #[inline(always)]
    pub(crate) fn bound(&self, reach: f64) -> f64 {
        self.bound_about(reach, 0.0)
    }

    /// [`EdgeFilter::bound`] for vertices that are themselves known within `vertex_err` per axis,
    /// relative to the ray.
    #[inline(always)]
    pub(crate) fn bound_about(&self, reach: f64, vertex_err: f64) -> f64 {
        let e = U.mul_add(2.0 * reach + self.o.max_abs(), self.o_err + vertex_err);
        let square = reach * reach;
        let inputs = self.d_max.mul_add(e * (2.0 * reach + e), self.d_err * (reach + e) * (reach + e));
        let roundings = 4.0 * U * (1.0 + 16.0 * U) * self.d_max * square;
        // The factor covers the roundings of this bound, the floor covers underflow.
        (6.0 * (inputs + roundings)).mul_add(1.0 + 64.0 * U, TINY)
    }

    /// A bound on the error of a minor `a_i d_j - a_j d_i` of such a vertex and the direction.
    #[inline(always)]
    pub(crate) fn minor_bound(&self, reach: f64) -> f64 {
        let e = U.mul_add(2.0 * reach + self.o.max_abs(), self.o_err);
        let inputs = self.d_max.mul_add(e, self.d_err * (reach + e));
        let roundings = 2.0 * U * (1.0 + 16.0 * U) * self.d_max * reach;
        (2.0 * (inputs + roundings)).mul_add(1.0 + 64.0 * U, TINY)
    }

    /// `U` for the edge between two vertices relative to the ray.
    #[inline(always)]
    pub(crate) fn side(&self, a: Vec3, b: Vec3) -> f64 {
        let minor = |i: usize, j: usize| b[i].mul_add(a[j], -(b[j] * a[i]));
        self.d.dot(Vec3::new(minor(1, 2), minor(2, 0), minor(0, 1)))
    }
}

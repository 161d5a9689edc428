//! The leaves, and the interval of a line in one: of a polytope by its half-spaces (M. Cyrus, J.
//! Beck, "Generalized two- and three-dimensional clipping", *Computers & Graphics* 3, 1978), of a
//! ball by its quadratic.

use super::frame::{CellRay, TINY, level};
use super::{IfsError, IfsLeaf};
use crate::planar::{ThreePoints, cross, cross_and_error, dot, seen_from};
use crate::{AxisBox, RingRay, Sphere};
use durer_math::eft::{difference_of_products, scale2};
use durer_math::{Aabb, Dyadic, Point3, Ring, U, Vec3};

/// The corners of the tetrahedron of Sierpinski, which are its maps' shifts, too.
pub(super) const SIERPINSKI: [[f64; 3]; 4] =
    [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];

/// The leaf, relative to the centre of the set in units of `2^scale`.
#[derive(Clone, Debug)]
pub(super) enum Leaf {
    Polytope(Vec<HalfSpace>),
    Ball(Ball),
}

/// A face of a polytope: its points fulfil `n.y <= h`.
#[derive(Clone, Debug)]
pub(super) struct HalfSpace {
    n: Vec3,
    n_err: Vec3,
    h: f64,
    h_err: f64,
    /// The axis, if `n` is plus or minus its unit vector.
    axis: Option<usize>,
    pub(super) plane: ExactPlane,
}

/// The plane of a face, in the set's own coordinates.
#[derive(Clone, Debug)]
pub(super) enum ExactPlane {
    /// `n.x = h`, relative to the centre, in units of `2^scale`.
    Level { n: [f64; 3], h: f64, centre: Point3, scale: i32 },
    /// Through three points.
    Points(ThreePoints),
}

#[derive(Clone, Debug)]
pub(super) struct Ball {
    pub(super) centre: Point3,
    pub(super) radius: f64,
    /// The centre of the set, and the unit.
    from: Point3,
    scale: i32,
    c: [f64; 3],
    c_err: [f64; 3],
    r: f64,
}

/// An end of an interval, in a bracket.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    pub(super) s: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
    pub(super) face: u32,
    /// Whether this face certainly is the one.
    pub(super) sure: bool,
}

/// The facts about a line and a leaf that f64 arithmetic proves.
#[derive(Clone, Copy, Debug)]
pub(super) enum Quick {
    Miss,
    Through(Pass, Pass),
    Unsure,
}

/// A box that holds a leaf, which it checks.
pub(super) fn bounds(leaf: &IfsLeaf) -> Result<Aabb, IfsError> {
    Ok(match *leaf {
        IfsLeaf::Box(a, b) => AxisBox::new(a, b)?.into(),
        IfsLeaf::Sphere(centre, radius) => crate::Surface::bounds(&Sphere::new(centre, radius)?),
        IfsLeaf::Tetrahedron(corners) => {
            if !corners.iter().all(|p| p.is_finite()) {
                return Err(IfsError::Tetrahedron);
            }
            Aabb::from_points(corners)
        }
    })
}

/// The corners of each face of a tetrahedron, the one opposite to each corner, counter-clockwise as
/// seen from outside; `None` if it is flat.
pub(super) fn outward(p: &[Point3; 4]) -> Option<[[Point3; 3]; 4]> {
    let from = |i: usize| -> [Dyadic; 3] { seen_from(p[i], p[0], 0) };
    let volume = dot(&from(1), &cross(&from(2), &from(3)));
    if volume.is_zero() {
        return None;
    }
    let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
    let is_positive = volume.exact_sign().is_gt();
    Some(faces.map(|[a, b, c]| if is_positive { [p[a], p[b], p[c]] } else { [p[a], p[c], p[b]] }))
}

impl Leaf {
    pub(super) fn new(leaf: &IfsLeaf, centre: Point3, scale: i32) -> Result<Self, IfsError> {
        Ok(match *leaf {
            IfsLeaf::Box(a, b) => {
                let Aabb { min, max, .. } = Aabb::from_points([a, b]);
                let face = |i: usize| {
                    let (axis, sign) = (i / 2, if i & 1 == 0 { -1.0 } else { 1.0 });
                    let at = if i & 1 == 0 { min[axis] } else { max[axis] };
                    let mut n = [0.0; 3];
                    n[axis] = sign;
                    let (h, h_err) = level(at, centre[axis], scale);
                    HalfSpace {
                        n: n.into(),
                        n_err: Vec3::ZERO,
                        h: sign * h,
                        h_err,
                        axis: Some(axis),
                        plane: ExactPlane::Level { n, h: sign * at, centre, scale },
                    }
                };
                Self::Polytope((0..6).map(face).collect())
            }
            IfsLeaf::Sphere(at, radius) => {
                let (mut c, mut c_err) = ([0.0; 3], [0.0; 3]);
                for i in 0..3 {
                    (c[i], c_err[i]) = level(at[i], centre[i], scale);
                }
                let r = scale2(radius, -scale);
                Self::Ball(Ball { centre: at, radius, from: centre, scale, c, c_err, r })
            }
            IfsLeaf::Tetrahedron(corners) => {
                let faces = outward(&corners).ok_or(IfsError::Tetrahedron)?;
                Self::Polytope(
                    faces.iter().map(|points| HalfSpace::through(*points, centre, scale)).collect(),
                )
            }
        })
    }

    /// The tetrahedron of Sierpinski: the face opposite to the corner `v` lies in `-v.x = 1`.
    pub(super) fn sierpinski() -> Self {
        let face = |v: &[f64; 3]| {
            let n = v.map(|x| -x);
            HalfSpace {
                n: n.into(),
                n_err: Vec3::ZERO,
                h: 1.0,
                h_err: 0.0,
                axis: None,
                plane: ExactPlane::Level { n, h: 1.0, centre: Point3::ORIGIN, scale: 0 },
            }
        };
        Self::Polytope(SIERPINSKI.iter().map(face).collect())
    }

    /// The interval of the line in the leaf.
    #[inline(always)]
    pub(super) fn quick(&self, ray: &CellRay) -> Quick {
        match self {
            Self::Polytope(faces) => polytope(faces, ray),
            Self::Ball(ball) => ball.quick(ray),
        }
    }

    /// Bounds of the parameters in a polytope; `None` if there certainly are none.
    #[inline(always)]
    pub(super) fn reach(&self, ray: &CellRay) -> Option<(f64, f64)> {
        let Self::Polytope(faces) = self else { return Some((f64::NEG_INFINITY, f64::INFINITY)) };
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for face in faces {
            match face.meet(ray) {
                Meet::Crosses { lo, enters: true, .. } => near = near.max(lo),
                Meet::Crosses { hi, enters: false, .. } => far = far.min(hi),
                Meet::Outside => return None,
                Meet::Inside | Meet::Unknown => {}
            }
        }
        if near > far { None } else { Some((near, far)) }
    }
}

/// A line and the plane of a face.
enum Meet {
    Crosses {
        s: f64,
        lo: f64,
        hi: f64,
        enters: bool,
    },
    /// Along the plane, behind it.
    Inside,
    /// Along the plane, in front of it.
    Outside,
    Unknown,
}

impl HalfSpace {
    fn through(points: [Point3; 3], centre: Point3, scale: i32) -> Self {
        let unit = |p: Point3, from: Point3| (p - from).map(|x| scale2(x, -scale));
        let [a, b, c] = points;
        let (n, n_err) = cross_and_error(unit(b, a), unit(c, a));
        let from = unit(a, centre);
        let h = n.dot(from);
        let h_err = n.abs().dot(from.abs()) * (4.0 * U) + n_err.dot(from.abs());
        let h_err = h_err.mul_add(1.0 + 16.0 * U, TINY);
        Self {
            n,
            n_err,
            h,
            h_err,
            axis: None,
            plane: ExactPlane::Points(ThreePoints { points, centre, scale }),
        }
    }

    /// Height above the plane, and slope, each with its error.
    #[inline(always)]
    fn along(&self, ray: &CellRay) -> [(f64, f64); 2] {
        let pay = |e: f64| if e == 0.0 { 0.0 } else { e.mul_add(1.0 + 16.0 * U, TINY) };
        if let Some(axis) = self.axis {
            let n = self.n[axis];
            let height = n.mul_add(ray.o[axis], -self.h);
            let err = height.abs().mul_add(U, ray.o_err[axis] + self.h_err);
            return [(height, pay(err)), (n * ray.d[axis], ray.d_err[axis])];
        }
        let size = self.n.abs();
        let (o, d) = (Vec3::from(ray.o), Vec3::from(ray.d));
        let (o_err, d_err) = (Vec3::from(ray.o_err), Vec3::from(ray.d_err));
        let err = |v: Vec3, e: Vec3| size.dot(v.abs() * (3.0 * U) + e) + self.n_err.dot(v.abs() + e);
        let height = self.n.dot(o) - self.h;
        [
            (height, pay(height.abs().mul_add(U, err(o, o_err) + self.h_err))),
            (self.n.dot(d), pay(err(d, d_err))),
        ]
    }

    #[inline(always)]
    fn meet(&self, ray: &CellRay) -> Meet {
        let [(height, height_err), (slope, slope_err)] = self.along(ray);
        let least = slope.abs() - slope_err;
        if least > 0.0 {
            let s = -height / slope;
            let err = s.abs().mul_add(slope_err, height_err) / least;
            let err = s.abs().mul_add(U, err).mul_add(1.0 + 16.0 * U, TINY);
            // Stepping outward pays for the rounding of the sums.
            return Meet::Crosses {
                s,
                lo: (s - err).next_down(),
                hi: (s + err).next_up(),
                enters: slope < 0.0,
            };
        }
        if slope == 0.0 && slope_err == 0.0 {
            if height > height_err {
                return Meet::Outside;
            }
            if height < -height_err {
                return Meet::Inside;
            }
        }
        Meet::Unknown
    }

    /// The integer normal and distance of the face's plane, if it has them.
    pub(super) fn lattice(&self) -> Option<(&[f64; 3], i64)> {
        match &self.plane {
            ExactPlane::Level { n, h, .. } => Some((n, *h as i64)),
            ExactPlane::Points(_) => None,
        }
    }
}

impl ExactPlane {
    /// `n` and `h` in a ring, relative to the centre, in units of `2^scale`.
    pub(super) fn form<T: Ring>(&self) -> ([T; 3], T) {
        match self {
            Self::Level { n, h, centre, scale } => {
                let e = n.map(T::exact);
                let c = dot(&e, &crate::planar::exact3(centre.to_vec()));
                let h = (T::exact(*h) - c).scale2(-scale);
                (e, h)
            }
            Self::Points(points) => {
                let (a, n) = points.normal::<T>();
                let h = dot(&n, &a);
                (n, h)
            }
        }
    }

    /// Height above the plane, and slope, times `w`.
    pub(super) fn along<T: Ring>(&self, ray: &RingRay<T>) -> (T, T) {
        let (n, h) = self.form::<T>();
        (dot(&n, &ray.o) - h * ray.w.clone(), dot(&n, &ray.d))
    }
}

/// The last entry and the first exit.
#[inline(always)]
fn polytope(faces: &[HalfSpace], ray: &CellRay) -> Quick {
    let none = |s: f64| Pass { s, lo: s, hi: s, face: 0, sure: false };
    let (mut entry, mut exit) = (none(f64::NEG_INFINITY), none(f64::INFINITY));
    let (mut entry_rival, mut exit_rival) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut known = true;
    for (number, face) in faces.iter().enumerate() {
        match face.meet(ray) {
            Meet::Crosses { s, lo, hi, enters } => {
                let face = number as u32;
                if enters {
                    if s > entry.s {
                        entry_rival = entry_rival.max(entry.hi);
                        (entry.s, entry.face) = (s, face);
                        entry.lo = entry.lo.max(lo);
                        entry.hi = entry.hi.max(hi);
                    } else {
                        entry_rival = entry_rival.max(hi);
                        entry.lo = entry.lo.max(lo);
                        entry.hi = entry.hi.max(hi);
                    }
                } else if s < exit.s {
                    exit_rival = exit_rival.min(exit.lo);
                    (exit.s, exit.face) = (s, face);
                    exit.lo = exit.lo.min(lo);
                    exit.hi = exit.hi.min(hi);
                } else {
                    exit_rival = exit_rival.min(lo);
                    exit.lo = exit.lo.min(lo);
                    exit.hi = exit.hi.min(hi);
                }
            }
            Meet::Outside => return Quick::Miss,
            Meet::Inside => {}
            Meet::Unknown => known = false,
        }
    }
    if entry.lo > exit.hi {
        return Quick::Miss;
    }
    if known && entry.hi < exit.lo && entry.s.is_finite() && exit.s.is_finite() {
        entry.sure = entry.lo > entry_rival;
        exit.sure = exit.hi < exit_rival;
        return Quick::Through(entry, exit);
    }
    Quick::Unsure
}

impl Ball {
    /// From the line's point nearest to the centre, found twice: in a small copy's frame the ray
    /// begins far away.
    #[inline(always)]
    fn quick(&self, ray: &CellRay) -> Quick {
        let (o, d) = (Vec3::from(ray.o), Vec3::from(ray.d));
        let from = o - Vec3::from(self.c);
        let dd = d.dot(d);
        let first = -from.dot(d) / dd;
        let near = |s: f64| Vec3::new(s.mul_add(d.x, from.x), s.mul_add(d.y, from.y), s.mul_add(d.z, from.z));
        let at = first - near(first).dot(d) / dd;
        let p = near(at);
        let (mut e, mut de) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let err = ray.o_err[i] + self.c_err[i] + at.abs() * ray.d_err[i];
            e[i] = (from[i].abs() + p[i].abs()).mul_add(U, err).mul_add(1.0 + 8.0 * U, TINY);
            de[i] = ray.d_err[i];
        }
        let (e, de) = (Vec3::from(e), Vec3::from(de));
        let k = 4.0 * U * (1.0 + 16.0 * U);
        let a = dd;
        let e_a = k * a + de.dot(d.abs() * 2.0 + de);
        let b = p.dot(d);
        let e_b = k * p.abs().dot(d.abs()) + de.dot(p.abs()) + e.dot(d.abs() + de);
        let pp = p.dot(p);
        let c = (-self.r).mul_add(self.r, pp);
        let e_c = k * pp + U * c.abs() + e.dot(p.abs() * 2.0 + e) + TINY;
        let disc = difference_of_products(b, b, a, c);
        let e_disc = 2.0 * b.abs() * e_b + e_b * e_b + a * e_c + (c.abs() + e_c) * e_a;
        let e_disc = e_disc + 3.0 * U * (disc.abs() + TINY);
        let e_disc = e_disc.mul_add(1.0 + 64.0 * U, TINY);
        if disc < -e_disc {
            return Quick::Miss;
        }
        if !(disc > 2.0 * e_disc && e_a < 0.125 * a && disc.is_finite() && at.is_finite()) {
            return Quick::Unsure;
        }
        // |sqrt(x) - sqrt(v)| <= e / sqrt(v) for x >= v - e >= v / 2, since then the sum of the
        // roots exceeds sqrt(v).
        let root = disc.sqrt();
        let e_root = e_disc / root + root * U;
        let pass = |top: f64| {
            let q = top / a;
            let err = (e_b + e_root + top.abs() * U) / (a - e_a) + q.abs() * (e_a / (a - e_a) + 2.0 * U);
            let s = at + q;
            let err = (err + s.abs() * U).mul_add(1.0 + 64.0 * U, TINY);
            Pass { s, lo: (s - err).next_down(), hi: (s + err).next_up(), face: 0, sure: true }
        };
        let (entry, exit) = (pass(-b - root), pass(root - b));
        if entry.hi < exit.lo { Quick::Through(entry, exit) } else { Quick::Unsure }
    }

    /// `a`, `b`, `c` of `a s^2 + 2 b s + c`, which is negative inside.
    pub(super) fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let c: [T; 3] = seen_from(self.centre, self.from, self.scale);
        let mut i = 0;
        let o = ray.o.clone().map(|o| {
            let o = o - c[i].clone() * ray.w.clone();
            i += 1;
            o
        });
        let r = T::exact(self.radius).scale2(-self.scale) * ray.w.clone();
        [dot(&ray.d, &ray.d), dot(&o, &ray.d), dot(&o, &o) - r.square()]
    }

    /// The gradient of the ball's form at a point, times half its `w`.
    pub(super) fn gradient<T: Ring>(&self, ray: &RingRay<T>) -> [T; 3] {
        let c: [T; 3] = seen_from(self.centre, self.from, self.scale);
        let [x, y, z] = ray.o.clone();
        let [cx, cy, cz] = c;
        let w = || ray.w.clone();
        [x - cx * w(), y - cy * w(), z - cz * w()]
    }
}

/// The parameters that a line may have in a box; `None` if there certainly are none (T. L. Kay, J.
/// T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986). A direction with a relative error above
/// `2^-20` gives no bound.
#[inline(always)]
pub(super) fn slabs(bounds: &Aabb, ray: &CellRay) -> Option<(f64, f64)> {
    const SURE: f64 = durer_math::scale::pow2(-20);
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (o, d, e) = (ray.o[axis], ray.d[axis], ray.o_err[axis]);
        let (lo, hi) = (bounds.min[axis] - o, bounds.max[axis] - o);
        let (lo, hi) = (lo - e - lo.abs() * (2.0 * U), hi + e + hi.abs() * (2.0 * U));
        if d == 0.0 && ray.d_err[axis] == 0.0 {
            if lo > 0.0 || hi < 0.0 {
                return None;
            }
            continue;
        }
        let inverse = 1.0 / d;
        let turn = ray.d_err[axis] * inverse.abs();
        if turn <= SURE {
            let (a, b) = (lo * inverse, hi * inverse);
            let (a, b) = if d > 0.0 { (a, b) } else { (b, a) };
            // The direction's error to second order, and three roundings.
            let wide = turn * (1.0 + 2.0 * SURE) + 4.0 * U;
            near = near.max(a - a.abs() * wide - TINY);
            far = far.min(b + b.abs() * wide + TINY);
        }
    }
    if near > far { None } else { Some((near, far)) }
}

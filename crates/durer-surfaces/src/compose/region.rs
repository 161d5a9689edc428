//! Closed sets that surfaces are clipped by: solids with plane and quadric faces, half-spaces,
//! boxes, and the closures of their complements.

use super::clip::in_parents_parameter;
use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::chart::{Chart, Frame, tangents};
use crate::faces::form::{Form, Rounded};
use crate::packet::FilterSource;
use crate::quadric::solid::QuadricSolid;
use crate::{LocalRay, Root};
use arrayvec::ArrayVec;
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Interval, Isa, Normal3, Point3, Ray, Ring, Vec3};
use durer_roots::quadratic::Quadratic;
use std::sync::Arc;

/// The box `min <= x <= max` as a region.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Block {
    min: Point3,
    max: Point3,
}

/// The half-space `n·x <= distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HalfSpace {
    normal: Normal3,
    distance: f64,
}

/// A closed set bounded by planes and quadrics, or the closure of its complement, placed by a map.
#[derive(Clone)]
pub struct Region {
    faces: Arc<dyn Faces>,
    map: Option<Affine>,
    inverse: bool,
    bounds: Aabb,
    /// Boxes that hold the region before it is placed, and the closure of its complement; for
    /// half-spaces they are bounded on one side only.
    slabs: [Aabb; 2],
}

impl core::fmt::Debug for Region {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { map, inverse, bounds, .. } = self;
        f.debug_struct("Region")
            .field("map", map)
            .field("inverse", inverse)
            .field("bounds", bounds)
            .finish_non_exhaustive()
    }
}

/// The faces of a region: [`QuadricFaces`] without the generic methods.
trait Faces: Send + Sync {
    fn frame(&self) -> Frame;
    fn forms(&self) -> &[Rounded];
    fn exact(&self, face: usize) -> Form<Dyadic>;
    fn wide(&self, face: usize) -> Form<EFloat<Dd>>;
    fn sketch(&self) -> FilterSource;
}

impl<S: QuadricFaces> Faces for QuadricSolid<S> {
    fn frame(&self) -> Frame {
        self.shape().frame()
    }

    fn forms(&self) -> &[Rounded] {
        self.view().forms
    }

    fn exact(&self, face: usize) -> Form<Dyadic> {
        self.shape().form(face)
    }

    fn wide(&self, face: usize) -> Form<EFloat<Dd>> {
        self.shape().form(face)
    }

    fn sketch(&self) -> FilterSource {
        FilterSource::of_shape(self.shape())
    }
}

/// The face of a half-space in a frame at the origin. A power of two scales its normal to about one.
fn plane<T: Ring>(n: [f64; 3], distance: f64) -> Form<T> {
    let k = -exponent(Vec3::from(n).max_abs());
    Form::half_space(n.map(|x| T::exact(x).scale2(k)), -T::exact(distance).scale2(k))
}

/// Two tangents and the coordinates along them.
fn plane_chart(y: Vec3, n: Vec3) -> Chart {
    let (u, v) = tangents(n);
    Chart { uv: [u.dot(y), v.dot(y)], dpdu: u, dpdv: v }
}

const ORIGIN: Frame = Frame { centre: Point3::ORIGIN, scale: 0, reach: f64::INFINITY };

impl QuadricFaces for Block {
    fn name(&self) -> &'static str {
        "box"
    }

    fn frame(&self) -> Frame {
        ORIGIN
    }

    fn faces(&self) -> usize {
        6
    }

    #[inline(always)]
    fn form<T: Ring>(&self, face: usize) -> Form<T> {
        let (axis, upper) = (face / 2, face % 2 == 1);
        let mut n = [0.0; 3];
        n[axis] = if upper { 1.0 } else { -1.0 };
        plane(n, if upper { self.max[axis] } else { -self.min[axis] })
    }

    fn bounds(&self) -> Aabb {
        Aabb::new(self.min, self.max)
    }

    fn chart(&self, _: usize, y: Vec3, n: Vec3) -> Chart {
        plane_chart(y, n)
    }
}

impl QuadricFaces for HalfSpace {
    fn name(&self) -> &'static str {
        "half-space"
    }

    fn frame(&self) -> Frame {
        ORIGIN
    }

    fn faces(&self) -> usize {
        1
    }

    #[inline(always)]
    fn form<T: Ring>(&self, _: usize) -> Form<T> {
        plane(self.normal.to_array(), self.distance)
    }

    fn bounds(&self) -> Aabb {
        Aabb::UNBOUNDED
    }

    fn chart(&self, _: usize, y: Vec3, n: Vec3) -> Chart {
        plane_chart(y, n)
    }
}

/// The boxes of a half-space and of its complement, if its normal is along an axis.
fn slabs(normal: Normal3, distance: f64) -> [Aabb; 2] {
    let mut slabs = [Aabb::UNBOUNDED; 2];
    let n = normal.to_array();
    if let Some(axis) = (0..3).find(|&axis| (0..3).all(|i| (n[i] == 0.0) == (i != axis))) {
        let at = Interval::from(distance) / Interval::from(n[axis]);
        let [below, above] = if n[axis] > 0.0 { [0, 1] } else { [1, 0] };
        slabs[below].max[axis] = at.hi;
        slabs[above].min[axis] = at.lo;
    }
    slabs
}

/// Why a [`Region`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RegionError {
    /// A corner of the box is infinite or NaN, or its lower corner is above its upper one.
    #[error("clipping box: the corners must be finite and in order")]
    Box,
    /// The normal is zero, infinite or NaN.
    #[error("clipping plane: the normal must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Normal(Normal3),
    /// The distance is infinite or NaN.
    #[error("clipping plane: the distance must be finite, got {0}")]
    Distance(f64),
}

impl Region {
    /// The inside of a solid with quadric faces, its boundary included; for a sheet, the set that
    /// its walls and its ends enclose.
    pub fn solid<S: QuadricFaces + 'static>(shape: S) -> Self {
        let bounds = shape.bounds();
        let slabs = [bounds, Aabb::UNBOUNDED];
        Self { faces: Arc::new(QuadricSolid::of(shape)), map: None, inverse: false, bounds, slabs }
    }

    /// The box from `min` to `max`, its boundary included.
    pub fn axis_box(min: Point3, max: Point3) -> Result<Self, RegionError> {
        let bounds = Aabb::new(min, max);
        if !bounds.is_bounded() {
            return Err(RegionError::Box);
        }
        Ok(Self::solid(Block { min, max }))
    }

    /// The half-space `normal·x <= distance`: behind the plane.
    pub fn half_space(normal: Normal3, distance: f64) -> Result<Self, RegionError> {
        if !normal.is_finite() || normal == Normal3::ZERO {
            return Err(RegionError::Normal(normal));
        }
        if !distance.is_finite() {
            return Err(RegionError::Distance(distance));
        }
        let slabs = slabs(normal, distance);
        Ok(Self { slabs, ..Self::solid(HalfSpace { normal, distance }) })
    }

    /// The region moved by a map.
    #[must_use]
    pub fn placed(mut self, map: Affine) -> Self {
        self.bounds = if self.inverse { Aabb::UNBOUNDED } else { map.bounds(&self.bounds) };
        // A second map is composed in f64, like the transforms of a scene file.
        self.map = Some(match self.map {
            Some(first) => first.then(&map).unwrap_or(map),
            None => map,
        });
        self
    }

    /// The closure of the region's complement.
    #[must_use]
    pub fn inverse(mut self) -> Self {
        self.inverse = !self.inverse;
        self.bounds = Aabb::UNBOUNDED;
        self.slabs.reverse();
        self
    }

    /// A box that holds the region.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// A box that holds the region in the frame of a surface that was placed by `map`. It may be
    /// unbounded on some sides.
    pub(super) fn slab(&self, map: Option<&Affine>) -> Aabb {
        if self.map.as_ref() == map { self.slabs[0] } else { Aabb::UNBOUNDED }
    }

    /// The packet filter of the part of a surface in the region.
    pub(super) fn cut(&self, surface: FilterSource) -> FilterSource {
        let region = self.faces.sketch();
        let region = match &self.map {
            Some(map) => region.placed(map),
            None => region,
        };
        if self.inverse { surface.without(region) } else { surface.within(region) }
    }

    /// Whether the closed region holds a root, if the root's bracket decides that; else the
    /// undecided faces.
    pub(super) fn holds(&self, ray: &LocalRay<'_>, root: &Root) -> Result<bool, FaceSet> {
        Isa::detect().run(
            #[inline(always)]
            || self.holds_here(ray, root),
        )
    }

    #[inline(always)]
    fn holds_here(&self, ray: &LocalRay<'_>, root: &Root) -> Result<bool, FaceSet> {
        let placed;
        let local = match &self.map {
            None => ray,
            Some(map) => {
                placed = ray.through(map);
                &placed
            }
        };
        let frame = self.faces.frame();
        let at = local.recentre(frame.centre, frame.scale);
        let (lo, hi) = at.window((root.lo, root.hi));
        let s = 0.5 * (lo + hi);
        let s = EFloat::with_error(s, (hi - s).max(s - lo));
        let mut doubtful = FaceSet::NONE;
        for (i, form) in self.faces.forms().iter().enumerate() {
            match form.along(at.o, at.d, at.o_err, at.d_err).at(s).sign() {
                Some(Ordering::Greater) => return Ok(self.inverse),
                Some(Ordering::Less) => {}
                _ => doubtful.insert(i),
            }
        }
        if doubtful.is_empty() { Ok(!self.inverse) } else { Err(doubtful) }
    }

    /// Decides exactly whether the region holds a root that is inside all faces but the doubtful
    /// ones and those on which it is known to lie (`on`). `sign` returns the sign of a polynomial
    /// at the root.
    pub(super) fn holds_exactly(
        &self,
        ray: &LocalRay<'_>,
        (doubtful, on): (FaceSet, FaceSet),
        sign: impl Fn(&Quadratic<Dyadic>) -> Option<Ordering>,
    ) -> Option<bool> {
        let mut worst = if on.is_empty() { Ordering::Less } else { Ordering::Equal };
        if !doubtful.is_empty() {
            for (_, q) in self.polynomials(ray, doubtful)? {
                worst = worst.max(sign(&q)?);
            }
        }
        Some(if self.inverse { worst.is_ge() } else { worst.is_le() })
    }

    /// [`Region::holds_exactly`] in double-doubles; `None` also if one of the signs is uncertain.
    pub(super) fn holds_widely(
        &self,
        ray: &LocalRay<'_>,
        (doubtful, on): (FaceSet, FaceSet),
        sign: impl Fn(&Quadratic<EFloat<Dd>>) -> Option<Ordering>,
    ) -> Option<bool> {
        let mut worst = if on.is_empty() { Ordering::Less } else { Ordering::Equal };
        if !doubtful.is_empty() {
            for (_, q) in self.polynomials_in(ray, doubtful, |i| self.faces.wide(i))? {
                worst = worst.max(sign(&q)?);
            }
        }
        Some(if self.inverse { worst.is_ge() } else { worst.is_le() })
    }

    /// The exact polynomials of some faces along a ray, in its own parameter, each times a positive
    /// factor; `None` if the ray is not exactly known.
    fn polynomials(
        &self,
        ray: &LocalRay<'_>,
        faces: FaceSet,
    ) -> Option<ArrayVec<(usize, Quadratic<Dyadic>), MOST_FACES>> {
        self.polynomials_in(ray, faces, |i| self.faces.exact(i))
    }

    /// [`Region::polynomials`] in any ring that can hold the ray.
    fn polynomials_in<T: Ring>(
        &self,
        ray: &LocalRay<'_>,
        faces: FaceSet,
        form: impl Fn(usize) -> Form<T>,
    ) -> Option<ArrayVec<(usize, Quadratic<T>), MOST_FACES>> {
        Isa::detect().run(
            #[inline(always)]
            || {
                let frame = self.faces.frame();
                let placed;
                let (local, clock) = match &self.map {
                    None => (ray, None),
                    Some(map) => {
                        placed = ray.through(map);
                        (&placed, placed.parent_clock())
                    }
                };
                let seen = local.in_ring_from::<T>(frame.centre, frame.scale)?;
                let mut all = ArrayVec::new();
                for i in faces.iter() {
                    let q = form(i).along(&seen);
                    all.push((i, clock.map_or(q.clone(), |(step, k)| in_parents_parameter(q, step, k))));
                }
                Some(all)
            },
        )
    }

    /// The faces that contain all of a surface's face: those whose polynomial is a multiple of its
    /// own, which `face` returns along a ray.
    ///
    /// Let `f` and `g` be the two, of degree two at most, and `p` a point where `f` does not
    /// vanish. If they are proportional along a line through `p`, `h = g(p) f - f(p) g` vanishes on
    /// it. The first and second degree terms of `h(p + s v)` are a linear and a quadratic form of
    /// the direction `v`; if both vanish for the six `v` below, all their coefficients are zero.
    pub(super) fn faces_around(&self, face: impl Fn(&LocalRay<'_>) -> Option<Quadratic<Dyadic>>) -> FaceSet {
        /// The point `p`: its coordinates have few bits, and it is unlikely to lie on a surface of
        /// a scene.
        const P: Point3 = Point3::new(179.0 / 256.0, -347.0 / 256.0, 89.0 / 256.0);
        const LINES: [Vec3; 6] = [
            Vec3::X,
            Vec3::Y,
            Vec3::Z,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(1.0, 0.0, 1.0),
            Vec3::new(0.0, 1.0, 1.0),
        ];
        let mut around = FaceSet::first(self.faces.forms().len());
        for line in LINES {
            let ray = LocalRay::new(&Ray::new(P, line));
            let (Some(f), Some(polynomials)) = (face(&ray), self.polynomials(&ray, around)) else {
                return FaceSet::NONE;
            };
            around = FaceSet::NONE;
            for (i, g) in polynomials {
                if !f.c.is_zero() && f.is_parallel_to(&g) {
                    around.insert(i);
                }
            }
            if around.is_empty() {
                break;
            }
        }
        around
    }
}

/// The largest number of faces of a shape.
const MOST_FACES: usize = 8;

/// A set of faces of a region, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FaceSet(u8);

impl FaceSet {
    pub(super) const NONE: Self = Self(0);

    /// The first `n` faces.
    fn first(n: usize) -> Self {
        debug_assert!(n <= MOST_FACES);
        Self(((1_u16 << n) - 1) as u8)
    }

    #[inline(always)]
    fn insert(&mut self, i: usize) {
        self.0 |= 1 << i;
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The faces of this set that are in `o`, and those that are not.
    pub(super) fn split(self, o: Self) -> (Self, Self) {
        (Self(self.0 & o.0), Self(self.0 & !o.0))
    }

    fn iter(self) -> impl Iterator<Item = usize> {
        (0..MOST_FACES).filter(move |i| self.0 >> i & 1 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compose::clip::Algebraic;
    use crate::quadric::cone::Cone;
    use crate::{AxisBox, Placed, Sphere};

    fn around(region: &Region, surface: &impl Algebraic, face: u32) -> Vec<usize> {
        region.faces_around(|ray| surface.polynomial(face, ray)).iter().collect()
    }

    #[test]
    fn faces_that_lie_on_a_border_are_known_and_no_others() {
        let block = |top: f64| Region::axis_box([-1.0, 0.0, -1.0].into(), [1.0, top, 1.0].into()).unwrap();
        let cube = AxisBox::new([-3.0, 0.0, -0.5].into(), [3.0, 2.0, 1.0].into()).unwrap();
        let on = |region: &Region| [0, 1, 2, 3, 4, 5].map(|face| around(region, &cube, face));
        assert_eq!(on(&block(2.0)), [vec![], vec![], vec![2], vec![3], vec![], vec![5]]);
        assert_eq!(on(&block(2.0_f64.next_down())), [vec![], vec![], vec![2], vec![], vec![], vec![5]]);
        // Turned about its axis by a quarter, within rounding: what is exactly in the plane still
        // is.
        let quarter = |moved: f64| {
            let turn = Affine::rotation_y(core::f64::consts::FRAC_PI_2).unwrap();
            turn.then(&Affine::translation(Vec3::new(0.0, moved, 0.0)).unwrap()).unwrap()
        };
        let turned = block(2.0).placed(quarter(0.0));
        assert_eq!(on(&turned), [vec![], vec![], vec![2], vec![3], vec![], vec![]]);
        assert!(on(&block(2.0).placed(quarter(1e-300))).concat().is_empty());
        // The same of the surface.
        let placed = Placed::new(cube, quarter(0.25));
        assert_eq!(around(&block(2.25), &placed, 3), [3]);
        assert_eq!(around(&block(2.25), &placed, 2), []);
    }

    #[test]
    fn curved_borders_are_known_by_all_their_coefficients() {
        let ball = |r: f64| Sphere::new(Point3::new(1.0, 2.0, -0.5), r).unwrap();
        let region = Region::solid(ball(1.5));
        assert_eq!(around(&region, &ball(1.5), 0), [0]);
        assert_eq!(around(&region, &ball(1.5_f64.next_up()), 0), []);
        assert_eq!(around(&region.inverse(), &ball(1.5), 0), [0]);
        // Twice as large and half as high: the same cone, of another length. Sheared a little it is
        // another.
        let cone = |r: f64, h: f64| Cone::new(r, r, h).unwrap();
        let region = Region::solid(*cone(1.0, 2.0).shape());
        assert_eq!(around(&region, &cone(2.0, 4.0), 0), [0]);
        let rows = [[1.0, 0.0, 0.0], [1e-12, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let shear = Affine::new(rows, Point3::ORIGIN).unwrap();
        assert_eq!(around(&region.placed(shear), &cone(2.0, 4.0), 0), []);
    }
}

//! A surface clipped by solids: what of it lies in a region.
//!
//! A root stays if it is in the closed region. Where an enclosure of the root straddles the region's border, the answer is the exact sign
//! of the border's polynomial at the root of the surface's, so that the cut neither leaks nor doubles.
//!
//! The result is a sheet: clipping removes surface and does not cap what it opens. It has no inside, also where the surface had one.

use crate::outline::Sketch;
use crate::quadric::body::{Chart, Frame, Shape, tangents};
use crate::quadric::form::{Form, Rounded};
use crate::quadric::solid::Body;
use crate::roots::quadratic::{Crossing, Quadratic, exact_sign, sign_at_root};
use crate::sphere::Sphere;
use crate::{Flow, LocalRay, Need, PartId, Placed, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Affine, Dyadic, Isa, Normal3, Point3, Ring, Run, Vec3};
use std::sync::Arc;

/// A surface each of whose faces is the zero set of a polynomial.
pub trait Algebraic: Surface {
    /// The polynomial of the face along the ray, in the ray's own parameter `s`, times any positive factor; negative behind the face.
    /// `None` if the ray is not exactly known, and on faces of a degree above two.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }

    /// The exact sign of a polynomial in the ray's own parameter at a root of this surface; `None` if the ray is not exactly known.
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let p = self.polynomial(root.face, ray)?;
        Some(sign_at_root(&p, name(&p, root), q))
    }
}

impl<S: Shape> Algebraic for Body<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let Frame { centre, scale, .. } = self.shape().frame();
        let form = self.shape().form::<Dyadic>(face as usize);
        Some(form.along(&ray.in_ring_from(centre, scale)?))
    }
}

impl Algebraic for Sphere {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let Frame { centre, scale, .. } = Shape::frame(self);
        Some(self.form::<Dyadic>(face as usize).along(&ray.in_ring_from(centre, scale)?))
    }
}

impl<S: Algebraic> Algebraic for Placed<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let local = ray.through(self.map());
        let p = self.surface().polynomial(face, &local)?;
        let (step, k) = local.parent_clock()?;
        Some(in_parents_parameter(p, step, k))
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let local = Isa::detect().run(
            #[inline(always)]
            || ray.through(self.map()),
        );
        let (step, k) = local.parent_clock()?;
        self.surface().sign_at_root(&local, root, &in_childs_parameter(q, step, k))
    }
}

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

/// The faces of a region: [`Shape`] without the generic methods.
trait Faces: Send + Sync {
    fn frame(&self) -> Frame;
    fn forms(&self) -> &[Rounded];
    fn exact(&self, face: usize) -> Form<Dyadic>;
    fn sketch(&self) -> Sketch;
}

impl<S: Shape> Faces for Body<S> {
    fn frame(&self) -> Frame {
        self.shape().frame()
    }

    fn forms(&self) -> &[Rounded] {
        self.view().forms
    }

    fn exact(&self, face: usize) -> Form<Dyadic> {
        self.shape().form(face)
    }

    fn sketch(&self) -> Sketch {
        Sketch::of_shape(self.shape())
    }
}

/// What a half-space's face is in a frame at the origin: its normal by a power of two to about one.
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

impl Shape for Block {
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

impl Shape for HalfSpace {
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
    /// The inside of a solid with quadric faces, its boundary included; of a sheet, what its walls and its cut-offs enclose.
    pub fn solid<S: Shape + 'static>(shape: S) -> Self {
        let bounds = shape.bounds();
        Self { faces: Arc::new(Body::of(shape)), map: None, inverse: false, bounds }
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
        Ok(Self::solid(HalfSpace { normal, distance }))
    }

    /// The region moved by a map.
    #[must_use]
    pub fn placed(mut self, map: Affine) -> Self {
        self.bounds = if self.inverse { Aabb::UNBOUNDED } else { map.bounds(&self.bounds) };
        // A second map is composed in f64, as transforms in a text are.
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
        self
    }

    /// A box that holds the region.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// What the region leaves of a surface.
    fn cut(&self, surface: Sketch) -> Sketch {
        let region = self.faces.sketch();
        let region = match &self.map {
            Some(map) => region.placed(map),
            None => region,
        };
        if self.inverse { surface.without(region) } else { surface.within(region) }
    }

    /// Whether the closed region holds a root, if that can be told from its bracket; else the faces that do not tell.
    fn holds(&self, ray: &LocalRay<'_>, root: &Root) -> Result<bool, Doubtful> {
        Isa::detect().run(
            #[inline(always)]
            || self.holds_here(ray, root),
        )
    }

    #[inline(always)]
    fn holds_here(&self, ray: &LocalRay<'_>, root: &Root) -> Result<bool, Doubtful> {
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
        let s = Run::with_error(s, (hi - s).max(s - lo));
        let mut doubtful = Doubtful(0);
        for (i, form) in self.faces.forms().iter().enumerate() {
            match form.along(at.o, at.d, at.o_err, at.d_err).at(s).sign() {
                Some(Ordering::Greater) => return Ok(self.inverse),
                Some(Ordering::Less) => {}
                _ => doubtful.0 |= 1 << i,
            }
        }
        if doubtful.0 == 0 { Ok(!self.inverse) } else { Err(doubtful) }
    }

    /// The same, exactly, for a root that is inside all faces but the doubtful ones; `sign` tells that of a polynomial at it.
    fn holds_exactly(
        &self,
        ray: &LocalRay<'_>,
        doubtful: Doubtful,
        sign: impl Fn(&Quadratic<Dyadic>) -> Option<Ordering>,
    ) -> Option<bool> {
        let frame = self.faces.frame();
        let placed;
        let (local, clock) = match &self.map {
            None => (ray, None),
            Some(map) => {
                placed = Isa::detect().run(
                    #[inline(always)]
                    || ray.through(map),
                );
                (&placed, placed.parent_clock())
            }
        };
        let exact = local.in_ring_from::<Dyadic>(frame.centre, frame.scale)?;
        let mut worst = Ordering::Less;
        for i in (0..self.faces.forms().len()).filter(|i| doubtful.0 >> i & 1 == 1) {
            let q = self.faces.exact(i).along(&exact);
            let q = match clock {
                None => q,
                Some((step, k)) => in_parents_parameter(q, step, k),
            };
            worst = worst.max(sign(&q)?);
        }
        Some(if self.inverse { worst.is_ge() } else { worst.is_le() })
    }
}

/// Faces of a region, by bits: those of which it is not certain on what side a root lies. No shape has more than six.
#[derive(Clone, Copy, Debug)]
struct Doubtful(u8);

/// A polynomial in `s'` as one in `s = step + 2^k s'`: `s' = 2^-k (s - step)`.
fn in_parents_parameter(p: Quadratic<Dyadic>, step: f64, k: i32) -> Quadratic<Dyadic> {
    let (a, b) = (p.a.scale2(-2 * k), p.b.scale2(-k));
    let m = -Dyadic::from(step);
    let am = &a * &m;
    let c = &(&(&am + &b.clone().scale2(1)) * &m) + &p.c;
    Quadratic { b: &am + &b, a, c }
}

/// A polynomial in `s = step + 2^k s'` as one in `s'`.
fn in_childs_parameter(p: &Quadratic<Dyadic>, step: f64, k: i32) -> Quadratic<Dyadic> {
    let m = Dyadic::from(step);
    let am = &p.a * &m;
    let c = &(&(&am + &p.b.clone().scale2(1)) * &m) + &p.c;
    Quadratic { a: p.a.clone().scale2(2 * k), b: (&am + &p.b).scale2(k), c }
}

/// The part of the surface `S` that lies in all of some closed regions.
#[derive(Clone, Debug)]
pub struct Clip<S> {
    surface: S,
    regions: Vec<Region>,
}

impl<S: Algebraic> Clip<S> {
    /// What of `surface` lies in all `regions`, their borders included.
    pub fn new(surface: S, regions: Vec<Region>) -> Self {
        Self { surface, regions }
    }

    /// The surface before it is clipped.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The part of a ray that holds all that is kept; `None` if nothing is.
    #[inline(always)]
    fn range(&self, ray: &LocalRay<'_>) -> Option<(f64, f64)> {
        let mut bounds = Aabb::UNBOUNDED;
        for region in &self.regions {
            bounds = bounds.intersection(region.bounds);
        }
        if bounds == Aabb::UNBOUNDED {
            return Some((f64::NEG_INFINITY, f64::INFINITY));
        }
        ray.within(&bounds)
    }

    fn keeps(&self, ray: &LocalRay<'_>, root: &Root) -> bool {
        self.regions
            .iter()
            .all(|r| r.holds(ray, root).unwrap_or_else(|doubtful| self.keeps_exactly(r, doubtful, ray, root)))
    }

    #[cold]
    #[inline(never)]
    fn keeps_exactly(&self, region: &Region, doubtful: Doubtful, ray: &LocalRay<'_>, root: &Root) -> bool {
        let decided = region.holds_exactly(ray, doubtful, |q| self.surface.sign_at_root(ray, root, q));
        // A ray that is known within errors only may be on the border: then it is, and closed sets hold their border.
        decided.unwrap_or(true)
    }
}

/// Which root of `p` a root is.
fn name(p: &Quadratic<Dyadic>, root: &Root) -> Crossing {
    match (root.sign, exact_sign(&p.discriminant()), exact_sign(&p.a)) {
        (_, Ordering::Equal, Ordering::Greater) => Crossing::TouchOutside,
        (_, Ordering::Equal, Ordering::Less) => Crossing::TouchInside,
        (-1, ..) => Crossing::In,
        (1, ..) => Crossing::Out,
        // A rim that the ray touches: the face says in its tag what it does there.
        _ if root.tag[0] > 0.0 => Crossing::Out,
        _ => Crossing::In,
    }
}

/// Passes on the roots that are kept.
struct Keeping<'a, 'r, S, K: ?Sized> {
    clip: &'a Clip<S>,
    ray: &'a LocalRay<'r>,
    sink: &'a mut K,
    /// What lies elsewhere is in none of the regions' boxes.
    range: (f64, f64),
}

impl<S: Algebraic, K: Sink + ?Sized> Sink for Keeping<'_, '_, S, K> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        let ((a, b), (near, far)) = (self.sink.range(), self.range);
        (a.max(near), b.min(far))
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> Flow {
        if self.clip.keeps(self.ray, &root) { self.sink.push(root) } else { Flow::Continue }
    }
}

impl<S: Algebraic> Surface for Clip<S> {
    fn bounds(&self) -> Aabb {
        self.regions.iter().fold(self.surface.bounds(), |b, r| b.intersection(r.bounds()))
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        if let Some(range) = self.range(ray) {
            self.surface.roots(ray, &mut Keeping { clip: self, ray, sink, range });
        }
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.surface.resolve(ray, root, need)
    }

    fn sketch(&self, part: PartId) -> Sketch {
        self.regions.iter().fold(self.surface.sketch(part), |sketch, region| region.cut(sketch))
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        self.surface.is_in_parts()
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        let mut n = 0;
        self.surface.parts(&mut |_, _| n += 1);
        let all = self.bounds();
        self.surface.parts(&mut |b, id| f(if n == 1 { all } else { b.intersection(all) }, id));
    }

    #[inline(always)]
    fn primitive_of(&self, part: PartId) -> u32 {
        self.surface.primitive_of(part)
    }

    #[inline(always)]
    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        if let Some(range) = self.range(ray) {
            self.surface.part_roots(part, ray, &mut Keeping { clip: self, ray, sink, range });
        }
    }
}

impl<S: Algebraic> Algebraic for Clip<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        self.surface.polynomial(face, ray)
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        self.surface.sign_at_root(ray, root, q)
    }
}

//! A surface clipped by solids: the part of it that lies in a region.
//!
//! A root stays if it is in the closed region. Where a bracket of the root straddles the region's
//! border, the exact sign of the border's polynomial at the root of the surface's polynomial
//! decides, so that the cut has neither gaps nor double hits.
//!
//! The result is a sheet: clipping removes surface and closes no openings. It has no inside, even
//! if the surface had one.

use super::region::{FaceSet, Region};
use crate::faces::boolean_faces::{Faces, QuadricFaces};
use crate::faces::chart::Frame;
use crate::packet::FilterSource;
use crate::quadric::solid::QuadricSolid;
use crate::{Accelerate, LocalRay, Need, PartId, Placed, Root, Sink, Surface, SurfacePoint};
use core::cmp::Ordering;
use core::ops::ControlFlow;
use durer_math::{Aabb, Affine, Dd, Dyadic, EFloat, Isa, Ring};
use durer_roots::quadratic::{Crossing, Quadratic, exact_sign, sign_at_root};
use std::sync::OnceLock;

/// A surface each of whose faces is the zero set of a polynomial.
pub trait Algebraic: Accelerate {
    /// The polynomial of the face along the ray, in the ray's own parameter `s`, times any positive
    /// factor; negative behind the face. `None` if the ray is not exactly known, and on faces of a
    /// degree above two.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }

    /// The polynomial in double-doubles with their errors. They decide most signs that f64 leaves
    /// open, at a small part of the cost of exact numbers. Not all surfaces provide it.
    fn wide_polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        None
    }

    /// The exact sign of a polynomial in the ray's own parameter at a root of this surface; `None`
    /// if the ray is not exactly known.
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let p = self.polynomial(root.face, ray)?;
        Some(sign_at_root(&p, name(&p, root), q))
    }

    /// A box that holds the part of the surface, placed by a map, in the intersection of some
    /// regions. It may be larger.
    fn bounds_among(&self, _regions: &[Region], map: Option<&Affine>) -> Aabb {
        map.map_or_else(|| self.bounds(), |map| self.bounds_through(map))
    }
}

/// The exact polynomial of a face along a ray. One copy of the code serves all shapes.
pub(crate) fn exact_along(
    shape: &dyn Faces,
    frame: Frame,
    face: u32,
    ray: &LocalRay<'_>,
) -> Option<Quadratic<Dyadic>> {
    Some(shape.exact(face as usize).along(&ray.in_ring_from(frame.centre, frame.scale)?))
}

/// The polynomial of a face along a ray, in double-doubles.
pub(crate) fn wide_along(
    shape: &dyn Faces,
    frame: Frame,
    face: u32,
    ray: &LocalRay<'_>,
) -> Option<Quadratic<EFloat<Dd>>> {
    let form = shape.double(face as usize);
    Isa::detect().run(
        #[inline(always)]
        || Some(form.along(&ray.in_ring_from(frame.centre, frame.scale)?)),
    )
}

impl<S: QuadricFaces> Algebraic for QuadricSolid<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        exact_along(self.shape(), self.shape().frame(), face, ray)
    }

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        wide_along(self.shape(), self.shape().frame(), face, ray)
    }

    fn bounds_among(&self, regions: &[Region], map: Option<&Affine>) -> Aabb {
        let slab = regions.iter().fold(Aabb::UNBOUNDED, |slab, r| slab.intersection(r.slab(map)));
        let inner = self.shape().bounds_within(&slab);
        match map {
            None => inner,
            Some(map) if inner.is_bounded() => self.bounds_through(map).intersection(map.bounds(&inner)),
            Some(map) => self.bounds_through(map),
        }
    }
}

impl<S: Algebraic> Algebraic for Placed<S> {
    fn polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        let local = ray.through(self.map());
        let p = self.surface().polynomial(face, &local)?;
        let (step, k) = local.parent_clock()?;
        Some(in_parents_parameter(p, step, k))
    }

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        Isa::detect().run(
            #[inline(always)]
            || {
                let local = ray.through(self.map());
                let p = self.surface().wide_polynomial(face, &local)?;
                let (step, k) = local.parent_clock()?;
                Some(in_parents_parameter(p, step, k))
            },
        )
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        let local = Isa::detect().run(
            #[inline(always)]
            || ray.through(self.map()),
        );
        let (step, k) = local.parent_clock()?;
        self.surface().sign_at_root(&local, root, &in_childs_parameter(q, step, k))
    }

    fn bounds_among(&self, regions: &[Region], map: Option<&Affine>) -> Aabb {
        match map {
            None => self.surface().bounds_among(regions, Some(self.map())),
            Some(map) => self.bounds_through(map),
        }
    }
}

/// A polynomial in `s'` as one in `s = step + 2^k s'`: `s' = 2^-k (s - step)`.
#[inline(always)]
pub(super) fn in_parents_parameter<T: Ring>(p: Quadratic<T>, step: f64, k: i32) -> Quadratic<T> {
    let (a, b) = (p.a.scale2(-2 * k), p.b.scale2(-k));
    let m = T::exact(-step);
    let am = a.clone() * m.clone();
    let c = (am.clone() + b.clone().scale2(1)) * m + p.c;
    Quadratic { b: am + b, a, c }
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
    /// For each region and each of the surface's first faces, the faces of the region that contain
    /// all of that face. They are computed when a root is first in doubt. Without them, where a
    /// solid ends in the very plane that cuts it, each ray there would need exact arithmetic.
    around: Vec<[OnceLock<FaceSet>; REMEMBERED]>,
}

/// Faces with higher numbers, as meshes have, are decided anew for each ray.
const REMEMBERED: usize = 8;

impl<S: Algebraic> Clip<S> {
    /// The part of `surface` in the intersection of `regions`, borders included.
    pub fn new(surface: S, regions: Vec<Region>) -> Self {
        let around = regions.iter().map(|_| Default::default()).collect();
        Self { surface, regions, around }
    }

    /// The surface before it is clipped.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The range of a ray in which a crossing may be kept; `None` if it is empty.
    #[inline(always)]
    fn range(&self, ray: &LocalRay<'_>) -> Option<(f64, f64)> {
        let mut bounds = Aabb::UNBOUNDED;
        for region in &self.regions {
            bounds = bounds.intersection(region.bounds());
        }
        if bounds == Aabb::UNBOUNDED {
            return Some((f64::NEG_INFINITY, f64::INFINITY));
        }
        ray.within(&bounds)
    }

    fn keeps(&self, ray: &LocalRay<'_>, root: &Root) -> bool {
        (0..self.regions.len()).all(
            #[inline(always)]
            |r| {
                self.regions[r]
                    .holds(ray, root)
                    .unwrap_or_else(|doubtful| self.keeps_exactly(r, doubtful, ray, root))
            },
        )
    }

    #[cold]
    #[inline(never)]
    fn keeps_exactly(&self, r: usize, doubtful: FaceSet, ray: &LocalRay<'_>, root: &Root) -> bool {
        let region = &self.regions[r];
        let around = self.around[r].get(root.face as usize).map_or(FaceSet::NONE, |around| {
            *around.get_or_init(|| region.faces_around(|ray| self.surface.polynomial(root.face, ray)))
        });
        let (on, doubtful) = doubtful.split(around);
        if let Some(keeps) = self.keeps_widely(region, (doubtful, on), ray, root) {
            return keeps;
        }
        let decided = region.holds_exactly(ray, (doubtful, on), |q| self.surface.sign_at_root(ray, root, q));
        // A ray that is known only within errors may be on the border: it counts as on it, and
        // closed sets contain their border.
        decided.unwrap_or(true)
    }
}

impl<S: Algebraic> Clip<S> {
    /// [`Clip::keeps_exactly`] for a plane face where double-doubles suffice: mostly faces that
    /// would coincide but for the rounding of a decimal number.
    fn keeps_widely(
        &self,
        region: &Region,
        faces: (FaceSet, FaceSet),
        ray: &LocalRay<'_>,
        root: &Root,
    ) -> Option<bool> {
        let p = self.surface.wide_polynomial(root.face, ray)?;
        if p.a.sign() != Some(Ordering::Equal) {
            return None;
        }
        let (n, m) = (-p.c, p.b.scale2(1));
        region.holds_widely(ray, faces, |q| q.at_ratio(&n, &m).sign())
    }
}

/// Which of the roots of `p` a root is.
fn name(p: &Quadratic<Dyadic>, root: &Root) -> Crossing {
    match (root.sign, exact_sign(&p.discriminant()), exact_sign(&p.a)) {
        (_, Ordering::Equal, Ordering::Greater) => Crossing::TouchOutside,
        (_, Ordering::Equal, Ordering::Less) => Crossing::TouchInside,
        (-1, ..) => Crossing::In,
        (1, ..) => Crossing::Out,
        // A rim that the ray touches: the tag says whether the ray enters or leaves.
        _ if root.tag[0] > 0.0 => Crossing::Out,
        _ => Crossing::In,
    }
}

/// A sink that passes on the kept roots.
struct Keeping<'a, 'r, S, K: ?Sized> {
    clip: &'a Clip<S>,
    ray: &'a LocalRay<'r>,
    sink: &'a mut K,
    /// Points outside this range are in none of the regions' boxes.
    range: (f64, f64),
}

impl<S: Algebraic, K: Sink + ?Sized> Sink for Keeping<'_, '_, S, K> {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        let ((a, b), (near, far)) = (self.sink.range(), self.range);
        (a.max(near), b.min(far))
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if self.clip.keeps(self.ray, &root) { self.sink.push(root) } else { ControlFlow::Continue(()) }
    }
}

impl<S: Algebraic> Surface for Clip<S> {
    fn bounds(&self) -> Aabb {
        let whole = self.surface.bounds_among(&self.regions, None);
        self.regions.iter().fold(whole, |b, r| b.intersection(r.bounds()))
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
}

impl<S: Algebraic> Accelerate for Clip<S> {
    fn name(&self) -> &'static str {
        self.surface.name()
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        self.regions.iter().fold(self.surface.packet_filter(part), |sketch, region| region.cut(sketch))
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

    fn wide_polynomial(&self, face: u32, ray: &LocalRay<'_>) -> Option<Quadratic<EFloat<Dd>>> {
        self.surface.wide_polynomial(face, ray)
    }

    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        self.surface.sign_at_root(ray, root, q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::TestRng;
    use crate::{CappedCylinder, Quadric};
    use durer_math::{Normal3, Point3, Ray, Vec3};

    /// All roots.
    struct Every(Vec<Root>);

    impl Sink for Every {
        fn range(&self) -> (f64, f64) {
            (f64::NEG_INFINITY, f64::INFINITY)
        }

        fn push(&mut self, root: Root) -> ControlFlow<()> {
            self.0.push(root);
            ControlFlow::Continue(())
        }
    }

    #[test]
    fn double_doubles_cut_as_exact_numbers_do() {
        // A lid in the plane that cuts it but for a few units in the last place, or exactly:
        // decimal numbers, as in texts.
        let mut dice = TestRng::new(5);
        let (mut told, mut kept) = (0, 0);
        for round in 0..400 {
            let shift = dice.integer(1, 40) * 0.1;
            let lid = 2.0 - shift + dice.integer(-1, 1) * f64::EPSILON;
            let tube =
                |top| CappedCylinder::new([0.1, -3.0, 0.2].into(), [0.1, top, 0.2].into(), 0.7).unwrap();
            let turn = Affine::rotation_y(0.3 * f64::from(round % 3)).unwrap();
            let away = Affine::translation(Vec3::new(0.0, -shift, 0.0)).unwrap();
            let block = Region::axis_box([-3.0, -9.0, -3.0].into(), [3.0, 2.0, 3.0].into()).unwrap();
            let region = block.placed(turn.then(&away).unwrap());
            let region = if round % 2 == 0 { region } else { region.inverse() };
            let clip = Clip::new(Placed::new(tube(lid), turn), vec![region]);
            let from = Point3::new(dice.between(-2.0, 2.0), dice.between(3.0, 9.0), dice.between(-2.0, 2.0));
            let to = Point3::new(dice.between(-0.2, 0.3), lid, dice.between(-0.1, 0.4));
            let ray = Ray::new(from, to - from);
            let local = LocalRay::new(&ray);
            let mut every = Every(Vec::new());
            clip.surface.roots(&local, &mut every);
            for root in &every.0 {
                let region = &clip.regions[0];
                let Err(doubtful) = region.holds(&local, root) else { continue };
                let faces = (doubtful, FaceSet::NONE);
                let exactly =
                    region.holds_exactly(&local, faces, |q| clip.surface.sign_at_root(&local, root, q));
                let widely = clip.keeps_widely(region, faces, &local, root);
                assert!(widely.is_none() || widely == exactly, "{ray:?} {root:?} {widely:?} {exactly:?}");
                told += usize::from(widely.is_some());
                kept += usize::from(widely == Some(true));
            }
        }
        assert!(told > 100 && kept > 20 && kept < told - 20, "{told} {kept}");
    }

    /// Of quadrics along an axis, clipped across it: the box holds all that is left, and is no
    /// larger than that needs.
    #[test]
    fn what_is_clipped_across_its_axis_has_a_box() {
        let below = |sign: f64, at: f64| Region::half_space(Normal3::new(0.0, sign, 0.0), sign * at).unwrap();
        let above = |at: f64| below(1.0, at).inverse();
        // Coefficients of x² y² z² xy xz yz x y z 1, regions, and the box.
        let cases = [
            // x² + 4 z² = y, below 9/16.
            (
                [1.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0],
                vec![below(1.0, 0.5625)],
                [[-0.75, 0.0, -0.375], [0.75, 0.5625, 0.375]],
            ),
            // The same turned inside out and hanging: 2 - y = (x - 1)² + z², above 1.
            (
                [-1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 2.0, -1.0, 0.0, 1.0],
                vec![above(1.0)],
                [[0.0, 1.0, -1.0], [2.0, 2.0, 1.0]],
            ),
            // A cylinder, a cone, a hyperboloid between two planes.
            (
                [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0],
                vec![below(1.0, 3.0), below(-1.0, -1.0)],
                [[-2.0, -1.0, -2.0], [2.0, 3.0, 2.0]],
            ),
            (
                [1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                vec![below(3.0, 2.0), above(-3.0)],
                [[-3.0, -3.0, -3.0], [3.0, 2.0, 3.0]],
            ),
            (
                [1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -16.0],
                vec![below(1.0, 3.0), above(0.0)],
                [[-5.0, 0.0, -5.0], [5.0, 3.0, 5.0]],
            ),
        ];
        let mut dice = TestRng::new(7);
        for (coefficients, regions, [min, max]) in cases {
            let quadric = Quadric::new(coefficients).unwrap();
            let still = Clip::new(quadric.clone(), regions.clone());
            let (exact, told) = (Aabb::new(min.into(), max.into()), still.bounds());
            let ulps = 8.0 * f64::EPSILON;
            assert!(
                exact.min.to_array().iter().zip(told.min.to_array()).all(|(&a, b)| b <= a && a - b <= ulps),
                "{told:?}"
            );
            assert!(
                exact.max.to_array().iter().zip(told.max.to_array()).all(|(&a, b)| b >= a && b - a <= ulps),
                "{told:?}"
            );
            // One end is not enough for what goes on both ways.
            if regions.len() == 2 {
                assert!(!Clip::new(quadric.clone(), regions[..1].to_vec()).bounds().is_bounded());
            }
            let map = Affine::rotation_x(0.7)
                .unwrap()
                .then(&Affine::translation(Vec3::new(3.0, -2.0, 0.5)).unwrap())
                .unwrap();
            let moved =
                Clip::new(Placed::new(quadric, map), regions.iter().map(|r| r.clone().placed(map)).collect());
            let bounds = moved.bounds();
            assert!(bounds.is_bounded());
            let mut met = 0;
            for _ in 0..200 {
                let [x, y, z] = [0, 1, 2].map(|i| dice.between(bounds.min[i], bounds.max[i]));
                let to = Point3::new(x, y, z);
                let from =
                    to + Vec3::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
                let ray = Ray::new(from, to - from).with_range(f64::NEG_INFINITY, f64::INFINITY);
                let local = LocalRay::new(&ray);
                let mut every = Every(Vec::new());
                moved.roots(&local, &mut every);
                for root in &every.0 {
                    let at = moved.resolve(&local, root, Need::POINT);
                    let near = Aabb::from_points([at.p]).expanded(at.dp);
                    assert!(!near.intersection(bounds).is_empty(), "{:?} {bounds:?}", at.p);
                    met += 1;
                }
            }
            assert!(met > 50, "{met}");
        }
    }
}

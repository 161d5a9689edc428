//! Points of the surface: directly on planes with integers, else on the leaf itself, mapped back
//! through one map after another.

use super::leaf::{HalfSpace, Leaf, outward};
use super::{IfsLeaf, System, word_of};
use crate::planar::{PlaneForm, Probe, ThreePoints, clearance, dot, exact3, foot_point, unit};
use crate::{All, AxisBox, LocalRay, Need, RingRay, Root, Sphere, Surface, SurfacePoint};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Point3, Ring, U, Vec3};

/// The plane `n.x = level / weight` with integers.
struct LatticePlane {
    n: Vec3,
    level: f64,
    weight: f64,
}

impl PlaneForm for LatticePlane {
    fn slope<T: Ring>(&self, ray: &RingRay<T>) -> T {
        T::exact(self.weight) * dot(&exact3(self.n), &ray.d)
    }

    fn height<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(T::exact(self.weight) * dot(&exact3(self.n), &ray.o) - T::exact(self.level) * ray.w.clone())
    }
}

impl System {
    /// The point of a root.
    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let letters = self.letters(word_of(root.tag));
        if let (Leaf::Polytope(faces), Some(weight)) = (&self.leaf, self.frames.weight(self.depth))
            && let Some(face) = faces.get(root.face as usize)
            && let Some(point) = self.lattice_point(ray, face, &letters, weight, need)
        {
            return point;
        }
        self.point_below(ray, &letters, root, need)
    }

    fn lattice_point(
        &self,
        ray: &LocalRay<'_>,
        face: &HalfSpace,
        letters: &[usize],
        weight: f64,
        need: Need,
    ) -> Option<SurfacePoint> {
        let (n, h) = face.lattice()?;
        let level = (self.frames.offset(letters, n)? + h) as f64;
        let plane = LatticePlane { n: Vec3::from(*n), level, weight };
        let probe = Probe::with_scale(ray, Point3::ORIGIN, 0, 1.0);
        let n2 = plane.n.dot(plane.n);
        let (mut p, mut dp) = foot_point(&probe, &plane, plane.n, n2, -level / weight);
        let axis = (0..3).find(|&i| n2 == 1.0 && plane.n[i] != 0.0);
        if let Some(axis) = axis {
            // Within the copy: moving a point into a convex set, but for the rounding of its
            // corners, brings it no farther from the set's points.
            for i in 0..3 {
                let mut e = [0.0; 3];
                e[i] = 1.0;
                let middle = self.frames.offset(letters, &e)? as f64;
                let (low, high) = ((middle - 1.0) / weight, (middle + 1.0) / weight);
                p[i] = p[i].max(low).min(high);
                dp[i] += U * (1.0 + 4.0 * U);
            }
            p[axis] = plane.n[axis] * level / weight;
        }
        let length = n2.sqrt() * weight * (1.0 - 4.0 * U);
        let off = clearance(&plane, p, Point3::ORIGIN, 0, length);
        let mut point = SurfacePoint::new(p, dp, off, unit(plane.n));
        if let Some(axis) = axis
            && (need.contains(Need::UV) || need.contains(Need::DERIVATIVES))
        {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            point.uv = [0.5 * (p[a] + 1.0), 0.5 * (p[b] + 1.0)];
            point.dpdu[a] = 2.0;
            point.dpdv[b] = 2.0;
        }
        Some(point)
    }

    /// The point in the frame of a copy with these letters left.
    fn point_below(&self, ray: &LocalRay<'_>, letters: &[usize], root: &Root, need: Need) -> SurfacePoint {
        let Some((&letter, rest)) = letters.split_first() else { return self.leaf_point(ray, root, need) };
        match self.frames.map(letter) {
            Some(map) => ray.resolve_through(map, |local| self.point_below(local, rest, root, need)),
            None => self.leaf_point(ray, root, need),
        }
    }

    fn leaf_point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let mut line = *ray;
        line.source = None;
        (line.t_min, line.t_max) = (f64::NEG_INFINITY, f64::INFINITY);
        let unknown = || SurfacePoint::unknown(ray.o);
        match self.given {
            IfsLeaf::Box(a, b) => match AxisBox::new(a, b) {
                Ok(leaf) => leaf.resolve(&line, root, need),
                Err(_) => unknown(),
            },
            IfsLeaf::Sphere(centre, radius) => {
                let Ok(leaf) = Sphere::new(centre, radius) else { return unknown() };
                let mut all = All::default();
                leaf.roots(&line, &mut all);
                let is_it = |r: &&Root| r.sign == root.sign || all.roots.len() == 1;
                match all.roots.iter().find(is_it) {
                    Some(root) => leaf.resolve(&line, root, need),
                    None => unknown(),
                }
            }
            IfsLeaf::Tetrahedron(corners) => {
                let bounds = Aabb::from_points(corners);
                let Some(points) = outward(&corners).and_then(|faces| faces.get(root.face as usize).copied())
                else {
                    return unknown();
                };
                tetrahedron_point(&line, points, &bounds)
            }
        }
    }
}

/// The point of a face of a tetrahedron.
fn tetrahedron_point(ray: &LocalRay<'_>, points: [Point3; 3], bounds: &Aabb) -> SurfacePoint {
    let centre = bounds.centre();
    let size = bounds.reach_from(centre);
    let scale = exponent(size) + 1;
    let probe = Probe::with_scale(ray, centre, scale, scale2(size, -scale));
    let plane = ThreePoints { points, centre, scale };
    let (_, exact) = plane.normal::<durer_math::EFloat>();
    let n = Vec3::new(exact[0].v, exact[1].v, exact[2].v);
    let from = (points[0] - centre).map(|x| scale2(x, -scale));
    let (p, dp) = foot_point(&probe, &plane, n, n.dot(n), -n.dot(from));
    let least = crate::planar::least_length(exact);
    let off = clearance(&plane, p, centre, scale, least);
    let k = exponent(n.max_abs());
    SurfacePoint::new(p, dp, off, unit(n.map(|x| scale2(x, -k))))
}

//! Points of the limit surface, and on which side of a closed one a point is.

use super::limit::{E_POINTS, Limit, MOST_STEPS, Place, Refined, Spot, Tail, parameters};
use super::plan::limit;
use super::sharp_normal::sharp_normal;
use crate::patch::cell::sums;
use crate::patch::point::{Jet, located};
use crate::{All, LocalPoint, LocalRay, Root, RootKind, Side, SurfacePoint};
use durer_math::{Dd, Ray, U, Vec3};

use super::limit::Leaf;

/// A corner of this size, in units, is one point.
const POINT: f64 = durer_math::scale::pow2(-50);
/// Directions in which it is counted how often a point is enclosed.
const DIRECTIONS: [[f64; 3]; 5] = [
    [0.5773, 0.7013, 0.4183],
    [-0.2113, 0.9113, 0.3533],
    [0.8819, -0.3119, 0.3535],
    [0.1931, 0.3717, -0.9081],
    [-0.6287, -0.5233, 0.5753],
];

fn vector(p: [Dd; 3]) -> Vec3 {
    Vec3::from(p.map(Dd::to_f64))
}

impl Limit {
    /// The point of a root.
    #[inline(always)]
    pub(super) fn point(&self, ray: &LocalRay<'_>, root: &Root) -> SurfacePoint {
        let mut place = Place::of(root.face, self.is_triangles);
        let Some(mut spot) = self.spots.get(root.face as usize).copied() else {
            return SurfacePoint::unknown(self.centre);
        };
        while let Spot::Split(first) = spot {
            let k = place.quarter_at(root.tag);
            (spot, place) = (self.spots[first as usize + k], place.quarter(k));
        }
        let mut point = match spot {
            Spot::Leaf(k) => self.on_leaf(ray, root, &self.leaves[k as usize]),
            Spot::Tail(k) => self.in_corner(ray, root, &self.tails[k as usize]),
            Spot::Split(_) => SurfacePoint::unknown(self.centre),
        };
        point.uv = parameters(self.is_triangles, root.tag);
        point
    }

    #[inline(always)]
    fn on_leaf(&self, ray: &LocalRay<'_>, root: &Root, leaf: &Leaf) -> SurfacePoint {
        let (face, place) = (&leaf.face, &leaf.place);
        let uv = place.inner(root.tag);
        let jet = face.jet(uv);
        let normal = face.normal(uv, &jet).map(|(n, near)| (n * f64::from(self.outward), near));
        let jet = jet.moved(Vec3::from(leaf.base), place.width);
        // The evaluation, and the sum with the base.
        let eta = (2.0 * sums(face.size) + 10.0) * U * face.largest + E_POINTS;
        located((self.centre, self.scale), (ray, root), &jet, normal, eta)
    }

    fn in_corner(&self, ray: &LocalRay<'_>, root: &Root, tail: &Tail) -> SurfacePoint {
        let node = &tail.node;
        let reach = tail.relative.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut spare = None;
        if reach > POINT
            && node.depth < MOST_STEPS
            && let Some(finer) = tail.finer(&self.plans, &self.kept, &mut spare)
        {
            return match &finer[node.place.quarter_at(root.tag)] {
                Refined::Patch(patch) => self.on_leaf(ray, root, &patch.leaf),
                Refined::Tail(tail) => self.in_corner(ray, root, tail),
            };
        }
        // All of it is one point.
        let p = &node.points;
        let less = |a: [Dd; 3], b: [Dd; 3]| vector([0, 1, 2].map(|c| a[c] - b[c]));
        let (pu, pv) = if self.is_triangles {
            (less(p[1], p[0]) * 2.0, less(p[2], p[0]) * 2.0)
        } else {
            (less(p[1], p[0]) + less(p[2], p[3]), less(p[3], p[0]) + less(p[2], p[1]))
        };
        let by = 0.5 / node.place.width;
        let unit = |n: Vec3| n * (1.0 / n.length());
        let (y, n) = match node.wheel(&self.plans) {
            Some(wheel) => {
                let [y, a, b] = limit(wheel, p).map(vector);
                (y, unit(a.cross(b)))
            }
            None => {
                let y = vector(p[node.vertex(&self.plans).unwrap_or(0)]);
                (y, sharp_normal(node, &self.plans).unwrap_or_else(|| unit(pu.cross(pv))))
            }
        };
        let n = n * f64::from(self.outward);
        let jet = Jet::flat(y, pu * by, pv * by);
        let normal = n.is_finite().then_some((n, jet));
        let eta = 4.0 * POINT;
        located((self.centre, self.scale), (ray, root), &jet, normal, eta)
    }

    /// On which side of a closed surface a point is: by the crossings ahead of it along a line, of
    /// which as many more leave than enter as it is enclosed.
    pub(super) fn side(&self, point: &LocalPoint<'_>) -> Side {
        let mut side = Side::Out;
        for direction in DIRECTIONS {
            let ray = Ray::new(point.p, Vec3::from(direction)).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let ray = LocalRay::with_errors(&ray, point.p_err, Vec3::ZERO);
            let mut all = All::default();
            self.roots(&ray, &mut all);
            if all.roots.iter().any(|root| root.lo <= 0.0 && root.hi >= 0.0) {
                return Side::On;
            }
            let ahead = all.roots.iter().filter(|root| root.lo > 0.0);
            let turns: i32 = ahead.map(|root| i32::from(root.sign)).sum();
            side = if turns == 0 { Side::Out } else { Side::In };
            let is_balanced = all.roots.iter().map(|root| i32::from(root.sign)).sum::<i32>() == 0;
            if is_balanced && all.roots.iter().all(|root| root.kind == RootKind::Simple) {
                break;
            }
        }
        side
    }
}

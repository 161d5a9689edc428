//! Ends of rays that lie on surfaces: the camera's location, and the locations of lights.
//!
//! The surface on which the camera stands is not seen, and the surface on which a light lies does
//! not shadow it. So the crossings of a ray that belong to one of its ends must be separated from
//! the others. No fixed distance decides that, but the rounding of the numbers involved.
//!
//! ```text
//!        o ───────────────────●── q         q   the end of the ray at t = e: the camera (e = 0), a light (e = 1)
//!                      t n ↖   ╲            t   the crossing at hand, n its unit normal
//!                            ╲  ╲ height    height of q over the tangent plane: |e - t| |n . d|
//! ```
//!
//! *The surface passes through `q`* if the height of `q` over it is not above
//!
//! ```text
//!     off + sum |n_i| u |d_i| + gamma(12) |q|₁
//! ```
//!
//! - `off` bounds the distance of the computed crossing point from the exact surface. It includes
//!   the rounding of the surface's own numbers (centres, radii, coefficients).
//! - A ray to a light has `d = fl(q - o)`, so that `o + d` misses `q` by at most `u |d_i|` on each
//!   axis. `off` and the bracket `[t_lo, t_hi]` include every other error on the way to the
//!   crossing. A camera's ray starts at `q` itself.
//! - `q` lies on a surface because the scene's author gave matching numbers to both: each of the
//!   two was written (one rounding), scaled (one), rotated (three, as a rotation about an axis is
//!   two products and a sum) and translated (one). Six roundings for each of the two are
//!   `gamma(12)` times the sum of the coordinates' magnitudes, as a rotation exchanges coordinates.
//!
//! The height is measured over the tangent plane at the crossing, from the end of the bracket that
//! is nearer to `q`. A curved surface deviates from that plane by at most `bend / 2 r²` at the
//! distance `r`. Its deviation between the crossing and `q` must not exceed the bound either.
//! Otherwise the crossing is a different place of the surface, such as a silhouette whose tangent
//! plane happens to hold `q`.
//!
//! The decision uses the exact query's answer for one ray, so it does not depend on how rays are
//! bundled. The packet kernels answer with wider brackets. [`RayEnd::may_be`] is the filter for
//! those: it admits each crossing that the decision could accept.

use crate::vector::dot;
use durer_geometry::{Geometry, Hit, Hits8, Rays8};
use durer_math::{Aabb, F8, M8, Point3, Ray, Shaft, U, Vec3, gamma};
use durer_surfaces::{Need, SurfacePoint};

/// The fraction of a scene's size that the filter admits, `2^-40`. The widths that the decision
/// allows are far below half of it: `gamma(12) < 2^-49`, and brackets of exact queries are at most
/// 32 ulp, `2^-47`, on each side.
const FILTER_WIDTH: f64 = 1.0 / (1_u64 << 40) as f64;

/// The end of rays at the camera or at a light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayEnd {
    /// Its parameter on the rays: 0 for the camera, 1 for a light.
    t: f64,
    /// The sum of the magnitudes of the coordinates from which the end was computed.
    size: f64,
    /// Whether the ends of parallel rays differ; then the coordinates of the ray's own end are
    /// added to `size`.
    is_parallel: bool,
    /// The height that the filter admits.
    filter: f64,
}

/// The sum of the magnitudes of a vector's coordinates.
fn sum_of(v: Vec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// An upper bound of the coordinates of all bounded objects of a geometry.
fn reach(geometry: &Geometry) -> f64 {
    let tree = geometry.tree();
    if tree.is_empty() { 0.0 } else { tree.bounds().magnitude() }
}

impl RayEnd {
    fn new(geometry: &Geometry, t: f64, size: f64, is_parallel: bool) -> Self {
        Self { t, size, is_parallel, filter: FILTER_WIDTH * (size + reach(geometry)) }
    }

    /// The start of a camera's rays. `size` is the sum of the magnitudes of the coordinates from
    /// which the starts are computed.
    pub(crate) fn camera(geometry: &Geometry, size: f64) -> Self {
        Self::new(geometry, 0.0, size, false)
    }

    /// The end of a light's shadow rays. `None` if certainly no surface that throws shadows passes
    /// near it.
    pub(crate) fn light(geometry: &Geometry, location: Point3, mask: u32) -> Option<Self> {
        let end = Self::new(geometry, 1.0, sum_of(location.to_vec()), false);
        let near = Aabb::centred(location, Vec3::new(end.filter, end.filter, end.filter));
        let candidates = geometry.candidates(&Shaft::between(near, near), None);
        candidates.is_none_or(|candidates| candidates.admits(mask)).then_some(end)
    }

    /// The ends of a parallel light's shadow rays, on the plane through its location. `None` if
    /// certainly no surface passes near that plane.
    pub(crate) fn light_plane(geometry: &Geometry, location: Point3, axis: Vec3) -> Option<Self> {
        let end = Self::new(geometry, 1.0, sum_of(location.to_vec()), true);
        let all = geometry.bounds();
        let meets = !all.is_bounded() || {
            let offset = axis.dot(location.to_vec());
            Shaft::between(all, all).may_cross(axis, offset, end.filter)
        };
        (meets && !all.is_empty()).then_some(end)
    }

    /// Replaces the hits of rays that start here by the first ones that do not belong to a surface
    /// through their start. On entry `hits` are the first hits.
    pub(crate) fn see_beyond(&self, geometry: &Geometry, mask: u32, rays: &[Rays8], hits: &mut [Hits8]) {
        for (rays, hits) in rays.iter().zip(hits) {
            for i in self.may_be(rays, hits).lanes() {
                hits.set_lane(i, self.first_beyond(geometry, &rays.lane(i), mask));
            }
        }
    }

    /// Removes the hits of rays that end here if they belong to a surface through their end. On
    /// entry `hits` are the first hits.
    pub(crate) fn see_before(&self, geometry: &Geometry, mask: u32, rays: &[Rays8], hits: &mut [Hits8]) {
        for (rays, hits) in rays.iter().zip(hits) {
            for i in self.may_be(rays, hits).lanes() {
                hits.set_lane(i, self.first_before(geometry, &rays.lane(i), mask));
            }
        }
    }

    /// The rays that end here and hit a surface which does not pass through their end. `hits` are
    /// their first hits.
    pub(crate) fn blocked(&self, geometry: &Geometry, mask: u32, rays: &Rays8, hits: &Hits8) -> M8 {
        let mut blocked = hits.hit;
        for i in self.may_be(rays, hits).lanes() {
            blocked.set_lane(i, self.is_blocked(geometry, &rays.lane(i), mask));
        }
        blocked
    }

    /// The crossings that may belong to this end: a superset of those that [`RayEnd::is_at`]
    /// accepts.
    #[inline(always)]
    fn may_be(&self, rays: &Rays8, hits: &Hits8) -> M8 {
        let away = (F8::splat(self.t) - hits.t).abs() - hits.t_error;
        let height = away * dot(hits.ng, rays.direction).abs();
        hits.hit & !height.gt(F8::splat(self.filter))
    }

    /// Whether the surface of this hit, from an exact query, passes through this end.
    fn is_at(&self, ray: &Ray, hit: &Hit, point: &SurfacePoint) -> bool {
        let away = (hit.t_lo - self.t).max(self.t - hit.t_hi).max(0.0);
        let (n, d) = (point.ng.to_vec(), ray.direction);
        let own = if self.is_parallel { sum_of(ray.origin.to_vec()) + sum_of(d) } else { 0.0 };
        let aim = if self.t == 0.0 { 0.0 } else { sum_of(Vec3::new(n.x * d.x, n.y * d.y, n.z * d.z)) * U };
        let bound = point.off + aim + gamma(12) * (self.size + own);
        // At most half of what the filter admits: the filter computes the same height with other
        // roundings.
        let bound = bound.min(0.5 * self.filter);
        let (height, far) = (away * dot(n, d).abs(), away * sum_of(d));
        // A tip has no tangent plane. There the distance of the crossing itself decides.
        far <= bound || height <= bound && 0.5 * point.bend * far * far <= bound
    }

    /// The first hit of a ray that starts here, without the surfaces that pass through its start.
    fn first_beyond(&self, geometry: &Geometry, ray: &Ray, mask: u32) -> Option<(Hit, SurfacePoint)> {
        let mut ray = *ray;
        loop {
            let hit = geometry.masked(mask).closest(&ray)?;
            let point = geometry.resolve_with(&ray, &hit, Need::SHADING_NORMAL);
            if !self.is_at(&ray, &hit, &point) {
                return Some((hit, point));
            }
            // Restart behind the bracket, so that each step leaves a crossing behind.
            let behind = hit.t_hi.max(hit.t).next_up();
            if behind == f64::INFINITY {
                return None;
            }
            ray = ray.with_range(behind, ray.t_max);
        }
    }

    /// Whether a ray that ends here hits a surface that does not pass through its end.
    fn is_blocked(&self, geometry: &Geometry, ray: &Ray, mask: u32) -> bool {
        geometry.masked(mask).any_where(ray, |hit| {
            !self.is_at(ray, hit, &geometry.resolve_with(ray, hit, Need::SHADING_NORMAL))
        })
    }

    /// The first hit of a ray that ends here; `None` if its surface passes through the end.
    fn first_before(&self, geometry: &Geometry, ray: &Ray, mask: u32) -> Option<(Hit, SurfacePoint)> {
        let hit = geometry.masked(mask).closest(ray)?;
        let point = geometry.resolve_with(ray, &hit, Need::SHADING_NORMAL);
        (!self.is_at(ray, &hit, &point)).then_some((hit, point))
    }
}

//! The point of a hit, and the rays that leave it.

use durer_math::{Normal3, Point3, Ray, RaySide, Source, Vec3};

/// A point of a surface with its error bounds and its differential geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The position.
    pub p: Point3,
    /// Per-axis bound on the distance to the exact crossing.
    pub dp: Vec3,
    /// A distance along the normal that provably leaves the surface: `p + aside + off ng` is strictly
    /// in front, `p + aside - off ng` strictly behind, also after each coordinate is rounded away.
    /// Usually far smaller than `dp`. Where the surface bends within the rounding of coordinates (a
    /// finite `bend` with `bend off >= 1/2`), as a thin cylinder far away, neither is proven.
    pub off: f64,
    /// The geometric normal: unit length, outward for solids, as stored for open surfaces.
    pub ng: Normal3,
    /// The shading normal: unit length, on the side of `ng`.
    pub ns: Normal3,
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// The derivative of the position by u.
    pub dpdu: Vec3,
    /// The derivative of the position by v.
    pub dpdv: Vec3,
    /// The derivative of the normal by u.
    pub dndu: Vec3,
    /// The derivative of the normal by v.
    pub dndv: Vec3,
    /// Bound on the curvature near the point: at a distance `r` the surface has left its tangent
    /// plane by at most `bend / 2 r^2`. Infinite at a tip, which has no tangent plane; `off` then
    /// leaves the tip along `ng`, also from any point within `slack` of `p`.
    pub bend: f64,
    /// See `bend`.
    pub slack: f64,
    /// The way from a tip at which two bodies meet, such as the two halves of a cone, to the middle
    /// between the starts on both sides: no normal there leads out of both bodies whose opposite
    /// leads into one. Zero elsewhere.
    pub aside: Vec3,
    /// The primitive the point lies on; set by the geometry that holds it.
    pub source: Option<Source>,
}

/// The step from a point without rounding error: far below the last place of the point, but so long
/// that no coordinate, and no error bound computed from it, comes near the subnormal numbers, with
/// which many CPUs compute a hundred times more slowly.
#[inline(always)]
pub(crate) fn least_step(p: Point3) -> f64 {
    p.to_vec().max_abs().mul_add(durer_math::scale::pow2(-500), f64::MIN_POSITIVE)
}

impl SurfacePoint {
    /// A point with its normal; all other data is zero until it is computed.
    pub fn new(p: Point3, dp: Vec3, off: f64, ng: Normal3) -> Self {
        Self {
            p,
            dp,
            off,
            ng,
            ns: ng,
            uv: [0.0; 2],
            dpdu: Vec3::ZERO,
            dpdv: Vec3::ZERO,
            dndu: Vec3::ZERO,
            dndv: Vec3::ZERO,
            bend: 0.0,
            slack: 0.0,
            aside: Vec3::ZERO,
            source: None,
        }
    }

    /// The point of a root that is not the surface's own: nothing can be computed.
    pub(crate) fn unknown(p: Point3) -> Self {
        let far = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
        Self::new(p, far, f64::INFINITY, Vec3::Y.to_normal())
    }

    /// A ray that leaves the surface along `direction`, from the side to which it points, with `t`
    /// in `[0, inf]`.
    ///
    /// Its origin is provably on that side, so no hit needs to be ignored (Pharr, Jakob, Humphreys,
    /// *Physically Based Rendering*, 4th ed. 2023, section 6.8, with a bound along the normal in
    /// place of one per axis).
    #[inline]
    pub fn spawn(&self, direction: Vec3) -> Ray {
        self.spawn_from(self.side_towards(direction), direction)
    }

    /// A ray to `target`, which it reaches at `t = 1`; its range is `[0, 1]`.
    #[inline]
    pub fn spawn_to(&self, target: Point3) -> Ray {
        let side = self.side_towards(target - self.p);
        let origin = self.start(side);
        let ray = Ray::new(origin, target - origin).with_range(0.0, 1.0);
        ray.spawned_from(self.source.map(|s| Source { side, ..s }))
    }

    /// A ray that leaves along `direction` from the given side.
    #[inline]
    pub fn spawn_from(&self, side: RaySide, direction: Vec3) -> Ray {
        Ray::new(self.start(side), direction).spawned_from(self.source.map(|s| Source { side, ..s }))
    }

    /// The side to which a direction points. At a grazing direction either side is correct: the
    /// start is proven for both.
    #[inline(always)]
    fn side_towards(&self, d: Vec3) -> RaySide {
        // Not fused: this is compiled for any CPU.
        let n = self.ng;
        if n.x * d.x + n.y * d.y + n.z * d.z < 0.0 { RaySide::Back } else { RaySide::Front }
    }

    /// The point at `off` on the given side, each coordinate rounded away from the surface.
    #[inline(always)]
    fn start(&self, side: RaySide) -> Point3 {
        let step = if side == RaySide::Front { self.off } else { -self.off };
        let from = self.p + self.aside;
        let axis = |p: f64, n: f64| {
            let move_by = step * n;
            let q = p + move_by;
            if move_by > 0.0 {
                q.next_up()
            } else if move_by < 0.0 {
                q.next_down()
            } else {
                q
            }
        };
        Point3::new(axis(from.x, self.ng.x), axis(from.y, self.ng.y), axis(from.z, self.ng.z))
    }
}

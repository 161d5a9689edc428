//! Rays for the tree: conservative in f32, so that no box is missed.

use crate::frame::{Units, down32, up32};
use durer_math::{Aabb, Point3, U, Vec3};

/// Half an ulp of 1 in f32.
pub(crate) const U32: f64 = 1.0 / (1 << 24) as f64;
/// Smaller sizes are replaced by this, so that a flat tree causes no division of zero by zero.
pub(crate) const LEAST: f64 = 1.0 / (1_u64 << 60) as f64;
/// The greatest length of a ray's segment in the tree with which boxes are tested; the ends of a
/// ray from farther away are too uncertain.
pub(crate) const LONGEST: f64 = (1 << 16) as f64;
/// A bound on the roundings of a difference, of `1 / d`, of their product and of the terms that are
/// then added.
pub(crate) const WIDEN: f64 = 8.0 * U;
/// The least component of a direction that is distinguished from zero: within the greatest length
/// it moves a ray by 2^-284, which is negligible.
pub(crate) const SLOWEST: f64 = f64::from_bits((1023 - 300) << 52);
/// Added before rounding to the nearest f32, so that the result is a bound.
pub(crate) const TO_NEAREST: f64 = U32 * (1.0 + 1.0 / (1 << 20) as f64);

/// A ray in the caller's units: `origin + t direction`, known within errors (per axis).
///
/// The largest component of the direction is in `[1, 2)` in magnitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray64 {
    /// The point at `t = 0`.
    pub origin: Point3,
    /// The direction.
    pub direction: Vec3,
    /// Per-axis bound on the error of the origin.
    pub origin_error: Vec3,
    /// Per-axis bound on the error of the direction.
    pub direction_error: Vec3,
    /// Crossings below this do not matter.
    pub t_min: f64,
    /// Crossings above this do not matter.
    pub t_max: f64,
    /// Crossings between these certainly matter: the caller's range, where `t_min` and `t_max` had
    /// to be widened.
    pub inner: (f64, f64),
}

impl Ray64 {
    /// Whether the ray may meet a box, which may be unbounded; `false` is certain.
    pub fn may_meet(&self, bounds: &Aabb) -> bool {
        if bounds.is_empty() {
            return false;
        }
        // One axis has |d| >= 1: beyond this t the ray has left the box for good.
        let reach = (0..3).fold(0.0_f64, |far, i| {
            far.max((bounds.min[i] - self.origin[i]).abs()).max((bounds.max[i] - self.origin[i]).abs())
        });
        let error = self.origin_error + self.direction_error * (2.0 * reach);
        if !error.is_finite() {
            return true;
        }
        bounds.expanded(error * 2.0).slabs(self.origin, self.direction, self.t_min, self.t_max).is_some()
    }
}

/// A ray for queries of a tree.
pub trait TreeRay {
    /// The ray in f64.
    fn line(&self) -> Ray64;

    /// The ray in f32, which suffices for many rays.
    fn glance(&self) -> Ray32;
}

/// The numbers of a [`Ray64`], each rounded to the nearest f32, and so perhaps to zero or infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray32 {
    /// The origin, then `t_min`.
    pub origin: [f32; 4],
    /// The direction, then `t_max`.
    pub direction: [f32; 4],
    /// The errors, then 0.
    pub origin_error: [f32; 4],
    /// The errors, then 0.
    pub direction_error: [f32; 4],
    /// Whether the errors are zero and the inner range is the whole one.
    pub is_exact: bool,
}

impl Ray32 {
    /// A value for which `line` is used instead.
    pub const NOTHING: Self = Self {
        origin: [f32::NAN; 4],
        direction: [f32::NAN; 4],
        origin_error: [0.0; 4],
        direction_error: [0.0; 4],
        is_exact: false,
    };
}

/// The number of rays in a packet.
pub const PACKET: usize = 8;

/// The number of rays in a large packet, where there are lanes for it.
pub(crate) const TWICE: usize = 2 * PACKET;

/// The numbers of eight [`Ray64`]s that are all exactly known, each rounded to the nearest f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packet32 {
    /// The origins, axis by axis.
    pub origin: [[f32; PACKET]; 3],
    /// The directions.
    pub direction: [[f32; PACKET]; 3],
    /// The least parameters that matter.
    pub t_min: [f32; PACKET],
    /// The greatest parameters that matter.
    pub t_max: [f32; PACKET],
}

impl Packet32 {
    /// The packet of eight rays, if all are exact.
    #[inline(always)]
    pub fn of(rays: &[Ray32; PACKET]) -> Option<Self> {
        let mut all = Self {
            origin: [[0.0; PACKET]; 3],
            direction: [[0.0; PACKET]; 3],
            t_min: [0.0; PACKET],
            t_max: [0.0; PACKET],
        };
        let mut are_exact = true;
        for (i, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                all.origin[axis][i] = ray.origin[axis];
                all.direction[axis][i] = ray.direction[axis];
            }
            (all.t_min[i], all.t_max[i]) = (ray.origin[3], ray.direction[3]);
            are_exact &= ray.is_exact;
        }
        are_exact.then_some(all)
    }
}

impl TreeRay for Ray64 {
    #[inline(always)]
    fn line(&self) -> Ray64 {
        *self
    }

    #[inline(always)]
    fn glance(&self) -> Ray32 {
        #[inline(always)]
        fn four(v: [f64; 3], w: f64) -> [f32; 4] {
            [v[0] as f32, v[1] as f32, v[2] as f32, w as f32]
        }
        Ray32 {
            origin: four(self.origin.to_array(), self.t_min),
            direction: four(self.direction.to_array(), self.t_max),
            origin_error: four(self.origin_error.to_array(), 0.0),
            direction_error: four(self.direction_error.to_array(), 0.0),
            is_exact: self.origin_error == Vec3::ZERO
                && self.direction_error == Vec3::ZERO
                && self.inner == (self.t_min, self.t_max),
        }
    }
}

/// The numbers of a node test: per axis `near = plane * r + c_near`, `far = plane * r + c_far`, in
/// f32.
///
/// They are computed in f64, once per ray: the ray is clipped to the tree's box and its origin
/// moved to the entry. `r` is `1 / d`, clamped so that a ray parallel to an axis needs no branch.
/// The constants include the slack for every rounding of the node test: of `r` (one unit), of the
/// fused multiply-add (one), of the moved origin and the second order (a tenth), and, where `r` is
/// clamped, for the changed direction (four tenths). So `near <= t <= far` for each `t` at which
/// the exact ray is in the box. This equals growing each box by `1.5e-7 (M + |o|)`, with the
/// instructions of an unsafe test. Compare T. Ize, "Robust BVH ray traversal", Journal of Computer
/// Graphics Techniques 2(2), 2013, which computes differences per plane instead.
///
/// Three of each four numbers are used; four are written and read at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CullRay {
    pub(crate) r: [f32; 4],
    pub(crate) near: [f32; 4],
    pub(crate) far: [f32; 4],
    /// Bit `i` is set if `d_i` is negative (or -0).
    pub(crate) octant: u32,
    pub(crate) way: ClippedRay,
}

/// A ray's segment within a tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClippedRay {
    /// The entry point in tree units, rounded to f64 and to f32, and the direction, rounded to f32.
    pub(crate) start: [f32; 4],
    pub(crate) direction: [f32; 4],
    /// The first and the last parameter that matter, from the entry.
    pub(crate) t_near: f32,
    pub(crate) t_far: f32,
    /// Whether the start is the ray's origin, the rounding to f32 is the only error of start and
    /// direction, and all crossings between the first and the last parameter count.
    pub(crate) is_exact: bool,
    /// A bound on the error of the ray's points within the tree, per axis.
    pub(crate) error: f64,
    /// The parameter of the entry.
    pub(crate) t_enter: f64,
    pub(crate) units: Units,
}

/// How many roundings a node test makes after `r`'s own: one if multiplication and addition are
/// fused, else two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rounding {
    Fused,
    Unfused,
}

impl Rounding {
    /// In units of `u32 (M + |o|) |r|`.
    pub(crate) fn slack(self) -> f64 {
        match self {
            Self::Fused => 2.5,
            Self::Unfused => 3.5,
        }
    }
}

/// A tree's box, to which exactly known rays are clipped. The numbers in the fourth lane pass every
/// test.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Clip {
    /// The box, grown by [`MARGIN`].
    pub(crate) lo: [f64; 4],
    pub(crate) hi: [f64; 4],
    /// The greatest magnitude of a coordinate along each axis.
    pub(crate) most: [f64; 4],
    /// The factor from the caller's lengths to tree units, which is exact; 0 if one number cannot
    /// hold it.
    pub(crate) shrink: f64,
    /// The factor from tree units to the caller's lengths; 0 if one number cannot hold it.
    pub(crate) grow: f64,
    /// The greatest magnitude of a coordinate, for rays that start [nearby](NEARBY).
    pub(crate) most32: [f32; 4],
    /// The factor from the lengths of a [`Ray32`] to tree units; infinite if the tree's size is
    /// [far](GLANCED) from 1.
    pub(crate) shrink32: f32,
}

/// Trees of sizes between `2^-32` and `2^32` accept rays in f32: the loss by underflow is then
/// below `2^-117` in tree units.
const GLANCED: (f64, f64) = (1.0 / (1_u64 << 32) as f64, (1_u64 << 32) as f64);

/// Rays that start with coordinates up to this, in tree units, need no clipping: f32 holds their
/// origins as accurately as the tree.
pub(crate) const NEARBY: f32 = 4.0;

/// A ray that runs within a face of the box, or nearly so, enters it this much earlier: far more
/// than [`SLOWEST`] moves it.
const MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

impl Clip {
    pub(crate) fn to(units: Units, lo: [f32; 3], hi: [f32; 3]) -> Self {
        let wide = |x: [f32; 3], by: f64, beyond: f64| {
            [f64::from(x[0]) + by, f64::from(x[1]) + by, f64::from(x[2]) + by, beyond]
        };
        let most = |i: usize| f64::from(lo[i]).abs().max(f64::from(hi[i]).abs()).max(LEAST);
        let (shrink, grow) = (units.inward(1.0), units.outward(1.0));
        let is_factor = shrink.is_normal() && grow.is_normal();
        Self {
            lo: wide(lo, -MARGIN, f64::MIN / 8.0),
            hi: wide(hi, MARGIN, f64::MAX / 8.0),
            most: [most(0), most(1), most(2), 1.0],
            shrink: if is_factor { shrink } else { 0.0 },
            grow: if is_factor { grow } else { 0.0 },
            most32: [most(0), most(1), most(2), 1.0].map(up32),
            shrink32: if (GLANCED.0..=GLANCED.1).contains(&shrink) { shrink as f32 } else { f32::INFINITY },
        }
    }
}

impl CullRay {
    /// Clips a ray to the tree's box `[lo, hi]`; its origin is relative to the tree's centre.
    /// `None` if it certainly misses the box.
    #[inline(always)]
    pub(crate) fn new(
        line: &Ray64,
        units: Units,
        lo: &[f32; 3],
        hi: &[f32; 3],
        rounding: Rounding,
    ) -> Option<Self> {
        let o = line.origin.map(|x| units.inward(x)).to_array();
        let d = line.direction.to_array();
        // One axis has |d| >= 1, so within the box |t| stays below this.
        let reach = o.iter().fold(0.0_f64, |m, x| m.max(x.abs())) + 4.0;
        let error: [f64; 3] = core::array::from_fn(|i| {
            // The loss of the origin by underflow is far below this.
            let origin = units.inward(line.origin_error[i]) + f64::MIN_POSITIVE;
            let lost = if line.direction_error[i] == 0.0 { 0.0 } else { reach * line.direction_error[i] };
            (origin + lost) * (1.0 + WIDEN)
        });
        if !(reach < f64::MAX && error.iter().all(|&e| e < 1.0)) {
            return Some(Self::everywhere(&d, units));
        }
        let (t_min, t_max) = (units.inward(line.t_min), units.inward(line.t_max));
        // A tiny parameter that was rounded in scaling is widened by the clipping below only if the
        // box does not begin later.
        let (mut enter, mut exit) = (if t_min == 0.0 { line.t_min.min(0.0) } else { t_min }, t_max.next_up());
        let inverse = d.map(|x| 1.0 / x);
        for i in 0..3 {
            let (a, b) = (f64::from(lo[i]) - error[i], f64::from(hi[i]) + error[i]);
            if d[i] == 0.0 {
                if o[i] < a || o[i] > b {
                    return None;
                }
                continue;
            }
            let (first, last) = if d[i] > 0.0 { (a, b) } else { (b, a) };
            let quotient = |x: f64| if inverse[i].is_finite() { x * inverse[i] } else { x / d[i] };
            let first = quotient(first - o[i]).min(f64::MAX);
            let last = quotient(last - o[i]).max(f64::MIN);
            enter = enter.max(first - WIDEN * first.abs());
            exit = exit.min(last + WIDEN * last.abs());
        }
        if enter > exit {
            return None;
        }
        let way = (exit - enter).max(LEAST);
        if way.is_nan() || way > LONGEST {
            return Some(Self::everywhere(&d, units));
        }
        let (mut r32, mut near, mut far, mut starts) = ([0.0; 4], [0.0; 4], [0.0; 4], [0.0; 4]);
        for i in 0..3 {
            let start = if enter == 0.0 { o[i] } else { enter.mul_add(d[i], o[i]) };
            starts[i] = start as f32;
            let size = f64::from(lo[i]).abs().max(f64::from(hi[i]).abs()).max(LEAST) + start.abs();
            let r = inverse[i];
            let bends = 0.4 * U32 * size;
            let r = if r.abs() * bends <= way { r } else { (way / bends).copysign(r) };
            let slack = (rounding.slack() * U32).mul_add(size, error[i]) * r.abs();
            r32[i] = r as f32;
            near[i] = down32(-start * r - slack);
            far[i] = up32(-start * r + slack);
        }
        let t_far = up32(way.next_up());
        Some(Self {
            r: r32,
            near,
            far,
            octant: octant(&d),
            way: ClippedRay {
                start: starts,
                direction: single(&d),
                t_near: 0.0,
                t_far,
                is_exact: false,
                error: error[0].max(error[1]).max(error[2]),
                t_enter: enter,
                units,
            },
        })
    }

    /// A ray that meets every box: for rays so far away or so uncertain that in these units no box
    /// can be excluded.
    #[cold]
    fn everywhere(d: &[f64; 3], units: Units) -> Self {
        let big = 4.0 * LONGEST as f32;
        let direction = single(d);
        Self {
            r: direction.map(|x| 1.0_f32.copysign(x)),
            near: [-big; 4],
            far: [big; 4],
            octant: octant(d),
            way: ClippedRay {
                start: [0.0; 4],
                direction,
                t_near: 0.0,
                t_far: 1.0,
                is_exact: false,
                error: f64::INFINITY,
                t_enter: f64::NEG_INFINITY,
                units,
            },
        }
    }
}

/// The ends of an exactly known ray's range are moved inward by this: relative, and absolute.
pub(crate) const INSIDE: (f32, f32) = (1.0 / (1 << 20) as f32, 1.0 / (1_u128 << 100) as f32);

impl ClippedRay {
    /// The limit of the search, in the node test's parameter, if nothing beyond the caller's `t`
    /// matters.
    #[inline(always)]
    pub(crate) fn shortened(&self, t: f64) -> f32 {
        let way = self.units.inward(t) - self.t_enter;
        // A ray that meets every box has its entry at minus infinity, so it is never shortened.
        up32(way.next_up()).min(self.t_far)
    }

    /// The parameter at the entry, in tree units.
    #[inline(always)]
    pub(crate) fn entry(&self) -> f64 {
        self.t_enter
    }

    /// Converts a range of the caller's `t` to the parameter of the node test, rounded inward.
    #[inline(always)]
    pub(crate) fn inner(&self, (from, to): (f64, f64)) -> (f32, f32) {
        // There is nothing to hit beyond the greatest length. So far away f32 is coarse, but
        // finite.
        const BEYOND: f64 = (1_u64 << 40) as f64;
        let single = |x: f64| (self.units.inward(x) - self.t_enter).clamp(-BEYOND, BEYOND) as f32;
        // More than the roundings of the difference and to f32, and than the loss of the scaling by
        // underflow.
        let step = |x: f32| x.abs().mul_add(1.0 / (1 << 22) as f32, 1.0 / (1_u128 << 120) as f32);
        let (from, to) = (single(from), single(to));
        (from + step(from), to - step(to))
    }

    /// The whole range of a ray that is [exact](ClippedRay::is_exact), rounded inward: its ends are
    /// within ten units of the first and the last parameter.
    #[inline(always)]
    pub(crate) fn inside(&self) -> (f32, f32) {
        let step = |x: f32| x.abs().mul_add(INSIDE.0, INSIDE.1);
        // There is nothing to hit beyond the greatest length.
        let last = if self.t_far > LONGEST as f32 { LONGEST as f32 } else { self.t_far };
        (self.t_near + step(self.t_near), last - step(last))
    }

    /// Converts a parameter of the node test to the caller's `t`.
    pub(crate) fn caller_t(&self, t: f32) -> f64 {
        self.units.outward(f64::from(t) + self.t_enter)
    }
}

#[inline(always)]
fn single(d: &[f64; 3]) -> [f32; 4] {
    [d[0] as f32, d[1] as f32, d[2] as f32, 0.0]
}

#[inline(always)]
fn octant(d: &[f64; 3]) -> u32 {
    (0..3).map(|i| u32::from(d[i].is_sign_negative()) << i).sum()
}

//! Crossings of eight rays with faces of degree at most two.

use super::closest::Spot;
use super::quadric::{Quadratic8, QuadricFace8, Seen};
use super::rays::{BEHIND, CLEAR, FAR, From8, SLACK};
use durer_math::{F8, Isa, M8, U};

/// The two roots of a face along eight rays: the entry, where the polynomial falls, and the exit.
#[derive(Debug, Default)]
pub(super) struct Roots {
    /// Both roots exist and are known.
    pub(super) known: M8,
    /// There is no root: the polynomial has the sign of `A` everywhere.
    pub(super) none: M8,
    /// `A` is certainly positive.
    pub(super) opens: M8,
    pub(super) enter: F8,
    pub(super) e_enter: F8,
    pub(super) leave: F8,
    pub(super) e_leave: F8,
}

/// The root of a plane along eight rays.
#[derive(Debug, Default)]
pub(super) struct PlaneRoot {
    /// The ray certainly crosses the plane.
    pub(super) crosses: M8,
    /// The ray goes downward.
    pub(super) falls: M8,
    /// The ray certainly stays above, or certainly below, on the part that matters.
    pub(super) above: M8,
    pub(super) below: M8,
    pub(super) t: F8,
    pub(super) e: F8,
}

/// The part of each of eight rays inside a slab, that is, between two parallel planes.
#[derive(Debug, Default)]
pub(super) struct SlabRoots {
    /// The ray certainly crosses both planes.
    pub(super) known: M8,
    /// The ray certainly stays outside, or certainly inside, on the part that matters.
    pub(super) outside: M8,
    pub(super) inside: M8,
    /// The ray enters through the first plane.
    pub(super) rises: M8,
    pub(super) enter: F8,
    pub(super) e_enter: F8,
    pub(super) leave: F8,
    pub(super) e_leave: F8,
}

/// Rays that start on a surface, seen from one of its faces.
#[derive(Clone, Copy)]
pub(super) struct Leaving<'a> {
    pub(super) from: &'a From8,
    pub(super) face: usize,
    pub(super) turned: bool,
}

impl Leaving<'_> {
    /// The lanes that start on this face, and those whose polynomial is negative at the start.
    #[inline(always)]
    pub(super) fn lanes(&self) -> (M8, M8) {
        let here = F8::splat(self.face as f64);
        let lanes = self.from.lanes & self.from.face.equals(here);
        (lanes, if self.turned { !self.from.back } else { self.from.back })
    }
}

/// `c / slope` with a bound on its error, if `c` is within `e_c` and the slope within `e_slope`;
/// `inverse` is one over the slope, rounded.
#[inline(always)]
pub(crate) fn quotient(c: F8, e_c: F8, inverse: F8, e_slope: F8) -> (F8, F8) {
    let t = c * inverse;
    let far = t.abs();
    // Two roundings, and the greatest difference to the exact quotient: `(e_c + |t| e_slope) /
    // (|slope| - e_slope)`, which is at most 4/3 of the division by `|slope|`.
    let e = ((e_c + far * e_slope) * inverse.abs() * (CLEAR / (CLEAR - 1.0)) + far * (4.0 * U)) * SLACK;
    (t, e)
}

// Each step below is a separate function that reads its eight lanes from memory and writes them
// back. In one large function the compiler mixes lanes of different numbers, which costs several
// times as much as the loads and stores.
impl QuadricFace8 {
    /// Roots of `A t² + 2 B t + C` by the stable formula, with bounds.
    ///
    /// For a ray that starts on this face, the near root is the point that it left. It lies behind
    /// the ray if the ray goes away from the surface.
    #[inline(never)]
    pub(super) fn roots(&self, isa: Isa, rays: &Seen<'_>, from: Option<&Leaving<'_>>, roots: &mut Roots) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.roots_here(rays, from, roots),
        );
    }

    #[inline(always)]
    pub(super) fn roots_here(&self, rays: &Seen<'_>, from: Option<&Leaving<'_>>, roots: &mut Roots) {
        let Quadratic8 { a, b, c, e_a, e_b, e_c } = self.along(rays);
        let (size_a, size_b, size_c) = (a.abs(), b.abs(), c.abs());
        let ac = a * c;
        let disc = b.mul_add(b, -ac);
        let e_disc = ((size_b * 2.0 + e_b) * e_b
            + (size_a + e_a) * e_c
            + size_c * e_a
            + (b * b + ac.abs()) * (4.0 * U))
            * SLACK;
        let some = disc.gt(e_disc);
        let root = some.select(disc, F8::ONE).sqrt();
        let q = -(b + root.copysign(b));
        let size_q = q.abs();
        let e_q = (e_b + e_disc / root + size_q * (2.0 * U)) * SLACK;
        let (far, near) = (q / a, c / q);
        let e_far = ((e_q + far.abs() * e_a) / (size_a - e_a) + far.abs() * (2.0 * U)) * SLACK;
        let e_near = ((e_c + near.abs() * e_q) / (size_q - e_q) + near.abs() * (2.0 * U)) * SLACK;
        let mut known =
            some & size_a.gt(e_a * CLEAR) & size_q.gt(e_q * CLEAR) & (e_far + e_near).lt(F8::splat(FAR));
        let (mut near, mut e_near) = (near, e_near);
        if let Some((lanes, negative)) = from.map(Leaving::lanes) {
            let away = negative.select(-b, b);
            known &= !lanes | away.gt(e_b);
            near = lanes.select(F8::splat(BEHIND), near);
            e_near = lanes.select(F8::ZERO, e_near);
        }
        // The slope at the far root has the sign of `q`, also if `B` is zero of either sign.
        let falls = q.lt(F8::ZERO);
        roots.known = known;
        roots.none = disc.lt(-e_disc);
        roots.opens = a.gt(e_a * CLEAR);
        roots.enter = falls.select(far, near);
        roots.e_enter = falls.select(e_far, e_near);
        roots.leave = falls.select(near, far);
        roots.e_leave = falls.select(e_near, e_far);
    }

    /// The crossing of a plane.
    #[inline(never)]
    pub(super) fn crossing(
        &self,
        isa: Isa,
        rays: &Seen<'_>,
        from: Option<&Leaving<'_>>,
        root: &mut PlaneRoot,
    ) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.crossing_here(rays, from, root),
        );
    }

    #[inline(always)]
    pub(super) fn crossing_here(&self, rays: &Seen<'_>, from: Option<&Leaving<'_>>, root: &mut PlaneRoot) {
        let (b, e_b, c) = self.slope(rays);
        let (constant, e_c) = self.height(rays);
        let (c, slope, e_slope) = (c + constant, b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let inverse = F8::ONE / slope;
        let (mut t, mut e) = quotient(-c, e_c, inverse, e_slope);
        let steep = size.gt(e_slope * CLEAR);
        let mut crosses = steep & e.lt(F8::splat(FAR));
        if let Some((lanes, negative)) = from.map(Leaving::lanes) {
            crosses &= !lanes | negative.select(-slope, slope).gt(e_slope);
            t = lanes.select(F8::splat(BEHIND), t);
            e = lanes.select(F8::ZERO, e);
        }
        let reach = ((size + e_slope) * rays.start.far + e_c) * SLACK;
        root.crosses = crosses;
        root.falls = slope.lt(F8::ZERO);
        root.above = !steep & c.gt(reach);
        root.below = !steep & c.lt(-reach);
        root.t = t;
        root.e = e;
    }

    /// The crossings of two parallel planes with opposite normals.
    #[inline(never)]
    pub(super) fn slab(
        &self,
        opposite: &Self,
        isa: Isa,
        rays: &Seen<'_>,
        from: [Option<&Leaving<'_>>; 2],
        roots: &mut SlabRoots,
    ) {
        isa.run_in_lanes(
            #[inline(always)]
            || self.slab_here(opposite, rays, from, roots),
        );
    }

    #[inline(always)]
    pub(super) fn slab_here(
        &self,
        opposite: &Self,
        rays: &Seen<'_>,
        from: [Option<&Leaving<'_>>; 2],
        roots: &mut SlabRoots,
    ) {
        // Along the second plane's normal.
        let (b, e_b, c) = opposite.slope(rays);
        let ((first, e_first), (second, e_second)) = (self.height(rays), opposite.height(rays));
        let (slope, e_slope) = (b * 2.0, e_b * 2.0);
        let size = slope.abs();
        let inverse = F8::ONE / slope;
        let (c0, c1) = (-c + first, c + second);
        let (mut t0, mut e0) = quotient(c0, e_first, inverse, e_slope);
        let (mut t1, mut e1) = quotient(-c1, e_second, inverse, e_slope);
        let steep = size.gt(e_slope * CLEAR);
        let mut known = steep & (e0 + e1).lt(F8::splat(FAR));
        let [from0, from1] = from;
        if let Some((lanes, negative)) = from0.map(Leaving::lanes) {
            known &= !lanes | negative.select(slope, -slope).gt(e_slope);
            t0 = lanes.select(F8::splat(BEHIND), t0);
            e0 = lanes.select(F8::ZERO, e0);
        }
        if let Some((lanes, negative)) = from1.map(Leaving::lanes) {
            known &= !lanes | negative.select(-slope, slope).gt(e_slope);
            t1 = lanes.select(F8::splat(BEHIND), t1);
            e1 = lanes.select(F8::ZERO, e1);
        }
        let reach = ((size + e_slope) * rays.start.far + e_first.max(e_second)) * SLACK;
        let rises = slope.gt(F8::ZERO);
        roots.known = known;
        roots.outside = !steep & (c0.gt(reach) | c1.gt(reach));
        roots.inside = !steep & c0.lt(-reach) & c1.lt(-reach);
        roots.rises = rises;
        roots.enter = rises.select(t0, t1);
        roots.e_enter = rises.select(e0, e1);
        roots.leave = rises.select(t1, t0);
        roots.e_leave = rises.select(e1, e0);
    }

    /// Where this face cuts off points, and where it certainly does not. Returns whether any open
    /// point may still be inside.
    #[inline(never)]
    pub(super) fn cut(&self, isa: Isa, at: &Spot, open: &M8, inside: &mut M8, outside: &mut M8) -> bool {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (f, e_f) = self.at(at.y, at.y1, at.e1);
                *inside &= f.lt(-e_f);
                *outside |= f.gt(e_f);
                (*open & !*outside).any()
            },
        )
    }

    /// The points that are certainly below this face, and those certainly above, as bit masks.
    #[inline(never)]
    pub(super) fn sides(&self, isa: Isa, at: &Spot) -> (u8, u8) {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                let (f, e_f) = self.at(at.y, at.y1, at.e1);
                (f.lt(-e_f).bits(), f.gt(e_f).bits())
            },
        )
    }
}

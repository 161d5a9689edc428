//! A ray's way over the blocks of a grid, front to back.
//!
//! The walk works on the re-centred ray in plain f64. A point of the exact ray that lies in the
//! sheet's box is at some `s` with `|s| <= S`, and `o + s d` is there within
//!
//! ```text
//!     E = o_err + S d_err + 16 u (R + |o| + 2 S)
//! ```
//!
//! per axis, where `R` is the distance of the box's corners from its centre. The last term covers
//! roundings: those of a border's coordinate are below `3.5 u <= 7 u R` (its quotient, its product
//! with the width of a cell, its difference to the centre), a parameter at which it is met adds
//! `4 u` of `R + |o|`, a height `2 u` of `|o| + 2 S`. So every interval is widened by `E`, and no
//! cell that holds a crossing is left out.

use super::heights::Block;
use crate::{CentredRay, Root, Sink};
use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use durer_math::{Aabb, Point3, U, Vec3};

/// The size of the stack: three entries for each level but the last; levels go up to 16, and the
/// first has one entry.
const DEEP: usize = 64;

/// A block on the stack, with the range of `s` in which the ray may be over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<D> {
    pub(super) block: Block,
    pub(super) data: D,
    pub(super) span: (f64, f64),
}

/// The blocks still to visit; the nearest one is on top.
pub(super) type Stack<D> = ArrayVec<Entry<D>, DEEP>;

/// The re-centred ray and its error while it is in the sheet's box.
pub(super) struct Line<'a> {
    ray: CentredRay<'a>,
    bounds: Aabb,
    o: Vec3,
    d: Vec3,
    /// The inverse of the direction; huge where that is zero.
    inverse: Vec3,
    /// `E`.
    error: Vec3,
    /// `E` divided by the direction: the error of a parameter.
    slack: Vec3,
}

impl<'a> Line<'a> {
    #[inline(always)]
    pub(super) fn new(ray: CentredRay<'a>, bounds: &Aabb) -> Self {
        let seen = |p: Point3| p - ray.centre;
        let bounds = Aabb { min: seen(bounds.min).to_point(), max: seen(bounds.max).to_point() };
        let sum = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
        let reach = sum(bounds.max.to_vec()).max(sum(bounds.min.to_vec()));
        let away = sum(ray.o) + sum(ray.o_err);
        // |d| is at least 1, the exact one at least half of that.
        let farthest = if ray.d_err.max_abs() < 0.25 { 2.0 * (reach + away) } else { f64::INFINITY };
        let rounding = 16.0 * U * (reach + away + 2.0 * farthest);
        let error = ray.o_err + ray.d_err * farthest + Vec3::new(rounding, rounding, rounding);
        // NaN is no bound.
        let error = error.map(|e| if e < f64::MAX { e } else { f64::MAX });
        // A parallel ray is at a border nowhere or everywhere: `E` decides which.
        let inverse = ray.d.map(|d| if d == 0.0 { f64::MAX } else { (1.0 / d).clamp(-f64::MAX, f64::MAX) });
        let slack =
            Vec3::new(error.x * inverse.x.abs(), error.y * inverse.y.abs(), error.z * inverse.z.abs());
        Self { ray, bounds, o: ray.o, d: ray.d, inverse, error, slack }
    }

    /// The range of `s` in which the ray may be in the box and in a range of `t`, if there is one.
    #[inline(always)]
    pub(super) fn within(&self, range: (f64, f64)) -> Option<(f64, f64)> {
        let own = self.ray.window((self.ray.local().t_min, self.ray.local().t_max));
        let asked = self.ray.window(range);
        let (mut near, mut far) = (own.0.max(asked.0), own.1.min(asked.1));
        for axis in 0..3 {
            let (a, b) = (self.meet(axis, self.bounds.min[axis]), self.meet(axis, self.bounds.max[axis]));
            near = near.max(a.0.min(b.0));
            far = far.min(a.1.max(b.1));
        }
        (near <= far).then_some((near, far))
    }

    /// The last `s` that matters for a sink.
    #[inline(always)]
    pub(super) fn latest(&self, range: (f64, f64)) -> f64 {
        self.ray.window(range).1
    }

    /// Bounds of the parameters at which the ray may be at a coordinate relative to the centre.
    #[inline(always)]
    fn meet(&self, axis: usize, at: f64) -> (f64, f64) {
        let (s, slack) = ((at - self.o[axis]) * self.inverse[axis], self.slack[axis]);
        // Infinite minus infinite: no bound.
        let bound = |x: f64, none: f64| if x.is_nan() { none } else { x };
        (bound(s - slack, f64::NEG_INFINITY), bound(s + slack, f64::INFINITY))
    }

    /// The ranges of `s` on both sides of the middle of a block along an axis, which is the border of
    /// a cell.
    #[inline(always)]
    fn halves(&self, axis: usize, middle: u32, cells: u32, (near, far): (f64, f64)) -> [(f64, f64); 2] {
        if middle >= cells {
            // All of the block lies in its lower half.
            return [(near, far), (f64::INFINITY, f64::NEG_INFINITY)];
        }
        let border = f64::from(middle) * (1.0 / f64::from(cells)) - self.ray.centre[axis];
        let (first, last) = self.meet(axis, border);
        let (before, behind) = ((near, far.min(last)), (near.max(first), far));
        if self.d[axis] >= 0.0 { [before, behind] } else { [behind, before] }
    }

    /// Calls `f` with each quarter of a block over which the ray may be: its number, itself, and the
    /// range of `s`; the farthest first.
    #[inline(always)]
    pub(super) fn split(
        &self,
        block: Block,
        span: (f64, f64),
        cells: [u32; 2],
        mut f: impl FnMut(usize, Block, (f64, f64)),
    ) {
        let half = block.level - 1;
        let x = self.halves(0, (2 * block.i + 1) << half, cells[0], span);
        let z = self.halves(2, (2 * block.j + 1) << half, cells[1], span);
        let nearest = usize::from(self.d.x < 0.0) | usize::from(self.d.z < 0.0) << 1;
        for k in [3, 2, 1, 0] {
            let k = k ^ nearest;
            let (x, z) = (x[k & 1], z[k >> 1]);
            let (near, far) = (x.0.max(z.0), x.1.min(z.1));
            if near <= far {
                f(k, block.quarter(k), (near, far));
            }
        }
    }

    /// Whether the ray may be between two heights somewhere in a range of `s`.
    #[inline(always)]
    pub(super) fn passes(&self, [low, high]: [f64; 2], (near, far): (f64, f64)) -> bool {
        let at = |s: f64| s.mul_add(self.d.y, self.o.y);
        let (a, b, centre) = (at(near), at(far), self.ray.centre.y);
        // NaN may be anywhere.
        !(a.min(b) - self.error.y > high - centre || a.max(b) + self.error.y < low - centre)
    }

    /// The place of the ray where its coordinate along an axis is `at`; `None` if it has no bounds.
    #[inline(always)]
    pub(super) fn place(&self, axis: usize, at: f64) -> Option<Place> {
        // The place need not be in the box, so it has an `S` of its own.
        let at = at - self.ray.centre[axis];
        let d = self.d[axis];
        if !(self.ray.d_err[axis] <= 0.25 * d.abs() && d != 0.0) {
            return None;
        }
        let s = (at - self.o[axis]) / d;
        let reach = 2.0 * (s.abs() + 1.0);
        let slack = self.error_within(axis, reach) / d.abs();
        let place = Place { s: (s - slack, s + slack), reach };
        (place.s.0 <= place.s.1).then_some(place)
    }

    /// `E` along an axis, for points at `|s| <= reach` that need not be in the box.
    #[inline(always)]
    fn error_within(&self, axis: usize, reach: f64) -> f64 {
        let rounding = 16.0 * U * (1.0 + self.o[axis].abs() + 2.0 * reach);
        self.ray.d_err[axis].mul_add(reach, self.ray.o_err[axis]) + rounding
    }

    /// Whether a place may be in a range of `t`.
    #[inline(always)]
    pub(super) fn may_reach(&self, place: &Place, range: (f64, f64)) -> bool {
        let local = self.ray.local();
        let (own, asked) = (self.ray.window((local.t_min, local.t_max)), self.ray.window(range));
        place.s.1 >= own.0.max(asked.0) && place.s.0 <= own.1.min(asked.1)
    }

    /// Bounds of the coordinate of a place along `axis`, relative to the centre.
    #[inline(always)]
    fn coordinate(&self, place: &Place, axis: usize) -> (f64, f64) {
        let (a, b) =
            (place.s.0.mul_add(self.d[axis], self.o[axis]), place.s.1.mul_add(self.d[axis], self.o[axis]));
        let error = self.error_within(axis, place.reach);
        (a.min(b) - error, a.max(b) + error)
    }

    /// Bounds of the coordinate of a place along x or z, in the sheet's frame, where the centre is
    /// between 0 and 1.
    #[inline(always)]
    pub(super) fn across(&self, place: &Place, axis: usize) -> (f64, f64) {
        let ((low, high), centre) = (self.coordinate(place, axis), self.ray.centre[axis]);
        (low + centre, high + centre)
    }

    /// Whether a place is certainly above a height. The height relative to the centre has a
    /// relative rounding of `u`, less than `E` where the place is about as high.
    #[inline(always)]
    pub(super) fn is_above(&self, place: &Place, height: f64) -> bool {
        self.coordinate(place, 1).0 > height - self.ray.centre.y
    }
}

/// A place on the ray, within bounds of its parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    s: (f64, f64),
    /// A bound on the magnitude of its parameters.
    reach: f64,
}

/// Crossings that are kept until no earlier one can be found any more.
pub(super) struct Queue {
    few: ArrayVec<Found, 8>,
    many: Vec<Found>,
    /// The least `until`.
    first: f64,
    /// The last parameter that was passed on, and the sign there; 0 if there was none.
    last: f64,
    sign: i8,
}

/// A crossing in the queue.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) root: Root,
    /// Crossings found at an `s` beyond this come later.
    until: f64,
}

impl Queue {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            few: ArrayVec::new(),
            many: Vec::new(),
            first: f64::INFINITY,
            last: f64::NEG_INFINITY,
            sign: 0,
        }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, root: Root, line: &Line<'_>) {
        let found = Found { root, until: line.latest((root.lo, root.hi)) };
        self.first = self.first.min(found.until);
        if self.many.is_empty() {
            match self.few.try_push(found) {
                Ok(()) => return,
                Err(_) => self.many.extend(self.few.drain(..)),
            }
        }
        self.many.push(found);
    }

    /// Whether a crossing may come before all others from `next` on.
    #[inline(always)]
    pub(super) fn may_pour(&self, next: f64) -> bool {
        self.first < next
    }

    /// Passes on the crossings that come before all others from `next` on, ascending; `order`
    /// arranges them so that signs alternate after a given one.
    #[inline(always)]
    pub(super) fn pour<S: Sink + ?Sized>(
        &mut self,
        next: f64,
        sink: &mut S,
        order: impl FnOnce(&mut [Found], i8),
    ) -> ControlFlow<()> {
        let waiting = if self.many.is_empty() { self.few.as_mut_slice() } else { &mut self.many };
        if waiting.is_empty() {
            return ControlFlow::Continue(());
        }
        order(waiting, self.sign);
        // As many of those that alternate as come before `next`.
        let ready = waiting.iter().take_while(|found| found.until < next || next == f64::INFINITY).count();
        // A crossing is not beyond the upper end of any later one, and not before an earlier one.
        // Both hold for the exact parameters, so each `t` stays in its bracket.
        let mut least = f64::INFINITY;
        for found in waiting.iter_mut().rev() {
            least = least.min(found.root.hi);
            found.root.t = found.root.t.min(least);
        }
        for found in &mut waiting[..ready] {
            self.last = self.last.max(found.root.t);
            found.root.t = self.last;
            self.sign = found.root.sign;
            sink.push(found.root)?;
        }
        if self.many.is_empty() && ready == self.few.len() {
            self.few.clear();
        } else if self.many.is_empty() {
            self.few.drain(..ready);
        } else {
            self.many.drain(..ready);
        }
        let left = if self.many.is_empty() { self.few.as_slice() } else { &self.many };
        self.first = left.iter().fold(f64::INFINITY, |first, found| first.min(found.until));
        ControlFlow::Continue(())
    }
}

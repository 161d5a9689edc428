//! Eight lines marching through the cells of a formula while it certainly keeps its sign.
//!
//! A line passes a cell where the formula has the line's sign, where it is undefined and the line
//! is outside, or where the bounds of the gradient prove that it moves away from zero. The line
//! stops before the first other cell. All eight lines step together, each through its own cells;
//! the lookup of a cell is done line by line, everything else in lanes.

use super::octree::{Cells, slope_along};
use super::octree_lookup::Found;
use crate::packet::{Line8, Segment8};
use durer_math::lanes::LANES;
use durer_math::{F8, M8, Vec3};

/// A line that rounding moves out of this many cells as soon as it enters them runs along their
/// faces. It continues as a single ray.
const GRAZED: f64 = 8.0;

/// Where the lines stopped.
pub(super) struct Stop {
    /// The formula keeps its sign up to here.
    pub(super) a: F8,
    /// The end of the cell.
    pub(super) b: F8,
    /// The lines that stopped before a leaf, the number of the leaf's tape, and bounds of the slope
    /// along the line in it.
    pub(super) leaf: M8,
    pub(super) tape: [u32; LANES],
    pub(super) low: F8,
    pub(super) high: F8,
}

impl Stop {
    /// Advances the lines in `told.lanes` from the starts of their segments.
    #[inline(never)]
    pub(super) fn of(cells: &Cells, line: &Line8, told: &Segment8) -> Self {
        let (a, b, zero) = (told.a, told.b, F8::ZERO);
        let mut stop = Self { a, b, leaf: M8::NONE, tape: [0; LANES], low: zero, high: zero };
        line.isa.run_in_lanes(
            #[inline(always)]
            || go_on(cells, line, told, &mut stop),
        );
        stop
    }
}

#[inline(always)]
fn go_on(cells: &Cells, line: &Line8, told: &Segment8, stop: &mut Stop) {
    let Line8 { o, d, e_d, .. } = line;
    let over = Vec3::new(F8::ONE / d.x, F8::ONE / d.y, F8::ONE / d.z);
    let positive = told.sign.gt(F8::ZERO);
    let beyond = cells.margin() * (1.0 / 16.0);
    let (mut s, mut open, mut grazed) = (told.a, told.lanes, F8::ZERO);
    while open.any() {
        let at = s + beyond;
        let p = Vec3::new(at * d.x + o.x, at * d.y + o.y, at * d.z + o.z);
        let found = cells.grid().find(&p);
        let end = cells.grid().ends(&found, o, &over);
        let next = end.gt(s).select(end, s + beyond);
        let mut passed = positive & found.outside() | !positive & found.within();
        let leaf = open & found.leaf();
        if leaf.any() {
            let (low, high) = slopes(cells, &found, leaf, (d, e_d), &mut stop.tape);
            let away = positive & low.gt(F8::ZERO) | !positive & high.lt(F8::ZERO);
            passed |= leaf & away;
            let here = leaf & !away;
            stop.leaf |= here;
            stop.low.set_where(here, low);
            stop.high.set_where(here, high);
            stop.b.set_where(here, next);
        }
        let stopped = open & !passed;
        stop.a.set_where(stopped, s);
        stop.b.set_where(stopped & !leaf, end.max(s));
        let through = open & passed & next.ge(told.last);
        stop.a.set_where(through, told.last);
        stop.b.set_where(through, told.last);
        open = open & passed & !through;
        // Cells grazed at a corner: by rounding the line leaves them at once.
        grazed += (open & end.le(s)).keep(F8::ONE);
        let along = open & grazed.gt(F8::splat(GRAZED));
        stop.a.set_where(along, s);
        stop.b.set_where(along, s);
        open &= !along;
        s.set_where(open, next);
    }
}

/// Bounds of the slopes of lines in their leaves, and the numbers of these leaves' tapes.
#[inline(always)]
fn slopes(
    cells: &Cells,
    found: &Found,
    leaf: M8,
    (d, e): (&Vec3<F8>, &F8),
    tape: &mut [u32; LANES],
) -> (F8, F8) {
    let (mut least, mut most) = ([F8::ZERO; 3], [F8::ZERO; 3]);
    for i in leaf.lanes() {
        let (number, lo, hi) = cells.leaf(found.leaf_of(i));
        tape[i] = number;
        for axis in 0..3 {
            (least[axis].0[i], most[axis].0[i]) = (f64::from(lo[axis]), f64::from(hi[axis]));
        }
    }
    slope_along(least, most, [d.x, d.y, d.z], [*e; 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implicit::subdivide::tests::{cubic, exactly};
    use crate::laws::TestRng;
    use durer_math::{Aabb, Dyadic, Isa, Point3, U};

    /// Two points of the container beside a tangent of the surface, if the generator finds one.
    fn beside_a_tangent(dice: &mut TestRng, c: f64) -> Option<(Vec3, Vec3)> {
        let Vec3 { x, y, .. } = dice.vector() * 0.75;
        let p = Vec3::new(x, y, (2.0 * x - x * x * x - c) / y);
        let gradient = Vec3::new(3.0 * x * x - 2.0, p.z, y);
        let d = gradient.cross(dice.vector());
        let (p, d) = (p + gradient * dice.between(-1e-2, 1e-2), d * (0.25 / d.length()));
        let (from, to) = (p - d, p + d);
        (from.max_abs() <= 1.0 && to.max_abs() <= 1.0).then_some((from, to))
    }

    /// From one point of the container to another: beside a tangent, anywhere, along an axis, or
    /// from a corner of cells.
    fn line_into(dice: &mut TestRng, c: f64, line: &mut Line8, i: usize) -> f64 {
        let (mut p, mut q) = (dice.vector(), dice.vector());
        if dice.once_in(4) {
            p = (p * 32.0).map(f64::round) * (1.0 / 32.0);
        }
        if dice.once_in(4) {
            (q.x, q.y) = (p.x, p.y);
        }
        if dice.once_in(2) {
            (p, q) = beside_a_tangent(dice, c).unwrap_or((p, q));
        }
        let length = (q - p).length().max(1.0 / 1024.0);
        line.o.set_lane(i, p);
        line.d.set_lane(i, (q - p) * (1.0 / length));
        length
    }

    /// The formula keeps its sign as far as a line moves, and the slope in the leaf before which it
    /// stops is within the bounds.
    #[test]
    fn lines_go_on_while_they_keep_the_sign() {
        let (mut gone, mut through, mut leaves) = (0, 0, 0);
        for (seed, isa) in (0..60).flat_map(|seed| Isa::available().map(move |isa| (seed, isa))) {
            let mut dice = TestRng::new(seed);
            let c = [0.0, dice.unit() - 0.5][dice.below(2) as usize];
            let cube = Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) };
            let cells = Cells::new(&cubic(c), cube);
            for _ in 0..40 {
                let (zero, none) = (Vec3::splat(Vec3::ZERO), M8::NONE);
                let (small, never) = (F8::splat(4.0 * U), F8::splat(f64::INFINITY));
                let mut line = Line8 { isa, o: zero, d: zero, e_o: small, e_d: small };
                let (mut last, mut sign, mut lanes) = (F8::ZERO, F8::ZERO, none);
                for i in 0..LANES {
                    last.0[i] = line_into(&mut dice, c, &mut line, i);
                    let start = exactly(c, &line, i, 0.0).exact_sign();
                    sign.0[i] = if start.is_gt() { 1.0 } else { -1.0 };
                    lanes.set_lane(i, start.is_ne() && !dice.once_in(8));
                }
                let (a, b, hint, next) = (F8::ZERO, last, never, never);
                let (out, within, rises, falls, seen) = (none, none, none, none, none);
                let told = Segment8 { lanes, seen, a, b, last, out, within, rises, falls, sign, hint, next };
                let stop = Stop::of(&cells, &line, &told);
                for i in lanes.lanes() {
                    let (to, end) = (stop.a.0[i], stop.b.0[i]);
                    assert!((0.0..=last.0[i]).contains(&to) && to <= end, "{seed} {i}: {to} {end}");
                    for k in 0..=8 {
                        let s = to * f64::from(k) / 8.0;
                        let now = exactly(c, &line, i, s).exact_sign();
                        assert!(if sign.0[i] > 0.0 { now.is_gt() } else { now.is_lt() }, "{seed} {i}: {s}");
                    }
                    gone += usize::from(to > 0.0);
                    through += usize::from(to >= last.0[i]);
                    if !stop.leaf.lane(i) {
                        continue;
                    }
                    leaves += 1;
                    let end = end.min(last.0[i]);
                    for k in 0..4 {
                        let at = |k: i32| to + (end - to) * f64::from(k) / 4.0;
                        let (s, t) = (at(k), at(k + 1));
                        let change = &exactly(c, &line, i, t) - &exactly(c, &line, i, s);
                        let way = &Dyadic::from(t) - &Dyadic::from(s);
                        let times = |slope: f64| &Dyadic::from(slope) * &way;
                        let is_within = times(stop.low.0[i]) <= change && change <= times(stop.high.0[i]);
                        assert!(is_within, "{seed} {i}: {s} {t}");
                    }
                }
            }
        }
        let paths = Isa::available().count();
        assert!(
            gone > 4000 * paths && through > 1000 * paths && leaves > 4000 * paths,
            "{gone} {through} {leaves}"
        );
    }
}

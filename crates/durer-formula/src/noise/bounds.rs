//! Bounds on noise and its derivatives on boxes.
//!
//! **In a cell.** `|n| <= 33/64 + 3/2`, since `(1 - f) t + f (1 - t) <= 1/2`. A derivative is a
//! blend, along the other two axes, of its values on the four edges along its own axis:
//!
//! ```text
//!   f'(x) (b - a) + (1 - f(x)) a_x + f(x) b_x,
//!   a and b: v + g . (x - i, y - j, z - k) of the edge's two corners
//! ```
//!
//! `b - a` is linear, so its slopes bound its distance from its value in the box's middle; `f` and
//! `f'` have their extremes at the box's ends, or `f'` in the cell's middle; a blend of intervals
//! is increasing in both and linear in `f`, so it has its extremes at the ends. The bound on the
//! value follows from the value in the middle by the mean value theorem. For a box in several cells
//! the bounds are the union of those of its parts, up to two along each axis; for larger boxes the
//! range is all that is known.
//!
//! **Small boxes**, with the middle `m` and the half sides `r`, need only one evaluation of the
//! corners:
//!
//! ```text
//!   |n(p) - n(m)| <= sum |n_i(m)| r_i + 1/2 sum H_ij r_i r_j,   |n_i(p) - n_i(m)| <= sum H_ij r_j
//! ```
//!
//! where `H` bounds the second derivatives, which jump between cells but are bounded in all of
//! them: so this holds over any number of cells. [`SLOPE`], [`BEND`] and [`TWIST`] bound the first
//! derivatives, and the second ones along one axis and along two, for all corners: as sums of
//! absolute values, whose extremes the tests find by interval arithmetic.
//!
//! **Rounding** is that of values and slopes; the bounds on an edge err by `115 u`, and each of the
//! two blends adds `75 u`: in all less than [`SLOPE_ROUNDINGS`]. A box's middle is rounded by half
//! of `u` along each axis, which moves a value by less than `8 u`.
//!
//! In a cell all is computed in f32, whose roundings are less than 2^-16 of the range of a
//! derivative: a box's ends are rounded outward first, and bounds on the larger box hold on it.
//! Boxes so small that such a rounding is significant beside the variation of the value are also
//! treated as small ones.

use super::{Along, Lattice, SLOPE_ROUNDINGS, Sum, VALUE_ROUNDINGS, are_one_cell, hashes};
use crate::I8;
use durer_math::real::{Eight, Real, less, more, roundings};
use durer_math::{F8, Isa, M8};

/// Errors count twice in bounds, so that these also hold for rounded values; the rest is for the
/// bounds' own rounding.
const VALUE_MARGIN: f32 = 2.0 * VALUE_ROUNDINGS + 16.0;
const SLOPE_MARGIN: f32 = 2.0 * SLOPE_ROUNDINGS + 16.0;
/// Covers the roundings of sums of non-negative numbers: at most twelve in succession.
const UP: f32 = 16.0;
/// The largest value of a lattice point.
pub(super) const CORNER: f64 = 33.0 / 64.0;
/// Bound on the values.
const RANGE: f64 = CORNER + 1.5;
/// Bound on the first derivatives.
pub(super) const SLOPE: f64 = 5.06;
/// Bound on the second derivatives along one axis.
pub(super) const BEND: f64 = 24.3;
/// Bound on the second derivatives along two axes.
pub(super) const TWIST: f64 = 12.45;

/// Bounds on noise and its derivatives on eight boxes.
#[inline(always)]
pub(super) fn bounds_in_cell<L: Lattice>(lattice: L, p: [&I8; 3]) -> (I8, [I8; 3]) {
    /// The bounds for small boxes suffice if all sides are as short as this.
    const SMALL: f64 = 1.0 / 128.0;
    /// Half of this times a derivative of 1 is nearly six times [`VALUE_MARGIN`], in f32.
    const FINE: f64 = 1.0 / 8192.0;
    let mut side = F8::ZERO;
    for axis in p {
        side = side.max(axis.hi - axis.lo);
    }
    let mut out = nothing(lattice.size(), p);
    let mut around_middle = side.le(F8::splat(SMALL));
    if !around_middle.all() {
        cellwise(lattice, p, &mut out);
        around_middle = side.le(F8::splat(FINE));
    }
    if around_middle.any() {
        around(lattice, p, around_middle, &mut out);
    }
    out
}

/// Narrows the bounds of some lanes by those for small boxes, which hold over any number of cells.
#[inline(always)]
fn around<L: Lattice>(lattice: L, p: [&I8; 3], lanes: M8, out: &mut (I8, [I8; 3])) {
    let (mut m, mut r) = ([F8::ZERO; 3], [F8::ZERO; 3]);
    for axis in 0..3 {
        for i in 0..8 {
            let (lo, hi) = (p[axis].lo.0[i], p[axis].hi.0[i]);
            let middle = 0.5 * lo + 0.5 * hi;
            let (before, after) = (middle - lo, hi - middle);
            m[axis].0[i] = middle;
            r[axis].0[i] = if before > after { before } else { after };
        }
    }
    let near = Sum::at(lattice, [&m[0], &m[1], &m[2]]);
    let size = lattice.size();
    let (slope_error, up) = (roundings::<f64>(SLOPE_ROUNDINGS) * size, more::<f64>(UP));
    let (bend, twist) = (BEND * size, TWIST * size);
    let (value_margin, slope_margin) =
        (roundings::<f64>(VALUE_MARGIN) * size, roundings::<f64>(SLOPE_MARGIN) * size);
    let others = lanes.select(F8::ZERO, F8::splat(f64::INFINITY));
    for i in 0..8 {
        let [a, b, c] = [r[0].0[i], r[1].0[i], r[2].0[i]];
        let [da, db, dc] = [near.d[0].0[i].abs(), near.d[1].0[i].abs(), near.d[2].0[i].abs()];
        let all = a + b + c;
        let along = da * a + db * b + dc * c + slope_error * all;
        let bent = (a * a + b * b + c * c) * ((bend - twist) * 0.5) + all * all * (twist * 0.5);
        let reach = (along + bent + value_margin) * up + others.0[i];
        narrow(&mut out.0, i, near.v.0[i] - reach, near.v.0[i] + reach);
        for (axis, r) in r.iter().enumerate() {
            let bent = r.0[i] * (bend - twist) + all * twist;
            let reach = (bent + slope_margin) * up + others.0[i];
            let slope = near.d[axis].0[i];
            narrow(&mut out.1[axis], i, slope - reach, slope + reach);
        }
    }
}

/// Bounds that hold everywhere.
#[inline(always)]
fn nothing(size: f64, p: [&I8; 3]) -> (I8, [I8; 3]) {
    let v = I8::new(F8::splat(-RANGE * size), F8::splat(RANGE * size)).said(p[0], p[1]).said(p[2], p[2]);
    let d = I8::new(F8::splat(-SLOPE * size), F8::splat(SLOPE * size)).said(&v, &v);
    (v, [d; 3])
}

/// Takes new bounds of a lane where they are narrower; a NaN is not.
#[inline(always)]
fn narrow(x: &mut I8, i: usize, lo: f64, hi: f64) {
    x.lo.0[i] = if lo > x.lo.0[i] { lo } else { x.lo.0[i] };
    x.hi.0[i] = if hi < x.hi.0[i] { hi } else { x.hi.0[i] };
}

/// The part of a box along an axis that is in one cell.
#[derive(Clone, Copy)]
struct Part {
    /// The number of the cell's lower corner.
    corner: [u32; 8],
    /// The part's interval in the cell.
    lo: F8,
    hi: F8,
}

/// A box along an axis: the part in its first cell, the lanes with a part in the next cell, and the
/// lanes with a part in a third.
struct Parts {
    first: Part,
    /// Where the part in the second cell ends.
    rest: F8,
    two: M8,
    more: M8,
}

impl Parts {
    #[inline(always)]
    fn new<L: Lattice>(lattice: L, x: &I8, axis: usize) -> Self {
        let mut first = Part { corner: [0; 8], lo: F8::ZERO, hi: F8::ZERO };
        let mut rest = F8::ZERO;
        for i in 0..8 {
            let whole = x.lo.0[i].floor();
            first.corner[i] = lattice.cell(whole, axis);
            first.lo.0[i] = x.lo.0[i] - whole;
            let hi = x.hi.0[i] - whole;
            first.hi.0[i] = if hi < 1.0 { hi } else { 1.0 };
            rest.0[i] = hi - 1.0;
        }
        // A negated comparison, so that infinite ends count as more.
        Self { first, rest, two: rest.gt(F8::ZERO), more: !rest.le(F8::ONE) }
    }

    /// The part of a lane in its first or second cell.
    #[inline(always)]
    fn part(&self, i: usize, second: bool, step: u32) -> (u32, f64, f64) {
        let corner = self.first.corner[i];
        if second {
            (corner.wrapping_add(step), 0.0, self.rest.0[i])
        } else {
            (corner, self.first.lo.0[i], self.first.hi.0[i])
        }
    }
}

/// Narrows bounds by those on the parts in single cells, except for boxes of more than two cells
/// along an axis.
#[inline(always)]
fn cellwise<L: Lattice>(lattice: L, p: [&I8; 3], out: &mut (I8, [I8; 3])) {
    let parts = [Parts::new(lattice, p[0], 0), Parts::new(lattice, p[1], 1), Parts::new(lattice, p[2], 2)];
    let more = parts[0].more | parts[1].more | parts[2].more;
    if more.all() {
        return;
    }
    let two = [parts[0].two & !more, parts[1].two & !more, parts[2].two & !more];
    let mut held = whole(lattice, &[parts[0].first, parts[1].first, parts[2].first]);
    if (two[0] | two[1] | two[2]).any() {
        beside(lattice, &parts, &two, &mut held);
    }
    let (v, d) = held;
    for i in (!more).lanes() {
        narrow(&mut out.0, i, v.lo.0[i].into(), v.hi.0[i].into());
        for (out, d) in out.1.iter_mut().zip(&d) {
            narrow(out, i, d.lo.0[i].into(), d.hi.0[i].into());
        }
    }
}

/// Widens bounds by those on the parts in other cells than the first, eight parts at a time.
#[inline(always)]
fn beside<L: Lattice>(lattice: L, parts: &[Parts; 3], two: &[M8; 3], held: &mut (Ends, [Ends; 3])) {
    let [x, y, z] = [two[0].bits(), two[1].bits(), two[2].bits()];
    let mut eight = [parts[0].first, parts[1].first, parts[2].first];
    let (mut of, mut count) = ([0; 8], 0);
    for which in 1..8_u8 {
        let needs = |axis: u8, lanes: u8| if which >> axis & 1 == 1 { lanes } else { 0xff };
        for i in durer_math::lanes::set_bits(needs(0, x) & needs(1, y) & needs(2, z)) {
            for axis in 0..3 {
                let (corner, lo, hi) = parts[axis].part(i, which >> axis & 1 == 1, L::STEP[axis]);
                let part = &mut eight[axis];
                (part.corner[count], part.lo.0[count], part.hi.0[count]) = (corner, lo, hi);
            }
            of[count] = i;
            count += 1;
            if count == 8 {
                widen(held, &of, &whole(lattice, &eight));
                count = 0;
            }
        }
    }
    if count > 0 {
        widen(held, &of[..count], &whole(lattice, &eight));
    }
}

/// Widens the bounds of the lanes `of` to contain the bounds `by`.
#[inline(always)]
fn widen(held: &mut (Ends, [Ends; 3]), of: &[usize], by: &(Ends, [Ends; 3])) {
    held.0.widen(of, &by.0);
    for axis in 0..3 {
        held.1[axis].widen(of, &by.1[axis]);
    }
}

/// Eight intervals in f32.
#[derive(Clone, Copy)]
struct Ends {
    lo: Eight<f32>,
    hi: Eight<f32>,
}

impl Ends {
    /// Widens the lanes `of` to contain the intervals `by`.
    #[inline(always)]
    fn widen(&mut self, of: &[usize], by: &Self) {
        for (k, &i) in of.iter().enumerate() {
            self.lo.0[i] = Real::min(self.lo.0[i], by.lo.0[k]);
            self.hi.0[i] = Real::max(self.hi.0[i], by.hi.0[k]);
        }
    }

    /// Bounds on `(1 - f) a + f b`, which is increasing in both and linear in `f`.
    #[inline(always)]
    fn blended(f: &Self, a: &Self, b: &Self) -> Self {
        let (lo, hi) = (b.lo - a.lo, b.hi - a.hi);
        Self {
            lo: f.lo.mul_add(lo, a.lo).min(f.hi.mul_add(lo, a.lo)),
            hi: f.lo.mul_add(hi, a.hi).max(f.hi.mul_add(hi, a.hi)),
        }
    }
}

/// A part of a cell along an axis, with bounds on the blend function and its derivative.
struct Within {
    /// Half of the part's length.
    half: Eight<f32>,
    f: Ends,
    slope: Ends,
}

impl Within {
    #[inline(always)]
    fn new(part: &Part, step: u32) -> (Along<f32>, Self) {
        let (mut lo, mut hi) = (Eight::ZERO, Eight::ZERO);
        for i in 0..8 {
            // Rounded outward to f32, but within the cell.
            let down = (part.lo.0[i] as f32) * less::<f32>(4.0) - f32::TINY;
            let up = (part.hi.0[i] as f32) * more::<f32>(4.0) + f32::TINY;
            lo.0[i] = Real::max(down, 0.0);
            hi.0[i] = Real::min(up, 1.0);
        }
        let middle = lo * 0.5 + hi * 0.5;
        let half = hi * 0.5 - lo * 0.5;
        let (a, b) = (Along::new(part.corner, &lo, step), Along::new(part.corner, &hi, step));
        let mut slope = Ends { lo: a.slope.min(b.slope), hi: a.slope.max(b.slope) };
        for i in 0..8 {
            let steepest = (lo.0[i] < 0.5) & (hi.0[i] > 0.5);
            slope.hi.0[i] = if steepest { 1.5 } else { slope.hi.0[i] };
        }
        (Along::new(part.corner, &middle, step), Self { half, f: Ends { lo: a.f, hi: b.f }, slope })
    }
}

/// Bounds on eight boxes, each of which is in one cell: on the derivatives by the blends' extremes,
/// on the value by its value in the middle and the derivatives.
#[inline(never)]
fn whole<L: Lattice>(lattice: L, parts: &[Part; 3]) -> (Ends, [Ends; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let (x, u) = Within::new(&parts[0], L::STEP[0]);
            let (y, v) = Within::new(&parts[1], L::STEP[1]);
            let (z, w) = Within::new(&parts[2], L::STEP[2]);
            let (along, within) = ([x, y, z], [u, v, w]);
            // Rounded up.
            let size = lattice.size() as f32 * more::<f32>(2.0);
            if are_one_cell(&along) {
                let corners = Sum::corners_of_one(lattice, &along, &hashes(lattice, &along));
                within_corners(size, &along, &within, &corners)
            } else {
                let corners = Sum::corners(lattice, &along, &hashes(lattice, &along));
                within_corners(size, &along, &within, &corners)
            }
        },
    )
}

#[inline(always)]
fn within_corners(
    size: f32,
    along: &[Along<f32>; 3],
    within: &[Within; 3],
    corners: &[Sum<f32>; 8],
) -> (Ends, [Ends; 3]) {
    let d = [
        slope(size, within, corners, [0, 1, 2]),
        slope(size, within, corners, [1, 0, 2]),
        slope(size, within, corners, [2, 0, 1]),
    ];
    let mut reach = Eight::splat(roundings::<f32>(VALUE_MARGIN) * size);
    for (d, within) in d.iter().zip(within) {
        reach = d.hi.max(-d.lo).mul_add(within.half, reach);
    }
    let (v, reach) = (Sum::of(along, corners).v, reach * more::<f32>(UP));
    (Ends { lo: v - reach, hi: v + reach }, d)
}

/// Bounds on the derivative along the first of three axes.
#[inline(always)]
fn slope(
    size: f32,
    within: &[Within; 3],
    corners: &[Sum<f32>; 8],
    [axis, second, third]: [usize; 3],
) -> Ends {
    let (upper, b, c) = (1 << axis, 1 << second, 1 << third);
    let near = Ends::blended(
        &within[second].f,
        &pair(within, axis, &corners[0], &corners[upper]),
        &pair(within, axis, &corners[b], &corners[b | upper]),
    );
    let far = Ends::blended(
        &within[second].f,
        &pair(within, axis, &corners[c], &corners[c | upper]),
        &pair(within, axis, &corners[b | c], &corners[b | c | upper]),
    );
    let Ends { lo, hi } = Ends::blended(&within[third].f, &near, &far);
    let margin = roundings::<f32>(SLOPE_MARGIN) * size;
    Ends { lo: lo - margin, hi: hi + margin }
}

/// Bounds for an edge with two corners: `f' (b - a)`, and the blended slopes.
#[inline(always)]
fn pair(within: &[Within; 3], axis: usize, a: &Sum<f32>, b: &Sum<f32>) -> Ends {
    // The difference is linear along all axes.
    let mut reach = Eight::ZERO;
    for (k, within) in within.iter().enumerate() {
        reach = (b.d[k] - a.d[k]).abs().mul_add(within.half, reach);
    }
    let middle = b.v - a.v;
    let (lo, hi) = (middle - reach, middle + reach);
    let Within { f, slope, .. } = &within[axis];
    let change = b.d[axis] - a.d[axis];
    let (from, to) = (f.lo.mul_add(change, a.d[axis]), f.hi.mul_add(change, a.d[axis]));
    Ends {
        lo: (slope.lo * lo).min(slope.hi * lo) + from.min(to),
        hi: (slope.lo * hi).max(slope.hi * hi) + from.max(to),
    }
}

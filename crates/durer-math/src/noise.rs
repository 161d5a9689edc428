//! Noise on the unit lattice: K. Perlin, "An image synthesizer", SIGGRAPH 1985.
//!
//! ```text
//!   n(x, y, z) = sum of w(x - i) w(y - j) w(z - k) (v + g . (x - i, y - j, z - k))   over the corners (i, j, k) of the lattice's cell
//!   w(t) = 1 - f(|t|),  f(t) = 3 t^2 - 2 t^3
//! ```
//!
//! Each point of the lattice has a value `v` and a slope `g` of its own, which a hash of its three whole numbers says, each taken modulo 2^32: `v` is one of the 256 multiples of 1/256 from -132/256 on, the three
//! parts of `g` are odd multiples of 1/256 between -1 and 1. So noise is a polynomial in each cell, with numbers that f64 holds exactly, and its derivatives are continuous everywhere: what is bounded here is that
//! function of real numbers.
//!
//! **Bounds in a cell.** `|n| <= 33/64 + 3/2`, since `(1 - f) t + f (1 - t) <= 1/2`. A derivative is a blend, along the other two axes, of what it is on the four edges along its own:
//!
//! ```text
//!   f'(x) (b - a) + (1 - f(x)) a_x + f(x) b_x,     a and b: v + g . (x - i, y - j, z - k) of the edge's two corners
//! ```
//!
//! `b - a` is linear, so it is as far from its value in the box's middle as its slopes say; `f` and `f'` have their extremes at the box's ends, or `f'` in the cell's middle; a blend of intervals rises with both and is
//! linear in `f`, so it has its extremes at the ends. The value follows from the one in the middle by the mean value theorem. Of a box in several cells this is asked of the parts, up to two along each axis; of
//! larger ones the range is all that is known.
//!
//! **Bounds of small boxes**, with the middle `m` and the half sides `r`, need only one look at the corners:
//!
//! ```text
//!   |n(p) - n(m)| <= sum |n_i(m)| r_i + 1/2 sum H_ij r_i r_j,   |n_i(p) - n_i(m)| <= sum H_ij r_j
//! ```
//!
//! where `H` bounds the second derivatives, which jump between cells but are bounded in all of them: so this holds over any number of cells. [`SLOPE`], [`BEND`] and [`TWIST`] bound the first derivatives, and the second
//! ones along one axis and along two, whatever the corners have: as sums of absolute values, whose extremes the tests find by interval arithmetic.
//!
//! **Rounding.** With `u = 2^-53`: a coordinate in its cell is exact, but for one between -1 and 0, where it errs by `u/2`; all roundings of `f` are `2 u`, of `f'` `4 u`,
//! of a corner's sum `7 u`. A step of the interpolation, of which there are three, adds `21 u` to a value (`2 u` times a difference of at most 7.04, its rounding of `4 u` and the sum's of `2 u`), and to a derivative at most `75 u`, or
//! `180 u` along its own axis. What is said of an edge errs by `115 u`, and each of the two blends adds `75 u`. With what the coordinates' errors make of it these are below [`VALUE_ERROR`] and [`SLOPE_ERROR`].

use crate::{F8, I8, Isa, M8};

/// Bound on the rounding errors of a value.
const VALUE_ERROR: f64 = 80.0 * crate::U;
/// The same of a derivative.
const SLOPE_ERROR: f64 = 320.0 * crate::U;
/// Both count twice in bounds, so that these hold rounded values too; the rest is for the bounds' own rounding.
const VALUE_MARGIN: f64 = 2.0 * VALUE_ERROR + 16.0 * crate::U;
const SLOPE_MARGIN: f64 = 2.0 * SLOPE_ERROR + 16.0 * crate::U;
/// Pays for the roundings of sums of numbers that are not negative: twelve at most one after the other.
const UP: f64 = 1.0 + 16.0 * crate::U;
/// The largest value of a corner.
const CORNER: f64 = 33.0 / 64.0;
/// Bound on the values.
const RANGE: f64 = CORNER + 1.5;
/// Bound on the first derivatives.
const SLOPE: f64 = 5.06;
/// Bound on the second ones along one axis.
const BEND: f64 = 24.3;
/// Bound on the second ones along two.
const TWIST: f64 = 12.45;

/// Primes that take the three whole numbers apart: those of Y. Collet's xxHash.
const APART: [u32; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];

/// A coordinate: its cell, and where in it.
struct Along {
    /// What the two corners of the cell add to the hash.
    corner: [[u32; 8]; 2],
    /// How far from these.
    from: [F8; 2],
    /// The blend and its derivative.
    f: F8,
    slope: F8,
}

impl Along {
    /// Of numbers from 0 to 1 in cells whose lower corners add this.
    #[inline(always)]
    fn new(corner: [u32; 8], t: &F8, apart: u32) -> Self {
        let mut out = Self { corner: [corner; 2], from: [*t, *t - 1.0], f: F8::ZERO, slope: F8::ZERO };
        for (i, &corner) in corner.iter().enumerate() {
            out.corner[1][i] = corner.wrapping_add(apart);
            // Around the cell's middle: 1/2 + s (3/2 - 2 s^2), and 6 (1/4 - s^2).
            let s = t.0[i] - 0.5;
            out.f.0[i] = (s * s).mul_add(-2.0, 1.5).mul_add(s, 0.5);
            out.slope.0[i] = 6.0 * (-s).mul_add(s, 0.25);
        }
        out
    }

    /// Of any numbers.
    #[inline(always)]
    fn of(x: &F8, apart: u32) -> Self {
        let (mut corner, mut t) = ([0; 8], F8::ZERO);
        for (i, corner) in corner.iter_mut().enumerate() {
            let whole = x.0[i].floor();
            *corner = number(whole).wrapping_mul(apart);
            t.0[i] = x.0[i] - whole;
        }
        Self::new(corner, &t, apart)
    }
}

/// Whether all lanes are in the same cell.
#[inline(always)]
fn are_one_cell(along: &[Along; 3]) -> bool {
    let mut different = 0;
    for axis in along {
        for &corner in &axis.corner[0] {
            different |= corner ^ axis.corner[0][0];
        }
    }
    different == 0
}

/// A whole number modulo 2^32; any if it is none.
#[inline(always)]
fn number(whole: f64) -> u32 {
    const TURN: f64 = (1_u64 << 32) as f64;
    // Added to a whole number below 2^32 it leaves that in the lowest bits.
    const WHOLE: f64 = (1_u64 << 52) as f64;
    let rest = whole - (whole * (1.0 / TURN)).floor() * TURN;
    (rest + WHOLE).to_bits() as u32
}

/// Mixes the bits of what the three numbers came to: the last rounds of A. Appleby's MurmurHash3.
#[inline(always)]
fn mixed(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x85eb_ca6b);
    let x = (x ^ x >> 13).wrapping_mul(0xc2b2_ae35);
    x ^ x >> 16
}

/// What the numbers of a corner of each lane's cell come to.
#[inline(always)]
fn hashes(along: &[Along; 3], corner: usize) -> [u32; 8] {
    let mut hash = [0; 8];
    for (lane, hash) in hash.iter_mut().enumerate() {
        let [x, y, z] = along;
        *hash = x.corner[corner & 1][lane] ^ y.corner[corner >> 1 & 1][lane] ^ z.corner[corner >> 2][lane];
    }
    hash
}

/// An array of what an expression is for each corner: bit `i` of its number says where it is along axis `i`.
macro_rules! each_corner {
    ($c:ident => $each:expr) => {
        [
            each_corner!(0, $c => $each),
            each_corner!(1, $c => $each),
            each_corner!(2, $c => $each),
            each_corner!(3, $c => $each),
            each_corner!(4, $c => $each),
            each_corner!(5, $c => $each),
            each_corner!(6, $c => $each),
            each_corner!(7, $c => $each),
        ]
    };
    ($number:literal, $c:ident => $each:expr) => {{
        let $c: usize = $number;
        $each
    }};
}

/// The lowest eight bits as what is behind the point of a number: from 1 to 2 by 1/256, or from 2 to 4 by 1/128.
#[inline(always)]
fn eight(bits: u64, first: f64) -> f64 {
    f64::from_bits(first.to_bits() | (bits & 0xff) << 44)
}

/// A sum over some of the corners: its value and its derivatives.
#[derive(Clone, Copy)]
struct Sum {
    v: F8,
    d: [F8; 3],
}

impl Sum {
    /// Values and slopes of eight points of the lattice.
    #[inline(always)]
    fn said(hash: &[u32; 8]) -> Self {
        let mut out = Self { v: F8::ZERO, d: [F8::ZERO; 3] };
        for (i, &hash) in hash.iter().enumerate() {
            let bits = u64::from(mixed(hash));
            out.v.0[i] = eight(bits, 1.0) - (1.0 + 132.0 / 256.0);
            out.d[0].0[i] = eight(bits >> 8, 2.0) - (3.0 - 1.0 / 256.0);
            out.d[1].0[i] = eight(bits >> 16, 2.0) - (3.0 - 1.0 / 256.0);
            out.d[2].0[i] = eight(bits >> 24, 2.0) - (3.0 - 1.0 / 256.0);
        }
        out
    }

    /// From one to another along an axis.
    #[inline(always)]
    fn blended(along: &[Along; 3], axis: usize, a: &Self, b: &Self) -> Self {
        let Along { f, slope, .. } = &along[axis];
        let change = b.v - a.v;
        let mut out = Self { v: f.mul_add(change, a.v), d: [F8::ZERO; 3] };
        for i in 0..3 {
            out.d[i] = f.mul_add(b.d[i] - a.d[i], a.d[i]);
        }
        out.d[axis] = slope.mul_add(change, out.d[axis]);
        out
    }

    /// All corners, as seen from there; if all lanes are in one cell, eight corners are asked once.
    #[inline(always)]
    fn corners<const ONE_CELL: bool>(along: &[Along; 3]) -> [Self; 8] {
        if !ONE_CELL {
            return each_corner!(c => Self::said(&hashes(along, c)).seen(along, c));
        }
        let [x, y, z] = along;
        let turn = [
            x.corner[0][0] ^ x.corner[1][0],
            y.corner[0][0] ^ y.corner[1][0],
            z.corner[0][0] ^ z.corner[1][0],
        ];
        let mut hash = [x.corner[0][0] ^ y.corner[0][0] ^ z.corner[0][0]; 8];
        for (corner, hash) in hash.iter_mut().enumerate() {
            for (axis, turn) in turn.iter().enumerate() {
                *hash ^= turn & 0_u32.wrapping_sub(corner as u32 >> axis & 1);
            }
        }
        let said = Self::said(&hash);
        each_corner!(c => said.splat(c).seen(along, c))
    }

    /// What one lane says, in all.
    #[inline(always)]
    fn splat(&self, lane: usize) -> Self {
        let [x, y, z] = &self.d;
        Self {
            v: F8::splat(self.v.0[lane]),
            d: [F8::splat(x.0[lane]), F8::splat(y.0[lane]), F8::splat(z.0[lane])],
        }
    }

    /// What a corner's value and slope come to at the points.
    #[inline(always)]
    fn seen(mut self, along: &[Along; 3], corner: usize) -> Self {
        let [gx, gy, gz] = self.d;
        let [x, y, z] =
            [along[0].from[corner & 1], along[1].from[corner >> 1 & 1], along[2].from[corner >> 2]];
        self.v = gz.mul_add(z, gy.mul_add(y, gx.mul_add(x, self.v)));
        self
    }

    /// Of all corners.
    #[inline(always)]
    fn of(along: &[Along; 3], c: &[Self; 8]) -> Self {
        let near = Self::blended(
            along,
            1,
            &Self::blended(along, 0, &c[0], &c[1]),
            &Self::blended(along, 0, &c[2], &c[3]),
        );
        let far = Self::blended(
            along,
            1,
            &Self::blended(along, 0, &c[4], &c[5]),
            &Self::blended(along, 0, &c[6], &c[7]),
        );
        Self::blended(along, 2, &near, &far)
    }

    /// At eight points.
    #[inline(always)]
    fn at([x, y, z]: [&F8; 3]) -> Self {
        let along = [Along::of(x, APART[0]), Along::of(y, APART[1]), Along::of(z, APART[2])];
        if are_one_cell(&along) {
            Self::of(&along, &Self::corners::<true>(&along))
        } else {
            Self::of(&along, &Self::corners::<false>(&along))
        }
    }
}

/// The noise of eight points, rounded.
#[inline(never)]
pub(crate) fn values(p: [&F8; 3]) -> F8 {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || Sum::at(p).v,
    )
}

/// The same with its derivatives.
#[inline(never)]
pub(crate) fn slants(p: [&F8; 3]) -> (F8, [F8; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let Sum { v, d } = Sum::at(p);
            (v, d)
        },
    )
}

/// Bounds of noise on eight boxes.
#[inline(never)]
pub(crate) fn bounds(p: [&I8; 3]) -> I8 {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || if are_small(p) { around(p).0 } else { cellwise(p).0 },
    )
}

/// The same with bounds of its derivatives.
#[inline(never)]
pub(crate) fn slopes(p: [&I8; 3]) -> (I8, [I8; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || if are_small(p) { around(p) } else { cellwise(p) },
    )
}

/// Whether bounds that know nothing of the corners will do.
#[inline(always)]
fn are_small(p: [&I8; 3]) -> bool {
    const SMALL: f64 = 1.0 / 128.0;
    let mut all = true;
    for axis in p {
        for i in 0..8 {
            all &= axis.hi.0[i] - axis.lo.0[i] <= SMALL;
        }
    }
    all
}

/// Bounds that hold over any number of cells.
#[inline(always)]
fn around(p: [&I8; 3]) -> (I8, [I8; 3]) {
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
    let near = Sum::at([&m[0], &m[1], &m[2]]);
    let mut out = nothing(p);
    for i in 0..8 {
        let [a, b, c] = [r[0].0[i], r[1].0[i], r[2].0[i]];
        let [da, db, dc] = [near.d[0].0[i].abs(), near.d[1].0[i].abs(), near.d[2].0[i].abs()];
        let all = a + b + c;
        let along = da * a + db * b + dc * c + SLOPE_ERROR * all;
        let bent = (a * a + b * b + c * c) * ((BEND - TWIST) * 0.5) + all * all * (TWIST * 0.5);
        let reach = (along + bent + VALUE_MARGIN) * UP;
        narrow(&mut out.0, i, near.v.0[i] - reach, near.v.0[i] + reach);
        for (axis, r) in r.iter().enumerate() {
            let reach = (r.0[i] * (BEND - TWIST) + all * TWIST + SLOPE_MARGIN) * UP;
            let slope = near.d[axis].0[i];
            narrow(&mut out.1[axis], i, slope - reach, slope + reach);
        }
    }
    out
}

/// What is known of noise anywhere.
#[inline(always)]
fn nothing(p: [&I8; 3]) -> (I8, [I8; 3]) {
    let v = I8::new(F8::splat(-RANGE), F8::splat(RANGE)).said(p[0], p[1]).said(p[2], p[2]);
    let d = I8::new(F8::splat(-SLOPE), F8::splat(SLOPE)).said(&v, &v);
    (v, [d; 3])
}

/// Takes new bounds of a lane where they are narrower; what is no number is not.
#[inline(always)]
fn narrow(x: &mut I8, i: usize, lo: f64, hi: f64) {
    x.lo.0[i] = if lo > x.lo.0[i] { lo } else { x.lo.0[i] };
    x.hi.0[i] = if hi < x.hi.0[i] { hi } else { x.hi.0[i] };
}

/// The part of a box along an axis that is in one cell.
#[derive(Clone, Copy)]
struct Part {
    /// What the cell's lower corner adds to the hash.
    corner: [u32; 8],
    /// From where to where, in the cell.
    lo: F8,
    hi: F8,
}

/// A box along an axis: the part in its first cell, in which lanes there is one in the next cell, and in which one in a third.
struct Parts {
    first: Part,
    /// Where the part in the second cell ends.
    rest: F8,
    two: M8,
    more: M8,
}

impl Parts {
    #[inline(always)]
    fn new(x: &I8, apart: u32) -> Self {
        let mut first = Part { corner: [0; 8], lo: F8::ZERO, hi: F8::ZERO };
        let mut rest = F8::ZERO;
        for i in 0..8 {
            let whole = x.lo.0[i].floor();
            first.corner[i] = number(whole).wrapping_mul(apart);
            first.lo.0[i] = x.lo.0[i] - whole;
            let hi = x.hi.0[i] - whole;
            first.hi.0[i] = if hi < 1.0 { hi } else { 1.0 };
            rest.0[i] = hi - 1.0;
        }
        // Where an end is infinite there are more.
        Self { first, rest, two: rest.gt(F8::ZERO), more: !rest.le(F8::ONE) }
    }

    /// The part of a lane in its first or second cell.
    #[inline(always)]
    fn part(&self, i: usize, second: bool, apart: u32) -> (u32, f64, f64) {
        let corner = self.first.corner[i];
        if second {
            (corner.wrapping_add(apart), 0.0, self.rest.0[i])
        } else {
            (corner, self.first.lo.0[i], self.first.hi.0[i])
        }
    }
}

/// Bounds by those on the parts in single cells; of boxes of more than two cells along an axis nothing is known.
#[inline(always)]
fn cellwise(p: [&I8; 3]) -> (I8, [I8; 3]) {
    let parts = [Parts::new(p[0], APART[0]), Parts::new(p[1], APART[1]), Parts::new(p[2], APART[2])];
    let more = parts[0].more | parts[1].more | parts[2].more;
    let two = [parts[0].two & !more, parts[1].two & !more, parts[2].two & !more];
    let mut out = nothing(p);
    let mut held = whole(&[parts[0].first, parts[1].first, parts[2].first]);
    if (two[0] | two[1] | two[2]).any() {
        beside(&parts, &two, &mut held);
    }
    let (v, d) = held;
    for i in (!more).lanes() {
        narrow(&mut out.0, i, v.lo.0[i], v.hi.0[i]);
        for (out, d) in out.1.iter_mut().zip(&d) {
            narrow(out, i, d.lo.0[i], d.hi.0[i]);
        }
    }
    out
}

/// Widens bounds by those on the parts in other cells than the first, eight of them at a time.
#[inline(always)]
fn beside(parts: &[Parts; 3], two: &[M8; 3], held: &mut (Ends, [Ends; 3])) {
    let [x, y, z] = [two[0].bits(), two[1].bits(), two[2].bits()];
    let mut eight = [parts[0].first, parts[1].first, parts[2].first];
    let (mut of, mut count) = ([0; 8], 0);
    for which in 1..8_u8 {
        let needs = |axis: u8, lanes: u8| if which >> axis & 1 == 1 { lanes } else { 0xff };
        for i in crate::lanes::set_bits(needs(0, x) & needs(1, y) & needs(2, z)) {
            for axis in 0..3 {
                let (corner, lo, hi) = parts[axis].part(i, which >> axis & 1 == 1, APART[axis]);
                let part = &mut eight[axis];
                (part.corner[count], part.lo.0[count], part.hi.0[count]) = (corner, lo, hi);
            }
            of[count] = i;
            count += 1;
            if count == 8 {
                widen(held, &of, &whole(&eight));
                count = 0;
            }
        }
    }
    if count > 0 {
        widen(held, &of[..count], &whole(&eight));
    }
}

/// Bounds of some lanes as wide as others are.
#[inline(always)]
fn widen(held: &mut (Ends, [Ends; 3]), of: &[usize], by: &(Ends, [Ends; 3])) {
    held.0.widen(of, &by.0);
    for axis in 0..3 {
        held.1[axis].widen(of, &by.1[axis]);
    }
}

/// The least and the greatest numbers of eight.
#[derive(Clone, Copy)]
struct Ends {
    lo: F8,
    hi: F8,
}

impl Ends {
    /// Some lanes as wide as others are.
    #[inline(always)]
    fn widen(&mut self, of: &[usize], by: &Self) {
        for (k, &i) in of.iter().enumerate() {
            self.lo.0[i] = self.lo.0[i].min(by.lo.0[k]);
            self.hi.0[i] = self.hi.0[i].max(by.hi.0[k]);
        }
    }

    /// Of `(1 - f) a + f b`: it rises with both, and is linear in `f`.
    #[inline(always)]
    fn blended(f: &Self, a: &Self, b: &Self) -> Self {
        let (lo, hi) = (b.lo - a.lo, b.hi - a.hi);
        Self {
            lo: f.lo.mul_add(lo, a.lo).min(f.hi.mul_add(lo, a.lo)),
            hi: f.lo.mul_add(hi, a.hi).max(f.hi.mul_add(hi, a.hi)),
        }
    }
}

/// A part along an axis, and what the blend and its derivative are on it.
struct Within {
    /// Half of its length.
    half: F8,
    f: Ends,
    slope: Ends,
}

impl Within {
    #[inline(always)]
    fn new(part: &Part, apart: u32) -> (Along, Self) {
        let middle = part.lo * 0.5 + part.hi * 0.5;
        let half = part.hi * 0.5 - part.lo * 0.5;
        let (a, b) = (Along::new(part.corner, &part.lo, apart), Along::new(part.corner, &part.hi, apart));
        let mut slope = Ends { lo: a.slope.min(b.slope), hi: a.slope.max(b.slope) };
        for i in 0..8 {
            let steepest = (part.lo.0[i] < 0.5) & (part.hi.0[i] > 0.5);
            slope.hi.0[i] = if steepest { 1.5 } else { slope.hi.0[i] };
        }
        (Along::new(part.corner, &middle, apart), Self { half, f: Ends { lo: a.f, hi: b.f }, slope })
    }
}

/// Bounds on eight boxes, each of which is in one cell: of the derivatives by the blends' extremes, of the value by the one in the middle and the derivatives.
#[inline(never)]
fn whole(parts: &[Part; 3]) -> (Ends, [Ends; 3]) {
    Isa::detect().run_in_lanes(
        #[inline(always)]
        || {
            let (x, u) = Within::new(&parts[0], APART[0]);
            let (y, v) = Within::new(&parts[1], APART[1]);
            let (z, w) = Within::new(&parts[2], APART[2]);
            let (along, within) = ([x, y, z], [u, v, w]);
            if are_one_cell(&along) {
                within_corners(&along, &within, &Sum::corners::<true>(&along))
            } else {
                within_corners(&along, &within, &Sum::corners::<false>(&along))
            }
        },
    )
}

#[inline(always)]
fn within_corners(along: &[Along; 3], within: &[Within; 3], corners: &[Sum; 8]) -> (Ends, [Ends; 3]) {
    let d = [
        slope(within, corners, [0, 1, 2]),
        slope(within, corners, [1, 0, 2]),
        slope(within, corners, [2, 0, 1]),
    ];
    let mut reach = F8::splat(VALUE_MARGIN);
    for (d, within) in d.iter().zip(within) {
        reach = d.hi.max(-d.lo).mul_add(within.half, reach);
    }
    let (v, reach) = (Sum::of(along, corners).v, reach * UP);
    (Ends { lo: v - reach, hi: v + reach }, d)
}

/// Bounds of the derivative along the first of three axes.
#[inline(always)]
fn slope(within: &[Within; 3], corners: &[Sum; 8], [axis, second, third]: [usize; 3]) -> Ends {
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
    Ends { lo: lo - SLOPE_MARGIN, hi: hi + SLOPE_MARGIN }
}

/// The same of an edge's two corners: `f' (b - a)`, and the slopes there.
#[inline(always)]
fn pair(within: &[Within; 3], axis: usize, a: &Sum, b: &Sum) -> Ends {
    // The difference is linear along all axes.
    let mut reach = F8::ZERO;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dyadic, Interval, Ring};

    /// A function of noise's parts at a place, written once.
    fn exact(p: [f64; 3]) -> [Dyadic; 4] {
        let number = |x: f64| Dyadic::exact(x);
        let whole = p.map(f64::floor);
        let zero = || number(0.0);
        let mut sum = [zero(), zero(), zero(), zero()];
        // The blend and its derivative towards the upper corner.
        let t: [Dyadic; 3] = [0, 1, 2].map(|i| number(p[i]) - number(whole[i]));
        let f = |t: &Dyadic| t.clone().square() * (number(3.0) - number(2.0) * t.clone());
        let slope = |t: &Dyadic| number(6.0) * t.clone() * (number(1.0) - t.clone());
        for corner in 0..8 {
            let bit = |axis: usize| corner >> axis & 1;
            let mut hash = 0_u32;
            for axis in 0..3 {
                let number = (whole[axis] + f64::from(bit(axis))).rem_euclid(4_294_967_296.0) as u32;
                hash ^= number.wrapping_mul(APART[axis]);
            }
            let hash = mixed(hash);
            let byte = |k: u32| f64::from(hash >> (8 * k) & 0xff);
            let g = [1, 2, 3].map(|k| number((2.0 * byte(k) - 255.0) / 256.0));
            let from: [Dyadic; 3] = [0, 1, 2].map(|i| t[i].clone() - number(f64::from(bit(i))));
            let q = (0..3).fold(number((byte(0) - 132.0) / 256.0), |q, i| q + g[i].clone() * from[i].clone());
            let weight = |i: usize| if bit(i) == 1 { f(&t[i]) } else { number(1.0) - f(&t[i]) };
            let steep = |i: usize| if bit(i) == 1 { slope(&t[i]) } else { -slope(&t[i]) };
            let all = weight(0) * weight(1) * weight(2);
            sum[0] = sum[0].clone() + all.clone() * q.clone();
            for axis in 0..3 {
                let others = weight((axis + 1) % 3) * weight((axis + 2) % 3);
                let part = steep(axis) * others * q.clone() + all.clone() * g[axis].clone();
                sum[axis + 1] = sum[axis + 1].clone() + part;
            }
        }
        sum
    }

    /// Numbers of all kinds: in cells, on their faces and next to these, small and large, of both signs.
    struct Dice(u64);

    impl Dice {
        fn bits(&mut self) -> u64 {
            // S. Vigna's SplitMix64.
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }

        fn unit(&mut self) -> f64 {
            (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn number(&mut self) -> f64 {
            let x = (self.unit() - 0.5) * [1.0, 20.0, 1e4, 1e10, 1e17][(self.bits() % 5) as usize];
            match self.bits() % 8 {
                0 => x.round(),
                1 => x.round().next_up(),
                2 => x.round().next_down(),
                3 => x.round() + 0.5,
                4 => x * 1e-12,
                _ => x,
            }
        }
    }

    fn is_within(x: &Dyadic, lo: f64, hi: f64) -> bool {
        *x >= Dyadic::exact(lo) && *x <= Dyadic::exact(hi)
    }

    #[test]
    fn rounded_values_and_slopes_are_as_near_as_is_said() {
        let mut dice = Dice(1);
        for _ in 0..20_000 {
            let p = [dice.number(), dice.number(), dice.number()];
            let (v, d) = slants(F8::splats(p).each_ref());
            let told = [v, d[0], d[1], d[2]];
            for (told, exact) in told.iter().zip(exact(p)) {
                let e = if *told == v { VALUE_ERROR } else { SLOPE_ERROR };
                // A quarter of what is claimed is what happens.
                let (lo, hi) = (told.0[0] - e / 4.0, told.0[0] + e / 4.0);
                assert!(is_within(&exact, lo, hi), "{p:?}: {told:?} {exact:?}");
            }
        }
    }

    #[test]
    fn pictures_of_noise_stay_what_they_are() {
        let at = |p: [f64; 3]| values(F8::splats(p).each_ref()).0[0];
        let known = [
            ([0.3, 0.7, 0.2], -0.4793344928000001),
            ([-5.25, 1e6 + 0.125, 77.5], 0.2862153649330139),
            ([2.5 * 4_294_967_296.0, 0.5, -0.5], 0.0361328125),
        ];
        for (p, value) in known {
            assert_eq!(at(p), value, "{p:?}");
        }
        // It begins anew after 2^32.
        assert_eq!(at([0.5 + 4_294_967_296.0, 0.5, 0.5]), at([0.5, 0.5, 0.5]));
        assert!(at([f64::INFINITY, 0.0, 0.0]).is_nan() && at([f64::MAX, f64::MIN, 1e300]).is_finite());
    }

    #[test]
    fn bounds_hold_exact_values_and_rounded_ones() {
        let mut dice = Dice(2);
        for _ in 0..3_000 {
            let size = [0.0, 1e-12, 1e-3, 0.05, 0.3, 1.0, 3.0][(dice.bits() % 7) as usize];
            let mut boxes = [I8::new(F8::ZERO, F8::ZERO); 3];
            for i in 0..8 {
                for x in &mut boxes {
                    let lo = dice.number();
                    x.set_lane(i, Interval { lo, hi: lo + size * dice.unit() });
                }
            }
            let (v, d) = slopes(boxes.each_ref());
            assert_eq!(v, bounds(boxes.each_ref()));
            for i in 0..8 {
                for _ in 0..2 {
                    let k = [0.0, 1.0, dice.unit(), dice.unit()];
                    let p = boxes.map(|x| {
                        let Interval { lo, hi } = x.lane(i);
                        (lo + (hi - lo) * k[(dice.bits() % 4) as usize]).clamp(lo, hi)
                    });
                    let (value, slope) = slants(F8::splats(p).each_ref());
                    let told = [(v, value), (d[0], slope[0]), (d[1], slope[1]), (d[2], slope[2])];
                    for ((bounds, rounded), exact) in told.into_iter().zip(exact(p)) {
                        let Interval { lo, hi } = bounds.lane(i);
                        assert!(is_within(&exact, lo, hi), "{p:?}: {lo} {hi} {exact:?}");
                        assert!(lo <= rounded.0[0] && rounded.0[0] <= hi, "{p:?}: {lo} {hi} {rounded:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn constants_bound_the_derivatives_whatever_the_corners_have() {
        let number = |x: f64| Interval { lo: x, hi: x };
        let (one, two, six) = (number(1.0), number(2.0), number(6.0));
        // Of the blend f(t), its first and its second derivative, and what a derivative takes of the slopes that two corners have along its axis.
        let parts = |t: Interval| {
            let f = t.square() * (number(3.0) - two * t);
            let (d, dd) = (six * t * (one - t), six - number(12.0) * t);
            (d, dd, (one - f - d * t).abs() + (f - d * (one - t)).abs())
        };
        let piece =
            |k: u32, n: u32| Interval::new(f64::from(k) / f64::from(n), f64::from(k + 1) / f64::from(n));
        // Distances from two corners, weighted, are at most 1/2 together: so 1 of two pairs along each of the other axes.
        let other = number(2.0 * CORNER + 2.0);
        let (mut slope, mut bend, mut twist) = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..4096 {
            let t = piece(i, 4096);
            let (d, dd, own) = parts(t);
            slope = slope.max((d * other + own).hi);
            let own = (dd * t + two * d).abs() + (two * d - dd * (one - t)).abs();
            bend = bend.max((dd.abs() * other + own).hi);
        }
        for i in 0..512 {
            for j in 0..512 {
                let ((du, _, u), (dv, _, v)) = (parts(piece(i, 512)), parts(piece(j, 512)));
                let all = du * dv * number(4.0 * CORNER + 2.0) + two * (dv * u + du * v);
                twist = twist.max(all.hi);
            }
        }
        // Not more than a hundredth too large.
        for (found, claimed) in [(slope, SLOPE), (bend, BEND), (twist, TWIST)] {
            assert!(found <= claimed && claimed <= 1.01 * found, "{found} {claimed}");
        }
    }

    #[test]
    fn values_and_slopes_go_on_from_cell_to_cell() {
        let mut dice = Dice(3);
        for _ in 0..5_000 {
            let mut p = [dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0];
            let axis = (dice.bits() % 3) as usize;
            p[axis] = p[axis].round();
            let at = |x: f64| {
                let mut p = p;
                p[axis] = x;
                slants(F8::splats(p).each_ref())
            };
            let ((a, da), (b, db)) = (at(p[axis].next_down()), at(p[axis].next_up()));
            let apart = p[axis].next_up() - p[axis].next_down();
            assert!((a.0[0] - b.0[0]).abs() <= 2.0 * VALUE_ERROR + SLOPE * apart);
            for (da, db) in da.iter().zip(&db) {
                assert!((da.0[0] - db.0[0]).abs() <= 2.0 * SLOPE_ERROR + BEND * apart);
            }
        }
    }

    #[test]
    fn corners_are_alike_and_know_nothing_of_each_other() {
        // What 64^3 points of the lattice have, and what the next ones along each direction have.
        let corner = |p: [f64; 3]| {
            let (v, [x, y, z]) = slants(F8::splats(p).each_ref());
            [v.0[0] + 4.5 / 256.0, x.0[0], y.0[0], z.0[0]]
        };
        const NEXT: [[f64; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
        let (mut count, mut sums, mut squares) = (0.0, [0.0; 4], [0.0; 4]);
        let mut products = [[0.0; 4]; 4];
        for k in 0..1 << 18 {
            let p = [k & 63, k >> 6 & 63, k >> 12].map(|x: i32| f64::from(x - 32));
            let own = corner(p);
            count += 1.0;
            for i in 0..4 {
                sums[i] += own[i];
                squares[i] += own[i] * own[i];
            }
            for (next, products) in NEXT.iter().zip(&mut products) {
                let next = corner([0, 1, 2].map(|i| p[i] + next[i]));
                for i in 0..4 {
                    products[i] += own[i] * next[i];
                }
            }
        }
        // Uniform between -1/2 and 1/2, and between -1 and 1. Of so many, means and correlations are within 5 standard errors.
        let variance = [1.0 / 12.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0];
        let error = 5.0 / f64::sqrt(count);
        for i in 0..4 {
            let spread = f64::sqrt(variance[i]);
            assert!((sums[i] / count).abs() < error * spread, "mean {i}: {}", sums[i] / count);
            assert!(
                (squares[i] / count / variance[i] - 1.0).abs() < error,
                "variance {i}: {}",
                squares[i] / count
            );
            for (next, products) in NEXT.iter().zip(&products) {
                let correlation = products[i] / count / variance[i];
                assert!(correlation.abs() < error, "{i} along {next:?}: {correlation}");
            }
        }
    }

    #[test]
    fn bounds_of_small_boxes_are_hardly_wider_than_the_values() {
        let mut dice = Dice(4);
        for (size, most) in [(0.1, 3.0), (0.02, 2.0), (1e-4, 1.1)] {
            let mut ratios: Vec<f64> = Vec::new();
            for _ in 0..200 {
                let lo = [dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0];
                let v = bounds(lo.map(|lo| I8::splat(Interval { lo, hi: lo + size })).each_ref()).lane(0);
                let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
                for k in 0..125_u32 {
                    let at = [k % 5, k / 5 % 5, k / 25].map(|k| f64::from(k) / 4.0 * size);
                    let value = values(F8::splats([0, 1, 2].map(|i| lo[i] + at[i])).each_ref()).0[0];
                    (least, greatest) = (least.min(value), greatest.max(value));
                }
                ratios.push((v.hi - v.lo) / (greatest - least));
            }
            ratios.sort_by(f64::total_cmp);
            assert!(ratios[0] >= 1.0 && ratios[100] < most, "{size}: {}", ratios[100]);
        }
    }
}

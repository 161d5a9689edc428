//! The distance from a point to the nearest, second or third nearest of random points, one in each
//! cube of the unit lattice: S. Worley, "A cellular texture basis function", SIGGRAPH 1996.
//!
//! ```text
//!   d_k(p) = the k-th least of (|x - x_i|^e + |y - y_i|^e + |z - z_i|^e + |offset|^e)^(1/e),  e >= 1
//! ```
//!
//! Bounds on a box: the k-th least of all lower bounds and the k-th least of all upper bounds
//! enclose the k-th least distance. Slopes: where it is differentiable, `d_k` has the gradient of the
//! distance from one of the points whose bounds meet those of `d_k`, so the hull of their gradients
//! holds all difference quotients (F. H. Clarke, *Optimization and Nonsmooth Analysis*, 1983).

use super::cell_numbers::CellNumbers;
use crate::I8;
use arrayvec::ArrayVec;
use durer_math::lanes::set_bits;
use durer_math::rounding::sub_down;
use durer_math::{F8, Interval, Isa, U};
use std::sync::{Mutex, PoisonError};

/// How distances are measured, and which of them is wanted. Those of formulas are shared and live as
/// long as the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    rank: usize,
    exponent: f64,
    offset: f64,
}

static SHARED: Mutex<Vec<&'static Nearest>> = Mutex::new(Vec::new());

/// On a wider box nothing but the bounds of all space are known.
const WIDEST: f64 = 2.0;

/// From here on unit cubes have no exact place.
const FARTHEST: f64 = (1_u64 << 50) as f64;

/// The largest distance, in steps, of a relevant cube from the middle one: no distance without the
/// offset is above 3.5 (see [`Nearest::everywhere`]), and half of the widest box is 1.
const SHELLS: usize = 5;

/// The slopes of as many random points are compared, which small boxes never reach. Of more nothing is
/// known.
const MOST: usize = 512;

/// A random point: the sum of the powers of the differences of its coordinates and those of the
/// box, and the differences.
struct Site {
    sum: Interval,
    from: [Interval; 3],
}

/// Half-integer exponents below this are powers and a square root, which are faster than a logarithm.
const MOST_HALVES: f64 = 16.0;

/// `x^e`, for `x` that is not negative.
#[inline(always)]
fn raised(x: Interval, e: f64) -> Interval {
    if e == 1.0 {
        return x;
    }
    if e < MOST_HALVES && e.fract() == 0.5 {
        return x.powi(e as i32).0 * x.sqrt();
    }
    x.pow(e.into()).0
}

impl Nearest {
    /// The distance of this rank, 0 to 2, with this exponent and this distance along a fourth axis.
    /// `None` if the rank is greater, the exponent is less than 1, or a number is not finite.
    pub fn new(rank: usize, exponent: f64, offset: f64) -> Option<Self> {
        let is_valid = rank < 3 && (1.0..f64::INFINITY).contains(&exponent) && offset.is_finite();
        is_valid.then_some(Self { rank, exponent, offset })
    }

    /// [`Nearest::new`], once for all that are equal.
    pub fn shared(rank: usize, exponent: f64, offset: f64) -> Option<&'static Self> {
        let wanted = Self::new(rank, exponent, offset)?;
        let mut all = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = all.iter().find(|known| ***known == wanted) {
            return Some(known);
        }
        let new: &Self = Box::leak(Box::new(wanted));
        all.push(new);
        Some(new)
    }

    /// `|x|^e`.
    #[inline(always)]
    fn power(self, x: Interval) -> Interval {
        match self.exponent {
            1.0 => x.abs(),
            2.0 => x.square(),
            e => raised(x.abs(), e),
        }
    }

    /// The distance with this sum of powers.
    #[inline(always)]
    fn distance(self, sum: Interval) -> Interval {
        let sum = sum + self.power(self.offset.into());
        match self.exponent {
            1.0 => sum,
            2.0 => sum.sqrt(),
            e => sum.pow(Interval::from(1.0) / Interval::from(e)).0,
        }
    }

    /// All distances of this rank. The point of the own cube is at most 1 away along each axis. The
    /// points of the three cubes that share the nearer faces are at most 1.5 away along one axis.
    fn everywhere(self) -> Interval {
        let (one, more) = (Interval::from(1.0), self.power(1.5.into()));
        let most = if self.rank == 0 { one + one + one } else { more + one + one };
        self.distance(Interval { lo: 0.0, hi: most.hi })
    }

    /// Shows the random points that may have this rank for a point of the box to `f`, and returns
    /// the bounds of the sum of this rank. `None` if the box is too wide or too far away.
    #[inline(always)]
    fn search(self, p: [Interval; 3], mut f: impl FnMut(Site)) -> Option<Interval> {
        let is_near = |x: &Interval| x.width() <= WIDEST && x.magnitude() < FARTHEST;
        if !p.iter().all(is_near) {
            return None;
        }
        let numbers = CellNumbers::get();
        let middle = p.map(|x| x.mid().floor());
        // The three least lower and upper bounds, ascending.
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::INFINITY; 3]);
        // For each axis and step, the least power of the distance from the box to the cube.
        let mut gaps = [[0.0; 2 * SHELLS + 1]; 3];
        for shell in 0..=SHELLS {
            let mut nearest = f64::INFINITY;
            for axis in 0..3 {
                for step in [SHELLS - shell, SHELLS + shell] {
                    let cube = middle[axis] + (step as f64 - SHELLS as f64);
                    let gap = sub_down(cube, p[axis].hi).max(sub_down(p[axis].lo, cube + 1.0)).max(0.0);
                    gaps[axis][step] = self.power(gap.into()).lo;
                    nearest = nearest.min(gaps[axis][step]);
                }
            }
            // Each cube of the shell is at least this far away along one axis.
            if nearest > high[self.rank] {
                break;
            }
            let range = SHELLS - shell..=SHELLS + shell;
            for x in range.clone() {
                for y in range.clone() {
                    let is_on_shell = |step: usize| step == *range.start() || step == *range.end();
                    let is_side = is_on_shell(x) || is_on_shell(y);
                    for z in range.clone().filter(|&z| is_side || is_on_shell(z)) {
                        // Two roundings of a sum of numbers that are not negative.
                        let least = (gaps[0][x] + gaps[1][y] + gaps[2][z]) * (1.0 - 4.0 * U);
                        if least > high[self.rank] {
                            continue;
                        }
                        let steps = [x, y, z];
                        let cube: [f64; 3] =
                            core::array::from_fn(|axis| middle[axis] + (steps[axis] as f64 - SHELLS as f64));
                        let within = numbers.of(cube);
                        let from: [Interval; 3] = core::array::from_fn(|axis| {
                            p[axis] - cube[axis].into() - Interval::from(within[axis])
                        });
                        let sum = self.power(from[0]) + self.power(from[1]) + self.power(from[2]);
                        keep_least(&mut low, sum.lo);
                        keep_least(&mut high, sum.hi);
                        f(Site { sum, from });
                    }
                }
            }
        }
        Some(Interval { lo: low[self.rank], hi: high[self.rank] })
    }

    /// The distances from the points of a box.
    pub fn bounds(self, p: [Interval; 3]) -> Interval {
        Isa::detect().run(
            #[inline(always)]
            || match self.search(
                p,
                #[inline(always)]
                |_| {},
            ) {
                Some(sum) => self.distance(sum),
                None => self.everywhere(),
            },
        )
    }

    /// The distances from the points of a box, and their slopes along the axes.
    pub fn slopes(self, p: [Interval; 3]) -> (Interval, [Interval; 3]) {
        Isa::detect().run(
            #[inline(always)]
            || self.slopes_here(p),
        )
    }

    #[inline(always)]
    fn slopes_here(self, p: [Interval; 3]) -> (Interval, [Interval; 3]) {
        let unknown = [Interval { lo: -1.0, hi: 1.0 }; 3];
        let mut sites = ArrayVec::<Site, MOST>::new();
        let mut is_complete = true;
        let found = self.search(
            p,
            #[inline(always)]
            |site| is_complete &= sites.try_push(site).is_ok(),
        );
        let Some(sum) = found else {
            return (self.everywhere(), unknown);
        };
        let distance = self.distance(sum);
        if !is_complete {
            return (distance, unknown);
        }
        let mut slopes: Option<[Interval; 3]> = None;
        for site in sites.iter().filter(|site| site.sum.lo <= sum.hi && site.sum.hi >= sum.lo) {
            let own_distance = self.distance(site.sum);
            let own = site.from.map(|x| self.slope(x, own_distance));
            slopes = Some(match slopes {
                None => own,
                Some(all) => core::array::from_fn(|axis| all[axis].hull(own[axis])),
            });
        }
        (distance, slopes.unwrap_or(unknown))
    }

    /// The slope of a distance along an axis: the sign of `x` times `(|x| / distance)^(e - 1)`.
    #[inline(always)]
    fn slope(self, x: Interval, distance: Interval) -> Interval {
        let unit = Interval { lo: 0.0, hi: 1.0 };
        let size = match self.exponent {
            1.0 => Interval::from(1.0),
            _ if distance.lo <= 0.0 => unit,
            e => {
                let ratio = (x.abs() / distance).intersection(unit).unwrap_or(unit);
                raised(ratio, e - 1.0)
            }
        };
        let size = size.intersection(unit).unwrap_or(unit);
        if x.lo > 0.0 {
            size
        } else if x.hi < 0.0 {
            -size
        } else {
            Interval { lo: -size.hi, hi: size.hi }
        }
    }

    /// The distance from a point: the middle of its bounds.
    pub fn value(self, p: [f64; 3]) -> f64 {
        if p.iter().any(|x| x.is_nan()) { f64::NAN } else { self.bounds(p.map(Interval::from)).mid() }
    }

    /// [`Nearest::value`] for eight points.
    pub(crate) fn values(self, [x, y, z]: [&F8; 3]) -> F8 {
        F8(core::array::from_fn(|i| self.value([x.0[i], y.0[i], z.0[i]])))
    }

    /// The distance from a point and its slopes, within their bounds.
    pub(crate) fn value_and_slopes(self, p: [f64; 3]) -> (f64, [f64; 3]) {
        if p.iter().any(|x| x.is_nan()) {
            return (f64::NAN, [f64::NAN; 3]);
        }
        let (value, slopes) = self.slopes(p.map(Interval::from));
        (value.mid(), slopes.map(Interval::mid))
    }

    /// The distances from eight points, and their slopes.
    pub(crate) fn values_and_slopes(self, [x, y, z]: [&F8; 3]) -> (F8, [F8; 3]) {
        let (mut v, mut d) = (F8::ZERO, [F8::ZERO; 3]);
        for i in 0..8 {
            let (value, slopes) = self.value_and_slopes([x.0[i], y.0[i], z.0[i]]);
            v.0[i] = value;
            for (d, slope) in d.iter_mut().zip(slopes) {
                d.0[i] = slope;
            }
        }
        (v, d)
    }

    /// The distances from the points of eight boxes.
    pub(crate) fn bounds_in_lanes(self, p: [&I8; 3]) -> I8 {
        let mut out = I8::new(F8::ZERO, F8::ZERO).said(p[0], p[1]).said(p[2], p[2]);
        for i in set_bits(!out.empty) {
            out.set_lane(i, self.bounds(p.map(|x| x.lane(i))));
        }
        out
    }

    /// The distances from the points of eight boxes, and their slopes.
    pub(crate) fn slopes_in_lanes(self, p: [&I8; 3]) -> (I8, [I8; 3]) {
        let mut out = I8::new(F8::ZERO, F8::ZERO).said(p[0], p[1]).said(p[2], p[2]);
        let mut d = [out; 3];
        for i in set_bits(!out.empty) {
            let (value, slopes) = self.slopes(p.map(|x| x.lane(i)));
            out.set_lane(i, value);
            for (d, slope) in d.iter_mut().zip(slopes) {
                d.set_lane(i, slope);
            }
        }
        (out, d)
    }
}

/// Puts a number among the least, which are ascending.
fn keep_least(least: &mut [f64; 3], x: f64) {
    if let Some(k) = (0..3).find(|&k| x < least[k]) {
        least[k..].rotate_right(1);
        least[k] = x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Dyadic;

    const KINDS: [(f64, f64); 5] = [(2.0, 0.0), (2.0, 0.3), (1.0, 0.0), (2.5, -0.7), (6.0, 0.0)];

    /// A few numbers from 0 to 1.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    /// The steps to the cubes of a shell: the greatest of the three is `shell` in magnitude.
    fn shell_steps(shell: i32) -> impl Iterator<Item = [i32; 3]> {
        let all = move || -shell..=shell;
        let cube = all().flat_map(move |x| all().flat_map(move |y| all().map(move |z| [x, y, z])));
        cube.filter(move |step| step.iter().any(|x| x.abs() == shell))
    }

    /// The sums of the squares for all random points of cubes up to three away, exactly, ascending.
    fn exact_squares(p: [f64; 3]) -> Vec<Dyadic> {
        let mut all = Vec::new();
        let cube = p.map(f64::floor);
        for step in (0..=3).flat_map(shell_steps) {
            let own: [f64; 3] = core::array::from_fn(|axis| cube[axis] + f64::from(step[axis]));
            let within = CellNumbers::get().of(own);
            let part = |axis: usize| {
                let x = &(&Dyadic::from(p[axis]) - &Dyadic::from(own[axis])) - &Dyadic::from(within[axis]);
                &x * &x
            };
            all.push(&(&part(0) + &part(1)) + &part(2));
        }
        all.sort();
        all
    }

    #[test]
    fn squares_of_bounds_hold_the_exact_sums() {
        let mut numbers = Numbers(1);
        for _ in 0..300 {
            let size = [1.0, 40.0, 1e6][(numbers.next() * 3.0) as usize];
            let p = [(); 3].map(|()| (numbers.next() - 0.5) * size);
            let exact = exact_squares(p);
            for (rank, exact) in exact.iter().enumerate().take(3) {
                let bounds = Nearest::new(rank, 2.0, 0.0).unwrap().bounds(p.map(Interval::from));
                let square = |x: f64| &Dyadic::from(x) * &Dyadic::from(x);
                assert!(square(bounds.lo) <= *exact && *exact <= square(bounds.hi), "{p:?} {rank}");
                assert!(bounds.width() < 1e-8, "{p:?} {rank} {bounds:?}");
            }
        }
    }

    #[test]
    fn bounds_of_boxes_hold_the_values_in_them_and_slopes_their_differences() {
        let mut numbers = Numbers(2);
        for _ in 0..400 {
            let width = [1e-6, 0.01, 0.3, 1.5, 3.0][(numbers.next() * 5.0) as usize];
            let low = [(); 3].map(|()| (numbers.next() - 0.5) * 20.0);
            let p = low.map(|x| Interval { lo: x, hi: x + width });
            for (exponent, offset) in KINDS {
                for rank in 0..3 {
                    let nearest = Nearest::new(rank, exponent, offset).unwrap();
                    let (all, slopes) = nearest.slopes(p);
                    assert_eq!((all.lo, all.hi), (nearest.bounds(p).lo, nearest.bounds(p).hi));
                    let inside = |numbers: &mut Numbers| p.map(|x| x.lo + numbers.next() * (x.hi - x.lo));
                    let from = inside(&mut numbers);
                    let axis = (numbers.next() * 3.0) as usize;
                    let mut to = from;
                    to[axis] = p[axis].lo + numbers.next() * (p[axis].hi - p[axis].lo);
                    let [a, b] = [from, to].map(|q| nearest.bounds(q.map(Interval::from)));
                    for x in [a, b] {
                        assert!(all.lo <= x.hi && x.lo <= all.hi, "{p:?} {from:?} {nearest:?}");
                    }
                    let step = Interval::from(to[axis]) - from[axis].into();
                    let expected = slopes[axis] * step;
                    let found = b - a;
                    assert!(expected.lo <= found.hi && found.lo <= expected.hi, "{p:?} {nearest:?} {axis}");
                }
            }
        }
    }

    #[test]
    fn small_boxes_have_narrow_bounds() {
        let nearest = Nearest::new(1, 2.0, 0.0).unwrap();
        let p = [0.3, -2.7, 11.4].map(|x| Interval { lo: x, hi: x + 1e-4 });
        let (all, slopes) = nearest.slopes(p);
        assert!(all.width() < 4e-4 && slopes.iter().all(|d| d.width() < 1e-2), "{all:?} {slopes:?}");
    }

    #[test]
    fn far_and_wide_boxes_have_the_bounds_of_all_space() {
        let nearest = Nearest::new(2, 2.0, 0.0).unwrap();
        for p in [Interval::ENTIRE, Interval::new(0.0, 5.0), Interval::from(1e300)] {
            let (all, slopes) = nearest.slopes([p; 3]);
            assert_eq!((all.lo, slopes[0].lo, slopes[0].hi), (0.0, -1.0, 1.0));
            assert!((all.hi - 4.25_f64.sqrt()).abs() < 1e-9);
        }
        assert!(nearest.value([f64::NAN, 0.0, 0.0]).is_nan());
        assert!(Nearest::new(3, 2.0, 0.0).is_none() && Nearest::new(0, 0.5, 0.0).is_none());
    }
}

//! Noise and its bounds against exact arithmetic, and the statistics of its corners.

use super::bounds::{BEND, CORNER, SLOPE, TWIST};
use super::*;
use crate::I8;
use durer_math::{Dyadic, Interval, Ring};
use durer_testkit::TestRng;

/// A table with values and slopes up to 0.7 and 1.3.
fn table() -> &'static NoiseTable {
    let (points, order) = numbers();
    NoiseTable::shared(&points, &order).unwrap()
}

fn numbers() -> ([[f64; 4]; 256], [u16; 4096]) {
    let mut dice = TestRng::new(77);
    let mut random = |most: f64| (dice.unit() * 2.0 - 1.0) * most;
    let points = core::array::from_fn(|_| [random(0.7), random(1.3), random(1.3), random(1.3)]);
    // A permutation: multiplication by an odd number.
    (points, core::array::from_fn(|i| (i * 1237 + 411) as u16 % 4096))
}

/// A table of rows with slopes up to 1.3.
fn rows() -> &'static NoiseTable {
    let (slopes, [a, b]) = row_numbers();
    NoiseTable::of_rows(&slopes, [&a, &b]).unwrap()
}

fn row_numbers() -> (Vec<[f64; 3]>, [Vec<u16>; 2]) {
    let mut dice = TestRng::new(78);
    let mut random = || (dice.unit() * 2.0 - 1.0) * 1.3;
    let slopes = (0..2048).map(|_| [random(), random(), random()]).collect();
    (slopes, [1237, 411].map(|factor| (0..2048).map(|i| (i * factor + 5) % 2048).map(|k| k as u16).collect()))
}

/// One of the lattices: durer's own, a table's, and that of a table of rows.
fn lattice(i: u64) -> Option<&'static NoiseTable> {
    [None, Some(table()), Some(rows())][(i % 3) as usize]
}

/// The value and the slopes of a point of the lattice.
fn point(table: Option<&NoiseTable>, p: [f64; 3]) -> [Dyadic; 4] {
    if table == Some(rows()) {
        let (slopes, [a, b]) = row_numbers();
        let [x, y, z] = p.map(|x| x.rem_euclid(2048.0) as usize);
        let number = (z + usize::from(b[(y + usize::from(a[x])) % 2048])) % 2048;
        let [gx, gy, gz] = slopes[number];
        return [0.0, gx, gy, gz].map(Dyadic::exact);
    }
    if table.is_some() {
        let (points, order) = numbers();
        let [x, y, z] = p.map(|x| (x + 10_000.0).rem_euclid(4096.0) as usize);
        let next = |k: usize| usize::from(order[k % 4096]);
        return points[next(next(next(x) ^ y) ^ z) % 256].map(Dyadic::exact);
    }
    let mut hash = 0_u32;
    for (x, step) in p.into_iter().zip(Own::STEP) {
        hash ^= (x.rem_euclid(4_294_967_296.0) as u32).wrapping_mul(step);
    }
    let hash = mixed(hash);
    let byte = |k: u32| f64::from(hash >> (8 * k) & 0xff);
    let g = |k: u32| (2.0 * byte(k) - 255.0) / 256.0;
    [(byte(0) - 132.0) / 256.0, g(1), g(2), g(3)].map(Dyadic::exact)
}

/// Noise and its derivatives, exactly.
fn exact(table: Option<&NoiseTable>, p: [f64; 3]) -> [Dyadic; 4] {
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
        let [v, g @ ..] = point(table, [0, 1, 2].map(|axis| whole[axis] + f64::from(bit(axis))));
        let from: [Dyadic; 3] = [0, 1, 2].map(|i| t[i].clone() - number(f64::from(bit(i))));
        let q = (0..3).fold(v, |q, i| q + g[i].clone() * from[i].clone());
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

/// Draws that only these tests need.
trait Draws {
    fn number(&mut self) -> f64;
}

impl Draws for TestRng {
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
    let mut dice = TestRng::new(1);
    for i in 0..40_000 {
        let table = lattice(i);
        let p = [dice.number(), dice.number(), dice.number()];
        let (v, d) = slants(table, F8::splats(p).each_ref());
        let told = [v, d[0], d[1], d[2]];
        for (told, exact) in told.iter().zip(exact(table, p)) {
            let e = size(table)
                * durer_math::U
                * f64::from(if *told == v { VALUE_ROUNDINGS } else { SLOPE_ROUNDINGS });
            // The true error is at most a quarter of the bound.
            let (lo, hi) = (told.0[0] - e / 4.0, told.0[0] + e / 4.0);
            assert!(is_within(&exact, lo, hi), "{p:?}: {told:?} {exact:?}");
        }
    }
}

/// The exact values of each table are checked above.
#[test]
fn the_components_of_a_vector_are_the_values_of_its_tables() {
    let (points, order) = numbers();
    let more = [1, 2].map(|by| core::array::from_fn(|i| points[(i + by) % points.len()]));
    let vector = VectorTable::shared([&points, &more[0], &more[1]], &order).unwrap();
    let mut dice = TestRng::new(79);
    let (mut one_cell, mut several) = (0, 0);
    for _ in 0..10_000 {
        let (size, from) = (dice.scale(-20, 20), dice.scale(-2, 40));
        let start = [0; 3].map(|_| dice.signed() * from);
        let p = start.map(|x| F8(core::array::from_fn(|_| x + dice.unit() * size)));
        let cells = |i: usize| p.each_ref().map(|x| x.0[i].floor());
        if (1..8).all(|i| cells(i) == cells(0)) {
            one_cell += 1;
        } else {
            several += 1;
        }
        let each = vector.components().map(|table| values(Some(table), p.each_ref()));
        assert_eq!(vector.values(p.each_ref()), each, "{p:?}");
    }
    assert!(one_cell > 1000 && several > 1000, "{one_cell} {several}");
}

fn size(table: Option<&NoiseTable>) -> f64 {
    table.map_or(1.0, NoiseTable::size)
}

/// Noise at eight equal points, of a cell and in it.
fn single<L: Lattice>(lattice: L, whole: [f64; 3], t: [f32; 3]) -> Sum<f32> {
    let along =
        [0, 1, 2].map(|i| Along::new([lattice.cell(whole[i], i); 8], &Eight::splat(t[i]), L::STEP[i]));
    Sum::of(&along, &Sum::corners(lattice, &along, &hashes(lattice, &along)))
}

/// In single precision, too, at points that it can represent: in the cells around the lattice's
/// point 0.
#[test]
fn single_precision_is_as_near_as_is_said() {
    let mut dice = TestRng::new(5);
    let mut worst = [0.0_f64; 2];
    for i in 0..40_000 {
        let table = lattice(i);
        let whole = [0, 1, 2].map(|_| (dice.bits() % 2) as f64 - 1.0);
        let t = [0, 1, 2].map(|_| (dice.unit() * [1.0, 1.0, 1e-9][(dice.bits() % 3) as usize]) as f32);
        let Sum { v, d } = with_lattice!(table, lattice => single(lattice, whole, t));
        // Sums with an integer are exact in f64 but for some small ones below zero, which then do
        // not count in f32.
        let exact = exact(table, [0, 1, 2].map(|i| whole[i] + f64::from(t[i])));
        for (k, (told, exact)) in [v, d[0], d[1], d[2]].iter().zip(&exact).enumerate() {
            let off = exact.clone() - Dyadic::exact(f64::from(told.0[0]));
            let off = off.abs().to_f64() / (size(table) * f64::from(<f32 as Real>::U));
            worst[usize::from(k > 0)] = worst[usize::from(k > 0)].max(off);
        }
    }
    // The true error is at most a quarter of the bound.
    assert!(
        worst[0] <= f64::from(VALUE_ROUNDINGS) / 4.0 && worst[1] <= f64::from(SLOPE_ROUNDINGS) / 4.0,
        "{worst:?}"
    );
    assert!(worst[0] >= 1.0 && worst[1] >= 1.0, "{worst:?}");
}

#[test]
fn pictures_of_noise_stay_what_they_are() {
    let at = |p: [f64; 3]| values(None, F8::splats(p).each_ref()).0[0];
    let known = [
        ([0.3, 0.7, 0.2], -0.4793344928000001),
        ([-5.25, 1e6 + 0.125, 77.5], 0.2862153649330139),
        ([2.5 * 4_294_967_296.0, 0.5, -0.5], 0.0361328125),
    ];
    for (p, value) in known {
        assert_eq!(at(p), value, "{p:?}");
    }
    // The lattice repeats after 2^32.
    assert_eq!(at([0.5 + 4_294_967_296.0, 0.5, 0.5]), at([0.5, 0.5, 0.5]));
    assert!(at([f64::INFINITY, 0.0, 0.0]).is_nan() && at([f64::MAX, f64::MIN, 1e300]).is_finite());
}

#[test]
fn bounds_hold_exact_values_and_rounded_ones() {
    let mut dice = TestRng::new(2);
    for i in 0..6_000 {
        let table = lattice(i);
        let any_size =
            |dice: &mut TestRng| [0.0, 1e-12, 1e-4, 1e-3, 0.05, 0.3, 1.0, 3.0][(dice.bits() % 8) as usize];
        let (is_mixed, mut size) = (dice.bits().is_multiple_of(2), any_size(&mut dice));
        let mut boxes = [I8::new(F8::ZERO, F8::ZERO); 3];
        for i in 0..8 {
            if is_mixed {
                size = any_size(&mut dice);
            }
            for x in &mut boxes {
                let lo = dice.number();
                x.set_lane(i, Interval { lo, hi: lo + size * dice.unit() });
            }
        }
        let (v, d) = slopes(table, boxes.each_ref());
        assert_eq!(v, bounds(table, boxes.each_ref()));
        for i in 0..8 {
            for _ in 0..2 {
                let k = [0.0, 1.0, dice.unit(), dice.unit()];
                let p = boxes.map(|x| {
                    let Interval { lo, hi } = x.lane(i);
                    (lo + (hi - lo) * k[(dice.bits() % 4) as usize]).clamp(lo, hi)
                });
                let (value, slope) = slants(table, F8::splats(p).each_ref());
                let told = [(v, value), (d[0], slope[0]), (d[1], slope[1]), (d[2], slope[2])];
                for ((bounds, rounded), exact) in told.into_iter().zip(exact(table, p)) {
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
    // The blend f(t), its first two derivatives, and the weights of two corners' slopes in a
    // derivative along their axis.
    let parts = |t: Interval| {
        let f = t.square() * (number(3.0) - two * t);
        let (d, dd) = (six * t * (one - t), six - number(12.0) * t);
        (d, dd, (one - f - d * t).abs() + (f - d * (one - t)).abs())
    };
    let piece = |k: u32, n: u32| Interval::new(f64::from(k) / f64::from(n), f64::from(k + 1) / f64::from(n));
    // The weighted distances from two corners are at most 1/2 together: so 1 for two pairs along
    // the other axes.
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
    // At most a hundredth too large.
    for (found, claimed) in [(slope, SLOPE), (bend, BEND), (twist, TWIST)] {
        assert!(found <= claimed && claimed <= 1.01 * found, "{found} {claimed}");
    }
}

#[test]
fn values_and_slopes_go_on_from_cell_to_cell() {
    let mut dice = TestRng::new(3);
    for i in 0..10_000 {
        let table = lattice(i);
        let mut p = [dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0];
        let axis = (dice.bits() % 3) as usize;
        p[axis] = p[axis].round();
        let at = |x: f64| {
            let mut p = p;
            p[axis] = x;
            slants(table, F8::splats(p).each_ref())
        };
        let ((a, da), (b, db)) = (at(p[axis].next_down()), at(p[axis].next_up()));
        let apart = p[axis].next_up() - p[axis].next_down();
        let size = size(table);
        let error = |roundings| 2.0 * durer_math::U * size * f64::from(roundings);
        assert!((a.0[0] - b.0[0]).abs() <= error(VALUE_ROUNDINGS) + SLOPE * size * apart);
        for (da, db) in da.iter().zip(&db) {
            assert!((da.0[0] - db.0[0]).abs() <= error(SLOPE_ROUNDINGS) + BEND * size * apart);
        }
    }
}

#[test]
fn corners_are_alike_and_know_nothing_of_each_other() {
    // The values at 64^3 lattice points, and at their neighbours along each direction.
    let corner = |p: [f64; 3]| {
        let (v, [x, y, z]) = slants(None, F8::splats(p).each_ref());
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
    // Uniform between -1/2 and 1/2, and between -1 and 1. With so many samples, means and
    // correlations are within 5 standard errors.
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
    let mut dice = TestRng::new(4);
    for (size, most, beside_large) in [
        (0.1, 3.0, false),
        (0.02, 2.0, false),
        (0.02, 2.0, true),
        (1e-4, 1.1, false),
        (1e-4, 1.1, true),
        (1e-6, 1.1, true),
    ] {
        let mut ratios: Vec<f64> = Vec::new();
        for _ in 0..200 {
            let lo = [dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0, dice.unit() * 40.0 - 20.0];
            let mut boxes = lo.map(|lo| I8::splat(Interval { lo, hi: lo + size }));
            if beside_large {
                boxes[0].set_lane(7, Interval { lo: lo[0], hi: lo[0] + 0.5 });
            }
            let v = bounds(None, boxes.each_ref()).lane(0);
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..125_u32 {
                let at = [k % 5, k / 5 % 5, k / 25].map(|k| f64::from(k) / 4.0 * size);
                let value = values(None, F8::splats([0, 1, 2].map(|i| lo[i] + at[i])).each_ref()).0[0];
                (least, greatest) = (least.min(value), greatest.max(value));
            }
            ratios.push((v.hi - v.lo) / (greatest - least));
        }
        ratios.sort_by(f64::total_cmp);
        assert!(
            ratios[0] >= 1.0 && ratios[100] < most,
            "{size}, beside a large one {beside_large}: {}",
            ratios[100]
        );
    }
}

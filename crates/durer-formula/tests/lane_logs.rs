//! Logarithms and powers of two in lanes keep their bounds against multi-precision values, with the
//! same bits on every path.

use astro_float::{BigFloat, Consts, RoundingMode};
use durer_formula::lane_logs::{EXP2_ERROR, LOG2_ERROR, exp2, log2, power, power_error};
use durer_formula::{I8, Number};
use durer_math::{F8, Interval, Isa, U};
use durer_testkit::TestRng;

const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, P)
}

/// `|a - b| / |b|`.
fn relative(a: f64, b: &BigFloat) -> f64 {
    if b.is_zero() {
        return if a == 0.0 { 0.0 } else { f64::INFINITY };
    }
    let difference = big(a).sub(b, P, RM).div(b, P, RM).abs();
    difference.to_string().parse().unwrap_or(f64::INFINITY)
}

fn on_all_paths(f: impl Fn(F8) -> F8 + Copy, x: F8) -> F8 {
    let definition = f(x);
    for isa in Isa::available() {
        let same = isa.run_in_lanes(
            #[inline(always)]
            || f(x),
        );
        assert_eq!(same.0.map(f64::to_bits), definition.0.map(f64::to_bits), "{isa:?} {x:?}");
    }
    definition
}

#[test]
fn logarithms_keep_their_bound() {
    let mut constants = Consts::new().unwrap();
    let (mut dice, mut worst) = (TestRng::new(1), 0.0_f64);
    let root = core::f64::consts::FRAC_1_SQRT_2;
    for _ in 0..600 {
        let x = F8(core::array::from_fn(|_| {
            let unit = dice.signed();
            match dice.bits() % 8 {
                0 => 1.0 + unit * durer_math::scale::pow2(-((dice.bits() % 53) as i32)),
                1 => root * (1.0 + unit * f64::EPSILON * 8.0),
                2 => 2.0 * root * (1.0 + unit * f64::EPSILON * 8.0),
                3 => (1.0 + unit.abs()) * durer_math::scale::pow2((dice.bits() % 2040) as i32 - 1020),
                4 => durer_math::scale::pow2((dice.bits() % 2040) as i32 - 1020),
                5 => (1.0 + unit.abs()) * durer_math::scale::pow2((dice.bits() % 8) as i32 - 4),
                _ => (0.5 + 0.5 * unit.abs()).max(f64::MIN_POSITIVE),
            }
            .abs()
            .max(f64::MIN_POSITIVE)
        }));
        let y = on_all_paths(log2, x);
        for i in 0..8 {
            let exact = big(x.0[i]).log2(P, RM, &mut constants);
            let error = relative(y.0[i], &exact);
            assert!(error <= LOG2_ERROR, "log2 {:e}: {:e}, off by {} u", x.0[i], y.0[i], error / U);
            worst = worst.max(error);
        }
    }
    println!("log2: at most {:.2} u", worst / U);
}

#[test]
fn powers_keep_their_bound() {
    let mut constants = Consts::new().unwrap();
    let (mut dice, mut worst) = (TestRng::new(2), 0.0_f64);
    for _ in 0..600 {
        let t = F8(core::array::from_fn(|_| {
            let unit = dice.signed();
            match dice.bits() % 6 {
                0 => unit * 1020.0,
                1 => unit * durer_math::scale::pow2(-((dice.bits() % 60) as i32)),
                2 => (unit * 40.0).round() + 0.5,
                3 => ((unit * 40.0).round() + 0.5).next_up(),
                4 => (unit * 1020.0).round(),
                _ => unit * 8.0,
            }
        }));
        let y = on_all_paths(exp2, t);
        for i in 0..8 {
            let ln2 = big(2.0).ln(2 * P, RM, &mut constants);
            let exact = big(t.0[i]).mul(&ln2, 2 * P, RM).exp(P, RM, &mut constants);
            let error = relative(y.0[i], &exact);
            assert!(error <= EXP2_ERROR, "2^{:e}: {:e}, off by {} u", t.0[i], y.0[i], error / U);
            worst = worst.max(error);
        }
    }
    println!("exp2: at most {:.2} u", worst / U);
}

#[test]
fn any_power_keeps_its_bound() {
    let mut constants = Consts::new().unwrap();
    let (mut dice, mut worst) = (TestRng::new(3), 0.0_f64);
    for _ in 0..800 {
        let p = match dice.bits() % 4 {
            0 => dice.signed() * 500.0,
            1 => dice.signed(),
            _ => dice.signed() * 10.0,
        };
        let x = F8(core::array::from_fn(|_| {
            let unit = dice.signed();
            match dice.bits() % 5 {
                0 => 1.0 + unit * durer_math::scale::pow2(-((dice.bits() % 53) as i32)),
                1 => (1.0 + unit.abs()) * durer_math::scale::pow2((dice.bits() % 1900) as i32 - 950),
                2 => durer_math::scale::pow2((dice.bits() % 40) as i32 - 20),
                _ => unit.abs().max(1e-9) * 4.0,
            }
            .abs()
            .max(1e-300)
        }));
        let y = on_all_paths(|x| power(x, F8::splat(p)).0, x);
        let t = power(x, F8::splat(p)).1;
        for i in (0..8).filter(|&i| t.0[i].abs() < 1010.0) {
            let exact =
                big(x.0[i]).ln(2 * P, RM, &mut constants).mul(&big(p), 2 * P, RM).exp(P, RM, &mut constants);
            let error = relative(y.0[i], &exact);
            assert!(error <= power_error(p), "{:e}^{p}: {:e}, off by {} u", x.0[i], y.0[i], error / U);
            worst = worst.max(error / power_error(p));
        }
    }
    println!("power: at most {worst:.3} of its bound");
}

/// Bases with every kind of end, exponents of every kind: the interval contains the exact powers,
/// and is not much wider than that of the scalar function.
#[test]
fn powers_of_intervals_hold_the_exact_ones() {
    let mut constants = Consts::new().unwrap();
    let mut dice = TestRng::new(4);
    for _ in 0..600 {
        let mut base = || {
            let unit = dice.signed();
            match dice.bits() % 8 {
                0 => 0.0,
                1 => 1.0,
                2 => durer_math::scale::ldexp(unit.abs(), -((dice.bits() % 1074) as i32)),
                3 => durer_math::scale::ldexp(unit.abs(), (dice.bits() % 1000) as i32),
                4 => -unit.abs(),
                _ => unit.abs() * 3.0,
            }
        };
        let ends: [(f64, f64); 8] = core::array::from_fn(|i| {
            let (a, b) = (base(), base());
            if i % 3 == 0 { (a, a) } else { (a.min(b), a.max(b)) }
        });
        let p = match dice.bits() % 5 {
            0 => dice.signed() * 700.0,
            1 => (dice.signed() * 9.0).round(),
            _ => dice.signed() * 6.0,
        };
        let q = if dice.bits().is_multiple_of(2) { p } else { p + dice.signed().abs() * 0.1 };
        let (a, b) = (I8::new(F8(ends.map(|e| e.0)), F8(ends.map(|e| e.1))), Interval::new(p, q));
        let y = <I8 as Number>::pow(&a, &I8::splat(b));
        for (i, (lo, hi)) in ends.into_iter().enumerate() {
            let (alone, _) = Interval::new(lo, hi).pow(b);
            let got = y.lane(i);
            assert_eq!(alone.is_empty(), got.is_empty(), "[{lo}, {hi}]^{b:?}: {got:?} {alone:?}");
            if lo > 1e-270 && hi < 1e270 && alone.lo > 1e-270 && alone.hi < 1e270 {
                let wider = |x: f64, y: f64| {
                    (x - y).abs() <= 2.0 * (power_error(p.abs().max(q.abs())) + 32.0 * U) * y.abs()
                };
                assert!(
                    wider(got.lo, alone.lo) && wider(got.hi, alone.hi),
                    "[{lo}, {hi}]^{b:?}: {got:?} {alone:?}"
                );
            }
            for (x, z) in [(lo, p), (hi, q), (lo, q), (hi, p), (0.5 * lo + 0.5 * hi, 0.5 * p + 0.5 * q)] {
                // The witness does not represent subnormal numbers exactly.
                if x < f64::MIN_POSITIVE || got.is_empty() {
                    continue;
                }
                let exact =
                    big(x).ln(2 * P, RM, &mut constants).mul(&big(z), 2 * P, RM).exp(P, RM, &mut constants);
                let below = got.lo == f64::NEG_INFINITY || big(got.lo).cmp(&exact).is_some_and(|o| o <= 0);
                let above = got.hi == f64::INFINITY || big(got.hi).cmp(&exact).is_some_and(|o| o >= 0);
                assert!(below && above, "{x:e}^{z} is not in {got:?}, of [{lo:e}, {hi:e}]^{b:?}");
            }
            // Zero to a positive power is zero.
            assert!(lo > 0.0 || hi < 0.0 || p <= 0.0 || got.contains(0.0), "[{lo}, {hi}]^{b:?}: {got:?}");
        }
    }
}

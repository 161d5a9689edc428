//! Logarithms and powers of two in lanes keep their bounds against multi-precision values, with the same bits on every path.

mod common;

use astro_float::{BigFloat, Consts, RoundingMode};
use common::Dice;
use durer_math::lane_logs::{EXP2_ERROR, LOG2_ERROR, exp2, log2};
use durer_math::{F8, Isa, U};

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
    let (mut dice, mut worst) = (Dice(1), 0.0_f64);
    let root = core::f64::consts::FRAC_1_SQRT_2;
    for _ in 0..600 {
        let x = F8(core::array::from_fn(|_| {
            let unit = dice.unit();
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
    let (mut dice, mut worst) = (Dice(2), 0.0_f64);
    for _ in 0..600 {
        let t = F8(core::array::from_fn(|_| {
            let unit = dice.unit();
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

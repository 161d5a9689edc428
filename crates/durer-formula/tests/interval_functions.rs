//! Intervals of elementary functions against multi-precision values, and the errors of the f64
//! functions.

#[path = "../../durer-math/tests/common/mod.rs"]
mod common;

use astro_float::{BigFloat, Consts, RoundingMode};
use common::{above, below, number, rat, wild};
use durer_formula::{Dual, Function, I8, Number};
use durer_math::interval::elementary::{Defined, Range, ULPS};
use durer_math::{F8, Interval, elementary};
use durer_testkit::TestRng;
use proptest::prelude::*;

/// Bits of the witness.
const P: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

/// Draws that only these tests need.
trait Draws {
    /// Numbers of all sizes up to `most`, near integers and near multiples of a quarter turn.
    fn number(&mut self, most: f64) -> f64;
}

impl Draws for TestRng {
    fn number(&mut self, most: f64) -> f64 {
        let quarter = core::f64::consts::FRAC_PI_2;
        let x = match self.bits() % 6 {
            0 => self.signed() * most,
            1 => self.signed() * most.min(4.0),
            2 => self.signed() * most * elementary::powi(0.5, (self.bits() % 200) as i32),
            3 => (self.signed() * most.min(20.0)).round(),
            4 => (self.signed() * most.min(40.0) / quarter).round() * quarter,
            _ => self.signed() * most.min(1.0),
        };
        match self.bits() % 4 {
            0 => x.next_up(),
            1 => x.next_down(),
            _ => x,
        }
        .clamp(-most, most)
    }
}

type Witness = fn(&BigFloat, &mut Consts) -> BigFloat;

/// A function as f64 computes it, on intervals, and exactly; and how large its argument may be.
struct Case {
    name: &'static str,
    f64: fn(f64) -> f64,
    interval: fn(Interval) -> Range,
    exact: Witness,
    least: f64,
    most: f64,
}

macro_rules! case {
    ($name:ident, $interval:expr, $exact:expr, $least:expr, $most:expr) => {
        Case {
            name: stringify!($name),
            f64: elementary::$name,
            interval: $interval,
            exact: $exact,
            least: $least,
            most: $most,
        }
    };
}

fn whole(x: Interval) -> Range {
    (x, Defined::Continuous)
}

fn cases() -> Vec<Case> {
    vec![
        case!(sin, |x| whole(x.sin()), |x, c| x.sin(P, RM, c), -1e6, 1e6),
        case!(cos, |x| whole(x.cos()), |x, c| x.cos(P, RM, c), -1e6, 1e6),
        case!(tan, Interval::tan, |x, c| x.tan(P, RM, c), -1e6, 1e6),
        case!(asin, Interval::asin, |x, c| x.asin(P, RM, c), -1.0, 1.0),
        case!(acos, Interval::acos, |x, c| x.acos(P, RM, c), -1.0, 1.0),
        case!(atan, |x| whole(x.atan()), |x, c| x.atan(P, RM, c), -1e9, 1e9),
        case!(sinh, |x| whole(x.sinh()), |x, c| x.sinh(P, RM, c), -700.0, 700.0),
        case!(cosh, |x| whole(x.cosh()), |x, c| x.cosh(P, RM, c), -700.0, 700.0),
        case!(tanh, |x| whole(x.tanh()), |x, c| x.tanh(P, RM, c), -40.0, 40.0),
        case!(asinh, |x| whole(x.asinh()), |x, c| x.asinh(P, RM, c), -1e9, 1e9),
        case!(acosh, Interval::acosh, |x, c| x.acosh(P, RM, c), 1.0, 1e9),
        case!(atanh, Interval::atanh, |x, c| x.atanh(P, RM, c), -0.999_999_999, 0.999_999_999),
        case!(exp, |x| whole(x.exp()), |x, c| x.exp(P, RM, c), -700.0, 700.0),
        case!(ln, Interval::ln, |x, c| x.ln(P, RM, c), 1e-300, 1e300),
        case!(log10, Interval::log10, |x, c| x.log10(P, RM, c), 1e-300, 1e300),
    ]
}

fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, P)
}

fn holds(x: Interval, y: &BigFloat) -> bool {
    (x.lo == f64::NEG_INFINITY || big(x.lo).cmp(y).is_some_and(|o| o <= 0))
        && (x.hi == f64::INFINITY || big(x.hi).cmp(y).is_some_and(|o| o >= 0))
}

/// `|a - b|` in ulp of `a`.
fn ulps(a: f64, b: &BigFloat) -> f64 {
    let ulp = (a.abs().next_up() - a.abs()).max(f64::MIN_POSITIVE * f64::EPSILON);
    let difference = big(a).sub(b, P, RM).div(&big(ulp), P, RM).abs();
    difference.to_string().parse().unwrap_or(f64::INFINITY)
}

#[test]
fn intervals_hold_the_exact_values() {
    let mut constants = Consts::new().unwrap();
    for case in cases() {
        let mut dice = TestRng::new(case.name.len() as u64);
        let mut worst = 0.0_f64;
        for _ in 0..1000 {
            let draw = |dice: &mut TestRng| dice.number(case.most.min(1e9)).clamp(case.least, case.most);
            let (a, b) = (draw(&mut dice), draw(&mut dice));
            let wide = if dice.bits().is_multiple_of(2) { b } else { a + (b - a) * 1e-3 };
            let box_ = Interval::new(a.min(wide), a.max(wide));
            let (range, _) = (case.interval)(box_);
            for x in [box_.lo, box_.hi, box_.mid(), box_.lo + box_.width() * 0.3 * dice.signed().abs()] {
                if !box_.contains(x) {
                    continue;
                }
                let exact = (case.exact)(&big(x), &mut constants);
                assert!(
                    holds(range, &exact),
                    "{} of {x:e}: {exact} not in {range:?}, of {box_:?}",
                    case.name
                );
                let value = (case.f64)(x);
                assert!(range.contains(value), "{} of {x:e}: {value} not in {range:?}", case.name);
                let (thin, _) = (case.interval)(Interval::from(x));
                assert!(holds(thin, &exact) && range.encloses(thin), "{} of {x:e}: {thin:?}", case.name);
                worst = worst.max(ulps(value, &exact));
            }
        }
        println!("{}: at most {worst:.3} ulp", case.name);
        assert!(worst <= ULPS / 2.0, "{}: {worst} ulp", case.name);
    }
}

#[test]
fn powers_and_angles_hold_the_exact_values() {
    let mut constants = Consts::new().unwrap();
    let mut dice = TestRng::new(77);
    let mut worst = 0.0_f64;
    for _ in 0..2000 {
        let (x, y) = (dice.number(50.0).abs(), dice.number(20.0));
        // The witness does not represent subnormal numbers exactly.
        if x < f64::MIN_POSITIVE {
            continue;
        }
        let exact = big(x).ln(2 * P, RM, &mut constants).mul(&big(y), 2 * P, RM).exp(P, RM, &mut constants);
        let reach = dice.signed().abs() * 0.1;
        let (a, b) =
            (Interval::new(x * (1.0 - reach), x * (1.0 + reach)), Interval::new(y - reach, y + reach));
        let (range, _) = a.pow(b);
        assert!(holds(range, &exact) && range.contains(elementary::pow(x, y)), "{x}^{y}: {range:?}");
        let (thin, _) = Interval::from(x).pow(Interval::from(y));
        assert!(holds(thin, &exact), "{x}^{y}: {thin:?}");
        if elementary::pow(x, y).is_normal() {
            worst = worst.max(ulps(elementary::pow(x, y), &exact));
        }
        // The angle of (u, v) is that of the quotient, turned.
        let (u, v) = (dice.number(10.0), dice.number(10.0));
        if u == 0.0 || v == 0.0 {
            continue;
        }
        let mut angle = big(v).div(&big(u), P, RM).atan(P, RM, &mut constants);
        if u < 0.0 {
            let pi = constants.pi(P, RM);
            angle = if v > 0.0 { angle.add(&pi, P, RM) } else { angle.sub(&pi, P, RM) };
        }
        let (a, b) = (Interval::new(v - reach, v + reach), Interval::new(u - reach, u + reach));
        let (range, _) = a.atan2(b);
        assert!(holds(range, &angle), "atan2({v}, {u}) within {reach}: {angle} not in {range:?}");
        // The packet version is as narrow.
        let lanes = I8::atan2(&I8::splat(a), &I8::splat(b)).lane(3);
        assert!(holds(lanes, &angle), "atan2({v}, {u}) within {reach}: {angle} not in {lanes:?}");
        let same = |x: f64, y: f64| (x - y).abs() <= 32.0 * f64::EPSILON * y.abs();
        assert!(same(lanes.lo, range.lo) && same(lanes.hi, range.hi), "{a:?} {b:?}: {lanes:?} {range:?}");
        // The witness does not represent subnormal numbers exactly.
        if !u.is_normal() || !v.is_normal() {
            continue;
        }
        let thin = I8::atan2(&I8::splat(Interval::from(v)), &I8::splat(Interval::from(u))).lane(7);
        assert!(
            holds(thin, &angle)
                && thin.width() <= 64.0 * f64::EPSILON * elementary::atan2(v, u).abs() + 1e-300,
            "{thin:?}"
        );
    }
    assert!(worst <= ULPS / 2.0, "pow: {worst} ulp");
}

/// Each lane encloses the f64 values of points in its boxes; where f64 gives NaN the lane is marked
/// as partly undefined.
#[test]
fn lanes_hold_the_values_of_points() {
    let mut dice = TestRng::new(5);
    let functions = [
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Asin,
        Function::Acos,
        Function::Atan,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Asinh,
        Function::Acosh,
        Function::Atanh,
        Function::Exp,
        Function::Ln,
        Function::Log10,
        Function::Floor,
        Function::Ceil,
        Function::Trunc,
    ];
    for _ in 0..20_000 {
        let mut draw = || {
            let (mut lo, mut hi) = (F8::ZERO, F8::ZERO);
            for i in 0..8 {
                let a = dice.number(30.0);
                let b = match dice.bits() % 4 {
                    0 => a,
                    1 => dice.number(30.0),
                    2 => a + dice.signed() * 1e-6,
                    _ => 0.0,
                };
                (lo.0[i], hi.0[i]) = (a.min(b), a.max(b));
            }
            I8::new(lo, hi)
        };
        let (a, b, c) = (draw(), draw(), draw());
        let point = |x: &I8, i: usize, k: f64| {
            let v = x.lo.0[i] + (x.hi.0[i] - x.lo.0[i]) * k;
            v.clamp(x.lo.0[i], x.hi.0[i])
        };
        let check = |what: &str, out: &I8, f: &dyn Fn(f64, f64, f64) -> f64| {
            for i in 0..8 {
                for k in [0.0, 0.3, 1.0] {
                    let (x, y, z) = (point(&a, i, k), point(&b, i, 1.0 - k), point(&c, i, k));
                    let value = f(x, y, z);
                    if value.is_nan() {
                        assert!(out.partial >> i & 1 == 1, "{what}({x}, {y}, {z}) is undefined, {out:?}");
                    } else {
                        let range = out.lane(i);
                        assert!(range.contains(value), "{what}({x}, {y}, {z}) = {value} not in {range:?}");
                    }
                }
            }
        };
        check("+", &I8::add(&a, &b), &|x, y, _| x + y);
        check("-", &I8::sub(&a, &b), &|x, y, _| x - y);
        check("*", &I8::mul(&a, &b), &|x, y, _| x * y);
        check("/", &I8::div(&a, &b), &|x, y, _| f64::div(&x, &y));
        check("neg", &I8::neg(&a), &|x, _, _| -x);
        check("sqr", &I8::sqr(&a), &|x, _, _| x * x);
        check("abs", &I8::abs(&a), &|x, _, _| x.abs());
        check("sqrt", &I8::sqrt(&a), &|x, _, _| x.sqrt());
        check("min", &<I8 as Number>::min(&a, &b), &|x, y, _| x.min(y));
        check("max", &<I8 as Number>::max(&a, &b), &|x, y, _| x.max(y));
        check("rem", &I8::rem(&a, &b), &|x, y, _| x % y);
        check("atan2", &I8::atan2(&a, &b), &|y, x, _| <f64 as Number>::atan2(&y, &x));
        check("pow", &I8::pow(&a, &b), &|x, y, _| <f64 as Number>::pow(&x, &y));
        for n in [-3, -2, -1, 3, 4, 5, 7] {
            check("powi", &I8::powi(&a, n), &|x, _, _| <f64 as Number>::powi(&x, n));
        }
        check("select", &I8::select(&a, &b, &c, &a), &|x, y, z| f64::select(&x, &y, &z, &x));
        for comparison in [
            durer_formula::Comparison::Less,
            durer_formula::Comparison::LessEqual,
            durer_formula::Comparison::Equal,
            durer_formula::Comparison::NotEqual,
            durer_formula::Comparison::And,
            durer_formula::Comparison::Or,
        ] {
            check("compare", &I8::compare(comparison, &a, &b), &|x, y, _| f64::compare(comparison, &x, &y));
        }
        for function in functions {
            check("function", &I8::function(function, &a), &|x, _, _| f64::function(function, &x));
        }
    }
}

/// Remainders of numbers are single numbers, and an interval that contains no integer multiple, or
/// only at its lower end, has the remainders of its ends.
#[test]
fn remainders_are_those_of_the_ends() {
    let mut dice = TestRng::new(41);
    let mut exact = 0;
    for _ in 0..200_000 {
        let (a, b) = (dice.number(60.0), dice.number(8.0).abs());
        let wide = if dice.bits().is_multiple_of(3) { 0.0 } else { dice.signed().abs() * b * 1.5 };
        let (x, y) = (Interval { lo: a, hi: a + wide }, Interval { lo: b, hi: b });
        if b == 0.0 {
            continue;
        }
        let (told, defined) = x.remainder(y);
        for k in [0.0, 0.25, 0.5, 1.0] {
            let inside = (x.lo + (x.hi - x.lo) * k).clamp(x.lo, x.hi);
            // The remainder of an f64 is exact.
            assert!(told.contains(inside % b), "{inside} of {x:?} mod {b}: {told:?}");
        }
        // The same integer quotient at both ends, by exact arithmetic; an interval as wide as b
        // within rounding may be left out.
        let whole = |x: f64| (rat(x) / rat(b)).trunc();
        let of_one_sign = x.lo >= 0.0 || x.hi <= 0.0;
        if of_one_sign && whole(x.lo) == whole(x.hi) && x.hi - x.lo < b {
            exact += 1;
            assert_eq!(
                (told.lo, told.hi, defined),
                (x.lo % b, x.hi % b, Defined::Continuous),
                "{x:?} mod {b}"
            );
        }
    }
    assert!(exact > 50_000, "{exact}");
}

proptest! {
    #![proptest_config(common::cases(4000))]

    /// Products with a constant keep a sign that underflow loses, and are as narrow as those of two
    /// intervals; so are their derivatives.
    #[test]
    fn products_with_a_constant_hold_the_exact_ones(k in prop_oneof![number(), wild()], x in prop_oneof![number(), wild()], y in prop_oneof![number(), wild()]) {
        prop_assume!(k != 0.0);
        let a = Interval { lo: x.min(y), hi: x.max(y) };
        let told = I8::times(k, &I8::splat(a)).lane(3);
        for x in [a.lo, a.hi] {
            let exact = rat(k) * rat(x);
            prop_assert!(below(told.lo, &exact) && above(told.hi, &exact), "{k} {a:?}: {told:?}");
        }
        let ends = [told.lo, told.hi];
        prop_assert!(!(a.lo >= 0.0 || a.hi <= 0.0) || ends[0] >= 0.0 || ends[1] <= 0.0, "{k} {a:?}: {told:?}");
        let general = I8::mul(&I8::splat(k.into()), &I8::splat(a)).lane(3);
        prop_assert_eq!(ends, [general.lo, general.hi]);
        let dual = Dual::<I8>::times(k, &Dual { v: I8::splat(k.into()), d: I8::splat(a) });
        prop_assert_eq!(dual.d.lane(3), told);
        prop_assert_eq!(dual.v, I8::times(k, &I8::splat(k.into())));
    }
}

//! Double-double and running error against exact rationals: every bound holds, and none is vacuous.
#![allow(missing_docs, reason = "a test program")]

mod common;
use common::*;
use dashu::rational::RBig;
use durer_math::efloat::Word;
use durer_math::ladder::{self, Predicate, Step};
use durer_math::{Dd, Dyadic, EFloat, Ring, U};
use proptest::prelude::*;

fn exact(x: Dd) -> RBig {
    rat(x.hi) + rat(x.lo)
}

/// Any double-double whose high part is near 2^-40..2^40.
fn double_double() -> impl Strategy<Value = Dd> {
    (scaled(40), scaled(1), 53..110_i32)
        .prop_map(|(hi, m, k)| Dd::new(hi, hi * durer_math::scale::ldexp(m, -k) * 0.5))
}

/// `|x - truth| <= n u^2 |truth|`.
fn relative(x: Dd, truth: &RBig, n: u32) -> bool {
    abs(exact(x) - truth) <= rat(f64::from(n) * U * U) * abs(truth.clone())
}

fn normal(x: Dd) -> bool {
    x.hi + x.lo == x.hi
}

trait Exact: Word {
    fn exact(self) -> RBig;
    fn finite(self) -> bool;
}

impl Exact for f64 {
    fn exact(self) -> RBig {
        rat(self)
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl Exact for Dd {
    fn exact(self) -> RBig {
        exact(self)
    }
    fn finite(self) -> bool {
        self.hi.is_finite() && self.lo.is_finite()
    }
}

fn bounds<T: Exact>(x: EFloat<T>, truth: &RBig) -> bool {
    // A negative or NaN bound with a finite value would be a lie of its own.
    let known = x.v.finite() && x.e.is_finite();
    (!known || (x.e >= 0.0 && within(&x.v.exact(), truth, x.e)))
        && below(x.lo(), truth)
        && above(x.hi(), truth)
        && x.sign().is_none_or(|s| s == truth.cmp(&RBig::ZERO))
        && (x.magnitude() == f64::INFINITY || rat(x.magnitude()) >= abs(truth.clone()))
}

/// An uncertain number and a true one within its error.
fn uncertain() -> impl Strategy<Value = (f64, f64, RBig)> {
    let error = prop_oneof![Just(0.0), (0..60_i32).prop_map(|k| durer_math::scale::ldexp(1.0, -k)), wild()];
    (number(), error, -4..=4_i32).prop_map(|(x, r, s)| {
        let e = if r == 0.0 { 0.0 } else { (x * r).abs().min(f64::MAX) };
        let truth = rat(x) + rat(e) * RBig::from(s) / RBig::from(4);
        (x, e, truth)
    })
}

#[derive(Clone, Copy, Debug)]
enum Op {
    Add,
    Sub,
    Mul,
    Div,
    Square,
    Scale(i32),
    Neg,
}

fn op() -> impl Strategy<Value = Op> {
    prop_oneof![
        4 => Just(Op::Add),
        4 => Just(Op::Sub),
        6 => Just(Op::Mul),
        2 => Just(Op::Div),
        1 => Just(Op::Square),
        1 => (-40..40_i32).prop_map(Op::Scale),
        1 => (-1200..1200_i32).prop_map(Op::Scale),
        1 => Just(Op::Neg),
    ]
}

fn pow2(k: i32) -> RBig {
    let two = RBig::from(2).pow(k.unsigned_abs() as isize);
    if k >= 0 { two } else { RBig::from(1) / two }
}

/// Runs a little stack machine in `T` and in rationals; every intermediate result must keep its
/// promise.
fn programme<T: Exact>(inputs: &[(f64, f64, RBig)], ops: &[(Op, usize, usize)]) -> Result<(), TestCaseError> {
    let mut stack: Vec<(EFloat<T>, RBig)> = inputs
        .iter()
        .map(|(x, e, truth)| (EFloat::within(*x, *e).expect("runs hold errors"), truth.clone()))
        .collect();
    for &(op, i, j) in ops {
        let (a, x) = stack[i % stack.len()].clone();
        let (b, y) = stack[j % stack.len()].clone();
        let (result, truth) = match op {
            Op::Add => (a + b, x + y),
            Op::Sub => (a - b, x - y),
            Op::Mul => (a * b, x * y),
            Op::Div if y.is_zero() => continue,
            Op::Div => (a / b, x / y),
            Op::Square => (a.square(), &x * &x),
            Op::Scale(k) => (a.scale2(k), x * pow2(k)),
            Op::Neg => (-a, -x),
        };
        prop_assert!(bounds(result, &truth), "{op:?} {a:?} {b:?} = {result:?}");
        stack.push((result, truth));
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn double_double_keeps_its_published_bounds(a in double_double(), b in double_double()) {
        let (x, y) = (exact(a), exact(b));
        for (result, truth, n) in [(a + b, &x + &y, 4), (a - b, &x - &y, 4), (a * b, &x * &y, 4), (a / b, &x / &y, 16)] {
            prop_assert!(relative(result, &truth, n), "{a:?} {b:?} {result:?}");
            prop_assert!(normal(result));
        }
        prop_assert!(relative(a * b.hi, &(&x * rat(b.hi)), 2));
        let root = exact(a.abs().sqrt());
        // |r^2 - x| <= 2 * 25/8 u^2 x and a little more.
        prop_assert!(abs(&root * &root - abs(x.clone())) <= rat(7.0 * U * U) * abs(x.clone()));
        prop_assert_eq!(a.partial_cmp(&b), x.partial_cmp(&y));
        prop_assert_eq!(exact(a.scale2(7)), x * RBig::from(128));
    }

    /// As above, with the constants that [`EFloat`] charges, which must not be smaller.
    #[test]
    fn running_errors_of_full_double_doubles_hold(a in double_double(), b in double_double()) {
        let (x, y) = (exact(a), exact(b));
        let (p, q) = (EFloat::with_error(a, 0.0), EFloat::with_error(b, 0.0));
        for (result, truth) in [(p + q, &x + &y), (p - q, &x - &y), (p * q, &x * &y), (p / q, &x / &y), (p.square(), &x * &x)] {
            prop_assert!(bounds(result, &truth), "{a:?} {b:?} {result:?}");
        }
    }

    #[test]
    fn nearly_opposite_double_doubles_still_subtract_well(a in double_double(), k in -3..=3_i32) {
        let b = Dd::new(a.hi, nudge(a.lo, k));
        prop_assert!(relative(a - b, &(exact(a) - exact(b)), 4));
    }

    #[test]
    fn running_errors_hold(
        inputs in prop::collection::vec(uncertain(), 2..5),
        ops in prop::collection::vec((op(), 0..20_usize, 0..20_usize), 1..8),
    ) {
        programme::<f64>(&inputs, &ops)?;
        programme::<Dd>(&inputs, &ops)?;
    }

    #[test]
    fn running_roots_hold((x, e, truth) in uncertain()) {
        fn check<T: Exact>(x: f64, e: f64, truth: &RBig) -> bool {
            let r = EFloat::<T>::within(x, e).expect("runs hold errors").sqrt();
            if *truth < RBig::ZERO {
                return true;
            }
            let square = |x: f64| rat(x) * rat(x);
            let (lo, hi) = (r.lo(), r.hi());
            (lo <= 0.0 || square(lo) <= *truth) && (hi == f64::INFINITY || (hi >= 0.0 && square(hi) >= *truth))
        }
        prop_assert!(check::<f64>(x, e, &truth), "{x:e} {e:e}");
        prop_assert!(check::<Dd>(x, e, &truth), "{x:e} {e:e}");
    }

    /// Each operation's bound is the first-order one and hardly more.
    #[test]
    fn running_errors_are_tight(a in scaled(40), b in scaled(40), ka in 10..60_i32, kb in 10..60_i32) {
        let error = |x: f64, k: i32| x.abs() * durer_math::scale::ldexp(1.0, -k);
        let (ea, eb) = (error(a, ka), error(b, kb));
        let (x, y) = (EFloat::with_error(a, ea), EFloat::with_error(b, eb));
        let tight = |e: f64, ideal: f64| e <= ideal * (1.0 + 1e-12);
        prop_assert!(tight((x + y).e, ea + eb + U * (a + b).abs()));
        prop_assert!(tight((x - y).e, ea + eb + U * (a - b).abs()));
        prop_assert!(tight((x * y).e, a.abs() * eb + ea * (b.abs() + eb) + U * (a * b).abs()));
        prop_assert!(tight(x.square().e, ea * (2.0 * a.abs() + ea) + U * a * a));
        let q = (a / b).abs();
        prop_assert!(tight((x / y).e, (ea + q * eb) / (b.abs() - eb) + U * q));
        let (s, r) = (x.abs().sqrt(), a.abs().sqrt());
        prop_assert!(tight(s.e, ea / (r + (a.abs() - ea).sqrt()) + U * r));
        // In double-double exact inputs leave errors of a few u^2.
        let (x, y) = (EFloat::<Dd>::exact(a), EFloat::<Dd>::exact(b));
        prop_assert!((x * y).e <= 4.01 * U * U * (a * b).abs());
        prop_assert!((x + y).e <= 3.01 * U * U * (a + b).abs());
        prop_assert!((x / y).e <= 15.01 * U * U * q);
    }

    #[test]
    fn the_ladder_is_always_right(a in number(), b in number(), c in number()) {
        let truth = rat(b) * rat(b) - rat(a) * rat(c);
        prop_assert_eq!(ladder::sign(&Discriminant { a, b, c, error: 0.0 }), Some(truth.cmp(&RBig::ZERO)));
    }

    #[test]
    fn the_ladder_sees_through_ties(x in 1..1_000_000_i32, y in 1..1_000_000_i32, k in -1..=1_i32) {
        // b^2 = a c exactly, up to a nudge of b by one ulp.
        let (x, y) = (f64::from(x), f64::from(y));
        let p = Discriminant { a: x * x, b: nudge(x * y, k), c: y * y, error: 0.0 };
        prop_assert_eq!(ladder::sign(&p), Some(k.cmp(&0)));
    }
}

struct Discriminant {
    a: f64,
    b: f64,
    c: f64,
    error: f64,
}

impl Predicate for Discriminant {
    fn eval<T: Ring>(&self) -> Option<T> {
        Some(T::within(self.b, self.error)?.square() - T::exact(self.a) * T::exact(self.c))
    }
}

#[test]
fn each_step_of_the_ladder_is_needed() {
    let step = |a, b, c| ladder::sign_and_step(&Discriminant { a, b, c, error: 0.0 });
    assert_eq!(step(1.0, 3.0, 4.0).map(|x| x.1), Some(Step::Double));
    // (1 + h)^2 against 1 + 2 h: they differ by h^2 = 2^-80.
    let h = durer_math::scale::pow2(-40);
    assert_eq!(step(1.0, 1.0 + h, 1.0 + 2.0 * h).map(|x| x.1), Some(Step::DoubleDouble));
    assert_eq!(step(0.1, 0.1, 0.1), Some((core::cmp::Ordering::Equal, Step::Exact)));
    assert_eq!(step(1e-300, 1e-300, 1e-300), Some((core::cmp::Ordering::Equal, Step::Exact)));
    assert_eq!(step(1e300, 1e300, 1e300), Some((core::cmp::Ordering::Equal, Step::Exact)));
    let open = Discriminant { a: 1.0, b: 2.0, c: 4.0, error: 1e-9 };
    assert_eq!(ladder::sign(&open), None);
    let clear = Discriminant { a: 1.0, b: 2.0, c: 3.9, error: 1e-9 };
    assert_eq!(ladder::sign(&clear), Some(core::cmp::Ordering::Greater));
}

#[test]
fn a_zero_factor_gives_an_exact_zero() {
    let zero = EFloat::<f64>::exact(0.0);
    let x = EFloat::with_error(0.3, 0.1);
    assert_eq!((zero * x).sign(), Some(core::cmp::Ordering::Equal));
    assert_eq!((zero / x).sign(), Some(core::cmp::Ordering::Equal));
    // An underflow to zero is not one.
    let tiny = EFloat::<f64>::exact(1e-200);
    assert_eq!((tiny * tiny).sign(), None);
    assert!((tiny * tiny).hi() > 0.0);
}

#[test]
fn unknown_numbers_know_nothing() {
    let one = EFloat::<f64>::exact(1.0);
    let unknown = one / EFloat::with_error(0.5, 0.5);
    assert_eq!((unknown.lo(), unknown.hi(), unknown.sign()), (f64::NEG_INFINITY, f64::INFINITY, None));
    let over = EFloat::<Dd>::exact(1e300).square();
    assert_eq!((over.lo(), over.hi(), over.sign()), (f64::NEG_INFINITY, f64::INFINITY, None));
    let negative = EFloat::<f64>::exact(-1.0).sqrt();
    assert_eq!((negative.lo(), negative.hi(), negative.sign()), (f64::NEG_INFINITY, f64::INFINITY, None));
}

/// Over a sum of eight products the bound is not much larger than the error it bounds.
#[test]
fn the_median_bound_is_close_to_the_error() {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * U * 2.0 - 1.0
    };
    let mut ratios: Vec<f64> = (0..2000)
        .filter_map(|_| {
            let pairs: Vec<(f64, f64)> = (0..8).map(|_| (random(), random())).collect();
            let zero = (EFloat::<f64>::exact(0.0), RBig::ZERO);
            let (sum, truth) = pairs
                .iter()
                .fold(zero, |(s, t), &(a, b)| (s + EFloat::exact(a) * EFloat::exact(b), t + rat(a) * rat(b)));
            let actual = abs(rat(sum.v) - truth).to_f64_fast();
            (actual > 0.0).then(|| sum.e / actual)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    assert!(ratios[0] >= 1.0 && median < 16.0, "median bound is {median} times the error");
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn dyadics_are_exact(a in number(), b in number(), c in number(), k in -3000..3000_i32) {
        let value = |x: &Dyadic| {
            // Read back through Debug, an independent path: sign, hexadecimal digits, exponent.
            let text = format!("{x:?}");
            let (negative, text) = text.strip_prefix('-').map_or((false, text.as_str()), |t| (true, t));
            let (digits, exponent) = text.strip_prefix("0x").and_then(|t| t.split_once('p')).expect("0x..p..");
            let m = dashu::integer::IBig::from_str_radix(digits, 16).expect("hexadecimal");
            let r = RBig::from(m) * pow2(exponent.parse().expect("a number"));
            if negative { -r } else { r }
        };
        let [x, y, z] = [a, b, c].map(Dyadic::from);
        let [p, q, r] = [a, b, c].map(rat);
        let u = &(&x * &y) - &z;
        let truth = &p * &q - &r;
        prop_assert_eq!(value(&u), truth.clone());
        prop_assert_eq!(value(&(&x + &y)), &p + &q);
        prop_assert_eq!(value(&(&u * &(&x + &z))), &truth * (&p + &r));
        prop_assert_eq!(u.exact_sign(), truth.cmp(&RBig::ZERO));
        prop_assert_eq!(x.cmp(&y), p.cmp(&q));
        prop_assert_eq!(u.cmp(&y), truth.cmp(&q));
        prop_assert_eq!(value(&-u.clone()), -truth.clone());
        prop_assert_eq!(value(&u.clone().scale2(k)), &truth * pow2(k));
        prop_assert_eq!(&(&u - &u), &Dyadic::ZERO);
        prop_assert_eq!(&(&u + &z), &(&x * &y));
        for modulus in [3_u64, 1_000_003, (1 << 61) - 1, (1 << 63) - 25] {
            let of = |x: &Dyadic| u128::from(x.residue(modulus));
            let m = u128::from(modulus);
            prop_assert_eq!(of(&u), (of(&x) * of(&y) + m - of(&z)) % m);
            prop_assert_eq!((of(&u) + of(&-u.clone())) % m, 0);
            prop_assert_eq!(of(&u.clone().scale2(k).scale2(1)), 2 * of(&u.clone().scale2(k)) % m);
            prop_assert_eq!(of(&Dyadic::from(c.abs().min(1e15).trunc())), c.abs().min(1e15).trunc() as u128 % m);
        }
        if let Some(e) = u.lowest_bit() {
            let odd = value(&u) * pow2(-(e as i32));
            prop_assert!(odd.is_int() && !(odd * pow2(-1)).is_int());
        }
        prop_assert_eq!(x.to_f64(), a);
        let (lo, hi) = u.to_bounds();
        prop_assert!(below(lo, &truth) && above(hi, &truth) && (lo == hi || lo.next_up() == hi));
        let near = u.to_f64();
        prop_assert!(near == lo || near == hi);
        if lo.is_finite() && hi.is_finite() && lo != hi {
            let (left, right) = (&truth - rat(lo), rat(hi) - &truth);
            let even = |x: f64| x.to_bits() & 1 == 0;
            let nearest = match left.cmp(&right) {
                core::cmp::Ordering::Less => near == lo,
                core::cmp::Ordering::Greater => near == hi,
                core::cmp::Ordering::Equal => even(near),
            };
            prop_assert!(nearest);
        }
    }
}

/// A bound far above what underflow loses must still grow by it: `e + 2^-1070` rounds to `e`.
#[test]
fn scaling_into_the_subnormals_widens_a_large_bound() {
    let (v, e) = (1.828_245_992_610_490_4, 2_179_652_282_933.859_9);
    let scaled = EFloat::<f64>::with_error(v, e).scale2(-1023);
    let edge = (rat(v) - rat(e)) * pow2(-1023);
    assert!(within(&rat(scaled.v), &edge, scaled.e));
}

/// Underflow inside a bound, just before a division by a tiny number; and a scaling that overflows.
#[test]
fn bounds_survive_the_ends_of_the_exponent_range() {
    let q = EFloat::<f64>::exact(-5e-324) / EFloat::with_error(2.5e-323, 1e-323);
    assert!(within(&rat(q.v), &(rat(-5e-324) / rat(1.5e-323)), q.e));
    let over = EFloat::<f64>::exact(3.0).scale2(1023);
    assert_eq!((over.sign(), over.hi()), (None, f64::INFINITY));
    assert_eq!((EFloat::exact(0.5) / over).hi(), f64::INFINITY);
}

//! Exact witnesses and generators of hard cases, shared by the tests.
#![allow(dead_code, reason = "each test program uses its own part")]

use dashu::rational::RBig;
use proptest::prelude::*;

/// `n` cases, times the variable `DURER_SOAK` if it is set, without files of past failures: a
/// failure worth keeping becomes a test with a name.
pub(crate) fn cases(n: u32) -> ProptestConfig {
    let soak = std::env::var("DURER_SOAK").ok().and_then(|x| x.parse().ok()).unwrap_or(1);
    ProptestConfig { cases: n.saturating_mul(soak), failure_persistence: None, ..ProptestConfig::default() }
}

/// `x` as a rational number; `x` must be finite.
pub(crate) fn rat(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

pub(crate) fn abs(x: RBig) -> RBig {
    if x < RBig::ZERO { -x } else { x }
}

/// Whether `|x - truth| <= e`. A bound that is infinite or NaN holds always.
pub(crate) fn within(x: &RBig, truth: &RBig, e: f64) -> bool {
    !e.is_finite() || abs(x - truth) <= rat(e)
}

/// `x <= truth`, where `x` may be infinite.
pub(crate) fn below(x: f64, truth: &RBig) -> bool {
    x == f64::NEG_INFINITY || (x.is_finite() && rat(x) <= *truth)
}

pub(crate) fn above(x: f64, truth: &RBig) -> bool {
    x == f64::INFINITY || (x.is_finite() && rat(x) >= *truth)
}

/// Any finite f64, subnormals and both zeros included: all exponents are equally likely.
pub(crate) fn wild() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())
}

/// Numbers with exponents within `[-e, e]` and full mantissas.
pub(crate) fn scaled(e: i32) -> impl Strategy<Value = f64> {
    (any::<bool>(), 1.0..2.0_f64, -e..=e).prop_map(|(negative, m, k)| {
        let x = durer_math::scale::ldexp(m, k);
        if negative { -x } else { x }
    })
}

/// Small integers and halves, which make exact ties.
pub(crate) fn small() -> impl Strategy<Value = f64> {
    (-8..=8).prop_map(|i| f64::from(i) * 0.5)
}

/// Numbers of all these kinds, and neighbours of simple ones.
pub(crate) fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => small(),
        4 => scaled(40),
        2 => (small(), -3..=3_i32).prop_map(|(x, k)| nudge(x, k)),
        1 => scaled(300),
        1 => wild(),
    ]
}

/// `x`, moved by `k` ulps.
pub(crate) fn nudge(x: f64, k: i32) -> f64 {
    (0..k.abs()).fold(x, |x, _| if k > 0 { x.next_up() } else { x.next_down() })
}

/// Three of them.
pub(crate) fn triple(x: impl Strategy<Value = f64> + 'static) -> impl Strategy<Value = [f64; 3]> {
    let x = x.boxed();
    [x.clone(), x.clone(), x]
}

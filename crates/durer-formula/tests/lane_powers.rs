//! Powers of eight intervals contain the exact powers of their numbers, whatever their signs and
//! sizes, and are narrow.

use durer_formula::{I8, Number};
use durer_math::{Dyadic, F8, Interval, Ring};
use durer_testkit::TestRng;

/// Numbers of either sign, from 2^-40 to 2^40, sometimes zero or so small or large that powers
/// leave the range.
fn number(dice: &mut TestRng) -> f64 {
    let unit = dice.signed();
    match dice.bits() % 8 {
        0 => 0.0,
        1 => unit * durer_math::scale::pow2(-300),
        2 => unit * durer_math::scale::pow2(300),
        _ => unit * durer_math::scale::pow2((dice.bits() % 81) as i32 - 40),
    }
}

#[test]
fn powers_hold_the_exact_ones() {
    let mut dice = TestRng::new(1);
    let mut tight = 0;
    for round in 0..4_000 {
        let n = 2 + (round % 64);
        let ends: [(f64, f64); 8] = core::array::from_fn(|i| {
            let (a, b) = (number(&mut dice), number(&mut dice));
            if i % 2 == 0 { (a, a) } else { (a.min(b), a.max(b)) }
        });
        let x = I8::new(F8(ends.map(|e| e.0)), F8(ends.map(|e| e.1)));
        let y = <I8 as Number>::powi(&x, n);
        for (i, (lo, hi)) in ends.into_iter().enumerate() {
            let Interval { lo: least, hi: most } = y.lane(i);
            for t in [lo, 0.5 * lo + 0.5 * hi, hi] {
                let exact = (0..n).fold(Dyadic::from(1.0), |product, _| product * Dyadic::exact(t));
                let below = least == f64::NEG_INFINITY || Dyadic::exact(least) <= exact;
                let above = most == f64::INFINITY || Dyadic::exact(most) >= exact;
                assert!(below && above, "{t}^{n} is not in [{least}, {most}], of [{lo}, {hi}]");
            }
            // An even power is never negative, nor is a power of a non-negative number.
            assert!(least >= 0.0 || (n % 2 == 1 && lo < 0.0), "[{lo}, {hi}]^{n}: {least}");
            // Each product pays 2^-1000 for underflow: the last place of a number above 2^-900 is
            // more.
            if lo == hi && most.is_finite() && least.abs() > durer_math::scale::pow2(-900) {
                assert!((most - least).abs() <= least.abs() * f64::EPSILON * 3.0 * f64::from(n), "{lo}^{n}");
                tight += 1;
            }
        }
    }
    assert!(tight > 5_000, "{tight}");
}

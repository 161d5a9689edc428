//! Dual numbers against derivatives by hand, and sums of intervals in lanes against exact ones.
#![allow(missing_docs, reason = "a test program")]

#[path = "../../durer-math/tests/common/mod.rs"]
mod common;
use common::*;
use durer_formula::{Dual, I8, Number};
use durer_math::{Interval, Scalar, U};
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(20_000))]

    /// x^2 sqrt(x) / (1 + |x|), its derivative by hand, and both as intervals.
    #[test]
    fn dual_numbers_differentiate(x in 0.1..10.0_f64) {
        fn f<T: Scalar>(x: T) -> T {
            let one = T::from(1.0);
            x.mul_add(x, T::from(0.0)) * x.sqrt() / (one + x.abs())
        }
        let value = f(Dual::variable(x));
        let by_hand = x * x.sqrt() * (2.5 + 1.5 * x) / ((1.0 + x) * (1.0 + x));
        prop_assert!((value.d - by_hand).abs() <= 32.0 * U * by_hand);
        prop_assert_eq!(value.v, f(x));
        let enclosure = f(Dual::variable(Interval::from(x)));
        prop_assert!(enclosure.v.contains(f(x)) || (enclosure.v.mid() - f(x)).abs() <= 8.0 * U * f(x));
        prop_assert!((enclosure.d.mid() - by_hand).abs() <= 64.0 * U * by_hand && enclosure.d.width() <= 256.0 * U * by_hand);
        let p = Dual { v: x, d: 2.0 };
        let m = Dual::difference_of_products(p, Dual::variable(3.0), Dual::variable(x), p);
        // d/dt (p q - r p) with p' = 2, q' = r' = 1.
        prop_assert!((m.d - (2.0 * 3.0 + x - x - x * 2.0)).abs() <= 16.0 * U * (6.0 + 4.0 * x));
    }

    /// In lanes the bounds of a sum enclose the exact one, and f64's sum is the bound on the side
    /// where it may be.
    #[test]
    fn sums_in_lanes(a in number(), b in number()) {
        let of = |x: f64| I8::splat(Interval::from(x));
        let (sum, difference) = (<I8 as Number>::add(&of(a), &of(b)), <I8 as Number>::sub(&of(a), &of(b)));
        for (said, truth) in [(sum, rat(a) + rat(b)), (difference, rat(a) - rat(b))] {
            let Interval { lo, hi } = said.lane(5);
            prop_assert!(below(lo, &truth) && above(hi, &truth), "{a:e} {b:e}: {lo:e} {hi:e}");
            let nearest = truth.to_f64().value();
            if nearest.is_finite() {
                prop_assert!(rat(nearest) > truth || lo == nearest, "{a:e} {b:e}: {lo:e} {hi:e}");
                prop_assert!(rat(nearest) < truth || hi == nearest, "{a:e} {b:e}: {lo:e} {hi:e}");
            }
        }
    }
}

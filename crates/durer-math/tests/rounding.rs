//! Directed rounding is exactly directed: no f64 lies between the result and the exact one.
#![allow(missing_docs, reason = "a test program")]

mod common;
use common::*;
use dashu::rational::RBig;
use durer_math::rounding::*;
use durer_math::{Interval, Scalar};
use proptest::prelude::*;

/// `down` is the greatest f64 not above `truth`, `up` the least not below.
fn tight(down: f64, up: f64, truth: &RBig) -> bool {
    below(down, truth)
        && above(up, truth)
        && (down.next_up() == f64::INFINITY || rat(down.next_up()) > *truth)
        && (up.next_down() == f64::NEG_INFINITY || rat(up.next_down()) < *truth)
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn sums_and_differences(a in number(), b in number()) {
        prop_assert!(tight(add_down(a, b), add_up(a, b), &(rat(a) + rat(b))));
        prop_assert!(tight(sub_down(a, b), sub_up(a, b), &(rat(a) - rat(b))));
    }

    #[test]
    fn products(a in number(), b in number()) {
        prop_assert!(tight(mul_down(a, b), mul_up(a, b), &(rat(a) * rat(b))));
    }

    #[test]
    fn quotients(a in number(), b in number()) {
        let b = if b == 0.0 { 3.0 } else { b };
        let (lo, hi) = (div_down(a, b), div_up(a, b));
        let truth = rat(a) / rat(b);
        prop_assert!(tight(lo, hi, &truth), "{a:e} / {b:e}: {lo:e} {hi:e}");
    }

    #[test]
    fn roots(a in number()) {
        let a = a.abs();
        let (lo, hi) = (sqrt_down(a), sqrt_up(a));
        let square = |x: f64| rat(x) * rat(x);
        prop_assert!(square(lo) <= rat(a) && rat(a) <= square(hi));
        prop_assert!(square(lo.next_up()) > rat(a));
        prop_assert!(hi == 0.0 || square(hi.next_down()) < rat(a));
    }

    /// Products of numbers whose product is exact, or nearly, in the subnormal range.
    #[test]
    fn products_at_the_bottom(a in scaled(20), b in scaled(20), k in 1000..1140_i32) {
        let a = durer_math::scale::ldexp(a, -500);
        let b = durer_math::scale::ldexp(b, 500 - k);
        prop_assert!(tight(mul_down(a, b), mul_up(a, b), &(rat(a) * rat(b))));
    }

    /// The image of every pair of members lies in the interval, and its ends are attained up to
    /// rounding.
    #[test]
    fn interval_operations_enclose(a in interval(), b in interval(), s in 0.0..=1.0_f64, t in 0.0..=1.0_f64) {
        let (x, y) = (member(a, s), member(b, t));
        let (p, q) = (rat(x), rat(y));
        for (result, truth) in [(a + b, &p + &q), (a - b, &p - &q), (a * b, &p * &q), (a.square(), &p * &p)] {
            prop_assert!(holds(result, &truth), "{a:?} {b:?} {result:?}");
        }
        prop_assert!(holds(Scalar::mul_add(a, b, a), &(&p * &q + &p)));
        prop_assert!(holds(a.abs(), &abs(p.clone())));
        prop_assert!(a.hull(b).contains(x) && a.hull(b).contains(y));
        prop_assert!(a.min(b).contains(x.min(y)) && a.max(b).contains(x.max(y)));
        prop_assert_eq!(a.intersection(b).is_some(), a.lo.max(b.lo) <= a.hi.min(b.hi));
        prop_assert!(a.contains(a.mid()) && holds(Interval::from(a.width()) - Interval::from(0.0), &rat(a.width())));
        if y != 0.0 {
            prop_assert!(holds(a / b, &(&p / &q)), "{a:?} / {b:?} = {:?}", a / b);
        }
        let root = a.sqrt();
        if x >= 0.0 {
            prop_assert!(root.lo <= x.sqrt().next_up() && x.sqrt().next_down() <= root.hi);
        }
        prop_assert_eq!(a.hi < 0.0, root.is_empty());
    }

    /// Interval products and quotients are the tightest: their ends are images of ends.
    #[test]
    fn interval_products_are_tight(a in interval(), b in interval()) {
        let ends = |f: &dyn Fn(f64, f64) -> RBig| {
            let mut all = [f(a.lo, b.lo), f(a.lo, b.hi), f(a.hi, b.lo), f(a.hi, b.hi)];
            all.sort();
            (all[0].clone(), all[3].clone())
        };
        let (lo, hi) = ends(&|x, y| rat(x) * rat(y));
        let p = a * b;
        prop_assert!(tightest(p, &lo, &hi), "{a:?} {b:?} {p:?}");
        if b.lo > 0.0 || b.hi < 0.0 {
            let (lo, hi) = ends(&|x, y| rat(x) / rat(y));
            let q = a / b;
            prop_assert!(tightest(q, &lo, &hi), "{a:?} / {b:?} = {q:?}");
        }
    }
}

/// The ends of `x` are `lo` rounded down and `hi` rounded up.
fn tightest(x: Interval, lo: &RBig, hi: &RBig) -> bool {
    below(x.lo, lo)
        && above(x.hi, hi)
        && (x.lo == f64::MAX || x.lo.next_up() == f64::INFINITY || rat(x.lo.next_up()) > *lo)
        && (x.hi == f64::MIN || x.hi.next_down() == f64::NEG_INFINITY || rat(x.hi.next_down()) < *hi)
}

fn interval() -> impl Strategy<Value = Interval> {
    (number(), number()).prop_map(|(a, b)| Interval::new(a.min(b), a.max(b)))
}

fn member(a: Interval, s: f64) -> f64 {
    ((1.0 - s) * a.lo + s * a.hi).max(a.lo).min(a.hi)
}

fn holds(a: Interval, x: &RBig) -> bool {
    !a.is_empty() && below(a.lo, x) && above(a.hi, x)
}

#[test]
fn infinite_ends_stay_bounds() {
    let half_line = Interval::new(1.0, f64::INFINITY);
    let zero = Interval::from(0.0);
    assert_eq!(half_line * zero, zero);
    assert_eq!(half_line + half_line, Interval::new(2.0, f64::INFINITY));
    assert_eq!(Interval::from(1.0) / half_line, Interval::new(0.0, 1.0));
    assert_eq!(Interval::from(1.0) / Interval::new(0.0, 2.0), Interval::new(0.5, f64::INFINITY));
    assert_eq!(Interval::from(-1.0) / Interval::new(0.0, 2.0), Interval::new(f64::NEG_INFINITY, -0.5));
    assert_eq!(Interval::from(1.0) / Interval::new(-1.0, 2.0), Interval::ENTIRE);
    assert!((half_line / zero).is_empty());
    assert!(Interval::new(-2.0, -1.0).sqrt().is_empty());
    assert!((Interval::EMPTY + half_line).is_empty());
    assert_eq!(Interval::from(f64::MAX) + Interval::from(f64::MAX), Interval::new(f64::MAX, f64::INFINITY));
}

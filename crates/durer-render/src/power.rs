//! Powers with a fixed exponent, fast for simple exponents.

use durer_math::{F8, M8, elementary};

/// `x -> x^e` for `x >= 0` and one `e`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Power {
    /// 1
    Zero,
    /// x
    One,
    /// An integer, by repeated squaring.
    Whole(i32),
    /// Any other exponent.
    Real(f64),
}

impl Power {
    pub(crate) fn new(exponent: f64) -> Self {
        // Above this exponent the logarithm is as fast as squaring, and more accurate.
        const MOST: f64 = 4096.0;
        if exponent == 0.0 {
            Self::Zero
        } else if exponent == 1.0 {
            Self::One
        } else if exponent > 0.0 && exponent <= MOST && exponent == crate::vector::floor(exponent) {
            Self::Whole(exponent as i32)
        } else {
            Self::Real(exponent)
        }
    }

    #[inline(always)]
    pub(crate) fn of(self, x: f64) -> f64 {
        match self {
            Self::Zero => 1.0,
            Self::One => x,
            Self::Whole(n) => elementary::powi(x, n),
            Self::Real(_) => self.lanes(F8::splat(x), M8::ALL).0[0],
        }
    }

    /// As `lanes`, also for `x < 0`: the sign follows from an even or odd exponent, and other
    /// exponents give NaN.
    #[inline(always)]
    pub(crate) fn signed_lanes(self, x: F8, live: M8) -> F8 {
        let Self::Real(e) = self else { return self.lanes(x, live) };
        let size = self.lanes(x.abs(), live);
        let half = 0.5 * e;
        let of_negative = if e != crate::vector::floor(e) {
            F8::splat(f64::NAN)
        } else if half == crate::vector::floor(half) {
            size
        } else {
            -size
        };
        x.lt(F8::ZERO).select(of_negative, size)
    }

    /// The powers of eight numbers. Lanes that are not live are unspecified.
    #[inline(always)]
    pub(crate) fn lanes(self, x: F8, live: M8) -> F8 {
        match self {
            Self::Zero => F8::ONE,
            Self::One => x,
            Self::Whole(n) => {
                // The same steps as `elementary::powi`.
                let (mut result, mut power, mut left) = (F8::ONE, x, n);
                loop {
                    if left & 1 == 1 {
                        result = result * power;
                    }
                    left >>= 1;
                    if left == 0 {
                        return result;
                    }
                    power = power * power;
                }
            }
            Self::Real(e) => elementary::pow_lanes(x, e, live),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_agree() {
        for e in [0.0, 1.0, 2.0, 7.0, 40.0, 1000.0, 4096.0, 4097.0, 0.5, 2.5, -1.0] {
            for x in [0.25, 0.99, 0.999_9, 1.0] {
                let want = elementary::pow(x, e);
                assert!((Power::new(e).of(x) - want).abs() <= 1e-12 * want, "{x}^{e}");
            }
        }
    }

    #[test]
    fn powers_of_negative_numbers_have_their_sign_or_are_none() {
        for (e, want) in [
            (0.0, 1.0),
            (1.0, -2.0),
            (2.0, 4.0),
            (3.0, -8.0),
            (-1.0, -0.5),
            (-2.0, 0.25),
            (5001.0, f64::NEG_INFINITY),
            (5002.0, f64::INFINITY),
        ] {
            let got = Power::new(e).signed_lanes(F8::splat(-2.0), M8::ALL).0[3];
            assert!(got == want || (got - want).abs() <= 1e-12 * want.abs(), "{e}: {got}");
        }
        assert!(Power::new(0.5).signed_lanes(F8::splat(-2.0), M8::ALL).0[3].is_nan());
        let x = F8([0.0, 0.1, 0.25, 0.5, 0.99, 0.999_9, 1.0, 1.5]);
        for e in [0.0, 1.0, 7.0, 4097.0, 0.5, 2.5, -3.0] {
            let power = Power::new(e);
            assert_eq!(power.signed_lanes(x, M8::ALL), power.lanes(x, M8::ALL), "{e}");
        }
    }

    #[test]
    fn lanes_have_the_bits_of_single_numbers() {
        let x = F8([0.0, 0.1, 0.25, 0.5, 0.99, 0.999_9, 1.0, 1.5]);
        for e in [0.0, 1.0, 2.0, 7.0, 40.0, 1000.0, 4097.0, 0.5, 2.5] {
            let power = Power::new(e);
            assert_eq!(power.lanes(x, M8::ALL), x.map(|x| power.of(x)), "{e}");
        }
    }
}

//! The unit roundoff and Higham's `gamma`.

/// The unit roundoff of f64, `2^-53`: `fl(a op b) = (a op b)(1 + d)` with `|d| <= U`, barring over-
/// and underflow.
pub const U: f64 = f64::EPSILON / 2.0;

/// `n u / (1 - n u)`: a bound for the relative error of `n` roundings in a row.
///
/// N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 2nd ed., SIAM (2002), lemma 3.1.
/// Evaluated in f64 and then raised by three ulps, which covers its own two roundings (`n u` is
/// exact for `n < 2^53`).
#[inline]
pub const fn gamma(n: u32) -> f64 {
    let nu = n as f64 * U;
    let g = nu / (1.0 - nu);
    g * (1.0 + 6.0 * U)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_is_just_above_n_u() {
        for n in [1, 2, 7, 1000] {
            let nu = f64::from(n) * U;
            // n u / (1 - n u) = n u (1 + n u + ...), so it lies this close above n u.
            assert!(gamma(n) > nu && gamma(n) < nu * (1.0 + 2.0 * nu + 10.0 * U));
        }
        assert_eq!(gamma(0), 0.0);
    }
}

//! Polynomials with exact coefficients, the constant first: for oracles.

use super::Exact;

/// The coefficients, that of the power 0 first.
pub type Poly = Vec<Exact>;

/// The number 0.
pub fn zero() -> Exact {
    Exact::zero()
}

/// `a + b`.
pub fn sum(a: &[Exact], b: &[Exact]) -> Poly {
    let at = |p: &[Exact], i: usize| p.get(i).cloned().unwrap_or_else(zero);
    (0..a.len().max(b.len())).map(|i| &at(a, i) + &at(b, i)).collect()
}

/// `a b`.
pub fn times(a: &[Exact], b: &[Exact]) -> Poly {
    let mut out = vec![zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    out
}

/// All coefficients times a number.
pub fn scaled(a: &[Exact], by: &Exact) -> Poly {
    a.iter().map(|x| x * by).collect()
}

/// The value at `x`, by Horner's rule.
pub fn value(p: &[Exact], x: &Exact) -> Exact {
    p.iter().rev().fold(zero(), |sum, a| &(&sum * x) + a)
}

//! The exact order of two crossings with curved walls along a ray.
//!
//! Each is at `s = p(u) / q(u)` for a root `u` of a cubic `g` (`parameter.rs`). The resultant of
//! `g(u)` and `p(u) - s q(u)`, from which `u` is eliminated (E. Bézout, *Théorie générale des
//! équations algébriques*, 1779), is a polynomial in `s` that vanishes there. Between two roots of
//! the product of both resultants there is a number, and the sign of a polynomial at the `u` of a
//! crossing decides on which side of that number the crossing lies.

use super::exact::Exactly;
use super::forms::along;
use super::parameter::{Places, product, quotient};
use super::profile_curve::ProfileCurve;
use super::profile_hits::Meet;
use crate::planar::Line;
use core::cmp::Ordering;
use durer_math::Dyadic;
use durer_roots::exact::ExactRoots;

/// A polynomial, the constant first.
type Poly = Vec<Dyadic>;

impl Places<'_, '_> {
    /// The order of two crossings; equal if they are at one point, or if the ray is not exactly
    /// known.
    #[cold]
    #[inline(never)]
    pub(super) fn order(&self, a: (&ProfileCurve, &Meet), b: (&ProfileCurve, &Meet)) -> Ordering {
        self.exact_order(a, b).unwrap_or(Ordering::Equal)
    }

    fn exact_order(&self, a: (&ProfileCurve, &Meet), b: (&ProfileCurve, &Meet)) -> Option<Ordering> {
        let ray = self.probe.exact()?;
        let (n, _) = self.scan.forms(&ray)?;
        let (num, den) = quotient(self.scan.view.sweep, &ray);
        let place = |(piece, meet): (&ProfileCurve, &Meet)| {
            let powers = piece.in_powers::<Dyadic>(self.scan.view);
            let [g, p, q] = [&n, &num, &den].map(|form| along(form, &powers));
            let resultant = resultant(&g, &p, &q);
            Some((Exactly::new(g.to_vec(), meet)?, p, q, resultant))
        };
        let (a, b) = (place(a)?, place(b)?);
        let roots = ExactRoots::new(product(&a.3, &b.3))?;
        let isolated = roots.isolate(&roots.beside(f64::MIN, -1.0), &roots.beside(f64::MAX, 1.0));
        // How many roots are certainly before a crossing.
        let before = |(u, p, q, _): &(Exactly, [Dyadic; 4], [Dyadic; 4], Poly)| {
            let positive = u.sign(q);
            let is_beyond = |x: &Dyadic| {
                let past = [0, 1, 2, 3].map(|i: usize| &p[i] - &(&q[i] * x));
                u.sign(&past) == positive
            };
            isolated.iter().filter(|root| is_beyond(root.end())).count()
        };
        Some(before(&a).cmp(&before(&b)))
    }
}

/// The resultant of `g(u)` and `p(u) - s q(u)`: the determinant of Bézout's matrix. Not zero, since
/// all three vanish at no `u`.
fn resultant(g: &[Dyadic; 4], p: &[Dyadic; 4], q: &[Dyadic; 4]) -> Poly {
    // The highest power that is present in one of them; otherwise the determinant would vanish.
    let n = (1..4).rev().find(|&i| [g, p, q].iter().any(|f| !f[i].is_zero())).unwrap_or(1);
    let minor = |f: &[Dyadic; 4], i: usize, j: usize| &(&g[i] * &f[j]) - &(&g[j] * &f[i]);
    let mut rows = vec![vec![vec![Dyadic::ZERO, Dyadic::ZERO]; n]; n];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            for k in (i + j + 1).saturating_sub(n)..=i.min(j) {
                entry[0] = &entry[0] + &minor(p, i + j + 1 - k, k);
                entry[1] = &entry[1] - &minor(q, i + j + 1 - k, k);
            }
        }
    }
    determinant(&rows)
}

/// Expanded by the first column.
fn determinant(rows: &[Vec<Poly>]) -> Poly {
    if let [row] = rows {
        return row[0].clone();
    }
    let mut sum: Poly = vec![Dyadic::ZERO; rows.len() + 1];
    for (i, row) in rows.iter().enumerate() {
        let rest: Vec<Vec<Poly>> =
            rows.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, r)| r[1..].to_vec()).collect();
        for (s, term) in sum.iter_mut().zip(product(&row[0], &determinant(&rest))) {
            *s = if i % 2 == 0 { &*s + &term } else { &*s - &term };
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resultants_vanish_where_a_root_has_its_place() {
        let poly = |c: [f64; 4]| c.map(Dyadic::from);
        // u = 1, 2, 3, at u² - u + 1: 1, 3 and 7; and a line at u = 1/2, at (u + 1) / (u - 1) = -3.
        let cases = [
            ([[-6.0, 11.0, -6.0, 1.0], [1.0, -1.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0]], vec![1.0, 3.0, 7.0]),
            ([[-1.0, 2.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0]], vec![-3.0]),
        ];
        for ([g, p, q], places) in cases {
            let found = ExactRoots::new(resultant(&poly(g), &poly(p), &poly(q))).unwrap();
            let roots = found.isolate(&Dyadic::from(-100.0), &Dyadic::from(100.0));
            assert_eq!(roots.len(), places.len());
            for (root, &at) in roots.iter().zip(&places) {
                assert_eq!(found.compare(&Dyadic::from(at), root), Ordering::Equal);
            }
        }
    }
}

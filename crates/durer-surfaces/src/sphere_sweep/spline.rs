//! Splines of spheres: which pieces a list of spheres has, and the polynomials of a piece.
//!
//! ```text
//!   linear     [p0 p1 .. pn]             straight from each sphere to the next
//!   b_spline   p0 p1 p2 p3 ..            the uniform cubic B-spline, near its control points
//!   cubic      p0 [p1 p2 .. pn-1] pn     from p_i to p_i+1 the cubic with the slopes
//!                                        (p_i+1 - p_i-1) / 2 and (p_i+2 - p_i) / 2 there
//! ```
//!
//! Centre and radius follow the same spline. The cubic splines are those of E. Catmull, R. Rom, "A
//! class of local interpolating splines", *Computer Aided Geometric Design* (ed. Barnhill,
//! Riesenfeld), 1974; the B-splines those of I. J. Schoenberg, 1946. The rows below hold exactly,
//! so the solid is that of the given numbers; nothing is rounded.

use durer_math::Ring;

/// How spheres define a curve of spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SweepSpline {
    /// Straight from each sphere to the next.
    Linear,
    /// The uniform cubic B-spline with these control points.
    BSpline,
    /// A cubic through all spheres but the first and the last, which only determine slopes.
    Cubic,
}

impl SweepSpline {
    /// The least number of spheres.
    #[must_use]
    pub fn least(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::BSpline | Self::Cubic => 4,
        }
    }

    /// Its name in messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Linear => "a linear_spline",
            Self::BSpline => "a b_spline",
            Self::Cubic => "a cubic_spline",
        }
    }
}

/// A piece by its control spheres `p_i`: over `x` in `[-1, 1]` it is
/// `(Σ rows[k][i] p_i x^k) / (weight 2^shift)`. Squares of these have `M = 2 K - 1` coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Basis<const K: usize, const M: usize> {
    rows: [[f64; K]; K],
    shift: i32,
    /// 1 or 3.
    pub(super) weight: f64,
}

pub(super) const LINEAR: Basis<2, 3> = Basis { rows: [[1.0, 1.0], [-1.0, 1.0]], shift: 1, weight: 1.0 };

pub(super) const B_SPLINE: Basis<4, 7> = Basis {
    rows: [[1.0, 23.0, 23.0, 1.0], [-3.0, -15.0, 15.0, 3.0], [3.0, -3.0, -3.0, 3.0], [-1.0, 3.0, -3.0, 1.0]],
    shift: 4,
    weight: 3.0,
};

pub(super) const CUBIC: Basis<4, 7> = Basis {
    rows: [[-1.0, 9.0, 9.0, -1.0], [1.0, -11.0, 11.0, -1.0], [1.0, -1.0, -1.0, 1.0], [-1.0, 3.0, -3.0, 1.0]],
    shift: 4,
    weight: 1.0,
};

impl<const K: usize, const M: usize> Basis<K, M> {
    /// The coefficients of `x^k`, times the weight.
    #[inline(always)]
    pub(super) fn coefficients<T: Ring>(&self, p: &[T; K]) -> [T; K] {
        let mut out = p.clone();
        for (out, row) in out.iter_mut().zip(&self.rows) {
            let mut sum = T::exact(row[0]) * p[0].clone();
            for i in 1..K {
                sum = sum + T::exact(row[i]) * p[i].clone();
            }
            *out = sum.scale2(-self.shift);
        }
        out
    }

    /// The control points of the piece in Bezier form, rounded.
    pub(super) fn bezier(&self, p: &[f64; K]) -> [f64; K] {
        let [a, b, c, d] = match K {
            2 => return *p,
            _ => [p[0], p[1], p[2], p[3]],
        };
        let out = if self.weight == 3.0 {
            [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
        } else {
            [b, b + (c - a) / 6.0, c - (d - b) / 6.0, c]
        };
        let mut bezier = *p;
        bezier.copy_from_slice(&out[..K]);
        bezier
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Dyadic;

    fn at<const K: usize, const M: usize>(basis: &Basis<K, M>, p: [f64; K], x: f64) -> f64 {
        let c = basis.coefficients(&p.map(Dyadic::from));
        let x = Dyadic::from(x);
        c.iter().rev().fold(Dyadic::ZERO, |sum, c| &(&sum * &x) + c).to_f64() / basis.weight
    }

    #[test]
    fn pieces_meet_and_pass_their_points() {
        let p = [3.0, -1.0, 0.25, 7.0];
        assert_eq!([at(&LINEAR, [3.0, -1.0], -1.0), at(&LINEAR, [3.0, -1.0], 1.0)], [3.0, -1.0]);
        assert_eq!([at(&CUBIC, p, -1.0), at(&CUBIC, p, 1.0)], [-1.0, 0.25]);
        let knot = |p: &[f64]| (p[0] + 4.0 * p[1] + p[2]) / 6.0;
        assert_eq!([at(&B_SPLINE, p, -1.0), at(&B_SPLINE, p, 1.0)], [knot(&p[..3]), knot(&p[1..])]);
        for basis in [B_SPLINE, CUBIC] {
            let b = basis.bezier(&p);
            let bezier = |u: f64| {
                let v = 1.0 - u;
                v * v * v * b[0] + 3.0 * u * v * (v * b[1] + u * b[2]) + u * u * u * b[3]
            };
            for i in 0..=16 {
                let x = f64::from(i) / 8.0 - 1.0;
                assert!((at(&basis, p, x) - bezier(0.5 + 0.5 * x)).abs() < 1e-13);
            }
        }
    }
}

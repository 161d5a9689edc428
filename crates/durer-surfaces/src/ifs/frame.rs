//! Rays in the frames of copies: through the inverses of the maps, one after another.
//!
//! In all frames coordinates are relative to one centre `C`, in units of `2^k`. There the inverse
//! of `x -> c + L x` is `y -> L^-1 y + (L^-1 (C - c) - C) / 2^k`, and the parameter of the ray
//! stays.

use crate::planar::quotient_bounds;
use crate::{CentredRay, RingRay};
use durer_math::affine::Matrix3;
use durer_math::eft::scale2;
use durer_math::{Affine, Dyadic, Point3, Ring, U};

/// Covers results below the normal range.
pub(super) const TINY: f64 = durer_math::scale::pow2(-1000);

/// The maps.
#[derive(Clone, Debug)]
pub(super) enum Frames {
    /// `x -> (x + c) / q` with integers: the inverse is `q x - c`, exactly.
    Lattice { q: f64, shifts: Vec<[f64; 3]> },
    /// Any.
    General { maps: Vec<Affine>, inverses: Vec<Inverse>, centre: Point3, scale: i32 },
}

/// The inverse of a map, rounded: `y -> rows y + shift`.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    rows: Matrix3,
    rows_err: Matrix3,
    shift: [f64; 3],
    shift_err: [f64; 3],
}

/// A ray in the frame of a copy: `o + s d`, each coordinate with a bound on its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellRay {
    pub(super) o: [f64; 3],
    pub(super) d: [f64; 3],
    pub(super) o_err: [f64; 3],
    pub(super) d_err: [f64; 3],
}

impl CellRay {
    /// The ray in the frame of the whole set.
    #[inline(always)]
    pub(super) fn new(at: &CentredRay<'_>) -> Self {
        Self {
            o: at.o.to_array(),
            d: at.d.to_array(),
            o_err: at.o_err.to_array(),
            d_err: at.d_err.to_array(),
        }
    }
}

impl Inverse {
    fn new(map: &Affine, centre: Point3, scale: i32) -> Self {
        let (adjugate, determinant) = map.adjugate::<Dyadic>();
        let c = centre.to_array().map(Dyadic::from);
        let from = [0, 1, 2].map(|i| &c[i] - &Dyadic::from(map.centre()[i]));
        let (mut shift, mut shift_err) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let row = &adjugate[i];
            let sum = &(&(&row[0] * &from[0]) + &(&row[1] * &from[1])) + &(&row[2] * &from[2]);
            let n = (&sum - &(&determinant * &c[i])).scale2(-scale);
            let (lo, hi) = quotient_bounds(&n, &n, &determinant);
            shift[i] = 0.5 * lo + 0.5 * hi;
            shift_err[i] = (hi - lo) * (1.0 + 4.0 * U);
        }
        Self { rows: map.inverse_linear(), rows_err: map.inverse_error(), shift, shift_err }
    }

    /// `rows v + shift`: three products and their sums.
    #[inline(always)]
    fn apply(
        &self,
        v: &[f64; 3],
        v_err: &[f64; 3],
        shift: &[f64; 3],
        shift_err: &[f64; 3],
    ) -> ([f64; 3], [f64; 3]) {
        let (mut x, mut e) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let (r, re) = (&self.rows[i], &self.rows_err[i]);
            x[i] = r[0].mul_add(v[0], r[1].mul_add(v[1], r[2].mul_add(v[2], shift[i])));
            let mut err = shift_err[i];
            let mut size = shift[i].abs();
            for j in 0..3 {
                size = r[j].abs().mul_add(v[j].abs(), size);
                err = r[j].abs().mul_add(v_err[j], re[j].mul_add(v[j].abs() + v_err[j], err));
            }
            // Three fused operations round once each.
            let err = size.mul_add(3.0 * U, err);
            e[i] = if err == 0.0 { 0.0 } else { err.mul_add(1.0 + 16.0 * U, TINY) };
        }
        (x, e)
    }
}

impl Frames {
    pub(super) fn lattice(q: f64, shifts: Vec<[f64; 3]>) -> Self {
        Self::Lattice { q, shifts }
    }

    pub(super) fn general(maps: Vec<Affine>, centre: Point3, scale: i32) -> Self {
        let inverses = maps.iter().map(|map| Inverse::new(map, centre, scale)).collect();
        Self::General { maps, inverses, centre, scale }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Lattice { shifts, .. } => shifts.len(),
            Self::General { maps, .. } => maps.len(),
        }
    }

    /// A map that is an affine one.
    pub(super) fn map(&self, letter: usize) -> Option<&Affine> {
        match self {
            Self::Lattice { .. } => None,
            Self::General { maps, .. } => maps.get(letter),
        }
    }

    pub(super) fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Lattice { shifts: a, .. }, Self::Lattice { shifts: b, .. }) => a == b,
            (Self::General { maps: a, .. }, Self::General { maps: b, .. }) => a == b,
            _ => false,
        }
    }

    /// The ray in the frame of a copy by one more map.
    #[inline(always)]
    pub(super) fn descend(&self, letter: usize, ray: &CellRay) -> CellRay {
        match self {
            Self::Lattice { q, shifts } => {
                let c = &shifts[letter];
                let mut cell = *ray;
                for (i, c) in c.iter().enumerate() {
                    cell.o[i] = q.mul_add(ray.o[i], -c);
                    cell.o_err[i] = cell.o[i].abs().mul_add(U, q * ray.o_err[i]) * (1.0 + 4.0 * U) + TINY;
                    cell.d[i] = q * ray.d[i];
                    let err = cell.d[i].abs().mul_add(U, q * ray.d_err[i]);
                    cell.d_err[i] = if ray.d[i] == 0.0 && ray.d_err[i] == 0.0 {
                        0.0
                    } else {
                        err.mul_add(1.0 + 4.0 * U, TINY)
                    };
                }
                cell
            }
            Self::General { inverses, .. } => {
                let inverse = &inverses[letter];
                let (o, o_err) = inverse.apply(&ray.o, &ray.o_err, &inverse.shift, &inverse.shift_err);
                let (d, d_err) = inverse.apply(&ray.d, &ray.d_err, &[0.0; 3], &[0.0; 3]);
                // Only a product that is exactly zero has no rounding, so a direction along an axis
                // stays one.
                CellRay { o, d, o_err, d_err }
            }
        }
    }

    /// [`Frames::descend`] in a ring.
    pub(super) fn descend_in<T: Ring>(&self, letter: usize, ray: RingRay<T>) -> RingRay<T> {
        let RingRay { o, d, w } = ray;
        match self {
            Self::Lattice { q, shifts } => {
                let c = &shifts[letter];
                let mut i = 0;
                let o = o.map(|o| {
                    let o = T::exact(*q) * o - T::exact(c[i]) * w.clone();
                    i += 1;
                    o
                });
                RingRay { o, d: d.map(|d| T::exact(*q) * d), w }
            }
            Self::General { maps, centre, scale, .. } => {
                let map = &maps[letter];
                let (adjugate, determinant) = map.adjugate::<T>();
                let (c, at) = (centre.to_array(), map.centre().to_array());
                let mut i = 0;
                let o = o.map(|o| {
                    let from = (T::exact(c[i]) - T::exact(at[i])).scale2(-scale);
                    i += 1;
                    o + from * w.clone()
                });
                let w = w * determinant;
                let times = |v: &[T; 3], i: usize| {
                    let r: &[T; 3] = &adjugate[i];
                    r[0].clone() * v[0].clone() + r[1].clone() * v[1].clone() + r[2].clone() * v[2].clone()
                };
                let back = |i: usize| T::exact(c[i]).scale2(-scale) * w.clone();
                RingRay {
                    o: [times(&o, 0) - back(0), times(&o, 1) - back(1), times(&o, 2) - back(2)],
                    d: [times(&d, 0), times(&d, 1), times(&d, 2)],
                    w,
                }
            }
        }
    }

    /// The ray in the frame of the copy with these letters.
    pub(super) fn descend_all<T: Ring>(&self, letters: &[usize], ray: RingRay<T>) -> RingRay<T> {
        letters.iter().fold(ray, |ray, &letter| self.descend_in(letter, ray))
    }

    /// For the maps `(x + c) / q`: the integer `n.sum`, where `q^N x = sum + y` maps the frame of
    /// the copy to that of the set.
    pub(super) fn offset(&self, letters: &[usize], n: &[f64; 3]) -> Option<i64> {
        let Self::Lattice { q, shifts } = self else { return None };
        let q = *q as i64;
        let dot = |c: &[f64; 3]| (n[0] * c[0] + n[1] * c[1] + n[2] * c[2]) as i64;
        Some(letters.iter().fold(0, |sum, &letter| sum * q + dot(&shifts[letter])))
    }

    /// `q^N`.
    pub(super) fn weight(&self, depth: u32) -> Option<f64> {
        match self {
            Self::Lattice { q, .. } => Some((*q as u64).pow(depth) as f64),
            Self::General { .. } => None,
        }
    }
}

/// A number relative to a centre, in units of `2^scale`, with a bound on its error.
#[inline(always)]
pub(super) fn level(at: f64, centre: f64, scale: i32) -> (f64, f64) {
    let x = scale2(at - centre, -scale);
    (x, x.abs().mul_add(U * (1.0 + 4.0 * U), if x == 0.0 && at == centre { 0.0 } else { TINY }))
}

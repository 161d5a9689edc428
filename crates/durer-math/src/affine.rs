//! Affine maps `x -> c + L x`.
//!
//! The stored `L` and `c` are exact: a placed surface *is* `{ c + L x : x in S }`. The inverse is
//! rounded, and [`Affine::inverse_error`] bounds the error of each entry. The translation is never
//! folded into the inverse, `x = L^-1 (p - c)`, because `L^-1 p - L^-1 c` cancels.

use crate::rounding::{add_up, mul_up, sqrt_up};
use crate::{Aabb, Dd, Dyadic, EFloat, Interval, Isa, Normal3, Point3, Ring, U, Vec3, elementary};

/// A 3x3 matrix by rows.
pub type Matrix3 = [[f64; 3]; 3];

const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// An invertible affine map `x -> c + L x`.
///
/// # Invariants
///
/// - `L` and `c` are finite, `det L` is not zero (decided exactly), and the inverse's entries are
///   finite.
///
/// ```
/// use durer_math::{Affine, Point3, Vec3};
/// let quarter = Affine::rotation_y(core::f64::consts::FRAC_PI_2)?;
/// let image = quarter.vector(Vec3::X); // the standard rotation: x goes to -z
/// assert!((image - -Vec3::Z).length() < 1e-15);
/// let map = quarter.then(&Affine::translation(Vec3::new(0.0, 5.0, 0.0))?)?;
/// assert_eq!(map.centre(), Point3::new(0.0, 5.0, 0.0));
/// # Ok::<(), durer_math::AffineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    linear: Matrix3,
    /// Each entry is the number nearest to the exact one.
    inverse: Matrix3,
    /// An upper bound on the spectral norm of the exact inverse.
    inverse_norm: Above,
    centre: Point3,
    rounded: Rounded,
    mirrored: bool,
}

/// An upper bound on a number that is not negative, at most 2^-20 of the number above it: the upper
/// half of an f64. Scenes store millions of maps, and a bound needs no more digits.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Above(u32);

impl Above {
    const fn of(x: f64) -> Self {
        // The order of positive numbers is that of their bits; the lower half of infinity is zero.
        Self(((x.to_bits() + 0xffff_ffff) >> 32) as u32)
    }

    const fn number(self) -> f64 {
        f64::from_bits((self.0 as u64) << 32)
    }
}

/// Flags of an inverse: bit `3 i + j` is set if the entry of row `i` and column `j` is rounded;
/// another bit if some entry is [`TINY`](Self::TINY).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rounded(u16);

impl Rounded {
    const NONE: Self = Self(0);
    /// Entries below this, other than zero, may have errors of more than half an ulp: see
    /// [`Rounded::slow`].
    const TINY: f64 = crate::scale::pow2(-960);
    const HAS_TINY: u16 = 1 << 9;
    /// Half an ulp, and a little more for an entry that was rounded from a double-double, which
    /// errs, too.
    const HALF_ULP: f64 = U * (1.0 + crate::scale::pow2(-40));
    const EXPONENT: u64 = 0x7ff << 52;

    /// Bounds on the rounding error of each entry.
    #[inline(always)]
    fn errors(self, inverse: &Matrix3) -> Matrix3 {
        let mut errors = [[0.0; 3]; 3];
        if self.0 == 0 {
            return errors;
        }
        if self.0 & Self::HAS_TINY != 0 {
            return self.slow(inverse);
        }
        for i in 0..3 {
            for j in 0..3 {
                let is_rounded = self.0 >> (3 * i + j) & 1 != 0;
                let power = f64::from_bits(inverse[i][j].to_bits() & Self::EXPONENT);
                errors[i][j] = if is_rounded { power * Self::HALF_ULP } else { 0.0 };
            }
        }
        errors
    }

    /// The bounds for tiny entries: at the bottom of the range the double-double errs by a few of
    /// the least number.
    #[cold]
    #[inline(never)]
    fn slow(self, inverse: &Matrix3) -> Matrix3 {
        const FEW: f64 = f64::from_bits(32);
        let error = |bit: usize, x: f64| {
            let power = f64::from_bits(x.to_bits() & Self::EXPONENT);
            if self.0 >> bit & 1 != 0 { power.mul_add(Self::HALF_ULP, FEW) } else { 0.0 }
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| error(3 * i + j, inverse[i][j])))
    }
}

/// Why an affine map cannot be used to place a surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AffineError {
    /// An entry of the matrix is infinite or NaN.
    #[error("transformation: entry ({row}, {column}) of the matrix must be finite, got {value}")]
    Entry {
        /// Its row, from 0.
        row: usize,
        /// Its column, from 0.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A coordinate of the translation is infinite or NaN.
    #[error("transformation: the translation must be finite, got {value} on axis {axis}")]
    Translation {
        /// Its axis, from 0.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// The determinant is exactly zero.
    #[error("transformation: the matrix is singular, its determinant is zero: {0:?}")]
    Singular(Matrix3),
    /// The matrix is so small that its inverse overflows.
    #[error("transformation: the inverse of the matrix is too large for a number: {0:?}")]
    Inverse(Matrix3),
    /// An axis of rotation is zero, infinite or NaN.
    #[error("transformation: an axis of rotation must be finite and not zero, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Axis(Vec3),
    /// An angle is infinite or NaN.
    #[error("transformation: an angle must be finite, got {0}")]
    Angle(f64),
}

impl Affine {
    /// The identity.
    pub const IDENTITY: Self = Self {
        linear: IDENTITY,
        inverse: IDENTITY,
        // The square root of 3, rounded up.
        inverse_norm: Above::of(1.732_050_807_568_877_4),
        centre: Point3::ORIGIN,
        rounded: Rounded::NONE,
        mirrored: false,
    };

    /// The map `x -> centre + L x`, with `L` by rows.
    pub fn new(rows: Matrix3, centre: Point3) -> Result<Self, AffineError> {
        for (row, entries) in rows.iter().enumerate() {
            for (column, &value) in entries.iter().enumerate() {
                if !value.is_finite() {
                    return Err(AffineError::Entry { row, column, value });
                }
            }
        }
        check_translation(centre)?;
        let swift = Isa::detect().run(
            #[inline(always)]
            || Inverse::in_double_double(&rows),
        );
        let Inverse { entries, rounded, mirrored } = match swift {
            Some(inverse) => inverse,
            None => Inverse::in_exact_numbers(&rows)?,
        };
        let inverse_norm = Above::of(frobenius(&entries, &rounded.errors(&entries)));
        Ok(Self { linear: rows, inverse: entries, inverse_norm, centre, rounded, mirrored })
    }

    /// The translation by `v`.
    pub fn translation(v: Vec3) -> Result<Self, AffineError> {
        let centre = v.to_point();
        check_translation(centre)?;
        Ok(Self { centre, ..Self::IDENTITY })
    }

    /// The scaling by `x`, `y`, `z` along the axes.
    pub fn scaling(x: f64, y: f64, z: f64) -> Result<Self, AffineError> {
        Self::new([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]], Point3::ORIGIN)
    }

    /// The rotation about the x axis: y goes to z for +90 degrees.
    pub fn rotation_x(radians: f64) -> Result<Self, AffineError> {
        let (s, c) = sine_and_cosine(radians)?;
        Self::new([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]], Point3::ORIGIN)
    }

    /// The rotation about the y axis: z goes to x, and x to -z, for +90 degrees.
    pub fn rotation_y(radians: f64) -> Result<Self, AffineError> {
        let (s, c) = sine_and_cosine(radians)?;
        Self::new([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]], Point3::ORIGIN)
    }

    /// The rotation about the z axis: x goes to y for +90 degrees.
    pub fn rotation_z(radians: f64) -> Result<Self, AffineError> {
        let (s, c) = sine_and_cosine(radians)?;
        Self::new([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], Point3::ORIGIN)
    }

    /// The rotation about `axis` through the origin, counter-clockwise as seen from its tip
    /// (Rodrigues' formula).
    pub fn rotation(axis: Vec3, radians: f64) -> Result<Self, AffineError> {
        let (s, c) = sine_and_cosine(radians)?;
        let k = axis.normalized().ok_or(AffineError::Axis(axis))?;
        let v = 1.0 - c;
        let row = |i: usize, cross: [f64; 3]| {
            [0, 1, 2].map(|j| {
                let diagonal = if i == j { c } else { 0.0 };
                diagonal + (k[i] * k[j]).mul_add(v, cross[j] * s)
            })
        };
        let rows = [row(0, [0.0, -k.z, k.y]), row(1, [k.z, 0.0, -k.x]), row(2, [-k.y, k.x, 0.0])];
        Self::new(rows, Point3::ORIGIN)
    }

    /// The composition: this map first, then `next`. Computed in f64: each term of the result's
    /// entries is rounded once, and the entries are then exact data.
    pub fn then(&self, next: &Self) -> Result<Self, AffineError> {
        let l = &next.linear;
        let column = |j: usize| Vec3::new(self.linear[0][j], self.linear[1][j], self.linear[2][j]);
        let columns = [0, 1, 2].map(|j| apply(l, column(j)));
        let rows = [0, 1, 2].map(|i| [columns[0][i], columns[1][i], columns[2][i]]);
        let centre = next.point(self.centre);
        if next.linear == IDENTITY {
            // The inverse matrix does not change.
            check_translation(centre)?;
            return Ok(Self { centre, ..*self });
        }
        Self::new(rows, centre)
    }

    /// The inverse map, whose matrix is the rounded inverse and whose centre is rounded too: for
    /// display and cameras. Certified code uses this map's `inverse_point` and
    /// [`Affine::inverse_error`] instead.
    pub fn inverted(&self) -> Result<Self, AffineError> {
        let centre = apply(&self.inverse, -self.centre.to_vec()).to_point();
        Self::new(self.inverse, centre)
    }

    /// `L`, by rows.
    #[inline(always)]
    pub fn linear(&self) -> Matrix3 {
        self.linear
    }

    /// The rounded inverse of `L`, by rows.
    #[inline(always)]
    pub fn inverse_linear(&self) -> Matrix3 {
        self.inverse
    }

    /// For each entry of [`Affine::inverse_linear`] a bound on its distance from the exact inverse
    /// of `L`: zero if it is exact, else half an ulp (for subnormal entries a few of the least
    /// number).
    #[inline(always)]
    pub fn inverse_error(&self) -> Matrix3 {
        self.rounded.errors(&self.inverse)
    }

    /// The image of the origin, `c`.
    #[inline(always)]
    pub fn centre(&self) -> Point3 {
        self.centre
    }

    /// Whether the map mirrors: `det L < 0`, decided exactly.
    #[inline(always)]
    pub fn determinant_is_negative(&self) -> bool {
        self.mirrored
    }

    /// The translation, if the map is only a translation.
    #[inline]
    pub fn as_translation(&self) -> Option<Vec3> {
        (self.linear == IDENTITY).then(|| self.centre.to_vec())
    }

    /// The factor `s > 0`, if `L` is `s` times the identity.
    #[inline]
    pub fn as_uniform_scale(&self) -> Option<f64> {
        let s = self.linear[0][0];
        (s > 0.0 && self.linear == [[s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]]).then_some(s)
    }

    /// The image of a point. Error: at most `gamma(3) (|L||p| + |c|)` in each coordinate.
    #[inline(always)]
    pub fn point(&self, p: Point3) -> Point3 {
        let row = |r: [f64; 3], c: f64| r[0].mul_add(p.x, r[1].mul_add(p.y, r[2].mul_add(p.z, c)));
        Point3::new(
            row(self.linear[0], self.centre.x),
            row(self.linear[1], self.centre.y),
            row(self.linear[2], self.centre.z),
        )
    }

    /// The image of a vector. Error: at most `gamma(3) |L||v|` in each coordinate.
    #[inline(always)]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        apply(&self.linear, v)
    }

    /// The image of a normal, by the inverse transpose; not of unit length. It points to the same
    /// side of the surface, also if the map mirrors.
    #[inline(always)]
    pub fn normal(&self, n: Normal3) -> Normal3 {
        apply_transposed(&self.inverse, n.to_vec()).to_normal()
    }

    /// The point that is mapped to `p`: `Linv (p - c)`. Error: `gamma(4) |Linv||p - c| + E|p - c|`,
    /// `E` the inverse's error.
    #[inline]
    pub fn inverse_point(&self, p: Point3) -> Point3 {
        apply(&self.inverse, p - self.centre).to_point()
    }

    /// The vector that is mapped to `v`. Error: `gamma(3) |Linv||v| + E|v|`.
    #[inline]
    pub fn inverse_vector(&self, v: Vec3) -> Vec3 {
        apply(&self.inverse, v)
    }

    /// The normal that is mapped to `n`, by the transpose of `L`; not of unit length.
    #[inline]
    pub fn inverse_normal(&self, n: Normal3) -> Normal3 {
        apply_transposed(&self.linear, n.to_vec()).to_normal()
    }

    /// An upper bound on `|L| v`, for `v >= 0`: on the images of displacements of up to `v` along
    /// each axis.
    #[inline(always)]
    pub fn linear_reach(&self, v: Vec3) -> Vec3 {
        reach(&self.linear, &[[0.0; 3]; 3], v)
    }

    /// An upper bound on `|L^-1| v` (of the exact inverse), for `v >= 0`.
    #[inline(always)]
    pub fn inverse_reach(&self, v: Vec3) -> Vec3 {
        reach(&self.inverse, &self.inverse_error(), v)
    }

    /// An upper bound on `L`'s spectral norm, the greatest length of the image of a unit vector:
    /// the Frobenius norm (at most `sqrt 3` times too large).
    pub fn linear_norm(&self) -> f64 {
        frobenius(&self.linear, &[[0.0; 3]; 3])
    }

    /// An upper bound on the spectral norm of the exact inverse of `L`.
    pub fn inverse_norm(&self) -> f64 {
        self.inverse_norm.number()
    }

    /// The adjugate of `L` and its determinant in the ring `T`, both times `sign(det L)`, so that
    /// the determinant is positive.
    ///
    /// `adjugate / determinant` is `L^-1`. Predicates about a placed surface multiply by the
    /// determinant instead of dividing, and stay polynomial in the exact data.
    #[inline(always)]
    pub fn adjugate<T: Ring>(&self) -> ([[T; 3]; 3], T) {
        // A function of its own: the compiler may compile the closure of `array::map` separately,
        // without fused instructions.
        #[inline(always)]
        fn exact<T: Ring>(r: [f64; 3]) -> [T; 3] {
            [T::exact(r[0]), T::exact(r[1]), T::exact(r[2])]
        }
        #[inline(always)]
        fn negative<T: Ring>([a, b, c]: [T; 3]) -> [T; 3] {
            [-a, -b, -c]
        }
        let [r, s, t] = self.linear;
        let (a, d) = adjugate(&[exact(r), exact(s), exact(t)]);
        if !self.mirrored {
            return (a, d);
        }
        let [r, s, t] = a;
        ([negative(r), negative(s), negative(t)], -d)
    }

    /// A box that contains the image of `b`, rounded outward: J. Arvo, "Transforming axis-aligned
    /// bounding boxes", Graphics Gems (1990).
    pub fn bounds(&self, b: &Aabb) -> Aabb {
        if b.is_empty() {
            return Aabb::EMPTY;
        }
        Isa::detect().run(
            #[inline(always)]
            || {
                let mut image = [Interval::from(0.0); 3];
                for (i, axis) in image.iter_mut().enumerate() {
                    for j in 0..3 {
                        *axis = *axis + Interval::from(self.linear[i][j]) * Interval::new(b.min[j], b.max[j]);
                    }
                    *axis = *axis + Interval::from(self.centre[i]);
                }
                let [x, y, z] = image;
                Aabb { min: Point3::new(x.lo, y.lo, z.lo), max: Point3::new(x.hi, y.hi, z.hi) }
            },
        )
    }
}

/// The inverse of a matrix, each entry rounded to the nearest number.
struct Inverse {
    entries: Matrix3,
    rounded: Rounded,
    mirrored: bool,
}

impl Inverse {
    /// The inverse by double-double arithmetic with error bounds: a hundredth of the time. `None`
    /// if that does not decide the sign of the determinant, or whether an entry is exact.
    #[inline(always)]
    fn in_double_double(rows: &Matrix3) -> Option<Self> {
        // Three times the exponent, and 106 bits, stay in the range of f64.
        let in_range =
            |x: &f64| *x == 0.0 || (x.abs() > crate::scale::pow2(-100) && x.abs() < crate::scale::pow2(100));
        if !rows.as_flattened().iter().all(in_range) {
            return None;
        }
        let (adjugate, determinant) = adjugate(&rows.map(|r| r.map(EFloat::<Dd>::exact)));
        // Where the determinant is exactly zero there is no inverse, even if all cofactors are
        // zero, too.
        let sign = determinant.sign()?;
        if sign.is_eq() {
            return None;
        }
        let mirrored = sign.is_lt();
        let (mut entries, mut rounded) = ([[0.0; 3]; 3], 0);
        for i in 0..3 {
            for j in 0..3 {
                if adjugate[i][j].v.hi == 0.0 && adjugate[i][j].e == 0.0 {
                    continue;
                }
                let quotient = adjugate[i][j] / determinant;
                let (entry, lost) = (quotient.v.hi, quotient.v.lo.abs());
                // Certainly inexact, and certainly the nearest up to the tolerance of
                // `Rounded::HALF_ULP`.
                let known = lost > quotient.e && quotient.e <= crate::scale::pow2(-94) * entry.abs();
                if !(known && entry.abs() > Rounded::TINY && entry.is_finite()) {
                    return None;
                }
                entries[i][j] = entry;
                rounded |= 1 << (3 * i + j);
            }
        }
        Some(Self { entries, rounded: Rounded(rounded), mirrored })
    }

    fn in_exact_numbers(rows: &Matrix3) -> Result<Self, AffineError> {
        let (adjugate, determinant) = adjugate(&rows.map(|r| r.map(Dyadic::from)));
        if determinant.is_zero() {
            return Err(AffineError::Singular(*rows));
        }
        let (mut entries, mut rounded) = ([[0.0; 3]; 3], 0);
        for i in 0..3 {
            for j in 0..3 {
                let entry = quotient(&adjugate[i][j], &determinant).value();
                if !entry.is_finite() {
                    return Err(AffineError::Inverse(*rows));
                }
                entries[i][j] = entry;
                if adjugate[i][j] != &Dyadic::from(entry) * &determinant {
                    rounded |= 1 << (3 * i + j);
                    rounded |= if entry.abs() < Rounded::TINY { Rounded::HAS_TINY } else { 0 };
                }
            }
        }
        Ok(Self { entries, rounded: Rounded(rounded), mirrored: determinant.exact_sign().is_lt() })
    }
}

fn check_translation(c: Point3) -> Result<(), AffineError> {
    match (0..3).find(|&axis| !c[axis].is_finite()) {
        Some(axis) => Err(AffineError::Translation { axis, value: c[axis] }),
        None => Ok(()),
    }
}

fn sine_and_cosine(radians: f64) -> Result<(f64, f64), AffineError> {
    if radians.is_finite() { Ok(elementary::sin_cos(radians)) } else { Err(AffineError::Angle(radians)) }
}

#[inline(always)]
fn apply(m: &Matrix3, v: Vec3) -> Vec3 {
    let row = |r: [f64; 3]| r[0].mul_add(v.x, r[1].mul_add(v.y, r[2] * v.z));
    Vec3::new(row(m[0]), row(m[1]), row(m[2]))
}

#[inline(always)]
fn apply_transposed(m: &Matrix3, v: Vec3) -> Vec3 {
    let column = |j: usize| m[0][j].mul_add(v.x, m[1][j].mul_add(v.y, m[2][j] * v.z));
    Vec3::new(column(0), column(1), column(2))
}

/// `(|m| + e) v`, rounded up.
#[inline(always)]
fn reach(m: &Matrix3, e: &Matrix3, v: Vec3) -> Vec3 {
    #[inline(always)]
    fn row(m: [f64; 3], e: [f64; 3], v: Vec3) -> f64 {
        let (a, b, c) = (m[0].abs() + e[0], m[1].abs() + e[1], m[2].abs() + e[2]);
        let sum = a.mul_add(v.x, b.mul_add(v.y, c * v.z));
        // Four roundings. If the sum is zero, either all terms are zero or it underflowed.
        let nothing =
            sum == 0.0 && (a == 0.0 || v.x == 0.0) && (b == 0.0 || v.y == 0.0) && (c == 0.0 || v.z == 0.0);
        if nothing { 0.0 } else { sum.mul_add(1.0 + 8.0 * U, f64::MIN_POSITIVE) }
    }
    Vec3::new(row(m[0], e[0], v), row(m[1], e[1], v), row(m[2], e[2], v))
}

fn frobenius(m: &Matrix3, e: &Matrix3) -> f64 {
    let entries = m.as_flattened().iter().zip(e.as_flattened());
    let squares = entries.map(|(&x, &e)| add_up(x.abs(), e)).map(|x| mul_up(x, x));
    sqrt_up(squares.fold(0.0, add_up))
}

/// The adjugate and the determinant.
#[inline(always)]
fn adjugate<T: Ring>(m: &[[T; 3]; 3]) -> ([[T; 3]; 3], T) {
    #[inline(always)]
    fn minor<T: Ring>(m: &[[T; 3]; 3], [a, b]: [usize; 2], [c, d]: [usize; 2]) -> T {
        m[a][c].clone() * m[b][d].clone() - m[a][d].clone() * m[b][c].clone()
    }
    // Entry (i, j) is the cofactor of (j, i); cyclic indices carry the sign.
    let (x, y, z) = ([1, 2], [2, 0], [0, 1]);
    let a = [
        [minor(m, x, x), minor(m, y, x), minor(m, z, x)],
        [minor(m, x, y), minor(m, y, y), minor(m, z, y)],
        [minor(m, x, z), minor(m, y, z), minor(m, z, z)],
    ];
    let determinant = m[0][0].clone() * a[0][0].clone()
        + m[0][1].clone() * a[1][0].clone()
        + m[0][2].clone() * a[2][0].clone();
    (a, determinant)
}

/// The quotient of two exact numbers, with a bound on its error.
fn quotient(n: &Dyadic, d: &Dyadic) -> EFloat<Dd> {
    let ((n, kn), (d, kd)) = (n.to_scaled_dd(), d.to_scaled_dd());
    // `to_scaled_dd` is within 2^-106 of numbers below 2.
    let error = 2.0 * U * U;
    let with_error = |x: Dd| EFloat::with_error(x, if x.hi == 0.0 { 0.0 } else { error });
    let k = (kn - kd).clamp(-3000, 3000) as i32;
    (with_error(n) / with_error(d)).scale2(k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_identity_written_down_is_the_one_that_is_built() {
        let built = Affine::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], Point3::ORIGIN).unwrap();
        assert_eq!(built, Affine::IDENTITY);
    }
}

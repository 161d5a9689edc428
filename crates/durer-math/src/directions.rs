//! Unit lengths, frames and affine combinations.

use crate::eft::two_sum;
use crate::scale::{exponent, ldexp};
use crate::{Normal3, Point3, Vec3, gamma};

/// Why an affine combination of points cannot be formed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CombinationError {
    /// There is no point at all.
    #[error("affine combination: no points")]
    Empty,
    /// The weights do not sum to one.
    #[error("affine combination: weights must sum to 1, they sum to {0}")]
    Weights(f64),
}

impl Point3 {
    /// The point `sum w_i P_i`, for weights `w_i` whose sum is 1.
    ///
    /// Formed as `P_0 + sum_{i>0} w_i (P_i - P_0)`, so that equal points give that point exactly.
    /// Weights such as `1/3` are rounded; their sum, taken here without further error, may differ
    /// from 1 by one rounding of each, `gamma(n) * sum |w_i|`. A greater difference is an error,
    /// and so is a NaN.
    pub fn affine(combination: &[(f64, Self)]) -> Result<Self, CombinationError> {
        let Some(&(_, base)) = combination.first() else { return Err(CombinationError::Empty) };
        let (mut sum, mut low, mut magnitude) = (0.0, 0.0, 0.0);
        for &(w, _) in combination {
            let (s, e) = two_sum(sum, w);
            (sum, low, magnitude) = (s, low + e, magnitude + w.abs());
        }
        let off = ((sum - 1.0) + low).abs();
        if off > gamma(combination.len() as u32) * magnitude || off.is_nan() {
            return Err(CombinationError::Weights(sum + low));
        }
        let mut v = Vec3::ZERO;
        for &(w, p) in &combination[1..] {
            let e = p - base;
            v = Vec3::new(w.mul_add(e.x, v.x), w.mul_add(e.y, v.y), w.mul_add(e.z, v.z));
        }
        Ok(base + v)
    }

    /// The point `(1 - t) self + t other`; exact at `t = 0` and `t = 1`.
    #[inline(always)]
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| t.mul_add(b, (-t).mul_add(a, a));
        Self::new(mix(self.x, other.x), mix(self.y, other.y), mix(self.z, other.z))
    }

    /// The coordinates' absolute values, as a vector.
    #[inline(always)]
    pub fn abs(self) -> Vec3 {
        Vec3::new(self.x.abs(), self.y.abs(), self.z.abs())
    }
}

/// `v` with length 1, safe against over- and underflow: scaled by an exact power of two first.
#[inline]
fn unit(v: Vec3) -> Option<Vec3> {
    let m = v.max_abs();
    if m == 0.0 || !v.is_finite() {
        return None;
    }
    // Most vectors need no scaling, and then one division suffices.
    let v = if (1e-140..1e140).contains(&m) { v } else { v.scale2(-exponent(m)) };
    Some(v / v.length())
}

impl Vec3 {
    /// The vector times `2^k`; exact barring over- and underflow.
    #[inline]
    #[must_use]
    pub fn scale2(self, k: i32) -> Self {
        self.map(|x| ldexp(x, k))
    }

    /// The vector of length 1 in this direction; `None` for zero, infinite or NaN vectors. Each
    /// coordinate is within `4 U` of the exact one, relatively.
    #[inline]
    pub fn normalized(self) -> Option<Self> {
        unit(self)
    }

    /// Two vectors that form, with this unit vector, a right-handed orthonormal frame:
    /// `u x v = self`.
    ///
    /// T. Duff, J. Burgess, P. Christensen, C. Hery, A. Kensler, M. Liani, R. Villemin, "Building
    /// an orthonormal basis, revisited", Journal of Computer Graphics Techniques 6(1), 2017.
    #[inline]
    pub fn orthonormal_basis(self) -> (Self, Self) {
        let sign = 1.0_f64.copysign(self.z);
        let a = -1.0 / (sign + self.z);
        let b = self.x * self.y * a;
        (
            Self::new(1.0 + sign * self.x * self.x * a, sign * b, -sign * self.x),
            Self::new(b, sign + self.y * self.y * a, -self.y),
        )
    }
}

impl Normal3 {
    /// The normal of length 1 in this direction; `None` for zero, infinite or NaN normals. Accurate
    /// as [`Vec3::normalized`].
    #[inline]
    pub fn normalized(self) -> Option<Self> {
        unit(self.to_vec()).map(Vec3::to_normal)
    }
}

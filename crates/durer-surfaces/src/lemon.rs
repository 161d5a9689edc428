//! The lemon: the part of a spindle between two planes across its axis.
//!
//! ```text
//!    y ▲  __ h, radius b
//!      │ ╱  ╲             an arc of radius r through <a, 0> and <b, h> turns about the axis: with its centre at <-R, c>
//!      ││    │              (√(x² + z²) + R)² + (y - c)² = r²,   0 <= y <= h
//!      │ ╲__╱  0, radius a
//! ```
//!
//! It is the inner sheet of the torus that meets itself (see [`Torus`](crate::Torus)), closed by
//! discs where `a` and `b` are not zero. The exact solid has R and c as f64 holds them; an end that
//! is a point is moved inward by the few ulps that it takes for the sheet to reach there.

use crate::revolution::{Profile, SurfaceOfRevolution};
use durer_math::{Dyadic, Ring, U, elementary};

/// Why a lemon cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LemonError {
    /// The height is zero, negative, infinite or NaN.
    #[error("lemon: the distance of its ends must be finite and positive, got {0}")]
    Height(f64),
    /// An end's radius is negative, infinite or NaN.
    #[error("lemon: the radius of an end must be finite and not negative, got {0}")]
    Radius(f64),
    /// An arc of this radius bulges beyond a half circle about the axis, or does not reach from end
    /// to end.
    #[error("lemon: the inner radius must be greater than {least} for these ends, got {inner}")]
    Inner {
        /// The radius of the arc.
        inner: f64,
        /// It must be greater.
        least: f64,
    },
    /// The numbers are beyond the range in which the solid can be described.
    #[error("lemon: its height and radii are too large or too small, or differ too much in size")]
    Range,
}

impl SurfaceOfRevolution {
    /// The lemon from the height 0 with the radius `base` to the height `height` with the radius
    /// `apex`, its profile an arc of radius `inner`.
    pub fn lemon(height: f64, base: f64, apex: f64, inner: f64) -> Result<Self, LemonError> {
        if !(height > 0.0 && height.is_finite()) {
            return Err(LemonError::Height(height));
        }
        for radius in [base, apex] {
            if !(radius >= 0.0 && radius.is_finite()) {
                return Err(LemonError::Radius(radius));
            }
        }
        let chord = elementary::hypot(apex - base, height);
        let middle = 0.5 * (base + apex);
        // With R = 0 the arc's centre is on the axis: half a chord across, and as far along its
        // bisector as leads to the axis.
        let least = elementary::hypot(0.5 * chord, middle * (chord / height));
        if !(inner > least && inner.is_finite()) {
            return Err(LemonError::Inner { inner, least });
        }
        let back = ((inner - 0.5 * chord) * (inner + 0.5 * chord)).sqrt();
        let major = back * (height / chord) - middle;
        let at = 0.5 * height + back * ((apex - base) / chord);
        if !(major > 0.0 && major.is_finite() && at.is_finite()) {
            return Err(LemonError::Inner { inner, least });
        }
        let square = |x: f64| Ring::square(Dyadic::exact(x));
        let room = square(inner) - square(major);
        let reaches =
            |y: f64| (Ring::square(Dyadic::exact(y) - Dyadic::exact(at)) - room.clone()).exact_sign().is_lt();
        let inward = |end: f64, step: f64| {
            let mut ends =
                (0..40).map(|k| if k == 0 { end } else { end + step * durer_math::scale::ldexp(U, k) });
            ends.find(|&y| reaches(y)).ok_or(LemonError::Range)
        };
        let heights = vec![inward(0.0, height)?, inward(height, -height)?];
        let widest = (inner - major).max(base).max(apex);
        Self::of(heights, &[Profile::Spindle { at, major, minor: inner }], widest)
            .map_err(|_| LemonError::Range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_numbers_are_named() {
        assert_eq!(SurfaceOfRevolution::lemon(0.0, 1.0, 1.0, 9.0), Err(LemonError::Height(0.0)));
        assert_eq!(SurfaceOfRevolution::lemon(1.0, -1.0, 1.0, 9.0), Err(LemonError::Radius(-1.0)));
        // A half circle about the axis.
        assert_eq!(
            SurfaceOfRevolution::lemon(2.0, 0.0, 0.0, 1.0),
            Err(LemonError::Inner { inner: 1.0, least: 1.0 })
        );
        assert!(SurfaceOfRevolution::lemon(2.0, 0.0, 0.0, 1.0_f64.next_up().next_up()).is_ok());
        assert!(matches!(SurfaceOfRevolution::lemon(2.0, 3.0, 3.0, 3.0), Err(LemonError::Inner { .. })));
    }
}

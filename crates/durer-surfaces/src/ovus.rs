//! The ovus: an egg of two spheres with a piece of a spindle torus between them.
//!
//! ```text
//!      .-.       top: a sphere of radius b about <0, a, 0>
//!     /   \      a piece of the inner sheet of the torus whose tube of radius r = 2 max(a, b)
//!    (     )     touches both spheres from outside; its circle has the height c and the radius R:
//!     `---'        R² + c² = (r - a)²,   R² + (c - a)² = (r - b)²
//!                bottom: a sphere of radius a about the origin
//! ```
//!
//! The three pieces have common tangents where they meet, at the heights `-c a / (r - a)` and
//! `a + (a - c) b / (r - b)`. With `b >= 2a` the upper sphere contains the lower one and is the
//! whole solid. The definition is that of POV-Ray's documentation ("Ovus"). The exact solid has R,
//! c and the heights as rounded to f64.

use crate::revolution::{Profile, SurfaceOfRevolution};
use durer_math::U;

/// Why an ovus cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OvusError {
    /// A radius is zero, negative, infinite or NaN.
    #[error("ovus: the {0} radius must be finite and positive, got {1}")]
    Radius(&'static str, f64),
    /// The radii are too different, or beyond the range in which the solid can be described.
    #[error("ovus: radii {0} and {1} are too large or too small, or differ too much in size")]
    Range(f64, f64),
}

impl SurfaceOfRevolution {
    /// The ovus about the y axis with the radius `bottom` about the origin and `top` about the
    /// point `bottom` above it.
    pub fn ovus(bottom: f64, top: f64) -> Result<Self, OvusError> {
        for (name, radius) in [("bottom", bottom), ("top", top)] {
            if !(radius > 0.0 && radius.is_finite()) {
                return Err(OvusError::Radius(name, radius));
            }
        }
        let unfit = |_| OvusError::Range(bottom, top);
        // Poles lie strictly between the ends, so that rounding cannot cut them off.
        let beyond = |y: f64| y * (1.0 + 16.0 * U);
        let ball = |at: f64, r: f64| Profile::Cubic { at, a: [r * r, 0.0, -1.0, 0.0] };
        let (a, b) = (bottom, top);
        let peak = beyond(a + b);
        if b >= 2.0 * a {
            let low = a - b - (peak - (a + b));
            return Self::of(vec![low, peak], &[ball(a, b)], b).map_err(unfit);
        }
        let r = 2.0 * a.max(b);
        let (from_a, from_b) = (r - a, r - b);
        // (r - a)² - (r - b)² as a product.
        let at = ((b - a) * (from_a + from_b) + a * a) / (2.0 * a);
        let major = ((from_a - at) * (from_a + at)).max(0.0).sqrt();
        let (low, high) = (-at * a / from_a, a + (a - at) * b / from_b);
        let spindle = Profile::Spindle { at, major, minor: r };
        let heights = vec![beyond(-a), low, high, peak];
        Self::of(heights, &[ball(0.0, a), spindle, ball(a, b)], a.max(b)).map_err(unfit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_radii_are_named() {
        assert_eq!(SurfaceOfRevolution::ovus(0.0, 1.0), Err(OvusError::Radius("bottom", 0.0)));
        assert_eq!(
            SurfaceOfRevolution::ovus(1.0, f64::INFINITY),
            Err(OvusError::Radius("top", f64::INFINITY))
        );
        assert_eq!(SurfaceOfRevolution::ovus(1.0, 1e-300), Err(OvusError::Range(1.0, 1e-300)));
    }
}

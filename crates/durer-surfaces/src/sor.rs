//! POV-Ray's surface of revolution: between successive points the squared radius is a cubic of the
//! height.
//!
//! ```text
//!    y ▲   · <r_3, h_3>      r²(h) = a₀ + a₁ v + a₂ v² + a₃ v³,  v = h - h_i,  h_i <= h <= h_{i+1}
//!      │  ( <r_2, h_2>       r(h_i) = r_i,   r(h_{i+1}) = r_{i+1}
//!      │   ) <r_1, h_1>      (r²)'(h_i) = 2 r_i (r_{i+1} - r_{i-1}) / (h_{i+1} - h_{i-1})
//!      └──· <r_0, h_0> ──▶ r
//! ```
//!
//! The first and the last point only determine the slopes at their neighbours, so the curve is
//! smooth, and `x² + z² = r²(y)` is a cubic along a ray. The choice of this cubic follows POV-Ray's
//! documentation ("Surface of Revolution"); `revolution/` intersects it with rays. The exact
//! surface has the coefficients as rounded to f64: at a height between two of its cubics their
//! radii may differ in the last bits, and the difference of the two discs is a flat ring of that
//! width.

use crate::revolution::{Profile, SurfaceOfRevolution};

/// Why a surface of revolution cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SorError {
    /// The curve needs at least four points.
    #[error("sor: it needs 4 points at least, and has {0}")]
    TooFew(usize),
    /// A radius or height is infinite or NaN, or a radius negative.
    #[error(
        "sor: a point has a radius that is not negative, and a height, both finite; got <{radius}, {height}>"
    )]
    Point {
        /// The radius.
        radius: f64,
        /// The height.
        height: f64,
    },
    /// Heights must ascend: each point on the curve must be higher than the one before it. The
    /// first and the last point must differ in height from the next but one.
    #[error("sor: heights must ascend, but {0} comes before {1}")]
    Heights(f64, f64),
    /// The curve has no inside, or its numbers are beyond the range in which it can be described.
    #[error("sor: its radii and heights are too large or too small, or differ too much in size")]
    Range,
}

impl SurfaceOfRevolution {
    /// The surface of revolution through `points`, each a radius and a height; the first and the
    /// last one are not on it. It is closed by flat ends.
    pub fn sor(points: &[[f64; 2]]) -> Result<Self, SorError> {
        if points.len() < 4 {
            return Err(SorError::TooFew(points.len()));
        }
        let fits = |[r, h]: &[f64; 2]| *r >= 0.0 && r.is_finite() && h.is_finite();
        if let Some(&[radius, height]) = points.iter().find(|p| !fits(p)) {
            return Err(SorError::Point { radius, height });
        }
        let last = points.len() - 2;
        let on_curve = &points[1..=last];
        if let Some(w) = on_curve.windows(2).find(|w| w[0][1] >= w[1][1]) {
            return Err(SorError::Heights(w[0][1], w[1][1]));
        }
        // The derivative of r² at a point, from its neighbours.
        let slope = |i: usize| {
            let ([r0, h0], [r1, h1]) = (points[i - 1], points[i + 1]);
            if h0 >= h1 {
                return Err(SorError::Heights(h0, h1));
            }
            Ok(2.0 * points[i][0] * ((r1 - r0) / (h1 - h0)))
        };
        let mut profiles = Vec::with_capacity(on_curve.len() - 1);
        for i in 1..last {
            let ([r0, h0], [r1, h1]) = (points[i], points[i + 1]);
            let (m0, m1, width) = (slope(i)?, slope(i + 1)?, h1 - h0);
            // C. Hermite's cubic through two values with two slopes.
            let (p0, p1) = (r0 * r0, r1 * r1);
            let secant = (p1 - p0) / width;
            let a2 = (3.0 * secant - 2.0 * m0 - m1) / width;
            let a3 = (m0 + m1 - 2.0 * secant) / (width * width);
            profiles.push(Profile::Cubic { at: h0, a: [p0, m0, a2, a3] });
        }
        let heights = on_curve.iter().map(|p| p[1]).collect();
        let widest = on_curve.iter().map(|p| p[0]).fold(0.0, f64::max);
        Self::of(heights, &profiles, widest).map_err(|_| SorError::Range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_curves_are_named() {
        assert_eq!(SurfaceOfRevolution::sor(&[[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]), Err(SorError::TooFew(3)));
        let low = SurfaceOfRevolution::sor(&[[1.0, 0.0], [1.0, 2.0], [1.0, 1.0], [1.0, 3.0]]);
        assert_eq!(low, Err(SorError::Heights(2.0, 1.0)));
        let back = SurfaceOfRevolution::sor(&[[1.0, 5.0], [1.0, 1.0], [1.0, 2.0], [1.0, 3.0]]);
        assert_eq!(back, Err(SorError::Heights(5.0, 2.0)));
        let inward = SurfaceOfRevolution::sor(&[[1.0, 0.0], [-1.0, 1.0], [1.0, 2.0], [1.0, 3.0]]);
        assert_eq!(inward, Err(SorError::Point { radius: -1.0, height: 1.0 }));
        let wild = SurfaceOfRevolution::sor(&[[1.0, 0.0], [1e200, 1.0], [1.0, 2.0], [1.0, 3.0]]);
        assert_eq!(wild, Err(SorError::Range));
    }
}

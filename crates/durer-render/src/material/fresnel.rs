//! The border between two clear media: Snell's law of refraction and Fresnel's reflectance.

use crate::vector::dot;
use durer_math::Vec3;

/// The part of unpolarised light that is reflected, for light that falls at an angle of cosine `cosine >= 0` from a medium of index `n` times
/// that of the medium behind (`n = n_from / n_to`); 1 beyond the critical angle.
pub(crate) fn reflectance(n: f64, cosine: f64) -> f64 {
    let sine2 = n * n * (1.0 - cosine * cosine);
    if sine2 >= 1.0 {
        return 1.0;
    }
    let inner = (1.0 - sine2).sqrt();
    let along = (n * cosine - inner) / (n * cosine + inner);
    let across = (cosine - n * inner) / (cosine + n * inner);
    let r = 0.5 * (along * along + across * across);
    if r.is_nan() { 1.0 } else { r.clamp(0.0, 1.0) }
}

/// The unit direction in which light of unit direction `d` goes on behind a surface with unit normal `normal` that faces it
/// (`d . normal <= 0`), from a medium of index `n` times that behind; `None` if it is totally reflected.
pub(crate) fn refract(d: Vec3, normal: Vec3, n: f64) -> Option<Vec3> {
    let cosine = -dot(d, normal);
    let sine2 = n * n * (1.0 - cosine * cosine);
    if sine2 > 1.0 {
        return None;
    }
    let inner = (1.0 - sine2).sqrt();
    Some(d * n + normal * (n * cosine - inner))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::elementary::{asin, cos, sin};

    fn falling(angle: f64) -> Vec3 {
        Vec3::new(sin(angle), -cos(angle), 0.0)
    }

    #[test]
    fn snells_law_holds() {
        for n in [1.0 / 1.5, 1.5, 1.0] {
            for angle in [0.0, 0.1, 0.5, 0.7] {
                let Some(out) = refract(falling(angle), Vec3::Y, n) else {
                    assert!(n * sin(angle) > 1.0);
                    continue;
                };
                assert!((out.x - n * sin(angle)).abs() < 1e-15, "{n} {angle}");
                assert!((dot(out, out) - 1.0).abs() < 1e-15);
                assert!(out.y < 0.0);
            }
        }
    }

    #[test]
    fn the_critical_angle_divides() {
        let critical = asin(1.0 / 1.5);
        assert!(refract(falling(critical - 1e-9), Vec3::Y, 1.5).is_some());
        assert!(refract(falling(critical + 1e-9), Vec3::Y, 1.5).is_none());
        assert_eq!(reflectance(1.5, cos(critical + 1e-9)), 1.0);
        assert!(reflectance(1.5, cos(critical - 1e-9)) < 1.0);
    }

    #[test]
    fn head_on_a_glass_reflects_four_percent() {
        assert!((reflectance(1.0 / 1.5, 1.0) - 0.04).abs() < 1e-15);
        assert!((reflectance(1.5, 1.0) - 0.04).abs() < 1e-15);
        assert_eq!(reflectance(1.0, 0.5), 0.0);
    }

    /// All bounces inside a clear plate together let `T = 2 n / (n^2 + 1)` pass head-on (the textbook sum of the geometric series).
    #[test]
    fn a_plate_lets_through_what_the_series_says() {
        let n = 1.5;
        let r = reflectance(1.0 / n, 1.0);
        let mut through = 0.0;
        let mut inside = 1.0 - r;
        for _ in 0..100 {
            through += inside * (1.0 - r);
            inside *= r * r;
        }
        assert!((through - 2.0 * n / (n * n + 1.0)).abs() < 1e-14);
    }

    /// Brewster's angle: no light with the electric field in the plane of incidence is reflected, so half of `across` is left.
    #[test]
    fn brewsters_angle_is_where_one_half_vanishes() {
        let n = 1.5_f64;
        let angle = durer_math::elementary::atan(n);
        let (c, n_inv) = (cos(angle), 1.0 / n);
        let inner = (1.0 - n_inv * n_inv * (1.0 - c * c)).sqrt();
        let s = (n_inv * c - inner) / (n_inv * c + inner);
        assert!((reflectance(n_inv, c) - 0.5 * s * s).abs() < 1e-15);
    }
}

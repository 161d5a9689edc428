//! The interface between two clear media: Snell's law of refraction and Fresnel's reflectance.

use crate::vector::dot;
use durer_math::{F8, M8, Vec3};

/// The fraction of unpolarised light that is reflected. The light arrives at an angle of cosine
/// `cosine`, from a medium whose index is `n` times that of the medium behind
/// (`n = n_from / n_to`). The answer is 1 beyond the critical angle and where
/// the cosine is negative.
#[inline(always)]
pub(crate) fn reflectance(n: f64, cosine: F8) -> F8 {
    let sine2 = (F8::ONE - cosine * cosine) * (n * n);
    let inner = (F8::ONE - sine2).sqrt();
    let (bent, bent_inner) = (cosine * n, inner * n);
    let along = (bent - inner) / (bent + inner);
    let across = (cosine - bent_inner) / (cosine + bent_inner);
    let r = (along * along + across * across) * 0.5;
    // NaN gives 1 too.
    let partial = sine2.lt(F8::ONE) & r.lt(F8::ONE);
    partial.select(r.max(F8::ZERO), F8::ONE)
}

/// The unit directions of refracted light, and the lanes where light is refracted; elsewhere it is
/// totally reflected. `d` are unit directions, `normal` unit normals that face them
/// (`d . normal <= 0`), and the index of the first medium is `n` times that of the medium behind.
#[inline(always)]
pub(crate) fn refract(d: Vec3<F8>, normal: Vec3<F8>, n: f64) -> (Vec3<F8>, M8) {
    let cosine = -dot(d, normal);
    let sine2 = (F8::ONE - cosine * cosine) * (n * n);
    let inner = (F8::ONE - sine2).sqrt();
    (d * F8::splat(n) + normal * (cosine * n - inner), !(F8::ONE).lt(sine2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::elementary::{asin, cos, sin};

    fn falling(angle: f64) -> Vec3 {
        Vec3::new(sin(angle), -cos(angle), 0.0)
    }

    fn refract(d: Vec3, normal: Vec3, n: f64) -> Option<Vec3> {
        let (out, passes) = super::refract(Vec3::<F8>::splat(d), Vec3::<F8>::splat(normal), n);
        (passes == M8::ALL).then(|| out.lane(3))
    }

    fn reflectance(n: f64, cosine: f64) -> f64 {
        super::reflectance(n, F8::splat(cosine)).0[7]
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

    #[test]
    fn a_normal_that_points_away_reflects_all() {
        for (n, cosine) in [(1.5, -0.1), (1.0 / 1.5, -0.1), (1.0 / 1.4, -0.9)] {
            assert_eq!(reflectance(n, cosine), 1.0, "{n} {cosine}");
        }
    }

    /// All bounces inside a clear plate together let `T = 2 n / (n^2 + 1)` pass head-on (the
    /// textbook sum of the geometric series).
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

    /// Brewster's angle: no light with the electric field in the plane of incidence is reflected,
    /// so half of `across` is left.
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

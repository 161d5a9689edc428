//! Metals: highlights and reflections take the pigment's colour, except at grazing angles.

use crate::lanes::Rgb8;
use core::f64::consts::FRAC_2_PI;
use durer_math::{F8, M8, elementary};

/// How near to grazing an angle is, from 0 (head-on) to 1: the scene language's fit to Fresnel's
/// formula for metals, `0.014567225 / (x - 1.12)^2 - 0.011612903` with `x` the angle in units of 90
/// degrees.
fn grazing(cosine: f64) -> f64 {
    let x = elementary::acos(cosine.clamp(-1.0, 1.0)) * FRAC_2_PI;
    let d = x - 1.12;
    (0.014_567_225 / (d * d) - 0.011_612_903).clamp(0.0, 1.0)
}

/// The factor of light that a surface of colour `colour`, metallic to the degree `metallic`,
/// reflects.
#[inline(always)]
pub(crate) fn tint(metallic: f64, cosine: F8, colour: Rgb8, live: M8) -> Rgb8 {
    let mut grazed = F8::ZERO;
    for i in live.lanes() {
        grazed.0[i] = grazing(cosine.0[i]);
    }
    let k = (F8::ONE - grazed) * metallic;
    colour.map(
        #[inline(always)]
        |c| F8::ONE + k * (c - F8::ONE),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Rgb;

    #[test]
    fn head_on_the_pigment_shows_and_grazing_it_does_not() {
        let c = Rgb::new(1.0, 0.5, 0.0);
        let of = |metallic, cosine, c| tint(metallic, F8::splat(cosine), Rgb8::splat(c), M8::ALL).lane(2);
        let head_on = of(1.0, 1.0, c);
        assert!((head_on.g - 0.5).abs() < 1e-6 && head_on.b.abs() < 1e-6);
        let flat = of(1.0, 0.0, c);
        assert!(flat.b > 0.99);
        assert_eq!(of(0.0, 0.7, c), Rgb::WHITE);
    }
}

//! Metals: highlights and mirror images that take the pigment's colour, except at grazing angles.

use core::f64::consts::FRAC_2_PI;
use durer_math::elementary;
use durer_scene::Rgb;

/// How near to grazing an angle is, from 0 (head-on) to 1: the scene language's fit to Fresnel's formula for metals,
/// `0.014567225 / (x - 1.12)^2 - 0.011612903` with `x` the angle in units of 90 degrees.
fn grazing(cosine: f64) -> f64 {
    let x = elementary::acos(cosine.clamp(-1.0, 1.0)) * FRAC_2_PI;
    let d = x - 1.12;
    (0.014_567_225 / (d * d) - 0.011_612_903).clamp(0.0, 1.0)
}

/// What light is multiplied by at a surface of colour `colour` that is metallic to the degree `metallic`.
pub(crate) fn tint(metallic: f64, cosine: f64, colour: Rgb) -> Rgb {
    let k = metallic * (1.0 - grazing(cosine));
    colour.map(|c| 1.0 + k * (c - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn head_on_the_pigment_shows_and_grazing_it_does_not() {
        let c = Rgb::new(1.0, 0.5, 0.0);
        let head_on = tint(1.0, 1.0, c);
        assert!((head_on.g - 0.5).abs() < 1e-6 && head_on.b.abs() < 1e-6);
        let flat = tint(1.0, 0.0, c);
        assert!(flat.b > 0.99);
        assert_eq!(tint(0.0, 0.7, c), Rgb::WHITE);
    }
}

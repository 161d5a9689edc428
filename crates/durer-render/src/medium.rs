//! What fills objects, made ready.

use crate::power::Power;
use durer_math::elementary;
use durer_scene::{Interior, Rgb};

/// What fills an object.
#[derive(Clone, Debug)]
pub(crate) struct Medium {
    /// The index of refraction.
    pub(crate) ior: f64,
    fade: Option<Fade>,
    /// The exponent of the brightening of shadows.
    pub(crate) caustics: Option<Power>,
}

#[derive(Clone, Copy, Debug)]
struct Fade {
    distance: f64,
    /// `None` for exponential fading.
    power: Option<Power>,
    colour: Rgb,
}

/// From this power on light fades exponentially: a fact of the scene language.
const EXPONENTIAL: f64 = 1000.0;

impl Medium {
    pub(crate) fn new(interior: &Interior) -> Self {
        let fade = (interior.fade_distance > 0.0).then(|| Fade {
            distance: interior.fade_distance,
            power: (interior.fade_power < EXPONENTIAL).then(|| Power::new(interior.fade_power)),
            colour: interior.fade_color,
        });
        let caustics = (interior.caustics != 0.0).then(|| Power::new(interior.caustics));
        Self { ior: interior.ior, fade, caustics }
    }

    /// What is left of light after a distance in the medium.
    #[inline]
    pub(crate) fn left_after(&self, distance: f64) -> Rgb {
        let Some(fade) = &self.fade else { return Rgb::WHITE };
        let depth = distance / fade.distance;
        match fade.power {
            Some(power) => {
                let k = 1.0 / (1.0 + power.of(depth));
                fade.colour.map(|c| c + (1.0 - c) * k)
            }
            None => fade.colour.map(|c| elementary::exp((c - 1.0) * depth)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_fades_to_the_fade_colour() {
        let interior = Interior {
            fade_distance: 2.0,
            fade_power: 2.0,
            fade_color: Rgb::new(1.0, 0.5, 0.0),
            ..Default::default()
        };
        let left = Medium::new(&interior).left_after(2.0);
        assert_eq!(left, Rgb::new(1.0, 0.75, 0.5));
        let far = Medium::new(&interior).left_after(1e9);
        assert!((far.g - 0.5).abs() < 1e-12 && far.b < 1e-12);
    }

    #[test]
    fn a_great_power_fades_exponentially() {
        let interior = Interior { fade_distance: 2.0, fade_power: 1000.0, ..Default::default() };
        let left = Medium::new(&interior).left_after(6.0);
        assert!((left.r - elementary::exp(-3.0)).abs() < 1e-15);
    }

    #[test]
    fn without_a_distance_nothing_fades() {
        let interior = Interior { fade_power: 2.0, ..Default::default() };
        assert_eq!(Medium::new(&interior).left_after(5.0), Rgb::WHITE);
    }
}

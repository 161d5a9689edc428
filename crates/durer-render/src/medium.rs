//! What fills objects, made ready.

use crate::lanes::Rgb8;
use crate::power::Power;
use durer_math::{F8, M8, elementary};
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

    /// What is left of light after some distances in the medium.
    #[inline(always)]
    pub(crate) fn left_after(&self, distance: F8, live: M8) -> Rgb8 {
        let Some(fade) = &self.fade else { return Rgb8::WHITE };
        let depth = distance / fade.distance;
        let colour = Rgb8::splat(fade.colour);
        match fade.power {
            Some(power) => {
                let k = F8::ONE / (F8::ONE + power.lanes(depth, live));
                colour.map(
                    #[inline(always)]
                    |c| c + (F8::ONE - c) * k,
                )
            }
            None => {
                let mut left = Rgb8::WHITE;
                for i in live.lanes() {
                    left.set_lane(i, fade.colour.map(|c| elementary::exp((c - 1.0) * depth.0[i])));
                }
                left
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_after(interior: &Interior, distance: f64) -> Rgb {
        Medium::new(interior).left_after(F8::splat(distance), M8::ALL).lane(5)
    }

    #[test]
    fn light_fades_to_the_fade_colour() {
        let interior = Interior {
            fade_distance: 2.0,
            fade_power: 2.0,
            fade_color: Rgb::new(1.0, 0.5, 0.0),
            ..Default::default()
        };
        let left = left_after(&interior, 2.0);
        assert_eq!(left, Rgb::new(1.0, 0.75, 0.5));
        let far = left_after(&interior, 1e9);
        assert!((far.g - 0.5).abs() < 1e-12 && far.b < 1e-12);
    }

    #[test]
    fn a_great_power_fades_exponentially() {
        let interior = Interior { fade_distance: 2.0, fade_power: 1000.0, ..Default::default() };
        let left = left_after(&interior, 6.0);
        assert!((left.r - elementary::exp(-3.0)).abs() < 1e-15);
    }

    #[test]
    fn without_a_distance_nothing_fades() {
        let interior = Interior { fade_power: 2.0, ..Default::default() };
        assert_eq!(left_after(&interior, 5.0), Rgb::WHITE);
    }
}

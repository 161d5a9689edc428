//! The media that fill objects, with their constants precomputed.

use crate::lanes::Rgb8;
use crate::power::Power;
use durer_math::{F8, M8, elementary};
use durer_scene::{Interior, Rgb};

/// The medium that fills an object.
#[derive(Clone, Debug)]
pub(crate) struct Medium {
    /// The index of refraction.
    pub(crate) ior: f64,
    fade: Option<Fade>,
    /// The factor of the light behind a surface.
    pub(crate) refraction: f64,
    /// The exponent with which caustics brighten shadows.
    pub(crate) caustics: Option<Power>,
}

#[derive(Clone, Copy, Debug)]
struct Fade {
    distance: f64,
    /// `None` for exponential fading.
    power: Option<Power>,
    colour: Rgb,
    /// False without a positive power: then shadows do not fade, although light to the eye does (a
    /// fact of the scene language).
    fades_shadows: bool,
}

/// From this power on, light fades exponentially (a fact of the scene language).
const EXPONENTIAL: f64 = 1000.0;

/// A distance of this magnitude or less counts as no distance, for interiors and lights (a fact of
/// the scene language).
pub(crate) const NO_DISTANCE: f64 = 1e-10;

impl Medium {
    pub(crate) fn new(interior: &Interior) -> Self {
        let fade = (interior.fade_distance.abs() > NO_DISTANCE).then(|| Fade {
            distance: interior.fade_distance,
            power: (interior.fade_power < EXPONENTIAL).then(|| Power::new(interior.fade_power)),
            colour: interior.fade_color,
            fades_shadows: interior.fade_power > 0.0,
        });
        let caustics = (interior.caustics != 0.0).then(|| Power::new(interior.caustics));
        Self { ior: interior.ior, refraction: interior.refraction, fade, caustics }
    }

    /// The transmittance of the medium over these distances, for shadow rays.
    #[inline(always)]
    pub(crate) fn shadow_after(&self, distance: F8, live: M8) -> Rgb8 {
        match &self.fade {
            Some(fade) if fade.fades_shadows => self.left_after(distance, live),
            _ => Rgb8::WHITE,
        }
    }

    /// The transmittance of the medium over these distances. With a negative fade distance the
    /// formula is evaluated unchanged; where the power is undefined the result is 0.
    #[inline(always)]
    pub(crate) fn left_after(&self, distance: F8, live: M8) -> Rgb8 {
        let Some(fade) = &self.fade else { return Rgb8::WHITE };
        let depth = distance / fade.distance;
        let colour = Rgb8::splat(fade.colour);
        match fade.power {
            Some(power) => {
                let k = F8::ONE / (F8::ONE + power.signed_lanes(depth, live));
                let is_number = k.equals(k);
                colour.map(
                    #[inline(always)]
                    |c| is_number.keep(c + (F8::ONE - c) * k),
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
    fn a_negative_distance_fades_by_the_formula() {
        let at = |fade_power| {
            left_after(&Interior { fade_distance: -2.0, fade_power, ..Default::default() }, 6.0).r
        };
        let near = |got: f64, wanted: f64| (got - wanted).abs() <= 4.0 * f64::EPSILON;
        let pairs = [(1.0, -0.5), (2.0, 0.1), (-1.0, 1.5), (0.5, 0.0)];
        assert!(pairs.iter().all(|&(power, wanted)| near(at(power), wanted)));
        assert!((at(1000.0) - elementary::exp(3.0)).abs() < 1e-14);
    }

    #[test]
    fn without_a_positive_power_shadows_do_not_fade() {
        let both = |fade_power| {
            let medium = Medium::new(&Interior { fade_distance: 2.0, fade_power, ..Default::default() });
            let d = F8::splat(6.0);
            [medium.left_after(d, M8::ALL).r.0[0], medium.shadow_after(d, M8::ALL).r.0[0]]
        };
        assert_eq!([both(0.0), both(-1.0), both(1.0)], [[0.5, 1.0], [0.75, 1.0], [0.25, 0.25]]);
    }

    #[test]
    fn distances_next_to_zero_are_none() {
        let at = |fade_distance| {
            left_after(&Interior { fade_distance, fade_power: 1.0, ..Default::default() }, 5.0)
        };
        assert_eq!([at(1e-10), at(-1e-10)], [Rgb::WHITE; 2]);
        assert!(at(1.1e-10).r < 1e-10);
    }

    #[test]
    fn without_a_distance_nothing_fades() {
        let interior = Interior { fade_power: 2.0, ..Default::default() };
        assert_eq!(left_after(&interior, 5.0), Rgb::WHITE);
    }
}

//! Waveforms, which map a number from 0 to 1 to another.

use crate::power::Power;
use crate::vector::{floor, floor_lanes};
use core::f64::consts::{PI, TAU};
use durer_math::{F8, M8, elementary};
use durer_scene::Wave;

/// A [`Wave`] with its constants precomputed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Ramp,
    Triangle,
    Sine,
    Scallop,
    Cubic,
    Poly(Power),
}

impl Shape {
    pub(super) fn new(wave: Wave) -> Self {
        match wave {
            Wave::Ramp => Self::Ramp,
            Wave::Triangle => Self::Triangle,
            Wave::Sine => Self::Sine,
            Wave::Scallop => Self::Scallop,
            Wave::Cubic => Self::Cubic,
            Wave::Poly(exponent) => Self::Poly(Power::new(exponent)),
        }
    }

    #[inline]
    pub(super) fn bend(self, w: f64) -> f64 {
        match self {
            Self::Ramp => w,
            Self::Triangle => {
                // Without a frequency values may be above 1, where the triangle begins anew (a fact of the
                // scene language).
                let w = if w > 1.0 { w - floor(w) } else { w };
                2.0 * if w < 0.5 { w } else { 1.0 - w }
            }
            Self::Sine => (1.0 + elementary::sin(TAU * w)) * 0.5,
            Self::Scallop => elementary::sin(PI * w).abs(),
            Self::Cubic => w * w * (3.0 - 2.0 * w),
            Self::Poly(power) => power.of(w),
        }
    }

    /// The values for eight numbers.
    #[inline(always)]
    pub(super) fn bend_lanes(self, w: F8, live: M8) -> F8 {
        match self {
            Self::Ramp => w,
            Self::Triangle => {
                let w = (F8::ONE).lt(w).select(w - floor_lanes(w), w);
                w.lt(F8::splat(0.5)).select(w, F8::ONE - w) * 2.0
            }
            Self::Cubic => w * w * (F8::splat(3.0) - w * 2.0),
            Self::Poly(power) => power.lanes(w, live),
            Self::Sine | Self::Scallop => {
                let mut bent = F8::ZERO;
                for i in live.lanes() {
                    bent.0[i] = self.bend(w.0[i]);
                }
                bent
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_of_each_wave() {
        let quarters = |wave| [0.0, 0.25, 0.5, 0.75].map(|w| (Shape::new(wave).bend(w) * 1e6).round() / 1e6);
        assert_eq!(quarters(Wave::Triangle), [0.0, 0.5, 1.0, 0.5]);
        assert_eq!(quarters(Wave::Sine), [0.5, 1.0, 0.5, 0.0]);
        let half_root = (core::f64::consts::FRAC_1_SQRT_2 * 1e6).round() / 1e6;
        assert_eq!(quarters(Wave::Scallop), [0.0, half_root, 1.0, half_root]);
        assert_eq!(quarters(Wave::Cubic), [0.0, 0.15625, 0.5, 0.84375]);
        assert_eq!(quarters(Wave::Poly(2.0)), [0.0, 0.0625, 0.25, 0.5625]);
    }
}

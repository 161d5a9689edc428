//! Waves around random centres.

use core::f64::consts::TAU;
use durer_math::{Point3, Vec3, elementary};
use durer_scene::Ripples;

use crate::vector::{floor, length, unit};

/// The number of centres.
const COUNT: usize = 10;

/// The centres of waves, all in the unit cube.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Centres {
    centres: [Centre; COUNT],
    phase: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Centre {
    at: Point3,
    frequency: f64,
    height: f64,
    slope: f64,
}

/// Of waves, all heights times the frequency. With it the spread of the value is that of POV-Ray's.
const HEIGHT: f64 = 0.017_94;
/// The same for slopes.
const SLOPE: f64 = 0.084_6;

impl Centres {
    pub(super) fn new(ripples: &Ripples) -> Self {
        let mut state = 0x9e37_79b9_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1_u32 << 24)
        };
        let centre = |i: usize| {
            let at = Point3::new(random(), random(), random());
            let own = if ripples.waves { 0.15 + 0.09 * i as f64 } else { 1.0 };
            let height = if ripples.waves { HEIGHT / own } else { 0.5 / COUNT as f64 };
            let slope = if ripples.waves { SLOPE / own } else { 1.0 / COUNT as f64 };
            Centre { at, frequency: own * ripples.frequency, height, slope }
        };
        Self { centres: core::array::from_fn(centre), phase: ripples.phase }
    }

    /// The mean slope of the waves at a point.
    pub(super) fn vector(&self, p: Point3) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for centre in &self.centres {
            let away = p - centre.at;
            let turns = length(away) * centre.frequency + self.phase;
            let slope = elementary::sin(TAU * (turns - floor(turns))) * centre.slope;
            sum += unit(away) * slope;
        }
        sum
    }

    /// The mean height of the waves at a point.
    pub(super) fn value(&self, p: Point3) -> f64 {
        let mut sum = 0.5;
        for centre in &self.centres {
            let turns = length(p - centre.at) * centre.frequency + self.phase;
            sum += elementary::sin(TAU * (turns - floor(turns))) * centre.height;
        }
        sum
    }
}

//! Waves around random centres.

use core::f64::consts::TAU;
use durer_math::{Point3, Vec3, elementary};
use durer_scene::Ripples;

use crate::texture::{Grains, number_of_waves};
use crate::vector::{floor, length, unit};

/// The number of centres for which the heights and slopes below are given.
const USUAL: f64 = 10.0;

/// The centres of waves, all in the unit cube.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Centres {
    centres: Box<[Centre]>,
    phase: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Centre {
    at: Point3,
    frequency: f64,
    height: f64,
    slope: f64,
}

/// For waves, each height times the frequency. With it the spread of the values equals POV-Ray's.
const HEIGHT: f64 = 0.017_94;
/// For waves, each slope times the frequency.
const SLOPE: f64 = 0.084_6;

/// The heights and slopes of POV-Ray's waves, times the frequency, and the state of the linear
/// congruential generator of their frequencies: found from values of the pattern in POV-Ray 3.7.
const LEARNED_HEIGHT: f64 = 0.02;
const LEARNED_SLOPE: f64 = 0.1;
const LEARNED_STATE: u32 = 0x745d_9d9e;

impl Centres {
    pub(super) fn new(ripples: &Ripples) -> Self {
        let mut state = 0x9e37_79b9_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1_u32 << 24)
        };
        let grains = Grains::current();
        let is_learned = grains != Grains::Own;
        let count = number_of_waves();
        let share = USUAL / f64::from(count);
        let (height, slope) = if is_learned { (LEARNED_HEIGHT, LEARNED_SLOPE) } else { (HEIGHT, SLOPE) };
        let (height, slope) = (height * share, slope * share);
        let mut learned_state = LEARNED_STATE;
        let centre = |i: u32| {
            let mut at = Point3::new(random(), random(), random());
            let mut own = if ripples.waves { 0.15 + 0.09 * f64::from(i % USUAL as u32) } else { 1.0 };
            if is_learned {
                at = unit(grains.vector(Point3::new(f64::from(i), 0.0, 0.0))).to_point();
                if ripples.waves {
                    own = f64::from(learned_state >> 16 & 0x7fff) / 32767.0 + 0.01;
                    learned_state = learned_state.wrapping_mul(1_812_433_253).wrapping_add(12_345);
                }
            }
            let height = if ripples.waves { height / own } else { 0.5 / f64::from(count) };
            let slope = if ripples.waves { slope / own } else { 1.0 / f64::from(count) };
            Centre { at, frequency: own * ripples.frequency, height, slope }
        };
        Self { centres: (0..count).map(centre).collect(), phase: ripples.phase }
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

//! Fog between the start of a ray and its hit or the background.
//!
//! Of the light from a distance `s`, the fraction `t = exp(-d/D)` comes through, where `D` is the
//! fog's distance and `d` the integral of its density along the way: `s` for uniform fog. The
//! density of ground fog depends on the height `h` alone, so that
//! `d = s (F(h_1) - F(h_0))/(h_1 - h_0)` for an integral `F` of the density. With turbulence it is
//! `t = exp(-(d/D) (1 - min(1, k T(p)) exp(-s/D)))`: `T` is turbulent noise at the point `p`
//! half-way, whose coordinates are multiplied by the turbulence, and `k` the depth of turbulence.
//! This was found from POV-Ray's pictures.

use core::f64::consts::FRAC_PI_2;

use durer_math::{F8, M8, Point3, Vec3, elementary};
use durer_scene::{Fog, GroundFog, Rainbow, Rgb};

use crate::lanes::Rgb8;
use crate::texture::Stir;
use crate::vector::dot;

/// A [`Fog`] with its constants precomputed.
#[derive(Clone, Debug)]
pub(crate) struct RenderFog {
    colour: Rgb,
    filter: f64,
    transmit: f64,
    distance: f64,
    ground: Option<GroundFog>,
    stir: Option<Stir>,
    depth: f64,
}

/// The way of eight rays through fog: unit directions, and distances, which may be infinite.
pub(crate) struct Ways {
    pub(crate) origin: Point3<F8>,
    pub(crate) direction: Vec3<F8>,
    pub(crate) distance: F8,
    pub(crate) live: M8,
}

/// The effect of fog on the light from behind it: `light * passed + added`.
pub(crate) struct Veil {
    pub(crate) passed: Rgb8,
    pub(crate) added: Rgb8,
}

/// The greatest distance in the scene language; what is farther counts as this far.
const FARTHEST: f64 = 1e7;

/// A ray with a smaller difference of heights counts as horizontal.
const LEVEL: f64 = 1e-9;

impl RenderFog {
    pub(crate) fn new(fog: &Fog) -> Self {
        Self {
            colour: fog.colour.rgb,
            filter: fog.colour.filter,
            transmit: fog.colour.transmit,
            distance: fog.distance,
            ground: fog.ground,
            stir: fog.turbulence.as_ref().map(Stir::new),
            depth: fog.turbulence_depth,
        }
    }

    /// The fraction of light that comes through, before the fog's own least fraction.
    fn through(&self, ways: &Ways) -> F8 {
        let mut through = F8::ZERO;
        let stirred = self.stir.as_ref().map(|stir| halfway(stir, ways));
        for i in ways.live.lanes() {
            let s = ways.distance.0[i];
            let way = match &self.ground {
                None => s,
                Some(ground) => {
                    let (origin, direction) = (ways.origin.to_vec().lane(i), ways.direction.lane(i));
                    ground_way(ground, dot(ground.up, origin), dot(ground.up, direction), s)
                }
            };
            let depth = way / self.distance;
            let width = stirred.map_or(1.0, |noise| {
                let part = (noise.0[i] * self.depth).min(1.0);
                1.0 - part * elementary::exp(-s / self.distance)
            });
            through.0[i] = elementary::exp(-depth * width);
        }
        through
    }

    fn veil(&self, ways: &Ways) -> Veil {
        let t = self.through(ways).max(F8::splat(self.transmit));
        let colour = Rgb8::splat(self.colour);
        let filter = F8::splat(self.filter);
        let passed = colour.map(|c| t * (c * filter + (F8::ONE - filter)));
        Veil { passed, added: colour * (F8::ONE - t) }
    }
}

/// The noise half-way, at the point whose coordinates are multiplied by the turbulence.
fn halfway(stir: &Stir, ways: &Ways) -> F8 {
    let half = ways.distance.map(|s| if s < FARTHEST { s } else { FARTHEST }) * 0.5;
    let Vec3 { x, y, z } = (ways.origin + ways.direction * half).to_vec();
    let Vec3 { x: a, y: b, z: c } = stir.amount;
    stir.scalar(Point3::new(x * a, y * b, z * c))
}

/// The fogs and rainbows between the start of a ray and its hit or the background.
#[derive(Clone, Copy)]
pub(crate) struct Air<'w> {
    pub(crate) fogs: &'w [RenderFog],
    pub(crate) rainbows: &'w [Rainbow],
}

impl Air<'_> {
    /// No fog and no rainbow.
    pub(crate) const CLEAR: Self = Self { fogs: &[], rainbows: &[] };

    /// Whether there is neither fog nor rainbow.
    #[inline(always)]
    pub(crate) fn is_clear(&self) -> bool {
        self.fogs.is_empty() && self.rainbows.is_empty()
    }
}

/// The effect of fog and rainbows on the light from behind them; `None` without any. Rainbows are
/// seen through fog.
pub(crate) fn veil(air: &Air<'_>, ways: &Ways) -> Option<Veil> {
    let fog = veil_of_fogs(air.fogs, ways);
    if air.rainbows.is_empty() {
        return fog;
    }
    let rainbow = crate::rainbow::veil(air.rainbows, ways);
    Some(match fog {
        None => rainbow,
        Some(fog) => {
            Veil { passed: rainbow.passed * fog.passed, added: rainbow.added * fog.passed + fog.added }
        }
    })
}

/// The effect of all fog; `None` without fog.
fn veil_of_fogs(fogs: &[RenderFog], ways: &Ways) -> Option<Veil> {
    let mut all: Option<Veil> = None;
    for fog in fogs {
        let one = fog.veil(ways);
        all = Some(match all {
            None => one,
            Some(before) => Veil {
                passed: before.passed * one.passed,
                // Colours of several fogs add up (a fact of the scene language).
                added: before.added + one.added,
            },
        });
    }
    all
}

/// The integral of the density along a way of length `s` that starts at the height `start` and rises
/// by `rise` for each unit.
fn ground_way(fog: &GroundFog, start: f64, rise: f64, s: f64) -> f64 {
    if rise.abs() < LEVEL {
        return s * density(fog, start);
    }
    let end = if s.is_finite() { start + rise * s } else { rise * f64::INFINITY };
    (summed(fog, end) - summed(fog, start)) / rise
}

fn density(fog: &GroundFog, height: f64) -> f64 {
    let above = height - fog.offset;
    if above <= 0.0 {
        return 1.0;
    }
    if fog.fade == 0.0 {
        return 0.0;
    }
    let x = above / fog.fade;
    1.0 / (1.0 + x * x)
}

/// An integral of the density over the height.
fn summed(fog: &GroundFog, height: f64) -> f64 {
    let above = height - fog.offset;
    if above <= 0.0 {
        above
    } else if fog.fade == 0.0 {
        0.0
    } else if above.is_finite() {
        fog.fade * elementary::atan(above / fog.fade)
    } else {
        fog.fade.abs() * FRAC_PI_2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of POV-Ray.
    #[test]
    fn ground_fog_thins_out() {
        for (offset, fade, want) in [(0.0, 1.0, 1.3734), (0.0, 2.0, 2.3806), (1.0, 1.0, 2.3258)] {
            let fog = GroundFog { up: Vec3::Y, offset, fade };
            assert!((ground_way(&fog, 0.0, 1.0, 5.0) - want).abs() < 1e-4);
        }
    }
}

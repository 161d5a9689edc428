//! Rainbows in front of the background or a hit.
//!
//! With the angle `a` between the ray and the rainbow's axis, the colour is the one at
//! `(a - angle)/width + 1/2` in its list. Of the light from a distance `s`, the fraction
//! `t = max(exp(-s/D), 1 - k (1 - transmit))` comes through: `D` is the rainbow's distance, and `k`
//! falls from 1 to 0 along a cubic towards the ends of the arc. The fraction `filter (1 - t)` of
//! that light takes the colour. Where several rainbows overlap, their effects are averaged. This
//! was found from POV-Ray's pictures.

use durer_math::{Vec3, elementary};
use durer_scene::{Colour, Rainbow, Rgb};

use crate::fog::{Veil, Ways};
use crate::lanes::Rgb8;
use crate::vector::dot;

/// The effect of all rainbows on the light from behind them.
pub(crate) fn veil(rainbows: &[Rainbow], ways: &Ways) -> Veil {
    let (mut passed, mut added) = (Rgb8::WHITE, Rgb8::BLACK);
    for i in ways.live.lanes() {
        let (direction, distance) = (ways.direction.lane(i), ways.distance.0[i]);
        let (mut all, mut count) = ((Rgb::BLACK, Rgb::BLACK), 0);
        for (one_passed, one_added) in rainbows.iter().filter_map(|own| seen(own, direction, distance)) {
            (all.0, all.1) = (all.0 + one_passed, all.1 + one_added);
            count += 1;
        }
        if count > 0 {
            let part = 1.0 / f64::from(count);
            passed.set_lane(i, all.0 * part);
            added.set_lane(i, all.1 * part);
        }
    }
    Veil { passed, added }
}

/// The light that one rainbow transmits, and the light that it adds; `None` outside its arc.
fn seen(rainbow: &Rainbow, direction: Vec3, distance: f64) -> Option<(Rgb, Rgb)> {
    let cosine = dot(direction, rainbow.axis).clamp(-1.0, 1.0);
    let index = (elementary::acos(cosine) - rainbow.angle) / rainbow.width + 0.5;
    if !(0.0..=1.0).contains(&index) {
        return None;
    }
    let across = direction - rainbow.axis * cosine;
    let size = dot(across, across).sqrt();
    let along = if size > 0.0 { (dot(across, rainbow.up) / size).clamp(-1.0, 1.0) } else { 1.0 };
    let from_top = elementary::acos(along);
    let strength = if from_top <= rainbow.half_full {
        1.0
    } else if from_top > rainbow.half_arc {
        return None;
    } else {
        let x = (rainbow.half_arc - from_top) / (rainbow.half_arc - rainbow.half_full);
        x * x * (3.0 - 2.0 * x)
    };
    let colour = at(&rainbow.colours, index);
    let through = elementary::exp(-distance / rainbow.distance);
    let t = through.max(1.0 - strength * (1.0 - colour.transmit));
    let filter = colour.filter * (1.0 - t);
    let passed = |c: f64| t * (c * filter + (1.0 - filter));
    let Rgb { r, g, b } = colour.rgb;
    Some((Rgb::new(passed(r), passed(g), passed(b)), colour.rgb * (1.0 - t)))
}

/// The colour at an index of a list; before the first entry the first colour, after the last one
/// the last.
fn at(colours: &[(f64, Colour)], index: f64) -> Colour {
    let next = colours.partition_point(|(place, _)| *place < index);
    match (next.checked_sub(1).and_then(|i| colours.get(i)), colours.get(next)) {
        (Some((a, before)), Some((b, after))) => before.mix(*after, (index - a) / (b - a)),
        (Some((_, only)), None) | (None, Some((_, only))) => *only,
        (None, None) => Colour::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::{F8, M8};

    /// Values of POV-Ray 3.7.
    #[test]
    fn a_rainbow_takes_part_of_the_light() {
        let colour = |r, b, filter, transmit| Colour { rgb: Rgb::new(r, 0.0, b), filter, transmit };
        let rainbow = Rainbow {
            axis: Vec3::Z,
            up: Vec3::Y,
            angle: 30_f64.to_radians(),
            width: 20_f64.to_radians(),
            distance: 1000.0,
            colours: vec![(0.0, colour(1.0, 0.0, 0.3, 0.5)), (1.0, colour(0.0, 1.0, 1.0, 0.2))],
            half_arc: core::f64::consts::PI,
            half_full: core::f64::consts::PI,
        };
        let shown = |x: f64, wanted: [f64; 3]| {
            let way = Vec3::new(x, -0.01, 1.0);
            let size = dot(way, way).sqrt();
            let ways = Ways {
                origin: Vec3::<F8>::splat(Vec3::ZERO).to_point(),
                direction: Vec3::<F8>::splat(way * (1.0 / size)),
                distance: F8::splat(500.0 * size),
                live: M8::first(1),
            };
            let veil = veil(core::slice::from_ref(&rainbow), &ways);
            let shown = (Rgb8::splat(Rgb::grey(0.8)) * veil.passed + veil.added).lane(0);
            let off = [shown.r - wanted[0], shown.g - wanted[1], shown.b - wanted[2]];
            assert!(off.iter().all(|off| off.abs() < 1e-4), "{shown:?}");
        };
        shown(0.31, [0.8; 3]);
        shown(0.39, [0.8514, 0.4005, 0.4322]);
        shown(0.79, [0.2911, 0.2354, 0.8386]);
    }
}

//! Patterns made of random numbers and points, one in each unit cube.

use durer_math::{F8, Point3, Vec3, elementary};
use durer_scene::{CellNumbers, Crackle, NoiseGenerator};

use super::noise::ranged;
use crate::texture::{Grains, generator_or_scene};
use crate::vector::floor;

/// The random number of the unit cube of a point.
pub(in crate::texture) fn cell_number(p: Point3) -> f64 {
    let [number, ..] = CellNumbers::get().of(p.to_array().map(|x| floor(x + super::super::cells::BORDER)));
    number
}

/// How the distances to random points are measured and combined.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Points {
    form: Vec3,
    metric: Metric,
    /// The distance along a fourth axis, as the metric sums it.
    fourth: f64,
    solid: bool,
    generator: NoiseGenerator,
    /// The noise value that all points with the same nearest point share.
    grains: Grains,
}

/// How a distance is made of the differences of coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Metric {
    Sum,
    Euclid,
    Power(f64),
}

impl Metric {
    /// The term of one axis in the sum over the axes.
    fn part(self, x: f64) -> f64 {
        match self {
            Self::Sum => x.abs(),
            Self::Euclid => x * x,
            // Half-integer exponents are common, and a square root is faster than a logarithm.
            Self::Power(e) if e.fract() == 0.5 => elementary::powi(x.abs(), e as i32) * x.abs().sqrt(),
            Self::Power(e) => elementary::pow(x.abs(), e),
        }
    }

    /// The distance with this sum.
    fn distance(self, sum: f64) -> f64 {
        match self {
            Self::Sum => sum,
            Self::Euclid => sum.sqrt(),
            Self::Power(e) => elementary::pow(sum, 1.0 / e),
        }
    }
}

impl Points {
    pub(super) fn new(crackle: &Crackle) -> Self {
        let metric = match crackle.metric {
            1.0 => Metric::Sum,
            2.0 => Metric::Euclid,
            e => Metric::Power(e),
        };
        Self {
            form: crackle.form,
            metric,
            fourth: metric.part(crackle.offset),
            solid: crackle.solid,
            generator: generator_or_scene(crackle.generator),
            grains: Grains::current(),
        }
    }

    /// The sums for the three nearest points, and the nearest point.
    fn nearest(&self, p: Point3) -> ([f64; 3], [f64; 3]) {
        let [x, y, z] = p.to_array();
        let own = [floor(x), floor(y), floor(z)];
        let within = [x - own[0], y - own[1], z - own[2]];
        // Along each axis, the nearest that points of the cells -2 to 2 away can be.
        let gaps = within.map(|t| [t + 1.0, t, 0.0, 1.0 - t, 2.0 - t].map(|gap| self.metric.part(gap)));
        let mut nearest = [f64::INFINITY; 3];
        let mut point = own;
        let numbers = CellNumbers::get();
        for (i, step) in NEAR_FIRST.iter().enumerate() {
            let reach = if self.form.z == 0.0 { nearest[1] } else { nearest[2] };
            // All further cells are at least 1 away along an axis.
            if i == NEXT_CELLS && reach <= 1.0 {
                break;
            }
            let gap = |axis: usize| gaps[axis][(step[axis] + 2) as usize];
            if gap(0) + gap(1) + gap(2) >= reach {
                continue;
            }
            let offset = step.map(f64::from);
            let point_within = numbers.of(core::array::from_fn(|axis| own[axis] + offset[axis]));
            let at: [f64; 3] = core::array::from_fn(|axis| offset[axis] + point_within[axis]);
            let part = |axis: usize| self.metric.part(at[axis] - within[axis]);
            let sum = part(0) + part(1) + part(2);
            if sum < nearest[0] {
                nearest = [sum, nearest[0], nearest[1]];
                point = core::array::from_fn(|axis| own[axis] + at[axis]);
            } else if sum < nearest[1] {
                nearest = [nearest[0], sum, nearest[1]];
            } else if sum < nearest[2] {
                nearest[2] = sum;
            }
        }
        (nearest, point)
    }

    /// A pattern for finding only the nearest point.
    pub(super) fn of_cells() -> Self {
        let crackle = Crackle { form: Vec3::X, metric: 2.0, offset: 0.0, solid: false, generator: None };
        Self::new(&crackle)
    }

    /// The random point nearest to a point.
    pub(super) fn nearest_point(&self, p: Point3) -> Point3 {
        Point3::from(self.nearest(p).1)
    }

    /// The noise vector of the random point nearest to a point.
    pub(super) fn vector(&self, p: Point3) -> Vec3 {
        self.grains.vector(self.nearest_point(p))
    }

    /// The value at a point.
    pub(super) fn value(&self, p: Point3) -> f64 {
        let (nearest, point) = self.nearest(p);
        if self.solid {
            let [x, y, z] = point.map(F8::splat);
            return ranged(&self.grains, Vec3 { x, y, z }, self.generator).0[0];
        }
        let [first, second, third] = nearest.map(|sum| self.metric.distance(sum + self.fourth));
        let third = if self.form.z == 0.0 { 0.0 } else { self.form.z * third };
        (self.form.x * first + self.form.y * second + third).clamp(0.0, 1.0)
    }
}

/// How many cells touch a cell, itself included.
const NEXT_CELLS: usize = 27;

/// The cells around a cell up to two away, the nearest first: those that touch it before all others.
const NEAR_FIRST: [[i32; 3]; 125] = near_first();

const fn near_first() -> [[i32; 3]; 125] {
    let mut all = [[0; 3]; 125];
    let (mut count, mut ring) = (0, 0);
    // By the sum of the squares of the steps.
    while ring <= 12 {
        let mut i = 0;
        while i < 125 {
            let step = [i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2];
            if step[0] * step[0] + step[1] * step[1] + step[2] * step[2] == ring {
                all[count] = step;
                count += 1;
            }
            i += 1;
        }
        ring += 1;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_formula::noise::Nearest;

    #[test]
    fn every_cell_is_visited_once() {
        let mut seen = NEAR_FIRST.to_vec();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!((seen.len(), NEAR_FIRST[0]), (125, [0; 3]));
        let touches = |step: &[i32; 3]| step.iter().all(|s| s.abs() <= 1);
        assert!(NEAR_FIRST.iter().enumerate().all(|(i, step)| touches(step) == (i < NEXT_CELLS)));
    }

    /// Functions of surfaces have the same distances, with proven bounds.
    #[test]
    fn values_are_sums_of_the_distances_of_functions() {
        for (metric, offset) in [(2.0, 0.0), (2.0, 0.3), (1.0, 0.2), (3.5, 0.0)] {
            for form in [Vec3::new(-1.0, 1.0, 0.0), Vec3::X, Vec3::new(-0.4, -0.2, 0.6)] {
                let points = Points::new(&Crackle {
                    form,
                    metric,
                    offset,
                    solid: false,
                    generator: Some(NoiseGenerator::Second),
                });
                for k in 0..300 {
                    let k = f64::from(k);
                    let p = Point3::new(k * 0.377 - 20.0, k * 0.611 - 40.0, 7.0 - k * 0.239);
                    let distance = |rank| Nearest::new(rank, metric, offset).unwrap().value(p.to_array());
                    let sum = form.x * distance(0) + form.y * distance(1) + form.z * distance(2);
                    let (found, wanted) = (points.value(p), sum.clamp(0.0, 1.0));
                    assert!((found - wanted).abs() < 1e-12, "{metric} {offset} {p:?}: {found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn solid_cells_have_the_range_of_their_noise_generator() {
        let points = |generator| {
            Points::new(&Crackle {
                form: Vec3::X,
                metric: 2.0,
                offset: 0.0,
                solid: true,
                generator: Some(generator),
            })
        };
        for k in 0..100 {
            let k = f64::from(k);
            let p = Point3::new(k * 0.377 - 20.0, k * 0.611 - 40.0, 7.0 - k * 0.239);
            let noise = points(NoiseGenerator::Second).value(p) / 0.489_855_82 - 1.052_42;
            assert!(
                (points(NoiseGenerator::First).value(p) - (noise + 0.5).clamp(0.0, 1.0)).abs() < 1e-12,
                "{p:?}"
            );
        }
    }

    #[test]
    fn means_are_near_those_of_the_scene_language() {
        let crackle = |form: Vec3| Crackle {
            form,
            metric: 2.0,
            offset: 0.0,
            solid: false,
            generator: Some(NoiseGenerator::Second),
        };
        for (form, want) in [(Vec3::new(-1.0, 1.0, 0.0), 0.196), (Vec3::X, 0.519), (Vec3::Y, 0.714)] {
            let points = Points::new(&crackle(form));
            let at = |k: i32| {
                let k = f64::from(k);
                Point3::new(k * 0.377, k * 0.611 - 40.0, 7.0 - k * 0.239)
            };
            let mean = (0..4000).map(|k| points.value(at(k))).sum::<f64>() / 4000.0;
            assert!((mean - want).abs() < 0.015, "{form:?}: {mean}");
        }
    }
}

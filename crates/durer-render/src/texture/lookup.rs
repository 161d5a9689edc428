//! Patterns that give a number from 0 to 1 for each point, by which a map is looked up.

use super::field::Field;
use super::wave::Shape;
use super::{Around, Around8};
use crate::vector::{floor, floor_lanes};
use durer_math::{AffineError, F8, M8, Point3};
use durer_scene::Value;

/// A pattern that gives a number for each point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lookup {
    field: Field,
    frequency: f64,
    phase: f64,
    shape: Shape,
}

/// Waves repeat not at 1 but a little later, so that 1 itself is still the end of the map (a fact
/// of the scene language).
const PERIOD: f64 = 1.000_01;

impl Lookup {
    pub(super) fn new(value: &Value) -> Result<Self, AffineError> {
        // The language stores these two in single precision.
        let single = |v: f64| f64::from(v as f32);
        Ok(Self {
            field: Field::new(&value.ramp)?,
            frequency: single(value.frequency),
            phase: single(value.phase),
            shape: Shape::new(value.wave),
        })
    }

    /// The value at a point.
    #[inline]
    pub(super) fn value(&self, p: Point3, around: Around) -> f64 {
        let ramp = self.field.value(p, around);
        if self.frequency == 0.0 {
            return self.shape.bend(if ramp < 0.0 { ramp - floor(ramp) } else { ramp });
        }
        let x = ramp * self.frequency + self.phase;
        let w = if x.abs() < PERIOD { x } else { x % PERIOD };
        self.shape.bend(if w < 0.0 { w + 1.0 } else { w })
    }

    /// The values at some points.
    #[inline(always)]
    pub(super) fn values(&self, p: Point3<F8>, around: &Around8, live: M8) -> F8 {
        let ramp = self.field.values(p, around, live);
        if self.frequency == 0.0 {
            let w = ramp.lt(F8::ZERO).select(ramp - floor_lanes(ramp), ramp);
            return self.shape.bend_lanes(w, live);
        }
        let mut w = ramp * self.frequency + F8::splat(self.phase);
        for i in (live & !w.abs().lt(F8::splat(PERIOD))).lanes() {
            w.0[i] %= PERIOD;
        }
        self.shape.bend_lanes(w.lt(F8::ZERO).select(w + F8::ONE, w), live)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Vec3;
    use durer_scene::{Ramp, Wave};

    fn gradient(frequency: f64, phase: f64) -> impl Fn(f64) -> f64 {
        let value =
            Value { ramp: Ramp::Gradient(Vec3::new(0.0, 2.0, 0.0)), frequency, phase, wave: Wave::Ramp };
        let lookup = Lookup::new(&value).unwrap();
        move |y| lookup.value(Point3::new(3.0, y, 4.0), Around::NOWHERE)
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn the_ramp_begins_anew_with_each_unit() {
        let at = gradient(1.0, 0.0);
        for (y, want) in [
            (0.0, 0.0),
            (0.25, 0.25),
            (1.25, 0.25),
            (1.0, 1.0),
            (2.0, 0.0),
            (-0.25, 0.75),
            (-1.0, 0.0),
            (-1.25, 0.75001),
            (-2.0, 1e-5),
            (-7.5, 0.50007),
            (-1e-6, 0.999_999),
        ] {
            assert!(close(at(y), want), "{y}: {} instead of {want}", at(y));
        }
    }

    #[test]
    fn frequency_and_phase_change_the_wave() {
        assert!(close(gradient(2.0, 0.0)(1.0), 0.999_99));
        assert!(close(gradient(2.0, 0.0)(0.5), 1.0));
        assert!(close(gradient(-1.0, 0.0)(0.25), 0.75));
        assert!(close(gradient(1.0, 0.5)(0.25), 0.75));
        assert!(close(gradient(0.0, 0.5)(0.25), 0.25));
        // A gradient in place of a default list of bricks has no frequency.
        assert!(close(gradient(0.0, 0.5)(-0.25), 0.75));
    }

    #[test]
    fn a_wave_bends_values_without_a_frequency() {
        let ramp = Ramp::Gradient(Vec3::new(0.0, 2.0, 0.0));
        let value = Value { ramp, frequency: 0.0, phase: 0.5, wave: Wave::Triangle };
        let lookup = Lookup::new(&value).unwrap();
        for (y, want) in [(0.25, 0.5), (0.75, 0.5), (-0.375, 0.75)] {
            assert!(close(lookup.value(Point3::new(3.0, y, 4.0), Around::NOWHERE), want), "{y}");
        }
        // As wood after a list in `#default`.
        let ramp = Ramp::Wood(None);
        let lookup = Lookup::new(&Value { ramp, frequency: 0.0, phase: 0.0, wave: Wave::Triangle }).unwrap();
        for (x, want) in [(0.25, 0.5), (1.125, 0.25), (2.75, 0.5)] {
            assert!(close(lookup.value(Point3::new(x, 0.0, 0.0), Around::NOWHERE), want), "{x}");
        }
    }

    #[test]
    fn lanes_have_the_values_of_single_points() {
        for (k, wave) in [Wave::Ramp, Wave::Triangle, Wave::Sine, Wave::Scallop, Wave::Cubic, Wave::Poly(2.5)]
            .into_iter()
            .enumerate()
        {
            let (frequency, phase) = ([1.0, -2.5, 0.0][k % 3], 0.3);
            let ramp = Ramp::Gradient(Vec3::new(0.3, 2.0, -0.7));
            let lookup = Lookup::new(&Value { ramp, frequency, phase, wave }).unwrap();
            for k in -40..40 {
                let x = |a: f64| F8(core::array::from_fn(|i| (f64::from(k) + 0.125 * i as f64) * a));
                let p = Point3::new(x(0.7), x(1.0), x(-0.3));
                let values = lookup.values(p, &Around8::NOWHERE, M8::ALL);
                for i in 0..8 {
                    assert_eq!(
                        values.0[i],
                        lookup.value(p.to_vec().lane(i).to_point(), Around::NOWHERE),
                        "{wave:?}"
                    );
                }
            }
        }
    }
}

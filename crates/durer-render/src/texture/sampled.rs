//! Functions that depend on textures.

use std::sync::Arc;

use durer_formula::{Formula, Op};
use durer_math::{Affine, AffineError, Point3};
use durer_scene::{Colour, SampledFunction, TextureSample, TextureSource};

use super::lookup::Lookup;
use super::{Around, Place, RenderPigment};

/// A [`SampledFunction`] with its textures prepared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sampled {
    inputs: usize,
    samples: Box<[Sample]>,
    formula: Formula,
}

#[derive(Clone, Debug, PartialEq)]
struct Sample {
    source: Arc<Source>,
    part: u8,
    at: [Coordinate; 3],
}

/// A coordinate of the point at which a texture is evaluated.
#[derive(Clone, Debug, PartialEq)]
enum Coordinate {
    /// One of the numbers so far.
    Input(usize),
    Formula(Formula),
}

#[derive(Clone, Debug, PartialEq)]
enum Source {
    Pigment(RenderPigment),
    Pattern(Place, Lookup),
}

impl Source {
    fn new(source: &TextureSource) -> Result<Self, AffineError> {
        Ok(match source {
            TextureSource::Pigment(pigment) => Self::Pigment(RenderPigment::new(pigment, &Affine::IDENTITY)?),
            TextureSource::Pattern { placement, warps, value } => {
                Self::Pattern(Place::through(placement.affine(), warps), Lookup::new(value)?)
            }
        })
    }

    /// The numbers at a point: those of a colour, or only the first.
    fn numbers(&self, p: Point3) -> [f64; 5] {
        let one = |value| [value, 0.0, 0.0, 0.0, 0.0];
        match self {
            Self::Pigment(pigment) => {
                let Colour { rgb, filter, transmit } = pigment.at(p, Around::NOWHERE);
                [rgb.r, rgb.g, rgb.b, filter, transmit]
            }
            Self::Pattern(place, lookup) => {
                one(lookup.value(place.inside(p, Around::NOWHERE), Around::NOWHERE))
            }
        }
    }
}

impl Coordinate {
    fn new(formula: &Formula) -> Self {
        match formula.ops() {
            &[Op::Input(i)] => Self::Input(i as usize),
            _ => Self::Formula(formula.clone()),
        }
    }

    fn value(&self, numbers: &[f64]) -> f64 {
        match self {
            Self::Input(i) => numbers.get(*i).copied().unwrap_or(f64::NAN),
            Self::Formula(formula) => formula.value(numbers),
        }
    }
}

impl Sampled {
    pub(crate) fn new(function: &SampledFunction) -> Result<Self, AffineError> {
        // Most functions ask one texture for several numbers.
        let mut known: Vec<(&Arc<TextureSource>, Arc<Source>)> = Vec::new();
        let mut samples = Vec::with_capacity(function.samples.len());
        for TextureSample { source, part, at } in &function.samples {
            let prepared = match known.iter().find(|(other, _)| Arc::ptr_eq(other, source)) {
                Some((_, prepared)) => prepared.clone(),
                None => {
                    let prepared = Arc::new(Source::new(source)?);
                    known.push((source, prepared.clone()));
                    prepared
                }
            };
            samples.push(Sample { source: prepared, part: *part, at: at.each_ref().map(Coordinate::new) });
        }
        let (inputs, formula) = (function.inputs as usize, function.formula.clone());
        Ok(Self { inputs, samples: samples.into(), formula })
    }

    /// The value for some inputs; NaN where it is undefined, or if there are too few.
    pub(crate) fn value(&self, inputs: &[f64]) -> f64 {
        let Some(inputs) = inputs.get(..self.inputs) else { return f64::NAN };
        let mut numbers = inputs.to_vec();
        let mut last: Option<(&Arc<Source>, [f64; 3], [f64; 5])> = None;
        for Sample { source, part, at } in &self.samples {
            let at = at.each_ref().map(|coordinate| coordinate.value(&numbers));
            let all = match last {
                Some((other, there, all)) if Arc::ptr_eq(other, source) && there == at => all,
                _ if at.iter().all(|x| x.is_finite()) => source.numbers(Point3::new(at[0], at[1], at[2])),
                _ => return f64::NAN,
            };
            last = Some((source, at, all));
            numbers.push(all.get(usize::from(*part)).copied().unwrap_or(f64::NAN));
        }
        self.formula.value(&numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_formula::Builder;
    use durer_math::Vec3;
    use durer_scene::{Pattern, Pigment, Placement, Ramp, Rgb, Value};

    fn input(number: u32, inputs: u32) -> Formula {
        let mut b = Builder::new();
        let root = b.input(number).unwrap();
        b.finish(root, inputs)
    }

    #[test]
    fn numbers_of_textures_are_inputs_of_what_follows() {
        // A pigment whose red is x and whose green is 2 x; then a gradient along x at the sum.
        let colour = |r, g| Colour::opaque(Rgb::new(r, g, 0.0));
        let value = Value::new(Ramp::Gradient(Vec3::X));
        let entries = vec![(0.0, colour(0.0, 0.0)), (1.0, colour(1.0, 2.0))];
        let pigment = Pigment::colours(Pattern::Map { value: value.clone(), entries });
        let pigment = Arc::new(TextureSource::Pigment(pigment));
        let pattern = TextureSource::Pattern { placement: Placement::IDENTITY, warps: Vec::new(), value };
        let axes = |count| [0, 1, 2].map(|axis| input(axis, count));
        let mut b = Builder::new();
        let (red, green) = (b.input(3).unwrap(), b.input(4).unwrap());
        let sum = b.push(Op::Add(red, green)).unwrap();
        let sum = b.finish(sum, 5);
        let function = SampledFunction {
            inputs: 3,
            samples: vec![
                TextureSample { source: pigment.clone(), part: 0, at: axes(3) },
                TextureSample { source: pigment, part: 1, at: axes(4) },
                TextureSample { source: Arc::new(pattern), part: 0, at: [sum.clone(), input(1, 5), sum] },
            ],
            formula: input(5, 6),
        };
        let sampled = Sampled::new(&function).unwrap();
        assert!((sampled.value(&[0.25, 7.0, 8.0]) - 0.75).abs() < 1e-12);
        assert!((sampled.value(&[0.5, 7.0, 8.0]) - 0.5).abs() < 1e-12);
        assert!(sampled.value(&[f64::NAN, 7.0, 8.0]).is_nan());
        assert!(sampled.value(&[0.25]).is_nan());
    }
}

//! Functions while they are read: formulas in which the numbers of textures may stand.
//!
//! A texture has no proven bounds, so its numbers are further inputs of the formula
//! ([`SampledFunction`]). If its number has a formula too (one of durer's own noise, for
//! isosurfaces), that goes along with it.

use std::cell::OnceCell;
use std::rc::Rc;
use std::sync::Arc;

use durer_formula::{Builder, Formula, FormulaError, NodeId};
use durer_math::Interval;
use durer_render::{FunctionValues, PigmentColours};
use durer_scene::{LearnedNoise, NoiseGenerator, SampledFunction, Settings, TextureSample, TextureSource};

use crate::diagnostics::{Error, Place, Result as Read};
use crate::formulas::Noisy;
use crate::noise_pattern::NoiseTables;
use crate::parser::Parser;
use crate::texture::Pigment;
use crate::texture_builder;

/// The number of the first input that stands for a texture while a function is read: more than the
/// parameters and the variables of loops that a function can have.
const FIRST_SAMPLE: u32 = 1 << 12;

/// A function that can be called.
#[derive(Clone, Debug)]
pub(crate) struct Called {
    /// Its formula, of its inputs and of the numbers of the textures in `samples`.
    formula: Formula,
    inputs: u32,
    samples: Vec<Sample>,
    /// The noise function, if it is one whose arguments must be checked.
    pub(crate) noisy: Option<Noisy>,
    /// The generator of the scene with which it was made, if it is the noise itself.
    pub(crate) scene_noise: Option<NoiseGenerator>,
    prepared: OnceCell<Option<Rc<FunctionValues>>>,
}

/// The noise and the settings that textures share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextureContext<'a> {
    /// The noise, if it is not durer's own.
    pub(crate) noise: Option<&'a Arc<LearnedNoise>>,
    /// The settings of the scene.
    pub(crate) settings: Settings,
}

/// A number of a texture.
#[derive(Clone, Debug)]
struct Sample {
    data: TextureSample,
    /// The number as a formula of the point, if one is known.
    exact: Option<Rc<Formula>>,
}

impl From<Formula> for Called {
    fn from(formula: Formula) -> Self {
        let inputs = formula.inputs();
        Self {
            formula,
            inputs,
            samples: Vec::new(),
            noisy: None,
            scene_noise: None,
            prepared: OnceCell::new(),
        }
    }
}

impl Called {
    /// A number of a texture as a function of `x`, `y` and `z`.
    pub(crate) fn texture(
        source: &Arc<TextureSource>,
        part: u8,
        exact: Option<Formula>,
    ) -> Result<Self, FormulaError> {
        let mut draft = Draft::default();
        let p = [draft.builder.input(0)?, draft.builder.input(1)?, draft.builder.input(2)?];
        let root = draft.sample(source, part, exact.map(Rc::new).as_ref(), p)?;
        draft.finish(root, 3)
    }

    /// The number of its arguments.
    pub(crate) fn inputs(&self) -> u32 {
        self.inputs
    }

    /// The number of its steps, and a weight for its textures.
    pub(crate) fn steps(&self) -> usize {
        const OF_TEXTURE: usize = 32;
        self.formula.ops().len() + OF_TEXTURE * self.samples.len()
    }

    /// The bytes that it holds.
    pub(crate) fn held(&self) -> usize {
        let of_sample = |sample: &Sample| {
            let steps = |formula: &Formula| formula.ops().len();
            64 + 24
                * (sample.data.at.iter().map(steps).sum::<usize>() + sample.exact.as_deref().map_or(0, steps))
        };
        self.formula.ops().len() * 24 + self.samples.iter().map(of_sample).sum::<usize>()
    }

    /// The formula, if no texture stands in it.
    pub(crate) fn plain(&self) -> Option<&Formula> {
        self.samples.is_empty().then_some(&self.formula)
    }

    /// The formula with those of textures in place of the textures; `None` if a texture has none.
    pub(crate) fn exact(&self) -> Result<Option<Formula>, FormulaError> {
        if self.samples.is_empty() {
            return Ok(Some(self.formula.clone()));
        }
        let mut b = Builder::new();
        let mut numbers = Vec::new();
        for number in 0..self.inputs {
            numbers.push(b.input(number)?);
        }
        for Sample { data, exact } in &self.samples {
            let Some(exact) = exact else { return Ok(None) };
            let mut at = Vec::with_capacity(3);
            for coordinate in &data.at {
                at.push(b.call(coordinate, &numbers)?);
            }
            numbers.push(b.call(exact, &at)?);
        }
        let root = b.call(&self.formula, &numbers)?;
        Ok(Some(b.finish(root, self.inputs)))
    }

    /// The function as data of a scene.
    pub(crate) fn scene(&self) -> SampledFunction {
        let samples = self.samples.iter().map(|sample| sample.data.clone()).collect();
        SampledFunction { inputs: self.inputs, samples, formula: self.formula.clone() }
    }

    /// The value for these arguments; NaN where it is undefined.
    pub(crate) fn value(&self, arguments: &[f64], context: TextureContext) -> f64 {
        if self.samples.is_empty() {
            return self.formula.value(arguments);
        }
        self.prepared(context).map_or(f64::NAN, |values| values.value(arguments))
    }

    /// The function with its textures prepared; `None` if a texture's placement cannot be undone.
    pub(crate) fn prepared(&self, context: TextureContext) -> Option<Rc<FunctionValues>> {
        let prepare =
            || FunctionValues::new(&self.scene(), context.noise, &context.settings).ok().map(Rc::new);
        self.prepared.get_or_init(prepare).clone()
    }
}

impl Parser<'_> {
    /// The noise and the settings of the scene's textures, as far as the scene is read.
    pub(crate) fn texture_context(&self) -> TextureContext<'_> {
        let settings = Settings {
            number_of_waves: self.scene.globals.number_of_waves,
            noise_generator: self.language.noise_generator(),
            ..Settings::default()
        };
        TextureContext { noise: self.options.noise.as_ref(), settings }
    }

    /// The colours of a pigment, prepared with the noise and the settings of the scene as far as it is read.
    pub(crate) fn pigment_colours(&self, pigment: &Pigment, place: Place) -> Read<PigmentColours> {
        let TextureContext { noise, settings } = self.texture_context();
        let made = texture_builder::pigment(pigment, place)?;
        PigmentColours::new(&made, noise, &settings).map_err(|error| Error::invalid(place, error.to_string()))
    }

    /// The components of the noise, if it is not durer's own.
    pub(crate) fn noise_tables(&self) -> Option<NoiseTables> {
        let noise = self.options.noise.as_ref()?;
        Some(NoiseTables { components: noise.components(), rows: noise.rows() })
    }
}

/// A function under construction.
#[derive(Default)]
pub(crate) struct Draft {
    pub(crate) builder: Builder,
    samples: Vec<DraftSample>,
}

struct DraftSample {
    source: Arc<TextureSource>,
    part: u8,
    exact: Option<Rc<Formula>>,
    at: [NodeId; 3],
}

impl Draft {
    /// A number of a texture at a point.
    fn sample(
        &mut self,
        source: &Arc<TextureSource>,
        part: u8,
        exact: Option<&Rc<Formula>>,
        at: [NodeId; 3],
    ) -> Result<NodeId, FormulaError> {
        let is_same = |s: &DraftSample| Arc::ptr_eq(&s.source, source) && s.part == part && s.at == at;
        let number = match self.samples.iter().position(is_same) {
            Some(number) => number,
            None => {
                let (source, exact) = (source.clone(), exact.cloned());
                self.samples.push(DraftSample { source, part, exact, at });
                self.samples.len() - 1
            }
        };
        self.builder.input(FIRST_SAMPLE + number as u32)
    }

    /// Writes out a function with these arguments, of which there must be as many as it takes.
    pub(crate) fn call(&mut self, called: &Called, arguments: &[NodeId]) -> Result<NodeId, FormulaError> {
        let mut numbers = arguments.to_vec();
        for Sample { data: TextureSample { source, part, at }, exact } in &called.samples {
            let [x, y, z] = at;
            let at = [
                self.builder.call(x, &numbers)?,
                self.builder.call(y, &numbers)?,
                self.builder.call(z, &numbers)?,
            ];
            numbers.push(self.sample(source, *part, exact.as_ref(), at)?);
        }
        self.builder.call(&called.formula, &numbers)
    }

    /// The one value of a step that depends on no input.
    pub(crate) fn constant_value(&self, root: NodeId) -> Option<Interval> {
        self.builder.finish(root, 0).as_constant()
    }

    /// The function of `inputs` numbers whose value is that of `root`.
    pub(crate) fn finish(&self, root: NodeId, inputs: u32) -> Result<Called, FormulaError> {
        let formula = self.builder.finish(root, inputs);
        if self.samples.is_empty() {
            return Ok(formula.into());
        }
        let mut samples = Vec::with_capacity(self.samples.len());
        for (number, sample) in self.samples.iter().enumerate() {
            let [x, y, z] =
                sample.at.map(|axis| renumbered(&self.builder.finish(axis, inputs), inputs, number));
            let data = TextureSample { source: sample.source.clone(), part: sample.part, at: [x?, y?, z?] };
            samples.push(Sample { data, exact: sample.exact.clone() });
        }
        let formula = renumbered(&formula, inputs, samples.len())?;
        Ok(Called { formula, inputs, samples, noisy: None, scene_noise: None, prepared: OnceCell::new() })
    }
}

/// A formula in which the numbers of the first `samples` textures follow the inputs.
fn renumbered(formula: &Formula, inputs: u32, samples: usize) -> Result<Formula, FormulaError> {
    let mut b = Builder::new();
    let mut numbers = Vec::with_capacity(FIRST_SAMPLE as usize + samples);
    for number in 0..FIRST_SAMPLE.max(inputs) {
        // No formula uses the numbers between.
        numbers.push(b.input(number.min(inputs))?);
    }
    let count = inputs + samples as u32;
    for number in inputs..count {
        numbers.push(b.input(number)?);
    }
    let root = b.call(formula, &numbers)?;
    Ok(b.finish(root, count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_formula::Op;
    use durer_math::Vec3;
    use durer_scene::{Placement, Ramp, Value};

    /// A gradient along x as a texture, with the formula `2 x`, so that the two can be told apart.
    fn gradient() -> Called {
        let source = TextureSource::Pattern {
            placement: Placement::IDENTITY,
            warps: Vec::new(),
            value: Value::new(Ramp::Gradient(Vec3::X)),
        };
        let mut b = Builder::new();
        let x = b.input(0).unwrap();
        let double = b.push(Op::Add(x, x)).unwrap();
        Called::texture(&Arc::new(source), 0, Some(b.finish(double, 3))).unwrap()
    }

    #[test]
    fn textures_of_textures_have_values_and_formulas() {
        let gradient = gradient();
        // g(g(y, 0, 0), 0, 0) + z g(y, 0, 0) as a function of two numbers, y and z.
        let mut draft = Draft::default();
        let (y, z) = (draft.builder.input(0).unwrap(), draft.builder.input(1).unwrap());
        let zero = draft.builder.constant(0.0).unwrap();
        let inner = draft.call(&gradient, &[y, zero, zero]).unwrap();
        let outer = draft.call(&gradient, &[inner, zero, zero]).unwrap();
        let product = draft.builder.push(Op::Mul(z, inner)).unwrap();
        let sum = draft.builder.push(Op::Add(outer, product)).unwrap();
        let function = draft.finish(sum, 2).unwrap();
        assert_eq!((function.inputs(), function.samples.len()), (2, 2));
        assert!(
            (function.value(&[0.25, 3.0], TextureContext { noise: None, settings: Settings::default() })
                - 1.0)
                .abs()
                < 1e-12
        );
        let exact = function.exact().unwrap().unwrap();
        assert_eq!(exact.inputs(), 2);
        assert!((exact.value(&[0.25, 3.0]) - 2.5).abs() < 1e-12);
    }
}

//! Noise patterns and turbulence, as formulas.
//!
//! ```text
//!   bozo, bumps, spotted  N(p)                                       dents  N(p)^3
//!   wrinkles              sum of m(2^k p)/2^(k+1),  k from 0 to 9
//!   granite               sum of |1/2 - m(2^(k+2) p)|/2^k,  k from 0 to 5
//!   agate                 ((1 + sin(2 pi (1.3 a T(p) + 1.1 z)))/2)^0.77
//!   marble                x + t_x T(p)
//!   wood                  |(x + sin(2 pi t_x (x + D_x(p))), y + sin(2 pi t_y (y + D_y(p))))|
//!   all others            their value at p + t D(p)
//!
//!   T(p) = sum of omega^k m_k(lambda^k p),   D(p) = sum of omega^k (n, n', n'')(lambda^k p),   k below the number of octaves
//! ```
//!
//! `N` is the noise of the chosen generator. `n` is the underlying noise, around zero; `n'` and
//! `n''` are the other components of learned noise, or durer's own `n` at shifted points. For the
//! first generator, `m` is `N`. For the others, `m` is `2 N - 1/2`, clamped to `[0, 1]` (in `T`
//! clamped only in the first octave). `t` is the turbulence, and `a` is agate's own. All this was
//! found from POV-Ray's values, with POV-Ray's own noise, and agrees with them to rounding.

use durer_formula::noise;
use durer_formula::noise::NoiseTable;
use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_math::scale::pow2;
use durer_math::{F8, elementary};
use durer_scene::{NoiseGenerator, Octaves, PointWarp};

use crate::formulas;
use crate::keywords::Keyword;
use crate::pattern_function::moved;
use crate::texture::{Pattern, PatternKind};

/// `vturbulence`: the sum of octaves of vector noise at a point, with the factor of frequency, the
/// factor of strength, and the number of octaves.
pub(crate) fn vector_turbulence(
    learned: Option<&durer_scene::LearnedNoise>,
    [lambda, omega, octaves]: [f64; 3],
    p: [f64; 3],
) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let (mut weight, mut scale) = (1.0, 1.0);
    for _ in 0..octaves.trunc().clamp(1.0, MOST_OCTAVES) as u32 {
        let at = p.map(|x| x * scale);
        let values = match learned {
            Some(noise) => noise.vector(durer_math::Point3::new(at[0], at[1], at[2])).to_array(),
            None => std::array::from_fn(|axis| {
                let shift = axis.checked_sub(1).map_or([0.0; 3], |i| ELSEWHERE[i]);
                let [x, y, z]: [F8; 3] = std::array::from_fn(|i| F8::splat(at[i] + shift[i]));
                noise::values(None, [&x, &y, &z]).0[0]
            }),
        };
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += weight * value;
        }
        (weight, scale) = (weight * omega, scale * lambda);
    }
    sum
}

/// Steps; `None` if no formula is known or there are too many steps.
type Made<T> = Option<T>;

/// The shifts of the noise for the second and the third component of turbulence: arbitrary other
/// cells of the lattice.
const ELSEWHERE: [[f64; 3]; 2] = [[157.0, -311.0, 89.0], [-223.0, 71.0, 439.0]];

/// `N` of the three generators; that of the third is made of the noise of a table of rows.
const FIRST: &str = "max(min(noise(x, y, z) + 0.5, 1), 0)";
const SECOND: &str = "max(min((noise(x, y, z) + 1.05242)*0.48985582, 1), 0)";
const THIRD: &str = "max(min(0.795*noise(x + P0, y + P0, z + P0) + 0.4925, 1), 0)";

/// `N` of the third generator, with the noise of this table.
pub(crate) fn third(rows: &'static NoiseTable) -> Option<Formula> {
    let formula = formulas::on_paper(THIRD, 1)?.with_noise(Some(rows));
    let mut b = Builder::new();
    let arguments =
        [b.input(0).ok()?, b.input(1).ok()?, b.input(2).ok()?, b.constant(noise::ROWS_SHIFT).ok()?];
    let root = b.call(&formula, &arguments).ok()?;
    Some(b.finish(root, 3))
}

/// The turbulence that is applied before a pattern is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turbulence {
    pub(crate) amount: [f64; 3],
    pub(crate) octaves: f64,
    pub(crate) lambda: f64,
    pub(crate) omega: f64,
    /// The amount of turbulence in agate.
    pub(crate) agate: f64,
    /// The noise generator; `None` for the scene's, as it is at the end of the text.
    pub(crate) generator: Option<NoiseGenerator>,
    /// The scene's noise generator where this is read.
    pub(crate) scene_generator: NoiseGenerator,
    /// The noise, if it is not durer's own.
    pub(crate) tables: Option<NoiseTables>,
}

/// The tables of a noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoiseTables {
    /// The components of the vector noise, of which the first is the scalar noise.
    pub(crate) components: [&'static NoiseTable; 3],
    /// The table of the third generator.
    pub(crate) rows: &'static NoiseTable,
}

impl Default for Turbulence {
    fn default() -> Self {
        Self {
            amount: [0.0; 3],
            octaves: 6.0,
            lambda: 2.0,
            omega: 0.5,
            agate: 1.0,
            generator: None,
            scene_generator: NoiseGenerator::default(),
            tables: None,
        }
    }
}

impl Turbulence {
    pub(crate) fn is_none(&self) -> bool {
        self.amount == [0.0; 3]
    }

    /// As data of the scene.
    pub(crate) fn scene(&self) -> durer_scene::Turbulence {
        let [x, y, z] = self.amount;
        let (count, lambda, omega) = (self.octaves(), self.lambda, self.omega);
        durer_scene::Turbulence {
            amount: durer_math::Vec3::new(x, y, z),
            octaves: Octaves { count, lambda, omega },
            generator: self.generator,
        }
    }

    /// The generator in functions, which are finished where they are read.
    fn generator_here(&self) -> NoiseGenerator {
        self.generator.unwrap_or(self.scene_generator)
    }

    fn octaves(&self) -> u32 {
        self.octaves.trunc().clamp(1.0, MOST_OCTAVES) as u32
    }

    /// The weight of octave `k`, and the factor of its points. The language stores both in single
    /// precision.
    fn octave(&self, k: u32) -> (f64, f64) {
        let [omega, lambda] = [self.omega, self.lambda].map(|v| f64::from(v as f32));
        (elementary::powi(omega, k as i32), elementary::powi(lambda, k as i32))
    }
}

/// POV-Ray's limit on the number of octaves.
const MOST_OCTAVES: f64 = 10.0;

/// Whether the word is that of a noise pattern.
pub(crate) fn is_noise(word: Keyword) -> bool {
    use Keyword::{Agate, Bozo, Bumps, Dents, Granite, Spotted, Wrinkles};
    matches!(word, Agate | Bozo | Bumps | Dents | Granite | Spotted | Wrinkles)
}

/// Builds formulas step by step.
struct Draft<'a> {
    b: &'a mut Builder,
    turbulence: Turbulence,
}

impl Draft<'_> {
    fn number(&mut self, x: f64) -> Made<NodeId> {
        self.b.constant(x).ok()
    }

    fn push(&mut self, op: Op) -> Made<NodeId> {
        self.b.push(op).ok()
    }

    fn times(&mut self, factor: f64, x: NodeId) -> Made<NodeId> {
        let factor = self.number(factor)?;
        self.push(Op::Mul(factor, x))
    }

    fn scaled(&mut self, p: [NodeId; 3], factor: f64) -> Made<[NodeId; 3]> {
        Some([self.times(factor, p[0])?, self.times(factor, p[1])?, self.times(factor, p[2])?])
    }

    fn text(&mut self, text: &'static str, p: [NodeId; 3], parameters: &[NodeId]) -> Made<NodeId> {
        let table = self.turbulence.tables.map(|tables| tables.components[0]);
        let formula: Formula = formulas::on_paper(text, parameters.len() as u32)?.with_noise(table);
        let made: Result<NodeId, FormulaError> = self.b.call(&formula, &[&p, parameters].concat());
        made.ok()
    }

    /// `N`.
    fn noise(&mut self, p: [NodeId; 3]) -> Made<NodeId> {
        match self.turbulence.generator_here() {
            NoiseGenerator::First => self.text(FIRST, p, &[]),
            NoiseGenerator::Second => self.text(SECOND, p, &[]),
            NoiseGenerator::Third => {
                let rows = self.turbulence.tables.map_or_else(NoiseTable::own_rows, |tables| tables.rows);
                self.b.call(&third(rows)?, &p).ok()
            }
        }
    }

    /// `m`; without the clamp if `is_kept` is false.
    fn grain(&mut self, p: [NodeId; 3], is_kept: bool) -> Made<NodeId> {
        let noise = self.noise(p)?;
        if self.turbulence.generator_here() == NoiseGenerator::First {
            return Some(noise);
        }
        let text = if is_kept { "max(min(2*P0 - 0.5, 1), 0)" } else { "2*P0 - 0.5" };
        self.text(text, p, &[noise])
    }

    /// A sum over octaves, given by weight and factor.
    fn sum(
        &mut self,
        p: [NodeId; 3],
        octaves: impl Iterator<Item = (f64, f64)>,
        mut term: impl FnMut(&mut Self, [NodeId; 3]) -> Made<NodeId>,
    ) -> Made<NodeId> {
        let mut sum = self.number(0.0)?;
        for (weight, factor) in octaves {
            let p = self.scaled(p, factor)?;
            let value = term(self, p)?;
            let value = self.times(weight, value)?;
            sum = self.push(Op::Add(sum, value))?;
        }
        Some(sum)
    }

    /// `T`.
    fn scalar(&mut self, p: [NodeId; 3]) -> Made<NodeId> {
        let turbulence = self.turbulence;
        let mut is_first = true;
        self.sum(p, (0..turbulence.octaves()).map(|k| turbulence.octave(k)), |draft, p| {
            draft.grain(p, std::mem::take(&mut is_first))
        })
    }

    /// A component of `D`.
    fn component(&mut self, p: [NodeId; 3], axis: usize) -> Made<NodeId> {
        let turbulence = self.turbulence;
        self.sum(p, (0..turbulence.octaves()).map(|k| turbulence.octave(k)), |draft, mut p| {
            if let Some(tables) = turbulence.tables {
                return draft.push(Op::Noise(Some(tables.components[axis]), p));
            }
            if let Some(offset) = axis.checked_sub(1).map(|i| ELSEWHERE[i]) {
                for (x, offset) in p.iter_mut().zip(offset) {
                    let offset = draft.number(offset)?;
                    *x = draft.push(Op::Add(*x, offset))?;
                }
            }
            draft.push(Op::Noise(None, p))
        })
    }

    /// `p + t D(p)`: the point with turbulence.
    fn stirred(&mut self, p: [NodeId; 3]) -> Made<[NodeId; 3]> {
        let mut out = p;
        for axis in 0..3 {
            let amount = self.turbulence.amount[axis];
            if amount != 0.0 {
                let way = self.component(p, axis)?;
                let way = self.times(amount, way)?;
                out[axis] = self.push(Op::Add(p[axis], way))?;
            }
        }
        Some(out)
    }

    /// A coordinate of the point in the formula of wood.
    fn grown(&mut self, p: [NodeId; 3], axis: usize) -> Made<NodeId> {
        let amount = self.turbulence.amount[axis];
        if amount == 0.0 {
            return Some(p[axis]);
        }
        let way = self.component(p, axis)?;
        let amount = self.number(amount)?;
        self.text("x + sin(2*pi*((x + y)*z))", [p[axis], way, amount], &[])
    }
}

/// The value of a pattern that is made of noise, or that uses turbulence in its own way.
pub(crate) fn value(b: &mut Builder, pattern: &Pattern, own: [NodeId; 3]) -> Option<NodeId> {
    let PatternKind::Written(word, _) = pattern.kind else { return None };
    let turbulence = *pattern.modifiers.turbulence;
    let mut draft = Draft { b, turbulence };
    match word {
        Keyword::Bozo | Keyword::Bumps | Keyword::Spotted => draft.noise(own),
        Keyword::Dents => {
            let noise = draft.noise(own)?;
            draft.push(Op::Powi(noise, 3))
        }
        Keyword::Wrinkles => {
            let octaves = (0..10).map(|k| (pow2(-k - 1), pow2(k)));
            draft.sum(own, octaves, |draft, p| draft.grain(p, true))
        }
        Keyword::Granite => {
            let octaves = (0..6).map(|k| (pow2(-k), pow2(k + 2)));
            draft.sum(own, octaves, |draft, p| {
                let grain = draft.grain(p, true)?;
                let half = draft.number(0.5)?;
                let away = draft.push(Op::Sub(half, grain))?;
                draft.push(Op::Abs(away))
            })
        }
        Keyword::Agate => {
            let stir = draft.scalar(own)?;
            let stir = draft.times(turbulence.agate, stir)?;
            draft.text("pow(max((1 + sin(2*pi*(1.3*P0 + 1.1*z)))/2, 0), 0.77)", own, &[stir])
        }
        Keyword::Marble => {
            if turbulence.amount[0] == 0.0 {
                return Some(own[0]);
            }
            let stir = draft.scalar(own)?;
            let stir = draft.times(turbulence.amount[0], stir)?;
            draft.push(Op::Add(own[0], stir))
        }
        Keyword::Wood => {
            let (x, y) = (draft.grown(own, 0)?, draft.grown(own, 1)?);
            let squares = (draft.push(Op::Sqr(x))?, draft.push(Op::Sqr(y))?);
            let square = draft.push(Op::Add(squares.0, squares.1))?;
            draft.push(Op::Sqrt(square))
        }
        _ => None,
    }
}

/// The point at which a pattern and what it selects are evaluated: a point in the pattern's space with
/// warps, and with turbulence as most patterns use it. `None` if no formula of a warp is known.
pub(crate) fn warped(b: &mut Builder, pattern: &Pattern, own: [NodeId; 3]) -> Made<[NodeId; 3]> {
    let (mut p, turbulence) = (own, *pattern.modifiers.turbulence);
    for (before, warp) in pattern.modifiers.warps.iter().rev() {
        let PointWarp::Turbulence(warp) = warp else { return None };
        let (amount, Octaves { count, lambda, omega }) = (warp.amount.to_array(), warp.octaves);
        let turbulence = Turbulence { amount, octaves: count.into(), lambda, omega, ..turbulence };
        p = Draft { b, turbulence }.stirred(p)?;
        if !before.is_identity() {
            p = moved(b, p, &before.inverse()?).ok()?;
        }
    }
    if pattern.kind.stirs_itself() || turbulence.is_none() {
        return Some(p);
    }
    Draft { b, turbulence }.stirred(p)
}

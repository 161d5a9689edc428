//! Patterns: they select or mix the entries of a list or map by position.

use std::rc::Rc;
use std::sync::Arc;

use durer_scene::NoiseGenerator;

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::noise_pattern::Turbulence;
use crate::parser::Parser;
use crate::pattern_function;
use crate::transform::{self, Matrix};

/// The kind of a pattern, with its own numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PatternKind {
    Checker,
    Hexagon,
    Square,
    Triangular,
    Brick {
        size: [f64; 3],
        mortar: f64,
    },
    Gradient([f64; 3]),
    /// A pattern without numbers of its own: its word, and the place of that.
    Written(Keyword, Place),
    /// A pattern with numbers of its own, and the place of its word.
    Ramp(Rc<durer_scene::Ramp>, Place),
    /// The grey value of a pigment.
    GreyOf(Rc<super::Pigment>),
    /// The inside of an object, and the place of its word.
    Inside(Rc<durer_scene::Object>, Place),
    /// Textures by the indices of a picture.
    Materials(Arc<durer_scene::ImageMap>),
    /// The mean of all entries of a map.
    Average,
}

impl PatternKind {
    /// The number of entries of its list; `None` for patterns with a map.
    pub(crate) fn list_length(&self) -> Option<usize> {
        match self {
            Self::Checker | Self::Brick { .. } | Self::Inside(..) => Some(2),
            Self::Hexagon => Some(3),
            Self::Square => Some(4),
            Self::Triangular => Some(6),
            Self::Gradient(_)
            | Self::Written(..)
            | Self::Ramp(..)
            | Self::GreyOf(_)
            | Self::Materials(_)
            | Self::Average => None,
        }
    }

    /// Whether the pattern uses turbulence in its own way.
    pub(crate) fn stirs_itself(&self) -> bool {
        matches!(self, Self::Written(Keyword::Marble | Keyword::Wood, _))
    }
}

/// The waveform between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Wave {
    #[default]
    Ramp,
    Triangle,
    Sine,
    Scallop,
    Cubic,
    Poly(f64),
}

/// The modifiers of a pattern's value, and its placement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatternModifiers {
    /// 0 leaves the value unchanged; then the phase has no effect either.
    pub(crate) frequency: f64,
    pub(crate) phase: f64,
    pub(crate) wave: Wave,
    pub(crate) turbulence: Rc<Turbulence>,
    /// The warps in the order of the text, each with the placement to which it applies.
    pub(crate) warps: Rc<Vec<(Matrix, durer_scene::PointWarp)>>,
    /// The map from the pattern's own space to the object's.
    pub(crate) place: Matrix,
    /// Whether the pattern is evaluated at the surface's texture coordinates instead of the point.
    pub(crate) on_chart: bool,
    /// If its whole texture is evaluated at texture coordinates: the map that rotates perturbations
    /// of normals.
    pub(crate) turn: Option<Box<Matrix>>,
}

impl Default for PatternModifiers {
    fn default() -> Self {
        Self {
            frequency: 1.0,
            phase: 0.0,
            wave: Wave::Ramp,
            turbulence: Rc::default(),
            warps: Rc::default(),
            place: Matrix::IDENTITY,
            on_chart: false,
            turn: None,
        }
    }
}

impl PatternModifiers {
    /// Applies what the word of a pattern changes by itself; the rest stays as it was (a fact of
    /// the language).
    pub(crate) fn begin(&mut self, kind: &PatternKind) {
        if kind.list_length().is_some() {
            self.frequency = 0.0;
        }
        if let PatternKind::Written(word, _) = kind {
            self.wave = pattern_function::own_wave(*word).unwrap_or(self.wave);
        }
        if let PatternKind::Ramp(ramp, _) = kind {
            match **ramp {
                durer_scene::Ramp::Spiral { .. } => self.wave = Wave::Triangle,
                durer_scene::Ramp::Quilted(..) => self.frequency = 0.0,
                _ => {}
            }
        }
    }

    /// Transforms the pattern together with its owner. Texture coordinates do not move with an
    /// object (a fact of the language).
    pub(crate) fn transform(&mut self, by: &Matrix) {
        if !self.on_chart {
            self.place = self.place.then(by);
        }
        if let Some(turn) = &mut self.turn {
            **turn = turn.then(by);
        }
    }

    /// Shows the pattern at texture coordinates, with its whole texture: the perturbation of normals
    /// is still turned by all transforms (a fact of the language).
    pub(crate) fn put_on_chart(&mut self) {
        if !self.on_chart {
            self.turn = Some(Box::new(self.place));
        }
        self.on_chart = true;
    }
}

/// A pattern with its modifiers and its placement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pattern {
    pub(crate) kind: PatternKind,
    pub(crate) modifiers: PatternModifiers,
}

impl Pattern {
    /// Whether each cell shows an entry of a list, unchanged by a frequency or a wave.
    pub(crate) fn is_plain_list(&self) -> bool {
        let PatternModifiers { frequency, wave, .. } = self.modifiers;
        self.kind.list_length().is_some() && frequency == 0.0 && wave == Wave::Ramp
    }
}

/// The greatest number of warps of a pattern; scenes use a few.
const MOST_WARPS: usize = 4096;

impl Parser<'_> {
    /// Reads the word of a pattern, if one comes next; `base` is the pattern that it replaces.
    pub(crate) fn pattern_kind(&mut self, base: Option<PatternKind>) -> Result<Option<PatternKind>> {
        let kind = match self.peek_word()? {
            Some(Keyword::Checker) => PatternKind::Checker,
            Some(Keyword::Hexagon) => PatternKind::Hexagon,
            Some(Keyword::Square) => PatternKind::Square,
            Some(Keyword::Triangular) => PatternKind::Triangular,
            Some(Keyword::Average) => PatternKind::Average,
            Some(Keyword::Object) => return self.nested(Self::inside_kind).map(Some),
            Some(Keyword::Brick) => match base {
                Some(bricks @ PatternKind::Brick { .. }) => bricks,
                _ => PatternKind::Brick { size: [8.0, 3.0, 4.5], mortar: 0.5 },
            },
            Some(Keyword::Gradient) => {
                self.next()?;
                let place = self.here();
                let direction = self.vector()?;
                if transform::length(direction) == 0.0 {
                    return Err(Error::invalid(place, "a gradient needs a direction that is not zero"));
                }
                return Ok(Some(PatternKind::Gradient(direction)));
            }
            Some(word) if pattern_function::is_written(word) => PatternKind::Written(word, self.here()),
            _ => return self.ramp_kind(),
        };
        self.next()?;
        Ok(Some(kind))
    }

    /// Reads `object {` and the object. The items of its list and the brace behind them follow.
    fn inside_kind(&mut self) -> Result<PatternKind> {
        self.next()?;
        let place = self.here();
        self.expect(Mark::BraceOpen)?;
        let object = self.volume_for_pattern(place)?;
        Ok(PatternKind::Inside(Rc::new(object), place))
    }

    /// Reads the brace behind the list of an `object` pattern.
    pub(crate) fn end_of_list(&mut self, kind: &PatternKind) -> Result<()> {
        if matches!(kind, PatternKind::Inside(..)) { self.expect(Mark::BraceClose) } else { Ok(()) }
    }

    /// The pattern of a word just read, with the scene's noise generator.
    pub(crate) fn plain_pattern(&self, kind: PatternKind) -> Pattern {
        let mut modifiers = PatternModifiers::default();
        self.set_noise_generator(&mut modifiers);
        modifiers.begin(&kind);
        Pattern { kind, modifiers }
    }

    /// Gives the pattern the scene's noise generator.
    pub(crate) fn set_noise_generator(&self, modifiers: &mut PatternModifiers) {
        let generator = self.language.noise_generator();
        let tables = self.noise_tables();
        let own = &modifiers.turbulence;
        if own.generator.is_some() || own.scene_generator != generator || own.tables != tables {
            let turbulence = Rc::make_mut(&mut modifiers.turbulence);
            (turbulence.generator, turbulence.scene_generator) = (None, generator);
            turbulence.tables = tables;
        }
    }

    /// Reads a modifier of a pattern other than a transformation: `frequency`, `phase`, a wave, a
    /// brick's sizes.
    pub(crate) fn pattern_modifier(
        &mut self,
        mut kind: Option<&mut PatternKind>,
        modifiers: &mut PatternModifiers,
    ) -> Result<bool> {
        if self.ramp_modifier(kind.as_deref_mut())? {
            return Ok(true);
        }
        let Some(keyword) = self.peek_word()? else { return Ok(false) };
        let place = self.here();
        let wave = match keyword {
            Keyword::RampWave => Some(Wave::Ramp),
            Keyword::TriangleWave => Some(Wave::Triangle),
            Keyword::SineWave => Some(Wave::Sine),
            Keyword::ScallopWave => Some(Wave::Scallop),
            Keyword::CubicWave => Some(Wave::Cubic),
            Keyword::PolyWave => Some(Wave::Poly(1.0)),
            _ => None,
        };
        if let Some(wave) = wave {
            self.next()?;
            modifiers.wave = match wave {
                Wave::Poly(absent) => Wave::Poly(self.float_or(absent)?),
                plain => plain,
            };
            return Ok(true);
        }
        match keyword {
            Keyword::Frequency => {
                self.next()?;
                modifiers.frequency = self.float()?;
            }
            Keyword::Phase => {
                self.next()?;
                modifiers.phase = self.float()?;
            }
            Keyword::BrickSize => {
                self.next()?;
                let given = self.vector()?;
                match kind {
                    Some(PatternKind::Brick { size, .. }) if given.iter().all(|v| *v != 0.0) => *size = given,
                    Some(PatternKind::Brick { .. }) => {
                        return Err(Error::invalid(place, "a brick has no zero sizes"));
                    }
                    _ => return Err(Error::invalid(place, "brick_size belongs to brick")),
                }
            }
            Keyword::Mortar => {
                self.next()?;
                let given = self.float()?;
                match kind {
                    Some(PatternKind::Brick { mortar, .. }) => *mortar = given,
                    _ => return Err(Error::invalid(place, "mortar belongs to brick")),
                }
            }
            Keyword::Octaves => {
                self.next()?;
                Rc::make_mut(&mut modifiers.turbulence).octaves = self.float()?;
            }
            Keyword::Omega => {
                self.next()?;
                Rc::make_mut(&mut modifiers.turbulence).omega = self.float()?;
            }
            Keyword::Lambda => {
                self.next()?;
                Rc::make_mut(&mut modifiers.turbulence).lambda = self.float()?;
            }
            Keyword::AgateTurb => {
                self.next()?;
                Rc::make_mut(&mut modifiers.turbulence).agate = self.float()?;
            }
            Keyword::NoiseGenerator => {
                self.next()?;
                // 0 means the scene's generator.
                let said = self.float()?;
                let generator = (said != 0.0).then(|| NoiseGenerator::numbered(said));
                Rc::make_mut(&mut modifiers.turbulence).generator = generator;
            }
            Keyword::Warp => {
                let warp = self.nested(Self::pattern_warp)?;
                if modifiers.warps.len() >= MOST_WARPS {
                    let text = format!("a pattern has at most {MOST_WARPS} warps");
                    return Err(Error::invalid(place, text));
                }
                let before = std::mem::replace(&mut modifiers.place, Matrix::IDENTITY);
                Rc::make_mut(&mut modifiers.warps).push((before, warp));
            }
            Keyword::Turbulence => {
                self.next()?;
                let turbulence = Rc::make_mut(&mut modifiers.turbulence);
                turbulence.amount = self.vector()?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

//! Patterns: where in space which entry of a list or map stands.

use crate::diagnostics::{Fault, Result};
use crate::keywords::Keyword;
use crate::reader::Reader;
use crate::transform::{self, Matrix};

/// Which pattern, with its own numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PatternKind {
    Checker,
    Hexagon,
    Brick { size: [f64; 3], mortar: f64 },
    Gradient([f64; 3]),
}

impl PatternKind {
    /// How many entries its list has; `None` for patterns with a map.
    pub(crate) fn list_length(self) -> Option<usize> {
        match self {
            Self::Checker | Self::Brick { .. } => Some(2),
            Self::Hexagon => Some(3),
            Self::Gradient(_) => None,
        }
    }
}

/// The shape of the wave between 0 and 1.
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

/// A pattern in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pattern {
    pub(crate) kind: PatternKind,
    pub(crate) frequency: f64,
    pub(crate) phase: f64,
    pub(crate) wave: Wave,
    /// From the pattern's own space to the object's.
    pub(crate) place: Matrix,
}

impl Pattern {
    pub(crate) fn new(kind: PatternKind) -> Self {
        Self { kind, frequency: 1.0, phase: 0.0, wave: Wave::Ramp, place: Matrix::IDENTITY }
    }

    pub(crate) fn transform(&mut self, by: &Matrix) {
        self.place = self.place.then(by);
    }
}

impl Reader<'_> {
    /// The word of a pattern, if one comes next.
    pub(crate) fn pattern_kind(&mut self) -> Result<Option<PatternKind>> {
        let kind = match self.peek_word()? {
            Some(Keyword::Checker) => PatternKind::Checker,
            Some(Keyword::Hexagon) => PatternKind::Hexagon,
            Some(Keyword::Brick) => PatternKind::Brick { size: [8.0, 3.0, 4.5], mortar: 0.5 },
            Some(Keyword::Gradient) => {
                self.next()?;
                let place = self.here();
                let direction = self.vector()?;
                if transform::length(direction) == 0.0 {
                    return Err(Fault::invalid(place, "a gradient needs a direction that is not zero"));
                }
                return Ok(Some(PatternKind::Gradient(direction)));
            }
            _ => return Ok(None),
        };
        self.next()?;
        Ok(Some(kind))
    }

    /// `frequency`, `phase`, a wave, a brick's sizes: what changes a pattern, transforms apart.
    pub(crate) fn pattern_modifier(&mut self, pattern: &mut Pattern) -> Result<bool> {
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
            pattern.wave = match wave {
                Wave::Poly(absent) => Wave::Poly(self.float_or(absent)?),
                plain => plain,
            };
            return Ok(true);
        }
        match keyword {
            Keyword::Frequency => {
                self.next()?;
                pattern.frequency = self.float()?;
            }
            Keyword::Phase => {
                self.next()?;
                pattern.phase = self.float()?;
            }
            Keyword::BrickSize => {
                self.next()?;
                let given = self.vector()?;
                match &mut pattern.kind {
                    PatternKind::Brick { size, .. } if given.iter().all(|v| *v != 0.0) => *size = given,
                    PatternKind::Brick { .. } => {
                        return Err(Fault::invalid(place, "a brick has no zero sizes"));
                    }
                    _ => return Err(Fault::invalid(place, "brick_size belongs to brick")),
                }
            }
            Keyword::Mortar => {
                self.next()?;
                let given = self.float()?;
                match &mut pattern.kind {
                    PatternKind::Brick { mortar, .. } => *mortar = given,
                    _ => return Err(Fault::invalid(place, "mortar belongs to brick")),
                }
            }
            // Without turbulence these change nothing.
            Keyword::Octaves | Keyword::Omega | Keyword::Lambda => {
                self.next()?;
                self.float()?;
            }
            Keyword::Turbulence => {
                self.next()?;
                if self.vector()? != [0.0; 3] {
                    return Err(Fault::unsupported(place, "turbulence"));
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

//! Patterns: functions of the point that select or mix entries.

use std::sync::Arc;

use durer_math::Vec3;

use crate::{ImageMap, PointWarp, Ramp};

/// Selects or mixes entries `T` (colours, pigments or textures) by position.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern<T> {
    /// Space is divided into cells, and each cell shows one entry.
    Cells {
        /// How space is divided.
        cells: Cells,
        /// One entry for each kind of cell: [`Cells::kinds`] of them.
        entries: Vec<T>,
    },
    /// A number is computed at each point and looked up in a map.
    Map {
        /// How the number is computed.
        value: Value,
        /// Positions in the map with their entries, in the order written; not empty.
        entries: Vec<(f64, T)>,
    },
    /// The index of a picture's pixel selects the entry, modulo their number.
    Image {
        /// The picture.
        map: Arc<ImageMap>,
        /// The entries; not empty.
        entries: Vec<T>,
    },
    /// Everywhere the mean of all entries, each with its weight.
    Mean(Vec<(f64, T)>),
    /// Another pattern, evaluated at a mapped point. The maps need not be affine.
    Warped {
        /// The maps, in the order in which they are applied to the point.
        warps: Vec<PointWarp>,
        /// The pattern.
        pattern: Box<Pattern<T>>,
    },
}

impl<T> Pattern<T> {
    /// The entries, in the order written.
    pub fn entries(&self) -> impl Iterator<Item = &T> {
        let (cells, map) = match self.plain() {
            Self::Cells { entries, .. } | Self::Image { entries, .. } => (&entries[..], &[][..]),
            Self::Map { entries, .. } | Self::Mean(entries) => (&[][..], &entries[..]),
            Self::Warped { .. } => (&[][..], &[][..]),
        };
        cells.iter().chain(map.iter().map(|(_, entry)| entry))
    }

    /// Whether there are fewer entries than kinds.
    pub fn lacks_entries(&self) -> bool {
        match self.plain() {
            Self::Cells { cells, entries } => entries.len() < cells.kinds(),
            Self::Image { entries, .. } => entries.is_empty(),
            Self::Map { entries, .. } | Self::Mean(entries) => entries.is_empty(),
            Self::Warped { .. } => true,
        }
    }

    /// The pattern without its warps.
    fn plain(&self) -> &Self {
        let mut plain = self;
        while let Self::Warped { pattern, .. } = plain {
            plain = pattern;
        }
        plain
    }
}

/// How space is divided into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cells {
    /// Unit cubes in two kinds, by the parity of the sum of their coordinates.
    Checker,
    /// Endless hexagonal columns along y with sides of length 1, in three kinds.
    Hexagon,
    /// A wall of bricks: the first kind is mortar, the second brick.
    Brick {
        /// The size of a brick with its mortar.
        size: Vec3,
        /// The width of the joints.
        mortar: f64,
    },
    /// Endless square columns along y with sides of length 1, in four kinds.
    Square,
    /// Endless triangular columns along y with sides of length 1, in six kinds.
    Triangular,
}

impl Cells {
    /// The number of kinds of cells.
    pub fn kinds(self) -> usize {
        match self {
            Self::Checker | Self::Brick { .. } => 2,
            Self::Hexagon => 3,
            Self::Square => 4,
            Self::Triangular => 6,
        }
    }
}

/// A number at each point, from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The function that the number grows with.
    pub ramp: Ramp,
    /// The number of waves in each unit of the ramp. 0 leaves the ramp as it is.
    pub frequency: f64,
    /// The shift of the wave.
    pub phase: f64,
    /// The form of the wave.
    pub wave: Wave,
}

impl Value {
    /// One plain wave of `ramp`.
    pub fn new(ramp: Ramp) -> Self {
        Self { ramp, frequency: 1.0, phase: 0.0, wave: Wave::Ramp }
    }
}

/// The waveform: it maps a number `w` from 0 to 1 to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wave {
    /// `w` itself.
    Ramp,
    /// Linearly up, then down.
    Triangle,
    /// A full sine wave.
    Sine,
    /// Half sine waves, which touch zero sharply.
    Scallop,
    /// `3 w^2 - 2 w^3`.
    Cubic,
    /// `w` to a power.
    Poly(f64),
}

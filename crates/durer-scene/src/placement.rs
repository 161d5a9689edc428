//! Placements: affine maps that take no memory for the identity.

use durer_math::{Affine, AffineError};

/// An affine map; the identity is stored without one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement(Option<Box<Affine>>);

impl Placement {
    /// The identity.
    pub const IDENTITY: Self = Self(None);

    /// Makes a placement from a map.
    pub fn new(map: Affine) -> Self {
        if map == Affine::IDENTITY { Self(None) } else { Self(Some(Box::new(map))) }
    }

    /// The map.
    pub fn affine(&self) -> &Affine {
        self.0.as_deref().unwrap_or(&Affine::IDENTITY)
    }

    /// Whether the map is the identity.
    pub fn is_identity(&self) -> bool {
        self.0.is_none()
    }

    /// Applies `next` after this placement.
    pub fn then(&mut self, next: &Affine) -> Result<(), AffineError> {
        *self = Self::new(match self.0.take() {
            None => *next,
            Some(first) => first.then(next)?,
        });
        Ok(())
    }
}

impl From<Affine> for Placement {
    fn from(map: Affine) -> Self {
        Self::new(map)
    }
}

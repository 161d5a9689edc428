//! Blobs.

use std::sync::Arc;

use crate::{BlobComponent, Texture};

/// The points where fields add up to `threshold`; inside, their sum is greater.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob {
    /// The value, which is positive.
    pub threshold: f64,
    /// The fields.
    pub components: Vec<BlobComponent>,
    /// The texture of each of them, placed in the blob's space; one without a texture has the
    /// blob's. Empty if none has one.
    pub textures: Vec<Option<Arc<Texture>>>,
}

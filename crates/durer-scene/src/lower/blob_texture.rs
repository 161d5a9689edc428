//! Blobs whose components have textures of their own: one texture, in the world, that is their mean
//! by the fields.

use std::sync::Arc;

use durer_math::Affine;
use durer_surfaces::Blob;

use super::{LowerErrorKind, Painted};
use crate::{Fields, Placement, Texture, TextureBody};

/// The textures of a blob's components, and the blob's own one of those that have none, in the
/// world.
pub(super) fn texture(
    blob: &crate::Blob,
    place: &Affine,
    (own, frame): &Painted,
) -> Result<Arc<Texture>, LowerErrorKind> {
    let mut rest = (**own).clone();
    rest.transform(frame.affine())?;
    // What is no blob says so where it is built.
    let Ok(fields) = Blob::new(blob.threshold, &blob.components) else { return Ok(Arc::new(rest)) };
    let fields = Fields {
        placement: Placement::new(*place),
        blob: fields,
        textures: blob.textures.clone(),
        rest: Arc::new(rest),
    };
    let made = Texture { body: TextureBody::Fields(Box::new(fields)), placement: Placement::IDENTITY };
    if made.has_empty_pattern() { Err(LowerErrorKind::EmptyPattern) } else { Ok(Arc::new(made)) }
}

//! The texture of a blob whose components have textures of their own: one texture in world space,
//! their mean weighted by the fields.

use std::sync::Arc;

use durer_math::Affine;
use durer_surfaces::Blob;

use super::{LowerErrorKind, Painted};
use crate::{FieldWeights, Fields, Placement, Texture, TextureBody};

/// Makes the texture in world space from the textures of the components. Components without one
/// have the blob's own texture.
pub(super) fn texture(
    blob: &crate::Blob,
    place: &Affine,
    (own, frame): &Painted,
) -> Result<Arc<Texture>, LowerErrorKind> {
    let mut rest = (**own).clone();
    rest.transform(frame.affine())?;
    // An invalid blob is reported where the surface is built.
    let Ok(fields) = Blob::new(blob.threshold, &blob.components) else { return Ok(Arc::new(rest)) };
    let fields = Fields {
        placement: Placement::new(*place),
        by: FieldWeights::Blob(fields),
        textures: blob.textures.clone(),
        rest: Arc::new(rest),
    };
    let made = Texture {
        body: TextureBody::Fields(Box::new(fields)),
        placement: Placement::IDENTITY,
        on_chart: false,
        turn: None,
    };
    if made.has_empty_pattern() { Err(LowerErrorKind::EmptyPattern) } else { Ok(Arc::new(made)) }
}

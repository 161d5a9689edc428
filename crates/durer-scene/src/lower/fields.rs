//! Blobs whose components have textures of their own: one texture, in the world, that is their mean by the fields.

use std::collections::HashMap;
use std::sync::Arc;

use durer_math::Affine;

use super::{LowerErrorKind, Painted};
use crate::{Blob, Fields, Placement, Texture, TextureBody};

/// The textures of a blob's components, and the blob's own one of those that have none, in the world.
pub(super) fn texture(
    blob: &Blob,
    place: &Affine,
    (own, frame): &Painted,
) -> Result<Arc<Texture>, LowerErrorKind> {
    let moved = |texture: &Arc<Texture>, map: &Affine| -> Result<_, LowerErrorKind> {
        if texture.is_uniform() {
            return Ok(Arc::clone(texture));
        }
        let mut moved = (**texture).clone();
        moved.transform(map)?;
        Ok(Arc::new(moved))
    };
    let mut textures = vec![moved(own, frame.affine())?];
    let mut numbers: HashMap<*const Texture, u32> = HashMap::new();
    let mut components = Vec::with_capacity(blob.components.len());
    for (i, component) in blob.components.iter().enumerate() {
        let number = match blob.textures.get(i).and_then(Option::as_ref) {
            None => 0,
            Some(texture) if texture.has_empty_pattern() => return Err(LowerErrorKind::EmptyPattern),
            Some(texture) => match numbers.get(&Arc::as_ptr(texture)) {
                Some(&number) => number,
                None => {
                    let number = textures.len() as u32;
                    textures.push(moved(texture, place)?);
                    numbers.insert(Arc::as_ptr(texture), number);
                    number
                }
            },
        };
        components.push((component.clone(), number));
    }
    let fields = Fields { placement: Placement::new(*place), components, textures };
    let body = TextureBody::Fields(Box::new(fields));
    Ok(Arc::new(Texture { body, placement: Placement::IDENTITY }))
}

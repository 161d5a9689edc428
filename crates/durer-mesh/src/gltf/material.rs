//! Materials: their base colours. Colour values in glTF files are linear light, as in scenes.

use crate::default_view;
use crate::error::{ErrorKind, Location};
use durer_scene::{Colour, Rgb, Texture};
use gltf::json::Material;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;
use std::sync::Arc;

/// The texture of a material, without its images.
pub(super) fn texture(material: &Material, number: usize) -> Result<Arc<Texture>, ErrorKind> {
    let spot = Location::Element("material", number);
    let factor = material.pbr_metallic_roughness.base_color_factor.0.map(f64::from);
    if let Some(x) = factor.into_iter().find(|x| !(0.0..=1.0).contains(x)) {
        return super::wrong(spot, format!("its baseColorFactor must be from 0 to 1, got {x}"));
    }
    let [r, g, b, alpha] = factor;
    let cover = match material.alpha_mode {
        Checked::Valid(AlphaMode::Opaque) => 1.0,
        Checked::Valid(AlphaMode::Blend) => alpha,
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = material.alpha_cutoff.map_or(0.5, |c| f64::from(c.0));
            f64::from(u8::from(alpha >= cutoff))
        }
        Checked::Invalid => return super::wrong(spot, "its alphaMode is unknown"),
    };
    let colour = Colour { transmit: 1.0 - cover, ..Colour::opaque(Rgb::new(r, g, b)) };
    Ok(Arc::new(default_view::paint(colour)))
}

//! The media that rays are in, and the interface between two media.
//!
//! Rays keep a list of the media they are in. At a surface whose medium is in the list the ray
//! leaves that medium; at any other surface it enters one. The list decides, not the normal, so
//! that open sheets and overlapping solids have a meaning too.

use crate::material::reflectance;
use crate::world::World;
use durer_math::F8;

/// How a surface changes the list of media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    Enter,
    Leave {
        /// The index, in the list, of the medium that the ray leaves.
        at: usize,
    },
    /// The ray only touches the surface, and the list does not change.
    Touch,
}

impl Crossing {
    pub(super) fn new(media: &[u32], medium: u32, grazing: bool) -> Self {
        if grazing {
            return Self::Touch;
        }
        media.iter().position(|&m| m == medium).map_or(Self::Enter, |at| Self::Leave { at })
    }

    /// Sets `list` to the media behind the surface of `medium`; `media` is the list before it.
    pub(super) fn behind(self, medium: u32, media: &[u32], list: &mut Vec<u32>) {
        list.clear();
        list.extend_from_slice(media);
        match self {
            Self::Enter => list.push(medium),
            Self::Leave { at } => {
                list.remove(at);
            }
            Self::Touch => {}
        }
    }
}

/// The interface between two media at a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interface {
    pub(super) crossing: Crossing,
    /// The index of refraction before the surface divided by that behind it.
    pub(super) ratio: f64,
    /// The ratio for Fresnel's formula. There the medium behind the surface is always the surface's
    /// own, except where a ray is in that medium alone and leaves it (a fact of the scene
    /// language).
    fresnel_ratio: f64,
}

impl Interface {
    /// The interface at a surface of `medium`, for rays in the media of `list`.
    pub(super) fn new(world: &World, list: &[u32], medium: u32, grazing: bool) -> Self {
        let index = |medium: Option<&u32>| medium.map_or(1.0, |&m| world.media[m as usize].ior);
        let own = index(Some(&medium));
        let crossing = Crossing::new(list, medium, grazing);
        let ratio = match crossing {
            Crossing::Enter => index(list.last()) / own,
            // Leaving bends the ray only if this medium was the last one entered.
            Crossing::Leave { at } if at + 1 == list.len() => own / index(list[..at].last()),
            Crossing::Leave { .. } | Crossing::Touch => 1.0,
        };
        let fresnel_ratio = if *list == [medium] { own } else { index(list.last()) / own };
        Self { crossing, ratio, fresnel_ratio }
    }

    /// The fraction of the light that is reflected: all of it where a perturbed normal points away
    /// from the eye, at a negative `cosine` (a fact of the language).
    #[inline(always)]
    pub(super) fn fresnel(&self, cosine: F8) -> F8 {
        if self.fresnel_ratio == 1.0 {
            cosine.lt(F8::ZERO).select(F8::ONE, F8::ZERO)
        } else {
            reflectance(self.fresnel_ratio, cosine)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_the_list_is_left_and_all_else_entered() {
        let behind = |media: &[u32], medium, grazing| {
            let mut list = vec![99];
            Crossing::new(media, medium, grazing).behind(medium, media, &mut list);
            list
        };
        assert_eq!(behind(&[1, 2], 3, false), [1, 2, 3]);
        assert_eq!(behind(&[1, 2, 1], 1, false), [2, 1]);
        assert_eq!(behind(&[1, 2], 1, false), [2]);
        assert_eq!(behind(&[1, 2], 1, true), [1, 2]);
    }
}

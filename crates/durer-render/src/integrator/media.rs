//! Which media rays are in, and what happens at the border between two of them.
//!
//! Rays keep a list of the media they are in. A surface whose medium is in the list is left, any
//! other is entered. The list decides, and not the normal, so that sheets and overlapping bodies
//! have a meaning too.

use crate::material::reflectance;
use crate::world::World;
use durer_math::F8;

/// What a surface does to a list of media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    Enter,
    Leave {
        /// Which of the list is left.
        at: usize,
    },
    /// The ray stays where it is.
    Touch,
}

impl Crossing {
    pub(super) fn new(media: &[u32], medium: u32, grazing: bool) -> Self {
        if grazing {
            return Self::Touch;
        }
        media.iter().rposition(|&m| m == medium).map_or(Self::Enter, |at| Self::Leave { at })
    }

    /// Makes `list` what `media` is behind the surface of `medium`.
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

/// The border between two media.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interface {
    pub(super) crossing: Crossing,
    /// The index of refraction before the surface over that behind it.
    pub(super) ratio: f64,
    /// The same as Fresnel's formula takes it. A fact of the scene language: behind the surface is
    /// always its own medium, save where a ray is in that alone and leaves it.
    fresnel_ratio: f64,
}

impl Interface {
    /// The border of `medium`, for rays in the media of a list.
    pub(super) fn new(world: &World, list: &[u32], medium: u32, grazing: bool) -> Self {
        let index = |medium: Option<&u32>| medium.map_or(1.0, |&m| world.media[m as usize].ior);
        let own = index(Some(&medium));
        let crossing = Crossing::new(list, medium, grazing);
        let ratio = match crossing {
            Crossing::Enter => index(list.last()) / own,
            // Only what was entered last bends the ray when it is left.
            Crossing::Leave { at } if at + 1 == list.len() => own / index(list[..at].last()),
            Crossing::Leave { .. } | Crossing::Touch => 1.0,
        };
        let fresnel_ratio = if *list == [medium] { own } else { index(list.last()) / own };
        Self { crossing, ratio, fresnel_ratio }
    }

    /// The part of the light that is reflected.
    #[inline(always)]
    pub(super) fn fresnel(&self, cosine: F8) -> F8 {
        if self.fresnel_ratio == 1.0 { F8::ZERO } else { reflectance(self.fresnel_ratio, cosine) }
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
        assert_eq!(behind(&[1, 2, 1], 1, false), [1, 2]);
        assert_eq!(behind(&[1, 2], 1, false), [2]);
        assert_eq!(behind(&[1, 2], 1, true), [1, 2]);
    }
}

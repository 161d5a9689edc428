//! Grouping of a bundle's rays: rays that hit surfaces with the same look, in the same way, are
//! shaded together.

use crate::vector::dot;
use crate::world::{Look, World};
use durer_geometry::{Hits8, Rays8};
use durer_math::M8;
use durer_math::lanes::{LANES, set_bits};

/// The lanes of a group that are shaded together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Piece {
    /// The number of the look, times two, plus one if the rays only touch the surface.
    key: u32,
    pub(super) group: u32,
    pub(super) lanes: u8,
}

/// Splits the hits of a group into pieces and adds these to `pieces`.
#[inline(always)]
pub(super) fn cut(world: &World, group: usize, rays: &Rays8, hits: &Hits8, pieces: &mut Vec<Piece>) {
    let mut left = hits.hit.bits();
    if left == 0 {
        return;
    }
    let (object, primitive) = (hits.object[0], hits.primitive[0]);
    let mut differ = 0;
    for i in 0..LANES {
        differ |= (hits.object[i] ^ object) | (hits.primitive[i] ^ primitive);
    }
    // Most groups hit one surface.
    if left == u8::MAX && differ == 0 && !hits.touching.any() && !world.has_insides {
        pieces.push(Piece {
            key: world.look_number(object, primitive) << 1,
            group: group as u32,
            lanes: left,
        });
        return;
    }
    // The shading normal decides from which side a smooth face is seen, not the plane of the face.
    let along = if world.has_insides { dot(hits.ns, rays.direction).0 } else { [0.0; LANES] };
    let mut keys = [0_u32; LANES];
    let mut last = (u32::MAX, u32::MAX, 0);
    for i in set_bits(left) {
        let (object, primitive) = (hits.object[i], hits.primitive[i]);
        if (object, primitive) != (last.0, last.1) {
            last = (object, primitive, world.look_number(object, primitive) << 1);
        }
        keys[i] = last.2 | u32::from(hits.touching.lane(i));
        if world.has_insides && along[i] > 0.0 {
            keys[i] = world.looks[(last.2 >> 1) as usize].inside << 1 | keys[i] & 1;
        }
    }
    while left != 0 {
        let key = keys[left.trailing_zeros() as usize];
        let same = M8::from_fn(
            #[inline(always)]
            |i| keys[i] == key,
        );
        let same = same.bits();
        pieces.push(Piece { key, group: group as u32, lanes: same & left });
        left &= !same;
    }
}

/// Sorts the pieces, so that pieces with the same key are adjacent.
pub(super) fn sort(pieces: &mut [Piece]) {
    // Most bundles hit one look.
    if pieces.windows(2).any(|w| w[0].key != w[1].key) {
        pieces.sort_unstable();
    }
}

impl Piece {
    /// Whether two pieces are shaded together.
    #[inline]
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.key == other.key
    }

    pub(super) fn look<'w>(&self, world: &'w World) -> &'w Look {
        &world.looks[(self.key >> 1) as usize]
    }

    /// Whether the rays only touch the surface.
    pub(super) fn is_grazing(&self) -> bool {
        self.key & 1 == 1
    }
}

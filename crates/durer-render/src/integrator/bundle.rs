//! Bundles: rays that are traced together.

use crate::lanes::Rgb8;
use crate::material::Mirror;
use durer_geometry::{Geometry, Hits8, Rays8, Scratch};
use durer_math::lanes::LANES;
use durer_math::{F8, M8};

/// The number of groups of neighbouring rays that share one search of the tree.
pub(super) const TOGETHER: usize = 16;

/// A group with at least this many active rays is used as it is. Rays of sparser groups are
/// gathered into new groups.
const DENSE: u32 = 6;

/// The greatest number of rays in a row; further ones are black. After this many transparent
/// surfaces in a row, no light passes. The limit bounds the list of media that each ray keeps.
pub(super) const DEEPEST: u32 = 4096;

/// How the colours of eight rays enter the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paths8 {
    /// The greatest channel of the colour's weight in the picture.
    pub(super) weight: F8,
    /// The factor of the colour.
    pub(super) factor: Rgb8,
    /// The number of the sum to which the colour is added.
    pub(super) slot: [u32; LANES],
    /// The positions in the picture as bits; they are the seeds of random numbers.
    pub(super) seed: [u64; LANES],
}

/// The state that all rays of a bundle share.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BundleState<'w> {
    /// The recursion level; the camera's rays have level 1.
    pub(super) level: u32,
    /// The number of rays before these. Rays that pass through a surface without refraction are
    /// included, although they do not raise the level.
    pub(super) depth: u32,
    /// The mask of the objects that the rays can hit.
    pub(super) mask: u32,
    /// The number of random numbers drawn on the way.
    pub(super) draws: u32,
    /// The mirror that changes the colours before any factor is applied, if there is one.
    pub(super) mirror: Option<&'w Mirror>,
    /// The media that the rays are in; the one entered last is at the end.
    pub(super) media: Vec<u32>,
    /// In a record, the number of the ray; before it is traced, that of the ray that led to it.
    pub(super) node: u32,
    /// The kind of ray, the second part of its bundle's key.
    pub(super) kind: u32,
}

/// Rays with everything needed to trace them.
#[derive(Clone, Debug)]
pub(super) struct Bundle<'w> {
    pub(super) rays: Vec<Rays8>,
    pub(super) paths: Vec<Paths8>,
    pub(super) standing: BundleState<'w>,
    loose: Loose,
}

/// The group that is being filled with single rays.
#[derive(Clone, Copy, Debug)]
struct Loose {
    group: usize,
    /// The number of its rays. A full group gets no more rays.
    filled: usize,
}

/// Whether a group with these active lanes is used as it is.
#[inline(always)]
pub(super) fn is_dense(lanes: u8) -> bool {
    lanes.count_ones() >= DENSE
}

impl Paths8 {
    pub(super) const NONE: Self =
        Self { weight: F8::ONE, factor: Rgb8::WHITE, slot: [0; LANES], seed: [0; LANES] };

    /// Copies lane `j` of `from` into lane `i`.
    #[inline(always)]
    pub(super) fn copy_lane(&mut self, i: usize, from: &Self, j: usize) {
        self.weight.0[i] = from.weight.0[j];
        self.factor.set_lane(i, from.factor.lane(j));
        self.slot[i] = from.slot[j];
        self.seed[i] = from.seed[j];
    }
}

impl<'w> Bundle<'w> {
    /// Makes an empty bundle. The camera's rays are outside of all media.
    pub(super) fn new() -> Self {
        let standing = BundleState {
            level: 1,
            depth: 0,
            mask: 0,
            draws: 0,
            mirror: None,
            media: Vec::new(),
            node: 0,
            kind: 0,
        };
        let loose = Loose { group: 0, filled: LANES };
        Self { rays: Vec::new(), paths: Vec::new(), standing, loose }
    }

    /// Removes the rays.
    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.paths.clear();
        self.loose.filled = LANES;
    }

    /// Adds the rays in `lanes`.
    #[inline(always)]
    pub(super) fn add(&mut self, rays: &Rays8, paths: &Paths8, lanes: M8) {
        if is_dense(lanes.bits()) {
            self.rays.push(Rays8 { live: lanes, ..*rays });
            self.paths.push(*paths);
        } else {
            self.add_loose(rays, paths, lanes);
        }
    }

    /// Adds the rays in `lanes` one by one to the group that is being filled.
    #[inline(never)]
    fn add_loose(&mut self, rays: &Rays8, paths: &Paths8, lanes: M8) {
        for j in lanes.lanes() {
            if self.loose.filled == LANES {
                self.loose = Loose { group: self.rays.len(), filled: 0 };
                self.rays.push(Rays8::NONE);
                self.paths.push(Paths8::NONE);
            }
            let Loose { group, filled: i } = self.loose;
            copy_lane(&mut self.rays[group], i, rays, j);
            self.paths[group].copy_lane(i, paths, j);
            self.loose.filled += 1;
        }
    }
}

/// Finds the first hits of rays.
pub(super) fn see(geometry: &Geometry, rays: &[Rays8], mask: u32, hits: &mut [Hits8], scratch: &mut Scratch) {
    for (rays, hits) in rays.chunks(TOGETHER).zip(hits.chunks_mut(TOGETHER)) {
        let beam = geometry.bundle_candidates(rays);
        geometry.first_visible8(beam.as_ref(), rays, mask, hits, scratch);
    }
}

/// Copies the ray in lane `j` of `from` into lane `i` of `to`.
#[inline(always)]
pub(super) fn copy_lane(to: &mut Rays8, i: usize, from: &Rays8, j: usize) {
    (to.origin.x.0[i], to.origin.y.0[i], to.origin.z.0[i]) =
        (from.origin.x.0[j], from.origin.y.0[j], from.origin.z.0[j]);
    to.direction.set_lane(i, from.direction.lane(j));
    to.t_max.0[i] = from.t_max.0[j];
    to.live.set_lane(i, true);
    to.source.copy_lane(i, &from.source, j);
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Vec3;

    #[test]
    fn no_ray_is_lost_and_groups_are_dense() {
        let mut bundle = Bundle::new();
        let mut want = Vec::new();
        for bits in 0..=255_u8 {
            let tell = |i: usize| f64::from(bits) * 8.0 + i as f64;
            let mut rays = Rays8::NONE;
            rays.direction = Vec3::new(F8(core::array::from_fn(tell)), F8::ONE, F8::ONE);
            let mut paths = Paths8::NONE;
            paths.slot = core::array::from_fn(|i| tell(i) as u32);
            let lanes = M8::from_bits(bits);
            bundle.add(&rays, &paths, lanes);
            want.extend(lanes.lanes().map(|i| tell(i) as u32));
        }
        let mut got = Vec::new();
        for (rays, paths) in bundle.rays.iter().zip(&bundle.paths) {
            for i in rays.live.lanes() {
                assert_eq!(rays.direction.x.0[i], f64::from(paths.slot[i]));
                got.push(paths.slot[i]);
            }
        }
        got.sort_unstable();
        assert_eq!(got, want);
        // Only the group that is being filled may be sparse.
        let is_sparse = |r: &&Rays8| r.live.count() < DENSE as usize;
        assert!(bundle.rays.iter().filter(is_sparse).count() <= 1);
    }
}

//! Eight shading points on surfaces with the same look, gathered to be shaded together.

use super::bundle::{Paths8, is_dense};
use super::group::Piece;
use crate::lanes::Rgb8;
use crate::material::View;
use crate::texture::Around8;
use crate::vector::{dot, length};
use durer_geometry::{Hits8, Rays8};
use durer_math::lanes::{LANES, set_bits};
use durer_math::{F8, Isa, M8, Point3, Vec3};
use durer_scene::Chart;

/// Eight points to be shaded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// The lanes that hold a point.
    pub(super) live: M8,
    /// The points.
    pub(super) hits: Hits8,
    /// How their colours enter the picture.
    pub(super) paths: Paths8,
    /// The directions of view. Before [`face`] is called, `eye` is the direction of the ray, not
    /// normalised.
    pub(super) view: View,
    /// The distance from the start of the ray.
    pub(super) distance: F8,
    /// The points in the space of their texture.
    pub(super) inside: Point3<F8>,
    /// The texture coordinates, if the texture uses them.
    pub(super) uv: [F8; 2],
    /// The light found so far.
    pub(super) sum: Rgb8,
    /// The transmittance of the layers so far.
    pub(super) passed: Rgb8,
}

impl Spot {
    /// The properties of the surface there that patterns may use.
    #[inline(always)]
    pub(super) fn around(&self) -> Around8 {
        Around8 { points: self.hits.p, normals: self.view.normal, rays: self.view.eye, uv: self.uv }
    }

    const NONE: Self = Self {
        live: M8::NONE,
        hits: Hits8::NONE,
        paths: Paths8::NONE,
        view: View { eye: Rays8::NONE.direction, normal: Hits8::NONE.ns, cosine: F8::ONE },
        distance: F8::ZERO,
        inside: Hits8::NONE.p,
        uv: [F8::ZERO; 2],
        sum: Rgb8::BLACK,
        passed: Rgb8::WHITE,
    };

    /// Copies lane `j` of a group's hits into lane `i`.
    #[inline(always)]
    fn copy_met(&mut self, i: usize, (hits, direction, paths): (&Hits8, Vec3<F8>, &Paths8), j: usize) {
        let to = &mut self.hits;
        to.t.0[i] = hits.t.0[j];
        (to.p.x.0[i], to.p.y.0[i], to.p.z.0[i]) = (hits.p.x.0[j], hits.p.y.0[j], hits.p.z.0[j]);
        to.ng.set_lane(i, hits.ng.lane(j));
        to.ns.set_lane(i, hits.ns.lane(j));
        to.off.0[i] = hits.off.0[j];
        to.primitive[i] = hits.primitive[j];
        to.source.copy_lane(i, &hits.source, j);
        self.view.eye.set_lane(i, direction.lane(j));
        self.paths.copy_lane(i, paths, j);
    }

    /// Copies lane `j` of `from` into lane `i`, before anything is shaded.
    #[inline(always)]
    fn copy_lane(&mut self, i: usize, from: &Self, j: usize) {
        self.copy_met(i, (&from.hits, from.view.eye, &from.paths), j);
        self.view.normal.set_lane(i, from.view.normal.lane(j));
        self.view.cosine.0[i] = from.view.cosine.0[j];
        self.distance.0[i] = from.distance.0[j];
        for (to, from) in self.uv.iter_mut().zip(&from.uv) {
            to.0[i] = from.0[j];
        }
        let p = &mut self.inside;
        (p.x.0[i], p.y.0[i], p.z.0[i]) = (from.inside.x.0[j], from.inside.y.0[j], from.inside.z.0[j]);
    }
}

/// The shading points in use, followed by others kept for reuse.
#[derive(Default)]
pub(super) struct Spots {
    spots: Vec<Spot>,
    used: usize,
}

impl Spots {
    /// The next element, without live lanes; its other contents are unspecified.
    #[inline(always)]
    fn next(&mut self) -> &mut Spot {
        if self.used == self.spots.len() {
            self.spots.push(Spot::NONE);
        }
        self.used += 1;
        let spot = &mut self.spots[self.used - 1];
        spot.live = M8::NONE;
        spot
    }

    /// Adds the given lanes of groups: dense groups by `whole(to, group)`, single lanes by
    /// `copy(to, i, group, j)`.
    #[inline(always)]
    fn pack(
        &mut self,
        lists: impl Iterator<Item = (usize, u8)>,
        whole: impl Fn(&mut Spot, usize),
        copy: impl Fn(&mut Spot, usize, usize, usize),
    ) {
        self.used = 0;
        let (mut open, mut filled) = (0, LANES);
        for (group, lanes) in lists {
            if is_dense(lanes) {
                let spot = self.next();
                whole(spot, group);
                spot.live = M8::from_bits(lanes);
                continue;
            }
            for j in set_bits(lanes) {
                if filled == LANES {
                    (open, filled) = (self.used, 0);
                    self.next();
                }
                let spot = &mut self.spots[open];
                copy(spot, filled, group, j);
                spot.live.set_lane(filled, true);
                filled += 1;
            }
        }
    }

    /// Gathers the hits of some rays. The direction of the ray stands in `view.eye` until [`face`]
    /// is called.
    pub(super) fn gather(
        &mut self,
        isa: Isa,
        pieces: &[Piece],
        (rays, paths): (&[Rays8], &[Paths8]),
        hits: &[Hits8],
    ) -> &mut [Spot] {
        // Compiled for the lanes' instruction set, because whole groups are copied in large blocks.
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.pack(
                    pieces.iter().map(
                        #[inline(always)]
                        |p| (p.group as usize, p.lanes),
                    ),
                    #[inline(always)]
                    |to, g| {
                        to.hits = hits[g];
                        to.view.eye = rays[g].direction;
                        to.paths = paths[g];
                    },
                    #[inline(always)]
                    |to, i, g, j| to.copy_met(i, (&hits[g], rays[g].direction, &paths[g]), j),
                );
            },
        );
        &mut self.spots[..self.used]
    }

    /// Gathers some lanes of spots in which nothing is shaded yet.
    pub(super) fn gather_again(
        &mut self,
        isa: Isa,
        lists: impl Iterator<Item = (usize, u8)>,
        from: &[Spot],
    ) -> &mut [Spot] {
        isa.run_in_lanes(
            #[inline(always)]
            || {
                self.pack(
                    lists,
                    #[inline(always)]
                    |to, g| *to = from[g],
                    #[inline(always)]
                    |to, i, g, j| to.copy_lane(i, &from[g], j),
                );
            },
        );
        &mut self.spots[..self.used]
    }
}

/// Computes the texture coordinates.
pub(super) fn map_to_chart(chart: &Chart, spots: &mut [Spot]) {
    for spot in spots {
        for i in spot.live.lanes() {
            let p = spot.hits.p.to_vec().lane(i).to_point();
            let [u, v] = chart.uv(p, spot.hits.primitive[i]);
            (spot.uv[0].0[i], spot.uv[1].0[i]) = (u, v);
        }
    }
}

/// Computes the directions of view, the normals that face them and their cosines.
pub(super) fn face(isa: Isa, spots: &mut [Spot]) {
    isa.run_in_lanes(
        #[inline(always)]
        || {
            for Spot { hits, view, distance, inside, .. } in spots {
                let speed = length(view.eye);
                let eye = view.eye * (F8::ONE / speed);
                let slope = dot(hits.ns, eye);
                let normal = (F8::ZERO).lt(slope).select3(-hits.ns, hits.ns);
                // Rounding must not make it more than 1.
                *view = View { eye, normal, cosine: slope.abs().min(F8::ONE) };
                *distance = hits.t * speed;
                *inside = hits.p;
            }
        },
    );
}

//! A record of all rays that follow from one camera ray, for explanations.
//!
//! Recording follows one camera ray alone. Every bundle then holds one ray, so a bundle is a node
//! of the tree of rays.

use super::bundle::{Bundle, Paths8};
use super::secondary::{THROUGH, TOTAL};
use super::shading_point::Spot;
use crate::lanes::Rgb8;
use durer_geometry::{Hits8, Rays8};
use durer_math::{M8, Point3, Ray};
use durer_scene::Rgb;

/// The reason why a ray was traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// It is the camera's ray.
    Camera,
    /// It continues behind a transparent surface, refracted or not.
    Transmitted,
    /// It is totally reflected at a transparent surface.
    TotallyReflected,
    /// A mirror reflects it.
    Reflected,
}

/// A ray of a [`RayTree`].
#[derive(Clone, Debug, PartialEq)]
pub struct TracedRay {
    /// The index of the ray that led to it; less than its own.
    pub parent: Option<usize>,
    /// Why it was traced.
    pub kind: RayKind,
    /// The recursion level; the camera's rays have level 1.
    pub level: u32,
    /// The ray.
    pub ray: Ray,
    /// The first surface that it hits: object, primitive, parameter and point.
    pub hit: Option<(u32, u32, f64, Point3)>,
    /// The factor from the ray's colour to the pixel's. Behind a mirror that changes colours, the
    /// factor to that mirror's colour.
    pub factor: Rgb,
    /// The contribution of the surface's own and scattered light, or of the background, to the
    /// pixel.
    pub light: Rgb,
    /// The contribution of the ray and all rays that follow from it to the pixel.
    pub total: Rgb,
    /// The shadow rays from its hit, one for each light that the surface scatters.
    pub shadows: Vec<ShadowRay>,
    /// The ray's colour as a mirror that changes colours shows it.
    shown: Option<Rgb>,
}

/// A ray from a surface to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRay {
    /// The number of the light, counting those that are not black.
    pub light: usize,
    /// Where the ray ends.
    pub target: Point3,
    /// The light that would reach the pixel if nothing were in the way.
    pub unblocked: Rgb,
    /// The light that reaches the pixel.
    pub arrived: Rgb,
}

/// All rays that follow from a camera ray, in the order in which they are traced.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTree {
    /// The rays; the first is the camera's.
    pub rays: Vec<TracedRay>,
    /// Whether there are more rays than are kept.
    pub has_more: bool,
    /// The colour of the pixel.
    pub colour: Rgb,
}

/// The most rays that are kept.
const MOST_RAYS: usize = 1000;

/// The node of a ray that is not kept.
pub(super) const NO_NODE: u32 = u32::MAX;

#[derive(Debug, Default)]
pub(super) struct Record {
    rays: Vec<TracedRay>,
    has_more: bool,
}

impl Record {
    /// Adds the ray of a bundle, whose state still has the number of the ray before it. Returns the
    /// new number.
    pub(super) fn begin(&mut self, bundle: &Bundle<'_>) -> u32 {
        let state = &bundle.standing;
        let live = bundle.rays.iter().zip(&bundle.paths).find(|(rays, _)| rays.live.any());
        let Some((rays, paths)) = live else { return NO_NODE };
        let Some(i) = rays.live.first_set() else { return NO_NODE };
        if self.rays.len() == MOST_RAYS {
            self.has_more = true;
            return NO_NODE;
        }
        let kind = match (state.depth, state.kind) {
            (0, _) => RayKind::Camera,
            (_, THROUGH) => RayKind::Transmitted,
            (_, TOTAL) => RayKind::TotallyReflected,
            _ => RayKind::Reflected,
        };
        self.rays.push(TracedRay {
            parent: (state.depth > 0).then_some(state.node as usize),
            kind,
            level: state.level,
            ray: rays.lane(i),
            hit: None,
            factor: paths.factor.lane(i),
            light: Rgb::BLACK,
            total: Rgb::BLACK,
            shadows: Vec::new(),
            shown: None,
        });
        (self.rays.len() - 1) as u32
    }

    fn node(&mut self, node: u32) -> Option<&mut TracedRay> {
        self.rays.get_mut(node as usize)
    }

    /// Records the hit of the node's ray, or the light of the background.
    pub(super) fn see(
        &mut self,
        node: u32,
        rays: &[Rays8],
        hits: &[Hits8],
        paths: &[Paths8],
        beyond: impl Fn(&Rays8, M8) -> Rgb8,
    ) {
        let Some(node) = self.node(node) else { return };
        for ((rays, hits), paths) in rays.iter().zip(hits).zip(paths) {
            let beyond = beyond(rays, rays.live & !hits.hit);
            for i in rays.live.lanes() {
                if hits.hit.lane(i) {
                    let point = hits.p.to_vec().lane(i).to_point();
                    node.hit = Some((hits.object[i], hits.primitive[i], hits.t.0[i], point));
                } else {
                    node.light += beyond.lane(i) * paths.factor.lane(i);
                }
            }
        }
    }

    /// Adds light that joins the node's ray on its way from a shading point.
    pub(super) fn add(&mut self, node: u32, spot: &Spot, light: Rgb8) {
        let Some(node) = self.node(node) else { return };
        for i in spot.live.lanes() {
            node.light += light.lane(i) * spot.paths.factor.lane(i);
        }
    }

    /// Adds the light that a stack of layers gives.
    pub(super) fn shade(&mut self, node: u32, spots: &[Spot]) {
        let Some(node) = self.node(node) else { return };
        for spot in spots {
            for i in spot.live.lanes() {
                node.light += spot.sum.lane(i) * spot.paths.factor.lane(i);
            }
        }
    }

    /// Adds the contribution of one light, unblocked and after shadows.
    pub(super) fn light(
        &mut self,
        node: u32,
        light: usize,
        spots: &[Spot],
        before: &[(Rgb8, Point3<durer_math::F8>)],
        after: &[Rgb8],
    ) {
        let Some(node) = self.node(node) else { return };
        for ((spot, (unblocked, target)), arrived) in spots.iter().zip(before).zip(after) {
            for i in spot.live.lanes() {
                let factor = spot.paths.factor.lane(i);
                let unblocked = unblocked.lane(i) * factor;
                if unblocked == Rgb::BLACK {
                    continue;
                }
                let arrived = arrived.lane(i) * factor;
                match node.shadows.iter_mut().find(|s| s.light == light) {
                    Some(known) => {
                        known.unblocked += unblocked;
                        known.arrived += arrived;
                    }
                    None => {
                        let target = target.to_vec().lane(i).to_point();
                        node.shadows.push(ShadowRay { light, target, unblocked, arrived });
                    }
                }
            }
        }
    }

    /// Records the colour of a ray as a mirror that changes colours shows it.
    pub(super) fn show(&mut self, node: u32, shown: Rgb) {
        if let Some(node) = self.node(node) {
            node.shown = Some(shown);
        }
    }

    /// The finished tree.
    pub(super) fn finish(mut self, colour: Rgb) -> RayTree {
        // Every ray comes after the one that led to it.
        for i in (0..self.rays.len()).rev() {
            let ray = &mut self.rays[i];
            let total = ray.shown.unwrap_or(ray.total + ray.light);
            ray.total = total;
            if let Some(parent) = ray.parent.and_then(|p| self.rays.get_mut(p)) {
                parent.total += total;
            }
        }
        RayTree { rays: self.rays, has_more: self.has_more, colour }
    }
}

//! Shadow rays: what is left of a light on its way to a point.

use super::whitted::{Crossing, Node, Whitted};
use crate::vector::{dot_n, length};
use durer_geometry::Hit;
use durer_math::{Point3, Ray};
use durer_scene::{Rgb, mask};
use durer_surfaces::{Need, SurfacePoint};

impl Whitted<'_> {
    /// The part of the light at `target` that arrives at `point`: none behind anything opaque, else what all clear surfaces on the way let pass, not
    /// bent. Light fades in a medium when it leaves it.
    pub(super) fn through(
        &mut self,
        point: &SurfacePoint,
        target: Point3,
        lamp: (usize, bool),
        cell: f64,
        node: &Node,
    ) -> Rgb {
        let world = self.world;
        let ray = point.spawn_to(target);
        self.counts.shadow += 1;
        let geometry = world.geometry();
        let between = self.cells.between(geometry, &ray, lamp, cell);
        let blocked = match between {
            Some(beam) if beam.is_empty() => return Rgb::WHITE,
            Some(beam) => geometry.any_in(beam, &ray, mask::SHADOW),
            None => geometry.any_masked(&ray, mask::SHADOW),
        };
        if blocked {
            return Rgb::BLACK;
        }
        if !world.has_clear_shadows {
            return Rgb::WHITE;
        }
        let first = match between {
            Some(beam) => geometry.seen_in(beam, &ray, mask::CLEAR_SHADOW, Need::POINT),
            None => geometry.seen(&ray, mask::CLEAR_SHADOW, Need::POINT),
        };
        match first {
            Some(first) => self.through_clear(&ray, first, target, node),
            None => Rgb::WHITE,
        }
    }

    fn through_clear(&mut self, first: &Ray, seen: (Hit, SurfacePoint), target: Point3, node: &Node) -> Rgb {
        let world = self.world;
        let start = self.media.len();
        self.media.extend_from_within(node.media.clone());
        let mut ray = *first;
        let mut left = Rgb::WHITE;
        let mut next = Some(seen);
        while let Some((hit, point)) = next {
            let look = world.look_of(hit.object, hit.primitive);
            left = left * world.paints[look.paint as usize].passed(point.p);
            if left.is_black() {
                break;
            }
            let speed = length(ray.direction);
            let medium = &world.media[look.medium as usize];
            match Crossing::new(&self.media[start..], look.medium, hit.sign == 0) {
                Crossing::Enter => self.media.push(look.medium),
                Crossing::Leave { at } => {
                    left = left * medium.left_after(hit.t * speed);
                    self.media.remove(start + at);
                }
                Crossing::Touch => {}
            }
            if let Some(power) = medium.caustics {
                let cosine = dot_n(point.ng, ray.direction).abs() / speed;
                left = left * (1.0 + power.of(cosine));
            }
            ray = point.spawn_to(target);
            self.counts.shadow += 1;
            next = world.geometry().seen(&ray, mask::CLEAR_SHADOW, Need::POINT);
        }
        self.media.truncate(start);
        left
    }
}

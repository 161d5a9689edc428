//! A tree of balls over the fields of a blob. Only fields near the eight rays, or near the eight
//! points, are evaluated.
//!
//! Fields are sorted so that neighbours in the list are neighbours in space. A ball around a run of
//! fields contains everything that they reach, and each half of the run has a ball of its own. Rays
//! or points that are certainly outside a ball get nothing from the fields in it.

use crate::packet::rays::SLACK;
use core::ops::Range;
use durer_math::{Aabb, U, Vec3};

/// A run of fields, and a ball that holds them.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) centre: Vec3,
    pub(super) radius: f64,
    /// The fields, if they are so few that the run is not divided; else empty.
    pub(super) fields: Range<usize>,
    /// The next group in the list that contains none of this group's fields.
    pub(super) next: usize,
}

/// Runs of at most this many fields are not divided.
const FEW: usize = 2;

/// The groups of fields with these bounding boxes, each before its halves.
pub(super) fn groups(boxes: &[Aabb]) -> Box<[Group]> {
    let mut groups = Vec::new();
    add(boxes, 0..boxes.len(), &mut groups);
    groups.into()
}

fn add(boxes: &[Aabb], fields: Range<usize>, groups: &mut Vec<Group>) {
    let held = boxes[fields.clone()].iter().fold(Aabb::EMPTY, |sum, b| sum.union(*b));
    let centre = held.centre();
    let far = held.min.to_vec().max_abs().max(held.max.to_vec().max_abs());
    // Each coordinate of a corner has been rounded once.
    let radius = held.reach_from(centre) * SLACK + far * (4.0 * U);
    let place = groups.len();
    let is_whole = fields.len() <= FEW;
    let own = if is_whole { fields.clone() } else { 0..0 };
    groups.push(Group { centre: centre.to_vec(), radius, fields: own, next: 0 });
    if !is_whole {
        let middle = fields.start + fields.len() / 2;
        add(boxes, fields.start..middle, groups);
        add(boxes, middle..fields.end, groups);
    }
    groups[place].next = groups.len();
}

//! Fields that lie together: a tree of balls, so that of many fields only those near eight rays, or
//! eight points, are asked.
//!
//! Fields come in such an order that neighbours in the list are neighbours in space. A ball about a
//! run of them holds all that they reach; each half of the run has a ball of its own. What surely
//! passes a ball by gets nothing from the fields in it.

use crate::packet::rays::SLACK;
use core::ops::Range;
use durer_math::{Aabb, U, Vec3};

/// A run of fields, and a ball that holds them.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) centre: Vec3,
    pub(super) radius: f64,
    /// The fields, if they are so few that the run is not divided.
    pub(super) fields: Range<usize>,
    /// The first group behind it that holds none of its fields.
    pub(super) next: usize,
}

/// So many fields are not divided.
const FEW: usize = 2;

/// The groups of fields that these boxes hold, each before its halves.
pub(super) fn groups(boxes: &[Aabb]) -> Box<[Group]> {
    let mut groups = Vec::new();
    add(boxes, 0..boxes.len(), &mut groups);
    groups.into()
}

fn add(boxes: &[Aabb], fields: Range<usize>, groups: &mut Vec<Group>) {
    let held = boxes[fields.clone()].iter().fold(Aabb::EMPTY, |sum, b| sum.union(*b));
    let centre = held.centre();
    let far = held.min.to_vec().max_abs().max(held.max.to_vec().max_abs());
    // Coordinates of corners have been rounded once.
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

//! Shared by the tests: random numbers, boxes, trees.

use durer_bvh::{Bvh, Frame, Settings};
use durer_math::Aabb;
use durer_testkit::TestRng;

/// Draws that only these tests need.
pub(crate) trait Draws {
    /// One of `-n..=n`.
    #[allow(dead_code, reason = "not every test needs it")]
    fn about(&mut self, n: i64) -> i64;
}

impl Draws for TestRng {
    fn about(&mut self, n: i64) -> i64 {
        self.below(2 * n as u64 + 1) as i64 - n
    }
}

/// The position of a scene: at the origin, or up to `2^bits` away on some axes.
#[allow(dead_code, reason = "not every test needs it")]
pub(crate) fn place(dice: &mut TestRng, bits: u64) -> [i64; 3] {
    if dice.below(2) == 0 {
        return [0; 3];
    }
    core::array::from_fn(|_| {
        let size = dice.below(bits);
        dice.about(1 << size)
    })
}

/// One setting for each quality.
#[allow(dead_code, reason = "not every test needs it")]
pub(crate) const QUALITIES: [Settings; 3] = [Settings::FAST, Settings::GOOD, Settings::BEST];

/// A tree over boxes of one kind, and the box in each slot.
#[allow(dead_code, reason = "not every test needs it")]
pub(crate) fn tree(boxes: &[Aabb]) -> (Bvh, Vec<u32>) {
    tree_of(boxes, &Settings::GOOD)
}

/// A tree over boxes of one kind with these settings, and the box in each slot.
#[allow(dead_code, reason = "not every test needs it")]
pub(crate) fn tree_of(boxes: &[Aabb], settings: &Settings) -> (Bvh, Vec<u32>) {
    let extent = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let frame = Frame::around(&extent);
    let entries = boxes.iter().enumerate().map(|(i, b)| frame.entry(b, 0, i as u32)).collect();
    let (tree, mut order) = Bvh::build(&frame, entries, &[None], settings);
    (tree, order.remove(0))
}

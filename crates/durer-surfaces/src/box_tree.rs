//! A tree of boxes, eight to a node, for surfaces of many pieces. A line meets the boxes in order.
//!
//! Boxes are enlarged by far more than the rounding of a line in units, as [`Along`] checks, so the
//! line certainly misses skipped boxes. Nodes are divided where the areas of the parts times the
//! numbers of their boxes have the least sum (J. Goldsmith, J. Salmon, "Automatic creation of
//! object hierarchies for ray tracing", *IEEE Computer Graphics and Applications* 7:5 (1987)
//! 14-20).

use crate::blob::{Along, MARGIN};
use durer_math::lanes::{LANES, set_bits};
use durer_math::{Aabb, F8, Vec3};

/// Larger groups of boxes are divided at the median along their longest side.
const SORTED: usize = 1 << 12;
/// In a child: the rest is the number of a box, not of a node.
const IS_BOX: u32 = 1 << 31;

/// Up to eight boxes side by side, and their contents.
#[derive(Clone, Debug, Default)]
struct Node {
    low: [F8; 3],
    high: [F8; 3],
    child: [u32; LANES],
    /// A bit for each lane that has a box.
    used: u8,
}

/// The tree; boxes are numbered in its own order.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    nodes: Vec<Node>,
}

/// Boxes and nodes that a line meets, each with the least parameter at which it may; the nearest last.
#[derive(Clone, Debug, Default)]
pub(crate) struct Open(Vec<(f64, u32)>);

impl Open {
    #[inline(always)]
    fn insert(&mut self, near: f64, child: u32) {
        let open = &mut self.0;
        open.push((near, child));
        let mut i = open.len() - 1;
        while i > 0 && open[i - 1].0 < near {
            open.swap(i, i - 1);
            i -= 1;
        }
    }
}

fn area(b: &Aabb) -> f64 {
    let d = b.max - b.min;
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Twice the middle of a box.
fn twice_middle(b: &Aabb) -> Vec3 {
    b.min.to_vec() + b.max.to_vec()
}

/// Orders boxes so that the first ones, as many as it returns, and the others are two groups. Two or
/// more boxes are needed.
fn divide(boxes: &[Aabb], which: &mut [u32]) -> usize {
    let key = |i: u32, axis: usize| twice_middle(&boxes[i as usize])[axis];
    let n = which.len();
    if n > SORTED {
        let first = twice_middle(&boxes[which[0] as usize]);
        let (mut low, mut high) = (first, first);
        for &i in which.iter() {
            for axis in 0..3 {
                (low[axis], high[axis]) = (low[axis].min(key(i, axis)), high[axis].max(key(i, axis)));
            }
        }
        let wide = high - low;
        let axis = (0..3).fold(0, |best, axis| if wide[axis] > wide[best] { axis } else { best });
        which.select_nth_unstable_by(n / 2, |&a, &b| key(a, axis).total_cmp(&key(b, axis)).then(a.cmp(&b)));
        return n / 2;
    }
    let sort = |which: &mut [u32], axis: usize| {
        which.sort_unstable_by(|&a, &b| key(a, axis).total_cmp(&key(b, axis)).then(a.cmp(&b)));
    };
    let (mut best, mut least, mut behind) = ((0, n / 2), f64::INFINITY, vec![0.0; n]);
    for axis in 0..3 {
        sort(which, axis);
        let mut all = Aabb::EMPTY;
        for k in (1..n).rev() {
            all = all.union(boxes[which[k] as usize]);
            behind[k] = area(&all);
        }
        let mut all = Aabb::EMPTY;
        for k in 1..n {
            all = all.union(boxes[which[k - 1] as usize]);
            let cost = area(&all) * k as f64 + behind[k] * (n - k) as f64;
            if cost < least {
                (best, least) = ((axis, k), cost);
            }
        }
    }
    sort(which, best.0);
    best.1
}

/// Boxes that become one lane of a node.
struct Group {
    range: (usize, usize),
    held: Aabb,
    /// In proportion to the lines that meet it, times its boxes; -1 for a single box.
    work: f64,
}

impl Group {
    fn of(boxes: &[Aabb], order: &[u32], range: (usize, usize)) -> Self {
        let (from, to) = range;
        let held = order[from..to].iter().fold(Aabb::EMPTY, |all, &i| all.union(boxes[i as usize]));
        let work = if to - from < 2 { -1.0 } else { area(&held) * (to - from) as f64 };
        Self { range, held, work }
    }
}

impl BoxTree {
    /// Builds the tree from boxes in units. Returns the tree and its order of the boxes.
    pub(crate) fn new(boxes: &[Aabb]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut tree = Self { nodes: vec![] };
        if boxes.is_empty() {
            return (tree, order);
        }
        tree.nodes.push(Node::default());
        let mut open = vec![(0_usize, 0_usize, boxes.len())];
        while let Some((node, from, to)) = open.pop() {
            let mut groups = vec![Group::of(boxes, &order, (from, to))];
            while groups.len() < LANES {
                let most = (0..groups.len())
                    .fold(0, |most, k| if groups[k].work > groups[most].work { k } else { most });
                let (a, b) = groups[most].range;
                if b - a < 2 {
                    break;
                }
                let middle = a + divide(boxes, &mut order[a..b]);
                groups[most] = Group::of(boxes, &order, (a, middle));
                groups.push(Group::of(boxes, &order, (middle, b)));
            }
            for (lane, Group { range: (a, b), held, .. }) in groups.into_iter().enumerate() {
                let mut child = a as u32 | IS_BOX;
                if b - a > 1 {
                    child = tree.nodes.len() as u32;
                    tree.nodes.push(Node::default());
                    open.push((child as usize, a, b));
                }
                tree.nodes[node].set(lane, &held, child);
            }
        }
        (tree, order)
    }

    /// Begins at the start of the tree.
    #[inline(always)]
    pub(crate) fn begin(&self, open: &mut Open) {
        open.0.clear();
        if !self.nodes.is_empty() {
            open.0.push((f64::NEG_INFINITY, 0));
        }
    }

    /// The next box that the line meets, with the least parameter at which it may; `None` if no more
    /// are in the window. Parameters ascend.
    #[inline(always)]
    pub(crate) fn next(&self, line: &Along, window: [f64; 2], open: &mut Open) -> Option<(f64, usize)> {
        while let Some((near, child)) = open.0.pop() {
            if near > window[1] {
                return None;
            }
            if child & IS_BOX != 0 {
                return Some((near, (child & !IS_BOX) as usize));
            }
            let node = &self.nodes[child as usize];
            let (near, far) = node.entry(line);
            let met = near.le(far) & near.le(F8::splat(window[1])) & far.ge(F8::splat(window[0]));
            for lane in set_bits(met.bits() & node.used) {
                open.insert(near.0[lane], node.child[lane]);
            }
        }
        None
    }
}

impl Node {
    fn set(&mut self, lane: usize, held: &Aabb, child: u32) {
        for axis in 0..3 {
            self.low[axis].0[lane] = held.min[axis] - MARGIN;
            self.high[axis].0[lane] = held.max[axis] + MARGIN;
        }
        self.child[lane] = child;
        self.used |= 1 << lane;
    }

    /// Where a line enters and leaves the boxes, in its parameter.
    #[inline(always)]
    fn entry(&self, line: &Along) -> (F8, F8) {
        let (mut near, mut far) = (F8::splat(f64::NEG_INFINITY), F8::splat(f64::INFINITY));
        if !line.known {
            return (near, far);
        }
        for axis in 0..3 {
            let (o, by) = (F8::splat(line.o[axis]), F8::splat(line.inverse[axis]));
            // A direction without this axis gives infinity, or NaN, which is no bound.
            let (a, b) = ((self.low[axis] - o) * by, (self.high[axis] - o) * by);
            near = a.min(b).max(near);
            far = a.max(b).min(far);
        }
        (near, far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LocalRay;
    use crate::laws::{dice, drawn};
    use durer_math::{Point3, Ray};

    /// Whether a line meets a box that is enlarged by half the margin.
    fn meets(held: &Aabb, line: &Along) -> bool {
        let held = held.expanded(Vec3::new(1.0, 1.0, 1.0) * (0.5 * MARGIN));
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (low, high) = (held.min[axis] - line.o[axis], held.max[axis] - line.o[axis]);
            if line.d[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low / line.d[axis], high / line.d[axis]);
            (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
        }
        near <= far
    }

    /// All boxes that a line meets come, each once, in the order of their entries.
    #[test]
    fn no_box_that_a_line_meets_is_left_out() {
        for case in drawn(400) {
            let mut dice = dice(57, case);
            let count = dice.pick(&[1, 2, 7, 8, 9, 30, 200]);
            let boxes: Vec<Aabb> = (0..count)
                .map(|_| {
                    let p = (dice.vector() * 0.5).to_point();
                    let size = dice.vector().abs() * dice.pick(&[0.0, 1e-3, 0.2]);
                    Aabb::new(p, p + size)
                })
                .collect();
            let (tree, order) = BoxTree::new(&boxes);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count as u32).collect::<Vec<_>>());
            // Through a corner of one of the boxes, perhaps in a coordinate plane.
            let mut direction = dice.vector();
            direction.x *= dice.pick(&[0.0, 1.0]);
            let corner = boxes[dice.pick(&[0, count - 1])].max;
            let ray = Ray::new(corner - direction, direction);
            let at = LocalRay::new(&ray);
            let at = at.recentre(Point3::ORIGIN, 0).sharp(1.0);
            let line = Along::new(&at);
            let (mut open, mut last) = (Open::default(), f64::NEG_INFINITY);
            tree.begin(&mut open);
            let mut seen = vec![false; count];
            while let Some((near, k)) = tree.next(&line, [f64::NEG_INFINITY, f64::INFINITY], &mut open) {
                assert!(near >= last && !seen[order[k] as usize], "{case}");
                (last, seen[order[k] as usize]) = (near, true);
            }
            for (held, seen) in boxes.iter().zip(seen) {
                assert!(seen || !meets(held, &line), "{case}: {held:?}");
            }
        }
    }
}

//! Boolean trees over leaves, and their value as leaves come and go.
//!
//! A tree is kept in one normal form: unions and intersections take turns, and complements stand at
//! the leaves only (De Morgan's laws; a difference `A - B` is the intersection of `A` and the
//! complement of `B`). Each node counts its children that hold. So a leaf that changes costs as
//! much as it is deep, however many others there are, and a tree without unions in intersections in
//! unions ... is flat.

use durer_math::Aabb;

/// A set under construction, in terms of leaves.
#[derive(Debug)]
pub(crate) enum Expr {
    Leaf(u32),
    All(Vec<u32>),
    Any(Vec<u32>),
    Not(u32),
}

/// A union or an intersection.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// The node around it, one of a lower number; none for the first.
    parent: u32,
    /// An intersection: all children must hold.
    all: bool,
    children: u32,
    /// How many children hold where no leaf does.
    outside: u32,
}

impl Node {
    fn holds(&self, count: u32) -> bool {
        if self.all { count == self.children } else { count > 0 }
    }
}

/// Where a leaf stands in the tree.
#[derive(Clone, Copy, Debug)]
struct TreePosition {
    node: u32,
    inverted: bool,
}

/// A Boolean tree. Node 0 is its root.
#[derive(Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    /// By leaf.
    places: Vec<TreePosition>,
}

/// What a node is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    Leaf(u32),
    Node(u32),
}

const NONE: u32 = u32::MAX;

impl Tree {
    /// The tree of the expression `root`; each expression stands in one place at most.
    pub(crate) fn new(exprs: &[Expr], root: u32, leaves: usize) -> Self {
        let first = Node { parent: NONE, all: false, children: 0, outside: 0 };
        let mut tree =
            Self { nodes: vec![first], places: vec![TreePosition { node: NONE, inverted: false }; leaves] };
        let mut is_first = true;
        let mut waiting = vec![(root, false, 0_u32)];
        while let Some((expr, inverted, parent)) = waiting.pop() {
            let (all, parts) = match &exprs[expr as usize] {
                Expr::Leaf(leaf) => {
                    tree.places[*leaf as usize] = TreePosition { node: parent, inverted };
                    tree.nodes[parent as usize].children += 1;
                    continue;
                }
                Expr::Not(part) => {
                    waiting.push((*part, !inverted, parent));
                    continue;
                }
                Expr::All(parts) => (!inverted, parts),
                Expr::Any(parts) => (inverted, parts),
            };
            let node = if is_first {
                tree.nodes[0].all = all;
                0
            } else if parts.len() == 1 || tree.nodes[parent as usize].all == all {
                parent
            } else {
                tree.nodes[parent as usize].children += 1;
                tree.nodes.push(Node { parent, all, children: 0, outside: 0 });
                (tree.nodes.len() - 1) as u32
            };
            is_first = false;
            waiting.extend(parts.iter().map(|&part| (part, inverted, node)));
        }
        for place in tree.places.iter().filter(|p| p.inverted && p.node != NONE) {
            tree.nodes[place.node as usize].outside += 1;
        }
        for i in (1..tree.nodes.len()).rev() {
            let node = tree.nodes[i];
            tree.nodes[node.parent as usize].outside += u32::from(node.holds(node.outside));
        }
        tree
    }

    /// How many nodes there are.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the leaf counts where it is not.
    pub(crate) fn is_inverted(&self, leaf: u32) -> bool {
        self.places[leaf as usize].inverted
    }

    /// Where each leaf stands: its node, and whether it is inverted there.
    pub(crate) fn places(&self) -> impl Iterator<Item = Option<(u32, bool)>> {
        self.places.iter().map(|p| (p.node != NONE).then_some((p.node, p.inverted)))
    }

    /// Each node's parent, whether it is an intersection, and its children.
    pub(crate) fn lists(&self) -> impl Iterator<Item = (Option<u32>, bool, Vec<Child>)> {
        let mut children = vec![Vec::new(); self.nodes.len()];
        let leaves = self.places.iter().map(|p| p.node).zip((0..).map(Child::Leaf));
        let nodes = self.nodes.iter().map(|n| n.parent).zip((0..).map(Child::Node));
        for (parent, child) in leaves.chain(nodes).filter(|(parent, _)| *parent != NONE) {
            children[parent as usize].push(child);
        }
        let parent = |n: &Node| (n.parent != NONE).then_some(n.parent);
        self.nodes.iter().zip(children).map(move |(n, children)| (parent(n), n.all, children))
    }

    /// A box that holds the set, given boxes that hold the leaves.
    pub(crate) fn bounds(&self, leaves: &[Aabb]) -> Aabb {
        self.boxes(leaves)[0]
    }

    /// For each leaf, a box outside of which it does not matter whether it holds: there it does
    /// not, or a node above it does not.
    ///
    /// These are S-bounds (S. Cameron, "Efficient intersection tests for objects defined
    /// constructively", International Journal of Robotics Research 8(1), 1989): boxes of nodes are
    /// made from below, and cut by those of the nodes above from above.
    pub(crate) fn where_leaves_matter(&self, leaves: &[Aabb]) -> Vec<Aabb> {
        let mut within = self.boxes(leaves);
        for i in 1..within.len() {
            within[i] = cut(within[i], within[self.nodes[i].parent as usize]);
        }
        let matters = |(place, bounds): (&TreePosition, &Aabb)| match within.get(place.node as usize) {
            Some(node) => cut(*bounds, *node),
            None => Aabb::EMPTY,
        };
        self.places.iter().zip(leaves).map(matters).collect()
    }

    /// Boxes that hold the nodes.
    fn boxes(&self, leaves: &[Aabb]) -> Vec<Aabb> {
        let start = |n: &Node| if n.all { Aabb::UNBOUNDED } else { Aabb::EMPTY };
        let mut boxes: Vec<Aabb> = self.nodes.iter().map(start).collect();
        let add = |boxes: &mut Vec<Aabb>, node: u32, part: Aabb| {
            let b = &mut boxes[node as usize];
            *b = if self.nodes[node as usize].all { cut(*b, part) } else { b.union(part) };
        };
        for (place, bounds) in self.places.iter().zip(leaves) {
            if place.node != NONE {
                add(&mut boxes, place.node, if place.inverted { Aabb::UNBOUNDED } else { *bounds });
            }
        }
        for i in (1..boxes.len()).rev() {
            let part = boxes[i];
            add(&mut boxes, self.nodes[i].parent, part);
        }
        boxes
    }
}

/// What two boxes have in common: what is empty on one axis is empty.
fn cut(a: Aabb, b: Aabb) -> Aabb {
    let both = a.intersection(b);
    if both.is_empty() { Aabb::EMPTY } else { both }
}

/// What a node counts at the moment.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    /// Older counts are forgotten.
    epoch: u64,
    /// The step in which it changed last.
    step: u64,
    /// Whether the node held before that step.
    held: bool,
    count: u32,
}

/// Whether a leaf holds at the moment.
#[derive(Clone, Copy, Debug, Default)]
struct Bit {
    epoch: u64,
    holds: bool,
}

/// The states of a tree's leaves and nodes, to be used again for any tree: nothing is cleared.
#[derive(Debug, Default)]
pub(crate) struct Values {
    epoch: u64,
    step: u64,
    counts: Vec<Count>,
    bits: Vec<Bit>,
}

impl Values {
    /// Forgets everything: no leaf holds.
    pub(crate) fn begin(&mut self, tree: &Tree) {
        self.epoch += 1;
        self.step += 1;
        if self.counts.len() < tree.nodes.len() {
            self.counts.resize(tree.nodes.len(), Count::default());
        }
        if self.bits.len() < tree.places.len() {
            self.bits.resize(tree.places.len(), Bit::default());
        }
    }

    /// Begins a step: what changes from now on is told apart from what changed before.
    pub(crate) fn next_step(&mut self) -> u64 {
        self.step += 1;
        self.step
    }

    fn count(&mut self, tree: &Tree, node: u32) -> &mut Count {
        let count = &mut self.counts[node as usize];
        if count.epoch != self.epoch {
            *count =
                Count { epoch: self.epoch, step: 0, held: false, count: tree.nodes[node as usize].outside };
        }
        count
    }

    /// Whether a node holds.
    fn node(&self, tree: &Tree, node: u32) -> bool {
        let (count, node) = (&self.counts[node as usize], &tree.nodes[node as usize]);
        node.holds(if count.epoch == self.epoch { count.count } else { node.outside })
    }

    /// Whether the whole tree holds.
    pub(crate) fn holds(&self, tree: &Tree) -> bool {
        self.node(tree, 0)
    }

    /// Whether a leaf holds (its complement's is not asked for).
    pub(crate) fn leaf(&self, leaf: u32) -> bool {
        let bit = &self.bits[leaf as usize];
        bit.epoch == self.epoch && bit.holds
    }

    /// Lets a leaf hold, or not.
    pub(crate) fn set(&mut self, tree: &Tree, leaf: u32, holds: bool) {
        if self.leaf(leaf) == holds {
            return;
        }
        self.bits[leaf as usize] = Bit { epoch: self.epoch, holds };
        let TreePosition { mut node, inverted } = tree.places[leaf as usize];
        let mut more = holds != inverted;
        let step = self.step;
        while node != NONE {
            let its = &tree.nodes[node as usize];
            let state = self.count(tree, node);
            let before = its.holds(state.count);
            if state.step != step {
                (state.step, state.held) = (step, before);
            }
            state.count = if more { state.count + 1 } else { state.count - 1 };
            let after = its.holds(state.count);
            if after == before {
                break;
            }
            (more, node) = (after, its.parent);
        }
    }

    /// Whether the root would change if a leaf did: no node above the leaf is decided by its other
    /// children.
    pub(crate) fn matters(&self, tree: &Tree, leaf: u32) -> bool {
        let TreePosition { mut node, inverted } = tree.places[leaf as usize];
        let mut holds = self.leaf(leaf) != inverted;
        while node != NONE {
            let (state, its) = (&self.counts[node as usize], &tree.nodes[node as usize]);
            let count = if state.epoch == self.epoch { state.count } else { its.outside };
            let others = count - u32::from(holds);
            if others != if its.all { its.children - 1 } else { 0 } {
                return false;
            }
            (holds, node) = (its.holds(count), its.parent);
        }
        true
    }

    /// Whether everything from a leaf up to the root has changed in this step, so that the leaf is
    /// a reason for the root's change.
    pub(crate) fn explains(&self, tree: &Tree, leaf: u32) -> bool {
        let mut node = tree.places[leaf as usize].node;
        while node != NONE {
            let state = &self.counts[node as usize];
            if state.epoch != self.epoch || state.step != self.step || state.held == self.node(tree, node) {
                return false;
            }
            node = tree.nodes[node as usize].parent;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evaluates the expression itself.
    fn direct(exprs: &[Expr], at: u32, bits: &[bool]) -> bool {
        match &exprs[at as usize] {
            Expr::Leaf(leaf) => bits[*leaf as usize],
            Expr::Not(part) => !direct(exprs, *part, bits),
            Expr::All(parts) => parts.iter().all(|&p| direct(exprs, p, bits)),
            Expr::Any(parts) => parts.iter().any(|&p| direct(exprs, p, bits)),
        }
    }

    /// A random expression of `leaves` leaves.
    fn random(leaves: u32, mut dice: impl FnMut(u32) -> u32) -> (Vec<Expr>, u32) {
        let mut exprs: Vec<Expr> = (0..leaves).map(Expr::Leaf).collect();
        let mut free: Vec<u32> = (0..leaves).collect();
        while free.len() > 1 || dice(3) == 0 {
            let count = (1 + dice(4) as usize).min(free.len());
            let mut parts = Vec::new();
            for _ in 0..count {
                parts.push(free.swap_remove(dice(free.len() as u32) as usize));
            }
            exprs.push(match dice(3) {
                0 => Expr::All(parts),
                1 => Expr::Any(parts),
                _ => {
                    free.extend(parts.split_off(1));
                    Expr::Not(parts[0])
                }
            });
            free.push(exprs.len() as u32 - 1);
        }
        (exprs, free[0])
    }

    #[test]
    fn the_counted_value_is_the_expressions() {
        let mut state = 1_u64;
        let mut dice = move |n: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % u64::from(n.max(1))) as u32
        };
        let mut values = Values::default();
        for _ in 0..500 {
            let leaves = 1 + dice(9);
            let (exprs, root) = random(leaves, &mut dice);
            let tree = Tree::new(&exprs, root, leaves as usize);
            values.begin(&tree);
            let mut bits = vec![false; leaves as usize];
            assert_eq!(values.holds(&tree), direct(&exprs, root, &bits));
            for _ in 0..40 {
                values.next_step();
                let before = bits.clone();
                for leaf in 0..leaves {
                    let mut other = bits.clone();
                    other[leaf as usize] ^= true;
                    let would = direct(&exprs, root, &other) != direct(&exprs, root, &bits);
                    assert_eq!(values.matters(&tree, leaf), would, "{exprs:?} {bits:?} {leaf}");
                }
                for _ in 0..=dice(3) {
                    let leaf = dice(leaves);
                    bits[leaf as usize] ^= true;
                    values.set(&tree, leaf, bits[leaf as usize]);
                }
                let (was, is) = (direct(&exprs, root, &before), direct(&exprs, root, &bits));
                assert_eq!(values.holds(&tree), is);
                // If the tree has changed some leaf that has changed is a reason for it.
                let changed = |l: &u32| before[*l as usize] != bits[*l as usize];
                let reasons: Vec<u32> =
                    (0..leaves).filter(changed).filter(|&l| values.explains(&tree, l)).collect();
                assert_eq!(was != is, !reasons.is_empty(), "{exprs:?} {before:?} {bits:?}");
            }
        }
    }

    #[test]
    fn boxes_of_differences_are_those_of_what_is_left() {
        let cube =
            |a: f64, b: f64| Aabb::new(durer_math::Point3::new(a, a, a), durer_math::Point3::new(b, b, b));
        // (0 - 1) | (2 & 3)
        let exprs = vec![
            Expr::Leaf(0),
            Expr::Leaf(1),
            Expr::Leaf(2),
            Expr::Leaf(3),
            Expr::Not(1),
            Expr::All(vec![0, 4]),
            Expr::All(vec![2, 3]),
            Expr::Any(vec![5, 6]),
        ];
        let tree = Tree::new(&exprs, 7, 4);
        let boxes = [cube(0.0, 1.0), cube(0.5, 9.0), cube(3.0, 5.0), Aabb::UNBOUNDED];
        assert_eq!(tree.bounds(&boxes), cube(0.0, 5.0));
        let disjoint = [cube(0.0, 1.0), Aabb::EMPTY, cube(3.0, 5.0), cube(6.0, 7.0)];
        assert_eq!(tree.bounds(&disjoint), cube(0.0, 1.0));
        // What is taken away matters where there is something to take it from.
        let matters = tree.where_leaves_matter(&boxes);
        assert_eq!(matters, [cube(0.0, 1.0), cube(0.5, 1.0), cube(3.0, 5.0), cube(3.0, 5.0)]);
        let apart = [cube(0.0, 1.0), cube(2.0, 3.0), cube(3.0, 5.0), cube(6.0, 7.0)];
        let [a, b, c, d] = tree.where_leaves_matter(&apart)[..] else { panic!("four leaves") };
        assert!(a == cube(0.0, 1.0) && [b, c, d].iter().all(Aabb::is_empty));
    }
}

//! Boolean trees over leaves, and their value as leaves change.
//!
//! A tree is in one normal form: unions and intersections alternate, and complements are at the
//! leaves only (De Morgan's laws; a difference `A - B` is the intersection of `A` and the
//! complement of `B`). Each node counts its children that hold. So the cost of a change of a leaf
//! is its depth, however many others there are, and a tree without unions in intersections in
//! unions ... is flat.

use durer_math::Aabb;
use durer_surfaces::{HalfSpace, QuadricExtent};

/// An expression under construction.
#[derive(Debug)]
pub(crate) enum Expr {
    Leaf(u32),
    All(Vec<u32>),
    /// A union without inner faces.
    Any(Vec<u32>),
    /// A union whose parts keep the faces that lie in other parts.
    AnyWithInner(Vec<u32>),
    Not(u32),
}

/// How a node combines its children.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    /// An intersection: all children must hold.
    All,
    /// A union: a child's face is visible where no other child holds.
    Any,
    /// A union: a child's face is visible wherever it lies.
    AnyWithInner,
}

/// A union or an intersection.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// The parent, which has a lower number; none for the root.
    parent: u32,
    rule: Rule,
    children: u32,
    /// How many children hold when no leaf does.
    outside: u32,
}

impl Node {
    fn holds(&self, count: u32) -> bool {
        if self.rule == Rule::All { count == self.children } else { count > 0 }
    }
}

/// Where a leaf lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// A box around it.
    pub(crate) bounds: Aabb,
    /// A box that it holds.
    pub(crate) inner: Aabb,
    /// The leaf itself, if it is a half-space.
    pub(crate) half_space: Option<HalfSpace>,
    /// The leaf itself, if it is an unbounded quadric.
    pub(crate) quadric: Option<QuadricExtent>,
}

/// The position of a leaf in the tree.
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
    /// Whether a union keeps its inner faces.
    has_inner_faces: bool,
}

/// A child of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    Leaf(u32),
    Node(u32),
}

const NONE: u32 = u32::MAX;

impl Tree {
    /// The tree of the expression `root`; each expression occurs at most once.
    pub(crate) fn new(exprs: &[Expr], root: u32, leaves: usize) -> Self {
        let first = Node { parent: NONE, rule: Rule::Any, children: 0, outside: 0 };
        let places = vec![TreePosition { node: NONE, inverted: false }; leaves];
        let mut tree = Self { nodes: vec![first], places, has_inner_faces: false };
        let mut is_first = true;
        let mut waiting = vec![(root, false, 0_u32)];
        while let Some((expr, inverted, parent)) = waiting.pop() {
            let (rule, parts) = match &exprs[expr as usize] {
                Expr::Leaf(leaf) => {
                    tree.places[*leaf as usize] = TreePosition { node: parent, inverted };
                    tree.nodes[parent as usize].children += 1;
                    continue;
                }
                Expr::Not(part) => {
                    waiting.push((*part, !inverted, parent));
                    continue;
                }
                Expr::All(parts) => (if inverted { Rule::Any } else { Rule::All }, parts),
                Expr::Any(parts) => (if inverted { Rule::All } else { Rule::Any }, parts),
                Expr::AnyWithInner(parts) => (if inverted { Rule::All } else { Rule::AnyWithInner }, parts),
            };
            let node = if is_first {
                tree.nodes[0].rule = rule;
                0
            } else if parts.len() == 1 || tree.nodes[parent as usize].rule == rule {
                parent
            } else {
                tree.nodes[parent as usize].children += 1;
                tree.nodes.push(Node { parent, rule, children: 0, outside: 0 });
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
        tree.has_inner_faces = tree.nodes.iter().any(|n| n.rule == Rule::AnyWithInner);
        tree
    }

    /// How many nodes there are.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Whether a union keeps its inner faces.
    pub(crate) fn has_inner_faces(&self) -> bool {
        self.has_inner_faces
    }

    /// Whether the complement of the leaf is in the tree.
    pub(crate) fn is_inverted(&self, leaf: u32) -> bool {
        self.places[leaf as usize].inverted
    }

    /// The position of each leaf: its node, and whether it is inverted there.
    pub(crate) fn places(&self) -> impl Iterator<Item = Option<(u32, bool)>> {
        self.places.iter().map(|p| (p.node != NONE).then_some((p.node, p.inverted)))
    }

    /// Each node's parent, its rule, and its children.
    pub(crate) fn lists(&self) -> impl Iterator<Item = (Option<u32>, Rule, Vec<Child>)> {
        let mut children = vec![Vec::new(); self.nodes.len()];
        let leaves = self.places.iter().map(|p| p.node).zip((0..).map(Child::Leaf));
        let nodes = self.nodes.iter().map(|n| n.parent).zip((0..).map(Child::Node));
        for (parent, child) in leaves.chain(nodes).filter(|(parent, _)| *parent != NONE) {
            children[parent as usize].push(child);
        }
        let parent = |n: &Node| (n.parent != NONE).then_some(n.parent);
        self.nodes.iter().zip(children).map(move |(n, children)| (parent(n), n.rule, children))
    }

    /// A box around the set.
    pub(crate) fn bounds(&self, leaves: &[Extent]) -> Aabb {
        self.boxes(leaves, true)[0]
    }

    /// For each leaf, a box outside of which its value does not matter: there the leaf does not
    /// hold, or an ancestor does not.
    ///
    /// These are S-bounds (S. Cameron, "Efficient intersection tests for objects defined
    /// constructively", International Journal of Robotics Research 8(1), 1989): boxes of nodes are
    /// computed bottom-up, and then clipped by those of their ancestors top-down.
    ///
    /// A ray that misses the box of a leaf may skip it, and then assumes that the leaf does not
    /// hold. So only children that are not complements may shrink the box of an intersection:
    /// outside of the box one of them does not hold, whether it is skipped or not, but a skipped
    /// complement would hold.
    pub(crate) fn where_leaves_matter(&self, leaves: &[Extent]) -> Vec<Aabb> {
        let mut within = self.boxes(leaves, false);
        for i in 1..within.len() {
            within[i] = cut(within[i], within[self.nodes[i].parent as usize]);
        }
        let matters = |(place, leaf): (&TreePosition, &Extent)| match within.get(place.node as usize) {
            Some(node) => cut(leaf.bounds, *node),
            None => Aabb::EMPTY,
        };
        self.places.iter().zip(leaves).map(matters).collect()
    }

    /// Boxes around the nodes, the root first; `with_complements` makes them smaller.
    fn boxes(&self, leaves: &[Extent], with_complements: bool) -> Vec<Aabb> {
        let start = |n: &Node| if n.rule == Rule::All { Aabb::UNBOUNDED } else { Aabb::EMPTY };
        let mut boxes: Vec<Aabb> = self.nodes.iter().map(start).collect();
        let add = |boxes: &mut Vec<Aabb>, node: u32, part: Aabb| {
            let b = &mut boxes[node as usize];
            let is_intersection = self.nodes[node as usize].rule == Rule::All;
            *b = if is_intersection { cut(*b, part) } else { b.union(part) };
        };
        // For each intersection: boxes inside the leaves that it subtracts, its half-spaces, and its
        // unbounded quadrics.
        let mut taken_away = vec![Vec::new(); self.nodes.len()];
        let mut faces = vec![Vec::new(); self.nodes.len()];
        let mut quadrics = vec![Vec::new(); self.nodes.len()];
        for (place, leaf) in self.places.iter().zip(leaves).filter(|(place, _)| place.node != NONE) {
            let node = place.node as usize;
            add(&mut boxes, place.node, if place.inverted { Aabb::UNBOUNDED } else { leaf.bounds });
            if self.nodes[node].rule != Rule::All {
                continue;
            }
            match (place.inverted, leaf.half_space) {
                (false, Some(half_space)) => faces[node].push(half_space),
                (true, Some(half_space)) if with_complements => faces[node].push(half_space.complement()),
                (false, None) => quadrics[node].extend(leaf.quadric),
                (true, _) if with_complements && !leaf.inner.is_empty() => taken_away[node].push(leaf.inner),
                _ => {}
            }
        }
        for i in (0..boxes.len()).rev() {
            if !faces[i].is_empty() {
                boxes[i] = cut(boxes[i], HalfSpace::common_bounds(&faces[i]));
            }
            for quadric in &quadrics[i] {
                let slab = faces[i].iter().fold(boxes[i], |slab, face: &HalfSpace| cut(slab, face.bounds()));
                let within = quadric.bounds_within(&slab);
                if within.is_bounded() {
                    boxes[i] = cut(boxes[i], within);
                }
            }
            boxes[i] = without(boxes[i], &taken_away[i]);
            if i > 0 {
                let part = boxes[i];
                add(&mut boxes, self.nodes[i].parent, part);
            }
        }
        boxes
    }
}

/// A box around the part of `whole` outside the boxes `parts`.
fn without(mut whole: Aabb, parts: &[Aabb]) -> Aabb {
    let mut has_changed = true;
    while has_changed && !whole.is_empty() {
        has_changed = false;
        for part in parts {
            for axis in 0..3 {
                let spans = |other: usize| {
                    other == axis
                        || part.min[other] <= whole.min[other] && whole.max[other] <= part.max[other]
                };
                if !(0..3).all(spans) {
                    continue;
                }
                let (min, max) = (part.min[axis], part.max[axis]);
                if min <= whole.min[axis] && max > whole.min[axis] {
                    (whole.min[axis], has_changed) = (max, true);
                } else if max >= whole.max[axis] && min < whole.max[axis] {
                    (whole.max[axis], has_changed) = (min, true);
                }
            }
        }
    }
    if whole.is_empty() { Aabb::EMPTY } else { whole }
}

/// The intersection of two boxes; if it is empty on one axis it is empty.
fn cut(a: Aabb, b: Aabb) -> Aabb {
    let both = a.intersection(b);
    if both.is_empty() { Aabb::EMPTY } else { both }
}

/// The current count of a node.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    /// Counts of older epochs are void.
    epoch: u64,
    /// The step in which it changed last.
    step: u64,
    /// Whether the node held before that step.
    held: bool,
    count: u32,
}

/// The current value of a leaf.
#[derive(Clone, Copy, Debug, Default)]
struct Bit {
    epoch: u64,
    holds: bool,
}

/// The values of a tree's leaves and nodes, reusable for any tree without clearing.
#[derive(Debug, Default)]
pub(crate) struct Values {
    epoch: u64,
    step: u64,
    counts: Vec<Count>,
    bits: Vec<Bit>,
}

impl Values {
    /// Resets all values: no leaf holds.
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

    /// Starts a step: later changes are distinguished from earlier ones.
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

    /// Whether a leaf holds (not its complement).
    pub(crate) fn leaf(&self, leaf: u32) -> bool {
        let bit = &self.bits[leaf as usize];
        bit.epoch == self.epoch && bit.holds
    }

    /// Sets whether a leaf holds.
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

    /// Whether the root would change if a leaf did: no ancestor of the leaf is decided by its other
    /// children.
    pub(crate) fn matters(&self, tree: &Tree, leaf: u32) -> bool {
        self.path_is_free(tree, leaf, false)
    }

    /// Whether the faces of a leaf are visible here: on the path to the root, all other children
    /// of an intersection hold, and no other child of a union without inner faces does.
    pub(crate) fn is_visible(&self, tree: &Tree, leaf: u32) -> bool {
        self.path_is_free(tree, leaf, true)
    }

    /// Whether no ancestor of a leaf is decided by its other children. With `through_inner_faces`,
    /// unions that keep their inner faces are ignored.
    fn path_is_free(&self, tree: &Tree, leaf: u32, through_inner_faces: bool) -> bool {
        let TreePosition { mut node, inverted } = tree.places[leaf as usize];
        let mut holds = self.leaf(leaf) != inverted;
        while node != NONE {
            let (state, its) = (&self.counts[node as usize], &tree.nodes[node as usize]);
            let count = if state.epoch == self.epoch { state.count } else { its.outside };
            let others = count - u32::from(holds);
            let is_free = match its.rule {
                Rule::All => others == its.children - 1,
                Rule::AnyWithInner if through_inner_faces => true,
                Rule::Any | Rule::AnyWithInner => others == 0,
            };
            if !is_free {
                return false;
            }
            (holds, node) = (its.holds(count), its.parent);
        }
        true
    }

    /// Whether everything from a leaf up to the root has changed in this step, so that the leaf is
    /// a cause of the root's change.
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
            Expr::Any(parts) | Expr::AnyWithInner(parts) => parts.iter().any(|&p| direct(exprs, p, bits)),
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
            exprs.push(match dice(4) {
                0 => Expr::All(parts),
                1 => Expr::Any(parts),
                2 => Expr::AnyWithInner(parts),
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
        let mut rng = durer_testkit::TestRng::new(1);
        let mut dice = move |n: u32| rng.below(u64::from(n.max(1))) as u32;
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
                // If the tree has changed, some leaf that has changed is a cause of it.
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
        let boxes = [cube(0.0, 1.0), cube(0.5, 9.0), cube(3.0, 5.0), Aabb::UNBOUNDED].map(round);
        assert_eq!(tree.bounds(&boxes), cube(0.0, 5.0));
        let disjoint = [cube(0.0, 1.0), Aabb::EMPTY, cube(3.0, 5.0), cube(6.0, 7.0)].map(round);
        assert_eq!(tree.bounds(&disjoint), cube(0.0, 1.0));
        // A subtracted leaf matters only where there is something to subtract it from.
        let matters = tree.where_leaves_matter(&boxes);
        assert_eq!(matters, [cube(0.0, 1.0), cube(0.5, 1.0), cube(3.0, 5.0), cube(3.0, 5.0)]);
        let apart = [cube(0.0, 1.0), cube(2.0, 3.0), cube(3.0, 5.0), cube(6.0, 7.0)].map(round);
        let [a, b, c, d] = tree.where_leaves_matter(&apart)[..] else { panic!("four leaves") };
        assert!(a == cube(0.0, 1.0) && [b, c, d].iter().all(Aabb::is_empty));
    }

    /// The extent of a leaf of which no more than its bounds are known.
    fn round(bounds: Aabb) -> Extent {
        Extent { bounds, inner: Aabb::EMPTY, half_space: None, quadric: None }
    }

    #[test]
    fn boxes_taken_away_make_the_bounds_smaller() {
        let block = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
            let p = durer_math::Point3::new;
            Aabb::new(p(x[0], y[0], z[0]), p(x[1], y[1], z[1]))
        };
        let solid = |inner: Aabb| Extent { bounds: inner, inner, half_space: None, quadric: None };
        let exprs = vec![
            Expr::Leaf(0),
            Expr::Leaf(1),
            Expr::Leaf(2),
            Expr::Not(1),
            Expr::Not(2),
            Expr::All(vec![0, 3, 4]),
        ];
        let tree = Tree::new(&exprs, 5, 3);
        let whole = round(block([-1.0, 1.0], [-1.0, 1.0], [-0.2, 0.2]));
        // The second box covers the rest only after the first one is taken away.
        let left = solid(block([-2.0, 0.0], [-2.0, 2.0], [-1.0, 1.0]));
        let below = solid(block([0.0, 2.0], [-2.0, 0.25], [-1.0, 1.0]));
        let rest = block([0.0, 1.0], [0.25, 1.0], [-0.2, 0.2]);
        assert_eq!(tree.bounds(&[whole, left, below]), rest);
        assert_eq!(tree.bounds(&[whole, below, left]), rest);
        // Where the boxes matter does not change.
        assert_eq!(tree.where_leaves_matter(&[whole, left, below])[0], whole.bounds);
        // A hole in the middle, and a box that covers one axis only.
        let hole = solid(block([-0.5, 0.5], [-2.0, 2.0], [-1.0, 1.0]));
        let thin = solid(block([-2.0, 0.0], [-2.0, 2.0], [-0.1, 1.0]));
        assert_eq!(tree.bounds(&[whole, hole, thin]), whole.bounds);
        // Nothing is left.
        assert!(tree.bounds(&[whole, solid(whole.bounds), hole]).is_empty());
    }

    #[test]
    fn half_spaces_bound_an_intersection() {
        let plane =
            |x: f64, y: f64, z: f64| durer_surfaces::Plane::new(durer_math::Vec3::new(x, y, z), 1.0).unwrap();
        let six = [
            plane(1.0, 0.0, 0.0),
            plane(-1.0, 0.0, 0.0),
            plane(0.0, 1.0, 0.0),
            plane(0.0, -1.0, 0.0),
            plane(0.0, 0.0, 1.0),
            plane(0.0, 0.0, -1.0),
        ];
        let half_spaces = six.map(|p| Extent {
            bounds: Aabb::UNBOUNDED,
            inner: durer_surfaces::Accelerate::inner_bounds(&p),
            half_space: durer_surfaces::Accelerate::half_space(&p),
            quadric: None,
        });
        let mut exprs: Vec<Expr> = (0..6).map(Expr::Leaf).collect();
        exprs.push(Expr::All((0..6).collect()));
        let tree = Tree::new(&exprs, 6, 6);
        let bounds = tree.bounds(&half_spaces);
        assert!(bounds.is_bounded() && bounds.magnitude() < 1.0 + 1e-14, "{bounds:?}");
        assert_eq!(tree.where_leaves_matter(&half_spaces), [bounds; 6]);
        // A union of half-spaces is unbounded.
        exprs[6] = Expr::Any((0..6).collect());
        let tree = Tree::new(&exprs, 6, 6);
        assert!(!tree.bounds(&half_spaces).is_bounded());
        // The intersection of their complements is empty, but rays need to test each.
        exprs.push(Expr::Not(6));
        let tree = Tree::new(&exprs, 7, 6);
        assert!(tree.bounds(&half_spaces).is_empty());
        assert_eq!(tree.where_leaves_matter(&half_spaces), [Aabb::UNBOUNDED; 6]);
    }

    #[test]
    fn planes_and_a_quadric_bound_an_intersection() {
        use durer_surfaces::{Accelerate, PartId, Plane, Quadric};
        let unbounded =
            |half_space, quadric| Extent { bounds: Aabb::UNBOUNDED, inner: Aabb::EMPTY, half_space, quadric };
        let plane = |y: f64| Plane::new(durer_math::Vec3::new(0.0, y, 0.0), 1.0).unwrap();
        // x² - y² + z² = 1, which is √2 wide at y = ±1.
        let waist = Quadric::new([1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).unwrap();
        let waist = waist.packet_filter(PartId(0)).quadric_extent();
        let leaves = [
            unbounded(plane(1.0).half_space(), None),
            unbounded(plane(-1.0).half_space(), None),
            unbounded(None, waist),
        ];
        let mut exprs: Vec<Expr> = (0..3).map(Expr::Leaf).collect();
        exprs.push(Expr::All((0..3).collect()));
        let bounds = Tree::new(&exprs, 3, 3).bounds(&leaves);
        assert!(bounds.max.x >= 2_f64.sqrt() && bounds.magnitude() < 1.6, "{bounds:?}");
        // What the solid takes away from the slab is not bounded.
        exprs.extend([Expr::Not(2), Expr::All(vec![0, 1, 4])]);
        assert!(!Tree::new(&exprs, 5, 3).bounds(&leaves).is_bounded());
    }
}

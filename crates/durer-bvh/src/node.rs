//! The node: sixteen boxes and references to their contents, in eight cache lines.

/// The greatest number of children of a node.
pub(crate) const WIDTH: usize = 16;

/// Bits of a slot in a word of [`Node::order`].
pub(crate) const SLOT_BITS: u32 = WIDTH.ilog2();

const _: () = assert!(WIDTH == 16 && 8 * SLOT_BITS == u32::BITS);

/// The greatest number of entries of a leaf.
pub(crate) const MAX_LEAF: usize = 16;

/// The greatest number of entries of a tree.
pub const MAX_ENTRIES: usize = 1 << 27;

/// Sixteen children: the planes of their boxes, their references, and the order in which rays of
/// each octant visit them.
///
/// 512 bytes: after V. Fuetterling, C. Lojewski, F.-J. Pfreundt, A. Ebert, "Accelerated single ray
/// tracing for wide vector units", High Performance Graphics (2017).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Low x, y, z, then high x, y, z, of each child. An empty slot has a box that no ray meets.
    pub(crate) planes: [[f32; WIDTH]; 6],
    pub(crate) child: [ChildRef; WIDTH],
    /// Word `j`, bits `4 o .. 4 o + 4`: the slot of the child that is `j`-th from the back for rays
    /// of octant `o`.
    pub(crate) order: [u32; WIDTH],
}

/// The near plane of an empty slot, which no ray of a tree reaches.
///
/// `|1/d| > 1/2` on every axis and origins are near the tree, so `near >= 2^29 - ...`, far beyond
/// any exit (which is at most `2^16`); and nothing overflows to NaN, since the added constant is
/// finite.
const NOWHERE: f32 = (1_u64 << 30) as f32;

impl Node {
    /// A node without children.
    pub(crate) const EMPTY: Self = Self {
        planes: [
            [NOWHERE; WIDTH],
            [NOWHERE; WIDTH],
            [NOWHERE; WIDTH],
            [-NOWHERE; WIDTH],
            [-NOWHERE; WIDTH],
            [-NOWHERE; WIDTH],
        ],
        child: [ChildRef(0); WIDTH],
        order: [0; WIDTH],
    };

    /// The box of a child.
    pub(crate) fn bounds(&self, child: usize) -> ([f32; 3], [f32; 3]) {
        ([0, 1, 2].map(|i| self.planes[i][child]), [3, 4, 5].map(|i| self.planes[i][child]))
    }

    /// Puts a child into a slot.
    pub(crate) fn set(&mut self, slot: usize, lo: [f32; 3], hi: [f32; 3], child: ChildRef) {
        for i in 0..3 {
            self.planes[i][slot] = lo[i];
            self.planes[3 + i][slot] = hi[i];
        }
        self.child[slot] = child;
    }

    /// Whether there is a child in this slot.
    pub(crate) fn is_used(&self, slot: usize) -> bool {
        self.planes[0][slot] <= self.planes[3][slot]
    }

    /// The slots in use.
    pub(crate) fn used(&self) -> impl Iterator<Item = usize> + '_ {
        (0..WIDTH).filter(|&slot| self.is_used(slot))
    }

    /// Orders the children for each octant: by their centres along the octant's diagonal, farthest
    /// first.
    pub(crate) fn sort(&mut self) {
        self.order = [0; WIDTH];
        // The opposite octant has the reverse order.
        for octant in 0..4_u32 {
            let (mut depths, mut slots) = ([0.0_f32; WIDTH], [0_usize; WIDTH]);
            for slot in 0..WIDTH {
                let along = |axis: usize| {
                    let centre2 = self.planes[axis][slot] + self.planes[3 + axis][slot];
                    if octant >> axis & 1 == 0 { centre2 } else { -centre2 }
                };
                let depth = along(0) + along(1) + along(2);
                let mut at = slot;
                while at > 0 && depths[at - 1] < depth {
                    (depths[at], slots[at]) = (depths[at - 1], slots[at - 1]);
                    at -= 1;
                }
                (depths[at], slots[at]) = (depth, slot);
            }
            for (i, &slot) in slots.iter().enumerate() {
                self.order[i] |= (slot as u32) << (SLOT_BITS * octant);
                self.order[WIDTH - 1 - i] |= (slot as u32) << (SLOT_BITS * (7 - octant));
            }
        }
    }
}

/// A reference to a child: another node, or a leaf.
///
/// Node: its index. Leaf: bit 31, then the count less one in four bits, then the first slot in 27.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct ChildRef(pub(crate) u32);

impl ChildRef {
    const LEAF: u32 = 1 << 31;
    const COUNT_SHIFT: u32 = 27;

    /// The end of a stack. It looks like a leaf that begins with the last entry that a tree can
    /// hold and has fifteen more.
    pub(crate) const END: Self = Self(u32::MAX);

    pub(crate) fn node(index: usize) -> Self {
        debug_assert!(index < Self::LEAF as usize);
        Self(index as u32)
    }

    pub(crate) fn leaf(first: usize, count: usize) -> Self {
        debug_assert!(first < MAX_ENTRIES && (1..=MAX_LEAF).contains(&count));
        Self(Self::LEAF | ((count as u32 - 1) << Self::COUNT_SHIFT) | first as u32)
    }

    #[inline(always)]
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// The index of the node.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    /// First slot and count of the leaf.
    #[inline(always)]
    pub(crate) fn slots(self) -> (u32, u32) {
        (self.0 & ((1 << Self::COUNT_SHIFT) - 1), ((self.0 >> Self::COUNT_SHIFT) & 15) + 1)
    }
}

/// A leaf: a range of entries of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// The kind.
    pub kind: u32,
    /// The first entry, counted within the kind in the order of the leaves.
    pub first: u32,
    /// How many entries.
    pub count: u32,
    /// For a single triangle of a block, sixteen times the number of the block, plus the lane; else
    /// [`Leaf::NO_BLOCK`].
    pub(crate) place: u32,
}

impl Leaf {
    pub(crate) const NO_BLOCK: u32 = u32::MAX;

    /// A range of entries of one kind.
    #[inline(always)]
    pub fn new(kind: u32, first: u32, count: u32) -> Self {
        Self { kind, first, count, place: Self::NO_BLOCK }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_is_eight_cache_lines() {
        assert_eq!((size_of::<Node>(), align_of::<Node>()), (512, 64));
    }

    #[test]
    fn references_keep_what_they_are_given() {
        for (first, count) in [(0, 1), (MAX_ENTRIES - 1, MAX_LEAF), (12345, 7)] {
            let r = ChildRef::leaf(first, count);
            assert!(r.is_leaf());
            assert_eq!(r.slots(), (first as u32, count as u32));
        }
        assert!(!ChildRef::node(77).is_leaf());
        assert_eq!(ChildRef::node(77).index(), 77);
    }

    #[test]
    fn each_octant_orders_all_children_from_the_back() {
        let mut node = Node::EMPTY;
        for i in 0..WIDTH {
            let x = (i * 5 % WIDTH) as f32 / WIDTH as f32;
            node.set(i, [x; 3], [x; 3], ChildRef::node(i));
        }
        node.sort();
        for octant in 0..8 {
            let slots = node.order.map(|w| (w >> (SLOT_BITS * octant)) as usize % WIDTH);
            let mut sorted = slots;
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..WIDTH));
        }
        let positive = node.order.map(|w| node.planes[0][w as usize % WIDTH]);
        assert!(positive.is_sorted_by(|a, b| a > b));
    }
}

//! The tree.

use crate::frame::Frame;
use crate::node::{ChildRef, Leaf, Node, WIDTH};
use crate::ray::{Clip, CullRay, PACKET, Ray32, Ray64, Rounding, TreeRay};
use crate::triangles::{Block, Corners, LANES};
use durer_math::{Aabb, Point3};

/// A bounding volume hierarchy: which entries might this ray hit?
///
/// Coordinates are f32, in units that make all of them at most 1. Boxes are rounded outward, and
/// tests count every rounding error as a possible hit, so that no box that the exact ray meets is
/// missed.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh {
    pub(crate) frame: Frame,
    pub(crate) nodes: Vec<Node>,
    /// The first slot of each kind, and the end.
    pub(crate) starts: Vec<u32>,
    /// The meaning of references to leaves, kind by kind.
    pub(crate) kinds: Vec<KindOfLeaf>,
    /// The leaves that hold triangles.
    pub(crate) blocks: Vec<Block>,
    /// The triangles that are in several of the blocks.
    pub(crate) splits: Splits,
    /// Whether f32 does not hold all corners of the blocks exactly.
    pub(crate) rounded: bool,
    /// Whether the only kind is one of triangles: then references to leaves are the numbers of
    /// their blocks.
    pub(crate) is_all_triangles: bool,
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
    pub(crate) clip: Clip,
}

/// The meaning of references to leaves of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct KindOfLeaf {
    /// The first reference.
    pub(crate) first: u32,
    /// For triangles, the number of the first block; else references are slots.
    pub(crate) blocks: Option<u32>,
}

/// The places of triangles that are in several leaves: they have the last slots of their kinds.
///
/// A ray may visit several of these leaves. Let the *first* be the one that comes first in `places`
/// among those whose boxes the ray meets by the node test. That test is monotonic in the planes of
/// a box, rounding included, so a ray visits a leaf if and only if it meets the leaf's own box: it
/// then meets the boxes around it, too. So a query that reports a triangle in its first leaf alone
/// reports it once, if the test is always up to the same `t`; and does not miss it, since the point
/// where the ray meets the triangle is in one of the boxes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Splits {
    /// For each kind its first such slot, and how many such slots the kinds before it have. Empty
    /// if there are none at all.
    pub(crate) kinds: Vec<(u32, u32)>,
    /// The begin of each triangle's places, and the end.
    pub(crate) starts: Vec<u32>,
    /// Children of nodes, in the order of the nodes: see [`Splits::place`].
    pub(crate) places: Vec<u32>,
}

impl Splits {
    /// The place of a child as one number: there are fewer than `2^28` nodes.
    pub(crate) fn place(node: usize, slot: usize) -> u32 {
        (node * WIDTH + slot) as u32
    }

    /// The node and the slot of a place.
    #[inline(always)]
    pub(crate) fn child(place: u32) -> (usize, usize) {
        (place as usize / WIDTH, place as usize % WIDTH)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The number of a slot among those in several leaves, if it is one of them.
    #[inline(always)]
    pub(crate) fn number(&self, kind: u32, slot: u32) -> Option<u32> {
        let &(whole, before) = self.kinds.get(kind as usize)?;
        (slot >= whole).then(|| before + slot - whole)
    }

    /// All places of a triangle that is in several leaves.
    #[inline(always)]
    pub(crate) fn places(&self, number: u32) -> &[u32] {
        let number = number as usize;
        &self.places[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

impl Bvh {
    /// An empty tree.
    pub fn empty() -> Self {
        Self::assembled(Frame::around(&Aabb::EMPTY), vec![0])
    }

    /// This tree with other nodes.
    pub(crate) fn with_nodes(mut self, nodes: Vec<Node>) -> Self {
        self.set_nodes(nodes);
        self
    }

    /// Replaces the nodes. Their boxes are in units of the tree's frame.
    pub(crate) fn set_nodes(&mut self, nodes: Vec<Node>) {
        (self.lo, self.hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        if let Some(root) = nodes.first() {
            for (a, b) in root.used().map(|slot| root.bounds(slot)) {
                self.lo = [0, 1, 2].map(|i| self.lo[i].min(a[i]));
                self.hi = [0, 1, 2].map(|i| self.hi[i].max(b[i]));
            }
        }
        self.clip = Clip::to(self.frame.units(), self.lo, self.hi);
        self.nodes = nodes;
    }

    /// A tree without nodes; `starts` has one element more than there are kinds.
    pub(crate) fn assembled(frame: Frame, starts: Vec<u32>) -> Self {
        let (lo, hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let slots = |&first: &u32| KindOfLeaf { first, blocks: None };
        Self {
            frame,
            nodes: Vec::new(),
            kinds: starts[..starts.len() - 1].iter().map(slots).collect(),
            starts,
            blocks: Vec::new(),
            splits: Splits::default(),
            rounded: false,
            is_all_triangles: false,
            lo,
            hi,
            clip: Clip::to(frame.units(), lo, hi),
        }
    }

    /// How many entries the tree holds.
    pub fn len(&self) -> usize {
        self.starts.last().map_or(0, |&n| n as usize)
    }

    /// How many entries of a kind the tree holds.
    pub fn count(&self, kind: u32) -> usize {
        let start = |kind: usize| self.starts.get(kind).map_or(0, |&n| n as usize);
        start(kind as usize + 1).saturating_sub(start(kind as usize))
    }

    /// Whether the tree holds nothing.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A box around all entries.
    pub fn bounds(&self) -> Aabb {
        if self.is_empty() { Aabb::EMPTY } else { self.frame.bounds(self.lo, self.hi) }
    }

    /// How many leaves hold triangles.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Whether the leaves of a kind hold triangles.
    pub fn is_of_triangles(&self, kind: u32) -> bool {
        self.kinds.get(kind as usize).is_some_and(|kind| kind.blocks.is_some())
    }

    /// A ray for the tree's kernels: its origin is relative to the tree's centre.
    #[inline(always)]
    pub(crate) fn local_line(&self, ray: &impl TreeRay) -> Ray64 {
        if self.frame.is_moved() { self.frame.moved(&ray.line()) } else { ray.line() }
    }

    /// [`TreeRay::glance`] with the origin relative to the tree's centre, for packets.
    #[inline(always)]
    pub fn glance(&self, ray: &impl TreeRay) -> Ray32 {
        if self.frame.is_moved() { self.frame.moved(&ray.line()).glance() } else { ray.glance() }
    }

    /// An upper bound on the magnitudes of its coordinates.
    #[inline(always)]
    pub fn size(&self) -> f64 {
        self.frame.size()
    }

    /// The kind of a reference to a leaf, and the reference counted within the kind.
    #[inline(always)]
    fn kind_of(&self, child: ChildRef) -> (usize, u32) {
        let (reference, _) = child.slots();
        // Few kinds: a scan is faster than a search, and with one kind it ends at once.
        let mut kind = 0;
        while kind + 1 < self.kinds.len() && self.kinds[kind + 1].first <= reference {
            kind += 1;
        }
        (kind, reference - self.kinds[kind].first)
    }

    /// A leaf, from a reference to one.
    #[inline(always)]
    pub(crate) fn leaf(&self, child: ChildRef) -> Leaf {
        let (kind, at) = self.kind_of(child);
        let first = match self.kinds[kind].blocks {
            Some(first) => self.blocks[(first + at) as usize].slot(0),
            None => at,
        };
        Leaf::new(kind as u32, first, child.slots().1)
    }

    /// Passes the content of a leaf to `visit`, in one piece where slots are successive, until it
    /// returns true; returns whether it did.
    #[inline(always)]
    pub(crate) fn leaves(&self, child: ChildRef, visit: &mut impl FnMut(Leaf) -> bool) -> bool {
        if self.splits.is_empty() {
            return visit(self.leaf(child));
        }
        self.pieces(child, visit)
    }

    fn pieces(&self, child: ChildRef, visit: &mut impl FnMut(Leaf) -> bool) -> bool {
        let Some((kind, number)) = self.block(child) else { return visit(self.leaf(child)) };
        let block = &self.blocks[number as usize];
        let (mut lane, end) = (0, block.len());
        while lane < end {
            let first = block.slot(lane);
            let mut count = 1;
            while lane + count < end && block.slot(lane + count) == first + count as u32 {
                count += 1;
            }
            lane += count;
            if visit(Leaf::new(kind, first, count as u32)) {
                return true;
            }
        }
        false
    }

    /// The kind and the number of the block of a leaf that holds triangles, from a reference to it.
    #[inline(always)]
    pub(crate) fn block(&self, child: ChildRef) -> Option<(u32, u32)> {
        if self.is_all_triangles {
            return Some((0, child.slots().0));
        }
        if self.blocks.is_empty() {
            return None;
        }
        let (kind, at) = self.kind_of(child);
        let first = self.kinds[kind].blocks?;
        Some((kind as u32, first + at))
    }

    /// The exact corners of a triangle that a query passed by itself, if f32 holds all corners
    /// exactly. They are in the cache, as the ray has just tested the block.
    #[inline(always)]
    pub fn corners(&self, triangle: &Leaf) -> Option<Corners> {
        let grow = self.clip.grow;
        if self.rounded || grow == 0.0 {
            return None;
        }
        let place = triangle.place as usize;
        let corners = self.blocks.get(place / LANES)?.corners(grow, place % LANES);
        // Exact, as the difference was.
        let moved = |p: Point3| p + self.frame.centre().to_vec();
        Some(if self.frame.is_moved() { corners.map(moved) } else { corners })
    }

    /// [`Bvh::corners`] of a triangle for each of eight rays, corner by corner and axis by axis;
    /// zeros where there is no triangle.
    #[inline(always)]
    pub fn corners_of_each(&self, triangles: &[Option<Leaf>; PACKET]) -> Option<[[[f64; PACKET]; 3]; 3]> {
        let grow = self.clip.grow;
        if self.rounded || grow == 0.0 {
            return None;
        }
        let mut kept = [[0.0_f32; PACKET]; 9];
        for (i, triangle) in triangles.iter().enumerate() {
            let Some(triangle) = triangle else { continue };
            let place = triangle.place as usize;
            let block = self.blocks.get(place / LANES)?;
            for (row, kept) in block.rows.iter().zip(&mut kept) {
                kept[i] = row[place % LANES];
            }
        }
        let mut corners = [[[0.0; PACKET]; 3]; 3];
        for corner in 0..3 {
            for axis in 0..3 {
                for i in 0..PACKET {
                    corners[corner][axis][i] = f64::from(kept[3 * corner + axis][i]) * grow;
                }
                if self.frame.is_moved() {
                    // Exact, as the difference was.
                    corners[corner][axis].iter_mut().for_each(|x| *x += self.frame.centre()[axis]);
                }
            }
        }
        Some(corners)
    }

    /// How many bytes queries may read.
    pub(crate) fn held(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }

    /// The address of a child, for prefetching: right for nodes, and for blocks if there is one
    /// kind.
    #[inline(always)]
    pub(crate) fn place(&self, child: ChildRef) -> *const u8 {
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        let block = self.blocks.as_ptr().wrapping_add(child.slots().0 as usize).cast::<u8>();
        if child.is_leaf() { block } else { node }
    }

    #[inline(always)]
    pub(crate) fn cull(&self, line: &Ray64, rounding: Rounding) -> Option<CullRay> {
        if self.is_empty() {
            return None;
        }
        CullRay::new(line, self.frame.units(), &self.lo, &self.hi, rounding)
    }
}

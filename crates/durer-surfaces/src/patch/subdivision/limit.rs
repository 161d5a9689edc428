//! The limit surface of a control mesh: patches, and corners that become patches only when a ray
//! comes near.
//!
//! A face next to an extraordinary vertex is refined to three patches and a smaller corner, again
//! and again. Some steps are computed in advance. The remaining corner is refined for each ray that
//! meets the convex hull of its points, by the same sums, so no hit depends on the steps in
//! advance. The refined parts are kept for later rays, up to a limit. When the hull is as small as
//! the errors of the ray, it becomes one candidate, which is joined with adjacent crossings.
//!
//! Coordinates are in double-double, starting from the exact control points. A step makes at most
//! 35 roundings of `2^-106` of the size of the surface, and no step makes the errors of the one
//! before larger, because its weights are not negative and have the sum 1. After 120 steps that is
//! less than `2^-93`; the bounds of cells and hulls include `2^-90`.

use super::Scheme;
use super::plan::{Plan, Plans, Wheel, net, refine};
use super::topology::{Adjacency, Topology};
use crate::blob::Along;
use crate::box_tree::{BoxTree, Open};
use crate::mesh::Sorted;
use crate::patch::ahead::Ahead;
use crate::patch::alternation::{alternate, decide, in_turn, is_in_doubt, join_unproven};
use crate::patch::cell::{Cell, cells};
use crate::patch::exact::Exact;
use crate::patch::line::{Found, Line, View};
use crate::patch::net::{FaceNet, relative};
use crate::patch::shell::{Face, ROOM, clamped, is_on_edge, root};
use crate::{CentredRay, LocalRay, Sink};
use core::cell::Cell as Slot;
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dd, Isa, Point3, U, Vec3};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The error of points in addition to their rounding to f64, in units.
pub(super) const E_POINTS: f64 = durer_math::scale::pow2(-90);
/// Functions that are within this many errors of zero on all of a hull count as zero.
const NOISE: f64 = 8.0;
/// The most refinements of a corner.
pub(super) const MOST_STEPS: u32 = 120;
/// The most steps in advance.
pub(super) const AHEAD: u32 = 6;
/// The most steps in advance for triangles, whose patches take more time to build.
const AHEAD_TRIANGLES: u32 = 3;
/// If there would be more patches than this, fewer steps are computed in advance.
const MANY: usize = 1 << 18;
/// The most steps of corners that are kept, of about 16 kB each.
const MOST_KEPT: usize = 4096;

/// A part of a face in its parameters: a square, or a triangle with this corner. In the middle of a
/// triangle parameters run in the opposite direction, and the width is negative.
///
/// Parameters near 1 are stored relative to 1, so that they are as precise as those near 0: a
/// crossing may be far nearer to a vertex than the spacing of numbers at 1. In the tag of a root
/// such a parameter has a minus sign, and `-0` is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) face: u32,
    pub(super) is_triangle: bool,
    /// The parameters that are relative to 1.
    is_far: [bool; 2],
    pub(super) from: [f64; 2],
    pub(super) width: f64,
}

/// The parameters of a face from a root's tag.
pub(super) fn parameters(is_triangle: bool, tag: [f64; 2]) -> [f64; 2] {
    clamped(is_triangle, tag.map(|x| if x.is_sign_negative() { 1.0 + x } else { x }))
}

impl Place {
    pub(super) fn of(face: u32, is_triangle: bool) -> Self {
        Self { face, is_triangle, is_far: [false; 2], from: [0.0; 2], width: 1.0 }
    }

    /// The parameters of a corner; the fourth one of a triangle is that of the square.
    fn corner(&self, k: usize) -> [f64; 2] {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        if self.is_triangle { triangle[k] } else { square[k] }
    }

    pub(super) fn quarter(&self, k: usize) -> Self {
        let width = 0.5 * self.width;
        let [a, b] = self.corner(k);
        let mut part = *self;
        part.from = [a * width + self.from[0], b * width + self.from[1]];
        if self.is_triangle && k == 3 {
            part.width = -width;
            return part;
        }
        part.width = width;
        if self.width == 1.0 {
            part.is_far = part.from.map(|x| x > 0.0);
            part.from = part.from.map(|x| if x > 0.0 { x - 1.0 } else { x });
        }
        part
    }

    /// Converts a tag to parameters relative to the first corner, stored from 0 or 1 as here.
    fn within(&self, tag: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            let from = match (self.is_far[k], tag[k].is_sign_negative()) {
                (true, false) => tag[k] - 1.0,
                (false, true) => tag[k] + 1.0,
                _ => tag[k],
            };
            from - self.from[k]
        })
    }

    /// The quarter that a root with this tag is in.
    pub(super) fn quarter_at(&self, tag: [f64; 2]) -> usize {
        let [u, v] = self.within(tag);
        let half = 0.5 * self.width;
        if self.is_triangle {
            let [u, v, half] = if half < 0.0 { [-u, -v, -half] } else { [u, v, half] };
            return if u >= half {
                1
            } else if v >= half {
                2
            } else if u + v <= half {
                0
            } else {
                3
            };
        }
        match (u >= half, v >= half) {
            (false, false) => 0,
            (true, false) => 1,
            (true, true) => 2,
            (false, true) => 3,
        }
    }

    /// The parameters of the part from a root's tag.
    pub(super) fn inner(&self, tag: [f64; 2]) -> [f64; 2] {
        clamped(self.is_triangle, self.within(tag).map(|x| x / self.width))
    }

    /// Parameters of the part as the tag of a root.
    pub(super) fn outer(&self, uv: [f64; 2]) -> [f64; 2] {
        let uv = clamped(self.is_triangle, uv);
        [0, 1].map(|k| {
            let x = uv[k].mul_add(self.width, self.from[k]).abs();
            if self.is_far[k] { -x } else { x }
        })
    }
}

/// A face of some step with the points that it depends on, in units.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) plan: u32,
    pub(super) place: Place,
    pub(super) depth: u32,
    pub(super) points: Box<[[Dd; 3]]>,
}

impl Node {
    /// The four faces of the next step; `None` if it is a patch.
    pub(super) fn quarters(&self, plans: &[Plan]) -> Option<[Node; 4]> {
        let Plan::Split { stencils, quarters, .. } = &plans[self.plan as usize] else { return None };
        let finer = refine(stencils, &self.points);
        Some([0, 1, 2, 3].map(|k: usize| Node {
            plan: quarters[k].plan,
            place: self.place.quarter(k),
            depth: self.depth + 1,
            points: quarters[k].points.iter().map(|p| finer[*p as usize]).collect(),
        }))
    }

    /// Its net, if it is a patch.
    pub(super) fn net(&self, plans: &[Plan]) -> Option<FaceNet> {
        net(&plans[self.plan as usize], &self.points)
    }

    /// The corner at which refinement does not end, the first one if there are several.
    pub(super) fn vertex(&self, plans: &[Plan]) -> Option<usize> {
        let Plan::Split { quarters, .. } = &plans[self.plan as usize] else { return None };
        quarters.iter().position(|q| matches!(plans[q.plan as usize], Plan::Split { .. }))
    }

    /// That vertex and its neighbourhood, if it is smooth.
    pub(super) fn wheel<'a>(&self, plans: &'a [Plan]) -> Option<&'a Wheel> {
        let Plan::Split { wheels, .. } = &plans[self.plan as usize] else { return None };
        let vertex = self.vertex(plans)?;
        wheels.iter().find(|wheel| wheel.centre as usize == vertex)
    }
}

/// The data of a patch for resolving hits: its net relative to `base`.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) place: Place,
    pub(super) base: [f64; 3],
    pub(super) face: Face,
}

impl Leaf {
    pub(super) fn new(place: Place, net: &FaceNet) -> Self {
        let base = [0, 1, 2].map(|c| net.points()[5][c].to_f64());
        let square = net.part([0.0; 2], [1.0; 2]);
        let points = square.relative(base);
        let largest = points.iter().flatten().fold(1.0, |m: f64, x| m.max(x.abs()));
        let face = Face {
            size: square.size,
            net: points.into(),
            is_triangle: net.is_triangle(),
            lightest: 1.0,
            largest,
            trim: None,
            is_turned: false,
        };
        Self { place, base, face }
    }
}

/// A patch from the refinement of a corner.
#[derive(Debug)]
pub(super) struct Patch {
    pub(super) leaf: Leaf,
    /// Its control points relative to the leaf's base.
    hull: Box<[[f64; 3]]>,
    net: FaceNet,
    /// The cells, built when a ray meets the hull.
    cells: OnceLock<Box<[Cell]>>,
}

/// A face that is no patch, and its refined parts once a ray has come near.
#[derive(Debug)]
pub(super) struct Tail {
    pub(super) node: Node,
    /// The first of its points, rounded, and all of them relative to that.
    base: [f64; 3],
    pub(super) relative: Box<[[f64; 3]]>,
    finer: OnceLock<Box<Finer>>,
}

/// The four faces of a step.
pub(super) type Finer = [Refined; 4];

#[derive(Debug)]
pub(super) enum Refined {
    Patch(Box<Patch>),
    Tail(Tail),
}

impl Tail {
    fn new(node: Node) -> Self {
        let base = node.points[0].map(Dd::to_f64);
        let less = |p: &[Dd; 3]| [0, 1, 2].map(|c| (p[c] - Dd::from(base[c])).to_f64());
        let relative = node.points.iter().map(less).collect();
        Self { node, base, relative, finer: OnceLock::new() }
    }

    /// The refined parts. The corner keeps them, unless the surface keeps many already (`kept`):
    /// then they are in `spare`. `None` if the corner is a patch.
    pub(super) fn finer<'a>(
        &'a self,
        plans: &[Plan],
        kept: &AtomicUsize,
        spare: &'a mut Option<Box<Finer>>,
    ) -> Option<&'a Finer> {
        if let Some(finer) = self.finer.get() {
            return Some(finer);
        }
        let quarters = self.node.quarters(plans)?;
        let finer = Box::new(quarters.map(|node| Refined::new(node, plans)));
        if kept.fetch_add(1, Ordering::Relaxed) < MOST_KEPT {
            return Some(self.finer.get_or_init(|| finer));
        }
        Some(spare.insert(finer))
    }
}

impl Patch {
    fn cells(&self) -> &[Cell] {
        self.cells.get_or_init(|| cells_of(&self.net, 0))
    }
}

impl Refined {
    pub(super) fn new(node: Node, plans: &[Plan]) -> Self {
        let Some(net) = node.net(plans) else { return Self::Tail(Tail::new(node)) };
        let leaf = Leaf::new(node.place, &net);
        let hull = relative(net.points(), leaf.base).iter().map(|&[x, y, z, _]| [x, y, z]).collect();
        Self::Patch(Box::new(Patch { leaf, hull, net, cells: OnceLock::new() }))
    }
}

/// Where a face, or a part of it, is stored.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spot {
    Leaf(u32),
    Tail(u32),
    /// The first of four.
    Split(u32),
}

/// An element of the tree.
#[derive(Clone, Copy, Debug)]
enum Item {
    Cell(u32),
    /// A patch whose cells are made when a line meets the hull of its points.
    Leaf(u32),
    Tail(u32),
}

/// The limit surface in units about its centre.
#[derive(Debug)]
pub(super) struct Limit {
    pub(super) bounds: Aabb,
    pub(super) centre: Point3,
    pub(super) scale: i32,
    /// The radius of a ball about the centre that holds the surface.
    pub(super) reach: f64,
    pub(super) plans: Box<[Plan]>,
    pub(super) leaves: Box<[Leaf]>,
    pub(super) tails: Box<[Tail]>,
    /// The number of their steps that are kept.
    pub(super) kept: AtomicUsize,
    /// The first ones are those of the faces, in order.
    pub(super) spots: Box<[Spot]>,
    /// The control points of the leaves in double-double.
    nets: Box<[FaceNet]>,
    cells: Box<[Cell]>,
    /// The cells of leaves that are elements of the tree themselves.
    lazy_cells: Box<[OnceLock<Box<[Cell]>>]>,
    items: Box<[Item]>,
    tree: BoxTree,
    pub(super) is_triangles: bool,
    /// -1 if normals point into the solid.
    pub(super) outward: i8,
    /// Whether it bounds a solid.
    pub(super) is_closed: bool,
}

/// A patch that was made for one ray, or a corner that was a candidate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extra {
    pub(super) place: Place,
    /// The distance along the line within which adjacent parts may have the same crossing; 0 for a
    /// patch.
    pub(super) room: f64,
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
pub(super) struct Lists {
    open: Open,
    pub(super) found: Vec<Found>,
    /// Crossings that are passed on before the search has reached the line's end.
    early: Vec<Found>,
    pub(super) extra: Vec<Extra>,
    ahead: Ahead,
}

thread_local! {
    static LISTS: Slot<Lists> = Slot::default();
}

#[inline(never)]
fn meet_cell(line: &Line, cell: &Cell, exact: &Exact<'_>, found: &mut Vec<Found>) {
    Isa::detect().run(
        #[inline(always)]
        || View::new(line, cell, false).meet(exact, found, 0.0),
    );
}

/// A box that holds points.
fn hull(points: impl Iterator<Item = [Dd; 3]>) -> Aabb {
    Aabb::from_points(points.map(|p| Vec3::from(p.map(Dd::to_f64)).to_point()))
}

/// The cells of a patch.
fn cells_of(net: &FaceNet, face: u32) -> Box<[Cell]> {
    let mut all = Vec::new();
    cells(net, false, face, &mut all);
    all.into_iter().map(|(cell, _)| cell).collect()
}

impl Limit {
    /// The limit surface of quadrilaterals, or of triangles, without those that are holes; `None` only
    /// for a mesh that is not valid.
    pub(super) fn new(
        mesh: &Topology,
        points: &[[Dd; 3]],
        is_hole: &[bool],
        frame: (Point3, i32, f64),
        most: u32,
    ) -> Option<Self> {
        let (centre, scale, reach) = frame;
        let adjacency = Adjacency::new(mesh);
        let mut plans = Plans::default();
        let is_triangles = mesh.scheme == Scheme::Loop;
        let mut roots = Vec::new();
        for face in 0..mesh.faces.len() {
            if is_hole[face] {
                continue;
            }
            let part = adjacency.around(face)?;
            let place = Place::of(face as u32, is_triangles);
            let points = part.points.iter().map(|p| points[*p as usize]).collect();
            roots.push(Node { plan: plans.of(&part.mesh)?, place, depth: 0, points });
        }
        let plans = plans.all;
        let corners =
            roots.iter().filter(|node| matches!(plans[node.plan as usize], Plan::Split { .. })).count();
        let most = if is_triangles { most.min(AHEAD_TRIANGLES) } else { most };
        let ahead = (1..=most).rev().find(|n| 4 * corners * *n as usize <= MANY).unwrap_or(1);
        let mut spots = vec![Spot::Tail(0); mesh.faces.len()];
        let (mut leaves, mut nets, mut tails) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = Vec::new();
        // The elements of the tree, and their boxes.
        let (mut boxes, mut items) = (Vec::new(), Vec::new());
        let room = Vec3::new(1.0, 1.0, 1.0) * (4.0 * U);
        let mut open: Vec<(usize, Node)> =
            roots.into_iter().map(|node| (node.place.face as usize, node)).collect();
        open.reverse();
        while let Some((spot, node)) = open.pop() {
            if let Some(net) = node.net(&plans) {
                spots[spot] = Spot::Leaf(leaves.len() as u32);
                let leaf = Leaf::new(node.place, &net);
                if node.depth == 0 {
                    let first = all.len();
                    cells(&net, false, leaves.len() as u32, &mut all);
                    boxes.extend(all[first..].iter().map(|(_, bounds)| *bounds));
                    items.extend((first..all.len()).map(|k| Item::Cell(k as u32)));
                } else {
                    // Near a corner there are many, of one or a few cells.
                    boxes.push(hull(net.points().iter().map(|&[x, y, z, _]| [x, y, z])).expanded(room));
                    items.push(Item::Leaf(leaves.len() as u32));
                }
                nets.push(net);
                leaves.push(leaf);
            } else if node.depth < ahead
                && let Some(quarters) = node.quarters(&plans)
            {
                let first = spots.len();
                spots[spot] = Spot::Split(first as u32);
                spots.extend([Spot::Tail(0); 4]);
                open.extend(quarters.into_iter().enumerate().rev().map(|(k, node)| (first + k, node)));
            } else {
                spots[spot] = Spot::Tail(tails.len() as u32);
                boxes.push(hull(node.points.iter().copied()).expanded(room));
                items.push(Item::Tail(tails.len() as u32));
                tails.push(Tail::new(node));
            }
        }
        let (tree, order) = BoxTree::new(&boxes);
        let units = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b)).expanded(room);
        let back = |p: Point3| centre + p.to_vec().map(|x| scale2(x, scale));
        let bounds = Aabb::new(back(units.min), back(units.max));
        let bounds = bounds.expanded(Vec3::new(1.0, 1.0, 1.0) * (4.0 * U * bounds.magnitude()));
        let items = order.iter().map(|&i| items[i as usize]).collect();
        let lazy_cells = leaves.iter().map(|_| OnceLock::new()).collect();
        Some(Self {
            bounds,
            centre,
            scale,
            reach,
            plans: plans.into(),
            leaves: leaves.into(),
            tails: tails.into(),
            kept: AtomicUsize::new(0),
            spots: spots.into(),
            nets: nets.into(),
            cells: all.into_iter().map(|(cell, _)| cell).collect(),
            lazy_cells,
            items,
            tree,
            is_triangles,
            outward: 1,
            is_closed: false,
        })
    }

    /// The number of patches and corners that are built in advance.
    pub(super) fn counts(&self) -> [usize; 2] {
        [self.leaves.len(), self.tails.len()]
    }

    /// Passes all crossings to `sink`, ascending.
    #[inline(always)]
    pub(super) fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let at = ray.recentre(self.centre, self.scale).sharp(1.0);
        let mut lists = LISTS.take();
        let window = |limit: f64| {
            let (begin, end) = at.window((ray.t_min, ray.t_max.min(limit)));
            [begin - ROOM, end + ROOM]
        };
        let all = window(sink.limit());
        let mut end = all[1];
        lists.ahead = Ahead::default();
        let is_ended = self.meet(&at, &mut lists, all, |lists, near| {
            self.send(&at, lists, near, sink)?;
            end = window(sink.limit())[1];
            ControlFlow::Continue(end)
        });
        let sent = lists.ahead.sent;
        lists.found.retain(|found| found.s - found.s_err <= end);
        if is_ended.is_continue() && !lists.found.is_empty() {
            self.join(&mut lists.found, &lists.extra);
            if is_in_doubt(&mut lists.found, |f| is_on_edge(self.is_triangles, f)) && self.is_closed {
                lists.ahead.close();
                let line = [f64::NEG_INFINITY, f64::INFINITY];
                let _ = self.meet(&at, &mut lists, line, |_, _| ControlFlow::Continue(f64::INFINITY));
                self.join(&mut lists.found, &lists.extra);
                self.decide(&mut lists);
            }
            lists.found.retain(|found| found.s > sent);
            let _ = self.pour(&at, &lists.found, &lists.extra, sink);
        }
        LISTS.set(lists);
    }

    /// Decides the kind of all crossings along a whole line.
    #[cold]
    #[inline(never)]
    fn decide(&self, lists: &mut Lists) {
        let Lists { found, extra, .. } = lists;
        let room = |f: &Found| self.room(f, extra);
        if !decide(found, self.outward, |f| is_on_edge(self.is_triangles, f), room) {
            join_unproven(found, room);
            in_turn(found, self.outward);
            alternate(found, self.outward);
        }
    }

    /// Passes on the crossings that no part of the surface from `near` on can change.
    #[inline(always)]
    fn send(
        &self,
        at: &CentredRay<'_>,
        lists: &mut Lists,
        near: f64,
        sink: &mut dyn Sink,
    ) -> ControlFlow<()> {
        let Lists { found, early, extra, ahead, .. } = lists;
        let count = ahead.known(found, near);
        early.clear();
        early.extend_from_slice(&found[..count]);
        self.join(early, extra);
        if is_in_doubt(early, |f| is_on_edge(self.is_triangles, f)) {
            ahead.close();
            return ControlFlow::Continue(());
        }
        if count > 0 {
            ahead.send(found, count, near);
        }
        self.pour(at, early, extra, sink)
    }

    /// Passes crossings in their order to `sink`.
    #[inline(always)]
    fn pour(
        &self,
        at: &CentredRay<'_>,
        found: &[Found],
        extra: &[Extra],
        sink: &mut dyn Sink,
    ) -> ControlFlow<()> {
        let mut roots = Sorted::new();
        for crossing in found {
            let place = self.place(crossing, extra);
            let mut crossing = *crossing;
            crossing.face = place.face;
            crossing.sign *= self.outward;
            crossing.turn *= self.outward;
            if let Some(root) = root(at, &crossing, place.outer(crossing.uv)) {
                roots.push(root);
            }
        }
        roots.pour_in_turn(sink)
    }

    pub(super) fn place(&self, found: &Found, extra: &[Extra]) -> Place {
        let k = found.face as usize;
        self.leaves.get(k).map_or_else(|| extra[k - self.leaves.len()].place, |leaf| leaf.place)
    }

    /// Finds the crossings in a window. Calls `send` with the start of the next part of the surface
    /// whenever crossings before it may be final; `send` returns the present end of the window.
    #[inline(always)]
    fn meet(
        &self,
        at: &CentredRay<'_>,
        lists: &mut Lists,
        mut window: [f64; 2],
        mut send: impl FnMut(&mut Lists, f64) -> ControlFlow<(), f64>,
    ) -> ControlFlow<()> {
        let along = Along::new(at);
        let line = Line::new(at);
        let exact = Exact::new(at, &self.nets, line.axes);
        lists.found.clear();
        lists.extra.clear();
        self.tree.begin(&mut lists.open);
        while let Some((near, item)) = self.tree.next(&along, window, &mut lists.open) {
            if near > lists.ahead.due {
                window[1] = send(lists, near)?;
                if near > window[1] {
                    break;
                }
            }
            let first = lists.found.len();
            match self.items[item] {
                Item::Cell(k) => meet_cell(&line, &self.cells[k as usize], &exact, &mut lists.found),
                Item::Leaf(k) => {
                    for cell in
                        self.lazy_cells[k as usize].get_or_init(|| cells_of(&self.nets[k as usize], k))
                    {
                        meet_cell(&line, cell, &exact, &mut lists.found);
                    }
                }
                Item::Tail(k) => self.unfold(at, &line, &self.tails[k as usize], window, lists),
            }
            lists.ahead.note(&lists.found[first..]);
        }
        ControlFlow::Continue(())
    }

    /// Finds the crossings of a line and a corner.
    #[inline(never)]
    fn unfold(&self, at: &CentredRay<'_>, line: &Line, tail: &Tail, window: [f64; 2], lists: &mut Lists) {
        Isa::detect().run(
            #[inline(always)]
            || self.unfold_here(at, line, tail, window, lists),
        );
    }

    #[inline(always)]
    fn unfold_here(
        &self,
        at: &CentredRay<'_>,
        line: &Line,
        tail: &Tail,
        window: [f64; 2],
        lists: &mut Lists,
    ) {
        let corners = if self.is_triangles { 3 } else { 4 };
        let sight = line.sight(tail.base, &tail.relative, corners, E_POINTS);
        if sight.is_clear() || sight.s[1] < window[0] || sight.s[0] > window[1] {
            return;
        }
        let is_noise = (0..2).all(|i| sight.f[i][0].abs().max(sight.f[i][1].abs()) <= NOISE * sight.e[i]);
        let mut spare = None;
        if !is_noise
            && tail.node.depth < MOST_STEPS
            && let Some(finer) = tail.finer(&self.plans, &self.kept, &mut spare)
        {
            for part in finer {
                match part {
                    Refined::Patch(patch) => self.meet_patch(at, line, patch, lists),
                    Refined::Tail(tail) => self.unfold(at, line, tail, window, lists),
                }
            }
            return;
        }
        // All of it is within the ray's error; the vertex represents it.
        let (place, vertex) = (tail.node.place, tail.node.vertex(&self.plans));
        let middle = [if self.is_triangles { 1.0 / 3.0 } else { 0.5 }; 2];
        let [low, high] = sight.plane.unwrap_or(sight.s);
        let face = (self.leaves.len() + lists.extra.len()) as u32;
        lists.extra.push(Extra { place, room: sight.s[1] - sight.s[0] });
        lists.found.push(Found {
            face,
            uv: vertex.map_or(middle, |k| place.corner(k)),
            radius: [1.0; 2],
            alone: [0.0; 2],
            s: 0.5 * (low + high),
            s_err: 0.5 * (high - low) * (1.0 + 4.0 * U) + U * (low.abs() + high.abs()),
            sign: 0,
            turn: sight.turn,
            on_trim: false,
            is_shared: false,
            is_zero: false,
        });
    }

    /// Finds the crossings of a line and a patch of a corner.
    #[inline(always)]
    fn meet_patch(&self, at: &CentredRay<'_>, line: &Line, patch: &Patch, lists: &mut Lists) {
        // The hull of its own net is much smaller than that of the points that it depends on.
        if line.misses(patch.leaf.base, &patch.hull, E_POINTS) {
            return;
        }
        let (face, first) = ((self.leaves.len() + lists.extra.len()) as u32, lists.found.len());
        lists.extra.push(Extra { place: patch.leaf.place, room: 0.0 });
        let exact = Exact::new(at, core::slice::from_ref(&patch.net), line.axes);
        for cell in patch.cells() {
            meet_cell(line, cell, &exact, &mut lists.found);
        }
        for found in &mut lists.found[first..] {
            found.face = face;
        }
    }

    /// The frame of points: their centre, the exponent of the unit, and the radius that holds them.
    pub(super) fn frame(points: impl Iterator<Item = Point3>) -> (Point3, i32, f64) {
        let hull = Aabb::from_points(points);
        let centre = hull.centre();
        let reach = hull.reach_from(centre);
        (centre, exponent(reach) + 1, reach)
    }
}

//! Patches as one surface: their cells in a tree, and all crossings of a ray, each once.

use super::ahead::Ahead;
use super::alternation::{decide, is_in_doubt};
use super::cell::{Cell, EDGE, Trimmed, cells};
use super::degree::turns_around;
use super::exact::Exact;
use super::line::{Found, Line, View};
use super::net::{FaceNet, Homogeneous, relative};
use super::trim::Trims;
use crate::blob::Along;
use crate::box_tree::{BoxTree, Open};
use crate::degree::{Sum, sum_of_signs};
use crate::mesh::Sorted;
use crate::{CentredRay, LocalRay, Root, RootKind, Sink, steps};
use core::cell::Cell as Slot;
use core::ops::ControlFlow;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dd, Isa, Point3, U, Vec3};
use durer_roots::two_unknowns::ROUNDED;
use std::sync::Arc;

/// Cells farther than this from the ray's range, in units, are skipped. The bracket of a proven
/// crossing is far narrower.
pub(super) const ROOM: f64 = 1.0 / 1024.0;

/// The data of a patch for resolving hits: its control points, rounded, in units.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(super) size: [usize; 2],
    /// The control points over the unit square, for a triangle too.
    pub(super) net: Box<[Homogeneous<f64>]>,
    pub(super) is_triangle: bool,
    /// The least weight, and the largest number of the net, doubled if there are weights.
    pub(super) lightest: f64,
    pub(super) largest: f64,
    pub(super) trim: Option<FaceTrim>,
    /// Whether the normal points the other way, out of a solid.
    pub(super) is_turned: bool,
}

/// The trims of a face, and its range of parameters in the trims' units: the least ones and the
/// widths.
#[derive(Clone, Debug)]
pub(crate) struct FaceTrim {
    pub(super) trims: Arc<Trims>,
    pub(super) from: [f64; 2],
    pub(super) width: [f64; 2],
}

impl FaceTrim {
    /// Whether parameters of the face within `radius` of `uv` are kept; `None` if only some may be.
    pub(crate) fn keeps(&self, uv: [f64; 2], radius: [f64; 2]) -> Option<bool> {
        let (at, off) = self.as_knots(uv, radius);
        self.trims.keeps(at, off)
    }

    /// Parameters and their errors, in the units of the knots.
    pub(super) fn as_knots(&self, uv: [f64; 2], radius: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let at = [0, 1].map(|k| f64::mul_add(self.width[k], uv[k], self.from[k]));
        let off = [0, 1].map(|k| {
            let rounding = 4.0 * U * (self.from[k].abs() + self.width[k]);
            (self.width[k] * radius[k] + rounding) * ROUNDED
        });
        (at, off)
    }
}

/// Patches in units about a common centre.
#[derive(Clone, Debug)]
pub(crate) struct Shell {
    pub(crate) bounds: Aabb,
    pub(crate) centre: Point3,
    pub(super) scale: i32,
    /// The radius of a ball about the centre that holds all patches.
    pub(crate) reach: f64,
    pub(super) rational: bool,
    pub(super) faces: Box<[Face]>,
    /// The control points of the faces in double-double.
    nets: Box<[FaceNet]>,
    /// In the order of the tree.
    cells: Box<[Cell]>,
    tree: BoxTree,
    /// Whether it bounds a solid, out of which all normals point.
    pub(super) is_closed: bool,
    /// Gaps between faces up to this width are closed, in units; 0 if gaps are not closed.
    pub(super) seal: f64,
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
pub(super) struct Lists {
    open: Open,
    pub(super) found: Vec<Found>,
    /// Crossings that are passed on before the search has reached the line's end.
    early: Vec<Found>,
    pub(super) ahead: Ahead,
    /// Crossings outside their face, within the seal's width of its edge.
    pub(super) off: Vec<Found>,
}

thread_local! {
    static LISTS: Slot<Lists> = Slot::default();
}

impl Face {
    fn new(net: &FaceNet, rational: bool, trim: Option<FaceTrim>) -> Self {
        let own = relative(net.points(), [0.0; 3]);
        let square = net.part([0.0; 2], [1.0; 2]);
        let points = square.relative([0.0; 3]);
        let (mut lightest, mut largest) = (1.0, 1.0);
        if rational {
            lightest = own.iter().fold(f64::INFINITY, |m: f64, p| m.min(p[3]));
            largest = 2.0 * points.iter().fold(0.0, |m: f64, p| m.max(p[3].abs()));
        }
        if net.is_triangle() {
            largest = points.iter().flatten().fold(largest, |m: f64, x| m.max(x.abs()));
        }
        let is_triangle = net.is_triangle();
        let net = points.into();
        Self { size: square.size, net, is_triangle, lightest, largest, trim, is_turned: false }
    }

    /// The middle of the parameters' domain.
    pub(super) fn middle(&self) -> [f64; 2] {
        [if self.is_triangle { 1.0 / 3.0 } else { 0.5 }; 2]
    }

    /// The parameters of the patch nearest to `uv`.
    #[inline(always)]
    fn clamped(&self, uv: [f64; 2]) -> [f64; 2] {
        clamped(self.is_triangle, uv)
    }

    /// Whether a crossing may be on an edge.
    #[inline(always)]
    fn has_on_edge(&self, f: &Found) -> bool {
        f.on_trim || is_on_edge(self.is_triangle, f)
    }
}

/// Moves parameters into the domain, a triangle or a square.
#[inline(always)]
pub(super) fn clamped(is_triangle: bool, uv: [f64; 2]) -> [f64; 2] {
    let [u, v] = uv.map(|x| x.clamp(0.0, 1.0));
    if is_triangle && u + v > 1.0 {
        let over = 0.5 * (u + v - 1.0);
        return [(u - over).max(0.0), (v - over).max(0.0)];
    }
    [u, v]
}

/// Whether a crossing may be on an edge of a triangle or a square.
#[inline(always)]
pub(super) fn is_on_edge(is_triangle: bool, f: &Found) -> bool {
    (0..2).any(|k| f.uv[k] <= f.radius[k] || !is_triangle && f.uv[k] + f.radius[k] >= 1.0)
        || is_triangle && f.uv[0] + f.uv[1] + f.radius[0] + f.radius[1] >= 1.0
}

impl Shell {
    /// The shell of nets whose points are finite and whose weights are positive; `None` if all points
    /// are the same.
    pub(crate) fn new(nets: &[FaceNet]) -> Option<Self> {
        Self::trimmed(nets, |_| None, 0.0)
    }

    /// The shell of nets with their trims; gaps up to `seal` are closed. `None` also if the trims
    /// leave nothing.
    pub(super) fn trimmed(
        nets: &[FaceNet],
        trim: impl Fn(usize) -> Option<FaceTrim>,
        seal: f64,
    ) -> Option<Self> {
        let points = || nets.iter().flat_map(FaceNet::points);
        let place = |p: &Homogeneous<Dd>| {
            let w = p[3].to_f64();
            Point3::new(p[0].to_f64() / w, p[1].to_f64() / w, p[2].to_f64() / w)
        };
        let hull = Aabb::from_points(points().map(place));
        let centre = hull.centre();
        let reach = hull.reach_from(centre);
        if reach == 0.0 {
            return None;
        }
        let scale = exponent(reach) + 1;
        let heaviest = points().fold(0.0, |m: f64, p| m.max(p[3].to_f64()));
        let rational = points().any(|p| p[3] != Dd::ONE);
        // If there are no weights, all are 1.
        let weight_scale = if rational { exponent(heaviest) + 1 } else { 0 };
        let middle = [centre.x, centre.y, centre.z].map(Dd::from);
        let (mut all, mut faces, mut exact) = (Vec::new(), Vec::new(), Vec::new());
        for (face, net) in nets.iter().enumerate() {
            let about = |p: &Homogeneous<Dd>| {
                let of = |k: usize| (p[k] - middle[k] * p[3]).scale2(-scale - weight_scale);
                [of(0), of(1), of(2), p[3].scale2(-weight_scale)]
            };
            let net = net.map(about);
            let first = all.len();
            cells(&net, rational, face as u32, &mut all);
            let trim = trim(face);
            if let Some(trim) = &trim {
                cut_off(trim, &mut all, first, seal > 0.0);
            }
            faces.push(Face::new(&net, rational, trim));
            exact.push(net);
        }
        if all.is_empty() {
            return None;
        }
        let seal = scale2(seal, -scale);
        let around = Vec3::new(seal, seal, seal);
        let boxes: Vec<Aabb> = all.iter().map(|(_, bounds)| bounds.expanded(around)).collect();
        let (tree, order) = BoxTree::new(&boxes);
        let units = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let room = Vec3::new(1.0, 1.0, 1.0) * (4.0 * U);
        let back = |p: Point3| centre + p.to_vec().map(|x| scale2(x, scale));
        let units = units.expanded(room);
        let bounds = Aabb::new(back(units.min), back(units.max));
        let room = Vec3::new(1.0, 1.0, 1.0) * (4.0 * U * bounds.magnitude());
        let bounds =
            bounds.expanded(room).intersection(hull.expanded(room + around.map(|x| scale2(x, scale))));
        let cells = order.iter().map(|&i| all[i as usize].0.clone()).collect();
        Some(Self {
            bounds,
            centre,
            scale,
            reach,
            rational,
            faces: faces.into(),
            nets: exact.into(),
            cells,
            tree,
            is_closed: false,
            seal,
        })
    }

    /// Points that trims certainly keep, with their faces. They are from a lattice that avoids the
    /// lines about which a face is likely to be symmetric.
    pub(super) fn kept_points(&self) -> impl Iterator<Item = (usize, Point3)> + '_ {
        const LATTICE: usize = 7;
        let at = |k: usize| (k as f64 + 0.37) / LATTICE as f64;
        let uvs = move || (0..LATTICE * LATTICE).map(move |k| [at(k / LATTICE), at(k % LATTICE)]);
        self.faces.iter().enumerate().flat_map(move |(number, face)| {
            let stays = |uv: &[f64; 2]| face.trim.as_ref().is_none_or(|t| t.keeps(*uv, [U; 2]) == Some(true));
            uvs()
                .filter(stays)
                .take(4)
                .map(move |uv| (number, self.centre + face.jet(uv).p.map(|x| scale2(x, self.scale))))
        })
    }

    /// Passes all crossings to `sink`, ascending.
    #[inline(never)]
    pub(crate) fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || self.roots(ray, sink),
        );
    }

    #[inline(always)]
    fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let at = ray.recentre(self.centre, self.scale).sharp(1.0);
        let mut lists = LISTS.take();
        let (before, mut unproven) = (steps::before(), 0);
        let mut is_ended = ControlFlow::Continue(());
        lists.ahead = Ahead::default();
        if self.seal > 0.0 {
            self.meet_sealed(&at, &mut lists);
        } else {
            let window = |limit: f64| at.window((ray.t_min, ray.t_max.min(limit)));
            let range = window(sink.limit());
            is_ended = self.meet::<false>(&at, &mut lists, range, |lists, near| {
                self.send(&at, lists, near, sink)?;
                ControlFlow::Continue(window(sink.limit()).1)
            });
        }
        let sent = lists.ahead.sent;
        if is_ended.is_continue() && !lists.found.is_empty() {
            self.distinct(&mut lists.found);
            if self.is_closed && self.seal == 0.0 && is_in_doubt(&mut lists.found, |f| self.has_on_edge(f)) {
                lists.ahead.close();
                let line = (f64::NEG_INFINITY, f64::INFINITY);
                let _ =
                    self.meet::<false>(&at, &mut lists, line, |_, _| ControlFlow::Continue(f64::INFINITY));
                self.distinct(&mut lists.found);
                decide(&mut lists.found, 1, |f| self.has_on_edge(f), |_| 0.0);
            }
            if !self.is_closed && lists.found.iter().any(|found| found.sign == 0) {
                self.add_signs(&at, &mut lists.found);
            }
            lists.found.retain(|found| found.s > sent);
            unproven = self.pour(&at, &lists.found, sink).1;
        }
        steps::done(before, unproven);
        LISTS.set(lists);
    }

    /// Passes on the crossings that no cell from `near` on can change.
    #[inline(always)]
    fn send(
        &self,
        at: &CentredRay<'_>,
        lists: &mut Lists,
        near: f64,
        sink: &mut dyn Sink,
    ) -> ControlFlow<()> {
        let Lists { found, early, ahead, .. } = lists;
        let count = ahead.known(found, near);
        if count == 0 {
            return ControlFlow::Continue(());
        }
        early.clear();
        early.extend_from_slice(&found[..count]);
        self.distinct(early);
        if is_in_doubt(early, |f| self.has_on_edge(f))
            && (self.is_closed || early.iter().any(|f| f.sign == 0))
        {
            ahead.close();
            return ControlFlow::Continue(());
        }
        ahead.send(found, count, near);
        self.pour(at, early, sink).0
    }

    /// Adds up the signs of what unproven crossings represent, and joins those that are too near each
    /// other for sums of their own. At trims, and where faces share an edge, no sum is known.
    #[cold]
    #[inline(never)]
    fn add_signs(&self, at: &CentredRay<'_>, found: &mut Vec<Found>) {
        let line = Line::new(at);
        let exact = Exact::new(at, &self.nets, line.axes);
        let mut i = 0;
        while i < found.len() {
            let own = &found[i];
            let face = &self.faces[own.face as usize];
            if own.sign != 0 || own.is_shared || face.trim.is_some() {
                i += 1;
                continue;
            }
            let places: Vec<_> = found.iter().map(Found::place).collect();
            let is_reversed = (line.d_z < 0.0) != face.is_turned;
            let sum_in = |around: &_| {
                let turns = turns_around(&exact, own.face, around)?;
                // Beyond the third side of a triangle the map goes on: if it has none there, or as many in
                // either direction, the line may touch the side.
                let is_known = turns == 0 || !exact.is_cut(own.face, around);
                is_known.then_some(if is_reversed { -turns } else { turns })
            };
            match sum_of_signs(&places, i, &[[0.0, 1.0]; 2], [false; 2], sum_in) {
                Sum::Of(sum) => found[i].turn = sum,
                Sum::Near(j) | Sum::Across(j, _) if !found[j].is_shared => {
                    found[i] = found[i].joined(&found[j]);
                    found.swap_remove(j);
                    i = 0;
                    continue;
                }
                _ => {}
            }
            i += 1;
        }
    }

    /// Passes crossings to `sink`, ascending. Returns how many of them are unproven, too.
    #[inline(always)]
    fn pour(&self, at: &CentredRay<'_>, found: &[Found], sink: &mut dyn Sink) -> (ControlFlow<()>, usize) {
        let (mut roots, mut unproven) = (Sorted::new(), 0);
        for crossing in found {
            let tag = self.faces[crossing.face as usize].clamped(crossing.uv);
            if let Some(root) = root(at, crossing, tag) {
                unproven += usize::from(root.kind != RootKind::Simple);
                roots.push(root);
            }
        }
        // Alternation has decided the order of a solid's crossings.
        let is_in_turn = self.is_closed && self.seal == 0.0;
        (if is_in_turn { roots.pour_in_turn(sink) } else { roots.pour(sink) }, unproven)
    }

    /// Finds the crossings in a range of the line, with duplicates: of the trimmed faces and, if
    /// `SEALED`, also those outside within the seal's width. Calls `send` with the start of the
    /// next cell whenever crossings before it may be final; `send` returns the present end of the
    /// range.
    #[inline(always)]
    pub(super) fn meet<const SEALED: bool>(
        &self,
        at: &CentredRay<'_>,
        lists: &mut Lists,
        (begin, end): (f64, f64),
        mut send: impl FnMut(&mut Lists, f64) -> ControlFlow<(), f64>,
    ) -> ControlFlow<()> {
        let along = Along::new(at);
        let mut window = [begin - ROOM, end + ROOM];
        let line = Line::new(at);
        let exact = Exact::new(at, &self.nets, line.axes);
        let is_open = !self.is_closed && !SEALED;
        lists.found.clear();
        lists.off.clear();
        self.tree.begin(&mut lists.open);
        while let Some((near, number)) = self.tree.next(&along, window, &mut lists.open) {
            if near > lists.ahead.due {
                window[1] = send(lists, near)? + ROOM;
                if near > window[1] {
                    break;
                }
            }
            let Lists { found, off, ahead, .. } = lists;
            let (cell, first) = (&self.cells[number], found.len());
            let room = if SEALED { EDGE } else { 0.0 };
            let mut view = View::new(&line, cell, self.rational);
            view.is_open = is_open;
            view.meet(&exact, found, room);
            if self.faces[cell.face as usize].is_turned {
                for f in &mut found[first..] {
                    (f.sign, f.turn) = (-f.sign, -f.turn);
                }
            }
            if SEALED {
                self.sort_out(cell, found, first, off);
            } else if cell.trimmed == Trimmed::Across {
                self.trim(found, first);
            }
            ahead.note(&found[first..]);
        }
        ControlFlow::Continue(())
    }
}

/// Whether the box of `a` lies where `b` is the only crossing.
#[inline(always)]
pub(super) fn is_held(a: &Found, b: &Found) -> bool {
    (0..2).all(|k| (a.uv[k] - b.uv[k]).abs() + a.radius[k] < b.alone[k])
}

/// Whether two boxes have a point in common.
#[inline(always)]
pub(super) fn overlap(a: &Found, b: &Found) -> bool {
    (0..2).all(|k| (a.uv[k] - b.uv[k]).abs() <= a.radius[k] + b.radius[k])
}

impl Shell {
    /// Removes crossings, from index `first` on, that trims certainly cut off. One that may be cut
    /// off becomes unproven.
    fn trim(&self, found: &mut Vec<Found>, first: usize) {
        let mut kept = first;
        for i in first..found.len() {
            let mut f = found[i];
            let trim = self.faces[f.face as usize].trim.as_ref();
            match trim.map_or(Some(true), |trim| trim.keeps(f.uv, f.radius)) {
                Some(false) => continue,
                Some(true) => {}
                None => (f.on_trim, f.sign, f.alone) = (true, 0, [0.0; 2]),
            }
            found[kept] = f;
            kept += 1;
        }
        found.truncate(kept);
    }

    /// Whether crossings of two patches are one crossing on a shared edge: at the same place of the
    /// line, in the same direction, and one of them may be on an edge. The other may be well within
    /// its own patch, because the search goes a little beyond edges.
    #[inline(always)]
    fn is_shared(&self, a: &Found, b: &Found) -> bool {
        a.turn == b.turn
            && (a.s - b.s).abs() <= a.s_err + b.s_err
            && (self.has_on_edge(a) || self.has_on_edge(b))
    }

    /// Whether a crossing may be on an edge of its face.
    #[inline(always)]
    fn has_on_edge(&self, f: &Found) -> bool {
        self.faces[f.face as usize].has_on_edge(f)
    }

    /// Joins duplicates: a crossing found in two cells on their common border, and unproven boxes
    /// that touch each other.
    #[inline(always)]
    pub(super) fn distinct(&self, found: &mut Vec<Found>) {
        if found.len() > 1 {
            // Proven ones first.
            found.sort_by_key(|f| f.sign == 0);
            let mut kept = 0;
            for i in 0..found.len() {
                let new = found[i];
                let same = |old: &Found| {
                    if old.face == new.face {
                        is_held(&new, old) || is_held(old, &new) || overlap(&new, old)
                    } else {
                        self.is_shared(&new, old)
                    }
                };
                match found[..kept].iter().position(same) {
                    Some(k) => {
                        let old = &mut found[k];
                        let is_other = old.face != new.face;
                        let known = is_other || is_held(&new, old) || is_held(old, &new);
                        // Next to a crease an unproven bracket may hold more crossings than the one
                        // of the other side. For a closed surface alternation decides.
                        let is_open = !self.is_closed && self.seal == 0.0;
                        let more = is_open && is_other && new.sign == 0 && !new.is_zero;
                        if old.sign == 0 || !known || more {
                            // It is unknown whether that is one crossing or two.
                            *old = old.joined(&new);
                        } else if new.sign != 0 && is_other {
                            *old = old.united(&new, |f| self.has_on_edge(f));
                        } else if new.sign != 0 && new.s_err < old.s_err {
                            // Keep the sharper of two proofs.
                            *old = new;
                        }
                    }
                    None => {
                        found[kept] = new;
                        kept += 1;
                    }
                }
            }
            found.truncate(kept);
            join_all(found);
        }
    }
}

/// Marks cells, from index `first` on, that are cut off or that a trim passes through. The former
/// are removed unless `stay` is set.
fn cut_off(trim: &FaceTrim, all: &mut Vec<(Cell, Aabb)>, first: usize, stay: bool) {
    let mut number = 0;
    all.retain_mut(|(cell, _)| {
        number += 1;
        if number <= first {
            return true;
        }
        let half = cell.width.map(|w| 0.5 * w);
        cell.trimmed = match trim.keeps([0, 1].map(|k| cell.from[k] + half[k]), half) {
            Some(true) => Trimmed::Not,
            Some(false) => Trimmed::Off,
            None => Trimmed::Across,
        };
        stay || cell.trimmed != Trimmed::Off
    });
}

/// Joins unproven boxes until none touches another.
fn join_all(found: &mut Vec<Found>) {
    let mut changed = true;
    while changed {
        changed = false;
        let mut i = 0;
        while i < found.len() {
            let other = (i + 1..found.len()).find(|&j| {
                let (a, b) = (&found[i], &found[j]);
                a.sign == 0 && b.sign == 0 && a.face == b.face && overlap(a, b)
            });
            match other {
                Some(j) => {
                    found[i] = found[i].joined(&found[j]);
                    found.swap_remove(j);
                    changed = true;
                }
                None => i += 1,
            }
        }
    }
}

/// A crossing in the caller's parameter, with its parameters on the surface; `None` if it is not in
/// the ray's range.
#[inline(always)]
pub(super) fn root(at: &CentredRay<'_>, found: &Found, tag: [f64; 2]) -> Option<Root> {
    root_at(at, (found.s, found.s_err), (found.face, tag), (found.sign, found.turn))
}

/// The root of a crossing at `s`, on a face at the parameters `tag`, with its sign (0 if unproven)
/// and the side to which it leads in any case; `None` if it is not in the ray's range.
#[inline(always)]
pub(crate) fn root_at(
    at: &CentredRay<'_>,
    (s, s_err): (f64, f64),
    (face, tag): (u32, [f64; 2]),
    (sign, turn): (i8, i8),
) -> Option<Root> {
    let (lo, hi) = at.bracket((s - s_err).next_down(), (s + s_err).next_up());
    match at.admits(lo, hi) {
        Some(false) => return None,
        // A ray that was spawned on the face starts off it: a bracket that holds the start is the
        // start itself.
        None if lo <= 0.0 && at.spawned().is_some_and(|(_, own, _)| own == face) => return None,
        _ => {}
    }
    let (kind, sign) = match (sign, turn) {
        (0, 0) => (RootKind::Grazing, 0),
        (0, turn) => (RootKind::Cluster, turn),
        (sign, _) => (RootKind::Simple, sign),
    };
    Some(Root { t: at.t(s).max(lo).min(hi), lo, hi, s, tag, face, sign, kind })
}

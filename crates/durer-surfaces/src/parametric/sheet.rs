//! Maps of rectangles as one surface: their pieces in a tree, and all crossings of a ray, each once.

use super::build::{self, Refused};
use super::crossings::{Edges, distinct, joined_across, root, united};
use super::degree::turns_around;
use super::line::{Found, NOWHERE, View};
use super::piece::{Face, Piece, Unit};
use super::{Bounds, subdivide};
use crate::blob::{Along, Inner, Tree};
use crate::degree::{Sum, sum_of_signs};
use crate::mesh::Sorted;
use crate::patch::line::Line;
use crate::patch::shell::FaceTrim;
use crate::{CentredRay, LocalRay, Sink, steps};
use core::cell::Cell as Slot;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Point3, U, Vec3};
use durer_roots::two_unknowns::Content;

/// Pieces farther than this from the ray's range, in units, are skipped. The bracket of a proven
/// crossing is far narrower.
const ROOM: f64 = 1.0 / 1024.0;

/// Maps in units about a common centre.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) faces: Box<[Face]>,
    pub(super) bounds: Aabb,
    pub(super) centre: Point3,
    pub(super) unit: Unit,
    /// The radius of a ball about the centre that holds everything.
    pub(super) reach: f64,
    /// The bounds that cut it, in units.
    pub(super) cut: Bounds,
    gap: f64,
    /// The maps whose normals point the other way; none if it is empty.
    turned: Box<[bool]>,
    /// The trims of each map; empty for a surface without trims.
    trims: Box<[Option<FaceTrim>]>,
    /// In the order of the tree.
    pieces: Box<[Piece]>,
    tree: Tree,
}

/// Lists of one ray. The thread keeps them so that rays do not allocate.
#[derive(Default)]
struct Lists {
    nodes: Vec<u32>,
    found: Vec<Found>,
}

thread_local! {
    static LISTS: Slot<Lists> = Slot::default();
}

impl Sheet {
    /// The part of the sheet of these maps within `bounds`; `None` if it is empty.
    ///
    /// Edges of maps that coincide are within `gap` of each other, in units, plus the formulas'
    /// errors there. An error names the map that is refused.
    pub(super) fn new(faces: Vec<Face>, bounds: &Bounds, gap: f64) -> Result<Option<Self>, (u32, Refused)> {
        let mut all = build::all_pieces(&faces, bounds)?;
        let box_of = |piece: &Piece| {
            let end = |of: fn(&durer_math::Interval) -> f64| {
                let [x, y, z] = [0, 1, 2].map(|c| of(&piece.hull[c]));
                Point3::new(x, y, z)
            };
            Aabb::new(end(|x| x.lo), end(|x| x.hi))
        };
        let hull = all.iter().fold(Aabb::EMPTY, |hull, piece| hull.union(box_of(piece)));
        let bounds_box = hull.intersection(bounds.hull());
        if bounds_box.is_empty() {
            return Ok(None);
        }
        let centre = bounds_box.centre();
        let reach = bounds_box.reach_from(centre);
        if !(reach > 0.0 && reach.is_finite()) {
            return Ok(None);
        }
        let unit = Unit { centre: [centre.x, centre.y, centre.z], scale: exponent(reach) + 1 };
        for piece in &mut all {
            *piece = piece.in_units(&unit);
        }
        let cut = bounds.in_units(&unit);
        // Each side of a common edge is off by this.
        let off = all.iter().map(|piece| piece.edge_error(&faces[piece.face as usize])).fold(0.0, f64::max);
        let gap = gap + 2.0 * off;
        let boxes: Vec<Aabb> = all.iter().map(box_of).map(|held| held.intersection(cut.hull())).collect();
        let (tree, order) = Tree::new(&boxes);
        let pieces = order.iter().map(|&i| all[i as usize]).collect();
        let room = Vec3::new(1.0, 1.0, 1.0) * (4.0 * U * bounds_box.magnitude());
        let bounds = bounds_box.expanded(room);
        Ok(Some(Self {
            faces: faces.into(),
            bounds,
            centre,
            unit,
            reach,
            cut,
            gap,
            turned: Box::default(),
            trims: Box::default(),
            pieces,
            tree,
        }))
    }

    /// The sheet with the normals of some maps turned and parts of maps cut out.
    pub(super) fn with_sides(mut self, turned: Vec<bool>, trims: Vec<Option<FaceTrim>>) -> Self {
        (self.turned, self.trims) = (turned.into(), trims.into());
        self
    }

    /// Whether the normal of a map points the other way.
    pub(super) fn is_turned(&self, face: u32) -> bool {
        self.turned.get(face as usize) == Some(&true)
    }

    /// A length in units.
    pub(super) fn back(&self, x: f64) -> f64 {
        scale2(x, self.unit.scale)
    }

    /// A length in units, of one that is not.
    pub(super) fn in_units(&self, x: f64) -> f64 {
        scale2(x, -self.unit.scale)
    }

    /// Passes all crossings with the maps that `wanted` names to `sink`, ascending.
    pub(super) fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink, wanted: impl Fn(u32) -> bool) {
        let range = (ray.t_min, ray.t_max.min(sink.limit()));
        self.with_found(ray, range, |at, found| {
            let mut roots = Sorted::new();
            for crossing in found.iter().filter(|found| wanted(found.face)) {
                if let Some(root) = root(at, crossing) {
                    roots.push(root);
                }
            }
            let _ = roots.pour(sink);
        });
    }

    /// Calls `f` with all crossings of a ray's line, if there are any.
    pub(super) fn with_all(&self, ray: &LocalRay<'_>, f: impl FnOnce(&CentredRay<'_>, &[Found])) {
        self.with_found(ray, (f64::NEG_INFINITY, f64::INFINITY), f);
    }

    fn with_found(&self, ray: &LocalRay<'_>, range: (f64, f64), f: impl FnOnce(&CentredRay<'_>, &[Found])) {
        let at = ray.recentre(self.centre, self.unit.scale).sharp(1.0);
        let mut lists = LISTS.take();
        let before = steps::before();
        self.meet(&at, &mut lists, range);
        let mut unproven = 0;
        if !lists.found.is_empty() {
            let found = &mut lists.found;
            distinct(found, Edges { faces: &self.faces, unit: &self.unit, gap: self.gap });
            if found.iter().any(|found| found.sign == 0) {
                self.add_signs(&Line::new(&at), found);
            }
            unproven = found.iter().filter(|found| found.sign == 0).count();
            f(&at, found);
        }
        steps::done(before, unproven);
        LISTS.set(lists);
    }

    fn meet(&self, at: &CentredRay<'_>, lists: &mut Lists, range: (f64, f64)) {
        let along = Along::new(at);
        let (begin, end) = at.window(range);
        let (begin, end) = (begin - ROOM, end + ROOM);
        let line = Line::new(at);
        let Lists { nodes, found } = lists;
        nodes.clear();
        found.clear();
        nodes.push(0);
        while let Some(node) = nodes.pop() {
            let Some((near, far)) = self.tree.entry(node, &along) else { continue };
            if far < begin || near > end {
                continue;
            }
            match self.tree.inner(node) {
                Inner::Nodes(a, b) => {
                    nodes.push(a);
                    nodes.push(b);
                }
                Inner::Leaf(from, to) => {
                    for piece in &self.pieces[from..to] {
                        self.meet_piece(&line, piece, found);
                    }
                }
            }
        }
    }

    fn meet_piece(&self, line: &Line, piece: &Piece, found: &mut Vec<Found>) {
        let view = self.view(line, piece.face);
        let first = found.len();
        match view.content(piece) {
            Content::Nothing => {}
            Content::AtMostOne(start) => {
                if !view.meet_at_most_one(piece, start, found) {
                    subdivide::meet(&view, piece, found);
                }
            }
            Content::Unknown => subdivide::meet(&view, piece, found),
        }
        if found.len() > first {
            self.finish(piece.face, found, first);
        }
    }

    /// Adds up the signs of what unproven crossings represent, and joins those that are too near each
    /// other for sums of their own. At trims no sum is known.
    #[cold]
    #[inline(never)]
    fn add_signs(&self, line: &Line, found: &mut Vec<Found>) {
        let mut i = 0;
        while i < found.len() {
            let face = found[i].face;
            if found[i].sign == 0 && !matches!(self.trims.get(face as usize), Some(Some(_))) {
                let places: Vec<_> = found.iter().map(Found::place).collect();
                let view = self.view(line, face);
                let is_reversed = (line.d_z < 0.0) != self.is_turned(face);
                let sum_in = |around: &_| {
                    turns_around(&view, around).map(|turns| if is_reversed { -turns } else { turns })
                };
                let (domain, has_seam) = (&view.face.domain, view.face.has_seam);
                let both = match sum_of_signs(&places, i, domain, has_seam, sum_in) {
                    Sum::Of(sum) => {
                        found[i].turn = sum;
                        None
                    }
                    Sum::Unknown => None,
                    Sum::Near(j) => Some((j, united(&found[i], &found[j]))),
                    Sum::Across(j, size) => Some((j, joined_across(&found[i], &found[j], size))),
                };
                if let Some((j, both)) = both {
                    found[i] = both;
                    found.swap_remove(j);
                    i = 0;
                    continue;
                }
            }
            i += 1;
        }
    }

    fn view<'a>(&'a self, line: &'a Line, face: u32) -> View<'a> {
        View { line, face: &self.faces[face as usize], unit: &self.unit, cut: &self.cut }
    }

    /// Leaves out crossings of a map, from the first of these on, that are cut off, and turns the
    /// others with the map.
    fn finish(&self, face: u32, found: &mut Vec<Found>, first: usize) {
        if self.is_turned(face) {
            for found in &mut found[first..] {
                (found.sign, found.turn) = (-found.sign, -found.turn);
            }
        }
        let Some(Some(trim)) = self.trims.get(face as usize) else { return };
        let mut kept = first;
        for i in first..found.len() {
            let mut crossing = found[i];
            match trim.keeps(crossing.uv, crossing.radius) {
                Some(false) => continue,
                Some(true) => {}
                None => (crossing.sign, crossing.only) = (0, NOWHERE),
            }
            found[kept] = crossing;
            kept += 1;
        }
        found.truncate(kept);
    }
}

//! What a ray meets of a body.
//!
//! Leaves stand in one tree, whatever the operators between them, and each has there the box in
//! which it matters (`Tree::where_leaves_matter`): a ray that passes by it is outside of the leaf,
//! or where some node above the leaf does not hold anyway. So what is not asked changes nothing.
//!
//! Whoever wants all crossings gets them from all leaves that the ray meets. Whoever wants the
//! first one goes through many leaves piece by piece, each piece of the way twice as long as the
//! one before: where a piece ends, leaves that were not met before it have no crossing before it,
//! but for the width of enclosures, and the walk along the crossings goes as far.

use super::Compound;
use super::sweep::{Crossing, Event, Scratch, partners};
use crate::arena::Filter;
use crate::geometry::slots;
use crate::ids::{EVERYTHING, Id};
use core::cell::RefCell;
use core::ops::Range;
use durer_bvh::{Leaf, Ray64};
use durer_math::{Isa, RaySide};
use durer_surfaces::{Flow, LocalRay, Need, Root, SurfacePoint};

/// A root of the body, as a geometry's queries take it.
pub(super) struct Found {
    /// The slot of the leaf's surface among all of the compound.
    pub(super) slot: u32,
    /// Whether the body's normal is the leaf's turned round.
    pub(super) turned: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
    /// The primitive, counted from the compound's first.
    pub(super) primitive: u32,
    /// The leaf's root with the body's sign.
    pub(super) root: Root,
}

thread_local! {
    /// Each thread's memory for walks along rays.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Lends the thread's working memory. Whoever asks while it is lent, as a visitor of crossings that
/// resolves one of them does, gets memory of its own.
fn with_scratch<R>(f: impl FnOnce(&mut Scratch) -> R) -> R {
    let mut scratch = SCRATCH.take();
    let result = f(&mut scratch);
    SCRATCH.set(scratch);
    result
}

/// Where on a body a ray starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// The slot among all of the compound.
    pub(super) slot: u32,
    /// The side of that leaf's own surface.
    pub(super) side: RaySide,
    /// Whether that is inside the body.
    pub(super) inside: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
}

/// Far more than an enclosure's ends are away from the exact crossing, in units of `|t| + size`:
/// that is 32 ulp, and what is wider is computed again in double-double.
const MARGIN: f64 = durer_math::scale::pow2(-40);

/// A ray, asked ahead of its start.
struct Asked<'a> {
    isa: Isa,
    ahead: LocalRay<'a>,
    /// Arena and slot of the leaf that it starts on, and the side.
    from: Option<((u32, u32), RaySide)>,
}

impl Asked<'_> {
    fn side_of(&self, arena: u32, slot: u32) -> Option<RaySide> {
        self.from.filter(|(place, _)| *place == (arena, slot)).map(|from| from.1)
    }
}

/// The pieces of a way, in the tree's parameter, each twice as long as the one before.
struct Pieces {
    end: f64,
    length: f64,
    /// Where the ray has left the tree.
    leave: f64,
}

impl Compound {
    /// Shows the crossings of the body in the ray's range, ascending, until `show` has enough; says
    /// whether the ray starts inside.
    pub(super) fn trace(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        show: &mut dyn FnMut(Found) -> Flow,
    ) -> bool {
        // In one piece nothing can be split.
        with_scratch(|scratch| self.walk(isa, ray, from, f64::INFINITY, None, scratch, show).unwrap_or(false))
    }

    /// Shows the first crossing of the body in the ray's range, if there is one; what begins behind
    /// `until` need not be shown.
    pub(super) fn first(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        until: f64,
        show: &mut dyn FnMut(Found),
    ) {
        let mut take = |found| {
            show(found);
            Flow::Stop
        };
        let pieces = if self.by_pieces { self.pieces(ray, until) } else { None };
        with_scratch(|scratch| {
            if self.walk(isa, ray, from, until, pieces, scratch, &mut take).is_none() {
                // Something wide reaches over the end of a piece. Nothing has been shown.
                self.walk(isa, ray, from, until, None, scratch, &mut take);
            }
        });
    }

    /// Walks along the ray; `None` if a crossing may belong on both sides of where a piece ended.
    #[expect(clippy::too_many_arguments, reason = "one walk for two queries")]
    fn walk(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        until: f64,
        mut pieces: Option<Pieces>,
        scratch: &mut Scratch,
        show: &mut dyn FnMut(Found) -> Flow,
    ) -> Option<bool> {
        let whole = self.line(ray, until);
        let asked = self.begin(isa, ray, from, scratch);
        let (mut begin, mut known) = (whole.t_min, f64::NEG_INFINITY);
        let (mut inside, mut astray) = (false, false);
        let limit = ray.t_max.min(until);
        loop {
            let end = pieces.as_mut().and_then(Pieces::next_end).filter(|&end| end < whole.t_max);
            let piece = Ray64 { t_min: begin, t_max: end.unwrap_or(whole.t_max), ..whole };
            self.gather(&asked, &piece, scratch);
            if known == f64::NEG_INFINITY {
                inside = scratch.starts_inside(&self.tree);
                // On an edge where leaves meet the ray's start is on the right side of one of them
                // only.
                astray = from.is_some_and(|start| start.tied && start.inside != inside);
            } else if scratch.is_split_at(known) {
                return None;
            } else {
                scratch.start_more(&self.tree);
            }
            known = end.map_or(f64::INFINITY, |end| {
                let s = (end.abs() + self.size).mul_add(-MARGIN, end);
                ray.unmoved().bracket(s, s).0
            });
            let go_on = scratch.sweep(
                &self.tree,
                known,
                |leaf| self.traits[leaf as usize].sense,
                |event| self.traits[event.leaf as usize].shown.holds(event.root.face),
                |crossing| {
                    if crossing.event.root.lo > limit {
                        return Flow::Stop;
                    }
                    if core::mem::take(&mut astray) && self.starts_at(isa, ray, &crossing.event) {
                        inside = !inside;
                        return Flow::Continue;
                    }
                    match self.in_range(isa, ray, crossing) {
                        Some(root) => show(self.found(crossing, root)),
                        None => Flow::Continue,
                    }
                },
            );
            match end {
                Some(end) if go_on => begin = end,
                _ => return Some(inside),
            }
        }
    }

    /// The ray as the tree of the leaves sees it.
    fn line(&self, ray: &LocalRay<'_>, until: f64) -> Ray64 {
        // All that a ray crosses of a leaf in parts tells where it starts.
        let end = if self.in_parts { f64::INFINITY } else { ray.t_max.min(until) };
        let (near, mut far) = ray.unmoved().window((ray.t_min, end));
        if end < ray.t_max {
            // The neighbours of what reaches over the end.
            far = (far.abs() + self.size).mul_add(MARGIN, far);
        }
        Ray64 {
            origin: ray.o,
            direction: ray.d,
            origin_error: ray.o_err,
            direction_error: ray.d_err,
            t_min: near,
            t_max: far,
            inner: (near, far),
        }
    }

    /// The pieces of the ray's way through the leaves; `None` if it is not known where that begins
    /// and ends.
    fn pieces(&self, ray: &LocalRay<'_>, until: f64) -> Option<Pieces> {
        let line = self.line(ray, until);
        let bounds = self.leaves.tree.bounds();
        // What lies before and behind belongs to the first and the last piece, so this need not be
        // exact.
        let (enter, leave) = bounds.slabs(line.origin, line.direction, line.t_min, line.t_max)?;
        // Leaves that fill a square are so far apart.
        let length = bounds.widths().max_abs() / (self.traits.len() as f64).sqrt();
        let pieces = Pieces { end: enter, length, leave };
        (enter.is_finite() && leave.is_finite() && length > 0.0).then_some(pieces)
    }

    /// Begins with a ray: asks the leaves that stand in no tree.
    fn begin<'a>(
        &self,
        isa: Isa,
        ray: &LocalRay<'a>,
        from: Option<Start>,
        scratch: &mut Scratch,
    ) -> Asked<'a> {
        scratch.begin(self.traits.len());
        let mut ahead = ray.from_side(None);
        // What lies behind the range tells where a leaf is in it.
        (ahead.t_max, ahead.rough) = (f64::INFINITY, false);
        let asked = Asked { isa, ahead, from: from.map(|start| (self.place(start.slot), start.side)) };
        for beside in &self.leaves.beside {
            self.visit(&asked, beside.leaf(), scratch);
        }
        asked
    }

    /// Gathers the crossings of the leaves in whose boxes a line is, those of each leaf once and
    /// all of them.
    fn gather(&self, asked: &Asked<'_>, line: &Ray64, scratch: &mut Scratch) {
        let visit = |leaf| {
            self.visit(asked, leaf, scratch);
            false
        };
        self.leaves.tree.each(asked.isa, line, visit);
    }

    /// Asks some slots that were not asked before.
    fn visit(&self, asked: &Asked<'_>, leaf: Leaf, scratch: &mut Scratch) {
        if !self.one_by_one {
            return self.ask(asked, leaf.kind, slots(&leaf), scratch);
        }
        let arena = self.arena(leaf.kind);
        for slot in slots(&leaf) {
            let of = arena.name(slot).object;
            let traits = self.traits[of as usize];
            // A leaf may be in several pieces of the way.
            if self.by_pieces && !scratch.is_new(of) {
                continue;
            }
            self.ask(asked, leaf.kind, slot..slot + 1, scratch);
            if traits.is_endless && !scratch.is_crossed(of) {
                let side = asked.side_of(leaf.kind, slot);
                if arena.starts_inside(slot, &asked.ahead.from_side(side)) {
                    scratch.start_inside(of);
                }
            }
        }
    }

    fn ask(&self, asked: &Asked<'_>, arena: u32, slots: Range<u32>, scratch: &mut Scratch) {
        let source = asked.from.filter(|(place, _)| place.0 == arena).map(|(place, side)| (place.1, side));
        let filter = Filter { mask: EVERYTHING, source };
        let mut take = |slot, id: Id, root| {
            scratch.push(id.object, self.traits[id.object as usize].sense, (arena, slot), root);
            Flow::Continue
        };
        self.arena(arena).each(asked.isa, slots, &asked.ahead, &filter, &mut take);
    }

    /// Whether a ray starts so near to a surface that it crosses that nothing but rounding is
    /// between.
    #[cold]
    fn starts_at(&self, isa: Isa, ray: &LocalRay<'_>, event: &Event) -> bool {
        let local = ray.from_side(None);
        let q = self.arena(event.arena).resolve(isa, event.slot, &local, &event.root, Need::POINT);
        let start = ray.point_at_start();
        let way = q.p - start;
        let height = q.ng.to_vec().dot(way).abs();
        // Starts are at most a few roundings of their coordinates away from the point that was
        // meant, and that is as far from the surface.
        let spacing = start.to_vec().max_abs() * (64.0 * durer_math::U);
        height <= 4.0 * q.off + spacing + q.bend * way.dot(way)
    }

    /// The crossing's root if it is in the ray's range. Its start was looked at where the crossing
    /// was found.
    fn in_range(&self, isa: Isa, ray: &LocalRay<'_>, crossing: &Crossing) -> Option<Root> {
        let Event { root, arena, slot, .. } = crossing.event;
        if root.hi <= ray.t_max {
            return Some(root);
        }
        let mut found = None;
        let mut local = ray.from_side(None);
        local.rough = false;
        let filter = Filter { mask: EVERYTHING, source: None };
        let mut take = |_, _, r: Root| {
            if (r.s.to_bits(), r.face, r.sign) == (root.s.to_bits(), root.face, root.sign) {
                found = Some(r);
            }
            Flow::Continue
        };
        self.arena(arena).each(isa, slot..slot + 1, &local, &filter, &mut take);
        found
    }

    fn found(&self, crossing: &Crossing, root: Root) -> Found {
        let Event { arena, slot, leaf, .. } = crossing.event;
        let name = self.arena(arena).name(slot);
        Found {
            slot: self.first_slot[arena as usize] + slot,
            turned: if crossing.sign == 0 { self.tree.is_inverted(leaf) } else { crossing.sign != root.sign },
            tied: crossing.tied,
            primitive: name.primitive,
            root: Root { sign: crossing.sign, ..root },
        }
    }

    /// The point of a root.
    pub(super) fn resolve(
        &self,
        isa: Isa,
        slot: u32,
        (turned, tied): (bool, bool),
        ray: &LocalRay<'_>,
        root: &Root,
        need: Need,
    ) -> SurfacePoint {
        let turn = |side: RaySide| match (turned, side) {
            (false, side) => side,
            (true, RaySide::Front) => RaySide::Back,
            (true, RaySide::Back) => RaySide::Front,
        };
        let (arena, inner) = self.place(slot);
        let own = Root { sign: if turned { -root.sign } else { root.sign }, ..*root };
        let local = ray.from_side(ray.source.map(turn));
        let mut point = self.arena(arena).resolve(isa, inner, &local, &own, need);
        if tied {
            point.off = self.clear_of_partners(isa, (arena, inner), &local, &own, &point);
        }
        if turned {
            (point.ng, point.ns) = (-point.ng, -point.ns);
            (point.dndu, point.dndv) = (-point.dndu, -point.dndv);
        }
        point
    }

    /// A distance along the normal that leaves all surfaces behind which lie along the point's own
    /// and could not be told from it.
    ///
    /// Where `n` and `n'` are the normals here and of another surface, and `h` its height over this
    /// point along `n'`, a step `x n` leaves it if `x |n.n'| - |h|` is more than the other's own
    /// bound and what it bends away over the distance between its point and the end of the step. A
    /// surface that crosses this one at an angle is not left by going along `n`, but rays decide
    /// exactly on which side of it they are.
    #[cold]
    fn clear_of_partners(
        &self,
        isa: Isa,
        (arena, slot): (u32, u32),
        ray: &LocalRay<'_>,
        root: &Root,
        point: &SurfacePoint,
    ) -> f64 {
        let event = |e: &Event| (e.arena, e.slot, e.root.face, e.root.s.to_bits());
        let own = (arena, slot, root.face, root.s.to_bits());
        // All of them are near.
        let (near, far) = ray.unmoved().window((root.lo, root.hi));
        let more = |t: f64| (t.abs() + self.size) * MARGIN;
        let line =
            Ray64 { t_min: near - more(near), t_max: far + more(far), ..self.line(ray, f64::INFINITY) };
        with_scratch(|scratch| {
            let asked = self.begin(isa, ray, None, scratch);
            self.gather(&asked, &line, scratch);
            let mut off = point.off;
            for other in partners(scratch, &|e| event(e) == own) {
                let q = self.arena(other.arena).resolve(isa, other.slot, ray, &other.root, Need::POINT);
                let (n, m) = (point.ng.to_vec(), q.ng.to_vec());
                let along = n.dot(m).abs();
                let apart = (q.p - point.p).length();
                // Half: which surfaces lie along this one, and which cross it.
                if along >= 0.5 && q.bend.is_finite() {
                    let height = m.dot(q.p - point.p).abs();
                    let reach = apart + 2.0 * (point.off + q.off);
                    let away = q.bend * reach * reach;
                    off = off.max(
                        (height + 2.0 * q.off + away) / along * (1.0 + 64.0 * durer_math::U) + point.off,
                    );
                }
            }
            off
        })
    }
}

impl Pieces {
    /// Where the next piece ends; `None` for the last one.
    fn next_end(&mut self) -> Option<f64> {
        self.end += self.length;
        self.length *= 2.0;
        (self.end < self.leave).then_some(self.end)
    }
}

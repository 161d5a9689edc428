//! The search for a ray's crossings with a CSG solid.
//!
//! All leaves are in one tree, whatever the operators between them, each with the box in which it
//! matters (`Tree::where_leaves_matter`): a ray that misses the box is outside of the leaf, or some
//! node above the leaf does not hold anyway. So a leaf that is not tested changes nothing.
//!
//! A query for all crossings takes them from all leaves that the ray meets. A query for the first
//! crossing searches many leaves piece by piece, each piece of the ray twice as long as the one
//! before. Leaves that were not met before the end of a piece have no crossing before it, up to the
//! width of brackets, and the sweep along the crossings goes as far.

use super::Compound;
use super::sweep::{Crossing, Event, Scratch, partners};
use crate::arena::Filter;
use crate::geometry::slots;
use crate::ids::{EVERYTHING, Id};
use core::cell::RefCell;
use core::ops::ControlFlow;
use core::ops::Range;
use durer_bvh::{Leaf, Ray64};
use durer_math::{Isa, RaySide};
use durer_surfaces::{FirstCrossing, LocalRay, Need, Root, Sink, SurfacePoint};

/// A root of the CSG solid, in the form for a geometry's queries.
pub(super) struct Found {
    /// The slot of the leaf's surface, counted over all slots of the compound.
    pub(super) slot: u32,
    /// Whether the solid's normal is the leaf's, reversed.
    pub(super) turned: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
    /// The primitive, counted from the compound's first.
    pub(super) primitive: u32,
    /// The leaf's root with the solid's sign.
    pub(super) root: Root,
}

thread_local! {
    /// The thread's memory for sweeps along rays.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Lends the thread's working memory. A nested call, as by a visitor of crossings that resolves one
/// of them, gets memory of its own.
fn with_scratch<R>(f: impl FnOnce(&mut Scratch) -> R) -> R {
    let mut scratch = SCRATCH.take();
    let result = f(&mut scratch);
    SCRATCH.set(scratch);
    result
}

/// The start of a ray on a CSG solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// The slot, counted over all slots of the compound.
    pub(super) slot: u32,
    /// The side of that leaf's own surface.
    pub(super) side: RaySide,
    /// Whether the start is inside the CSG solid.
    pub(super) inside: bool,
    /// See [`Crossing::tied`].
    pub(super) tied: bool,
}

/// Far more than the distance of a bracket's ends from the exact crossing, in units of
/// `|t| + size`: that is 32 ulp, and wider brackets are computed again in double-double.
const MARGIN: f64 = durer_math::scale::pow2(-40);

/// A ray for tests of leaves, with its range extended ahead.
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

/// The pieces of a ray, in the tree's parameter, each twice as long as the one before.
struct Pieces {
    end: f64,
    length: f64,
    /// The parameter at which the ray has left the tree.
    leave: f64,
}

impl Compound {
    /// Passes the crossings of the solid in the ray's range to `show`, ascending, until it returns
    /// [`ControlFlow::Break`]; returns whether the ray starts inside.
    pub(super) fn trace(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        show: &mut dyn FnMut(Found) -> ControlFlow<()>,
    ) -> bool {
        // A single piece has no inner end at which a crossing could be split.
        with_scratch(|scratch| self.walk(isa, ray, from, f64::INFINITY, None, scratch, show).unwrap_or(false))
    }

    /// Whether a ray that starts on the solid's surface goes into the solid.
    pub fn enters(&self, ray: &LocalRay<'_>) -> bool {
        let mut first = FirstCrossing::default();
        self.trace(Isa::detect(), ray, None, &mut |found| first.push(found.root));
        first.enters()
    }

    /// Passes the first crossing of the solid in the ray's range to `show`, if there is one; a
    /// crossing that begins behind `until` may be left out.
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
            ControlFlow::Break(())
        };
        let pieces = if self.by_pieces { self.pieces(ray, until) } else { None };
        with_scratch(|scratch| {
            if self.walk(isa, ray, from, until, pieces, scratch, &mut take).is_none() {
                // A wide bracket contains the end of a piece. Nothing has been passed to `show`
                // yet.
                self.walk(isa, ray, from, until, None, scratch, &mut take);
            }
        });
    }

    /// Searches along the ray; `None` if a crossing may belong on both sides of the end of a piece.
    #[expect(clippy::too_many_arguments, reason = "one walk for two queries")]
    fn walk(
        &self,
        isa: Isa,
        ray: &LocalRay<'_>,
        from: Option<Start>,
        until: f64,
        mut pieces: Option<Pieces>,
        scratch: &mut Scratch,
        show: &mut dyn FnMut(Found) -> ControlFlow<()>,
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
                // On an edge where leaves meet, the ray's start is on the right side of one of them
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
                        return ControlFlow::Break(());
                    }
                    if core::mem::take(&mut astray) && self.starts_at(isa, ray, &crossing.event) {
                        inside = !inside;
                        return ControlFlow::Continue(());
                    }
                    match self.in_range(isa, ray, crossing) {
                        Some(root) => show(self.found(crossing, root)),
                        None => ControlFlow::Continue(()),
                    }
                },
            );
            match end {
                Some(end) if go_on => begin = end,
                _ => return Some(inside),
            }
        }
    }

    /// The ray in the form for the tree of the leaves.
    fn line(&self, ray: &LocalRay<'_>, until: f64) -> Ray64 {
        // For a leaf in parts all crossings are needed to decide whether the ray starts inside.
        let end = if self.in_parts { f64::INFINITY } else { ray.t_max.min(until) };
        let (near, mut far) = ray.unmoved().window((ray.t_min, end));
        if end < ray.t_max {
            // Includes the neighbours of a bracket that contains the end.
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

    /// The pieces of the ray within the leaves; `None` if their begin and end are not known.
    fn pieces(&self, ray: &LocalRay<'_>, until: f64) -> Option<Pieces> {
        let line = self.line(ray, until);
        let bounds = self.leaves.tree.bounds();
        // Need not be exact: what lies before and behind belongs to the first and the last piece.
        let (enter, leave) = bounds.slabs(line.origin, line.direction, line.t_min, line.t_max)?;
        // The distance between leaves that fill a square.
        let length = bounds.widths().max_abs() / (self.traits.len() as f64).sqrt();
        let pieces = Pieces { end: enter, length, leave };
        (enter.is_finite() && leave.is_finite() && length > 0.0).then_some(pieces)
    }

    /// Starts a ray: tests the leaves that are not in the tree.
    fn begin<'a>(
        &self,
        isa: Isa,
        ray: &LocalRay<'a>,
        from: Option<Start>,
        scratch: &mut Scratch,
    ) -> Asked<'a> {
        scratch.begin(self.traits.len());
        let mut ahead = ray.from_side(None);
        // The crossings behind the range help to decide where a leaf is within it.
        (ahead.t_max, ahead.rough) = (f64::INFINITY, false);
        let asked = Asked { isa, ahead, from: from.map(|start| (self.place(start.slot), start.side)) };
        for beside in &self.leaves.beside {
            self.visit(&asked, beside.leaf(), scratch);
        }
        asked
    }

    /// Collects all crossings of the leaves in whose boxes the segment is, each leaf once.
    fn gather(&self, asked: &Asked<'_>, line: &Ray64, scratch: &mut Scratch) {
        let visit = |leaf| {
            self.visit(asked, leaf, scratch);
            false
        };
        self.leaves.tree.each(asked.isa, line, visit);
    }

    /// Tests those of some slots that were not tested before.
    fn visit(&self, asked: &Asked<'_>, leaf: Leaf, scratch: &mut Scratch) {
        if !self.one_by_one {
            return self.ask(asked, leaf.kind, slots(&leaf), scratch);
        }
        let arena = self.arena(leaf.kind);
        for slot in slots(&leaf) {
            let of = arena.name(slot).object;
            let traits = self.traits[of as usize];
            // A leaf may be in several pieces of the ray.
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
            ControlFlow::Continue(())
        };
        let _ = self.arena(arena).each(asked.isa, slots, &asked.ahead, &filter, &mut take);
    }

    /// Whether a ray starts at a surface that it crosses, up to rounding.
    #[cold]
    fn starts_at(&self, isa: Isa, ray: &LocalRay<'_>, event: &Event) -> bool {
        let local = ray.from_side(None);
        let q = self.arena(event.arena).resolve(isa, event.slot, &local, &event.root, Need::POINT);
        let start = ray.point_at_start();
        let way = q.p - start;
        let height = q.ng.to_vec().dot(way).abs();
        // A start is at most a few roundings of its coordinates away from the intended point, and
        // that is as far from the surface.
        let spacing = start.to_vec().max_abs() * (64.0 * durer_math::U);
        height <= 4.0 * q.off + spacing + q.bend * way.dot(way)
    }

    /// The crossing's root if it is in the ray's range. The begin of the range was tested where the
    /// crossing was found.
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
            ControlFlow::Continue(())
        };
        let _ = self.arena(arena).each(isa, slot..slot + 1, &local, &filter, &mut take);
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

    /// A distance along the normal that leaves behind all surfaces that lie along the point's own
    /// and could not be distinguished from it.
    ///
    /// Where `n` and `n'` are the normals here and of another surface, and `h` its height over this
    /// point along `n'`, a step `x n` leaves it if `x |n.n'| - |h|` is more than the sum of the
    /// other's own bound and its deviation from its tangent plane over the distance between its
    /// point and the end of the step. A step along `n` does not leave a surface that crosses this
    /// one at an angle, but rays decide exactly on which side of it they are.
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
        // All of these surfaces are near.
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
                // One half separates surfaces along this one from those that cross it.
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
    /// The end of the next piece; `None` for the last one.
    fn next_end(&mut self) -> Option<f64> {
        self.end += self.length;
        self.length *= 2.0;
        (self.end < self.leave).then_some(self.end)
    }
}

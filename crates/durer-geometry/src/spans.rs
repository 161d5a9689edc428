//! Spans: the intervals of a ray inside the union of all solids.
//!
//! Each solid's crossings are turned into states by their signs. Whether the ray starts inside is
//! decided by the first sign; for solids that are not crossed, by the crossings outside the range
//! or by the exact side of a point. Then one sweep merges the solids: crossings whose brackets
//! overlap (transitively) form one group, all their bits are flipped, and only the union before and
//! after counts, so that touching bodies fuse and no skin of zero thickness appears (S. D. Roth,
//! "Ray casting for modeling solids", Computer Graphics and Image Processing 18, 1982; R. B.
//! Tilove, "Set membership classification", IEEE Transactions on Computers C-29, 1980).

use crate::arena::Filter;
use crate::closest::Placement;
use crate::ids::Id;
use crate::{ObjectId, ObjectSpan, Span};
use durer_surfaces::{PartId, Root};

/// A solid: placement, arena, surface.
type Key = (u32, u32, u32);

/// A crossing of a solid that changes sides.
#[derive(Clone, Copy, Debug)]
struct Event {
    solid: Key,
    t: f64,
    lo: f64,
    hi: f64,
    sign: i8,
    object: u32,
    part: u32,
}

/// Whether the ray starts inside a solid.
#[derive(Clone, Copy, Debug)]
struct Start {
    solid: Key,
    object: u32,
    inside: bool,
}

/// The crossings that a traversal collects, with their context.
pub(crate) struct Tracks {
    events: Vec<Event>,
    starts: Vec<Start>,
    pub(crate) placement: Placement,
    pub(crate) arena: u32,
    mask: u32,
    pub(crate) source: Option<(u32, durer_math::RaySide)>,
}

impl Tracks {
    pub(crate) fn new(mask: u32) -> Self {
        Self {
            events: Vec::new(),
            starts: Vec::new(),
            placement: Placement::default(),
            arena: 0,
            mask,
            source: None,
        }
    }

    pub(crate) fn filter(&self) -> Filter {
        Filter { mask: self.mask, source: self.source }
    }

    fn key(&self, surface: u32) -> Key {
        (self.placement.instance, self.arena, surface)
    }

    /// How many crossings there are so far.
    pub(crate) fn len(&self) -> usize {
        self.events.len()
    }

    /// Adds a crossing of a part of a solid. A touch has no length and is left out.
    pub(crate) fn push(&mut self, surface: u32, part: PartId, id: Id, root: &Root) {
        if root.sign != 0 {
            self.events.push(Event {
                solid: self.key(surface),
                t: root.t,
                lo: root.lo,
                hi: root.hi,
                sign: root.sign,
                object: self.placement.object.wrapping_add(id.object),
                part: part.0,
            });
        }
    }

    /// Records whether the ray starts inside a solid whose crossings do not decide it.
    pub(crate) fn start(&mut self, surface: u32, id: Id, inside: bool) {
        let object = self.placement.object.wrapping_add(id.object);
        self.starts.push(Start { solid: self.key(surface), object, inside });
    }

    /// Whether the crossings of a surface decide whether the ray starts inside.
    pub(crate) fn tell(&self, surface: u32) -> bool {
        let key = self.key(surface);
        self.events.iter().filter(|e| e.solid == key).map(|e| i32::from(e.sign)).sum::<i32>() != 0
    }

    /// [`Tracks::tell`] for a surface whose crossings are those from `first` on, ascending:
    /// overlapping ones count by their sum.
    pub(crate) fn tell_from(&self, first: usize) -> bool {
        overlapping(&self.events[first..]).any(|group| net(group) != 0)
    }

    /// The spans of each object.
    pub(crate) fn merge_by_object(mut self, t_min: f64, t_max: f64) -> Vec<ObjectSpan> {
        self.events.sort_by_key(|e| e.object);
        self.starts.sort_by_key(|s| s.object);
        let mut found = Vec::new();
        let (mut events, mut starts) = (self.events.as_slice(), self.starts.as_slice());
        loop {
            let next = events.first().map(|e| e.object).into_iter().chain(starts.first().map(|s| s.object));
            let Some(object) = next.min() else { break };
            let (own, others) = events.split_at(events.partition_point(|e| e.object == object));
            let (begun, rest) = starts.split_at(starts.partition_point(|s| s.object == object));
            (events, starts) = (others, rest);
            let tracks = Self { events: own.to_vec(), starts: begun.to_vec(), ..Self::new(self.mask) };
            let object = ObjectId(object);
            found.extend(tracks.merge(t_min, t_max).into_iter().map(|span| ObjectSpan { object, span }));
        }
        // Stable: spans of one object stay in their order, and objects ascend.
        found.sort_by(|a, b| a.span.t_in.total_cmp(&b.span.t_in));
        found
    }

    /// The spans of the union.
    pub(crate) fn merge(mut self, t_min: f64, t_max: f64) -> Vec<Span> {
        // Where crossings of one solid coincide, the order of its parts counts, not that of the
        // tree.
        self.events.sort_by(|a, b| a.solid.cmp(&b.solid).then(a.t.total_cmp(&b.t)).then(a.part.cmp(&b.part)));
        let mut depth = self.inside_without_crossing();
        let mut changes = Vec::with_capacity(self.events.len());
        for solid in self.events.chunk_by_mut(|a, b| a.solid == b.solid) {
            keep_order(solid);
            let told = self.starts.iter().find(|s| s.solid == solid[0].solid).map(|s| s.inside);
            depth += usize::from(transitions(solid, told, &mut changes));
        }
        // Stable: successive crossings of one solid stay in their order.
        changes.sort_by(|a, b| a.lo.total_cmp(&b.lo).then(a.t.total_cmp(&b.t)));
        sweep(&changes, depth, t_min, t_max)
    }

    /// The number of solids without crossings that contain the whole range.
    fn inside_without_crossing(&self) -> usize {
        let crossed = |key: &Key| self.events.binary_search_by(|e| e.solid.cmp(key)).is_ok();
        let mut inside: Vec<Key> =
            self.starts.iter().filter(|s| s.inside && !crossed(&s.solid)).map(|s| s.solid).collect();
        inside.sort_unstable();
        inside.dedup();
        inside.len()
    }
}

/// Makes the lower ends of one solid's brackets ascend, as a crossing is not before the earlier
/// ones of the same solid. The crossings of all solids are sorted by these ends.
fn keep_order(events: &mut [Event]) {
    let mut lo = f64::NEG_INFINITY;
    for event in events {
        lo = lo.max(event.lo);
        event.lo = lo;
    }
}

/// Turns the crossings of one solid into alternating changes of state; returns whether the ray
/// starts inside.
fn transitions(events: &[Event], told: Option<bool>, changes: &mut Vec<Event>) -> bool {
    let groups = || overlapping(events);
    // A group's net sign determines the state before it; a group without one does not change the
    // state.
    let by_net = groups().map(net).find(|&n| n != 0).map(|n| n > 0);
    let starts_inside = by_net.or(told).unwrap_or(events[0].sign > 0);
    let mut inside = starts_inside;
    for group in groups() {
        let alternates = group.iter().enumerate().all(|(i, e)| (e.sign > 0) == (inside ^ (i % 2 == 1)));
        if alternates {
            changes.extend_from_slice(group);
            inside ^= group.len() % 2 == 1;
        } else {
            let after = match net(group) {
                0 => inside,
                n => n < 0,
            };
            let change = group.iter().find(|e| (e.sign < 0) == after).filter(|_| after != inside);
            changes.extend(change);
            inside = after;
        }
    }
    starts_inside
}

fn net(group: &[Event]) -> i32 {
    group.iter().map(|e| i32::from(e.sign)).sum()
}

/// The groups of events whose brackets overlap transitively.
fn overlapping(events: &[Event]) -> impl Iterator<Item = &[Event]> {
    let mut rest = events;
    core::iter::from_fn(move || {
        let mut reach = rest.first()?.hi;
        let len = 1 + rest[1..]
            .iter()
            .take_while(|e| {
                let touches = e.lo <= reach;
                reach = reach.max(e.hi);
                touches
            })
            .count();
        let (group, tail) = rest.split_at(len);
        rest = tail;
        Some(group)
    })
}

/// Sweeps along the ray and counts the solids that contain each point.
fn sweep(changes: &[Event], depth: usize, t_min: f64, t_max: f64) -> Vec<Span> {
    let mut spans = Vec::new();
    let mut depth = depth as i64;
    let mut open = (depth > 0).then_some((t_min, None));
    let mut step = |events: &[Event]| {
        let before = depth;
        depth -= i64::from(net(events));
        let of_sign = |sign: i8| events.iter().filter(move |e| e.sign == sign);
        let first_object = |sign: i8| of_sign(sign).map(|e| ObjectId(e.object)).min();
        if before <= 0 && depth > 0 {
            let t = of_sign(-1).map(|e| e.t).fold(f64::INFINITY, f64::min);
            open = Some((t, first_object(-1)));
        } else if before > 0 && depth <= 0 {
            let t = of_sign(1).map(|e| e.t).fold(f64::NEG_INFINITY, f64::max);
            if let Some((t_in, object_in)) = open.take() {
                // A range that begins where a solid ends is outside of it.
                if object_in.is_some() || t > t_in {
                    spans.push(Span { t_in, t_out: t, object_in, object_out: first_object(1) });
                }
            }
        }
    };
    for group in overlapping(changes) {
        if group.iter().all(|e| e.solid == group[0].solid) {
            group.iter().for_each(|e| step(core::slice::from_ref(e)));
        } else {
            step(group);
        }
    }
    if let Some((t_in, object_in)) = open
        && (t_max > t_in || object_in.is_none())
    {
        spans.push(Span { t_in, t_out: t_max, object_in, object_out: None });
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(surface: u32, t: f64, width: f64, sign: i8) -> (u32, Root) {
        let kind = durer_surfaces::RootKind::Simple;
        (surface, Root { t, lo: t - width, hi: t + width, s: t, tag: [0.0; 2], face: 0, sign, kind })
    }

    fn merged(events: &[(u32, Root)], starts: &[(u32, bool)]) -> Vec<(f64, f64, Option<u32>, Option<u32>)> {
        let mut tracks = Tracks::new(u32::MAX);
        for (surface, root) in events {
            tracks.push(*surface, PartId(0), Id { object: *surface, primitive: 0 }, root);
        }
        starts.iter().for_each(|&(s, inside)| tracks.start(s, Id { object: s, primitive: 0 }, inside));
        let spans = tracks.merge(0.0, 100.0);
        let object = |o: Option<ObjectId>| o.map(|o| o.0);
        spans.iter().map(|s| (s.t_in, s.t_out, object(s.object_in), object(s.object_out))).collect()
    }

    #[test]
    fn overlapping_solids_merge() {
        let events =
            [event(0, 1.0, 0.0, -1), event(0, 3.0, 0.0, 1), event(1, 2.0, 0.0, -1), event(1, 5.0, 0.0, 1)];
        assert_eq!(merged(&events, &[]), [(1.0, 5.0, Some(0), Some(1))]);
    }

    #[test]
    fn touching_solids_fuse_and_separate_ones_do_not() {
        let touching =
            [event(0, 1.0, 0.0, -1), event(0, 2.0, 0.1, 1), event(1, 2.05, 0.1, -1), event(1, 3.0, 0.0, 1)];
        assert_eq!(merged(&touching, &[]), [(1.0, 3.0, Some(0), Some(1))]);
        let apart =
            [event(0, 1.0, 0.0, -1), event(0, 2.0, 0.0, 1), event(1, 2.5, 0.0, -1), event(1, 3.0, 0.0, 1)];
        assert_eq!(merged(&apart, &[]).len(), 2);
    }

    #[test]
    fn a_start_inside_has_no_entry() {
        assert_eq!(merged(&[event(0, 2.0, 0.0, 1)], &[]), [(0.0, 2.0, None, Some(0))]);
        assert_eq!(merged(&[], &[(4, true)]), [(0.0, 100.0, None, None)]);
        assert_eq!(merged(&[], &[(4, false)]), []);
    }

    #[test]
    fn a_range_that_begins_on_the_way_out_is_outside() {
        assert_eq!(merged(&[event(0, 0.0, 0.0, 1)], &[]), []);
    }

    #[test]
    fn what_one_solid_does_in_a_row_stays_in_its_order() {
        // Leaves and enters at the start; the second crossing has the wider bracket.
        let events = [event(0, 0.0, 0.0, 1), event(0, 0.0, 0.5, -1)];
        assert_eq!(merged(&events, &[(0, true)]), [(0.0, 100.0, Some(0), None)]);
    }

    #[test]
    fn a_thin_solid_is_kept_and_seams_of_one_solid_are_not() {
        let thin = [event(0, 1.0, 0.1, -1), event(0, 1.05, 0.1, 1)];
        assert_eq!(merged(&thin, &[]), [(1.0, 1.05, Some(0), Some(0))]);
        // Two faces report one entry: by the net sign the ray enters once.
        let seam = [event(0, 1.0, 0.1, -1), event(0, 1.05, 0.1, -1), event(0, 4.0, 0.0, 1)];
        assert_eq!(merged(&seam, &[]), [(1.0, 4.0, Some(0), Some(0))]);
        // A sliver whose crossings were swapped by rounding, then the body.
        let swapped =
            [event(0, 1.0, 0.1, 1), event(0, 1.05, 0.1, -1), event(0, 2.0, 0.0, -1), event(0, 4.0, 0.0, 1)];
        assert_eq!(merged(&swapped, &[]), [(2.0, 4.0, Some(0), Some(0))]);
    }
}

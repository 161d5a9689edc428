//! All crossings of a ray with the walls and caps of a curved prism.

use super::forms::Cut;
use super::parameter::Places;
use super::profile_curve::{ProfileCurve, View};
use super::profile_hits::{Meet, Scan};
use super::{CurvedPrism, Sweep};
use crate::mesh::Sorted;
use crate::planar::{Crossing, Line, Probe};
use crate::revolution::level::HeightPlane;
use crate::{LocalRay, PartId, Root, RootKind, Sink};
use core::cmp::Ordering;
use durer_math::eft::scale2;
use durer_math::{Aabb, EFloat, Isa, Ring, Vec3};

/// A face that a ray crosses.
enum CrossedFace {
    /// A wall: the crossing, and the wall's number.
    Wall(Meet, usize),
    /// A cap: whether it is the top one.
    Cap(bool),
}

impl CurvedPrism {
    /// The cut of a ray at a height that it passes; `rise` is the sign of its vertical direction.
    #[inline(always)]
    fn at_height<'a>(&self, probe: &Probe<'_>, level: &'a HeightPlane, rise: i8) -> Cut<'a> {
        let positive = match self.view.sweep {
            Sweep::Linear => rise > 0,
            Sweep::Conic => (rise > 0) == (level.height > 0.0),
        };
        if self.is_seen_as_a_point(probe) {
            Cut::Point { level, positive }
        } else {
            Cut::Height { level, positive }
        }
    }

    /// Whether a ray runs along the sweep, or through its apex, so that its trace is a point.
    #[inline(always)]
    fn is_seen_as_a_point(&self, probe: &Probe<'_>) -> bool {
        let scan = Scan::new(probe, &self.view, Cut::Ray);
        scan.vanishes()
    }

    /// Passes the crossings with the wall of piece `i` to `f`, with the root of `g` and the number.
    #[inline(always)]
    fn wall_crossings(
        &self,
        probe: &Probe<'_>,
        places: &Places<'_, '_>,
        i: usize,
        mut f: impl FnMut(Crossing, Meet, usize),
    ) {
        let piece = &self.pieces[i];
        places.scan.meets(
            piece,
            #[inline(always)]
            |meet| {
                let crossing = places.crossing(piece, &meet);
                if self.is_between(probe, piece, &meet, &crossing) {
                    f(crossing, meet, i);
                }
            },
        );
    }

    /// Whether a crossing is between the heights.
    #[inline(always)]
    fn is_between(&self, probe: &Probe<'_>, piece: &ProfileCurve, meet: &Meet, crossing: &Crossing) -> bool {
        let (at, err) = probe.place(crossing);
        let y = EFloat::with_error(at.y, err.y);
        #[inline(always)]
        fn above(y: EFloat, height: f64, view: &View) -> Option<Ordering> {
            (y - (EFloat::exact(height) - EFloat::exact(view.centre.y)).scale2(-view.scale)).sign()
        }
        match [above(y, self.heights[0], &self.view), above(y, self.heights[1], &self.view)] {
            [Some(Ordering::Greater), Some(Ordering::Less)] => true,
            [Some(Ordering::Less), _] | [_, Some(Ordering::Greater)] => false,
            _ => self.is_exactly_between(probe, piece, meet),
        }
    }

    /// Decides this exactly, by the order along the line of the crossing and the points at which
    /// the ray passes the heights.
    #[cold]
    #[inline(never)]
    fn is_exactly_between(&self, probe: &Probe<'_>, piece: &ProfileCurve, meet: &Meet) -> bool {
        let levels = [self.level(false), self.level(true)];
        let Some(rise) = probe.crossing(&levels[0]).map(|c| c.sign) else {
            // The whole ray is at one height. The bottom counts as above it, and so does the top.
            let above = |level: &HeightPlane| probe.sign(level).is_none_or(Ordering::is_ge);
            return above(&levels[0]) && !above(&levels[1]);
        };
        let is_behind = |level: &HeightPlane| {
            let positive = match self.view.sweep {
                Sweep::Linear => rise > 0,
                Sweep::Conic => (rise > 0) == (level.height > 0.0),
            };
            Scan::new(probe, &self.view, Cut::Height { level, positive }).is_behind(piece, meet)
        };
        let order = if rise > 0 { [0, 1] } else { [1, 0] };
        let [entry, exit] = order.map(|i| &levels[i]);
        // At the apex's height the ray's trace goes to infinity and comes back from the other side.
        let at_apex = |level: &HeightPlane| self.view.sweep == Sweep::Conic && level.height == 0.0;
        let (entered, left) = (at_apex(entry) || !is_behind(entry), !at_apex(exit) && !is_behind(exit));
        let through_apex = self.view.sweep == Sweep::Conic && self.heights[0] < 0.0 && self.heights[1] > 0.0;
        if through_apex { entered || !left } else { entered && !left }
    }

    /// The crossing with a cap. At a tip: the crossing of a ray through the apex that continues
    /// inside the other cap's outlines.
    #[inline(always)]
    fn cap_crossing(&self, probe: &Probe<'_>, top: bool, range: Option<(f64, f64)>) -> Option<Crossing> {
        let level = self.level(top);
        let crossing = probe.crossing(&level)?;
        if range.is_some_and(|range| crossing.is_outside(range))
            || !probe.may_admit(&crossing) && range.is_some()
        {
            return None;
        }
        // Points that are certainly outside the box do not need the outlines.
        let (at, err) = probe.place(&crossing);
        let Vec3 { x, z, .. } = at;
        let unit = |v: f64, c: f64| scale2(v - c, -self.view.scale);
        let (Aabb { min, max, .. }, c) = (self.cap_boxes[usize::from(top)], self.view.centre);
        // The numbers compared are below 4, and each side has been rounded twice.
        let room = |e: f64| e + durer_math::U * 16.0;
        if x < unit(min.x, c.x) - room(err.x)
            || x > unit(max.x, c.x) + room(err.x)
            || z < unit(min.z, c.z) - room(err.z)
            || z > unit(max.z, c.z) + room(err.z)
        {
            return None;
        }
        let end = self.level(top != self.has_tip(top));
        let cut = self.at_height(probe, &end, crossing.sign);
        if self.has_tip(top) && !matches!(cut, Cut::Point { .. }) {
            return None;
        }
        let scan = Scan::new(probe, &self.view, cut);
        let mut odd = false;
        for piece in &self.pieces {
            odd ^= scan.is_odd_behind(piece);
        }
        odd.then_some(crossing)
    }

    #[inline(always)]
    fn wall_root(&self, probe: &Probe<'_>, crossing: &Crossing, meet: &Meet, i: usize, left: bool) -> Root {
        let sign = if left { -meet.turn } else { meet.turn };
        let tag = [(2 * i + usize::from(left)) as f64, meet.y];
        let kind = match meet {
            Meet { certain: false, .. } => RootKind::Cluster,
            Meet { turn: 0, .. } => RootKind::Grazing,
            _ => RootKind::Simple,
        };
        Root { sign, kind, ..probe.root(crossing, 0, tag) }
    }

    #[inline(always)]
    fn cap_root(&self, probe: &Probe<'_>, crossing: &Crossing, top: bool) -> Root {
        let root = probe.root(crossing, 1 + u32::from(top), [0.0; 2]);
        // At the bottom, outward is down.
        Root { sign: if top { root.sign } else { -root.sign }, ..root }
    }

    /// The roots of some walls and of some caps.
    #[inline(always)]
    fn roots_of(
        &self,
        walls: core::ops::Range<usize>,
        caps: &[bool],
        sides: &[bool],
        ray: &LocalRay<'_>,
        sink: &mut dyn Sink,
    ) {
        let probe = self.probe(ray);
        let mut roots = Sorted::new();
        if !walls.is_empty() {
            let scan = Scan::new(&probe, &self.view, Cut::Ray);
            let places = Places::new(&probe, &scan);
            for i in walls {
                self.wall_crossings(
                    &probe,
                    &places,
                    i,
                    #[inline(always)]
                    |crossing: Crossing, meet: Meet, i: usize| {
                        if self.admits_wall(&places, &crossing, &meet, i, sink.range()) {
                            roots.push(self.wall_root(&probe, &crossing, &meet, i, sides[i]));
                        }
                    },
                );
            }
        }
        for &top in caps.iter().filter(|_| !self.open) {
            if let Some(crossing) = self.cap_crossing(&probe, top, Some(sink.range()))
                && probe.admits(&self.level(top), &crossing)
            {
                roots.push(self.cap_root(&probe, &crossing, top));
            }
        }
        let _ = roots.pour(sink);
    }

    #[inline(always)]
    fn admits_wall(
        &self,
        places: &Places<'_, '_>,
        crossing: &Crossing,
        meet: &Meet,
        i: usize,
        range: (f64, f64),
    ) -> bool {
        if crossing.is_outside(range) || !places.probe.may_admit(crossing) {
            return false;
        }
        match places.probe.ray.admits(crossing.lo, crossing.hi) {
            Some(admitted) => admitted,
            None => places.is_in_range(&self.pieces[i], meet, crossing),
        }
    }

    /// The roots of a tangled prism: inside and outside alternate along the line.
    #[inline(always)]
    fn tangled_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let probe = self.probe(ray);
        let scan = Scan::new(&probe, &self.view, Cut::Ray);
        let places = Places::new(&probe, &scan);
        let mut all: Vec<(Crossing, CrossedFace)> = Vec::new();
        for i in 0..self.pieces.len() {
            self.wall_crossings(&probe, &places, i, |crossing, meet, i| {
                all.push((crossing, CrossedFace::Wall(meet, i)));
            });
        }
        for top in [false, true] {
            if let Some(crossing) = self.cap_crossing(&probe, top, None) {
                all.push((crossing, CrossedFace::Cap(top)));
            }
        }
        // In the exact order along the line, the walls lie after the cap through which the ray
        // enters and before the other one.
        let rank = |(crossing, face): &(Crossing, CrossedFace)| match face {
            CrossedFace::Wall(..) => 1,
            CrossedFace::Cap(top) if (crossing.sign > 0) != *top => 0,
            CrossedFace::Cap(_) => 2,
        };
        all.sort_by(|a, b| rank(a).cmp(&rank(b)).then(a.0.s.total_cmp(&b.0.s)));
        // Where an outline crosses another, crossings that f64 cannot order are ordered exactly.
        let overlap = |(a, x): &(Crossing, CrossedFace), (b, y): &(Crossing, CrossedFace)| {
            matches!((x, y), (CrossedFace::Wall(..), CrossedFace::Wall(..)))
                && a.s_lo.max(b.s_lo) <= a.s_hi.min(b.s_hi)
        };
        for group in all.chunk_by_mut(overlap).filter(|group| group.len() > 1) {
            group.sort_by(|(_, a), (_, b)| match (a, b) {
                (CrossedFace::Wall(a, i), CrossedFace::Wall(b, j)) => {
                    places.order((&self.pieces[*i], a), (&self.pieces[*j], b))
                }
                _ => Ordering::Equal,
            });
        }
        let mut roots = Sorted::new();
        let mut inside = false;
        for (crossing, face) in &all {
            match face {
                CrossedFace::Wall(meet, i) => {
                    inside ^= meet.turn != 0;
                    // Where `g` rises, the ray goes to the left side of the curve.
                    let left = (meet.turn > 0) == inside;
                    if self.admits_wall(&places, crossing, meet, *i, sink.range()) {
                        roots.push(self.wall_root(&probe, crossing, meet, *i, left));
                    }
                }
                CrossedFace::Cap(top) => {
                    inside = !inside;
                    if !self.open
                        && !crossing.is_outside(sink.range())
                        && probe.may_admit(crossing)
                        && probe.admits(&self.level(*top), crossing)
                    {
                        roots.push(self.cap_root(&probe, crossing, *top));
                    }
                }
            }
        }
        let _ = roots.pour_in_turn(sink);
    }

    #[inline(never)]
    pub(super) fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        Isa::detect().run(
            #[inline(always)]
            || match &self.inside_is_left {
                Some(sides) => self.roots_of(0..self.pieces.len(), &[false, true], sides, ray, sink),
                None => self.tangled_roots(ray, sink),
            },
        );
    }

    #[inline(never)]
    pub(super) fn roots_of_part(&self, PartId(part): PartId, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        let Some(sides) = &self.inside_is_left else { return self.all_roots(ray, sink) };
        let passes = match (part as usize).checked_sub(self.pieces.len()) {
            None => self.pieces[part as usize].is_passed_by(ray, self.view.sweep),
            Some(cap) => ray.within(&self.cap_boxes[cap.min(1)]).is_none(),
        };
        if passes {
            return;
        }
        Isa::detect().run(
            #[inline(always)]
            || match (part as usize).checked_sub(self.pieces.len()) {
                None => self.roots_of(part as usize..part as usize + 1, &[], sides, ray, sink),
                Some(cap) => self.roots_of(0..0, &[cap > 0], sides, ray, sink),
            },
        );
    }
}

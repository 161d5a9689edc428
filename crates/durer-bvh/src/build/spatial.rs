//! Spatial splits: a triangle that a plane cuts is put on both sides of it.
//!
//! Where the boxes of two halves overlap much, as they do around large triangles, a plane through
//! all of them may be the better split (M. Stich, H. Friedrich, A. Dietrich, "Spatial splits in
//! bounding volume hierarchies", High Performance Graphics, 2009). An entry is then a *reference*:
//! a box around a part of a triangle. All parts of a triangle together are the whole of it: a part
//! that a plane cuts is replaced by two, each with a box that holds all on its side. A budget
//! bounds the number of references: it is *room* behind the entries of a range, of which both
//! halves get their shares.
//!
//! # The boxes of parts
//!
//! With `u = 2^-53` an edge from `a` to `b`, coordinates at most 1, that crosses the plane `x = p`
//! does so at
//!
//! ```text
//!     y = a_y + s (b_y - a_y),   s = (p - a_x) / (b_x - a_x) in [0, 1].
//! ```
//!
//! Both differences and the quotient are rounded, so the relative error of `s` is `3 u`; with the
//! third difference and the product that is `5 u` of at most 2; and the sum is at most `1 + 10 u`
//! and rounded once: `12 u` in all, with terms of second order. Underflow needs no charge:
//! differences of f64 do not underflow, and a quotient or a product that does loses less than
//! `2^-1074`. A part's box contains the corners on its side and these points, and is grown by
//! [`SLACK`], `32 u`; so at least `20 u` are left, more than the error of [`Bounds`] for any other
//! planes: this is why [`is_covered`] can look for gaps. The box is also inside the box of the part
//! that was cut, and on its side of the plane, both of which hold the new part.
//!
//! Corners are scaled to the tree's units. A triangle for which that is inexact is never cut.

use super::area::Extent;
use super::split::{Plane, fold};
use super::{Costs, Divided, KindCosts};
use crate::frame::{Entry, Frame, down32, up32};
use crate::triangles::Corners;

/// The boxes of parts are grown by this: see above.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// The number of bins along each axis, whose borders are the planes to choose from.
const BINS: usize = 16;

/// A spatial split is tried where the overlap of the halves has more than this fraction of their
/// range's surface. The paper compares with the whole tree's surface instead: then it is tried
/// nearly everywhere, which takes three times as long and gains nothing.
const OVERLAP: f32 = 0.3;

/// A range of fewer entries gets no spatial split: it is a few blocks.
const LEAST: usize = 64;

/// The number of entries for which one more reference is allowed.
pub(super) const BUDGET: usize = 4;

/// A triangle in the tree's units.
pub(crate) type Scaled = [[f64; 3]; 3];

/// A triangle in the tree's units, if the scaling is exact.
pub(crate) fn scaled(frame: Frame, corners: &Corners) -> Option<Scaled> {
    let mut scaled = [[0.0; 3]; 3];
    for (to, from) in scaled.iter_mut().zip(corners) {
        for axis in 0..3 {
            let (x, lost) = frame.difference(from[axis], axis);
            to[axis] = frame.units().inward(x);
            if frame.units().outward(to[axis]) != x || lost != 0.0 {
                return None;
            }
        }
    }
    Some(scaled)
}

/// A box around a part of a triangle, within 12 u; empty at first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) lo: [f64; 3],
    pub(crate) hi: [f64; 3],
}

impl Bounds {
    const EMPTY: Self = Self { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3] };

    #[inline(always)]
    fn add(&mut self, p: &[f64; 3]) {
        for (i, &x) in p.iter().enumerate() {
            self.lo[i] = if x < self.lo[i] { x } else { self.lo[i] };
            self.hi[i] = if x > self.hi[i] { x } else { self.hi[i] };
        }
    }

    /// The boxes of the parts of a triangle on both sides of the plane `x_axis = at`.
    #[inline(always)]
    fn of_parts(v: &Scaled, axis: usize, at: f64) -> [Self; 2] {
        let [mut below, mut above] = [Self::EMPTY; 2];
        for (i, a) in v.iter().enumerate() {
            let b = &v[(i + 1) % 3];
            if a[axis] <= at {
                below.add(a);
            }
            if a[axis] >= at {
                above.add(a);
            }
            if (a[axis] < at && b[axis] > at) || (a[axis] > at && b[axis] < at) {
                let s = (at - a[axis]) / (b[axis] - a[axis]);
                let mut p = [0.0; 3];
                for i in 0..3 {
                    p[i] = a[i] + s * (b[i] - a[i]);
                }
                p[axis] = at;
                below.add(&p);
                above.add(&p);
            }
        }
        [below, above]
    }

    fn within(mut self, other: &Self) -> Self {
        for i in 0..3 {
            self.lo[i] = self.lo[i].max(other.lo[i]);
            self.hi[i] = self.hi[i].min(other.hi[i]);
        }
        self
    }

    fn is_empty(&self) -> bool {
        (0..3).any(|i| self.lo[i] > self.hi[i])
    }
}

/// The boxes of an entry's parts on both sides of a plane; `None` for a part that does not exist.
#[inline(always)]
fn parts(entry: &Entry, v: &Scaled, axis: usize, at: f32) -> [Option<Extent>; 2] {
    let [below, above] = Bounds::of_parts(v, axis, f64::from(at));
    let (lo, hi) = (entry.lo(), entry.hi());
    let side = |part: &Bounds, mut lo: [f32; 3], mut hi: [f32; 3]| {
        for i in 0..3 {
            lo[i] = lo[i].max(down32(part.lo[i] - SLACK));
            hi[i] = hi[i].min(up32(part.hi[i] + SLACK));
        }
        (0..3).all(|i| lo[i] <= hi[i]).then(|| Extent::between((lo, hi)))
    };
    let (mut below_hi, mut above_lo) = (hi, lo);
    below_hi[axis] = at.min(hi[axis]);
    above_lo[axis] = at.max(lo[axis]);
    [side(&below, lo, below_hi), side(&above, above_lo, hi)]
}

/// Whether boxes cover a triangle's part in `bounds`, up to the accuracy of f64.
pub(crate) fn is_covered(v: &Scaled, bounds: &Bounds, boxes: &[Bounds]) -> bool {
    if bounds.is_empty() {
        return true;
    }
    let holds = |b: &Bounds| (0..3).all(|i| b.lo[i] <= bounds.lo[i] && bounds.hi[i] <= b.hi[i]);
    if boxes.iter().any(holds) {
        return true;
    }
    // Looks for a plane of a box that cuts the part. If there is none, the part is outside all
    // boxes.
    let meets = |b: &&Bounds| !bounds.within(b).is_empty();
    let planes = |b: &Bounds| (0..3).flat_map(|i| [(i, b.lo[i]), (i, b.hi[i])]).collect::<Vec<_>>();
    let mut all = boxes.iter().filter(meets).flat_map(planes);
    let Some((axis, at)) = all.find(|&(i, at)| bounds.lo[i] < at && at < bounds.hi[i]) else { return false };
    let [below, above] = Bounds::of_parts(v, axis, at);
    is_covered(v, &below.within(bounds), boxes) && is_covered(v, &above.within(bounds), boxes)
}

/// The contents of the bins of each axis: boxes of parts, and how many triangles begin and end
/// there.
struct Chopped {
    extents: [[Extent; BINS]; 3],
    begin: [[u32; BINS]; 3],
    end: [[u32; BINS]; 3],
}

impl Chopped {
    const EMPTY: Self =
        Self { extents: [[Extent::EMPTY; BINS]; 3], begin: [[0; BINS]; 3], end: [[0; BINS]; 3] };

    fn joined(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.extents[axis][bin].unite(&other.extents[axis][bin]);
                self.begin[axis][bin] += other.begin[axis][bin];
                self.end[axis][bin] += other.end[axis][bin];
            }
        }
        self
    }

    #[inline(always)]
    fn add(&mut self, entry: &Entry, grid: &Grid, costs: &Costs<'_>) {
        let (lo, hi) = (entry.lo(), entry.hi());
        // Fetched only if a plane cuts the triangle.
        let mut corners = None;
        for axis in 0..3 {
            let (first, last) = (grid.bin(lo[axis], axis), grid.bin(hi[axis], axis));
            if first < last {
                let corners = corners.get_or_insert_with(
                    #[inline(always)]
                    || costs.scaled(entry).map(|v| v.map(|v| v.map(|x| x as f32))),
                );
                if let Some(v) = corners
                    && self.chop(entry, v, grid, axis, first, last)
                {
                    continue;
                }
                // Not cut: the entry counts on one side.
                let bin = grid.bin(0.5 * entry.centre2(axis), axis);
                self.put(axis, bin, bin, &Extent::of(entry));
            } else {
                self.put(axis, first, last, &Extent::of(entry));
            }
        }
    }

    #[inline(always)]
    fn put(&mut self, axis: usize, first: usize, last: usize, extent: &Extent) {
        self.extents[axis][last].unite(extent);
        self.begin[axis][first] += 1;
        self.end[axis][last] += 1;
    }

    /// Adds a triangle's parts in some bins, rounded, which affects only the choice of the plane.
    /// Returns whether there are any.
    #[inline(always)]
    fn chop(
        &mut self,
        entry: &Entry,
        v: &[[f32; 3]; 3],
        grid: &Grid,
        axis: usize,
        first: usize,
        last: usize,
    ) -> bool {
        let mut parts = [Extent::EMPTY; BINS];
        for i in 0..3 {
            let (a, b) = (&v[i], &v[(i + 1) % 3]);
            let (a, b) = if a[axis] <= b[axis] { (a, b) } else { (b, a) };
            parts[grid.bin(v[i][axis], axis)].unite(&Extent::at(&v[i]));
            let (before, behind) = (grid.bin(a[axis], axis).max(first), grid.bin(b[axis], axis).min(last));
            if before >= behind {
                continue;
            }
            let inverse = 1.0 / (b[axis] - a[axis]);
            for bin in before..behind {
                let s = (grid.plane(bin + 1, axis) - a[axis]) * inverse;
                let mut p = [0.0; 3];
                for i in 0..3 {
                    p[i] = a[i] + s * (b[i] - a[i]);
                }
                let p = Extent::at(&p);
                parts[bin].unite(&p);
                parts[bin + 1].unite(&p);
            }
        }
        let (mut begin, mut end) = (BINS, 0);
        let whole = Extent::of(entry);
        for (bin, part) in parts.iter().enumerate().take(last + 1).skip(first) {
            let part = part.common(&whole);
            if !part.is_empty() {
                self.extents[axis][bin].unite(&part);
                begin = begin.min(bin);
                end = bin;
            }
        }
        if begin < BINS {
            self.begin[axis][begin] += 1;
            self.end[axis][end] += 1;
        }
        begin < BINS
    }
}

/// Bins of equal width across a box.
struct Grid {
    from: [f32; 3],
    width: [f32; 3],
    scale: [f32; 3],
}

impl Grid {
    fn over(extent: &Extent) -> Self {
        let (lo, hi) = (extent.lo(), extent.hi());
        let mut grid = Self { from: lo, width: [0.0; 3], scale: [0.0; 3] };
        for i in 0..3 {
            grid.width[i] = hi[i] - lo[i];
            let scale = BINS as f32 / grid.width[i];
            grid.scale[i] = if scale.is_finite() { scale } else { 0.0 };
        }
        grid
    }

    #[inline(always)]
    fn bin(&self, x: f32, axis: usize) -> usize {
        (((x - self.from[axis]) * self.scale[axis]) as usize).min(BINS - 1)
    }

    /// The plane at which a bin begins.
    #[inline(always)]
    fn plane(&self, bin: usize, axis: usize) -> f32 {
        self.from[axis] + self.width[axis] * (bin as f32 / BINS as f32)
    }
}

/// A plane, and the extent and number of references on both sides of it.
struct Cut {
    axis: usize,
    at: f32,
    sides: [(Extent, usize); 2],
}

/// Splits the first `len` entries, which are followed by room, by a plane in space, if that is
/// better than `other`; else nothing changes.
pub(super) fn divide(
    entries: &mut [Entry],
    len: usize,
    extent: &Extent,
    other: Option<&Plane>,
    (kind, costs): (&KindCosts, &Costs<'_>),
) -> Option<Divided> {
    let room = entries.len() - len;
    if room == 0 || kind.block == 0 || len < LEAST {
        return None;
    }
    let cost = match other {
        Some(plane) if plane.overlap() <= OVERLAP * extent.half_area() => return None,
        Some(plane) => plane.cost(kind),
        None => f32::INFINITY,
    };
    let cut = best(&entries[..len], extent, room, cost, (kind, costs))?;
    make(entries, len, &cut, costs)
}

fn best(
    entries: &[Entry],
    extent: &Extent,
    room: usize,
    mut cost: f32,
    (kind, costs): (&KindCosts, &Costs<'_>),
) -> Option<Cut> {
    let grid = Grid::over(extent);
    let chopped = fold(
        entries,
        || Chopped::EMPTY,
        |chopped, part| {
            costs.isa.run(
                #[inline(always)]
                || {
                    for entry in part {
                        chopped.add(entry, &grid, costs);
                    }
                },
            );
        },
        Chopped::joined,
    );
    let mut found = None;
    for axis in (0..3).filter(|&axis| grid.scale[axis] > 0.0) {
        let (extents, begin, end) = (&chopped.extents[axis], &chopped.begin[axis], &chopped.end[axis]);
        let mut above = [(Extent::EMPTY, 0); BINS];
        let mut side = (Extent::EMPTY, 0);
        for bin in (1..BINS).rev() {
            side.0.unite(&extents[bin]);
            side.1 += end[bin] as usize;
            above[bin] = side;
        }
        let mut below = (Extent::EMPTY, 0);
        for bin in 1..BINS {
            below.0.unite(&extents[bin - 1]);
            below.1 += begin[bin - 1] as usize;
            let sides = [below, above[bin]];
            let counts = [below.1, above[bin].1];
            // Whether neither side has all entries.
            let is_cut = counts.iter().all(|&n| n < entries.len());
            if !is_cut || counts[0] + counts[1] > entries.len() + room {
                continue;
            }
            let at: f32 = sides.iter().map(|(e, n)| e.half_area() * kind.of_leaf(*n)).sum();
            if at < cost {
                (cost, found) = (at, Some(Cut { axis, at: grid.plane(bin, axis), sides }));
            }
        }
    }
    found
}

/// Makes the split. An entry that the plane cuts may be put whole on one side, if that is better.
/// `None` if one side turns out to be empty: then nothing has changed.
fn make(entries: &mut [Entry], len: usize, cut: &Cut, costs: &Costs<'_>) -> Option<Divided> {
    let Cut { axis, at, .. } = *cut;
    let [(below, n_below), (above, n_above)] = cut.sides;
    let cost = |extent: &Extent, count: usize| extent.half_area() * count as f32;
    let both = cost(&below, n_below) + cost(&above, n_above);
    let mut right = Vec::with_capacity(n_above);
    let mut left = 0;
    let (mut left_extent, mut right_extent) = (Extent::EMPTY, Extent::EMPTY);
    for i in 0..len {
        let entry = entries[i];
        let whole = Extent::of(&entry);
        let mut sides = [None, None];
        if entry.hi()[axis] <= at {
            sides[0] = Some(whole);
        } else if entry.lo()[axis] >= at {
            sides[1] = Some(whole);
        } else {
            let first = cost(&below.united(&whole), n_below) + cost(&above, n_above.saturating_sub(1));
            let second = cost(&below, n_below.saturating_sub(1)) + cost(&above.united(&whole), n_above);
            let has_room = left + right.len() + (len - i) < entries.len();
            let cut = costs.scaled(&entry).map(|v| parts(&entry, &v, axis, at));
            sides = match cut {
                Some([Some(part), Some(beyond)]) if has_room && both < first && both < second => {
                    [Some(part), Some(beyond)]
                }
                Some([Some(_), None]) => [Some(whole), None],
                Some([None, Some(_)]) => [None, Some(whole)],
                _ if first <= second => [Some(whole), None],
                _ => [None, Some(whole)],
            };
        }
        if let Some(extent) = sides[1] {
            right_extent.unite(&extent);
            right.push(entry.with_extent(&extent));
        }
        if let Some(extent) = sides[0] {
            left_extent.unite(&extent);
            entries[left] = entry.with_extent(&extent);
            left += 1;
        }
    }
    if left == 0 || right.is_empty() {
        return None;
    }
    let room = entries.len() - left - right.len();
    let divided = Divided::sharing(room, (left, left_extent), (right.len(), right_extent));
    let first = divided.left.len + divided.left.room;
    entries[first..first + right.len()].copy_from_slice(&right);
    Some(divided)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use durer_math::{Aabb, Point3};
    use proptest::prelude::*;

    /// Coordinates are multiples of this, so that the test's arithmetic is exact in f64.
    const UNIT: f64 = 1.0 / (1 << 20) as f64;

    fn corner() -> impl Strategy<Value = [i32; 3]> {
        let far = -(1 << 19)..1 << 19;
        prop::array::uniform3(prop_oneof![far, -4..4_i32])
    }

    fn triangle(corners: [[i32; 3]; 3]) -> (Entry, Scaled) {
        let v = corners.map(|c| c.map(|x| f64::from(x) * UNIT));
        let frame = Frame::around(&Aabb::centred(Point3::ORIGIN, durer_math::Vec3::new(0.9, 0.9, 0.9)));
        let v = scaled(frame, &v.map(Point3::from)).unwrap();
        let entry = frame.entry(&Aabb::from_points(v.map(Point3::from)), 0, 0);
        (entry, v)
    }

    proptest! {
        #[test]
        fn parts_hold_all_points_of_edges(corners in prop::array::uniform3(corner()), at in -(1 << 19)..1 << 19, axis in 0..3_usize) {
            let (entry, v) = triangle(corners);
            let at = (f64::from(at) * UNIT) as f32;
            let sides = parts(&entry, &v, axis, at);
            let at = f64::from(at);
            for i in 0..3 {
                let (a, b) = (v[i], v[(i + 1) % 3]);
                // Corners.
                for (side, is_there) in sides.iter().zip([a[axis] <= at, a[axis] >= at]) {
                    if is_there {
                        let e = side.as_ref().expect("a part with a corner");
                        prop_assert!((0..3).all(|i| f64::from(e.lo()[i]) <= a[i] && a[i] <= f64::from(e.hi()[i])));
                    }
                }
                // Where the plane cuts an edge, as a fraction.
                let (over, under) = (at - a[axis], b[axis] - a[axis]);
                if over * (at - b[axis]) < 0.0 {
                    let (over, under) = if under < 0.0 { (-over, -under) } else { (over, under) };
                    for side in &sides {
                        let e = side.as_ref().expect("both have a part");
                        for i in 0..3 {
                            let y = a[i] * under + over * (b[i] - a[i]);
                            prop_assert!(f64::from(e.lo()[i]) * under <= y && y <= f64::from(e.hi()[i]) * under);
                        }
                    }
                }
            }
            // Each is on its side.
            prop_assert!(sides[0].as_ref().is_none_or(|e| f64::from(e.hi()[axis]) <= at));
            prop_assert!(sides[1].as_ref().is_none_or(|e| f64::from(e.lo()[axis]) >= at));
        }

        #[test]
        fn parts_cover_a_triangle_and_all_but_one_do_not(
            corners in prop::array::uniform3(corner()),
            cuts in prop::collection::vec((0..3_usize, 0.1..0.9_f32, any::<prop::sample::Index>()), 1..12),
            lost in any::<prop::sample::Index>(),
        ) {
            let (entry, v) = triangle(corners);
            let mut all = vec![entry];
            for (axis, part, which) in cuts {
                let which = which.index(all.len());
                let entry = all[which];
                let at = entry.lo()[axis] + part * (entry.hi()[axis] - entry.lo()[axis]);
                if let [Some(below), Some(above)] = parts(&entry, &v, axis, at) {
                    all[which] = entry.with_extent(&below);
                    all.push(entry.with_extent(&above));
                }
            }
            let wide = |e: &Entry| Bounds { lo: e.lo().map(f64::from), hi: e.hi().map(f64::from) };
            let mut boxes: Vec<Bounds> = all.iter().map(wide).collect();
            let whole = Bounds::of_parts(&v, 0, f64::INFINITY)[0];
            prop_assert!(is_covered(&v, &whole, &boxes));
            let lost = boxes.swap_remove(lost.index(boxes.len()));
            // A corner that is in none of the others is missed.
            let corner = v.iter().find(|p| {
                let holds = |b: &Bounds| (0..3).all(|i| b.lo[i] <= p[i] && p[i] <= b.hi[i]);
                holds(&lost) && !boxes.iter().any(holds)
            });
            prop_assert!(corner.is_none() || !is_covered(&v, &whole, &boxes));
        }
    }
}

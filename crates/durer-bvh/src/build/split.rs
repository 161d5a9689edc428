//! Where to cut a range of entries.

use super::area::Extent;
use super::{Costs, KindCosts};
use crate::frame::Entry;
use rayon::prelude::*;

/// Bins per axis.
const BINS: usize = 16;

/// With so few entries all cuts are tried, which is less work than bins.
const SWEPT: usize = 32;

/// Ranges with more entries are binned by all threads.
const PARALLEL: usize = 1 << 15;

/// A range cut in two: the first part's length, and the boxes of both.
pub(super) struct Split {
    pub(super) at: usize,
    pub(super) left: Extent,
    pub(super) right: Extent,
}

/// The box of all entries.
pub(super) fn extent(entries: &[Entry]) -> Extent {
    fold(entries, || Extent::EMPTY, Extent::add, |a, b| a.united(&b))
}

/// Folds in an order that does not matter: by all threads if it pays.
fn fold<T: Send>(
    entries: &[Entry],
    identity: impl Fn() -> T + Sync + Send,
    add: impl Fn(&mut T, &Entry) + Sync,
    join: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    let some = |part: &[Entry]| {
        let mut value = identity();
        part.iter().for_each(|entry| add(&mut value, entry));
        value
    };
    if entries.len() > PARALLEL {
        entries.par_chunks(PARALLEL / 4).map(some).reduce(&identity, join)
    } else {
        some(entries)
    }
}

pub(super) fn is_one_kind(entries: &[Entry]) -> bool {
    entries.len() > super::MAX_LEAF || entries.iter().all(|e| e.kind() == entries[0].kind())
}

/// A way to cut a range in two.
pub(super) struct Plane {
    cut: Cut,
    left: (Extent, usize),
    right: (Extent, usize),
}

/// Which entries go left.
enum Cut {
    /// Those in bins before this one.
    Bin { axis: usize, bin: usize, bins: Bins },
    /// The first ones in this order; for few entries.
    Order { order: [u8; SWEPT] },
}

impl Plane {
    /// The area-weighted cost of two leaves.
    pub(super) fn cost(&self, costs: &KindCosts) -> f32 {
        let side = |(extent, count): &(Extent, usize)| extent.half_area() * costs.of_leaf(*count);
        side(&self.left) + side(&self.right)
    }

    /// Whether a cut of this cost into parts so different is better than `best`. Flat in two directions, the surface says
    /// nothing: then the most even cut wins.
    fn is_beaten_by(best: &Option<Self>, least: f32, cost: f32, left: usize, right: usize) -> bool {
        let uneven = |b: &Self| b.left.1.abs_diff(b.right.1);
        cost < least || (cost == least && best.as_ref().is_none_or(|b| left.abs_diff(right) < uneven(b)))
    }
}

/// How twice-centres map to bins.
#[derive(Clone, Copy)]
struct Bins {
    from: [f32; 3],
    scale: [f32; 3],
}

impl Bins {
    fn over(entries: &[Entry]) -> Self {
        let add = |e: &mut Extent, entry: &Entry| {
            let c = [entry.centre2(0), entry.centre2(1), entry.centre2(2)];
            e.grow(c, c);
        };
        let centres = fold(entries, || Extent::EMPTY, add, |a, b| a.united(&b));
        let (lo, hi) = (centres.lo(), centres.hi());
        let scale = core::array::from_fn(|i| {
            let scale = BINS as f32 / (hi[i] - lo[i]);
            if scale.is_finite() { scale } else { 0.0 }
        });
        Self { from: lo, scale }
    }

    #[inline(always)]
    fn of(&self, entry: &Entry, axis: usize) -> usize {
        /// Added to a small number it leaves its nearest integer in the lowest bits, which a conversion takes more steps to find.
        const INTEGERS: f32 = (1 << 23) as f32;
        const LAST: f32 = (BINS - 1) as f32;
        let x = (entry.centre2(axis) - self.from[axis]) * self.scale[axis] - 0.5;
        let x = if x > 0.0 { x } else { 0.0 };
        let x = if x < LAST { x } else { LAST };
        (x + INTEGERS).to_bits() as usize & (BINS - 1)
    }
}

/// The best cut along any axis by the surface area heuristic; `None` if all centres coincide (or nearly).
pub(super) fn best_plane(entries: &[Entry], costs: &KindCosts) -> Option<Plane> {
    if entries.len() <= SWEPT { best_of_all(entries, costs) } else { best_between_bins(entries, costs) }
}

/// The best of all cuts of a few entries sorted by their centres.
fn best_of_all(entries: &[Entry], costs: &KindCosts) -> Option<Plane> {
    let n = entries.len();
    let mut best: Option<Plane> = None;
    let mut least = f32::INFINITY;
    for axis in 0..3 {
        // The centre, then the kind, then the place: one number to sort by.
        let mut keys = [0_u64; SWEPT];
        for (i, entry) in entries.iter().enumerate() {
            let kind = u64::from(entry.kind().min((1 << 24) - 1));
            keys[i] = u64::from(in_order(entry.centre2(axis))) << 32 | kind << 8 | i as u64;
        }
        keys[..n].sort_unstable();
        let mut order = [0_u8; SWEPT];
        for (to, key) in order.iter_mut().zip(&keys[..n]) {
            *to = *key as u8;
        }
        let mut right = [Extent::EMPTY; SWEPT];
        let mut so_far = Extent::EMPTY;
        for i in (1..n).rev() {
            so_far.add(&entries[usize::from(order[i])]);
            right[i] = so_far;
        }
        let mut left = Extent::EMPTY;
        for i in 1..n {
            left.add(&entries[usize::from(order[i - 1])]);
            let cost = left.half_area() * costs.tests(i) + right[i].half_area() * costs.tests(n - i);
            if Plane::is_beaten_by(&best, least, cost, i, n - i) {
                least = cost;
                best = Some(Plane { cut: Cut::Order { order }, left: (left, i), right: (right[i], n - i) });
            }
        }
    }
    best
}

/// A number that orders as f32 does.
#[inline(always)]
fn in_order(x: f32) -> u32 {
    // Zeros of either sign are one.
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

fn best_between_bins(entries: &[Entry], costs: &KindCosts) -> Option<Plane> {
    type Filled = [[(Extent, usize); BINS]; 3];
    let bins = Bins::over(entries);
    let add = |filled: &mut Filled, entry: &Entry| {
        for (axis, row) in filled.iter_mut().enumerate() {
            let (extent, count) = &mut row[bins.of(entry, axis)];
            extent.add(entry);
            *count += 1;
        }
    };
    let join = |mut a: Filled, b: Filled| {
        for ((extent, count), (other, more)) in a.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
            extent.unite(other);
            *count += more;
        }
        a
    };
    let filled = fold(entries, || [[(Extent::EMPTY, 0); BINS]; 3], add, join);
    let mut best: Option<Plane> = None;
    let mut least = f32::INFINITY;
    for (axis, row) in filled.iter().enumerate() {
        let grow = |(extent, count): (Extent, usize), b: &(Extent, usize)| (extent.united(&b.0), count + b.1);
        let mut right = [(Extent::EMPTY, 0); BINS + 1];
        for bin in (1..BINS).rev() {
            right[bin] = grow(right[bin + 1], &row[bin]);
        }
        let mut left = (Extent::EMPTY, 0);
        for bin in 1..BINS {
            left = grow(left, &row[bin - 1]);
            let right = right[bin];
            if left.1 == 0 || right.1 == 0 {
                continue;
            }
            let cost = left.0.half_area() * costs.tests(left.1) + right.0.half_area() * costs.tests(right.1);
            if Plane::is_beaten_by(&best, least, cost, left.1, right.1) {
                least = cost;
                best = Some(Plane { cut: Cut::Bin { axis, bin, bins }, left, right });
            }
        }
    }
    best
}

/// Whether a range that its node has no room to split should be a leaf rather than a node below.
pub(super) fn is_better_as_leaf(entries: &[Entry], extent: &Extent, costs: &Costs<'_>) -> bool {
    if entries.len() > costs.max_leaf || !is_one_kind(entries) {
        return false;
    }
    let costs = costs.of_range(entries);
    let whole = extent.half_area();
    let leaf = costs.of_leaf(entries.len()) * whole;
    best_plane(entries, &costs).is_none_or(|plane| leaf <= whole + plane.cost(&costs))
}

/// Makes the cut.
pub(super) fn by_plane(entries: &mut [Entry], plane: &Plane) -> Split {
    match plane.cut {
        Cut::Bin { axis, bin, bins } => {
            let goes_left = |e: &Entry| bins.of(e, axis) < bin;
            let (mut i, mut j) = (0, entries.len());
            loop {
                while i < j && goes_left(&entries[i]) {
                    i += 1;
                }
                while i < j && !goes_left(&entries[j - 1]) {
                    j -= 1;
                }
                if i >= j {
                    break;
                }
                entries.swap(i, j - 1);
            }
            debug_assert_eq!(i, plane.left.1);
        }
        Cut::Order { order } => {
            let mut sorted = [entries[0]; SWEPT];
            for (to, &from) in sorted.iter_mut().zip(&order[..entries.len()]) {
                *to = entries[usize::from(from)];
            }
            entries.copy_from_slice(&sorted[..entries.len()]);
        }
    }
    Split { at: plane.left.1, left: plane.left.0, right: plane.right.0 }
}

/// Cuts in the middle, as the entries stand.
pub(super) fn halve(entries: &[Entry]) -> Split {
    let at = entries.len() / 2;
    let (left, right) = entries.split_at(at);
    Split { at, left: extent(left), right: extent(right) }
}

/// Cuts in the middle; a range that is small enough for a leaf is sorted by kind first, so that kinds part.
pub(super) fn halve_by_kind(entries: &mut [Entry]) -> Split {
    if entries.len() > super::MAX_LEAF {
        return halve(entries);
    }
    entries.sort_by_key(Entry::kind);
    let middle = entries.len() / 2;
    // The change of kind that is nearest to the middle.
    let changes = (1..entries.len()).filter(|&i| entries[i].kind() != entries[i - 1].kind());
    let at = changes.min_by_key(|i| i.abs_diff(middle)).unwrap_or(middle);
    let (left, right) = entries.split_at(at);
    Split { at, left: extent(left), right: extent(right) }
}

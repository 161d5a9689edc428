//! Where to cut a range of entries.

use super::area::Extent;
use super::bins::{BINS, Bins, Filled};
use super::{Costs, KindCosts};
use crate::frame::Entry;
use crate::kernels;
use durer_math::Isa;
use rayon::prelude::*;

/// With so few entries all cuts are tried, which is less work than bins.
const SWEPT: usize = 32;

/// Ranges with more entries are binned and parted by all threads.
const PARALLEL: usize = 1 << 15;

/// A range cut in two: the first part's length, and the boxes of both.
pub(super) struct Split {
    pub(super) at: usize,
    pub(super) left: Extent,
    pub(super) right: Extent,
}

/// The box of all entries.
pub(super) fn extent(entries: &[Entry]) -> Extent {
    let add = |extent: &mut Extent, part: &[Entry]| part.iter().for_each(|entry| extent.add(entry));
    fold(entries, || Extent::EMPTY, add, |a, b| a.united(&b))
}

/// Folds in an order that does not matter: by all threads if it pays.
pub(super) fn fold<T: Send>(
    entries: &[Entry],
    identity: impl Fn() -> T + Sync + Send,
    add: impl Fn(&mut T, &[Entry]) + Sync,
    join: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    let some = |part: &[Entry]| {
        let mut value = identity();
        add(&mut value, part);
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
    Bin { axis: usize, bin: u32, bins: Bins },
    /// The first ones in this order; for few entries.
    Order { order: [u8; SWEPT] },
}

impl Plane {
    /// Half the surface of what both boxes have in common.
    pub(super) fn overlap(&self) -> f32 {
        self.left.0.common(&self.right.0).half_area()
    }

    /// The area-weighted cost of two leaves.
    pub(super) fn cost(&self, costs: &KindCosts) -> f32 {
        let side = |(extent, count): &(Extent, usize)| extent.half_area() * costs.of_leaf(*count);
        side(&self.left) + side(&self.right)
    }
}

/// The best cut so far.
struct Best {
    cost: f32,
    axis: usize,
    at: usize,
    uneven: usize,
}

impl Best {
    const NONE: Self = Self { cost: f32::INFINITY, axis: 0, at: 0, uneven: usize::MAX };

    /// Takes a cut into `left` and `right` entries if it is better. Flat in two directions, the
    /// surface says nothing: then the most even cut wins.
    #[inline(always)]
    fn improve(&mut self, cost: f32, axis: usize, at: usize, left: usize, right: usize) {
        let uneven = left.abs_diff(right);
        if cost < self.cost || (cost == self.cost && uneven < self.uneven) {
            *self = Self { cost, axis, at, uneven };
        }
    }
}

/// The best cut along any axis by the surface area heuristic; `None` if all centres coincide (or
/// nearly).
pub(super) fn best_plane(entries: &[Entry], costs: &KindCosts, isa: Isa) -> Option<Plane> {
    if entries.len() <= SWEPT {
        isa.run(
            #[inline(always)]
            || best_of_all(entries, costs),
        )
    } else {
        best_between_bins(entries, costs, isa)
    }
}

/// The best of all cuts of a few entries in the order of their centres; equal ones stay as they
/// stand.
#[inline(always)]
fn best_of_all(entries: &[Entry], costs: &KindCosts) -> Option<Plane> {
    let n = entries.len();
    let mut boxes = [Extent::EMPTY; SWEPT];
    for (to, entry) in boxes.iter_mut().zip(entries) {
        *to = Extent::of(entry);
    }
    // Lanes where there is no cut are infinite.
    let (mut tests_left, mut tests_right) = ([1.0; SWEPT], [1.0; SWEPT]);
    for i in 1..n {
        (tests_left[i], tests_right[i]) = (costs.tests(i), costs.tests(n - i));
    }
    let (mut best, mut orders) = (Best::NONE, [[0_u8; SWEPT]; 3]);
    for (axis, order) in orders.iter_mut().enumerate() {
        let mut centres = [f32::INFINITY; SWEPT];
        for (to, entry) in centres.iter_mut().zip(entries) {
            *to = entry.centre2(axis);
        }
        for (i, rank) in ranks(&centres, n)[..n].iter().enumerate() {
            order[*rank as usize % SWEPT] = i as u8;
        }
        let at = |i: usize| &boxes[usize::from(order[i]) % SWEPT];
        let (mut left, mut right) = ([f32::INFINITY; SWEPT], [f32::INFINITY; SWEPT]);
        let (mut before, mut after) = (Extent::EMPTY, Extent::EMPTY);
        for i in 1..n {
            before.unite(at(i - 1));
            left[i] = before.half_area();
            after.unite(at(n - i));
            right[n - i] = after.half_area();
        }
        let (mut sums, mut least) = ([0.0; SWEPT], f32::INFINITY);
        for i in 0..SWEPT {
            sums[i] = left[i] * tests_left[i] + right[i] * tests_right[i];
        }
        for &sum in &sums {
            least = if sum < least { sum } else { least };
        }
        if least <= best.cost {
            for i in (1..n).filter(|&i| sums[i] == least) {
                best.improve(least, axis, i, i, n - i);
            }
        }
    }
    if best.at == 0 {
        return None;
    }
    let order = orders[best.axis];
    let all = |part: &[u8]| part.iter().fold(Extent::EMPTY, |e, &i| e.united(&boxes[usize::from(i)]));
    let (left, right) = order[..n].split_at(best.at);
    Some(Plane { left: (all(left), left.len()), right: (all(right), right.len()), cut: Cut::Order { order } })
}

/// How many of `n` numbers come before each: lesser ones, and equal ones that stand before it.
/// Without a branch, which sorting few numbers is full of.
#[inline(always)]
fn ranks(x: &[f32; SWEPT], n: usize) -> [u32; SWEPT] {
    const STEP: usize = 8;
    let mut ranks = [0_u32; SWEPT];
    for first in (0..n).step_by(STEP) {
        let (mut some, mut mine) = ([0_u32; STEP], [0.0; STEP]);
        mine.copy_from_slice(&x[first..first + STEP]);
        for (j, &other) in x[..n].iter().enumerate() {
            for lane in 0..STEP {
                let is_first = (other < mine[lane]) | ((other == mine[lane]) & (j < first + lane));
                some[lane] += u32::from(is_first);
            }
        }
        ranks[first..first + STEP].copy_from_slice(&some);
    }
    ranks
}

fn best_between_bins(entries: &[Entry], costs: &KindCosts, isa: Isa) -> Option<Plane> {
    let bins = Bins::over(&fold(
        entries,
        || Extent::EMPTY,
        |centres, part| kernels::add_centres(isa, part, centres),
        |a, b| a.united(&b),
    ));
    let filled = fold(
        entries,
        || Filled::EMPTY,
        |filled, part| kernels::fill(isa, part, &bins, filled),
        Filled::joined,
    );
    let Best { axis, at, .. } = isa.run(
        #[inline(always)]
        || best_bin(&filled, costs),
    );
    (at > 0).then(|| Plane {
        cut: Cut::Bin { axis, bin: at as u32, bins },
        left: filled.all(axis, 0..at),
        right: filled.all(axis, at..BINS),
    })
}

/// The best cut before a bin that is not the first.
#[inline(always)]
fn best_bin(filled: &Filled, costs: &KindCosts) -> Best {
    let mut best = Best::NONE;
    for (axis, (extents, counts)) in filled.extents.iter().zip(&filled.counts).enumerate() {
        let mut right = [(0.0, 0); BINS];
        let (mut so_far, mut count) = (Extent::EMPTY, 0);
        for bin in (1..BINS).rev() {
            so_far.unite(&extents[bin]);
            count += counts[bin] as usize;
            right[bin] = (so_far.half_area(), count);
        }
        let (mut left, mut count) = (Extent::EMPTY, 0);
        for bin in 1..BINS {
            left.unite(&extents[bin - 1]);
            count += counts[bin - 1] as usize;
            let (area, rest) = right[bin];
            if count > 0 && rest > 0 {
                let cost = left.half_area() * costs.tests(count) + area * costs.tests(rest);
                best.improve(cost, axis, bin, count, rest);
            }
        }
    }
    best
}

/// Whether a range that its node has no room to split should be a leaf rather than a node below.
pub(super) fn is_better_as_leaf(entries: &[Entry], extent: &Extent, costs: &Costs<'_>) -> bool {
    if entries.len() > costs.of_range(entries).most || !is_one_kind(entries) {
        return false;
    }
    let (isa, costs) = (costs.isa, costs.of_range(entries));
    let whole = extent.half_area();
    let leaf = costs.of_leaf(entries.len()) * whole;
    best_plane(entries, &costs, isa).is_none_or(|plane| leaf <= whole + plane.cost(&costs))
}

/// Makes the cut.
pub(super) fn by_plane(entries: &mut [Entry], plane: &Plane, isa: Isa) -> Split {
    match &plane.cut {
        Cut::Bin { axis, bin, bins } => {
            let at = part(entries, bins, *axis, *bin, isa);
            debug_assert_eq!(at, plane.left.1);
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

/// Puts entries in bins before `bin` first, and says how many there are.
fn part(entries: &mut [Entry], bins: &Bins, axis: usize, bin: u32, isa: Isa) -> usize {
    const CHUNK: usize = PARALLEL / 4;
    if entries.len() <= PARALLEL {
        return isa.run(
            #[inline(always)]
            || part_in_turn(entries, bins, axis, bin),
        );
    }
    let some = |chunk: &mut [Entry]| {
        isa.run(
            #[inline(always)]
            || part_in_turn(chunk, bins, axis, bin),
        )
    };
    let lefts: Vec<usize> = entries.par_chunks_mut(CHUNK).map(some).collect();
    let (at, end) = (lefts.iter().sum(), entries.len());
    // What went right in chunks that are on the left, and what went left in those on the right,
    // changes places.
    let chunks = || lefts.iter().enumerate().map(|(i, left)| (i * CHUNK, i * CHUNK + left));
    let mut from_left = chunks().map(|(start, middle)| middle.min(at)..(start + CHUNK).min(end).min(at));
    let mut from_right = chunks().map(|(start, middle)| start.max(at) - at..middle.max(at) - at);
    let (left, right) = entries.split_at_mut(at);
    let (mut a, mut b) = (0..0, 0..0);
    loop {
        while a.is_empty() {
            let Some(next) = from_left.next() else { return at };
            a = next;
        }
        while b.is_empty() {
            let Some(next) = from_right.next() else { return at };
            b = next;
        }
        let count = a.len().min(b.len());
        left[a.start..a.start + count].swap_with_slice(&mut right[b.start..b.start + count]);
        (a.start, b.start) = (a.start + count, b.start + count);
    }
}

/// The same by one thread. Which side an entry goes to nobody could foresee, so there is no branch:
/// each changes places with the first one that is not known to go left.
#[inline(always)]
fn part_in_turn(entries: &mut [Entry], bins: &Bins, axis: usize, bin: u32) -> usize {
    let mut at = 0;
    for i in 0..entries.len() {
        let goes_left = bins.of(&entries[i], axis) < bin;
        entries.swap(i, at);
        at += usize::from(goes_left);
    }
    at
}

/// Cuts in the middle, as the entries stand.
pub(super) fn halve(entries: &[Entry]) -> Split {
    let at = entries.len() / 2;
    let (left, right) = entries.split_at(at);
    Split { at, left: extent(left), right: extent(right) }
}

/// Cuts in the middle; a range that is small enough for a leaf is sorted by kind first, so that
/// kinds part.
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

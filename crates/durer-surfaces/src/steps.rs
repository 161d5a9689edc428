//! How many steps rays need on surfaces of two parameters: patches, NURBS, subdivision surfaces,
//! parametric ones, sweeps along paths, and what deforms them.
//!
//! Each thread counts for itself, so that counting costs a ray next to nothing.

use core::cell::Cell;
use core::ops::AddAssign;

/// What the rays of a thread, or of all threads together, have needed.
///
/// ```
/// use durer_surfaces::Steps;
/// Steps::take();
/// assert_eq!(Steps::take(), Steps::default());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Rays that came near such a surface.
    pub rays: u64,
    /// Evaluations of a surface: steps of Newton's method and proofs of a start or an end.
    pub evaluations: u64,
    /// Parts that were cut up, near silhouettes and where slopes vanish.
    pub cuts: u64,
    /// Crossings that Krawczyk's test proved to be there once.
    pub proven: u64,
    /// Crossings that ended at the size of rounding errors, unproven: grazing ones and clusters.
    pub unproven: u64,
    /// The most evaluations and cuts that one ray needed.
    pub most: u64,
}

thread_local! {
    static STEPS: Cell<Steps> = const {
        Cell::new(Steps { rays: 0, evaluations: 0, cuts: 0, proven: 0, unproven: 0, most: 0 })
    };
}

impl Steps {
    /// What the rays of this thread have needed since this was last asked for.
    pub fn take() -> Self {
        STEPS.take()
    }

    /// Evaluations and cuts.
    pub fn total(&self) -> u64 {
        self.evaluations + self.cuts
    }
}

impl AddAssign for Steps {
    fn add_assign(&mut self, o: Self) {
        self.rays += o.rays;
        self.evaluations += o.evaluations;
        self.cuts += o.cuts;
        self.proven += o.proven;
        self.unproven += o.unproven;
        self.most = self.most.max(o.most);
    }
}

/// A ray's evaluations of one piece of a surface, and whether a crossing was proven by them.
#[inline(always)]
pub(crate) fn evaluated(evaluations: u64, proven: bool) {
    let mut steps = STEPS.get();
    steps.evaluations += evaluations;
    steps.proven += u64::from(proven);
    STEPS.set(steps);
}

/// A part that was cut up.
#[inline(always)]
pub(crate) fn cut() {
    let mut steps = STEPS.get();
    steps.cuts += 1;
    STEPS.set(steps);
}

/// How many steps the thread has made before a ray.
#[inline(always)]
pub(crate) fn before() -> u64 {
    STEPS.get().total()
}

/// A ray that is done, with what [`before`] said at its start.
#[inline(always)]
pub(crate) fn done(before: u64, unproven: usize) {
    let mut steps = STEPS.get();
    steps.rays += 1;
    steps.unproven += unproven as u64;
    steps.most = steps.most.max(steps.total().saturating_sub(before));
    STEPS.set(steps);
}

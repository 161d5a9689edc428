//! How many steps rays need on surfaces of two parameters: patches, NURBS, subdivision surfaces,
//! parametric ones, sweeps along paths, and deformed ones.
//!
//! Each thread counts for itself, so that counting costs a ray next to nothing.

use core::cell::Cell;
use core::ops::AddAssign;

/// Counts of the steps that rays needed on such surfaces.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{BezierPatch, Closest, LocalRay, Steps, Surface};
/// let corners = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [1.0, 2.0, 1.0]];
/// let patch = BezierPatch::new([2, 2], &corners.map(Point3::from))?;
/// Steps::take();
/// patch.roots(&LocalRay::new(&Ray::new(Point3::new(0.3, 0.8, -3.0), Vec3::Z)), &mut Closest::default());
/// let steps = Steps::take();
/// assert_eq!((steps.rays, steps.proven, steps.unproven), (1, 1, 0));
/// assert_eq!(Steps::take(), Steps::default());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Rays that came near such a surface.
    pub rays: u64,
    /// Evaluations of a surface: steps of Newton's method and proofs of a start or an end.
    pub evaluations: u64,
    /// Parts of a surface that were subdivided: near silhouettes and where slopes vanish.
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
    /// Returns the counts of this thread since the last call, and clears them.
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

/// Counts a ray's evaluations of one piece of a surface, and the crossing that they proved.
#[inline(always)]
pub(crate) fn evaluated(evaluations: u64, proven: bool) {
    let mut steps = STEPS.get();
    steps.evaluations += evaluations;
    steps.proven += u64::from(proven);
    STEPS.set(steps);
}

/// Counts a part that was subdivided.
#[inline(always)]
pub(crate) fn cut() {
    let mut steps = STEPS.get();
    steps.cuts += 1;
    STEPS.set(steps);
}

/// The steps of the thread before a ray.
#[inline(always)]
pub(crate) fn before() -> u64 {
    STEPS.get().total()
}

/// Counts a ray. `before` is the result of [`before`] at its start.
#[inline(always)]
pub(crate) fn done(before: u64, unproven: usize) {
    let mut steps = STEPS.get();
    steps.rays += 1;
    steps.unproven += unproven as u64;
    steps.most = steps.most.max(steps.total().saturating_sub(before));
    STEPS.set(steps);
}

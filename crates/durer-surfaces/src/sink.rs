//! Receivers of roots: closest, any, all.

use crate::Root;
use core::ops::ControlFlow;

/// A receiver of roots.
pub trait Sink {
    /// The range of `t` (caller's parameter) in which a root may still matter, both ends included.
    /// A producer may skip a root whose bracket lies outside, and does nothing else with it.
    fn range(&self) -> (f64, f64);

    /// The parameter (the caller's) beyond which roots can no longer matter. A producer may stop
    /// before roots whose brackets start beyond it; it must not enter arithmetic either.
    fn limit(&self) -> f64 {
        f64::INFINITY
    }

    /// Takes a root. Returns `Break` if no more are wanted.
    fn push(&mut self, root: Root) -> ControlFlow<()>;
}

/// Passes everything on to a sink of any type. Since its own type is sized, it can become a
/// `dyn Sink`, so that a kernel behind `dyn Sink` is compiled once.
#[derive(Debug)]
pub struct Forward<'k, K: ?Sized>(pub &'k mut K);

impl<K: Sink + ?Sized> Sink for Forward<'_, K> {
    fn range(&self) -> (f64, f64) {
        self.0.range()
    }

    fn limit(&self) -> f64 {
        self.0.limit()
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        self.0.push(root)
    }
}

/// Keeps the least root by `t`; of equal roots the first, since surfaces push in the exact order.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closest {
    /// The least root so far.
    pub root: Option<Root>,
}

impl Sink for Closest {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, self.root.map_or(f64::INFINITY, |r| r.hi))
    }

    #[inline(always)]
    fn limit(&self) -> f64 {
        self.root.map_or(f64::INFINITY, |r| r.hi)
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if self.root.is_none_or(|best| root.t < best.t) {
            self.root = Some(root);
        }
        ControlFlow::Continue(())
    }
}

/// Stops at the first root.
#[derive(Clone, Copy, Debug, Default)]
pub struct Any {
    /// Whether there was a root.
    pub hit: bool,
}

impl Sink for Any {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    #[inline(always)]
    fn push(&mut self, _: Root) -> ControlFlow<()> {
        self.hit = true;
        ControlFlow::Break(())
    }
}

/// Keeps every root.
#[derive(Clone, Debug, Default)]
pub struct All {
    /// The roots, in the order of arrival.
    pub roots: Vec<Root>,
}

impl Sink for All {
    #[inline(always)]
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    #[inline(always)]
    fn push(&mut self, root: Root) -> ControlFlow<()> {
        self.roots.push(root);
        ControlFlow::Continue(())
    }
}

/// Decides whether a ray that starts on a solid's surface goes into the solid: its first crossing
/// ahead leaves the solid; without one, the crossing at the start enters it.
#[derive(Clone, Copy, Debug, Default)]
pub struct FirstCrossing {
    at_start: Option<i8>,
    ahead: Option<i8>,
}

impl FirstCrossing {
    /// Whether the ray goes into the solid.
    pub fn enters(&self) -> bool {
        match (self.ahead, self.at_start) {
            (Some(ahead), _) => ahead > 0,
            (None, at_start) => at_start.is_some_and(|sign| sign < 0),
        }
    }
}

impl Sink for FirstCrossing {
    fn range(&self) -> (f64, f64) {
        (0.0, f64::INFINITY)
    }

    fn push(&mut self, root: Root) -> ControlFlow<()> {
        if root.sign == 0 {
            return ControlFlow::Continue(());
        }
        if root.lo <= 0.0 {
            self.at_start = Some(root.sign);
            return ControlFlow::Continue(());
        }
        self.ahead = Some(root.sign);
        ControlFlow::Break(())
    }
}

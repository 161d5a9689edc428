//! Exact roots of a cubic on `[-1/2, 1/2]`, including those at the ends.

use super::profile_hits::Meet;
use core::cmp::Ordering;
use core::cmp::Ordering::{Greater, Less};
use durer_math::{Dyadic, Ring};
use durer_roots::exact::{ExactRoots, Isolated};

/// The direction of the change of sign of a polynomial with these signs before and after a root.
#[inline(always)]
pub(crate) fn turn(before: Ordering, after: Ordering) -> i8 {
    match (before, after) {
        (Less, Greater) => 1,
        (Greater, Less) => -1,
        _ => 0,
    }
}

/// The value of a polynomial.
pub(crate) fn at(p: &[Dyadic], y: f64) -> Dyadic {
    let y = Dyadic::from(y);
    p.iter().rev().fold(Dyadic::ZERO, |sum, a| &(&sum * &y) + a)
}

/// A polynomial on `[-1/2, 1/2]`, which may vanish at the ends.
pub(crate) struct Ends {
    /// Whether it crosses zero at the first end, and at the last, if zero counts as positive.
    pub(crate) first: bool,
    pub(crate) last: bool,
    /// The polynomial without its roots at the ends.
    pub(crate) exact: ExactRoots,
    /// Whether, between the ends, the given polynomial has the opposite sign of `exact`.
    turned: bool,
}

impl Ends {
    /// Divides by the roots at the ends. `None` if the polynomial is zero everywhere.
    pub(crate) fn new(mut p: Vec<Dyadic>) -> Option<Self> {
        while p.last()?.is_zero() {
            p.pop();
        }
        let mut strip = |end: f64| {
            let mut times = 0;
            while at(&p, end).is_zero() {
                // W. G. Horner's scheme: the quotient by y - end.
                let y = Dyadic::from(end);
                for k in (1..p.len() - 1).rev() {
                    p[k] = &p[k] + &(&p[k + 1] * &y);
                }
                p.remove(0);
                times += 1;
            }
            times
        };
        let (at_first, at_last) = (strip(-0.5), strip(0.5));
        // y - 1/2 is negative between the ends.
        let turned = at_last % 2 == 1;
        let is_minus = |y: f64| at(&p, y).exact_sign() == if turned { Greater } else { Less };
        let (first, last) = (at_first > 0 && is_minus(-0.5), at_last > 0 && is_minus(0.5));
        Some(Self { first, last, exact: ExactRoots::new(p)?, turned })
    }

    /// The roots between two numbers that may themselves be roots, without those at the ends.
    pub(crate) fn isolated(&self, lo: f64, hi: f64) -> Vec<Isolated> {
        let beside = |y: f64, away: f64| {
            if y.abs() >= 0.5 { Dyadic::from(0.5_f64.copysign(y)) } else { self.exact.beside(y, away) }
        };
        self.exact.isolate(&beside(lo, -1.0), &beside(hi, 1.0))
    }

    pub(crate) fn turn(&self, root: &Isolated) -> i8 {
        let turn = turn(root.before, root.after);
        if self.turned { -turn } else { turn }
    }
}

/// A crossing as an exact root.
pub(crate) enum Exactly {
    /// At an end of the piece.
    At(f64),
    Root(Box<(Ends, Isolated)>),
}

impl Exactly {
    /// The exact root of a crossing. If several are so close together that brackets do not separate
    /// them, the one that turns as the crossing does.
    pub(crate) fn new(g: Vec<Dyadic>, meet: &Meet) -> Option<Self> {
        if meet.lo == meet.hi && meet.y.abs() == 0.5 && at(&g, meet.y).is_zero() {
            return Some(Self::At(meet.y));
        }
        let ends = Ends::new(g)?;
        // A root may be nearer to the end of a bracket than the spacing of f64.
        let roots = ends.isolated(meet.lo.next_down(), meet.hi.next_up());
        let found = roots.iter().find(|root| ends.turn(root) == meet.turn).or(roots.first())?.clone();
        Some(Self::Root(Box::new((ends, found))))
    }

    /// An interval with exact ends that contains the root, no wider than `2^log`.
    pub(crate) fn narrowed(&mut self, log: i32) -> (Dyadic, Dyadic) {
        match self {
            Self::At(y) => (Dyadic::from(*y), Dyadic::from(*y)),
            Self::Root(found) => {
                let (ends, root) = &mut **found;
                ends.exact.narrowed(root, &Dyadic::from(1.0).scale2(log))
            }
        }
    }

    /// The sign of a polynomial at the root.
    pub(crate) fn sign(&self, q: &[Dyadic]) -> Ordering {
        match self {
            Self::At(y) => at(q, *y).exact_sign(),
            Self::Root(found) => found.0.exact.sign_at_root(q, &found.1),
        }
    }
}

/// The sign of `q` at a crossing of `g`.
pub(super) fn exact_sign(g: Vec<Dyadic>, meet: &Meet, q: &[Dyadic]) -> Option<Ordering> {
    Some(Exactly::new(g, meet)?.sign(q))
}

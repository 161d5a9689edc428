//! Crossings of a line in the plane of the outlines with their curves.
//!
//! A ray and the direction of a linear sweep, or the apex of a conic one, span a plane; its trace
//! in the plane of the outlines is a line, `n·(x, 1, z) = 0`. It meets a piece `c(u)` where the
//! cubic `g(u) = n·(x(u), 1, z(u))` vanishes. Signs of `g` are exact, and zero counts as positive,
//! as if the line were moved aside by an infinitesimal distance, the whole line and for all pieces
//! alike. So a line through the common end of two pieces meets both, one or none of them, just as a
//! line beside it does, and it meets closed curves an even number of times.
//!
//! The order of points along the line is that of `r·(x, 1, z)`, which is zero at a given point of
//! the line, the reference point, and grows in the direction of the ray.

use super::exact::{Ends, at, exact_sign, turn};
use super::forms::{Coefficient, Cut, Form, along, value};
use super::profile_curve::{ProfileCurve, View};
use crate::planar::{AlongRay, Line, exact_line, with_denominator_near_one};
use crate::{PREVIEW_WIDTH, RingRay};
use core::cmp::Ordering;
use core::cmp::Ordering::{Greater, Less};
use core::ops::ControlFlow;
use durer_math::{Dd, Dyadic, EFloat, Ring, U};
use durer_roots::polynomial::{Along, Found, Stretch, solve};
use durer_roots::quadratic::{Limits, NARROW};

/// Covers results below the normal range.
const FLOOR: f64 = durer_math::scale::pow2(-500);

/// A line in space, its cut through the curves, and the forms of the cut in f64.
pub(super) struct Scan<'a, L> {
    pub(super) line: &'a L,
    pub(super) view: &'a View,
    cut: Cut<'a>,
    /// The form of the line.
    pub(super) n: Form<EFloat>,
    /// The form that grows along the line; zero everywhere for [`Cut::Ray`].
    pub(super) r: Form<EFloat>,
}

/// A crossing of the line with a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meet {
    /// `u - 1/2`, and its bracket.
    pub(crate) y: f64,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// 1 where `g` rises, -1 where it falls, 0 where it touches zero.
    pub(crate) turn: i8,
    /// False if the line is not known well enough to be certain.
    pub(crate) certain: bool,
}

/// The values of a form at a piece's control points, with one common error.
struct Corners {
    g: [f64; 4],
    e: f64,
}

impl Corners {
    /// Each value takes three roundings of numbers no larger than the sum of the terms.
    #[inline(always)]
    fn new(f: &Form<EFloat>, piece: &ProfileCurve) -> Self {
        let [[x0, x1, x2, x3], [z0, z1, z2, z3]] = piece.seen;
        let [a, b, c] = [f[0].v, f[1].v, f[2].v];
        #[inline(always)]
        fn at([a, b, c]: [f64; 3], x: f64, z: f64) -> f64 {
            a.mul_add(x, c.mul_add(z, b))
        }
        let f0 = [a, b, c];
        let g = [at(f0, x0, z0), at(f0, x1, z1), at(f0, x2, z2), at(f0, x3, z3)];
        let rounding = a.abs().mul_add(piece.reach[0], c.abs().mul_add(piece.reach[1], b.abs())) * (4.0 * U);
        let own = f[0].e.mul_add(piece.reach[0], f[2].e.mul_add(piece.reach[1], f[1].e));
        let seen = (a.abs() + f[0].e).mul_add(piece.slack[0], (c.abs() + f[2].e) * piece.slack[1]);
        Self { g, e: (rounding + own + seen) * (1.0 + 32.0 * U) + FLOOR }
    }

    /// Whether all are certainly positive, or certainly negative.
    #[inline(always)]
    fn all(&self, sign: Ordering) -> bool {
        let [a, b, c, d] = self.g;
        match sign {
            Greater => a.min(b).min(c.min(d)) > self.e,
            _ => a.max(b).max(c.max(d)) < -self.e,
        }
    }

    /// The sign of one value, if it is certain.
    #[inline(always)]
    fn sign(&self, i: usize) -> Option<Ordering> {
        if self.g[i] > self.e {
            Some(Greater)
        } else if self.g[i] < -self.e {
            Some(Less)
        } else {
            None
        }
    }
}

/// A form at a control point, as a polynomial of the ray.
struct Corner<'a, L> {
    scan: &'a Scan<'a, L>,
    at: [f64; 2],
}

impl<L: Line> AlongRay for Corner<'_, L> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let (n, _) = self.scan.forms(ray)?;
        Some(value(&n, self.scan.view.seen(self.at)))
    }
}

/// One line and one piece.
struct Shadow<'a, L> {
    scan: &'a Scan<'a, L>,
    piece: &'a ProfileCurve,
}

impl<L: Line> Along<4> for Shadow<'_, L> {
    #[inline(always)]
    fn double(&self) -> [EFloat; 4] {
        along(&self.scan.n, &self.piece.powers)
    }

    #[inline(always)]
    fn wide(&self) -> Option<[EFloat<Dd>; 4]> {
        let ray = with_denominator_near_one(self.scan.line.double()?);
        let (n, _) = self.scan.forms(&ray)?;
        Some(along(&n, &self.piece.in_powers(self.scan.view)))
    }

    fn exact(&self) -> (Vec<Dyadic>, bool) {
        let (ray, certain) = exact_line(self.scan.line);
        (self.scan.exact_powers(self.piece, &ray), certain)
    }
}

impl<'a, L: Line> Scan<'a, L> {
    #[inline(always)]
    pub(super) fn new(line: &'a L, view: &'a View, cut: Cut<'a>) -> Self {
        let unknown = || [EFloat::with_error(0.0, f64::INFINITY); 3];
        let forms = cut.forms(view.sweep, &line.running());
        let (n, r) = forms.unwrap_or_else(|| (unknown(), unknown()));
        Self { line, view, cut, n, r }
    }

    /// Whether the trace is a point instead of a line.
    #[inline(always)]
    pub(super) fn vanishes(&self) -> bool {
        let is_zero = |i: usize| match self.n[i].sign() {
            Some(sign) => sign.is_eq(),
            None => self.line.sign_climb(&Coefficient(self.view.sweep, i)).is_some_and(Ordering::is_eq),
        };
        is_zero(0) && is_zero(2) && is_zero(1)
    }

    /// Both forms, in a ring.
    #[inline(always)]
    pub(super) fn forms<T: Ring>(&self, ray: &RingRay<T>) -> Option<(Form<T>, Form<T>)> {
        self.cut.forms(self.view.sweep, ray)
    }

    /// Both forms, exactly.
    fn exact_forms(&self, ray: &RingRay<Dyadic>) -> (Form<Dyadic>, Form<Dyadic>) {
        let zero = || [Dyadic::ZERO, Dyadic::ZERO, Dyadic::ZERO];
        self.forms(ray).unwrap_or_else(|| (zero(), zero()))
    }

    fn exact_powers(&self, piece: &ProfileCurve, ray: &RingRay<Dyadic>) -> Vec<Dyadic> {
        along(&self.exact_forms(ray).0, &piece.in_powers(self.view)).to_vec()
    }

    /// The sign of `g` at a control point, `Equal` only where it is zero.
    #[inline(always)]
    fn corner(&self, piece: &ProfileCurve, i: usize, g: &Corners) -> Ordering {
        match g.sign(i) {
            Some(sign) => sign,
            // Not exactly known: any sign is correct, if it is the same for both pieces that end
            // here.
            None => self.line.sign_climb(&Corner { scan: self, at: piece.points[i] }).unwrap_or(Greater),
        }
    }

    /// Passes the crossings of the line with a piece to `f`, in the order of `u`.
    #[inline(always)]
    pub(super) fn meets(&self, piece: &ProfileCurve, mut f: impl FnMut(Meet)) {
        let g = Corners::new(&self.n, piece);
        // The common case: all control points, and so the whole curve, on one side.
        if g.all(Greater) || g.all(Less) {
            return;
        }
        if g.sign(0).is_none() || g.sign(3).is_none() {
            self.exact_meets(piece, &mut f);
            return;
        }
        // Usually the bracket is as narrow as f64 allows; where it matters on the ray, it is
        // narrowed later.
        let limits = Limits { lo: -1.0, hi: 1.0, origin: 0.0, width: PREVIEW_WIDTH };
        solve(
            &Shadow { scan: self, piece },
            Stretch::Within { mid: 0.0, half: 0.5 },
            &limits,
            #[inline(always)]
            |found: &Found<'_>| {
                f(Meet {
                    y: found.s,
                    lo: found.lo,
                    hi: found.hi,
                    turn: turn(found.before, found.after),
                    certain: found.certain,
                });
                ControlFlow::Continue(())
            },
        );
    }

    /// [`Scan::meets`] where the line passes through an end of the piece, or so near that f64
    /// cannot decide.
    #[cold]
    #[inline(never)]
    fn exact_meets(&self, piece: &ProfileCurve, f: &mut dyn FnMut(Meet)) {
        let (ray, certain) = exact_line(self.line);
        let Some(roots) = Ends::new(self.exact_powers(piece, &ray)) else { return };
        if roots.first {
            f(Meet { y: -0.5, lo: -0.5, hi: -0.5, turn: -1, certain });
        }
        for mut root in roots.isolated(-0.5, 0.5) {
            let enough = |lo: f64, hi: f64| hi - lo <= NARROW * 0.25;
            let (lo, hi) = roots.exact.bracket(&mut root, enough);
            let y = (lo + 0.5 * (hi - lo)).clamp(lo, hi);
            f(Meet { y, lo, hi, turn: roots.turn(&root), certain });
        }
        if roots.last {
            f(Meet { y: 0.5, lo: 0.5, hi: 0.5, turn: 1, certain });
        }
    }

    /// Whether the line meets a piece an odd number of times behind the reference point.
    #[inline(always)]
    pub(super) fn is_odd_behind(&self, piece: &ProfileCurve) -> bool {
        let g = Corners::new(&self.n, piece);
        if g.all(Greater) || g.all(Less) {
            return false;
        }
        let r = Corners::new(&self.r, piece);
        if r.all(Greater) {
            return false;
        }
        if r.all(Less) {
            // The parity is that of the changes of sign.
            return self.corner(piece, 0, &g).is_lt() != self.corner(piece, 3, &g).is_lt();
        }
        let mut odd = false;
        self.meets(
            piece,
            #[inline(always)]
            |meet| odd ^= meet.turn != 0 && self.is_behind(piece, &meet),
        );
        odd
    }

    /// Whether a crossing is behind the reference point; false if it is at that point.
    #[inline(always)]
    pub(super) fn is_behind(&self, piece: &ProfileCurve, meet: &Meet) -> bool {
        self.order(piece, meet).is_some_and(Ordering::is_lt)
    }

    /// The order of a crossing and the reference point; `None` only if the line is not exactly
    /// known.
    #[inline(always)]
    pub(super) fn order(&self, piece: &ProfileCurve, meet: &Meet) -> Option<Ordering> {
        match value(&self.r, ProfileCurve::at(&piece.powers, &meet.running())).sign() {
            Some(sign) => Some(sign),
            None => self.exact_order(piece, meet),
        }
    }

    #[cold]
    #[inline(never)]
    fn exact_order(&self, piece: &ProfileCurve, meet: &Meet) -> Option<Ordering> {
        let ray = self.line.exact()?;
        let (n, r) = self.exact_forms(&ray);
        let powers = piece.in_powers(self.view);
        exact_sign(along(&n, &powers).to_vec(), meet, &along(&r, &powers))
    }

    /// Whether the reference point lies on the piece, exactly.
    pub(super) fn touches(&self, piece: &ProfileCurve) -> bool {
        for form in [&self.n, &self.r] {
            let corners = Corners::new(form, piece);
            if corners.all(Greater) || corners.all(Less) {
                return false;
            }
        }
        let (ray, _) = exact_line(self.line);
        let (n, r) = self.exact_forms(&ray);
        let powers = piece.in_powers(self.view);
        let [g, r] = [n, r].map(|f| along(&f, &powers).to_vec());
        let is_zero = |p: &[Dyadic], y: f64| at(p, y).is_zero();
        if [-0.5, 0.5].iter().any(|&y| is_zero(&g, y) && is_zero(&r, y)) {
            return true;
        }
        match (Ends::new(g), Ends::new(r.clone())) {
            // The whole piece lies on the line: is the point within it?
            (None, Some(r)) => !r.isolated(-0.5, 0.5).is_empty(),
            (None, None) => true,
            (Some(g), _) => g.isolated(-0.5, 0.5).iter().any(|root| g.exact.sign_at_root(&r, root).is_eq()),
        }
    }
}

impl Meet {
    /// `y` with its error.
    #[inline(always)]
    pub(super) fn running(&self) -> EFloat {
        EFloat::with_error(self.y, (self.hi - self.y).max(self.y - self.lo))
    }
}

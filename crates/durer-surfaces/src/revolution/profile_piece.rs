//! The walls that enclose a solid of revolution between two of its heights.

use super::packet::RevolutionWall;
use super::profile::{Cubic, Spindle};
use crate::faces::chart::Frame;
use crate::planar::{AlongRay, Line, PointLine, Probe};
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::{LocalPoint, LocalRay, RingRay, Root, Side};
use core::cmp::Ordering;
use durer_math::{Dyadic, EFloat, Isa, Ring, Vec3};
use durer_roots::quadratic::Quadratic;

/// The wall between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wall {
    Cubic(Cubic),
    Spindle(Spindle),
}

impl Wall {
    /// Whether a point known within `err` is inside; `None` if that is uncertain.
    #[inline(always)]
    pub(super) fn rough(&self, at: Vec3, err: Vec3) -> Option<bool> {
        let run = |x: f64, e: f64| EFloat::with_error(x, e);
        let o = [run(at.x, err.x), run(at.y, err.y), run(at.z, err.z)];
        let one = EFloat::exact(1.0);
        let inside = |sign: Option<Ordering>| sign.filter(|s| s.is_ne()).map(Ordering::is_lt);
        match self {
            Self::Cubic(w) => inside(w.at(&o, &one).sign()),
            Self::Spindle(w) => {
                let zero = || EFloat::exact(0.0);
                let ray = RingRay { o, d: [zero(), zero(), zero()], w: one };
                match inside(w.inner(&ray).c.sign()) {
                    Some(false) => Some(false),
                    inner => {
                        inside(w.at(&o, &one).sign()).and_then(|is| if is { inner } else { Some(false) })
                    }
                }
            }
        }
    }

    /// The wall for packets, no wider than `radius`; `None` if its polynomial has another sheet
    /// within that radius.
    pub(super) fn for_lanes(&self, radius: f64) -> Option<RevolutionWall> {
        let stand = match self {
            Self::Cubic(w) => &w.stand,
            Self::Spindle(w) => &w.stand,
        };
        let (at, slab) = (stand.at_height(), stand.slab);
        match *self {
            Self::Cubic(Cubic { a: p, .. }) => Some(RevolutionWall {
                alpha: 0.0,
                kappa: 0.0,
                beta: 1.0,
                p,
                at,
                slab,
                radius,
                kappa_size: 0.0,
            }),
            Self::Spindle(Spindle { major, minor, .. }) => {
                let far = (slab[0] - at).abs().max((slab[1] - at).abs());
                let outer = major + (minor * minor - far * far).max(major * major).sqrt();
                let (kappa, beta) = ((major - minor) * (major + minor), 4.0 * major * major);
                let kappa_size = major * major + minor * minor;
                let wall =
                    RevolutionWall { alpha: -1.0, kappa, beta, p: [0.0; 4], at, slab, radius, kappa_size };
                (outer > radius * (1.0 + 1.0 / 16.0)).then_some(wall)
            }
        }
    }

    pub(super) fn polynomial(&self, ray: &RingRay<Dyadic>) -> Vec<Dyadic> {
        match self {
            Self::Cubic(w) => w.along(ray).to_vec(),
            Self::Spindle(w) => w.along(ray).to_vec(),
        }
    }

    /// The polynomial that is negative on the wall's own sheet, if there are others.
    pub(super) fn sheet(&self, ray: &RingRay<Dyadic>) -> Option<Vec<Dyadic>> {
        match self {
            Self::Cubic(_) => None,
            Self::Spindle(w) => {
                let Quadratic { a, b, c } = w.inner(ray);
                Some(vec![c, b.scale2(1), a])
            }
        }
    }

    pub(super) fn sign_at_root(
        &self,
        ray: &LocalRay<'_>,
        root: &Root,
        q: &Quadratic<Dyadic>,
    ) -> Option<Ordering> {
        match self {
            Self::Cubic(w) => polynomial_surface::sign_at_root(w, ray, root, q),
            Self::Spindle(w) => polynomial_surface::sign_at_root(w, ray, root, q),
        }
    }

    /// Whether a root is on the wall's own sheet.
    pub(super) fn holds(&self, probe: &Probe<'_>, root: &Root) -> bool {
        match self {
            Self::Cubic(_) => true,
            Self::Spindle(w) => Isa::detect().run(
                #[inline(always)]
                || self.holds_here(w, probe, root),
            ),
        }
    }

    #[inline(always)]
    fn holds_here(&self, w: &Spindle, probe: &Probe<'_>, root: &Root) -> bool {
        let (lo, hi) = probe.ray.window((root.lo, root.hi));
        let s = EFloat::with_error(root.s, (hi - root.s).max(root.s - lo));
        let Quadratic { a, b, c } = w.inner(&probe.running());
        if let Some(sign) = ((a * s + b.scale2(1)) * s + c).sign().filter(|s| s.is_ne()) {
            return sign.is_lt();
        }
        let ray = probe.ray.local();
        let Some(exact) = ray.in_ring_from::<Dyadic>(w.frame().centre, w.frame().scale) else { return true };
        // On the axis, where both sheets meet, the point counts as outside by construction.
        self.sign_at_root(ray, root, &w.inner(&exact)).is_none_or(Ordering::is_lt)
    }

    pub(super) fn side(&self, point: &LocalPoint<'_>) -> Side {
        match self {
            Self::Cubic(w) => polynomial_surface::side(w, point),
            Self::Spindle(w) => {
                let Frame { centre, scale, .. } = w.frame();
                let line = PointLine::new(point, Vec3::ZERO, centre, scale);
                match line.sign(&Inner(w)) {
                    Some(Ordering::Less) => polynomial_surface::side(w, point),
                    _ => Side::Out,
                }
            }
        }
    }
}

/// `Q` of a spindle at the start of a line.
struct Inner<'a>(&'a Spindle);

impl AlongRay for Inner<'_> {
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        Some(self.0.inner(ray).c)
    }
}

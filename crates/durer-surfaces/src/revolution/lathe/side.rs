//! The side of a lathe on which a point lies: the number of times that the half line from it, at
//! its height and away from the axis, meets the profile.

use super::Lathe;
use super::boxes::MARGIN;
use super::crossings::meets;
use super::forms::{Equation, Meeting, exact_equation};
use crate::planar::{AlongRay, Line, PointLine, exact_line};
use crate::prism::curved::exact::{Ends, Exactly};
use crate::prism::curved::profile_hits::Meet;
use crate::{LocalPoint, RingRay, Side};
use core::cmp::Ordering;
use durer_math::{Dyadic, EFloat, Ring, Vec3};

/// How much farther than a point the end of a piece is from the axis, squared.
struct Beyond<'a> {
    lathe: &'a Lathe,
    point: [f64; 2],
}

impl AlongRay for Beyond<'_> {
    #[inline(always)]
    fn eval<T: Ring>(&self, ray: &RingRay<T>) -> Option<T> {
        let [r, _] = self.lathe.profile.point::<T>(self.point);
        let [x, _, z] = ray.o.clone();
        Some((r * ray.w.clone()).square() - x.square() - z.square())
    }
}

impl Lathe {
    pub(super) fn side_of(&self, point: &LocalPoint<'_>) -> Side {
        let line = PointLine::new(point, Vec3::ZERO, self.centre(), self.profile.scale);
        let run = line.running();
        let [x, y, z] = run.o;
        let err = x.e + y.e + z.e + MARGIN;
        let radius = durer_math::elementary::hypot(x.v, z.v);
        let (mut odd, mut on) = (false, false);
        self.boxes.visit_beyond(y.v, radius, err, |i| {
            if !self.pieces[i].is_surface || on {
                return;
            }
            if self.touches(&line, i) {
                on = true;
                return;
            }
            let meeting =
                Meeting { line: &line, profile: &self.profile, piece: &self.pieces[i], i, factors: None };
            meets(&meeting, &self.profile, |meet| {
                if meet.turn != 0 {
                    match self.is_beyond(&line, &run, i, &meet) {
                        Ordering::Greater => odd = !odd,
                        Ordering::Less => {}
                        Ordering::Equal => on = true,
                    }
                }
            });
        });
        match (on, odd) {
            (true, _) => Side::On,
            (false, true) => Side::In,
            (false, false) => Side::Out,
        }
    }

    /// Whether a piece is farther from the axis than the point where it has the point's height.
    fn is_beyond(&self, line: &PointLine<'_>, run: &RingRay<EFloat>, i: usize, meet: &Meet) -> Ordering {
        let (r, _) = self.pieces[i].running();
        let half = (meet.hi - meet.y).max(meet.y - meet.lo).next_up();
        let r = super::profile::Piece::at(&r, &EFloat::with_error(meet.y, half));
        let quick = (r * run.w).square() - run.o[0].square() - run.o[2].square();
        if let Some(sign) = quick.sign() {
            return sign;
        }
        let (ray, _) = exact_line(line);
        let equation = exact_equation(Equation::Level, &self.profile, i, &ray);
        Exactly::new(equation, meet).map_or(Ordering::Equal, |root| root.sign(&self.beyond(&ray, i)))
    }

    /// `(W r(w))² - x² - z²`.
    fn beyond(&self, ray: &RingRay<Dyadic>, i: usize) -> Vec<Dyadic> {
        let r = self.profile.powers::<Dyadic>(i).0.map(|r| &r * &ray.w);
        let mut out = super::exact::product(&r, &r);
        out[0] = &(&out[0] - &(&ray.o[0] * &ray.o[0])) - &(&ray.o[2] * &ray.o[2]);
        out
    }

    /// Whether the point is on a piece, where [`meets`] does not see that: at an end, at a root
    /// that is not crossed, or anywhere on a flat piece.
    fn touches(&self, line: &PointLine<'_>, i: usize) -> bool {
        let run = line.running();
        // Certainly not at the piece: `P` and the height have no common root, as far as f64 knows.
        let (r, y) = self.pieces[i].running();
        let whole = EFloat::with_error(0.0, 0.5);
        let near = |a: &[EFloat; 4]| super::profile::Piece::at(a, &whole);
        let height = run.w * near(&y) - run.o[1];
        let radius = (near(&r) * run.w).square() - run.o[0].square() - run.o[2].square();
        if height.sign().is_some_and(Ordering::is_ne) || radius.sign().is_some_and(Ordering::is_ne) {
            return false;
        }
        let at_end = |last: bool| {
            let point = self.profile.end(i, last);
            let meeting = Meeting { line, profile: &self.profile, piece: &self.pieces[i], i, factors: None };
            line.sign(&meeting.at_end(last)).is_none_or(Ordering::is_eq)
                && line.sign(&Beyond { lathe: self, point }).is_none_or(Ordering::is_eq)
        };
        if at_end(false) || at_end(true) {
            return true;
        }
        let (ray, _) = exact_line(line);
        let height = exact_equation(Equation::Level, &self.profile, i, &ray);
        let beyond = self.beyond(&ray, i);
        match (Ends::new(height), Ends::new(beyond.clone())) {
            (None, Some(r)) => !r.isolated(-0.5, 0.5).is_empty(),
            (None, None) => true,
            (Some(g), _) => {
                g.isolated(-0.5, 0.5).iter().any(|root| g.exact.sign_at_root(&beyond, root).is_eq())
            }
        }
    }
}

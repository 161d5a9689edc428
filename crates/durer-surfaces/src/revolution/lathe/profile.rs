//! The profile of a lathe: its spline, cut into polynomial pieces, and how they are joined.
//!
//! With `u` from 0 to 1 on each piece:
//!
//! ```text
//!   linear     p0 p1         p0 + u (p1 - p0)
//!   quadratic  p0 [p1 p2]    p1 + u (p2 - p0) / 2 + u² ((p0 + p2) / 2 - p1)
//!   cubic      p0 [p1 p2] p3 p1 + u (p2 - p0) / 2 + u² (p0 - 5/2 p1 + 2 p2 - p3 / 2)
//!                               + u³ ((p3 - p0) / 2 + 3/2 (p1 - p2))
//!   Bezier     [p0 p1 p2 p3] the cubic with these control points
//! ```
//!
//! The curve runs between the points in brackets. Cubic splines are those of E. Catmull, R. Rom, "A
//! class of local interpolating splines", *Computer Aided Geometric Design* (ed. Barnhill,
//! Riesenfeld), 1974. All factors are multiples of `1/2`, so the coefficients are exact in a ring:
//! the surface is that of the given numbers, and neighbours share the same end.

use super::LatheError;
use core::cmp::Ordering;
use durer_math::{Dd, Dyadic, EFloat, Ring, U};

/// How points define the profile of a lathe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatheSpline {
    /// Straight lines between successive points.
    Linear,
    /// Parabolas; the first point only determines a slope.
    Quadratic,
    /// Cubics; the first and the last point only determine slopes.
    Cubic,
    /// Four control points for each piece. Successive pieces need not be joined.
    Bezier,
}

impl LatheSpline {
    /// The least number of points.
    #[must_use]
    pub fn least_points(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::Quadratic => 3,
            Self::Cubic | Self::Bezier => 4,
        }
    }

    /// Whether the profile through these points is a single point, or lies on the axis, so that it
    /// sweeps no surface.
    #[must_use]
    pub fn is_on_axis(self, points: &[[f64; 2]]) -> bool {
        let Ok(profile) = Profile::new(self, points) else { return false };
        !(0..profile.len()).any(|i| profile.is_surface(i))
    }

    /// The number of pieces that `points` points define.
    pub(super) fn pieces(self, points: usize) -> usize {
        match self {
            Self::Bezier => points / 4,
            _ => (points + 1).saturating_sub(self.least_points()),
        }
    }

    /// The degree of the pieces.
    pub(super) fn degree(self) -> usize {
        match self {
            Self::Linear => 1,
            Self::Quadratic => 2,
            Self::Cubic | Self::Bezier => 3,
        }
    }
}

/// No piece.
const NONE: u32 = u32::MAX;

/// The spline, its points `[r, y]`, and the frame: the centre's height and the unit of length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Profile {
    pub(super) spline: LatheSpline,
    pub(super) points: Vec<[f64; 2]>,
    pub(super) centre: f64,
    pub(super) scale: i32,
    /// The pieces before and after each piece, at which it is joined; [`NONE`] at a free end.
    joints: Vec<[u32; 2]>,
    /// Whether every curve of the profile is closed, or ends on the axis on both sides.
    pub(super) is_closed: bool,
}

/// A polynomial `a_0 + a_1 w + a_2 w² + a_3 w³`.
pub(super) type Cubic<T> = [T; 4];

/// A piece in f64, in the frame, in powers of `w = u - 1/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// The radius, which may be negative, and the height.
    pub(super) r: [f64; 4],
    pub(super) y: [f64; 4],
    /// Bounds of the error of each coefficient.
    pub(super) r_err: f64,
    pub(super) y_err: f64,
    /// Upper bounds of the sums of the coefficients' magnitudes.
    pub(super) r_sum: f64,
    pub(super) y_sum: f64,
    /// Coefficients of higher powers are exactly zero.
    pub(super) degree: u8,
    /// False for a point, and for a piece that lies on the axis: it is not a surface.
    pub(super) is_surface: bool,
}

impl Profile {
    pub(super) fn new(spline: LatheSpline, points: &[[f64; 2]]) -> Result<Self, LatheError> {
        let least = spline.least_points();
        if points.len() < least {
            return Err(LatheError::TooFew { least, got: points.len() });
        }
        if spline == LatheSpline::Bezier && !points.len().is_multiple_of(4) {
            return Err(LatheError::NotFours(points.len()));
        }
        if let Some(number) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            let [radius, height] = points[number];
            return Err(LatheError::Point { number: number + 1, radius, height });
        }
        let count = spline.pieces(points.len());
        if count >= NONE as usize {
            return Err(LatheError::Range);
        }
        let mut profile = Self {
            spline,
            points: points.to_vec(),
            centre: 0.0,
            scale: 0,
            joints: vec![[NONE; 2]; count],
            is_closed: true,
        };
        profile.join();
        Ok(profile)
    }

    pub(super) fn len(&self) -> usize {
        self.joints.len()
    }

    /// The control points of a piece.
    #[inline(always)]
    pub(super) fn control(&self, i: usize) -> &[[f64; 2]] {
        let (from, len) = match self.spline {
            LatheSpline::Linear => (i, 2),
            LatheSpline::Quadratic => (i, 3),
            LatheSpline::Cubic => (i, 4),
            LatheSpline::Bezier => (4 * i, 4),
        };
        self.points.get(from..from + len).unwrap_or(&[])
    }

    /// The first or the last point of a piece, in the author's numbers.
    #[inline(always)]
    pub(super) fn end(&self, i: usize, last: bool) -> [f64; 2] {
        let [first, second] = match self.spline {
            LatheSpline::Linear => [i, i + 1],
            LatheSpline::Quadratic | LatheSpline::Cubic => [i + 1, i + 2],
            LatheSpline::Bezier => [4 * i, 4 * i + 3],
        };
        self.points.get(if last { second } else { first }).copied().unwrap_or_default()
    }

    /// The piece that is joined at an end of a piece.
    #[inline(always)]
    pub(super) fn joined(&self, i: usize, last: bool) -> Option<usize> {
        let at = self.joints.get(i)?[usize::from(last)];
        (at != NONE).then_some(at as usize)
    }

    /// Whether all of these coefficients are zero, from the `first`.
    fn is_zero(&self, i: usize, k: usize, first: usize) -> bool {
        let near = self.coordinate::<EFloat<Dd>>(i, k);
        if near[first..].iter().any(|x| x.sign().is_some_and(Ordering::is_ne)) {
            return false;
        }
        self.coordinate::<Dyadic>(i, k)[first..].iter().all(Dyadic::is_zero)
    }

    /// Whether a piece is a single point.
    fn is_point(&self, i: usize) -> bool {
        self.is_zero(i, 0, 1) && self.is_zero(i, 1, 1)
    }

    /// Whether a piece is neither a single point nor on the axis.
    fn is_surface(&self, i: usize) -> bool {
        !self.is_zero(i, 0, 0) && !self.is_point(i)
    }

    /// Joins pieces that meet, and the last piece of a closed curve with its first. Points are
    /// left out.
    fn join(&mut self) {
        let mut first: Option<usize> = None;
        let mut before: Option<usize> = None;
        for i in 0..=self.len() {
            if i < self.len() && self.is_point(i) {
                continue;
            }
            let meets = i < self.len() && before.is_some_and(|b| self.end(b, true) == self.end(i, false));
            if meets {
                if let Some(b) = before {
                    self.joints[b][1] = i as u32;
                    self.joints[i][0] = b as u32;
                }
            } else {
                if let (Some(first), Some(last)) = (first, before) {
                    self.close(first, last);
                }
                first = Some(i);
            }
            before = Some(i);
        }
    }

    /// Ends a curve of the profile.
    fn close(&mut self, first: usize, last: usize) {
        let (start, end) = (self.end(first, false), self.end(last, true));
        if start == end {
            self.joints[last][1] = first as u32;
            self.joints[first][0] = last as u32;
        } else if start[0] != 0.0 || end[0] != 0.0 {
            self.is_closed = false;
        }
    }

    /// A radius or a height in the frame.
    #[inline(always)]
    fn seen<T: Ring>(&self, value: f64, k: usize) -> T {
        let x = if k == 0 { T::exact(value) } else { T::exact(value) - T::exact(self.centre) };
        x.scale2(-self.scale)
    }

    /// The radius and the height of a point, in the frame.
    #[inline(always)]
    pub(super) fn point<T: Ring>(&self, [r, y]: [f64; 2]) -> [T; 2] {
        [self.seen(r, 0), self.seen(y, 1)]
    }

    /// The radius and the height in powers of `w = u - 1/2`, in any ring.
    #[inline(always)]
    pub(super) fn powers<T: Ring>(&self, i: usize) -> (Cubic<T>, Cubic<T>) {
        (self.coordinate(i, 0), self.coordinate(i, 1))
    }

    #[inline(always)]
    fn coordinate<T: Ring>(&self, i: usize, k: usize) -> Cubic<T> {
        let zero = || T::exact(0.0);
        #[inline(always)]
        fn times<T: Ring>(x: f64, a: T) -> T {
            T::exact(x) * a
        }
        let mut seen = [zero(), zero(), zero(), zero()];
        for (seen, point) in seen.iter_mut().zip(self.control(i)) {
            *seen = self.seen(point[k], k);
        }
        // In powers of u.
        let p = |j: usize| seen[j].clone();
        let [a, b, c, d] = match self.spline {
            LatheSpline::Linear => [p(0), p(1) - p(0), zero(), zero()],
            LatheSpline::Quadratic => {
                [p(1), (p(2) - p(0)).scale2(-1), (p(0) + p(2)).scale2(-1) - p(1), zero()]
            }
            LatheSpline::Cubic => [
                p(1),
                (p(2) - p(0)).scale2(-1),
                p(0) - times(2.5, p(1)) + p(2).scale2(1) - p(3).scale2(-1),
                (p(3) - p(0)).scale2(-1) + times(1.5, p(1) - p(2)),
            ],
            LatheSpline::Bezier => [
                p(0),
                times(3.0, p(1) - p(0)),
                times(3.0, p(0) + p(2) - p(1).scale2(1)),
                p(3) - p(0) + times(3.0, p(1) - p(2)),
            ],
        };
        // Moved to the middle of the piece.
        [
            a + b.clone().scale2(-1) + c.clone().scale2(-2) + d.clone().scale2(-3),
            b + c.clone() + times(0.75, d.clone()),
            c + times(1.5, d.clone()),
            d,
        ]
    }

    /// A piece in f64.
    pub(super) fn piece(&self, i: usize) -> Piece {
        let (r, y) = self.powers::<EFloat<Dd>>(i);
        let is_surface = self.is_surface(i);
        let rounded = |a: &Cubic<EFloat<Dd>>| {
            let v = [0, 1, 2, 3].map(|k: usize| a[k].v.hi);
            let e = a.iter().fold(0.0_f64, |e, x| e.max((x.v.lo.abs() + x.e) * (1.0 + 4.0 * U)));
            let sum = (v.iter().map(|x| x.abs()).sum::<f64>() + 4.0 * e) * (1.0 + 16.0 * U);
            (v, e, sum)
        };
        let ((r, r_err, r_sum), (y, y_err, y_sum)) = (rounded(&r), rounded(&y));
        let degree = self.spline.degree() as u8;
        Piece { r, y, r_err, y_err, r_sum, y_sum, degree, is_surface }
    }

    /// Bezier control points of the range of a piece's radius and height, `[[r; 4], [y; 4]]`, in the
    /// author's numbers, and bounds of their errors.
    pub(super) fn bezier(&self, i: usize) -> ([[f64; 4]; 2], [f64; 2]) {
        let control = self.control(i);
        let mut errors = [0.0; 2];
        let axes = [0, 1].map(|k: usize| {
            let p = |j: usize| control.get(j).map_or(0.0, |p| p[k]);
            let size = control.iter().fold(0.0_f64, |m, p| m.max(p[k].abs()));
            // No more than eight roundings of numbers below four times the size.
            // Lines lie between their ends.
            let is_exact = matches!(self.spline, LatheSpline::Linear | LatheSpline::Bezier);
            errors[k] = if is_exact { 0.0 } else { size * (32.0 * U) };
            match self.spline {
                LatheSpline::Linear => [p(0), p(0), p(1), p(1)],
                LatheSpline::Quadratic => {
                    let middle = p(1) + (0.25 * p(2) - 0.25 * p(0));
                    [p(1), p(1) + (middle - p(1)) * (2.0 / 3.0), p(2) + (middle - p(2)) * (2.0 / 3.0), p(2)]
                }
                LatheSpline::Cubic => {
                    [p(1), p(1) + (p(2) / 6.0 - p(0) / 6.0), p(2) - (p(3) / 6.0 - p(1) / 6.0), p(2)]
                }
                LatheSpline::Bezier => [p(0), p(1), p(2), p(3)],
            }
        });
        (axes, errors)
    }
}

impl Piece {
    /// The value of a polynomial.
    #[inline(always)]
    pub(super) fn at<T: Ring>(a: &Cubic<T>, w: &T) -> T {
        let [a, b, c, d] = a;
        ((d.clone() * w.clone() + c.clone()) * w.clone() + b.clone()) * w.clone() + a.clone()
    }

    /// The coefficients with their errors.
    #[inline(always)]
    pub(super) fn running(&self) -> (Cubic<EFloat>, Cubic<EFloat>) {
        #[inline(always)]
        fn run(a: &[f64; 4], e: f64, degree: u8) -> Cubic<EFloat> {
            let e = |k: u8| if k > degree { 0.0 } else { e };
            [
                EFloat::with_error(a[0], e(0)),
                EFloat::with_error(a[1], e(1)),
                EFloat::with_error(a[2], e(2)),
                EFloat::with_error(a[3], e(3)),
            ]
        }
        (run(&self.r, self.r_err, self.degree), run(&self.y, self.y_err, self.degree))
    }

    /// Radius and height at `w`, and their first and second derivatives, rounded: `[r, y]` each.
    #[inline(always)]
    pub(super) fn slopes(&self, w: f64) -> [[f64; 2]; 3] {
        let value = |a: &[f64; 4]| a[3].mul_add(w, a[2]).mul_add(w, a[1]).mul_add(w, a[0]);
        let first = |a: &[f64; 4]| (3.0 * a[3]).mul_add(w, 2.0 * a[2]).mul_add(w, a[1]);
        let second = |a: &[f64; 4]| (6.0 * a[3]).mul_add(w, 2.0 * a[2]);
        let (r, y) = (&self.r, &self.y);
        [[value(r), value(y)], [first(r), first(y)], [second(r), second(y)]]
    }
}

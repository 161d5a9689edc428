//! `spline { }`: curves of a parameter `t` through points, as values and as functions.
//!
//! Between the knots `t_i` and `t_(i+1)`, at the distance `h_i`, with `s = t - t_i` and the
//! quotients `d_i = (P_(i+1) - P_i)/h_i`:
//!
//! ```text
//!   linear_spline     P_i + d_i s
//!   quadratic_spline  P_i + d_i s + q s (s - h_i),  q = (d_(j+1) - d_j)/(t_(j+2) - t_j),  j = max(i - 1, 0): a parabola through three points
//!   cubic_spline      the cubic with the slopes (d_(i-1) + d_i)/2 and (d_i + d_(i+1))/2 at its ends; the first and the last point are only for those
//!   natural_spline    cubics with two continuous derivatives, the second of which is zero at both ends
//! ```
//!
//! Beyond its ends a spline keeps its last value. That agrees with POV-Ray's values to rounding.
//! The exact spline is that of the numbers in the text: its coefficients are enclosed by intervals.

use std::rc::Rc;

use durer_formula::{Builder, Formula, FormulaError, NodeId};
use durer_math::Interval;

use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::formulas::pieces;
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::limits::Charge;
use crate::parser::{Item, Parser};
use crate::value::{Terms, Value};

/// Steps, or the error that there are too many.
type Made<T> = std::result::Result<T, FormulaError>;

/// The ways to interpolate between the points.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SplineKind {
    Linear,
    Quadratic,
    Cubic,
    Natural,
}

impl SplineKind {
    fn of(word: Keyword) -> Option<Self> {
        Some(match word {
            Keyword::LinearSpline => Self::Linear,
            Keyword::QuadraticSpline => Self::Quadratic,
            Keyword::CubicSpline => Self::Cubic,
            Keyword::NaturalSpline => Self::Natural,
            _ => return None,
        })
    }
}

/// A spline as a value.
#[derive(Clone, Debug)]
pub(crate) struct Spline {
    kind: SplineKind,
    /// Knots and points in ascending order, each knot once.
    points: Vec<(f64, [f64; 5])>,
    /// The number of components: 2 to 5.
    terms: usize,
    _charge: Charge,
}

/// One component: the knots, and the cubics between them.
struct Curve {
    knots: Vec<f64>,
    pieces: Vec<[Interval; 4]>,
}

impl Curve {
    /// A constant curve.
    fn constant(value: Interval) -> Self {
        let zero = Interval::from(0.0);
        Self { knots: vec![0.0, 1.0], pieces: vec![[value, zero, zero, zero]] }
    }

    /// The curve through these points.
    fn new(kind: SplineKind, t: &[f64], p: &[f64]) -> Self {
        let n = p.len();
        let point = |i: usize| Interval::from(p[i]);
        // POV-Ray's values where a cubic has too few points for a piece.
        match (kind, n) {
            (_, 1) => return Self::constant(point(0)),
            (SplineKind::Cubic, 2) => {
                return Self::constant((point(0) + point(1)) * Interval::from(0.5));
            }
            (SplineKind::Cubic, 3) => return Self::constant(point(1)),
            _ => {}
        }
        let zero = Interval::from(0.0);
        let step = |i: usize, j: usize| Interval::from(t[j]) - Interval::from(t[i]);
        let h: Vec<Interval> = (0..n - 1).map(|i| step(i, i + 1)).collect();
        let d: Vec<Interval> = (0..n - 1).map(|i| (point(i + 1) - point(i)) / h[i]).collect();
        let hermite = |i: usize, from: Interval, to: Interval| {
            let (two, three) = (Interval::from(2.0), Interval::from(3.0));
            let c2 = (three * d[i] - two * from - to) / h[i];
            let c3 = (from + to - two * d[i]) / h[i].square();
            [point(i), from, c2, c3]
        };
        let (first, last) = if kind == SplineKind::Cubic { (1, n - 2) } else { (0, n - 1) };
        let bends = if kind == SplineKind::Natural { natural_bends(&h, &d) } else { Vec::new() };
        let piece = |i: usize| match kind {
            SplineKind::Linear => [point(i), d[i], zero, zero],
            SplineKind::Quadratic if n == 2 => [point(i), d[i], zero, zero],
            SplineKind::Quadratic => {
                let j = i.saturating_sub(1);
                let q = (d[j + 1] - d[j]) / step(j, j + 2);
                [point(i), d[i] - q * h[i], q, zero]
            }
            SplineKind::Cubic => {
                let half = Interval::from(0.5);
                hermite(i, (d[i - 1] + d[i]) * half, (d[i] + d[i + 1]) * half)
            }
            SplineKind::Natural => {
                let (six, two) = (Interval::from(6.0), Interval::from(2.0));
                let slope = d[i] - h[i] * (two * bends[i] + bends[i + 1]) / six;
                [point(i), slope, bends[i] / two, (bends[i + 1] - bends[i]) / (six * h[i])]
            }
        };
        Self { knots: t[first..=last].to_vec(), pieces: (first..last).map(piece).collect() }
    }

    fn is_finite(&self) -> bool {
        let finite = |c: &Interval| c.lo.is_finite() && c.hi.is_finite();
        self.pieces.iter().flatten().all(finite)
    }

    /// The value at `t`, rounded.
    fn at(&self, t: f64) -> f64 {
        let last = self.knots.len() - 1;
        let t = t.clamp(self.knots[0], self.knots[last]);
        let i = self.knots[1..last].partition_point(|&knot| knot <= t);
        let s = t - self.knots[i];
        let [c0, c1, c2, c3] = self.pieces[i].map(Interval::mid);
        ((c3 * s + c2) * s + c1) * s + c0
    }

    /// The curve as steps.
    fn steps(&self, b: &mut Builder, t: NodeId) -> Made<NodeId> {
        pieces::continuous(b, t, &self.knots, &self.pieces)
    }
}

/// The second derivatives `M_i` of a natural spline, by elimination from
/// `h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 (d_i - d_(i-1))`. The matrix is
/// strictly diagonally dominant, so no pivot comes near zero.
fn natural_bends(h: &[Interval], d: &[Interval]) -> Vec<Interval> {
    let (two, six) = (Interval::from(2.0), Interval::from(6.0));
    let n = h.len();
    // Forward elimination: M_i = right_i - share_i M_(i+1).
    let (mut share, mut right) = (vec![Interval::from(0.0); n + 1], vec![Interval::from(0.0); n + 1]);
    for i in 1..n {
        let pivot = two * (h[i - 1] + h[i]) - h[i - 1] * share[i - 1];
        share[i] = h[i] / pivot;
        right[i] = (six * (d[i] - d[i - 1]) - h[i - 1] * right[i - 1]) / pivot;
    }
    let mut bends = vec![Interval::from(0.0); n + 1];
    for i in (1..n).rev() {
        bends[i] = right[i] - share[i] * bends[i + 1];
    }
    bends
}

impl Spline {
    fn curve(&self, kind: SplineKind, component: usize) -> Curve {
        let t: Vec<f64> = self.points.iter().map(|(t, _)| *t).collect();
        let p: Vec<f64> = self.points.iter().map(|(_, p)| p[component]).collect();
        Curve::new(kind, &t, &p)
    }

    /// The components as formulas of one number.
    pub(crate) fn formulas(&self) -> Made<Vec<Formula>> {
        let formula = |component| {
            let mut b = Builder::new();
            let t = b.input(0)?;
            let root = self.curve(self.kind, component).steps(&mut b, t)?;
            Ok(b.finish(root, 1))
        };
        (0..self.terms).map(formula).collect()
    }
}

impl Parser<'_> {
    /// Reads `spline { ... }`, including the word.
    pub(crate) fn spline_value(&mut self) -> Result<Spline> {
        self.next()?;
        let place = self.here();
        self.expect(Mark::BraceOpen)?;
        let (mut kind, mut points, mut terms) = (SplineKind::Linear, Vec::new(), 2);
        loop {
            if let Some(said) = self.peek_word()?.and_then(SplineKind::of) {
                self.next()?;
                kind = said;
                continue;
            }
            if let Item::Value(Value::Spline(known)) = self.peek()? {
                let known = known.clone();
                self.next()?;
                kind = known.kind;
                terms = terms.max(known.terms);
                points.extend_from_slice(&known.points);
                self.skip_comma()?;
                continue;
            }
            if self.take_mark(Mark::BraceClose)? {
                break;
            }
            let t = self.float()?;
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            let value = self.expression()?;
            if value.len() < 2 {
                return Err(Error::invalid(
                    at,
                    "a point of a spline must be a vector of two to five components, got a number",
                ));
            }
            for &part in value.as_slice() {
                crate::expression::finite(part, at)?;
            }
            terms = terms.max(value.len());
            points.push((t, value.all()));
            self.skip_comma()?;
            self.check_memory(points.len() * size_of::<(f64, [f64; 5])>(), at)?;
        }
        if points.is_empty() {
            return Err(Error::invalid(place, "this spline has no points"));
        }
        points.sort_by(|(s, _), (t, _)| s.total_cmp(t));
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let shown = |p: &[f64; 5]| p[..terms].iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            let [(t, one), (_, other)] = [pair[0], pair[1]];
            let text =
                format!("this spline has two points at t = {t}: <{}> and <{}>", shown(&one), shown(&other));
            return Err(Error::invalid(place, text));
        }
        let _charge = Charge::new(points.len() * size_of::<(f64, [f64; 5])>() + 64);
        let spline = Spline { kind, points, terms, _charge };
        self.count_steps(spline.points.len() as u64, place)?;
        if !(0..terms).all(|component| spline.curve(kind, component).is_finite()) {
            return Err(Error::invalid(
                place,
                "the points of this spline are too far apart, or too near to each other",
            ));
        }
        Ok(spline)
    }

    /// Evaluates a spline at the float in parentheses, after its name. Another kind of spline may
    /// follow the float.
    pub(crate) fn called_spline(&mut self, spline: &Rc<Spline>, place: Place) -> Result<Terms> {
        self.expect(Mark::ParenOpen)?;
        let t = self.float()?;
        let mut kind = spline.kind;
        if self.take_mark(Mark::Comma)? {
            let lexeme = self.next()?;
            kind = match lexeme.item {
                Item::Word(word) => SplineKind::of(word),
                _ => None,
            }
            .ok_or_else(|| self.unexpected(&lexeme, "a kind of spline, such as `cubic_spline`"))?;
        }
        self.expect(Mark::ParenClose)?;
        self.count_steps(spline.points.len() as u64, place)?;
        let mut point = [0.0; 5];
        for (component, value) in point.iter_mut().enumerate().take(spline.terms) {
            *value = crate::expression::finite(spline.curve(kind, component).at(t), place)?;
        }
        Ok(Terms::new(&point[..spline.terms]))
    }

    /// Reads `spline { ... }` as a function of one number.
    pub(crate) fn spline_function(&mut self) -> Result<Vec<Formula>> {
        let place = self.here();
        let spline = self.nested(Self::spline_value)?;
        spline.formulas().map_err(|error| Error::at(place, ErrorKind::Limit, error.to_string()))
    }
}

//! A profile that moves along a path: the generalised cylinder.
//!
//! ```text
//!   S(u, v) = c(u) + size(u) (a(v) X(u) + b(v) Y(u)),     X, Y and the tangent T are a frame
//! ```
//!
//! J. T. Kajiya, "New techniques for ray tracing procedurally defined objects", *SIGGRAPH* 1983;
//! W. F. Bronsvoort, F. Klok, "Ray tracing generalized cylinders", *ACM Transactions on Graphics* 4
//! (1985) 291-303.
//!
//! Inside a span of the path the frame is the smallest rotation of the span's first frame onto the
//! tangent, and then what is left of the turn to the next knot's frame, and the twist, evenly in `u`
//! (`path.rs`). With `up`, X of a curved span is at right angles to it everywhere. Straight spans begin and end in the
//! planes that halve the angles of the corners. Each piece of the profile along each span is one map
//! of a rectangle (`sheet.rs`).
//!
//! The caps are maps too: `q + r (p(v) - q)` for a point `q` of the profile's plane, which covers the
//! plane as often as the profile goes round it. So walls and caps form closed surfaces with an
//! orientation, and the solid is where their winding number is not 0. A ray adds up the signs of all
//! crossings on its line; a crossing counts where the sum leaves 0 or comes back to it.

use super::bounds::Bounds;
use super::build::Refused;
use super::crossings::{on_border, root};
use super::line::Found;
use super::path::{PathSpline, Span, framed};
use super::piece::Face;
use super::sheet::Sheet;
use crate::compose::clip::Algebraic;
use crate::mesh::Sorted;
use crate::packet::FilterSource;
use crate::prism::curved::Bezier;
use crate::tape::{Builder, FormulaError, NodeId, Op, VectorTape};
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, RootKind, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use durer_math::{Aabb, Function, Ray, Vec3};
use std::sync::Arc;

/// Why a [`PathSweep`] cannot exist. Knots count from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// The path has too few points, or points that make no whole spans.
    #[error(
        "sweep: a path of {what} needs {least} points at least, and a multiple of 4 for a bezier_spline; got {len}"
    )]
    Points {
        /// The spline.
        what: &'static str,
        /// How many it needs.
        least: usize,
        /// How many there are.
        len: usize,
    },
    /// A number is infinite or NaN.
    #[error("sweep: all numbers of {0} must be finite")]
    Finite(&'static str),
    /// A size is not positive.
    #[error("sweep: a size must be positive, got {0}")]
    Size(f64),
    /// The profile has no area.
    #[error("sweep: the profile has no pieces")]
    Profile,
    /// The tangent vanishes.
    #[error("sweep: the path has no tangent at knot {0}")]
    Tangent(usize),
    /// A span does not begin where the one before it ends.
    #[error("sweep: the path is broken at knot {0}: a span must begin where the one before it ends")]
    Gap(usize),
    /// The path turns back on itself.
    #[error("sweep: the path turns by 180 degrees at knot {0}")]
    Reversal(usize),
    /// A curved path has a corner.
    #[error("sweep: the curved path has a corner at knot {0}; only a linear_spline may have corners")]
    Corner(usize),
    /// The vector that shows upward is along the path.
    #[error("sweep: `up` is parallel to the path at knot {0}")]
    Up(usize),
    /// The formulas are too long.
    #[error("sweep: {0}")]
    Formula(#[from] FormulaError),
    /// The frame or the tangent vanishes between two knots; spans count from 0.
    #[error("sweep: inside span {0} the path has no tangent, turns by 180 degrees, or is parallel to `up`")]
    Inside(usize),
}

/// What a [`PathSweep`] is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepData {
    /// Closed outlines in the plane across the path, as Bezier pieces.
    pub outlines: Vec<Vec<Bezier>>,
    /// How the points define the path.
    pub spline: PathSpline,
    /// The points of the path and the size of the profile there, `[x, y, z, size]`.
    pub path: Vec<[f64; 4]>,
    /// The whole twist about the path, in radians, even in the path's parameter.
    pub twist: f64,
    /// The profile's second axis points to this side; of a linear path at its beginning.
    pub up: Option<Vec3>,
}

impl SweepData {
    /// The edges of a polygon, as an outline.
    pub fn edges(points: &[[f64; 2]]) -> Vec<Bezier> {
        let next = |k: usize| points[(k + 1) % points.len()];
        (0..points.len()).map(|k| [points[k], points[k], next(k), next(k)]).filter(|p| p[0] != p[3]).collect()
    }
}

/// A profile swept along a path, with size and twist; a solid, or a sheet without its caps.
///
/// Faces are the pieces of the profile along the spans, span by span, then the caps.
#[derive(Clone, Debug)]
pub struct PathSweep {
    data: Arc<SweepData>,
    pub(super) sheet: Arc<Sheet>,
    pieces: usize,
    pub(super) walls: usize,
    open: bool,
}

/// How far a point that starts a ray may be from where the ray is thought to start: the roundings of
/// three coordinates relative to the centre and of the place along the ray, as a part of the largest.
const START: f64 = 8.0 * durer_math::U;
/// How far faces reach beyond their borders: more than the frames of neighbours differ by.
const OVERLAP: f64 = durer_math::scale::pow2(-44);

impl PathSweep {
    /// The solid with flat caps.
    pub fn new(data: SweepData) -> Result<Self, SweepError> {
        let (least, len) = (data.spline.least(), data.path.len());
        if len < least || data.spline == PathSpline::Bezier && len % 4 != 0 {
            return Err(SweepError::Points { what: data.spline.name(), least, len });
        }
        if !(data.path.iter().flatten().all(|x| x.is_finite()) && data.twist.is_finite()) {
            return Err(SweepError::Finite("the path"));
        }
        if !data.outlines.iter().flatten().flatten().flatten().all(|x| x.is_finite()) {
            return Err(SweepError::Finite("the profile"));
        }
        let spans = framed(data.spline, &data.path, data.up)?;
        let control = spans.iter().flat_map(|span| &span.points);
        if let Some(p) = data.path.iter().chain(control).find(|p| p[3] <= 0.0) {
            return Err(SweepError::Size(p[3]));
        }
        let outlines = oriented(&data.outlines);
        let pieces: Vec<Bezier> = outlines.into_iter().flatten().collect();
        if pieces.is_empty() {
            return Err(SweepError::Profile);
        }
        let kind = Kind { spline: data.spline, up: data.up, twist: data.twist / spans.len() as f64 };
        let mut faces = Vec::new();
        for (number, span) in spans.iter().enumerate() {
            for piece in &pieces {
                faces.push(kind.wall(number, span, piece)?);
            }
        }
        let walls = faces.len();
        let middle = centre(&pieces);
        for piece in &pieces {
            faces.push(kind.cap(0, &spans[0], piece, middle, false)?);
        }
        let last = spans.len() - 1;
        for piece in &pieces {
            faces.push(kind.cap(last, &spans[last], piece, middle, true)?);
        }
        let number = pieces.len();
        let sheet = match Sheet::new(faces, &Bounds::NONE, OVERLAP) {
            Ok(Some(sheet)) => sheet,
            Ok(None) => return Err(SweepError::Profile),
            Err((face, Refused::Jump(_) | Refused::Unbounded(_))) => {
                return Err(SweepError::Inside(face as usize / number));
            }
        };
        Ok(Self { data: Arc::new(data), sheet: Arc::new(sheet), pieces: number, walls, open: false })
    }

    /// The same surface without its caps: a sheet.
    #[must_use]
    pub fn without_caps(mut self) -> Self {
        self.open = true;
        self
    }

    /// What it is made of.
    pub fn data(&self) -> &SweepData {
        &self.data
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        if self.open {
            let walls = self.walls as u32;
            return self.sheet.roots(ray, sink, |face| face < walls);
        }
        self.sheet.with_all(ray, |at, found| {
            let mut roots = Sorted::new();
            for Turn { found, sign, .. } in self.turns(found) {
                if let Some(root) = root(at, &found) {
                    let kind = match (sign, root.kind) {
                        (0, _) => RootKind::Grazing,
                        (_, RootKind::Grazing) => RootKind::Cluster,
                        (_, kind) => kind,
                    };
                    roots.push(Root { sign, kind, ..root });
                }
            }
            roots.pour(sink);
        });
    }

    /// Where the winding number along a line leaves 0 or comes back to it, ascending.
    fn turns(&self, found: &[Found]) -> Vec<Turn> {
        let mut all = Vec::with_capacity(found.len());
        let mut caps: [Option<Turn>; 2] = [None; 2];
        for found in found {
            let sign = if found.sign == 0 { found.turn } else { found.sign };
            let turn = Turn { found: *found, sign, weight: i32::from(sign) };
            match (found.face as usize).checked_sub(self.walls) {
                None => all.push(turn),
                // All of a cap is in one plane: what is in it comes together.
                Some(k) => {
                    let cap = &mut caps[usize::from(k >= self.pieces)];
                    let sum = cap.map_or(0, |cap| cap.weight) + turn.weight;
                    let kept = cap.filter(|cap| cap.sign != 0 && i32::from(cap.sign) == sum.signum());
                    *cap = Some(Turn { weight: sum, ..kept.unwrap_or(turn) });
                }
            }
        }
        let counted = |cap: &Turn| cap.weight != 0 || cap.sign == 0;
        all.extend(caps.into_iter().flatten().filter(counted));
        all.sort_by(|a, b| a.found.s.total_cmp(&b.found.s));
        // Where both ends of a closed path meet, the caps are at the same place: into the one first.
        for k in 1..all.len() {
            let is_cap = |turn: &Turn| turn.found.face as usize >= self.walls;
            let (a, b) = (&all[k - 1], &all[k]);
            let meet = (a.found.s - b.found.s).abs() <= a.found.s_err + b.found.s_err + OVERLAP;
            if is_cap(a) && is_cap(b) && meet && a.weight > 0 && b.weight < 0 {
                all.swap(k - 1, k);
            }
        }
        self.close(&mut all);
        let mut count = 0;
        all.retain_mut(|turn| {
            let before = count;
            // Normals point outward: a crossing against them goes into one more turn.
            count -= turn.weight;
            turn.sign = match (before, count) {
                (0, 0) if turn.weight == 0 => 0,
                (0, after) if after != 0 => -1,
                (_, 0) if before != 0 => 1,
                _ => return false,
            };
            true
        });
        all
    }

    /// The winding number is 0 far away on both sides. If it is not, one crossing is there that may
    /// as well be a miss, or one tangent may cross: the first that is within its error of an edge of
    /// a face, or unproven, is changed.
    fn close(&self, all: &mut Vec<Turn>) {
        let missing: i32 = -all.iter().map(|turn| turn.weight).sum::<i32>();
        if missing == 0 {
            return;
        }
        if let Some(turn) = all.iter_mut().find(|turn| turn.weight == 0) {
            turn.weight = missing;
            return;
        }
        let faces = &self.sheet.faces;
        let at = all.iter().position(|turn| {
            turn.weight == -missing && (turn.found.sign == 0 || on_border(&turn.found, faces))
        });
        if let Some(at) = at {
            all.remove(at);
        }
    }

    /// The parameters along the path and along the profile: whole numbers count spans and pieces.
    fn uv(&self, face: usize, tag: [f64; 2]) -> [f64; 2] {
        let spans = (self.walls / self.pieces) as f64;
        if face < self.walls {
            return [(face / self.pieces) as f64 + tag[1], (face % self.pieces) as f64 + tag[0]];
        }
        let cap = face - self.walls;
        if cap < self.pieces {
            [0.0, cap as f64 + tag[0]]
        } else {
            [spans, (cap - self.pieces) as f64 + tag[1]]
        }
    }
}

/// A crossing that changes the winding number.
#[derive(Clone, Copy, Debug)]
struct Turn {
    found: Found,
    /// The sign of the normal along the line; then that of the solid: -1 enters it.
    sign: i8,
    /// By how much the number changes.
    weight: i32,
}

/// What all maps of a sweep have in common.
struct Kind {
    spline: PathSpline,
    up: Option<Vec3>,
    /// The twist of a span.
    twist: f64,
}

/// A vector of formulas.
type Vector = [NodeId; 3];

/// Writes the formulas of one map.
struct Pen(Builder);

type Written<T> = Result<T, FormulaError>;

impl Pen {
    fn number(&mut self, x: f64) -> Written<NodeId> {
        self.0.constant(x)
    }

    fn constant(&mut self, v: Vec3) -> Written<Vector> {
        Ok([self.number(v.x)?, self.number(v.y)?, self.number(v.z)?])
    }

    fn add(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Add(a, b))
    }

    fn sub(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Sub(a, b))
    }

    fn mul(&mut self, a: NodeId, b: NodeId) -> Written<NodeId> {
        self.0.push(Op::Mul(a, b))
    }

    fn sum(&mut self, a: Vector, b: Vector) -> Written<Vector> {
        Ok([self.add(a[0], b[0])?, self.add(a[1], b[1])?, self.add(a[2], b[2])?])
    }

    fn times(&mut self, k: NodeId, a: Vector) -> Written<Vector> {
        Ok([self.mul(k, a[0])?, self.mul(k, a[1])?, self.mul(k, a[2])?])
    }

    fn dot(&mut self, a: Vector, b: Vector) -> Written<NodeId> {
        let mut sum = self.mul(a[0], b[0])?;
        for k in 1..3 {
            let term = self.mul(a[k], b[k])?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }

    fn cross(&mut self, a: Vector, b: Vector) -> Written<Vector> {
        let mut out = a;
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (p, q) = (self.mul(a[i], b[j])?, self.mul(a[j], b[i])?);
            out[k] = self.sub(p, q)?;
        }
        Ok(out)
    }

    fn unit(&mut self, a: Vector) -> Written<Vector> {
        let square = self.dot(a, a)?;
        let length = self.0.push(Op::Sqrt(square))?;
        let mut out = a;
        for x in &mut out {
            *x = self.0.push(Op::Div(*x, length))?;
        }
        Ok(out)
    }

    /// A Bezier curve at `t`; its coefficients are rounded once, alike for equal points.
    fn bezier(&mut self, points: [f64; 4], t: NodeId) -> Written<NodeId> {
        let one = self.number(1.0)?;
        let s = self.sub(one, t)?;
        let (ss, tt) = (self.0.push(Op::Sqr(s))?, self.0.push(Op::Sqr(t))?);
        let three = self.number(3.0)?;
        let (a, d) = (self.mul(ss, s)?, self.mul(tt, t)?);
        let (b, c) = (self.mul(ss, t)?, self.mul(s, tt)?);
        let (b, c) = (self.mul(three, b)?, self.mul(three, c)?);
        let mut sum = self.number(0.0)?;
        for (weight, p) in [a, b, c, d].into_iter().zip(points) {
            let p = self.number(p)?;
            let term = self.mul(weight, p)?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }

    /// The slope of a Bezier curve, divided by 3.
    fn slope(&mut self, p: [f64; 4], t: NodeId) -> Written<NodeId> {
        let one = self.number(1.0)?;
        let s = self.sub(one, t)?;
        let (ss, tt, st) = (self.0.push(Op::Sqr(s))?, self.0.push(Op::Sqr(t))?, self.mul(s, t)?);
        let two = self.number(2.0)?;
        let st = self.mul(two, st)?;
        let mut sum = self.number(0.0)?;
        for (weight, k) in [ss, st, tt].into_iter().zip(0..) {
            let (a, b) = (self.number(p[k])?, self.number(p[k + 1])?);
            let step = self.sub(b, a)?;
            let term = self.mul(weight, step)?;
            sum = self.add(sum, term)?;
        }
        Ok(sum)
    }
}

/// A coordinate of control points.
fn coordinate(points: &[[f64; 4]; 4], k: usize) -> [f64; 4] {
    points.map(|p| p[k])
}

impl Kind {
    /// The point of the profile's plane with these coordinates, at `u` of a span.
    fn point(
        &self,
        pen: &mut Pen,
        (number, span): (usize, &Span),
        ab: [NodeId; 2],
        u: NodeId,
    ) -> Written<Vector> {
        if self.spline == PathSpline::Linear {
            return self.straight(pen, (number, span), ab, u);
        }
        let mut c = [u; 3];
        let mut slope = [u; 3];
        for k in 0..3 {
            c[k] = pen.bezier(coordinate(&span.points, k), u)?;
            slope[k] = pen.slope(coordinate(&span.points, k), u)?;
        }
        let t = pen.unit(slope)?;
        let x = match self.up {
            Some(up) => {
                let up = pen.constant(up)?;
                let x = pen.cross(up, t)?;
                pen.unit(x)?
            }
            None => {
                // The smallest rotation of the first tangent onto this one.
                let (first, x) = (pen.constant(span.t)?, pen.constant(span.x)?);
                let sum = pen.sum(first, t)?;
                let (over, under, one) = (pen.dot(x, t)?, pen.dot(first, t)?, pen.number(-1.0)?);
                let under = pen.sub(one, under)?;
                let by = pen.0.push(Op::Div(over, under))?;
                let back = pen.times(by, sum)?;
                pen.sum(x, back)?
            }
        };
        let off = self.offset(pen, (number, span), (x, t), ab, u)?;
        let size = pen.bezier(coordinate(&span.points, 3), u)?;
        let off = pen.times(size, off)?;
        pen.sum(c, off)
    }

    /// `a X + b Y` after the turn and the twist at `u`.
    fn offset(
        &self,
        pen: &mut Pen,
        (number, span): (usize, &Span),
        (x, t): (Vector, Vector),
        [a, b]: [NodeId; 2],
        u: NodeId,
    ) -> Written<Vector> {
        let y = pen.cross(t, x)?;
        let (start, turn) = (self.twist * number as f64, self.twist + span.turn);
        let (mut a, mut b) = (a, b);
        if start != 0.0 || turn != 0.0 {
            let (start, turn) = (pen.number(start)?, pen.number(turn)?);
            let angle = pen.mul(turn, u)?;
            let angle = pen.add(start, angle)?;
            let s = pen.0.push(Op::Function(Function::Sin, angle))?;
            let c = pen.0.push(Op::Function(Function::Cos, angle))?;
            let (ac, bs, sa, cb) = (pen.mul(a, c)?, pen.mul(b, s)?, pen.mul(a, s)?, pen.mul(b, c)?);
            (a, b) = (pen.sub(ac, bs)?, pen.add(sa, cb)?);
        }
        let (x, y) = (pen.times(a, x)?, pen.times(b, y)?);
        pen.sum(x, y)
    }

    /// The same along a straight span, between the planes that halve its corners.
    fn straight(&self, pen: &mut Pen, at: (usize, &Span), ab: [NodeId; 2], u: NodeId) -> Written<Vector> {
        let span = at.1;
        let (x, t) = (pen.constant(span.x)?, pen.constant(span.t)?);
        let one = pen.number(1.0)?;
        let rest = pen.sub(one, u)?;
        let [from, to] = [span.points[0], span.points[3]];
        let mut size = pen.number(0.0)?;
        let mut sum = [size; 3];
        // How far along the tangent the ends are moved.
        let mut along = size;
        for (end, (weight, p)) in [(rest, from), (u, to)].into_iter().enumerate() {
            let place = pen.constant(Vec3::new(p[0], p[1], p[2]))?;
            let place = pen.times(weight, place)?;
            sum = pen.sum(sum, place)?;
            let own = pen.number(p[3])?;
            let part = pen.mul(weight, own)?;
            size = pen.add(size, part)?;
            let mitre = pen.constant(span.mitres[end])?;
            let here = pen.number(end as f64)?;
            let off = self.offset(pen, at, (x, t), ab, here)?;
            let (over, under) = (pen.dot(off, mitre)?, pen.dot(t, mitre)?);
            let by = pen.0.push(Op::Div(over, under))?;
            let by = pen.mul(part, by)?;
            along = pen.sub(along, by)?;
        }
        let off = self.offset(pen, at, (x, t), ab, u)?;
        let (off, along) = (pen.times(size, off)?, pen.times(along, t)?);
        let sum = pen.sum(sum, off)?;
        pen.sum(sum, along)
    }

    /// A piece of the profile along a span: parameters along the profile and along the span.
    fn wall(&self, number: usize, span: &Span, piece: &Bezier) -> Written<Face> {
        let mut pen = Pen(Builder::new());
        let (v, u) = (pen.0.input(0)?, pen.0.input(1)?);
        let ab = profile(&mut pen, piece, v)?;
        let roots = self.point(&mut pen, (number, span), ab, u)?;
        Ok(Face::new(VectorTape::of(&pen.0, roots), [[0.0, 1.0]; 2]).reaching(OVERLAP))
    }

    /// What a piece of the profile adds to a cap: all points between it and `q`. Its normal points
    /// outward, away from the path.
    fn cap(&self, number: usize, span: &Span, piece: &Bezier, q: [f64; 2], at_end: bool) -> Written<Face> {
        let mut pen = Pen(Builder::new());
        let inputs = [pen.0.input(0)?, pen.0.input(1)?];
        let [v, r] = if at_end { [inputs[1], inputs[0]] } else { inputs };
        let mut ab = profile(&mut pen, piece, v)?;
        for (x, q) in ab.iter_mut().zip(q) {
            let q = pen.number(q)?;
            let by = pen.sub(*x, q)?;
            let by = pen.mul(r, by)?;
            *x = pen.add(q, by)?;
        }
        let u = pen.number(if at_end { 1.0 } else { 0.0 })?;
        let roots = self.point(&mut pen, (number, span), ab, u)?;
        Ok(Face::new(VectorTape::of(&pen.0, roots), [[0.0, 1.0]; 2]).reaching(OVERLAP))
    }
}

/// A point of the profile.
fn profile(pen: &mut Pen, piece: &Bezier, v: NodeId) -> Written<[NodeId; 2]> {
    let of = |pen: &mut Pen, k: usize| -> Written<NodeId> {
        let [a, _, _, d] = piece.map(|p| p[k]);
        if is_straight(piece) {
            let (a, d) = (pen.number(a)?, pen.number(d)?);
            let one = pen.number(1.0)?;
            let rest = pen.sub(one, v)?;
            let (a, d) = (pen.mul(rest, a)?, pen.mul(v, d)?);
            return pen.add(a, d);
        }
        pen.bezier(piece.map(|p| p[k]), v)
    };
    Ok([of(pen, 0)?, of(pen, 1)?])
}

/// A straight edge has its own ends as its inner control points.
fn is_straight(piece: &Bezier) -> bool {
    piece[0] == piece[1] && piece[2] == piece[3]
}

/// Twice the area within an outline of its control points' chords, with a sign.
fn area(outline: &[Bezier]) -> f64 {
    let points = outline.iter().flat_map(|piece| piece[..3].iter());
    let points: Vec<_> = points.collect();
    let next = |k: usize| points[(k + 1) % points.len()];
    (0..points.len()).map(|k| points[k][0] * next(k)[1] - points[k][1] * next(k)[0]).sum()
}

/// The outlines, each with the inside of the profile to its left: those within an odd number of
/// others are holes.
fn oriented(outlines: &[Vec<Bezier>]) -> Vec<Vec<Bezier>> {
    let crosses = |[x, y]: [f64; 2], piece: &Bezier| {
        piece.windows(2).fold(false, |odd, w| {
            let ([ax, ay], [bx, by]) = (w[0], w[1]);
            let between = (ay > y) != (by > y);
            odd ^ (between && x < (bx - ax) * (y - ay) / (by - ay) + ax)
        })
    };
    let within =
        |p: [f64; 2], outline: &[Bezier]| outline.iter().fold(false, |odd, piece| odd ^ crosses(p, piece));
    let mut out = Vec::new();
    for (k, outline) in outlines.iter().enumerate() {
        let Some(first) = outline.first() else { continue };
        let others = outlines.iter().enumerate().filter(|(i, _)| *i != k);
        let is_hole = others.fold(false, |odd, (_, other)| odd ^ within(first[0], other));
        let mut outline = outline.clone();
        if (area(&outline) > 0.0) == is_hole {
            outline.reverse();
            outline.iter_mut().for_each(|piece| piece.reverse());
        }
        out.push(outline);
    }
    out
}

/// A point in the middle of the profile, beside its symmetries.
fn centre(pieces: &[Bezier]) -> [f64; 2] {
    [0, 1].map(|k: usize| {
        let (low, high) = pieces
            .iter()
            .flatten()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        low + (high - low) * [0.5093, 0.4871][k]
    })
}

/// Equal if they are made of the same.
impl PartialEq for PathSweep {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data && self.open == other.open
    }
}

impl Surface for PathSweep {
    fn bounds(&self) -> Aabb {
        self.sheet.bounds
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        if !ray.passes_by(self.sheet.centre, self.sheet.reach) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, _need: Need) -> SurfacePoint {
        let mut point = self.sheet.point(ray, root);
        // Where the profile overlaps itself the solid's outside may be behind the normal.
        let along = point.ng.to_vec().dot(ray.d);
        if root.sign != 0 && !self.open && along != 0.0 && (along > 0.0) != (root.sign > 0) {
            (point.ng, point.ns) = (-point.ng, -point.ns);
        }
        point.uv = self.uv(root.face as usize, root.tag);
        (point.dpdu, point.dpdv) = (point.dpdv, point.dpdu);
        point
    }

    fn solidity(&self) -> Solidity {
        if self.open { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        let held = self.sheet.bounds.expanded(point.p_err);
        if self.open || !(0..3).all(|k| held.min[k] <= point.p[k] && point.p[k] <= held.max[k]) {
            return Side::Out;
        }
        // Any direction will do; this one is parallel to no likely face.
        let ray = Ray::new(point.p, Vec3::new(0.351, 0.637, 0.686));
        let mut side = Side::Out;
        self.sheet.with_all(&LocalRay::new(&ray), |at, found| {
            let start = -at.shift();
            let room = self.sheet.in_units(2.0 * point.p_err.max_abs() + START * point.p.to_vec().max_abs());
            for turn in self.turns(found) {
                if (turn.found.s - start).abs() <= turn.found.s_err + room {
                    side = Side::On;
                    return;
                }
                if turn.found.s > start {
                    break;
                }
                match turn.sign {
                    -1 => side = Side::In,
                    1 => side = Side::Out,
                    _ => {}
                }
            }
        });
        side
    }
}

impl Accelerate for PathSweep {
    fn name(&self) -> &'static str {
        "sweep"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.sheet.bounds)
    }
}

impl Algebraic for PathSweep {}

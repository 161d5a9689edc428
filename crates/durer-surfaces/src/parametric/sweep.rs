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
//! tangent, followed by the rest of the turn to the next knot's frame and the twist, both linear in
//! `u` (`path.rs`). With `up`, X of a curved span is perpendicular to it everywhere. Straight spans
//! begin and end in the planes that bisect the corners. Each piece of the profile along each span
//! is one map of a rectangle (`sweep_maps.rs`, `sheet.rs`).
//!
//! The caps are maps too: `q + r (p(v) - q)` for a point `q` of the profile's plane, which covers
//! each point of the plane as often as the profile goes round it. So walls and caps form closed
//! surfaces with an orientation, and the solid is where their winding number is not 0. A ray adds
//! up the signs of all crossings on its line; a crossing is one of the solid's where the sum leaves
//! 0 or returns to it.

use super::bounds::Bounds;
use super::build::Refused;
use super::line::Found;
use super::outline::{centre, oriented};
use super::path::{PathSpline, framed};
use super::sheet::Sheet;
use super::sweep_maps::{Maps, OVERLAP};
use super::winding::{self, Turn, face_outside, kept_turns, pour};
use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::prism::curved::Bezier;
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use durer_formula::FormulaError;
use durer_math::{Aabb, Vec3};
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

/// The input of a [`PathSweep`].
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
        let maps = Maps { spline: data.spline, up: data.up, twist: data.twist / spans.len() as f64 };
        let mut faces = Vec::new();
        for (number, span) in spans.iter().enumerate() {
            for piece in &pieces {
                faces.push(maps.wall(number, span, piece)?);
            }
        }
        let walls = faces.len();
        let middle = centre(&pieces);
        for piece in &pieces {
            faces.push(maps.cap(0, &spans[0], piece, middle, false)?);
        }
        let last = spans.len() - 1;
        for piece in &pieces {
            faces.push(maps.cap(last, &spans[last], piece, middle, true)?);
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

    /// The surface without its caps: a sheet.
    #[must_use]
    pub fn without_caps(mut self) -> Self {
        self.open = true;
        self
    }

    /// The input that it was made from.
    pub fn data(&self) -> &SweepData {
        &self.data
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        if self.open {
            let walls = self.walls as u32;
            return self.sheet.roots(ray, sink, |face| face < walls);
        }
        self.sheet.with_all(ray, |at, found| pour(at, &self.turns(found), sink));
    }

    /// Where the winding number along a line leaves 0 or comes back to it, ascending.
    fn turns(&self, found: &[Found]) -> Vec<Turn> {
        let mut all = Vec::with_capacity(found.len());
        let mut caps: [Option<Turn>; 2] = [None; 2];
        for found in found {
            let turn = Turn::new(found);
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
        kept_turns(all, &self.sheet.faces)
    }

    /// The parameters along the path and along the profile; their integer parts are the numbers of
    /// the span and the piece.
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
        if !self.open {
            face_outside(&mut point, ray, root);
        }
        point.uv = self.uv(root.face as usize, root.tag);
        (point.dpdu, point.dpdv) = (point.dpdv, point.dpdu);
        point
    }

    fn solidity(&self) -> Solidity {
        if self.open { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.open {
            return Side::Out;
        }
        winding::side(&self.sheet, point, |found| self.turns(found))
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

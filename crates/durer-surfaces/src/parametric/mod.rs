//! The parametric surface: three formulas of two parameters.
//!
//! ```text
//!   v ▲                                        x = f_x(u, v)
//!  v2 ├───────┐         S                      y = f_y(u, v)
//!     │       │  ───────────────▶  a sheet     z = f_z(u, v)
//!  v1 └───────┴──▶ u                           u1 <= u <= u2,  v1 <= v <= v2
//!     u1      u2
//! ```
//!
//! A ray meets it where two functions of `u` and `v` vanish. The rectangle is cut into pieces in
//! advance (`build.rs`); interval arithmetic bounds the formulas and their slopes on each
//! (`piece.rs`). A ray skips the pieces that it provably misses. On others Newton's method finds
//! its crossing and Krawczyk's test proves it (`line.rs`, `two_unknowns.rs` of durer-roots). Near a
//! silhouette and near a pole a piece is cut further (`subdivide.rs`). A part that is as small as
//! the rounding errors and still open is reported as [`RootKind::Grazing`] or
//! [`RootKind::Cluster`].
//!
//! D. L. Toth, "On ray tracing parametric surfaces", *SIGGRAPH* 1985; J. M. Snyder, "Interval
//! analysis for computer graphics", *SIGGRAPH* 1992; W. Barth, R. Lieger, M. Schindler, "Ray tracing
//! general parametric surfaces using interval arithmetic", *The Visual Computer* 10 (1994) 363-371.
//!
//! # Seams and poles
//!
//! The ends of the domain belong to it, and so do crossings within four units in the last place
//! beyond: `2*pi` is rounded, and a seam must not have a gap. Crossings on opposite sides of the domain
//! at the same place of a ray are one crossing, that of the least parameters: so a surface that
//! comes back to itself, perhaps turned over like a Moebius strip, is met once on its seam. On the same
//! side, or on sides that meet, they are one if they go in the same direction. At a
//! pole, where `S_u x S_v` vanishes, a crossing cannot be proven and is reported as uncertain; the
//! normal there is the limit from within the domain.
//!
//! [`RootKind::Grazing`]: crate::RootKind::Grazing
//! [`RootKind::Cluster`]: crate::RootKind::Cluster
#![expect(clippy::needless_range_loop, reason = "several arrays have the same axes")]

mod bounds;
mod build;
mod crossings;
mod deformed;
mod degree;
mod line;
mod outline;
mod path;
mod piece;
mod point;
mod sheet;
mod subdivide;
mod sweep;
mod sweep_maps;
mod winding;

use crate::compose::clip::Algebraic;
use crate::packet::FilterSource;
use crate::{Accelerate, Container, Forward, LocalRay, Need, PartId, Root, Sink, Surface, SurfacePoint};
use bounds::Bounds;
use build::Refused;
use durer_formula::{Formula, FormulaError, VectorTape};
use durer_math::Aabb;
use piece::Face;
use sheet::Sheet;
use std::sync::Arc;

pub use deformed::{DeformSource, DeformedSurface};
pub use path::PathSpline;
pub use sweep::{PathSweep, SweepData, SweepError};

/// The number of parts into which each parameter is divided to check whether a container holds all
/// of a surface.
const CHECKED: usize = 64;

/// Why a [`Parametric`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ParametricError {
    /// The domain of a parameter is empty, infinite or NaN.
    #[error("parametric: {name} must go from a number to a greater one, got {from} to {to}")]
    Domain {
        /// `u` or `v`.
        name: char,
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// A function takes another number of arguments than two.
    #[error("parametric: its functions have two arguments, u and v; that of {axis} has {arguments}")]
    Arguments {
        /// The coordinate.
        axis: char,
        /// How many it has.
        arguments: u32,
    },
    /// The formulas are too long.
    #[error("parametric: {0}")]
    Formula(#[from] FormulaError),
    /// Where a function jumps the surface would have a gap.
    #[error("parametric: its functions jump near u = {u}, v = {v}; a parametric surface is continuous")]
    Jump {
        /// The first parameter.
        u: f64,
        /// The second parameter.
        v: f64,
    },
    /// The surface is unbounded, and there is no container.
    #[error("parametric: it has no bounds near u = {u}, v = {v}, and no container")]
    Unbounded {
        /// The first parameter.
        u: f64,
        /// The second parameter.
        v: f64,
    },
    /// No part of it is defined and within the container.
    #[error("parametric: nothing of it is in its container")]
    Nothing,
}

impl From<Refused> for ParametricError {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Jump([u, v]) => Self::Jump { u, v },
            Refused::Unbounded([u, v]) => Self::Unbounded { u, v },
        }
    }
}

/// The surface of three formulas of `u` and `v` over a rectangle of parameters, as far as it is in a
/// container. An open surface; its stored normal is `S_u x S_v`. A root's tag is `(u, v)`.
///
/// ```
/// use durer_formula::Function;
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_formula::{Builder, Op};
/// use durer_surfaces::{Closest, LocalRay, Parametric, Surface};
/// // A cylinder: x = cos u, y = v, z = sin u.
/// let mut b = Builder::new();
/// let (u, v) = (b.input(0)?, b.input(1)?);
/// let (x, z) = (b.push(Op::Function(Function::Cos, u))?, b.push(Op::Function(Function::Sin, u))?);
/// let formulas = [x, v, z].map(|root| b.finish(root, 2));
/// let turn = 2.0 * std::f64::consts::PI;
/// let cylinder = Parametric::new(formulas.each_ref(), [[0.0, turn], [-1.0, 1.0]], None)?;
/// let ray = Ray::new(Point3::new(0.6, 0.5, -3.0), Vec3::new(0.0, 0.0, 1.0));
/// let mut closest = Closest::default();
/// cylinder.roots(&LocalRay::new(&ray), &mut closest);
/// let root = closest.root.expect("the ray meets it");
/// assert!(root.lo <= 2.2 && 2.2 <= root.hi && root.hi - root.lo < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Invariants
///
/// The formulas take two numbers and do not jump, and something of the surface is in the container.
#[derive(Clone, Debug)]
pub struct Parametric {
    sheet: Arc<Sheet>,
}

impl Parametric {
    /// The surface of the formulas of `x`, `y` and `z` over the parameters from `domain[0][0]` to
    /// `domain[0][1]` and from `domain[1][0]` to `domain[1][1]`. The container, if there is one,
    /// cuts off what is outside; without one the surface must be bounded.
    ///
    /// Where a formula is undefined there is no surface. Where one has a pole, parameters within
    /// `2^-50` of the domain's width of it are left out; `2^-10` or so where the pole runs across
    /// both parameters.
    pub fn new(
        formulas: [&Formula; 3],
        domain: [[f64; 2]; 2],
        container: Option<&Container>,
    ) -> Result<Self, ParametricError> {
        for (k, name) in ['u', 'v'].into_iter().enumerate() {
            let [from, to] = domain[k];
            if !(from < to && (to - from).is_finite()) {
                return Err(ParametricError::Domain { name, from, to });
            }
        }
        for (formula, axis) in formulas.iter().zip(['x', 'y', 'z']) {
            let arguments = formula.inputs();
            if arguments != 2 {
                return Err(ParametricError::Arguments { axis, arguments });
            }
        }
        let tape = VectorTape::new(formulas)?;
        let bounds = container.map_or(Bounds::NONE, Bounds::of);
        let sheet =
            Sheet::new(vec![Face::new(tape, domain)], &bounds, 0.0).map_err(|(_, refused)| refused)?;
        let sheet = sheet.ok_or(ParametricError::Nothing)?;
        Ok(Self { sheet: Arc::new(sheet) })
    }

    /// The map itself, if all of it is in its container.
    fn whole_face(&self) -> Option<Face> {
        let Sheet { faces, cut, unit, .. } = &*self.sheet;
        let face = &faces[0];
        if cut.are_none() {
            return Some(face.clone());
        }
        let at = |k: usize, i: usize| {
            let [from, to] = face.domain[k];
            if i == CHECKED { to } else { from + (to - from) * (i as f64 / CHECKED as f64) }
        };
        let rows = (0..CHECKED * CHECKED).map(|n| (n % CHECKED, n / CHECKED));
        let boxes: Vec<_> = rows.map(|(i, j)| [[at(0, i), at(0, i + 1)], [at(1, j), at(1, j + 1)]]).collect();
        let mut pieces = Vec::with_capacity(boxes.len());
        face.pieces(0, &boxes, unit, &mut pieces);
        let holds = |piece: &piece::Piece| piece.is_bounded() && cut.hold(&piece.hull);
        (pieces.len() == boxes.len() && pieces.iter().all(holds)).then(|| face.clone())
    }

    /// The rectangle of parameters.
    pub fn domain(&self) -> [[f64; 2]; 2] {
        self.sheet.faces[0].domain
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        self.sheet.roots(ray, sink, |_| true);
    }
}

/// Equal if their formulas, domains and containers are.
impl PartialEq for Parametric {
    fn eq(&self, other: &Self) -> bool {
        self.sheet.faces == other.sheet.faces && self.sheet.cut == other.sheet.cut
    }
}

impl Surface for Parametric {
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
        self.sheet.point(ray, root)
    }
}

impl Accelerate for Parametric {
    fn name(&self) -> &'static str {
        "parametric surface"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.sheet.bounds)
    }
}

impl Algebraic for Parametric {}

#[cfg(test)]
mod tests;

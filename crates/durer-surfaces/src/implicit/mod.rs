//! The surface of a formula: all points of a container where `f(x, y, z) = threshold`.
//!
//! ```text
//!   { p in C : f(p) = T },  inside: f(p) < T;  C is a box or a ball; its faces show where they are inside
//! ```
//!
//! The user gives neither a bound on the gradient nor an accuracy. Interval arithmetic evaluates
//! the formula along a ray, and a stretch is skipped only if the bounds exclude a root (R. E. Moore
//! 1966; D. P. Mitchell 1990; D. Kalra, A. H. Barr, "Guaranteed ray intersections with implicit
//! surfaces", SIGGRAPH 1989, use Lipschitz constants from the user). A root is simple where the
//! formula is strictly monotone between two certain and opposite signs.
//!
//! The exact surface is that of the formula with its numbers. Where rounding leaves the sign
//! unknown over a whole stretch, mostly at tangents, the crossings of that stretch form one
//! [`RootKind::Cluster`](crate::RootKind). Where the formula jumps from one sign to the other, or
//! has a pole, the solid has a wall, which is a cluster too, because no derivative proves that it
//! is only one. Where the formula is undefined there is no surface.

mod coincident_face;
mod container;
pub mod deform;
mod isolate;
mod lanes;
pub mod level_set;
mod line;
mod march;
mod octree;
mod octree_lookup;
mod point;
mod polynomial;
mod root_isolator;
mod roots;
mod subdivide;
mod superellipsoid;

pub use container::Container;
pub(crate) use root_isolator::{CertifiedFunction, Found, RootIsolator, SignInfo};
pub use superellipsoid::{SuperellipsoidError, superellipsoid};

use crate::compose::clip::Algebraic;
use crate::packet::{FilterSource, ImplicitKernel, Segments};
use crate::{
    Accelerate, Forward, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use durer_formula::I8;
use durer_formula::{Builder, Formula, FormulaError, Op, Powers, Tape};
use durer_math::{Aabb, Dyadic, F8, Point3};
use durer_roots::quadratic::Quadratic;
use octree::{CellLookup, Cells};
use std::sync::{Arc, OnceLock};
use superellipsoid::concave::Star;
use superellipsoid::convex::Gauge;

/// The surface of a formula in a container. Face 0 is the formula's; the container's faces follow.
///
/// # Invariants
///
/// The formula takes three numbers, and the threshold is finite.
#[derive(Clone, Debug)]
pub struct Isosurface {
    /// `f - T`.
    tape: Tape,
    container: Container,
    open: bool,
    /// Whether touching points do not belong to the surface: see [`Isosurface::regular`].
    regular: bool,
    /// The octree, built at first use; a convex superellipsoid hardly ever needs it.
    cells: Arc<OnceLock<Cells>>,
    /// If the formula is a polynomial: its greatest degree along a line.
    degree: Option<usize>,
    /// The gauge of a convex superellipsoid, with which most rays need no tape.
    gauge: Option<Gauge>,
    /// The gauge of a superellipsoid with dents between all axes, for packets.
    dented: Option<Gauge>,
}

/// Why an [`Isosurface`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum IsosurfaceError {
    /// The threshold is infinite or NaN.
    #[error("isosurface: the threshold must be finite, got {0}")]
    Threshold(f64),
    /// The formula takes another number of arguments than three.
    #[error("isosurface: its function must have three arguments, this one has {0}")]
    Arguments(u32),
    /// The formula is too long.
    #[error("isosurface: {0}")]
    Formula(#[from] FormulaError),
    /// The container is not valid.
    #[error("isosurface: {0}")]
    Container(#[from] crate::AxisBoxError),
}

impl Isosurface {
    /// The surface of `formula`, at `threshold`, in `container`; the container closes the solid
    /// where it cuts it.
    pub fn new(formula: &Formula, threshold: f64, container: Container) -> Result<Self, IsosurfaceError> {
        let surface = Self::undivided(formula, threshold, container)?;
        surface.divided();
        Ok(surface)
    }

    /// [`Isosurface::new`], without the octree, which is built at first use.
    fn undivided(formula: &Formula, threshold: f64, container: Container) -> Result<Self, IsosurfaceError> {
        if !threshold.is_finite() {
            return Err(IsosurfaceError::Threshold(threshold));
        }
        if formula.inputs() != 3 {
            return Err(IsosurfaceError::Arguments(formula.inputs()));
        }
        let mut builder = Builder::new();
        let inputs = [builder.input(0)?, builder.input(1)?, builder.input(2)?];
        let value = builder.call(formula, &inputs)?;
        let threshold = builder.constant(threshold)?;
        let level = builder.push(Op::Sub(value, threshold))?;
        let tape = Tape::new(&builder.finish(level, 3));
        let line = Powers::line([0.0, 1.0], [0.0; 2]);
        let degree = tape.along(&[line; 3]).degree();
        let cells = Arc::default();
        Ok(Self { tape, container, open: false, regular: false, degree, cells, gauge: None, dented: None })
    }

    /// The octree over the container.
    fn divided(&self) -> &Cells {
        self.cells.get_or_init(|| Cells::new(&self.tape, self.container.bounds()))
    }

    /// A tape that is valid within `reach` of `p` along each axis: a cell's own, if possible.
    fn tape_near(&self, p: Point3, reach: f64) -> &Tape {
        match self.divided().place(p, reach) {
            Some(CellLookup::Open(tape) | CellLookup::Slope(tape, _)) => tape,
            _ => &self.tape,
        }
    }

    /// The surface without the container's faces: a sheet.
    #[must_use]
    pub fn without_caps(mut self) -> Self {
        self.open = true;
        self
    }

    /// The solid without touching points: a ray that is certainly on the same side before and
    /// behind has not crossed. CSG as one formula has zeros where faces of two parts coincide,
    /// which are no surface of the result (R. B. Tilove, A. A. G. Requicha, "Closure of Boolean
    /// operations on geometric entities", *Computer-Aided Design* 12(5), 1980: the regularised
    /// set). Rays that are tangent within rounding do not meet it either.
    #[must_use]
    pub fn regular(mut self) -> Self {
        self.regular = true;
        self
    }

    /// The number of cells that may hold surface, the mean length of their tapes, and the length of
    /// the whole formula's tape.
    pub fn cells(&self) -> (usize, f64, usize) {
        let (open, steps) = self.divided().open();
        (open, steps, self.tape.len())
    }
}

impl Surface for Isosurface {
    fn bounds(&self) -> Aabb {
        self.container.bounds()
    }

    #[inline(always)]
    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        self.all_roots(ray, &mut Forward(sink));
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        self.point(ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        if self.open { Solidity::Open } else { Solidity::Solid }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if self.open {
            return Side::Out;
        }
        if let Some(side) = self.gauge.as_ref().and_then(|gauge| gauge.side(point)) {
            return side;
        }
        let held = self.container.side(point);
        if held == Side::Out {
            return Side::Out;
        }
        let tape = match self.divided().place(point.p, point.p_err.max_abs()) {
            Some(CellLookup::Sign(above)) => return if above { Side::Out } else { held },
            Some(CellLookup::Open(tape) | CellLookup::Slope(tape, _)) => tape,
            Some(CellLookup::Gap) | None => &self.tape,
        };
        let (p, e) = (point.p.to_array(), point.p_err.to_array());
        let around = |i: usize| {
            let (lo, hi) = ((p[i] - e[i]).next_down(), (p[i] + e[i]).next_up());
            let exact = e[i] == 0.0;
            I8::new(F8::splat(if exact { p[i] } else { lo }), F8::splat(if exact { p[i] } else { hi }))
        };
        let v = tape.bounds(&[around(0), around(1), around(2)]);
        if v.empty & 1 == 1 || v.lo.0[0] > 0.0 {
            Side::Out
        } else if v.hi.0[0] < 0.0 && v.partial & 1 == 0 {
            held
        } else {
            Side::On
        }
    }
}

impl Accelerate for Isosurface {
    fn name(&self) -> &'static str {
        "isosurface"
    }

    fn bounds_through(&self, map: &durer_math::Affine) -> Aabb {
        self.container.bounds_through(map)
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        let level: Arc<dyn ImplicitKernel> = match (&self.gauge, &self.dented) {
            (Some(gauge), _) => Arc::new(gauge.clone()),
            (None, Some(gauge)) => Arc::new(Star::new(gauge, self)),
            (None, None) => {
                return FilterSource::contained(
                    self.container.packet_filter(),
                    Segments(Arc::new(self.clone())),
                    Point3::ORIGIN,
                );
            }
        };
        FilterSource::kernel(self.bounds(), Segments(level), Point3::ORIGIN, 0, [0, 1, 2])
    }
}

impl Algebraic for Isosurface {
    /// A formula has no polynomial along a ray.
    fn polynomial(&self, _face: u32, _ray: &LocalRay<'_>) -> Option<Quadratic<Dyadic>> {
        None
    }
}

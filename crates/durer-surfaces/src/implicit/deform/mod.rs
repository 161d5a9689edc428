//! Deformed solids: twisted, tapered, bent, or moved by any map whose inverse is a formula.
//!
//! ```text
//!   D(S) = { p : f(D^-1(p)) < 0 }  for the solid S = { p : f(p) < 0 }
//! ```
//!
//! A. H. Barr, "Global and local deformations of solid primitives", SIGGRAPH 1984. The inverse is
//! composed with the solid's own formula, and the result is an [`Isosurface`](super::Isosurface):
//! no curve is traced through the undeformed space (A. H. Barr, "Ray tracing deformed surfaces",
//! SIGGRAPH 1986, integrates one), a ray stays straight and the formula is deformed, so that each
//! root has its certified bracket.
//!
//! A map that sends two points of the solid to one has no inverse there. Twists always have one,
//! tapers if their factor stays positive, bends if the solid stays on its side of the centre and
//! does not come round to itself. For other maps it must be proven on a box ([`Warp::Inverse`]).

mod bend;
mod inverse;
mod lattice;
mod turn;

use super::level_set::LevelSet;
use super::level_set::expr::ExprBuilder;
use crate::IsosurfaceError;
use bend::Bend;
use durer_formula::{Formula, FormulaError, NodeId};
use durer_math::{Aabb, Affine, AffineError, Interval, Point3, Vec3};
use std::sync::Arc;
use turn::{Taper, Twist};

pub use lattice::Lattice;
pub(crate) use lattice::bernstein;

/// A map of space. The first three act about an axis through the origin, between two heights along
/// it: below the lower one nothing moves, and above the upper one everything moves as it does at
/// the upper one.
#[derive(Clone, Debug, PartialEq)]
pub enum Warp {
    /// Turns about the axis, by an angle that grows evenly with the height, counter-clockwise as
    /// seen from the axis' tip.
    Twist {
        /// The axis, of any length but zero.
        axis: Vec3,
        /// The angle of the turn from one height to the other.
        degrees: f64,
        /// The lower height.
        from: f64,
        /// The upper height.
        to: f64,
    },
    /// Scales across the axis, by a factor that changes linearly from 1 to `factor`.
    Taper {
        /// The axis, of any length but zero.
        axis: Vec3,
        /// The factor at the upper height; positive.
        factor: f64,
        /// The lower height.
        from: f64,
        /// The upper height.
        to: f64,
    },
    /// Bends the piece of the axis between the heights to an arc of the same length, together with
    /// the space around it.
    Bend {
        /// The axis, of any length but zero.
        axis: Vec3,
        /// The side to which it bends; its component along the axis does not matter.
        toward: Vec3,
        /// The angle of the arc from one height to the other.
        degrees: f64,
        /// The lower height.
        from: f64,
        /// The upper height.
        to: f64,
    },
    /// The map whose inverse is given by functions, restricted to images in a box. The part of the
    /// solid's image outside the box is cut off.
    Inverse {
        /// The coordinates of the undeformed point, as functions of the deformed point.
        functions: Arc<[Formula; 3]>,
        /// The box, in which they must be shown to have an inverse.
        within: Aabb,
    },
    /// Moves the content of a box with a lattice of control points. It has no inverse formula, so
    /// it deforms only parametric surfaces.
    Lattice(Arc<Lattice>),
}

/// One step of a deformation.
#[derive(Clone, Debug, PartialEq)]
pub enum DeformStep {
    /// An affine map.
    Place(Affine),
    /// A warp.
    Warp(Warp),
}

/// Why a deformed solid cannot exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeformError {
    /// The solid is unbounded.
    #[error("deform: this solid has no end; only what a box holds can be deformed so: intersect it with one")]
    Unbounded,
    /// The axis has no direction.
    #[error("{warp}: the axis must be finite and not zero, got <{}, {}, {}>", .axis.x, .axis.y, .axis.z)]
    Axis {
        /// Which warp.
        warp: &'static str,
        /// The axis.
        axis: Vec3,
    },
    /// The heights are not finite and ascending.
    #[error("{warp}: it must go from one height to a greater one, got from {from} to {to}")]
    Stretch {
        /// Which warp.
        warp: &'static str,
        /// The lower height.
        from: f64,
        /// The upper height.
        to: f64,
    },
    /// The angle is infinite or NaN.
    #[error("{warp}: the angle must be finite, got {degrees}")]
    Angle {
        /// Which warp.
        warp: &'static str,
        /// The angle.
        degrees: f64,
    },
    /// A taper shrinks to nothing or beyond.
    #[error(
        "taper: the factor must be finite and greater than 0, got {0}: at 0 all points of a height would be one"
    )]
    Factor(f64),
    /// A bend's direction is parallel to its axis.
    #[error("bend: the direction must not be that of the axis, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    Toward(Vec3),
    /// The solid reaches the centre of a bend.
    #[error(
        "bend: the solid reaches {reach} from the axis to the inner side, and the centre of the bend is at {radius}: there two of its points may become one"
    )]
    Centre {
        /// How far it may reach.
        reach: f64,
        /// How far the centre is.
        radius: f64,
    },
    /// The solid comes round to itself.
    #[error(
        "bend: the solid would reach {degrees} degrees around the centre of the bend, which may bring its ends together: less than 360 are possible"
    )]
    Round {
        /// How far it may reach.
        degrees: f64,
    },
    /// The functions are not smooth.
    #[error(
        "formula: the functions may jump, be undefined or have no bounded slope near <{}, {}, {}>, so nothing shows that they have an inverse", .0.x, .0.y, .0.z
    )]
    Rough(Point3),
    /// The functions may map two points to one.
    #[error(
        "formula: the functions may take two points of their box to one: bounds of the determinant of their slopes, each within its own over the box, are {} to {}, and do not exclude 0", .0.lo, .0.hi
    )]
    Injective(Interval),
    /// A lattice's box is flat or infinite.
    #[error("lattice: its box must be finite and not flat, from <{}, {}, {}> to <{}, {}, {}>", .0.min.x, .0.min.y, .0.min.z, .0.max.x, .0.max.y, .0.max.z)]
    LatticeBox(Aabb),
    /// A lattice has too few or too many points.
    #[error("lattice: it has 2 to 8 points along each axis, got {} by {} by {}", .0[0], .0[1], .0[2])]
    LatticeSize([usize; 3]),
    /// A point of a lattice does not exist.
    #[error("lattice: there is no point <{}, {}, {}> in a lattice of {} by {} by {}, which counts from 0", point[0], point[1], point[2], size[0], size[1], size[2])]
    LatticePoint {
        /// The point.
        point: [usize; 3],
        /// How many there are along each axis.
        size: [usize; 3],
    },
    /// The move of a lattice point is infinite or NaN.
    #[error("lattice: a point must move by finite numbers, got <{}, {}, {}>", .0.x, .0.y, .0.z)]
    LatticeMove(Vec3),
    /// A lattice has no inverse formula.
    #[error(
        "lattice: it deforms patches, NURBS and parametric surfaces; a solid of formulas would need its inverse, which has no formula"
    )]
    LatticeInverse,
    /// A parametric surface is deformed by inverse functions.
    #[error(
        "formula: it is an inverse map, which deforms only solids; parametric surfaces and patches need a forward map: twist, taper, bend or lattice"
    )]
    Forward,
    /// A deformed parametric surface is not completely in its container.
    #[error(
        "deform: its container must hold all of a parametric surface that is deformed, since the container is not: enlarge its `contained_by`"
    )]
    Cut,
    /// A sealed solid is deformed.
    #[error(
        "deform: a closed sewn surface with trims or a seal cannot be deformed so: the seal is a distance, which a deformation changes"
    )]
    Sealed,
    /// A deformed surface has no bounds.
    #[error("deform: the deformed surface has no bounds near u = {u}, v = {v} of a patch")]
    Torn {
        /// The first parameter.
        u: f64,
        /// The second parameter.
        v: f64,
    },
    /// The patches of a sewn surface no longer fit.
    #[error("deform: {0}")]
    Sewn(#[from] crate::SewnError),
    /// A function takes another number of arguments than three.
    #[error("formula: its functions must have three arguments, one has {0}")]
    Arguments(u32),
    /// The box is empty or not finite.
    #[error("formula: its box must be finite and not flat, from <{}, {}, {}> to <{}, {}, {}>", .0.min.x, .0.min.y, .0.min.z, .0.max.x, .0.max.y, .0.max.z)]
    Within(Aabb),
    /// It has too many steps.
    #[error("deform: {0}")]
    Formula(#[from] FormulaError),
    /// The frame is singular or not finite.
    #[error("deform: {0}")]
    Frame(#[from] AffineError),
    /// The resulting isosurface cannot exist.
    #[error("deform: {0}")]
    Surface(#[from] IsosurfaceError),
}

/// A piece of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    from: f64,
    to: f64,
}

impl LevelSet {
    /// The solid deformed by a warp.
    pub fn deformed(&self, warp: &Warp) -> Result<Self, DeformError> {
        let bounded = self.bounds().is_bounded() || self.bounds().is_empty();
        if !bounded && !matches!(warp, Warp::Inverse { .. }) {
            return Err(DeformError::Unbounded);
        }
        match *warp {
            Warp::Twist { axis, degrees, from, to } => {
                let stretch = Stretch::new("twist", from, to)?;
                let turn = angle("twist", degrees)?;
                self.warped(&frame("twist", axis)?, &Twist { turn, stretch })
            }
            Warp::Taper { axis, factor, from, to } => {
                let stretch = Stretch::new("taper", from, to)?;
                if !(factor > 0.0 && factor.is_finite()) {
                    return Err(DeformError::Factor(factor));
                }
                self.warped(&frame("taper", axis)?, &Taper { factor, stretch })
            }
            Warp::Bend { axis, toward, degrees, from, to } => {
                let stretch = Stretch::new("bend", from, to)?;
                let turn = angle("bend", degrees.abs())?;
                let toward = if degrees < 0.0 { -toward } else { toward };
                let frame = bend::frame(axis, toward)?;
                if degrees == 0.0 {
                    return Ok(self.clone());
                }
                let bend = Bend::new(turn, stretch, self.within(&frame)?)?;
                self.warped(&frame, &bend)
            }
            Warp::Inverse { ref functions, within } => inverse::deformed(self, functions, within),
            Warp::Lattice(_) => Err(DeformError::LatticeInverse),
        }
    }

    /// A box around it in another frame.
    fn within(&self, frame: &Affine) -> Result<Aabb, DeformError> {
        let back = frame.inverted()?;
        Ok(self.cells().iter().fold(Aabb::EMPTY, |all, cell| all.union(back.bounds(cell))))
    }

    fn warped(&self, frame: &Affine, map: &impl Map) -> Result<Self, DeformError> {
        let back = frame.inverted()?;
        let mut bounds = Aabb::EMPTY;
        for cell in self.cells() {
            let own = back.bounds(&cell);
            let image = map.image([0, 1, 2].map(|i| Interval { lo: own.min[i], hi: own.max[i] }));
            let [x, y, z] = image;
            let image = Aabb::new(Point3::new(x.lo, y.lo, z.lo), Point3::new(x.hi, y.hi, z.hi));
            bounds = bounds.union(frame.bounds(&image));
        }
        let (mut pen, p) = ExprBuilder::new()?;
        let own = pen.undone(p, frame)?;
        let was = map.undone(&mut pen, own)?;
        let was = pen.placed(was, frame)?;
        let mut f = pen.call(self.formula(), was)?;
        if let Some(nothing) = map.nothing(&mut pen, own)? {
            let outside = pen.number(1.0)?;
            f = pen.select(nothing, outside, f)?;
        }
        Ok(self.rewritten(pen.done(f), bounds))
    }
}

impl Warp {
    /// Appends the image of a point to the formula.
    pub(crate) fn applied(&self, pen: &mut ExprBuilder, p: [NodeId; 3]) -> Result<[NodeId; 3], DeformError> {
        match *self {
            Self::Twist { axis, degrees, from, to } => {
                let stretch = Stretch::new("twist", from, to)?;
                let turn = angle("twist", degrees)?;
                moved(pen, p, &frame("twist", axis)?, &Twist { turn, stretch })
            }
            Self::Taper { axis, factor, from, to } => {
                let stretch = Stretch::new("taper", from, to)?;
                if !(factor > 0.0 && factor.is_finite()) {
                    return Err(DeformError::Factor(factor));
                }
                moved(pen, p, &frame("taper", axis)?, &Taper { factor, stretch })
            }
            Self::Bend { axis, toward, degrees, from, to } => {
                let stretch = Stretch::new("bend", from, to)?;
                let turn = angle("bend", degrees.abs())?;
                let frame = bend::frame(axis, if degrees < 0.0 { -toward } else { toward })?;
                if degrees == 0.0 {
                    return Ok(p);
                }
                // A surface may come round to itself, so its place is not checked.
                moved(pen, p, &frame, &Bend::new(turn, stretch, Aabb::EMPTY)?)
            }
            Self::Inverse { .. } => Err(DeformError::Forward),
            Self::Lattice(ref lattice) => Ok(lattice.applied(pen, p)?),
        }
    }
}

fn moved(
    pen: &mut ExprBuilder,
    p: [NodeId; 3],
    frame: &Affine,
    map: &impl Map,
) -> Result<[NodeId; 3], DeformError> {
    let own = pen.undone(p, frame)?;
    let there = map.applied(pen, own)?;
    Ok(pen.placed(there, frame)?)
}

/// A warp in its own frame, with the z axis for its axis.
trait Map {
    /// Appends the image of a point to the formula.
    fn applied(&self, pen: &mut ExprBuilder, p: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError>;

    /// Bounds of the images of a box's points.
    fn image(&self, p: [Interval; 3]) -> [Interval; 3];

    /// Appends the inverse image of a point to the formula.
    fn undone(&self, pen: &mut ExprBuilder, p: [NodeId; 3]) -> Result<[NodeId; 3], FormulaError>;

    /// Appends a number that is negative only where no part of the solid is.
    fn nothing(&self, _: &mut ExprBuilder, _: [NodeId; 3]) -> Result<Option<NodeId>, FormulaError> {
        Ok(None)
    }
}

impl Stretch {
    fn new(warp: &'static str, from: f64, to: f64) -> Result<Self, DeformError> {
        if from < to && from.is_finite() && to.is_finite() && (to - from).is_finite() {
            Ok(Self { from, to })
        } else {
            Err(DeformError::Stretch { warp, from, to })
        }
    }

    fn length(self) -> Interval {
        Interval::from(self.to) - Interval::from(self.from)
    }
}

/// Converts an angle to radians.
fn angle(warp: &'static str, degrees: f64) -> Result<Interval, DeformError> {
    if degrees.is_finite() {
        Ok(Interval::from(degrees).to_radians())
    } else {
        Err(DeformError::Angle { warp, degrees })
    }
}

/// A right-handed frame with this axis for z: exact if it is one of the coordinate axes, else
/// rounded to f64.
fn frame(warp: &'static str, axis: Vec3) -> Result<Affine, DeformError> {
    let z = direction(axis).ok_or(DeformError::Axis { warp, axis })?;
    let along = (0..3).find(|&i| z[i].abs() == 1.0);
    let (x, y) = match along {
        Some(i) => {
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            let (x, y) = (axes[(i + 1) % 3], axes[(i + 2) % 3]);
            if z[i] > 0.0 { (x, y) } else { (y, x) }
        }
        None => z.orthonormal_basis(),
    };
    columns(x, y, z)
}

fn columns(x: Vec3, y: Vec3, z: Vec3) -> Result<Affine, DeformError> {
    // 0.0 + gives no negative zeros.
    let rows = [0, 1, 2].map(|i| [x[i] + 0.0, y[i] + 0.0, z[i] + 0.0]);
    Ok(Affine::new(rows, Point3::ORIGIN)?)
}

/// The unit vector along `v`, exactly where `v` lies along a coordinate axis.
fn direction(v: Vec3) -> Option<Vec3> {
    if !v.is_finite() || v == Vec3::ZERO {
        return None;
    }
    let parts = v.to_array();
    if parts.iter().filter(|x| **x != 0.0).count() == 1 {
        return Some(Vec3::from(parts.map(|x| if x == 0.0 { 0.0 } else { 1.0_f64.copysign(x) })));
    }
    let scaled = v * (1.0 / v.max_abs());
    Some(scaled * (1.0 / scaled.length()))
}

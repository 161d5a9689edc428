//! Deformed surfaces that are given by parameters: patches, NURBS, sewn ones and formulas.
//!
//! ```text
//!   (u, v)  ──S──▶  p  ──D──▶  D(S(u, v))
//! ```
//!
//! A ray meets the deformed surface itself, so the warps `D` are written after the surface `S`: each
//! Bezier patch becomes three formulas of `u` and `v` (A. H. Barr, "Global and local deformations of
//! solid primitives", *SIGGRAPH* 1984). Where all warps are lattices and the degree allows, the
//! patches of `S` become patches of a higher degree instead (`patch/composed.rs`).
//!
//! The deformed surface may meet itself; it only needs bounds. A closed sewn
//! one stays a solid; its inside is where the winding number of the deformed faces is not 0.

use super::Parametric;
use super::bounds::Bounds;
use super::piece::Face;
use super::sheet::Sheet;
use super::sweep_maps::OVERLAP;
use super::winding::{self, Turn, face_outside, kept_turns, pour};
use crate::compose::clip::Algebraic;
use crate::implicit::deform::{DeformStep, bernstein};
use crate::implicit::level_set::expr::ExprBuilder;
use crate::packet::FilterSource;
use crate::patch::composed::Moved;
use crate::patch::{Nets, Source, map_uv, net::FaceNet, shells, triangular};
use crate::{
    Accelerate, BezierPatch, DeformError, Forward, LocalPoint, LocalRay, Need, Nurbs, PartId, Root, Sewn,
    Side, Sink, Solidity, Surface, SurfacePoint, TriangularPatch,
};
use durer_formula::{FormulaError, NodeId, VectorTape};
use durer_math::{Aabb, Affine, Dd, Interval};
use std::sync::Arc;

/// A surface to deform.
#[derive(Clone, Debug, PartialEq)]
pub enum DeformSource {
    /// A Bezier patch.
    Patch(BezierPatch),
    /// A triangular Bezier patch.
    Triangular(TriangularPatch),
    /// A NURBS surface.
    Nurbs(Nurbs),
    /// NURBS surfaces that share edges, as a solid if they are closed.
    Sewn(Sewn),
    /// A surface of three formulas, all of it in its container.
    Parametric(Parametric),
}

/// A surface that is given by parameters, after placements and warps. A root's face is the patch, its
/// tag that patch's `(u, v)`; a triangular patch by formulas has `(u, v / (1 - u))`. The stored normal
/// is `S_u x S_v`, that of a solid points outward.
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::{BezierPatch, Closest, DeformSource, DeformStep, DeformedSurface, LocalRay, Surface, Warp};
/// // The strip from (-1, 0, 0) to (1, 2, 0), turned a quarter about y from its lower to its upper end.
/// let corners = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
/// let strip = DeformSource::Patch(BezierPatch::new([2, 2], &corners.map(Point3::from))?);
/// let twist = Warp::Twist { axis: Vec3::new(0.0, 1.0, 0.0), degrees: 90.0, from: 0.0, to: 2.0 };
/// let twisted = DeformedSurface::new(strip, vec![DeformStep::Warp(twist)])?.expect("it has an area");
/// // Half way up it is turned by 45 degrees: z = -x there.
/// let ray = Ray::new(Point3::new(0.5, 1.0, -3.0), Vec3::new(0.0, 0.0, 1.0));
/// let mut closest = Closest::default();
/// twisted.roots(&LocalRay::new(&ray), &mut closest);
/// let root = closest.root.expect("the ray meets it");
/// assert!(root.lo <= 2.5 && 2.5 <= root.hi && root.hi - root.lo < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DeformedSurface {
    made_of: Arc<(DeformSource, Vec<DeformStep>)>,
    body: Body,
}

#[derive(Clone, Debug)]
enum Body {
    /// Patches of a higher degree.
    Patches(Arc<Moved>),
    Formulas(Arc<Formulas>),
}

/// Maps of rectangles.
#[derive(Debug)]
struct Formulas {
    sheet: Sheet,
    is_triangle: bool,
    is_solid: bool,
}

impl DeformSource {
    fn patches(&self) -> Option<Source<'_>> {
        match self {
            Self::Patch(it) => Some(Source::Patch(it)),
            Self::Triangular(it) => Some(Source::Triangular(it)),
            Self::Nurbs(it) => Some(Source::Nurbs(it)),
            Self::Sewn(it) => Some(Source::Sewn(it)),
            Self::Parametric(_) => None,
        }
    }
}

impl DeformedSurface {
    /// The surface after these steps, one after another; `None` if nothing is left of it.
    pub fn new(source: DeformSource, steps: Vec<DeformStep>) -> Result<Option<Self>, DeformError> {
        let composed = source.patches().and_then(|patches| shells(patches, &steps));
        let body = match composed {
            Some(made) => match made? {
                None => return Ok(None),
                Some(made) => Body::Patches(Arc::new(made)),
            },
            None => match Formulas::new(&source, &steps)? {
                None => return Ok(None),
                Some(formulas) => Body::Formulas(Arc::new(formulas)),
            },
        };
        Ok(Some(Self { made_of: Arc::new((source, steps)), body }))
    }

    /// The surface that was deformed, and the steps.
    pub fn made_of(&self) -> (&DeformSource, &[DeformStep]) {
        (&self.made_of.0, &self.made_of.1)
    }

    /// Whether its patches are met as patches of a higher degree, not by formulas.
    pub fn is_composed(&self) -> bool {
        matches!(self.body, Body::Patches(_))
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        match &self.body {
            Body::Patches(made) => match &**made {
                Moved::Shell(shell) => {
                    if !ray.passes_by(shell.centre, shell.reach) {
                        shell.all_roots(ray, sink);
                    }
                }
                Moved::Sewn(sewn) => sewn.roots(ray, sink),
            },
            Body::Formulas(formulas) => formulas.roots(ray, sink),
        }
    }

    /// The texture coordinates of a point whose `uv` are the parameters of a patch.
    fn map_uv(&self, root: &Root, point: &mut SurfacePoint, need: Need) {
        match &self.made_of.0 {
            DeformSource::Patch(it) => map_uv(it.corners(), point, need),
            DeformSource::Triangular(it) => triangular::map_uv(it.corners(), point, need),
            DeformSource::Parametric(_) => {}
            DeformSource::Nurbs(it) => it.spread_uv(root.face, point),
            DeformSource::Sewn(it) => it.spread_uv(root.face, point),
        }
    }
}

/// Equal if they are made of the same.
impl PartialEq for DeformedSurface {
    fn eq(&self, other: &Self) -> bool {
        self.made_of == other.made_of
    }
}

impl Formulas {
    fn new(source: &DeformSource, steps: &[DeformStep]) -> Result<Option<Self>, DeformError> {
        let Some(patches) = source.patches() else {
            let DeformSource::Parametric(it) = source else { return Ok(None) };
            let face = it.whole_face().ok_or(DeformError::Cut)?;
            let mut pen = ExprBuilder(durer_formula::Builder::new());
            let inputs = [pen.0.input(0)?, pen.0.input(1)?];
            let p = face.tape.written(&mut pen.0, inputs)?;
            let p = moved(&mut pen, p, steps)?;
            let tape = VectorTape::of(&pen.0, p);
            return Self::of(vec![Face::new(tape, face.domain)], 0.0, |sheet| Self {
                sheet,
                is_triangle: false,
                is_solid: false,
            });
        };
        let is_solid = matches!(source, DeformSource::Sewn(it) if it.data().closed);
        if let DeformSource::Sewn(it) = source
            && is_solid
            && (it.data().seal > 0.0 || it.data().surfaces.iter().any(|s| !s.trims.is_empty()))
        {
            return Err(DeformError::Sealed);
        }
        let Nets { nets, trims, turned } = patches.nets();
        let mut faces = Vec::with_capacity(nets.len());
        for net in &nets {
            let mut pen = ExprBuilder(durer_formula::Builder::new());
            let inputs = [pen.0.input(0)?, pen.0.input(1)?];
            let p = point(&mut pen, net, inputs)?;
            let p = moved(&mut pen, p, steps)?;
            let tape = VectorTape::of(&pen.0, p);
            faces.push(Face::new(tape, [[0.0, 1.0]; 2]).reaching(OVERLAP));
        }
        let is_triangle = matches!(source, DeformSource::Triangular(_));
        Self::of(faces, OVERLAP, |sheet| Self {
            sheet: sheet.with_sides(turned, trims),
            is_triangle,
            is_solid,
        })
    }

    fn of(faces: Vec<Face>, gap: f64, made: impl FnOnce(Sheet) -> Self) -> Result<Option<Self>, DeformError> {
        match Sheet::new(faces, &Bounds::NONE, gap) {
            Ok(sheet) => Ok(sheet.map(made)),
            Err((_, refused)) => {
                let (super::Refused::Jump([u, v]) | super::Refused::Unbounded([u, v])) = refused;
                Err(DeformError::Torn { u, v })
            }
        }
    }

    fn roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        if ray.passes_by(self.sheet.centre, self.sheet.reach) {
            return;
        }
        if self.is_solid {
            self.sheet.with_all(ray, |at, found| pour(at, &self.turns(found), sink));
        } else {
            self.sheet.roots(ray, sink, |_| true);
        }
    }

    /// Where the winding number along a line leaves 0 or comes back to it, ascending.
    fn turns(&self, found: &[super::line::Found]) -> Vec<Turn> {
        let mut all: Vec<Turn> = found.iter().map(Turn::new).collect();
        all.sort_by(|a, b| a.found.s.total_cmp(&b.found.s));
        kept_turns(all, &self.sheet.faces)
    }

    /// The point of a root, with the parameters of its patch.
    fn point(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let mut point = self.sheet.point(ray, root);
        if self.is_solid {
            face_outside(&mut point, ray, root);
        }
        if self.is_triangle {
            // u and v / (1 - u).
            let [u, part] = point.uv;
            point.uv[1] = (1.0 - u) * part;
            point.change_parameters([[1.0, 0.0], [-part, 1.0 - u]], need);
        }
        point
    }
}

/// Appends the point of a patch to the formula.
fn point(pen: &mut ExprBuilder, net: &FaceNet, [u, v]: [NodeId; 2]) -> Result<[NodeId; 3], FormulaError> {
    let (points, weights) = match net {
        FaceNet::Square(net) => {
            let [nu, nv] = net.size;
            let (bu, bv) = (bernstein(pen, nu - 1, u)?, bernstein(pen, nv - 1, v)?);
            let mut weights = Vec::with_capacity(net.points.len());
            for b in &bv {
                for a in &bu {
                    weights.push(pen.mul(*a, *b)?);
                }
            }
            (&net.points, weights)
        }
        // The triangle is the image of the square under (u, v) -> (u, (1 - u) v).
        FaceNet::Triangle(net) => {
            let n = net.side - 1;
            let mut weights = Vec::with_capacity(net.points.len());
            for j in 0..=n {
                let along = bernstein(pen, n, u)?;
                for i in 0..=n - j {
                    // B_i^n(u) B_j^(n - i)(v): the factors of 1 - u are n - i in all.
                    let across = bernstein(pen, n - i, v)?;
                    weights.push(pen.mul(along[i], across[j])?);
                }
            }
            (&net.points, weights)
        }
    };
    let is_rational = points.iter().any(|p| p[3] != Dd::ONE);
    let mut sums = Vec::with_capacity(4);
    for c in 0..if is_rational { 4 } else { 3 } {
        // The polynomials add up to 1: less is lost in differences of points.
        let mut sum = None;
        for (weight, p) in weights.iter().zip(points) {
            let number = pen.enclosed(enclosed(p[c]))?;
            let term = pen.mul(*weight, number)?;
            sum = Some(match sum {
                None => term,
                Some(sum) => pen.add(sum, term)?,
            });
        }
        sums.push(sum.map_or_else(|| pen.number(0.0), Ok)?);
    }
    let mut out = [sums[0], sums[1], sums[2]];
    if is_rational {
        for part in &mut out {
            *part = pen.div(*part, sums[3])?;
        }
    }
    Ok(out)
}

/// A number in double-double within an interval.
fn enclosed(x: Dd) -> Interval {
    let near = x.to_f64();
    if x == Dd::from(near) {
        return Interval { lo: near + 0.0, hi: near + 0.0 };
    }
    Interval { lo: near.next_down(), hi: near.next_up() }
}

/// Appends the image of a point to the formula.
fn moved(
    pen: &mut ExprBuilder,
    mut p: [NodeId; 3],
    steps: &[DeformStep],
) -> Result<[NodeId; 3], DeformError> {
    for step in steps {
        p = match step {
            DeformStep::Place(map) if *map == Affine::IDENTITY => p,
            DeformStep::Place(map) => pen.placed(p, map)?,
            DeformStep::Warp(warp) => warp.applied(pen, p)?,
        };
    }
    Ok(p)
}

impl Surface for DeformedSurface {
    fn bounds(&self) -> Aabb {
        match &self.body {
            Body::Patches(made) => match &**made {
                Moved::Shell(shell) => shell.bounds,
                Moved::Sewn(sewn) => sewn.bounds(),
            },
            Body::Formulas(formulas) => formulas.sheet.bounds,
        }
    }

    fn roots<S: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut S) {
        self.all_roots(ray, &mut Forward(sink));
    }

    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        let mut point = match &self.body {
            Body::Patches(made) => match &**made {
                Moved::Shell(shell) => shell.point(ray, root),
                // It maps its own texture coordinates.
                Moved::Sewn(sewn) => return sewn.resolve(ray, root, need),
            },
            Body::Formulas(formulas) => formulas.point(ray, root, need),
        };
        self.map_uv(root, &mut point, need);
        point
    }

    fn solidity(&self) -> Solidity {
        match &self.made_of.0 {
            DeformSource::Sewn(it) => it.solidity(),
            _ => Solidity::Open,
        }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        match &self.body {
            Body::Patches(made) => match &**made {
                Moved::Sewn(sewn) => sewn.side(point),
                Moved::Shell(_) => Side::Out,
            },
            Body::Formulas(it) if it.is_solid => winding::side(&it.sheet, point, |found| it.turns(found)),
            Body::Formulas(_) => Side::Out,
        }
    }
}

impl Accelerate for DeformedSurface {
    fn name(&self) -> &'static str {
        "deformed surface"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        FilterSource::vague(self.bounds())
    }
}

impl Algebraic for DeformedSurface {}

//! NURBS surfaces that share edges: one object, and a solid if every edge has a partner.
//!
//! Edges with the same control points are the same curve to the last bit, so no ray passes between
//! them, and a crossing on one is reported once. Trimmed edges are only near each other, within
//! `seal` (`seal.rs`). A point is inside if a line from it crosses the faces an odd number of
//! times. W. Martin, E. Cohen, R. Fish, P. Shirley, "Practical ray tracing of trimmed NURBS
//! surfaces", *Journal of Graphics Tools* 5 (2000) 27-52.

use super::nurbs::Parts;
use super::seam::Surfaces;
use super::shell::{FaceTrim, Shell};
use super::surface::{Patches, surface_of_patches};
use super::trim::Trims;
use super::{NurbsData, NurbsError};
use crate::{All, LocalPoint, LocalRay, Need, Root, RootKind, Side, Solidity, SurfacePoint};
use durer_math::{Point3, Ray, Vec3};
use std::sync::Arc;

/// The input of a [`Sewn`] surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SewnData {
    /// The surfaces.
    pub surfaces: Vec<NurbsData>,
    /// The largest distance between edges that belong together; gaps of a closed surface are
    /// closed. 0: their control points must be equal.
    pub seal: f64,
    /// Whether it is a solid: then every edge must have a partner.
    pub closed: bool,
}

impl SewnData {
    /// Checks whether these surfaces form an object, by building it.
    pub fn check(&self) -> Result<(), SewnError> {
        Sewn::new(self.clone()).map(drop)
    }
}

/// Why a [`Sewn`] surface cannot exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SewnError {
    /// There are no surfaces.
    #[error("sewn: it needs one surface at least")]
    Empty,
    /// A surface cannot exist.
    #[error("sewn: surface {number}: {why}")]
    Surface {
        /// The surface, from 1.
        number: usize,
        /// Why.
        why: NurbsError,
    },
    /// The seal is negative, infinite or NaN.
    #[error("sewn: the seal must be finite and not negative, got {0}")]
    Seal(f64),
    /// An edge of a closed one has no partner.
    #[error(
        "sewn: it is not closed: {edge} of surface {surface}, from <{}, {}, {}> to <{}, {}, {}>, has no partner",
        from.x, from.y, from.z, to.x, to.y, to.z
    )]
    Edge {
        /// The surface, from 1.
        surface: usize,
        /// The edge.
        edge: String,
        /// Where it begins.
        from: Point3,
        /// Where it ends.
        to: Point3,
    },
    /// An edge of a closed one has more than one partner.
    #[error(
        "sewn: {count} surfaces share {edge} of surface {surface}, from <{}, {}, {}> to <{}, {}, {}>",
        from.x, from.y, from.z, to.x, to.y, to.z
    )]
    Many {
        /// The surface, from 1.
        surface: usize,
        /// The edge.
        edge: String,
        /// Where it begins.
        from: Point3,
        /// Where it ends.
        to: Point3,
        /// How many share it.
        count: usize,
    },
    /// Surfaces of a closed one have no common outer side.
    #[error("sewn: it has no inside: surfaces {a} and {b} cannot be oriented consistently")]
    Sides {
        /// One surface, from 1.
        a: usize,
        /// The other, from 1.
        b: usize,
    },
    /// No ray decides which side of a closed one is inside.
    #[error("sewn: it has no inside: no line crosses it an even number of times")]
    Inside,
}

/// NURBS surfaces as one object, a solid if it is closed. A root's face is a Bezier patch, counted
/// through all surfaces, its tag that patch's `(u, v)`. The normals of a solid point outward.
///
/// ```
/// use durer_surfaces::{NurbsData, Sewn, SewnData, Solidity, Surface};
/// // Four triangles, each a face with one side that is a point: a tetrahedron.
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let face = |a: usize, b: usize, c: usize| {
///     let points = [a, b, c, c].map(|k| [corners[k][0], corners[k][1], corners[k][2], 1.0]);
///     NurbsData { degree: [1, 1], size: [2, 2], points: points.to_vec(), ..NurbsData::default() }
/// };
/// let surfaces = vec![face(0, 1, 2), face(0, 1, 3), face(1, 2, 3), face(2, 0, 3)];
/// let solid = Sewn::new(SewnData { surfaces, seal: 0.0, closed: true })?;
/// assert_eq!(solid.solidity(), Solidity::Solid);
/// # Ok::<(), durer_surfaces::SewnError>(())
/// ```
///
/// # Invariants
///
/// Those of [`Nurbs`](crate::Nurbs). If it is closed, every edge has exactly one partner.
#[derive(Clone, Debug)]
pub struct Sewn {
    data: Arc<SewnData>,
    shell: Arc<Shell>,
    /// The ranges of parameters of each patch, as fractions of its surface: least ones and widths.
    spans: Arc<[[[f64; 2]; 2]]>,
}

impl Sewn {
    /// The object of these surfaces.
    pub fn new(data: SewnData) -> Result<Self, SewnError> {
        if !(data.seal >= 0.0 && data.seal.is_finite()) {
            return Err(SewnError::Seal(data.seal));
        }
        let of = |(i, surface)| Parts::new(surface).map_err(|why| SewnError::Surface { number: i + 1, why });
        let parts: Vec<Parts> = data.surfaces.iter().enumerate().map(of).collect::<Result<_, _>>()?;
        Self::of_parts(data, &parts)
    }

    /// The object of these surfaces' patches.
    pub(super) fn of_parts(data: SewnData, parts: &[Parts]) -> Result<Self, SewnError> {
        let (mut first, mut spans, mut nets, mut trims) = (vec![], vec![], vec![], vec![]);
        // Gaps are closed only where entries and exits must alternate.
        let seal = if data.closed { data.seal } else { 0.0 };
        for parts in parts {
            first.push(nets.len());
            let own = parts.trims.clone();
            let own = own.or_else(|| (seal > 0.0).then(|| Arc::new(Trims::none(parts.domain()))));
            for face in 0..parts.nets.len() {
                spans.push(parts.part(face));
                let [from, width] = parts.span(face);
                trims.push(own.clone().map(|trims| FaceTrim { trims, from, width }));
            }
            nets.extend(parts.nets.iter().cloned());
        }
        if nets.is_empty() {
            return Err(SewnError::Empty);
        }
        let nothing = SewnError::Surface { number: 1, why: NurbsError::Nothing };
        let mut shell = Shell::trimmed(&nets, |face| trims[face].clone(), seal).ok_or(nothing)?;
        if data.closed {
            let periodic: Vec<_> = data.surfaces.iter().map(|s| s.periodic).collect();
            let surfaces = Surfaces { parts, first: &first, periodic: &periodic, shell: &shell };
            let groups = surfaces.joined(shell.seal)?;
            let surface_of: Vec<usize> =
                (0..nets.len()).map(|face| first.partition_point(|f| *f <= face) - 1).collect();
            for (face, surface) in shell.faces.iter_mut().zip(&surface_of) {
                face.is_turned = groups[*surface].1;
            }
            let group_of: Vec<usize> = surface_of.iter().map(|s| groups[*s].0).collect();
            shell.turn_outward(&group_of)?;
            shell.is_closed = true;
        }
        Ok(Self { data: Arc::new(data), shell: Arc::new(shell), spans: spans.into() })
    }

    /// Replaces the parameters of a patch by those of the whole surface, from 0 to 1.
    pub(crate) fn spread_uv(&self, face: u32, point: &mut SurfacePoint) {
        if let Some([from, width]) = self.spans.get(face as usize) {
            point.uv = [0, 1].map(|k| f64::mul_add(point.uv[k], width[k], from[k]));
            (point.dpdu, point.dpdv) = (point.dpdu * (1.0 / width[0]), point.dpdv * (1.0 / width[1]));
        }
    }

    /// The input that it was made from.
    pub fn data(&self) -> &SewnData {
        &self.data
    }
}

impl Shell {
    /// Orients each group of faces so that normals point out of the solid: along a line without
    /// touches or crossings on edges, entries and exits alternate.
    fn turn_outward(&mut self, group_of: &[usize]) -> Result<(), SewnError> {
        let mut groups: Vec<usize> = group_of.to_vec();
        groups.sort_unstable();
        groups.dedup();
        let sealed = core::mem::replace(&mut self.seal, 0.0);
        for group in groups {
            let turned = self.is_inward(group_of, group).ok_or(SewnError::Inside)?;
            if turned {
                for (face, of) in self.faces.iter_mut().zip(group_of) {
                    face.is_turned ^= *of == group;
                }
            }
        }
        self.seal = sealed;
        Ok(())
    }

    /// Whether the normals of a group point into the solid; `None` if no line decides.
    fn is_inward(&self, group_of: &[usize], group: usize) -> Option<bool> {
        let aims = self.kept_points().filter(|(face, _)| group_of[*face] == group);
        aims.take(64).find_map(|(face, aim)| {
            DIRECTIONS.iter().find_map(|d| {
                let ray = Ray::new(aim, Vec3::from(*d)).with_range(f64::NEG_INFINITY, f64::INFINITY);
                let mut all = All::default();
                self.all_roots(&LocalRay::new(&ray), &mut all);
                let roots = all.roots;
                let clear = |w: &[Root]| w[0].hi < w[1].lo;
                if roots.len() % 2 == 1 || !roots.iter().all(is_proper) || !roots.windows(2).all(clear) {
                    return None;
                }
                let k = roots.iter().position(|r| r.face as usize == face)?;
                Some((roots[k].sign < 0) != (k % 2 == 0))
            })
        })
    }
}

fn is_proper(root: &Root) -> bool {
    root.kind == RootKind::Simple
}

/// Directions of lines that decide between inside and outside: any that meets no edge is suitable.
const DIRECTIONS: [[f64; 3]; 6] = [
    [0.283, 0.531, 0.798],
    [-0.719, 0.412, 0.559],
    [0.611, -0.703, 0.364],
    [0.155, 0.902, -0.402],
    [-0.437, -0.349, 0.829],
    [0.874, 0.217, 0.434],
];

/// Surfaces are equal if they are made from equal data.
impl PartialEq for Sewn {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

impl Patches for Sewn {
    const NAME: &'static str = "sewn surface";

    fn shell(&self) -> &Shell {
        &self.shell
    }

    fn map_uv(&self, root: &Root, point: &mut SurfacePoint, _need: Need) {
        self.spread_uv(root.face, point);
    }

    fn solidity(&self) -> Solidity {
        if self.data.closed { Solidity::Solid } else { Solidity::Open }
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        if !self.data.closed || !self.shell.bounds.expanded(point.p_err).contains(point.p) {
            return Side::Out;
        }
        let mut told = Side::Out;
        for d in DIRECTIONS {
            let ray = Ray::new(point.p, Vec3::from(d)).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let local = LocalRay::new(&ray);
            let mut all = All::default();
            self.shell.all_roots(&local, &mut all);
            let ahead: i32 = all.roots.iter().filter(|r| r.t > 0.0).map(|r| i32::from(r.sign)).sum();
            told = if ahead > 0 { Side::In } else { Side::Out };
            // The distance by which an error of the point moves a crossing along the line.
            let moves = |r: &Root| {
                let n = self.shell.point(&local, r).ng.to_vec();
                n.abs().dot(point.p_err) / n.dot(ray.direction).abs()
            };
            let holds = |r: &Root| r.lo <= 0.0 && r.hi >= 0.0 || r.t.abs() <= 2.0 * moves(r);
            if all.roots.iter().any(holds) {
                return Side::On;
            }
            if all.roots.iter().all(is_proper) {
                break;
            }
        }
        told
    }
}

surface_of_patches!(Sewn);

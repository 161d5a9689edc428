//! Non-uniform rational B-splines: Bezier patches that join, from one net and two lists of knots.
//!
//! ```text
//!   S(u, v) = sum of N_i(u) N_j(v) w_ij P_ij / sum of N_i(u) N_j(v) w_ij
//! ```
//!
//! `N` are the B-splines over the knots. Knots are inserted until each is there as often as the
//! degree says (W. Boehm, "Inserting new knots into B-spline curves", *Computer-Aided Design* 12
//! (1980) 199-201); then the net is that of Bezier patches, one for each pair of spans. That is
//! done in double-double, so its error is far below all others, and patches that join have the same
//! control points along their edge. W. Stuerzlinger, "Ray-tracing triangular trimmed free-form
//! surfaces", *IEEE Transactions on Visualization and Computer Graphics* 4 (1998) 202-214; L.
//! Piegl, W. Tiller, *The NURBS Book*, 2nd ed. 1997.

use super::net::{FaceNet, Homogeneous, Net, between};
use super::shell::{FaceTrim, Shell};
use super::surface::{Patches, surface_of_patches};
use super::trim::{TrimError, TrimLoop, Trims};
use super::{LARGEST, WEIGHTS};
use crate::{Need, Root, SurfacePoint};
use durer_math::Dd;
use std::sync::Arc;

/// The highest degree.
const MOST_DEGREE: usize = 9;

/// The input of a [`Nurbs`] surface: the first of each pair is along `u`, the second along `v`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NurbsData {
    /// The degrees, 1 to 9.
    pub degree: [usize; 2],
    /// How many points a row has, and how many rows there are.
    pub size: [usize; 2],
    /// The points row by row, and their weights: `[x, y, z, w]`, with coordinates that are not
    /// multiplied by the weight. `u` runs along a row.
    pub points: Vec<[f64; 4]>,
    /// The knots along each parameter: the number of points plus the degree plus one; if periodic,
    /// the number of points plus one. Empty: uniform, and the surface ends at the outer points.
    pub knots: [Vec<f64>; 2],
    /// Whether points and knots are periodic.
    pub periodic: [bool; 2],
    /// Loops that do not cross; the part to the left of them is kept. Empty: all of the surface. A
    /// loop within another runs the other way round.
    pub trims: Vec<TrimLoop>,
}

impl NurbsData {
    /// Checks whether these numbers make a surface, before it is built. Does not check whether all
    /// points are the same.
    pub fn check(&self) -> Result<(), NurbsError> {
        let full = [full_knots(self, 0)?, full_knots(self, 1)?];
        check(self)?;
        self.trims(&full).map(|_| ())
    }

    /// The trims, if there are any.
    fn trims(&self, full: &[(Vec<f64>, usize); 2]) -> Result<Option<Trims>, NurbsError> {
        if self.trims.is_empty() {
            return Ok(None);
        }
        let ends = [0, 1].map(|k: usize| [full[k].0[self.degree[k]], full[k].0[full[k].1]]);
        let domain = [[ends[0][0], ends[1][0]], [ends[0][1], ends[1][1]]];
        let made = Trims::new(&self.trims, domain);
        made.map(Some).map_err(|(number, why)| NurbsError::Trim { number, why })
    }
}

/// Why a [`Nurbs`] surface cannot exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NurbsError {
    /// The degree is out of range.
    #[error("nurbs: the degree along {along} must be 1 to 9, got {degree}")]
    Degree {
        /// The parameter.
        along: char,
        /// The degree.
        degree: usize,
    },
    /// There are too few points along a parameter.
    #[error("nurbs: degree {degree} needs {least} points along {along} at least, got {len}")]
    TooFew {
        /// The parameter.
        along: char,
        /// The degree.
        degree: usize,
        /// How many it needs.
        least: usize,
        /// How many there are.
        len: usize,
    },
    /// The number of points is not that of the net.
    #[error("nurbs: a net of {} by {} has {} points, got {len}", size[0], size[1], size[0] * size[1])]
    Count {
        /// The points of a row, and the rows.
        size: [usize; 2],
        /// How many points there are.
        len: usize,
    },
    /// The number of knots is wrong.
    #[error("nurbs: {needed} knots are needed along {along}, got {len}")]
    Knots {
        /// The parameter.
        along: char,
        /// How many are needed.
        needed: usize,
        /// How many there are.
        len: usize,
    },
    /// A knot is infinite, NaN, or less than the one before it.
    #[error("nurbs: knots must be finite and must not decrease, but knot {number} along {along} is {knot}")]
    Knot {
        /// The parameter.
        along: char,
        /// The knot, from 1.
        number: usize,
        /// Its value.
        knot: f64,
    },
    /// A knot is there too often.
    #[error("nurbs: the knot {knot} along {along} occurs {times} times, but may occur at most {most} times")]
    Repeated {
        /// The parameter.
        along: char,
        /// Its value.
        knot: f64,
        /// How often it is there.
        times: usize,
        /// How often it may be.
        most: usize,
    },
    /// A point is infinite, NaN or too large.
    #[error("nurbs: point {column} of row {row} must be finite and less than 1e60, got <{x}, {y}, {z}>")]
    Point {
        /// The place in its row, from 1.
        column: usize,
        /// The row, from 1.
        row: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its z.
        z: f64,
    },
    /// A weight is not positive, infinite or NaN.
    #[error("nurbs: the weight of point {column} of row {row} must be positive and finite, got {weight}")]
    Weight {
        /// The place in its row, from 1.
        column: usize,
        /// The row, from 1.
        row: usize,
        /// Its weight.
        weight: f64,
    },
    /// The ratio of two weights is too large.
    #[error("nurbs: the largest weight is {0} times the least, which is too much")]
    Weights(f64),
    /// A trim cannot be one.
    #[error("nurbs: trim {number}: {why}")]
    Trim {
        /// The trim, from 1.
        number: usize,
        /// Why.
        why: TrimError,
    },
    /// All points are the same, or trims leave nothing.
    #[error("nurbs: all its points are the same, so it has no surface")]
    Nothing,
}

/// A surface of non-uniform rational B-splines: open, with `S_u x S_v` as its stored normal. A root's
/// face is the Bezier patch, its tag that patch's `(u, v)`.
///
/// ```
/// use durer_surfaces::{Nurbs, NurbsData};
/// // A quarter of a cylinder of radius 1, exactly.
/// let rows = [0.0, 1.0].map(|y| [[1.0, y, 0.0, 1.0], [1.0, y, 1.0, 1.0], [0.0, y, 1.0, 2.0]]);
/// let data = NurbsData { degree: [2, 1], size: [3, 2], points: rows.concat(), ..NurbsData::default() };
/// let quarter = Nurbs::new(data)?;
/// assert_eq!(quarter.patches(), 1);
/// # Ok::<(), durer_surfaces::NurbsError>(())
/// ```
///
/// # Invariants
///
/// Numbers are finite, weights positive, and knots do not fall.
#[derive(Clone, Debug)]
pub struct Nurbs {
    data: Arc<NurbsData>,
    shell: Arc<Shell>,
    /// The ranges of parameters of each patch, as fractions of the whole: least ones and widths.
    spans: Arc<[[[f64; 2]; 2]]>,
}

const ALONG: [char; 2] = ['u', 'v'];

/// The knots along a parameter, periodic and default ones included, and how many control points
/// they need.
fn full_knots(data: &NurbsData, k: usize) -> Result<(Vec<f64>, usize), NurbsError> {
    let (along, degree, len) = (ALONG[k], data.degree[k], data.size[k]);
    if !(1..=MOST_DEGREE).contains(&degree) {
        return Err(NurbsError::Degree { along, degree });
    }
    let least = degree + 1;
    if len < least {
        return Err(NurbsError::TooFew { along, degree, least, len });
    }
    let (given, periodic) = (&data.knots[k], data.periodic[k]);
    let needed = if periodic { len + 1 } else { len + degree + 1 };
    if given.is_empty() {
        let count = |n: usize| n as f64;
        let knots = if periodic {
            (0..len + 2 * degree + 1).map(|i| count(i) - count(degree)).collect()
        } else {
            (0..needed).map(|i| count(i.clamp(degree, len)) - count(degree)).collect()
        };
        return Ok((knots, if periodic { len + degree } else { len }));
    }
    if given.len() != needed {
        return Err(NurbsError::Knots { along, needed, len: given.len() });
    }
    for (i, &knot) in given.iter().enumerate() {
        if !knot.is_finite() || i > 0 && knot < given[i - 1] {
            return Err(NurbsError::Knot { along, number: i + 1, knot });
        }
    }
    for same in given.chunk_by(|a, b| a == b) {
        let (knot, times) = (same[0], same.len());
        let is_end = !periodic && (knot == given[0] || Some(&knot) == given.last());
        let most = degree + usize::from(is_end);
        if times > most {
            return Err(NurbsError::Repeated { along, knot, times, most });
        }
    }
    if !periodic {
        // The surface is between these two.
        if given[degree] >= given[len] {
            let (knot, times) = (given[degree], len - degree + 1);
            return Err(NurbsError::Repeated { along, knot, times, most: degree });
        }
        return Ok((given.clone(), len));
    }
    let round = given[len] - given[0];
    let at = |i: usize| {
        // Knot `i - degree`, by whole periods and a rest.
        let (turns, rest) = ((i + 8 * len - degree) / len, (i + 8 * len - degree) % len);
        given[rest] + (turns as f64 - 8.0) * round
    };
    Ok(((0..len + 2 * degree + 1).map(at).collect(), len + degree))
}

/// A curve's control points after a knot was inserted.
fn insert(curve: &mut Vec<Homogeneous<Dd>>, knots: &[f64], degree: usize, knot: f64) {
    // The last span that begins at the knot or before it.
    let span = knots.partition_point(|t| *t <= knot) - 1;
    let same = knots.iter().filter(|t| **t == knot).count();
    let old = curve.clone();
    let (first, last) = (span + 1 - degree, span - same);
    for i in first..=last {
        let part = Dd::difference(knot, knots[i]) / Dd::difference(knots[i + degree], knots[i]);
        for c in 0..4 {
            curve[i][c] = between(old[i - 1][c], old[i][c], part);
        }
    }
    curve.insert(last + 1, old[last]);
}

/// The Bezier control points of a curve, span after span, neighbours sharing their ends; and the
/// knots between which the spans are.
pub(super) fn spans(
    curve: &[Homogeneous<Dd>],
    knots: &[f64],
    degree: usize,
) -> (Vec<Homogeneous<Dd>>, Vec<f64>) {
    let (mut curve, mut knots) = (curve.to_vec(), knots.to_vec());
    let (from, to) = (knots[degree], knots[curve.len()]);
    let mut ends: Vec<f64> = knots.iter().copied().filter(|t| (from..=to).contains(t)).collect();
    ends.dedup();
    for &end in &ends {
        while knots.iter().filter(|t| **t == end).count() < degree {
            insert(&mut curve, &knots, degree, end);
            let at = knots.partition_point(|t| *t <= end);
            knots.insert(at, end);
        }
    }
    // The first span's first point is that before the last of the knots at the start.
    let begin = knots.partition_point(|t| *t <= from) - 1 - degree;
    let count = degree * (ends.len() - 1) + 1;
    (curve[begin..begin + count].to_vec(), ends)
}

/// A surface as Bezier patches: rows along `u`, one after another along `v`.
pub(super) struct Parts {
    pub(super) nets: Vec<FaceNet>,
    /// The knots between which patches are, along `u` and `v`.
    pub(super) ends: [Vec<f64>; 2],
    pub(super) trims: Option<Arc<Trims>>,
}

impl Parts {
    pub(super) fn new(data: &NurbsData) -> Result<Self, NurbsError> {
        let full = [full_knots(data, 0)?, full_knots(data, 1)?];
        check(data)?;
        let trims = data.trims(&full)?.map(Arc::new);
        let given = Net::new(data.size, &data.points).points;
        let [nu, nv] = data.size;
        // Rows first, then columns.
        let mut ends = [vec![], vec![]];
        let mut rows = Vec::new();
        for row in given.chunks_exact(nu) {
            let curve: Vec<_> = (0..full[0].1).map(|i| row[i % nu]).collect();
            let (points, knots) = spans(&curve, &full[0].0, data.degree[0]);
            rows.push(points);
            ends[0] = knots;
        }
        let width = rows[0].len();
        let mut columns = Vec::new();
        for i in 0..width {
            let curve: Vec<_> = (0..full[1].1).map(|j| rows[j % nv][i]).collect();
            let (points, knots) = spans(&curve, &full[1].0, data.degree[1]);
            columns.push(points);
            ends[1] = knots;
        }
        let [pu, pv] = data.degree;
        let mut nets = vec![];
        for b in 0..ends[1].len() - 1 {
            for a in 0..ends[0].len() - 1 {
                let net = (0..=pv).flat_map(|j| (0..=pu).map(move |i| (a * pu + i, b * pv + j)));
                let points = net.map(|(i, j)| columns[i][j]).collect();
                nets.push(FaceNet::Square(Net { size: [pu + 1, pv + 1], points }));
            }
        }
        Ok(Self { nets, ends, trims })
    }

    /// How many patches there are along `u` and along `v`.
    pub(super) fn grid(&self) -> [usize; 2] {
        [0, 1].map(|k: usize| self.ends[k].len() - 1)
    }

    /// The least parameters of a patch and their widths, in the units of the knots.
    pub(super) fn span(&self, face: usize) -> [[f64; 2]; 2] {
        let at = [face % self.grid()[0], face / self.grid()[0]];
        let ends = [0, 1].map(|k: usize| [self.ends[k][at[k]], self.ends[k][at[k] + 1]]);
        [ends.map(|[from, _]| from), ends.map(|[from, to]| to - from)]
    }

    /// The trims of a patch, if there are any.
    pub(super) fn trim(&self, face: usize) -> Option<FaceTrim> {
        let [from, width] = self.span(face);
        self.trims.clone().map(|trims| FaceTrim { trims, from, width })
    }

    /// The least parameters of a patch and their widths, as fractions of the whole.
    pub(super) fn part(&self, face: usize) -> [[f64; 2]; 2] {
        let [from, width] = self.span(face);
        let whole = [0, 1].map(|k: usize| [self.ends[k][0], self.ends[k][self.ends[k].len() - 1]]);
        let all = whole.map(|[a, b]| b - a);
        [[0, 1].map(|k: usize| (from[k] - whole[k][0]) / all[k]), [0, 1].map(|k: usize| width[k] / all[k])]
    }

    /// The least and the greatest parameters.
    pub(super) fn domain(&self) -> [[f64; 2]; 2] {
        [[0, 1].map(|k: usize| self.ends[k][0]), [0, 1].map(|k: usize| self.ends[k][self.ends[k].len() - 1])]
    }
}

impl Nurbs {
    /// The surface of these points and knots.
    pub fn new(data: NurbsData) -> Result<Self, NurbsError> {
        let parts = Parts::new(&data)?;
        let shell = Shell::trimmed(&parts.nets, |face| parts.trim(face), 0.0).ok_or(NurbsError::Nothing)?;
        let spans = (0..parts.nets.len()).map(|face| parts.part(face)).collect();
        Ok(Self { data: Arc::new(data), shell: Arc::new(shell), spans })
    }

    /// Replaces the parameters of a patch by those of the whole surface, from 0 to 1.
    pub(crate) fn spread_uv(&self, face: u32, point: &mut SurfacePoint) {
        if let Some([from, width]) = self.spans.get(face as usize) {
            point.uv = [0, 1].map(|k| f64::mul_add(point.uv[k], width[k], from[k]));
            (point.dpdu, point.dpdv) = (point.dpdu * (1.0 / width[0]), point.dpdv * (1.0 / width[1]));
        }
    }

    /// The input that it was made from.
    pub fn data(&self) -> &NurbsData {
        &self.data
    }

    /// How many Bezier patches it has.
    pub fn patches(&self) -> usize {
        self.spans.len()
    }
}

/// Checks that all points and weights are in the range in which the solver works.
fn check(data: &NurbsData) -> Result<(), NurbsError> {
    let (size, len) = (data.size, data.points.len());
    if size[0].checked_mul(size[1]) != Some(len) {
        return Err(NurbsError::Count { size, len });
    }
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for (i, &[x, y, z, weight]) in data.points.iter().enumerate() {
        let (column, row) = (i % size[0] + 1, i / size[0] + 1);
        if ![x, y, z].iter().all(|x| x.abs() < LARGEST) {
            return Err(NurbsError::Point { column, row, x, y, z });
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(NurbsError::Weight { column, row, weight });
        }
        (least, most) = (least.min(weight), most.max(weight));
    }
    if most / least > WEIGHTS {
        return Err(NurbsError::Weights(most / least));
    }
    Ok(())
}

/// Surfaces are equal if they are made from equal data.
impl PartialEq for Nurbs {
    fn eq(&self, other: &Self) -> bool {
        self.data == other.data
    }
}

impl Patches for Nurbs {
    const NAME: &'static str = "NURBS surface";

    fn shell(&self) -> &Shell {
        &self.shell
    }

    /// Texture coordinates: the parameters, from 0 to 1 over the whole surface.
    fn map_uv(&self, root: &Root, point: &mut SurfacePoint, _need: Need) {
        self.spread_uv(root.face, point);
    }
}

surface_of_patches!(Nurbs);

//! Patches that a lattice deforms, exactly: a polynomial map of a Bezier patch is a Bezier patch.
//!
//! ```text
//!   (a b)_k = sum over i + j = k of (n over i) (m over j) / (n + m over k)  a_i b_j
//! ```
//!
//! are the Bernstein coefficients of a product of degrees `n` and `m`. A lattice with `l + 1`, `m + 1`
//! and `n + 1` points along its axes makes a patch of `l + m + n` times the degree; where that is more
//! than [`MOST`] allows, the formula back end takes it (`parametric/deformed.rs`). With weights, `B_i(s)`
//! of `s = (X - min W) / (width W)` is multiplied by `W^l`, so that everything stays a polynomial.
//!
//! T. W. Sederberg, S. R. Parry, "Free-form deformation of solid geometric models", *SIGGRAPH* 1986;
//! T. D. DeRose, "Composing Bezier simplexes", *ACM Transactions on Graphics* 7 (1988) 198-221.
//! Like the nets of NURBS, this is done in double-double, alike for equal control points.

use super::cell::MOST;
use super::net::{FaceNet, Homogeneous, Net};
use super::nurbs::Parts;
use super::shell::{FaceTrim, Shell};
use super::surface::Patches;
use super::{BezierPatch, LARGEST, Nurbs, Sewn, SewnError, TriangularPatch, WEIGHTS};
use crate::{DeformStep, Lattice, Warp};
use durer_math::{Affine, Dd};
use durer_roots::bernstein::binomial;

/// Surfaces whose control points can be moved.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source<'a> {
    Patch(&'a BezierPatch),
    Triangular(&'a TriangularPatch),
    Nurbs(&'a Nurbs),
    Sewn(&'a Sewn),
}

/// The patches of a surface.
pub(crate) struct Nets {
    pub(crate) nets: Vec<FaceNet>,
    pub(crate) trims: Vec<Option<FaceTrim>>,
    /// Whether normals point the other way, out of a solid.
    pub(crate) turned: Vec<bool>,
}

/// A surface whose patches were replaced.
#[derive(Clone, Debug)]
pub(crate) enum Moved {
    Shell(Box<Shell>),
    Sewn(Sewn),
}

impl Source<'_> {
    /// The patches as they are.
    pub(crate) fn nets(self) -> Nets {
        let one = |net| Nets { nets: vec![net], trims: vec![None], turned: vec![false] };
        match self {
            Self::Patch(it) => one(FaceNet::Square(Net::new(it.size, &it.points))),
            Self::Triangular(it) => one(it.net()),
            Self::Nurbs(it) => of_parts(&parts(core::slice::from_ref(it.data())), &[]),
            Self::Sewn(it) => {
                let turned: Vec<bool> = it.shell().faces.iter().map(|face| face.is_turned).collect();
                of_parts(&parts(&it.data().surfaces), &turned)
            }
        }
    }
}

/// The patches of surfaces that have been built before, so that nothing is wrong with them.
fn parts(surfaces: &[super::NurbsData]) -> Vec<Parts> {
    surfaces.iter().filter_map(|data| Parts::new(data).ok()).collect()
}

fn of_parts(parts: &[Parts], turned: &[bool]) -> Nets {
    let mut out = Nets { nets: vec![], trims: vec![], turned: turned.to_vec() };
    for parts in parts {
        for (face, net) in parts.nets.iter().enumerate() {
            out.nets.push(net.clone());
            out.trims.push(parts.trim(face));
        }
    }
    out.turned.resize(out.nets.len(), false);
    out
}

/// What [`shells`] makes; `None` if all points are the same.
type Made = Result<Option<Moved>, SewnError>;

/// The surface with its patches mapped by these steps; `None` if the results are not patches of a
/// supported degree.
pub(crate) fn shells(source: Source<'_>, steps: &[DeformStep]) -> Option<Made> {
    if let Source::Sewn(it) = source {
        let mut parts = parts(&it.data().surfaces);
        for parts in &mut parts {
            parts.nets = moved(&parts.nets, steps)?;
        }
        return Some(Sewn::of_parts(it.data().clone(), &parts).map(|made| Some(Moved::Sewn(made))));
    }
    let given = source.nets();
    let nets = moved(&given.nets, steps)?;
    let shell = Shell::trimmed(&nets, |face| given.trims[face].clone(), 0.0);
    Some(Ok(shell.map(|shell| Moved::Shell(Box::new(shell)))))
}

fn moved(nets: &[FaceNet], steps: &[DeformStep]) -> Option<Vec<FaceNet>> {
    let mut nets = nets.to_vec();
    for step in steps {
        nets = match step {
            DeformStep::Place(map) => nets.iter().map(|net| net.map(|p| placed(p, map))).collect(),
            DeformStep::Warp(Warp::Lattice(lattice)) => {
                nets.iter().map(|net| deformed(net, lattice)).collect::<Option<_>>()?
            }
            DeformStep::Warp(_) => return None,
        };
    }
    let fits = |p: &Homogeneous<Dd>| p.iter().all(|x| x.to_f64().abs() < LARGEST);
    nets.iter().all(|net| net.points().iter().all(fits)).then_some(nets)
}

fn placed(p: &Homogeneous<Dd>, map: &Affine) -> Homogeneous<Dd> {
    let (linear, centre) = (map.linear(), map.centre());
    let mut out = *p;
    for (i, out) in out[..3].iter_mut().enumerate() {
        *out = (0..3).fold(Dd::from(centre[i]) * p[3], |sum, k| sum + Dd::from(linear[i][k]) * p[k]);
    }
    out
}

/// The Bernstein coefficients of one number over a patch.
#[derive(Clone)]
struct Coefficients {
    degree: [usize; 2],
    c: Vec<Dd>,
}

impl Coefficients {
    fn of(net: &Net, f: impl Fn(&Homogeneous<Dd>) -> Dd) -> Self {
        Self { degree: net.size.map(|n| n - 1), c: net.points.iter().map(f).collect() }
    }

    fn constant(x: Dd) -> Self {
        Self { degree: [0; 2], c: vec![x] }
    }

    fn times(&self, other: &Self) -> Self {
        let degree = [0, 1].map(|k: usize| self.degree[k] + other.degree[k]);
        let mut c = vec![Dd::ZERO; (degree[0] + 1) * (degree[1] + 1)];
        let along = |k: usize, i: usize, j: usize| {
            Dd::from(binomial(self.degree[k], i) * binomial(other.degree[k], j))
                / Dd::from(binomial(degree[k], i + j))
        };
        for (n, a) in self.c.iter().enumerate() {
            let (i, j) = (n % (self.degree[0] + 1), n / (self.degree[0] + 1));
            for (m, b) in other.c.iter().enumerate() {
                let (k, l) = (m % (other.degree[0] + 1), m / (other.degree[0] + 1));
                let place = (j + l) * (degree[0] + 1) + i + k;
                c[place] = c[place] + along(0, i, k) * along(1, j, l) * (*a * *b);
            }
        }
        Self { degree, c }
    }

    fn scaled(&self, by: Dd) -> Self {
        Self { degree: self.degree, c: self.c.iter().map(|x| *x * by).collect() }
    }

    /// The sum of two of the same degrees.
    fn plus(&self, other: &Self) -> Self {
        Self { degree: self.degree, c: self.c.iter().zip(&other.c).map(|(a, b)| *a + *b).collect() }
    }

    fn power(&self, n: usize) -> Self {
        (0..n).fold(Self::constant(Dd::ONE), |out, _| out.times(self))
    }
}

/// A patch that a lattice deforms; `None` if it reaches beyond the lattice or its degree is too high.
fn deformed(net: &FaceNet, lattice: &Lattice) -> Option<FaceNet> {
    let FaceNet::Square(net) = net else { return None };
    let degree = lattice.size.map(|n| n - 1);
    let all: usize = degree.iter().sum();
    if net.size.iter().any(|n| all * (n - 1) >= MOST) {
        return None;
    }
    let weight = |p: &Homogeneous<Dd>| p[3].to_f64();
    let heaviest = net.points.iter().map(weight).fold(0.0, f64::max);
    let lightest = net.points.iter().map(weight).fold(f64::INFINITY, f64::min);
    if (0..all).fold(1.0, |spread, _| spread * (heaviest / lightest)) > WEIGHTS {
        return None;
    }
    let w = Coefficients::of(net, |p| p[3]);
    // B_i of each axis, times a power of the weight.
    let mut basis: Vec<Vec<Coefficients>> = Vec::with_capacity(3);
    for axis in 0..3 {
        let (low, high) = (lattice.bounds.min[axis], lattice.bounds.max[axis]);
        let width = Dd::difference(high, low);
        let above = |p: &Homogeneous<Dd>| p[axis] - Dd::from(low) * p[3];
        let below = |p: &Homogeneous<Dd>| Dd::from(high) * p[3] - p[axis];
        // The hull of its control points holds a patch.
        let is_within = |p: &Homogeneous<Dd>| above(p).to_f64() >= 0.0 && below(p).to_f64() >= 0.0;
        if !net.points.iter().all(is_within) {
            return None;
        }
        let (t, rest) =
            (Coefficients::of(net, |p| above(p) / width), Coefficients::of(net, |p| below(p) / width));
        let n = degree[axis];
        let polynomial = |i: usize| t.power(i).times(&rest.power(n - i)).scaled(Dd::from(binomial(n, i)));
        basis.push((0..=n).map(polynomial).collect());
    }
    let others = w.power(all - 1);
    let mut sums = [0, 1, 2].map(|axis| Coefficients::of(net, |p| p[axis]).times(&others));
    for (number, by) in lattice.moves.iter().enumerate() {
        if *by == durer_math::Vec3::ZERO {
            continue;
        }
        let [nx, ny, _] = lattice.size;
        let [i, j, k] = [number % nx, number / nx % ny, number / (nx * ny)];
        let moves = basis[0][i].times(&basis[1][j]).times(&basis[2][k]);
        for (axis, sum) in sums.iter_mut().enumerate() {
            *sum = sum.plus(&moves.scaled(Dd::from(by[axis])));
        }
    }
    let weights = w.times(&others);
    let size = weights.degree.map(|n| n + 1);
    let points = (0..weights.c.len()).map(|n| [sums[0].c[n], sums[1].c[n], sums[2].c[n], weights.c[n]]);
    Some(FaceNet::Square(Net { size, points: points.collect() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::cell::power;
    use durer_math::{Aabb, Point3, Vec3};

    /// The point of a net, by the Bernstein polynomials.
    fn point(net: &Net, uv: [f64; 2]) -> [f64; 3] {
        let b = |n: usize, i: usize, t: f64| binomial(n, i) * power(t, i) * power(1.0 - t, n - i);
        let mut sum = [0.0; 4];
        for (n, p) in net.points.iter().enumerate() {
            let (i, j) = (n % net.size[0], n / net.size[0]);
            let weight = b(net.size[0] - 1, i, uv[0]) * b(net.size[1] - 1, j, uv[1]);
            for (sum, p) in sum.iter_mut().zip(p) {
                *sum += weight * p.to_f64();
            }
        }
        [0, 1, 2].map(|k| sum[k] / sum[3])
    }

    fn lattice() -> Lattice {
        let bounds = Aabb::new(Point3::new(-1.0, -2.0, -1.0), Point3::new(2.0, 2.0, 3.0));
        let mut lattice = Lattice::new(bounds, [3, 2, 2]).unwrap();
        lattice.shift([1, 1, 0], Vec3::new(0.5, -0.25, 1.0)).unwrap();
        lattice.shift([2, 0, 1], Vec3::new(-0.75, 0.5, 0.125)).unwrap();
        lattice
    }

    fn moved_by(lattice: &Lattice, p: [f64; 3]) -> [f64; 3] {
        let b = |n: usize, i: usize, t: f64| binomial(n, i) * power(t, i) * power(1.0 - t, n - i);
        let t = [0, 1, 2].map(|k: usize| (p[k] - lattice.bounds.min[k]) / lattice.bounds.widths()[k]);
        let mut out = p;
        for (number, by) in lattice.moves.iter().enumerate() {
            let [nx, ny, nz] = lattice.size;
            let [i, j, k] = [number % nx, number / nx % ny, number / (nx * ny)];
            let weight = b(nx - 1, i, t[0]) * b(ny - 1, j, t[1]) * b(nz - 1, k, t[2]);
            for (out, by) in out.iter_mut().zip(by.to_array()) {
                *out += weight * by;
            }
        }
        out
    }

    #[test]
    fn the_composed_patch_is_the_deformed_patch() {
        let cubic: Vec<[f64; 4]> = (0..16)
            .map(|n: usize| {
                [(n % 4) as f64 * 0.3, 0.4 * ((n * 7) % 5) as f64 - 0.9, (n / 4) as f64 * 0.5, 1.0]
            })
            .collect();
        let quarter =
            [1.0, 1.5].map(|y| [[1.0, y, 0.0, 1.0], [1.0, y, 1.0, 1.0], [0.0, y, 1.0, 2.0]]).concat();
        for (size, points) in [([4, 4], cubic), ([3, 2], quarter)] {
            let net = Net::new(size, &points);
            if size == [4, 4] {
                assert!(deformed(&FaceNet::Square(net.clone()), &lattice()).is_some());
            }
            let Some(FaceNet::Square(made)) = deformed(&FaceNet::Square(net.clone()), &lattice()) else {
                panic!("the degree allows it")
            };
            for uv in [[0.0, 0.0], [0.3, 0.8], [1.0, 0.5], [0.77, 0.11]] {
                let (got, wanted) = (point(&made, uv), moved_by(&lattice(), point(&net, uv)));
                assert!((0..3).all(|k| (got[k] - wanted[k]).abs() < 1e-13), "{got:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn what_reaches_beyond_the_lattice_or_the_degree_is_not_composed() {
        let corners =
            [[0.0, 0.0, 0.0, 1.0], [9.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0]];
        assert!(deformed(&FaceNet::Square(Net::new([2, 2], &corners)), &lattice()).is_none());
        let flat: Vec<[f64; 4]> =
            (0..36).map(|n| [(n % 6) as f64 * 0.2, 0.0, (n / 6) as f64 * 0.2, 1.0]).collect();
        assert!(deformed(&FaceNet::Square(Net::new([6, 6], &flat)), &lattice()).is_none());
    }
}

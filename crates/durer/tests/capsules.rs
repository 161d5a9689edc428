//! Capsules keep the laws: compared with the union of two balls and a cylinder in exact arithmetic.

use core::cmp::Ordering;
use durer::math::{Point3, Ray, Vec3};
use durer::surfaces::laws::exact::Poly;
use durer::surfaces::laws::{
    Crossing, Exact, ExactBody, ExactForm, ExactLine, Feature, Oracle, TestRng, all_roots, check_many, exact3,
};
use durer::surfaces::{RootKind, SphereSweep};

/// All points within `r` of a line from `a` on, with the direction and length `v`.
struct Capsule {
    a: [Exact; 3],
    v: [Exact; 3],
    /// `v²` and `r²`.
    squares: [Exact; 2],
    bodies: [ExactBody; 3],
    size: f64,
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

fn minus(a: &[Exact; 3], b: &[Exact; 3]) -> [Exact; 3] {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

impl Capsule {
    fn new(a: [f64; 3], b: [f64; 3], r: f64) -> Self {
        let size = (Vec3::from(b) - Vec3::from(a)).length() + r;
        let (a, b) = (exact3(a), exact3(b));
        let v = minus(&b, &a);
        let (vv, rr) = (dot(&v, &v), Exact::from(r).squared());
        let form = |f: &dyn Fn(usize, usize) -> Exact, c: Exact| ExactForm {
            q: core::array::from_fn(|i| core::array::from_fn(|j| f(i, j))),
            b: core::array::from_fn(|_| Exact::zero()),
            c,
        };
        let unit = |i: usize, j: usize| Exact::from(if i == j { 1.0 } else { 0.0 });
        let ball = form(&unit, -rr.clone());
        let wall = form(&|i, j| &(&vv * &unit(i, j)) - &(&v[i] * &v[j]), -(&rr * &vv));
        let ends = [
            ExactForm::half_space(v.clone().map(|x| -x), a.clone()),
            ExactForm::half_space(v.clone(), b.clone()),
        ];
        let [below, above] = ends;
        let bodies = [
            ExactBody::solid(vec![ball.translated(&a)], size, true),
            ExactBody::solid(vec![wall.translated(&a), below, above], size, true),
            ExactBody::solid(vec![ball.translated(&b)], size, true),
        ];
        Self { a, v, squares: [vv, rr], bodies, size }
    }

    /// The point relative to A, and its product with the axis.
    fn local(&self, point: &[Exact; 3]) -> ([Exact; 3], Exact) {
        let y = minus(point, &self.a);
        let h = dot(&y, &self.v);
        (y, h)
    }
}

/// The crossing that comes first by `order`. Those of two bodies are equal if each is a root of a
/// face of the other.
fn first<'a>(of: &[(&'a Crossing, &'a [Poly])], order: Ordering) -> Option<&'a Crossing> {
    let close =
        |x: &Crossing, y: &Crossing| (&x.t.about(300) - &y.t.about(300)).abs().shifted(280).to_f64() < 1.0;
    let is_root = |x: &Crossing, polys: &[Poly]| polys.iter().any(|p| x.t.sign_of(p).is_eq());
    let mut best: Option<(&Crossing, &[Poly])> = None;
    for &(x, polys) in of {
        let wins = best.is_none_or(|(y, others)| {
            x.t.compare(&y.t, close(x, y) && is_root(x, others) && is_root(y, polys)) == order
        });
        if wins {
            best = Some((x, polys));
        }
    }
    best.map(|(x, _)| x)
}

impl Oracle for Capsule {
    /// The solid is convex: from the first beginning to the last end.
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        let polys: Vec<Vec<Poly>> =
            self.bodies.iter().map(|body| body.faces.iter().map(|f| f.along(line)).collect()).collect();
        let found: Vec<Vec<Crossing>> = self.bodies.iter().map(|body| body.crossings(line)).collect();
        let each = |which: fn(&[Crossing]) -> Option<&Crossing>| {
            found.iter().zip(&polys).filter_map(move |(c, p)| Some((which(c)?, &p[..]))).collect::<Vec<_>>()
        };
        let (Some(from), Some(to)) = (
            first(&each(<[Crossing]>::first), Ordering::Less),
            first(&each(<[Crossing]>::last), Ordering::Greater),
        ) else {
            return vec![];
        };
        if found.iter().all(|c| c.len() < 2) {
            return vec![Crossing { t: from.t.clone(), sign: 0, grazing: true }];
        }
        let end = |c: &Crossing, sign: i8| Crossing { t: c.t.clone(), sign, grazing: false };
        vec![end(from, -1), end(to, 1)]
    }

    fn face_side(&self, _face: u32, point: &[Exact; 3]) -> Ordering {
        let ((y, h), [vv, rr]) = (self.local(point), &self.squares);
        if h.sign().is_le() {
            return (&dot(&y, &y) - rr).sign();
        }
        if (&h - vv).sign().is_ge() {
            let y = minus(&y, &self.v);
            return (&dot(&y, &y) - rr).sign();
        }
        (&(&(&dot(&y, &y) - rr) * vv) - &h.squared()).sign()
    }

    fn face_normal(&self, _face: u32, point: &[Exact; 3]) -> Vec3 {
        let ((y, h), [vv, _]) = (self.local(point), &self.squares);
        let n = if h.sign().is_le() {
            y
        } else if (&h - vv).sign().is_ge() {
            minus(&y, &self.v)
        } else {
            [0, 1, 2].map(|i| &(&y[i] * vv) - &(&self.v[i] * &h))
        };
        n.map(|x| x.to_f64()).into()
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        Some(self.face_side(0, point))
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn is_convex(&self) -> bool {
        true
    }
}

/// The frame `(2, 3, 6), (6, 2, -3), (3, -6, 2)`: vectors of length 7, across each other.
const FRAME: [[f64; 3]; 3] = [[2.0, 3.0, 6.0], [6.0, 2.0, -3.0], [3.0, -6.0, 2.0]];

/// A capsule of radius `7 size` along `length` times the first axis, and points with few-bit
/// coordinates on it: on both rims, halfway between them, and at the ends.
fn capsule(size: f64, length: f64, at: [f64; 3]) -> (SphereSweep, Capsule, Vec<Feature>) {
    let [along, across, around] = FRAME.map(|v| Vec3::from(v) * size);
    let a = Vec3::from(at) * size;
    let b = a + along * length;
    let feature = |p: Vec3, way: Vec3| Feature::new(p.to_array(), way.to_array());
    let mut features = vec![];
    for way in [along, across, around, along + across, Vec3::ZERO] {
        for side in [across, -around] {
            features.extend([0.0, 0.5, 1.0].map(|share| feature(a + along * (length * share) + side, way)));
        }
        features.push(feature(a - along, way));
        features.push(feature(b + along, way));
    }
    let made = SphereSweep::capsule(a.to_point(), b.to_point(), 7.0 * size).unwrap();
    (made, Capsule::new(a.to_array(), b.to_array(), 7.0 * size), features)
}

#[test]
fn capsules_obey_the_laws() {
    let (mut roots, mut grazing, mut widths) = (0, 0, vec![]);
    for seed in 0..24 {
        let mut dice = TestRng::new(seed);
        let size = dice.power(-40, 40);
        // Pills, rods, and all but balls.
        let length = [1.0, 8.0, 0.25, 64.0, 1.0 / 1024.0][seed as usize % 5];
        let at = if dice.once_in(2) { [0.0; 3] } else { dice.lattice(8).to_array() };
        let (it, oracle, features) = capsule(size, length, at);
        let mut tally = check_many(&it, &oracle, &features, seed, 60);
        roots += tally.roots;
        grazing += tally.grazing;
        widths.push(tally.median_width());
    }
    assert!(roots > 800, "{roots}");
    assert!(grazing > 40, "{grazing}");
    assert!(widths.iter().all(|w| *w < 48.0), "{widths:?}");
}

#[test]
fn a_ray_along_the_wall_runs_inside_from_rim_to_rim() {
    let (it, oracle, _) = capsule(1.0, 2.0, [0.0; 3]);
    let [along, across, _] = FRAME.map(Vec3::from);
    let ray = Ray::new((across - along * 3.0).to_point(), along);
    let roots = all_roots(&it, &ray);
    let exact = oracle.crossings(&ExactLine::new(&ray));
    assert_eq!(exact.len(), 2);
    let ends: Vec<_> = roots.iter().map(|r| (r.t, r.sign, r.kind)).collect();
    assert_eq!(ends, [(3.0, -1, RootKind::Simple), (5.0, 1, RootKind::Simple)]);
}

#[test]
fn the_ends_may_be_one_point() {
    let it = SphereSweep::capsule(Point3::ORIGIN, Point3::ORIGIN, 1.0).unwrap();
    let ray = Ray::new(Point3::new(0.0, 0.0, -3.0), Vec3::Z);
    let ends: Vec<_> = all_roots(&it, &ray).iter().map(|r| r.t).collect();
    assert_eq!(ends, [2.0, 4.0]);
    assert!(SphereSweep::capsule(Point3::ORIGIN, Point3::new(1.0, 0.0, 0.0), 0.0).is_err());
}

//! The laws, tested against the exact roots of the walls' polynomials.

use super::*;
use crate::laws::{
    self, Crossing, Exact, ExactLine, Feature, LineCache, Oracle, Surd, TestRng, ZeroOracle, aim, all_roots,
    check, exact3, real_roots, roots_are_the_exact_crossings,
};
use crate::{Axis, Sphere, Torus};
use durer_math::Ray;

/// The walls' polynomials in space, expanded from the same numbers, and the polynomial that is
/// negative on the wall's own sheet.
struct ExactTurned {
    heights: Vec<f64>,
    walls: Vec<(ZeroOracle, Option<ZeroOracle>)>,
    size: f64,
    known: LineCache<Option<Vec<Met>>>,
}

/// The precision, in bits, of the parameters of crossings: directions are `2^-330` to `2^330` long.
const BITS: i64 = 700;

/// A crossing, with the number of its height if it is at one.
type Met = (Crossing, Option<usize>);

fn zero_set(terms: Vec<(Exact, [usize; 3])>) -> ZeroOracle {
    ZeroOracle { terms, size: 1.0 }
}

fn expanded(solid: &SurfaceOfRevolution) -> ExactTurned {
    let scale = i64::from(solid.frame.scale);
    let one = || Exact::from(1.0);
    let wall = |wall: &Wall| match wall {
        Wall::Cubic(w) => {
            // x² + z² - Σ a_k (y - c)^k
            let c = -Exact::from(w.stand.at);
            let mut terms = vec![(one(), [2, 0, 0]), (one(), [0, 0, 2])];
            let mut power = vec![one()];
            for k in 0..4 {
                let a = Exact::from(w.a[k]).shifted(scale * (2 - k as i64));
                terms.extend(power.iter().enumerate().map(|(n, p)| (-(&a * p), [0, n, 0])));
                let mut next = vec![Exact::zero(); k + 2];
                for (n, p) in power.iter().enumerate() {
                    next[n] = &next[n] + &(p * &c);
                    next[n + 1] = &next[n + 1] + p;
                }
                power = next;
            }
            (zero_set(terms), None)
        }
        Wall::Spindle(w) => {
            let (big, small) = (
                Exact::from(w.major).squared().shifted(2 * scale),
                Exact::from(w.minor).squared().shifted(2 * scale),
            );
            let c = Exact::from(w.stand.at);
            // Q = x² + (y - c)² + z² + R² - r²
            let constant = &c.squared() + &(&big - &small);
            let q = vec![
                (one(), [2, 0, 0]),
                (one(), [0, 2, 0]),
                (one(), [0, 0, 2]),
                (-c.shifted(1), [0, 1, 0]),
                (constant, [0, 0, 0]),
            ];
            let mut terms = vec![(big.clone().shifted(2), [2, 0, 0]), (big.shifted(2), [0, 0, 2])];
            for (x, [i, j, k]) in &q {
                for (y, [l, m, n]) in &q {
                    terms.push((-(x * y), [i + l, j + m, k + n]));
                }
            }
            (zero_set(terms), Some(zero_set(q)))
        }
    };
    let walls = solid.walls.iter().map(wall).collect();
    let size = solid.bounds.widths().max_abs();
    ExactTurned { heights: solid.heights.clone(), walls, size, known: LineCache::default() }
}

/// `p(n/d + s)`, times a positive number; `d > 0`.
fn moved(p: &[Exact], n: &Exact, d: &Exact) -> Vec<Exact> {
    let mut c: Vec<Exact> = p.to_vec();
    // c_k d^(m-k) in the unknown d s, shifted by n.
    let m = c.len();
    for (k, c) in c.iter_mut().enumerate() {
        for _ in k + 1..m {
            *c = &*c * d;
        }
    }
    for i in 0..m {
        for j in (i..m - 1).rev() {
            c[j] = &c[j] + &(&c[j + 1] * n);
        }
    }
    c
}

/// The sign of a polynomial just after zero, or just before.
fn beside(p: &[Exact], after: bool) -> Ordering {
    let signs = p.iter().enumerate().map(|(k, c)| {
        let sign = c.sign();
        if after || k % 2 == 0 { sign } else { sign.reverse() }
    });
    signs.into_iter().find(|s| s.is_ne()).unwrap_or(Ordering::Equal)
}

impl ExactTurned {
    /// All crossings; `None` if the ray runs along a height.
    fn met(&self, line: &ExactLine) -> Option<Vec<Met>> {
        self.known.get(line, || self.find(line))
    }

    fn find(&self, line: &ExactLine) -> Option<Vec<Met>> {
        let last = self.walls.len();
        let height = |i: usize| [&line.o[1] - &Exact::from(self.heights[i]), line.d[1].clone()];
        let still = line.d[1].sign().is_eq();
        let along: Vec<_> =
            self.walls.iter().map(|(p, q)| (p.along(line), q.as_ref().map(|q| q.along(line)))).collect();
        let mut found = vec![];
        for (i, (p, q)) in along.iter().enumerate() {
            let (low, high) = (height(i), height(i + 1));
            if still && (low[0].sign().is_eq() || high[0].sign().is_eq()) {
                return None;
            }
            for root in real_roots(p) {
                let between = root.sign_of(&low).is_gt() && root.sign_of(&high).is_lt();
                if between && q.as_ref().is_none_or(|q| root.sign_of(q).is_lt()) {
                    let sign = match (root.before, root.after) {
                        (Ordering::Less, Ordering::Greater) => 1,
                        (Ordering::Greater, Ordering::Less) => -1,
                        _ => 0,
                    };
                    found.push((Crossing { t: root.into(), sign, grazing: sign == 0 }, None));
                }
            }
        }
        for i in 0..=last {
            if still {
                break;
            }
            let [h, slope] = height(i);
            let (n, d) = if slope.sign().is_lt() { (h, -slope.clone()) } else { (-h, slope.clone()) };
            let inside = |wall: usize, after: bool| {
                let (p, q) = &along[wall];
                let is = |p: &Vec<Exact>| beside(&moved(p, &n, &d), after).is_lt();
                is(p) && q.as_ref().is_none_or(is)
            };
            let up = slope.sign().is_gt();
            let below = i > 0 && inside(i - 1, !up);
            let above = i < last && inside(i, up);
            if below != above {
                let sign = if above == up { -1 } else { 1 };
                found.push((Crossing { t: Surd::ratio(n, d), sign, grazing: false }, Some(i)));
            }
        }
        found.sort_by(|a, b| a.0.t.compare(&b.0.t, false));
        Some(found)
    }

    /// The wall or the height to which a point on the solid belongs: the nearest; `None` if several
    /// are near.
    fn owner(&self, p: Vec3) -> Option<Result<usize, usize>> {
        let near = 1e-4 * self.size;
        let heights =
            self.heights.iter().enumerate().filter(|(_, h)| (p.y - **h).abs() < near).map(|(i, _)| i);
        let heights: Vec<usize> = heights.collect();
        let within = (0..self.walls.len()).find(|&i| self.heights[i] <= p.y && p.y <= self.heights[i + 1]);
        let value = |i: usize| {
            let at = exact3(p.to_array());
            let (wall, _) = &self.walls[i];
            let g = wall.face_normal(0, &at);
            if g == Vec3::ZERO {
                return (0.0, 0.0);
            }
            // Relative to the slope, roughly a distance.
            let far = (p + g * (near / g.length())).to_array();
            (wall.value(&at).to_f64(), wall.value(&exact3(far)).to_f64())
        };
        match (heights[..].len(), within) {
            (0, Some(i)) => Some(Ok(i)),
            (1, Some(i)) => {
                let (here, far) = value(i);
                // At an end, and not near the rim.
                let h = heights[0];
                let is_end = h == 0 || h == self.walls.len();
                (is_end && here.abs() > 4.0 * (far - here).abs()).then_some(Err(h))
            }
            _ => None,
        }
    }

    fn is_clear(&self, line: &ExactLine) -> bool {
        self.crossings(line).iter().all(|c| {
            let p = Vec3::from(line.at(&c.t.about(BITS)).map(|x| x.to_f64()));
            // Not near the axis, where a sheet may have a tip.
            self.owner(p).is_some() && (p.x.abs() + p.z.abs()) > 1e-4 * self.size
        })
    }
}

impl Oracle for ExactTurned {
    fn crossings(&self, line: &ExactLine) -> Vec<Crossing> {
        self.met(line).unwrap_or_default().into_iter().map(|(c, _)| c).collect()
    }

    fn face_side(&self, face: u32, point: &[Exact; 3]) -> Ordering {
        match face {
            1 => (&Exact::from(self.heights[0]) - &point[1]).sign(),
            2 => (&point[1] - &Exact::from(self.heights[self.walls.len()])).sign(),
            _ => match self.owner(Vec3::from(point.clone().map(|x| x.to_f64()))) {
                Some(Ok(i)) => self.walls[i].0.value(point).sign(),
                _ => Ordering::Equal,
            },
        }
    }

    fn face_normal(&self, face: u32, point: &[Exact; 3]) -> Vec3 {
        match face {
            1 => -Vec3::Y,
            2 => Vec3::Y,
            _ => match self.owner(Vec3::from(point.clone().map(|x| x.to_f64()))) {
                Some(Ok(i)) => self.walls[i].0.face_normal(0, point),
                _ => Vec3::ZERO,
            },
        }
    }

    fn side(&self, point: &[Exact; 3]) -> Option<Ordering> {
        let last = self.walls.len();
        let above = |i: usize| (&point[1] - &Exact::from(self.heights[i])).sign();
        let wall = |i: usize| {
            let (p, q) = &self.walls[i];
            match q.as_ref().map_or(Ordering::Less, |q| q.value(point).sign()) {
                Ordering::Less => p.value(point).sign(),
                _ => Ordering::Greater,
            }
        };
        let at = (0..=last).find(|&i| above(i).is_eq());
        Some(match at {
            Some(i) => {
                let below = if i == 0 { Ordering::Greater } else { wall(i - 1) };
                let over = if i == last { Ordering::Greater } else { wall(i) };
                if below == over { below } else { Ordering::Equal }
            }
            None => {
                (0..last).find(|&i| above(i).is_gt() && above(i + 1).is_lt()).map_or(Ordering::Greater, wall)
            }
        })
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn is_convex(&self) -> bool {
        false
    }
}

fn solids() -> Vec<SurfaceOfRevolution> {
    let vase = [[0.0, -1.0], [1.0, 0.0], [1.5, 1.0], [0.5, 2.0], [0.75, 3.0], [0.0, 4.0], [0.5, 5.0]];
    let column = [[1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [1.0, 4.0], [1.0, 5.0]];
    let thin = [[0.3, -7.0], [0.31, -6.93], [0.47, -6.921], [0.11, -6.9], [0.0, -6.7]];
    let steep = [[0.0, 0.0], [0.125, 0.0], [4.0, 0.0625], [0.25, 0.125], [0.0, 9.0]];
    let scaled = |points: &[[f64; 2]], k: f64, y: f64| {
        points.iter().map(|p| [p[0] * k, p[1] * k + y]).collect::<Vec<_>>()
    };
    let sor = |points: &[[f64; 2]]| SurfaceOfRevolution::sor(points).unwrap();
    vec![
        sor(&vase),
        sor(&scaled(&vase, pow2(-40), 0.0)),
        sor(&scaled(&vase, 1024.0, 65536.0)),
        sor(&column),
        sor(&thin),
        sor(&steep),
        SurfaceOfRevolution::ovus(1.0, 0.5).unwrap(),
        SurfaceOfRevolution::ovus(0.3, 0.45).unwrap(),
        SurfaceOfRevolution::ovus(1.0, 0.03125).unwrap(),
        SurfaceOfRevolution::ovus(1.0, 2.5).unwrap(),
        SurfaceOfRevolution::ovus(1000.0, 999.0).unwrap(),
        SurfaceOfRevolution::lemon(2.0, 0.0, 0.0, 1.5).unwrap(),
        SurfaceOfRevolution::lemon(2.0, 0.5, 0.25, 2.0).unwrap(),
        SurfaceOfRevolution::lemon(1.0, 0.0, 0.75, 12.0).unwrap(),
        SurfaceOfRevolution::lemon(3.0, 1.0, 1.0, 500.0).unwrap(),
    ]
}

fn features(solid: &SurfaceOfRevolution) -> Vec<Feature> {
    let mut out = vec![];
    let last = solid.walls.len();
    let size = solid.bounds.widths().max_abs();
    for i in 0..=last {
        let h = solid.heights[i];
        let beside = if i < last { 0.5 * (h + solid.heights[i + 1]) } else { h - 0.125 * size };
        for y in [h, beside, 0.75 * h + 0.25 * beside] {
            // A point on the wall, found by bisection from the axis outward.
            for d in [Vec3::X, Vec3::new(0.6, 0.0, 0.8)] {
                let (mut a, mut b) = (0.0, solid.bounds.max.x);
                for _ in 0..60 {
                    let m = 0.5 * (a + b);
                    let p = Point3::new(d.x * m, y, d.z * m);
                    if solid.side(&LocalPoint::new(p)) == Side::Out { b = m } else { a = m }
                }
                let point = Point3::new(d.x * a, y, d.z * a);
                for direction in [Vec3::Y, d, Vec3::new(-d.z, 0.0, d.x), Vec3::new(1.0, 2.0, -3.0)] {
                    out.push(Feature { point, direction });
                }
            }
            out.push(Feature { point: Point3::new(0.0, y, 0.0), direction: Vec3::Y });
        }
    }
    out
}

#[test]
fn turned_solids_obey_the_laws() {
    let (mut rays, mut clear, mut at_heights, mut grazing) = (0, 0, 0, 0);
    for (seed, solid) in solids().iter().enumerate() {
        let oracle = expanded(solid);
        let features = features(solid);
        let mut roots = 0;
        for i in laws::drawn(120) {
            let ray = aim(&mut laws::dice(seed as u64, i), &features, oracle.size());
            let line = ExactLine::new(&ray);
            let Some(met) = ray.is_valid().then(|| oracle.met(&line)).flatten() else { continue };
            at_heights += met.iter().filter(|c| c.1.is_some_and(|i| i > 0 && i < solid.walls.len())).count();
            grazing += met.iter().filter(|c| c.0.grazing).count();
            let found = if oracle.is_clear(&line) {
                clear += 1;
                check(solid, &oracle, &ray)
            } else {
                roots_are_the_exact_crossings(solid, &oracle, &ray, None)
            };
            roots += found.unwrap_or_else(|e| panic!("{e}\nsolid {seed} ray {i} {ray:?}\n{solid:?}")).len();
            rays += 1;
        }
        assert!(roots > 40, "{roots} roots on solid {seed}");
    }
    laws::report(rays);
    assert!(
        rays > 1500 && clear > 1000 && at_heights > 10 && grazing > 0,
        "{rays} {clear} {at_heights} {grazing}"
    );
}

#[test]
fn a_line_goes_in_as_often_as_out() {
    let mut through = 0;
    for (seed, solid) in solids().iter().enumerate() {
        let features = features(solid);
        let mut dice = TestRng::new(500 + seed as u64);
        for _ in 0..200 {
            let (a, b) = (dice.pick(&features).point, dice.pick(&features).point);
            let direction = match dice.below(4) {
                0 => Vec3::Y,
                1 => Vec3::X,
                _ => b - a,
            };
            if direction == Vec3::ZERO {
                continue;
            }
            let ray = Ray::new(a - direction * dice.pick(&[0.0, 1.0, 8.0]), direction);
            let ray = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(solid, &ray);
            let mut inside = 0;
            for root in &roots {
                inside -= i32::from(root.sign);
                assert!((0..=1).contains(&inside), "{roots:?} for {ray:?} and {solid:?}");
            }
            assert_eq!(inside, 0, "{roots:?} for {ray:?} and {solid:?}");
            through += usize::from(roots.len() > 1);
        }
    }
    assert!(through > 1000, "{through}");
}

#[test]
fn sides_are_exact() {
    let mut told = [0; 3];
    for (seed, solid) in solids().iter().enumerate() {
        let (oracle, features) = (expanded(solid), features(solid));
        let mut dice = TestRng::new(900 + seed as u64);
        for _ in 0..100 {
            let p = match dice.below(3) {
                0 => dice.pick(&features).point,
                1 => dice.pick(&features).point + dice.vector() * (oracle.size * dice.scale(-52, -1)),
                _ => {
                    let p = dice.pick(&features).point;
                    Point3::new(0.5 * p.x, p.y, 0.5 * p.z)
                }
            };
            let expected = oracle.side(&exact3(p.to_array())).unwrap();
            let found = solid.side(&LocalPoint::new(p));
            assert_eq!(
                found,
                [Side::In, Side::On, Side::Out][(expected as i8 + 1) as usize],
                "{p:?} {solid:?}"
            );
            told[(expected as i8 + 1) as usize] += 1;
        }
    }
    assert!(told.iter().all(|&n| n > 20), "{told:?}");
}

#[test]
fn an_ovus_with_a_large_top_is_a_ball_and_a_lemon_is_a_part_of_a_torus() {
    let mut dice = TestRng::new(3);
    let (ovus, ball) =
        (SurfaceOfRevolution::ovus(1.0, 2.0).unwrap(), Sphere::new(Point3::new(0.0, 1.0, 0.0), 2.0).unwrap());
    let lemon = SurfaceOfRevolution::lemon(2.0, 0.0, 0.0, 1.25).unwrap();
    // r = 5/4, half the height 1: R = 3/4, and the whole inner sheet.
    let torus = Torus::new(Point3::new(0.0, 1.0, 0.0), Axis::Y, 0.75, 1.25).unwrap();
    let mut met = 0;
    for _ in 0..400 {
        let from = (dice.vector() * 5.0).to_point();
        let ray = Ray::new(from, (dice.vector() + Vec3::Y).to_point() - from);
        let (a, b) = (all_roots(&ovus, &ray), all_roots(&ball, &ray));
        assert_eq!(a.len(), b.len());
        assert!(a.iter().zip(&b).all(|(a, b)| a.sign == b.sign && (a.t - b.t).abs() < 1e-12), "{a:?} {b:?}");
        // The ray leaves the torus where it enters the lemon.
        let (a, b) = (all_roots(&lemon, &ray), all_roots(&torus, &ray));
        for root in &a {
            met += 1;
            assert!(b.iter().any(|b| b.sign == -root.sign && (root.t - b.t).abs() < 1e-9), "{root:?} {b:?}");
        }
    }
    assert!(met > 100, "{met}");
}

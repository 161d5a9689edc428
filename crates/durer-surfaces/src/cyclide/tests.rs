use super::*;
use crate::laws::{Exact, Feature, TestRng, ZeroOracle, check_many};
use crate::{All, Axis, Placed, RootKind, Torus};
use durer_math::Ray;

/// `(x² + y² + z² - d² + b²)² - 4 (a x - c d)² - 4 b² y'²`: the other form of the equation, in
/// which the roles of two axes are exchanged; expanded.
fn oracle(it: &Cyclide) -> ZeroOracle {
    let [a, c, d] = [it.a, it.c, it.d].map(Exact::from);
    let b2 = &a.squared() - &c.squared();
    let one = || Exact::from(1.0);
    let mut q: Vec<(Exact, [usize; 3])> = (0..3)
        .map(|axis| {
            let mut n = [0; 3];
            n[axis] = 2;
            (one(), n)
        })
        .collect();
    q.push((&b2 - &d.squared(), [0; 3]));
    let mut terms = vec![];
    for (x, [i, j, k]) in &q {
        for (y, [l, m, n]) in &q {
            terms.push((x * y, [i + l, j + m, k + n]));
        }
    }
    terms.push((-a.squared().shifted(2), [2, 0, 0]));
    terms.push(((&(&a * &c) * &d).shifted(3), [1, 0, 0]));
    terms.push((-(&c * &d).squared().shifted(2), [0, 0, 0]));
    terms.push((-b2.shifted(2), [0, 0, 2]));
    ZeroOracle { terms, size: it.a + it.c + it.d }
}

/// Points with few-bit coordinates, for (a, c, d) = k (10, 6, 7.5), k (65, 25, 15) or k (25, 15,
/// 65), tangents there, and tips.
fn features(it: &Cyclide, k: f64) -> Vec<Feature> {
    let (a, c, d) = (it.a / k, it.c / k, it.d / k);
    let mut out = vec![];
    let mut add = |p: [f64; 3], v: [f64; 3]| {
        out.push(Feature { point: Point3::from(p.map(|x| x * k)), direction: Vec3::from(v) * k });
    };
    let ways = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [3.0, 0.0, 4.0],
        [4.0, 0.0, -3.0],
        [1.0, 2.0, 2.0],
    ];
    for v in ways {
        for (centre, radius) in [(-c, a + d), (c, a - d)] {
            // Circles in the plane y = 0.
            for (s, t) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (0.8, -0.6)] {
                add([centre + radius * s, 0.0, radius * t], v);
            }
        }
        for (centre, radius) in [(a, d - c), (-a, d + c)] {
            // Circles in the plane z = 0: a plane rests on each top.
            for (s, t) in [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0)] {
                add([centre + radius * s, radius * t, 0.0], v);
            }
        }
    }
    if d < c || d > a {
        for v in ways {
            let tip = if d < c { [39.0, 0.0, 48.0] } else { [39.0, 48.0, 0.0] };
            add(tip, v);
            add(tip.map(|x| -x), v);
            add([tip[0], -tip[1], -tip[2]], v);
        }
    }
    out
}

const KINDS: [[f64; 3]; 3] = [[10.0, 6.0, 7.5], [65.0, 25.0, 15.0], [25.0, 15.0, 65.0]];

#[test]
fn cyclides_obey_the_laws() {
    let (mut grazing, mut widths) = (0, vec![]);
    for seed in 0..24 {
        let mut dice = TestRng::new(seed);
        let [a, c, d] = KINDS[seed as usize % 3];
        let k = match seed % 4 {
            0 => 1.0,
            1 => dice.power(-60, 60),
            _ => dice.scale(-10, 10),
        };
        let it = Cyclide::new(a * k, c * k, d * k).unwrap();
        let mut tally = check_many(&it, &oracle(&it), &features(&it, k), seed, 40);
        assert!(tally.roots > 20);
        widths.push(tally.median_width());
        grazing += tally.grazing;
    }
    assert!(grazing > 20, "only {grazing} tangents");
    assert!(widths.iter().all(|w| *w < 48.0), "{widths:?}");
}

fn all<S: Surface>(surface: &S, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

#[test]
fn without_focal_distance_it_is_the_torus() {
    let mut met = 0;
    for seed in 0..4000 {
        let mut dice = TestRng::new(seed);
        let (major, minor) = (dice.scale(-4, 4), dice.scale(-4, 4));
        let map = dice.map();
        let torus = Torus::new(Point3::ORIGIN, Axis::Y, major, minor).unwrap();
        let cyclide = Cyclide::new(major, 0.0, minor).unwrap();
        let size = major + minor;
        let (from, to) = (dice.vector() * (4.0 * size), dice.vector() * (0.5 * size));
        let through = dice.once_in(2);
        let (own, place) = (Ray::new(from.to_point(), to - from), |p: Vec3| map.point(p.to_point()));
        let moved = Ray::new(place(from), place(to) - place(from));
        let (a, b) = if through {
            (all(&torus, &own), all(&cyclide, &own))
        } else {
            (all(&Placed::new(torus, map), &moved), all(&Placed::new(cyclide, map), &moved))
        };
        assert_eq!(a.len(), b.len(), "{a:?}\n{b:?}");
        for (x, y) in a.iter().zip(&b) {
            assert!(x.lo <= y.hi && y.lo <= x.hi && x.sign == y.sign && x.kind == y.kind, "{x:?}\n{y:?}");
        }
        met += a.len();
    }
    assert!(met > 2000, "{met}");
}

#[test]
fn boxes_hold_it_and_touch_it() {
    for (n, [a, c, d]) in KINDS.into_iter().enumerate() {
        let it = Cyclide::new(a, c, d).unwrap();
        let b = ((a - c) * (a + c)).sqrt();
        let mut dice = TestRng::new(n as u64);
        for map in [Affine::IDENTITY, dice.map(), dice.map(), dice.map()] {
            let bounds = it.bounds_through(&map);
            let mut seen = Aabb::EMPTY;
            // Spheres of the sweep: the outermost points of each.
            for i in 0..2000 {
                let t = f64::from(i) * (core::f64::consts::PI / 1000.0);
                let (sin, cos) = (elementary::sin(t), elementary::cos(t));
                let centre = map.point(Point3::new(a * cos, 0.0, b * sin));
                let far = map.linear().map(|row| (d - c * cos).abs() * Vec3::from(row).length());
                seen = seen.union(Aabb::centred(centre, Vec3::from(far)));
            }
            let slack = 1e-12 * (seen.magnitude() + 1.0);
            assert!(bounds.expanded(Vec3::new(slack, slack, slack)).encloses(&seen), "{bounds:?} {seen:?}");
            let room = seen.widths() - bounds.widths();
            assert!(room.max_abs() <= 1e-4 * seen.widths().max_abs(), "{bounds:?} {seen:?}");
        }
    }
}

#[test]
fn charts_follow_the_surface() {
    for (n, [a, c, d]) in KINDS.into_iter().enumerate() {
        let it = Cyclide::new(a, c, d).unwrap();
        let mut dice = TestRng::new(100 + n as u64);
        let mut met = 0;
        for _ in 0..2000 {
            let from = dice.vector() * (3.0 * (a + d));
            let ray = Ray::new(from.to_point(), dice.vector() * (a + d) - from);
            for root in all(&it, &ray).iter().filter(|r| r.kind == RootKind::Simple) {
                let p = it.resolve(&LocalRay::new(&ray), root, Need::ALL);
                assert!(p.uv.iter().all(|x| (0.0..=1.0).contains(x)), "{p:?}");
                // A small step along each coordinate line changes its coordinate by as much, and
                // not the other.
                for (i, way) in [p.dpdu, p.dpdv].into_iter().enumerate() {
                    let h = 1e-5;
                    let aside = p.p + way * h;
                    let down = Ray::new(aside + p.ng.to_vec() * (1e-4 * d), -p.ng.to_vec());
                    let Some(next) = all(&it, &down).first().copied() else { continue };
                    let q = it.resolve(&LocalRay::new(&down), &next, Need::ALL);
                    let steep = p.bend * (way * h).length() > 1e-3 || p.bend * 1e-4 * d > 1e-2;
                    let seam = p.uv.iter().any(|x| !(0.01..0.99).contains(x));
                    if steep || seam || (q.p - p.p).length() > 2.0 * (way * h).length() {
                        continue;
                    }
                    let change = [(q.uv[0] - p.uv[0]) / h, (q.uv[1] - p.uv[1]) / h];
                    let (own, other) = (change[i], change[1 - i]);
                    assert!(
                        (own.abs() - 1.0).abs() < 0.02 && other.abs() < 0.02,
                        "{i}: {change:?} {p:?} {q:?}"
                    );
                    met += 1;
                }
            }
        }
        assert!(met > 500, "{met}");
    }
}

#[test]
fn bad_numbers_are_named() {
    assert_eq!(Cyclide::new(0.0, 0.0, 1.0), Err(CyclideError::SemiAxis(0.0)));
    assert_eq!(Cyclide::new(1.0, 1.0, 1.0), Err(CyclideError::Focal { a: 1.0, c: 1.0 }));
    assert_eq!(Cyclide::new(1.0, -0.5, 1.0), Err(CyclideError::Focal { a: 1.0, c: -0.5 }));
    assert_eq!(Cyclide::new(1.0, 0.5, -1.0), Err(CyclideError::Radius(-1.0)));
    assert!(Cyclide::new(f64::NAN, 0.0, 1.0).is_err() && Cyclide::new(1.0, f64::NAN, 1.0).is_err());
}

//! Polynomials of an author's own keep the laws, also placed and clipped.

use durer::formula::Formula;
use durer::math::{Aabb, Point3, Ray, Ring, Vec3};
use durer::surfaces::laws::{Exact, Feature, TestRng, TestSurface, ZeroOracle, aim, check_alone, check_many};
use durer::surfaces::{
    AlgebraicSurface, All, AxisBox, Clip, Container, Isosurface, LocalRay, Placed, Polynomial, Region, Root,
    Sphere, Surface, ZeroSet, ZeroSetError, algebraic,
};

/// `Σ c x^i y^j z^k`, with the terms' own powers of `w`.
#[derive(Clone, Debug)]
struct Listed<const N: usize> {
    terms: Vec<(f64, [u32; 3])>,
    degree: u32,
    bounds: Aabb,
}

impl<const N: usize> Polynomial<N> for Listed<N> {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn value<T: Ring>(&self, p: [T; 3], w: T) -> T {
        let mut sum = T::exact(0.0);
        for (c, n) in &self.terms {
            let mut term = T::exact(*c);
            for (x, n) in p.iter().zip(n) {
                for _ in 0..*n {
                    term = term * x.clone();
                }
            }
            for _ in n.iter().sum::<u32>()..self.degree {
                term = term * w.clone();
            }
            sum = sum + term;
        }
        sum
    }
}

fn cube(half: f64) -> Aabb {
    Aabb::new(Point3::new(-half, -half, -half), Point3::new(half, half, half))
}

fn oracle<const N: usize>(it: &Listed<N>, size: f64) -> ZeroOracle {
    let terms = it.terms.iter().map(|(c, n)| (Exact::from(*c), n.map(|n| n as usize)));
    ZeroOracle { terms: terms.collect(), size }
}

/// `x⁴ + y⁴ + z⁴ = r⁴`, r a power of two.
fn pillow(r: f64) -> Listed<5> {
    let fourth = r * r * r * r;
    let terms = vec![(1.0, [4, 0, 0]), (1.0, [0, 4, 0]), (1.0, [0, 0, 4]), (-fourth, [0, 0, 0])];
    Listed { terms, degree: 4, bounds: cube(r) }
}

/// `x⁴ + y⁴ + z⁴ - 5 (x² + y² + z²) + 11.8`.
fn tangle() -> Listed<5> {
    let mut terms = vec![(11.8, [0, 0, 0])];
    for k in 0..3 {
        for (c, n) in [(1.0, 4), (-5.0, 2)] {
            let mut powers = [0; 3];
            powers[k] = n;
            terms.push((c, powers));
        }
    }
    Listed { terms, degree: 4, bounds: cube(2.27) }
}

/// The umbrella of H. Whitney, `x² = y² z`.
fn umbrella() -> Listed<4> {
    let terms = vec![(1.0, [2, 0, 0]), (-1.0, [0, 2, 1])];
    Listed { terms, degree: 3, bounds: Aabb::UNBOUNDED }
}

fn features(points: &[[f64; 3]], size: f64) -> Vec<Feature> {
    let ways = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
    let at = |p: &[f64; 3]| p.map(|x| x * size);
    points.iter().flat_map(|p| ways.map(|v| Feature::new(at(p), v.map(|x: f64| x * size)))).collect()
}

#[test]
fn zero_sets_obey_the_laws() {
    let (mut roots, mut grazing, mut widths) = (0, 0, vec![]);
    for seed in 0..12 {
        let size = TestRng::new(seed).power(-60, 60);
        let listed = pillow(size);
        let it = ZeroSet::new(listed.clone()).unwrap();
        let tops = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.5]];
        let mut tally = check_many(&it, &oracle(&listed, size), &features(&tops, size), seed, 40);
        roots += tally.roots;
        grazing += tally.grazing;
        widths.push(tally.median_width());
    }
    for seed in 0..8 {
        let it = ZeroSet::new(tangle()).unwrap();
        let inner = [[1.5, 1.5, 1.5], [1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [1.5, 0.0, 1.5]];
        roots += check_many(&it, &oracle(&tangle(), 2.0), &features(&inner, 1.0), seed, 40).roots;
        let it = ZeroSet::new(umbrella()).unwrap();
        let lines = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0; 3], [1.0, 1.0, 1.0], [2.0, 1.0, 4.0]];
        let tally = check_many(&it, &oracle(&umbrella(), 1.0), &features(&lines, 1.0), seed, 40);
        roots += tally.roots;
        grazing += tally.grazing;
    }
    assert!(roots > 600, "{roots}");
    assert!(grazing > 40, "{grazing}");
    assert!(widths.iter().all(|w| *w < 64.0), "{widths:?}");
}

fn all(surface: &impl Surface, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots(&LocalRay::new(ray), &mut sink);
    sink.roots
}

#[test]
fn it_is_the_algebraic_surface_of_the_same_coefficients_also_placed_and_clipped() {
    let listed = tangle();
    let mut list = vec![0.0; algebraic::coefficient_count(4)];
    for (c, n) in &listed.terms {
        list[algebraic::place_of(4, *n)] = *c;
    }
    let listed = ZeroSet::new(listed).unwrap();
    let known = AlgebraicSurface::new(4, &list).unwrap();
    let mut met = 0;
    for seed in 0..300 {
        let mut dice = TestRng::new(seed);
        let map = dice.map();
        let ball = || vec![Region::solid(Sphere::new(Point3::ORIGIN, 2.0).unwrap())];
        let place = |v: Vec3| map.point(v.to_point());
        let (from, to) = (dice.vector() * 6.0, dice.vector());
        let ray = Ray::new(place(from), place(to) - place(from));
        let one = all(&Placed::new(Clip::new(listed.clone(), ball()), map), &ray);
        let other = all(&Placed::new(Clip::new(known.clone(), ball()), map), &ray);
        assert_eq!(one.len(), other.len(), "{ray:?}");
        for (a, b) in one.iter().zip(&other) {
            assert!(a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign, "{a:?} {b:?}");
        }
        met += one.len();
    }
    assert!(met > 200, "{met}");
}

#[test]
fn what_is_no_polynomial_of_the_degree_is_refused() {
    let made = |terms: Vec<(f64, [u32; 3])>, degree, bounds| {
        ZeroSet::new(Listed::<4> { terms, degree, bounds }).map(|_| ())
    };
    assert_eq!(made(vec![(1.0, [3, 0, 0]), (1.0, [0, 1, 0])], 3, cube(1.0)), Ok(()));
    // Nothing is multiplied by w.
    assert_eq!(made(vec![(1.0, [3, 0, 0]), (1.0, [0, 1, 0])], 0, cube(1.0)), Err(ZeroSetError::Terms));
    assert_eq!(
        made(vec![(1.0, [2, 2, 0])], 4, cube(1.0)),
        Err(ZeroSetError::Degree { greatest: 3, degree: 4 })
    );
    assert_eq!(
        made(vec![(2.0, [0, 0, 0])], 0, cube(1.0)),
        Err(ZeroSetError::Degree { greatest: 3, degree: 0 })
    );
    assert_eq!(made(vec![], 2, cube(1.0)), Err(ZeroSetError::Zero));
    assert_eq!(made(vec![(1.0, [2, 0, 0])], 2, Aabb::EMPTY), Err(ZeroSetError::Bounds));
}

#[test]
fn a_formula_and_a_polynomial_keep_the_laws_that_need_no_oracle() {
    let bump = Formula::of(|x, y, z| z - (-(x.square() + y.square())).exp()).unwrap();
    let space = AxisBox::new(Point3::new(-2.3, -1.9, -1.17), Point3::new(2.2, 1.83, 2.06)).unwrap();
    let bump = Isosurface::new(&bump, 0.0, Container::Box(space)).unwrap();
    let tops = features(&[[0.0, 0.0, 1.0], [1.0, 0.0, 0.25], [1.5, 1.0, 0.0]], 1.0);
    let corners = features(&[[1.5, 1.5, 1.5], [1.0, 1.0, 1.0]], 1.0);
    let tangle = ZeroSet::new(tangle()).unwrap();
    let mut met = 0;
    for seed in 0..300 {
        for (surface, features) in [(&bump as &dyn TestSurface, &tops), (&tangle, &corners)] {
            let ray = aim(&mut TestRng::new(seed), features, 2.0);
            if ray.is_valid() {
                met += check_alone(surface, &ray).unwrap().len();
            }
        }
    }
    assert!(met > 400, "{met}");
}

//! Tests of deformed surfaces: rays are aimed at points that are worked out from the definitions.

use super::*;
use crate::DeformStep;
use crate::{
    Lattice, LocalPoint, Nurbs, NurbsData, Sewn, SewnData, Side, Solidity, Steps, TriangularPatch, Warp,
};
use durer_math::elementary::{cos, sin};

/// A point on a surface.
type Place = [f64; 3];

/// Draws a number in a range.
fn number(rng: &mut TestRng, from: f64, to: f64) -> f64 {
    from + (to - from) * rng.unit()
}

/// A bicubic net over a square of side 3, with heights up to 1.
fn cubic(rng: &mut TestRng) -> Vec<[f64; 4]> {
    (0..16).map(|n| [(n % 4) as f64, (n / 4) as f64, number(rng, -1.0, 1.0), 1.0]).collect()
}

fn bernstein_point(size: [usize; 2], points: &[[f64; 4]], uv: [f64; 2]) -> Place {
    // De Casteljau's algorithm on rows, then on the column.
    let reduce = |mut p: Vec<[f64; 4]>, t: f64| {
        while p.len() > 1 {
            p = p.windows(2).map(|w| [0, 1, 2, 3].map(|k| w[0][k] + t * (w[1][k] - w[0][k]))).collect();
        }
        p[0]
    };
    let times = |p: &[f64; 4]| [p[0] * p[3], p[1] * p[3], p[2] * p[3], p[3]];
    let rows = points.chunks_exact(size[0]).map(|row| reduce(row.iter().map(times).collect(), uv[0]));
    let p = reduce(rows.collect(), uv[1]);
    [p[0] / p[3], p[1] / p[3], p[2] / p[3]]
}

/// The warps, by their definitions, of a point; all about the y axis and towards x.
fn warped(warp: &Warp, p: Place) -> Place {
    let ratio = |from: f64, to: f64| ((p[1] - from) / (to - from)).clamp(0.0, 1.0);
    match *warp {
        Warp::Twist { degrees, from, to, .. } => {
            let a = degrees.to_radians() * ratio(from, to);
            let (s, c) = (sin(a), cos(a));
            // Counter-clockwise as seen from the tip of y: from z to x.
            [p[0] * c + p[2] * s, p[1], p[2] * c - p[0] * s]
        }
        Warp::Taper { factor, from, to, .. } => {
            let k = 1.0 + (factor - 1.0) * ratio(from, to);
            [p[0] * k, p[1], p[2] * k]
        }
        Warp::Bend { degrees, from, to, .. } => {
            let radius = (to - from) / degrees.to_radians();
            let held = p[1].clamp(from, to);
            let (a, beyond, u) = ((held - from) / radius, p[1] - held, radius - p[0]);
            let (s, c) = (sin(a), cos(a));
            [radius - u * c + beyond * s, from + u * s + beyond * c, p[2]]
        }
        Warp::Lattice(ref lattice) => {
            let [nx, ny, nz] = lattice.size;
            let bounds = lattice.bounds;
            let t = [0, 1, 2].map(|k: usize| ((p[k] - bounds.min[k]) / bounds.widths()[k]).clamp(0.0, 1.0));
            let basis = |n: usize, t: f64| {
                let mut b = vec![1.0];
                for _ in 1..n {
                    let next = |i: usize| {
                        let before = if i > 0 { b[i - 1] } else { 0.0 };
                        t * before + (1.0 - t) * b.get(i).copied().unwrap_or(0.0)
                    };
                    b = (0..=b.len()).map(next).collect();
                }
                b
            };
            let (bx, by, bz) = (basis(nx, t[0]), basis(ny, t[1]), basis(nz, t[2]));
            let mut out = p;
            for (number, moves) in lattice.moves.iter().enumerate() {
                let weight = bx[number % nx] * by[number / nx % ny] * bz[number / (nx * ny)];
                for (out, moves) in out.iter_mut().zip(moves.to_array()) {
                    *out += weight * moves;
                }
            }
            out
        }
        Warp::Inverse { .. } => p,
    }
}

fn lattice(rng: &mut TestRng, size: [usize; 3], low: f64) -> Warp {
    let corner = |x: f64, z: f64| Point3::new(x, x, z);
    let mut lattice = Lattice::new(Aabb::new(corner(low, -2.0), corner(3.5, 2.0)), size).unwrap();
    for _ in 0..3 {
        let point = size.map(|n| ((rng.unit() * n as f64) as usize).min(n - 1));
        let by = [0, 1, 2].map(|_| number(rng, -0.5, 0.5));
        lattice.shift(point, Vec3::from(by)).unwrap();
    }
    Warp::Lattice(Arc::new(lattice))
}

fn some_warp(rng: &mut TestRng) -> Warp {
    let axis = Vec3::Y;
    match (rng.unit() * 5.0) as usize {
        0 => Warp::Twist { axis, degrees: number(rng, -200.0, 200.0), from: 0.5, to: 2.5 },
        1 => Warp::Taper { axis, factor: number(rng, 0.3, 2.0), from: 0.25, to: 3.0 },
        2 => Warp::Bend { axis, toward: Vec3::X, degrees: number(rng, 5.0, 30.0), from: 0.5, to: 2.0 },
        3 => lattice(rng, [3, 2, 2], -0.5),
        // Part of the surface is beyond it, or the degree is too high for a net.
        4 => lattice(rng, [3, 3, 2], 1.0),
        _ => lattice(rng, [4, 4, 2], -0.5),
    }
}

/// Rays at known points meet the surface there, within their brackets and bounds of the point.
fn held(made: &DeformedSurface, rng: &mut TestRng, places: &[Place]) {
    for p in places {
        let p = Point3::new(p[0], p[1], p[2]);
        let d = Vec3::new(number(rng, -1.0, 1.0), number(rng, -1.0, 1.0), number(rng, -1.0, 1.0));
        let ray = Ray::new(p - d * 2.0, d).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let local = LocalRay::new(&ray);
        let mut all = All::default();
        made.roots(&local, &mut all);
        // The point is rounded by some units, which moves a crossing the farther the flatter it is.
        let near = all.roots.iter().find(|root| {
            let point = made.resolve(&local, root, Need::ALL);
            let slant = point.ng.to_vec().dot(d).abs() / d.length();
            (root.t - 2.0).abs() < 1e-12 + 1e-12 / slant.max(1e-6) || root.lo <= 2.0 && 2.0 <= root.hi
        });
        assert!(near.is_some(), "{p:?} along {d:?}: {:?}", all.roots);
    }
}

#[test]
fn rays_meet_deformed_patches_where_the_definitions_say() {
    let mut composed = 0;
    for seed in 0..16 {
        let mut rng = TestRng::new(seed);
        let points = cubic(&mut rng);
        let warps: Vec<Warp> = (0..1 + seed % 2).map(|_| some_warp(&mut rng)).collect();
        let source = DeformSource::Patch(BezierPatch::rational([4, 4], &points).unwrap());
        let steps = warps.iter().cloned().map(DeformStep::Warp).collect();
        let made = DeformedSurface::new(source, steps).unwrap().unwrap();
        composed += usize::from(made.is_composed());
        let ends = [0.0, 1.0, 0.5, 0.25];
        let mut places = vec![];
        for n in 0..60 {
            let free = [rng.unit(), rng.unit()];
            let uv = match n % 3 {
                0 => [ends[n / 3 % 4], ends[n / 12 % 4]],
                1 => [ends[n / 3 % 2], free[1]],
                _ => free,
            };
            let p = bernstein_point([4, 4], &points, uv);
            places.push(warps.iter().fold(p, |p, warp| warped(warp, p)));
        }
        held(&made, &mut rng, &places);
    }
    assert!(composed > 0, "some lattices are composed");
}

#[test]
fn a_composed_patch_and_formulas_have_the_same_crossings() {
    for seed in 0..6 {
        let mut rng = TestRng::new(seed);
        let points = cubic(&mut rng);
        let warp = lattice(&mut rng, [3, 2, 2], -0.5);
        let source = DeformSource::Patch(BezierPatch::rational([4, 4], &points).unwrap());
        let composed = DeformedSurface::new(source.clone(), vec![DeformStep::Warp(warp.clone())]);
        let composed = composed.unwrap().unwrap();
        // A bend by nothing is no lattice.
        let still = Warp::Bend { axis: Vec3::Y, toward: Vec3::X, degrees: 0.0, from: 0.0, to: 1.0 };
        let steps = vec![DeformStep::Warp(warp), DeformStep::Warp(still)];
        let formulas = DeformedSurface::new(source, steps).unwrap().unwrap();
        assert!(composed.is_composed() && !formulas.is_composed());
        let mut met = 0;
        for _ in 0..400 {
            let o = Point3::new(number(&mut rng, -1.0, 4.0), number(&mut rng, -1.0, 4.0), 5.0);
            let d = Vec3::new(number(&mut rng, -0.5, 0.5), number(&mut rng, -0.5, 0.5), -1.0);
            let ray = Ray::new(o, d);
            let (a, b) = (all_roots(&composed, &ray), all_roots(&formulas, &ray));
            met += a.len();
            assert_eq!(a.len(), b.len(), "{ray:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!(a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign, "{a:?} {b:?}");
            }
        }
        assert!(met > 50, "{met}");
    }
}

/// A cube of six faces with bulging sides.
fn bulging_cube() -> SewnData {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let mut surfaces = vec![];
    for axis in 0..3 {
        for end in 0..2_usize {
            let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            let base = end << axis;
            let at = |k: usize| {
                let p = corner(base | k);
                [p[0], p[1] + 1.0, p[2], 1.0]
            };
            let middle = |p: [f64; 4], q: [f64; 4]| [0, 1, 2, 3].map(|k| 0.5 * (p[k] + q[k]));
            let [p, q, r, s] = [at(0), at(a), at(b), at(a | b)];
            let mut bulge = middle(middle(p, q), middle(r, s));
            bulge[axis] += if end == 1 { 0.5 } else { -0.5 };
            let points = vec![p, middle(p, q), q, middle(p, r), bulge, middle(q, s), r, middle(r, s), s];
            surfaces.push(NurbsData { degree: [2, 2], size: [3, 3], points, ..NurbsData::default() });
        }
    }
    SewnData { surfaces, seal: 0.0, closed: true }
}

#[test]
fn no_ray_leaves_a_deformed_closed_solid() {
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 70.0, from: 0.0, to: 2.0 };
    let mut rng = TestRng::new(7);
    let size = Vec3::new(2.0, 3.0, 2.0);
    let bounds = Aabb::new(Point3::ORIGIN - size, Point3::ORIGIN + size);
    let mut soft = Lattice::new(bounds, [3, 2, 2]).unwrap();
    soft.shift([1, 1, 1], Vec3::new(0.4, 0.3, 0.2)).unwrap();
    for (warp, is_composed) in [(twist, false), (Warp::Lattice(Arc::new(soft)), true)] {
        let data = bulging_cube();
        let source = DeformSource::Sewn(Sewn::new(data.clone()).unwrap());
        let made = DeformedSurface::new(source, vec![DeformStep::Warp(warp.clone())]).unwrap().unwrap();
        assert_eq!((made.is_composed(), made.solidity()), (is_composed, Solidity::Solid));
        let inside = warped(&warp, [0.0, 1.0, 0.0]);
        let o = Point3::new(inside[0], inside[1], inside[2]);
        for n in 0..2000 {
            let surface = &data.surfaces[n % 6];
            let ends = [0.0, 1.0];
            let uv = match n / 6 % 4 {
                0 => [ends[n / 24 % 2], ends[n / 48 % 2]],
                1 => [ends[n / 24 % 2], rng.unit()],
                2 => [rng.unit(), ends[n / 24 % 2]],
                _ => [rng.unit(), rng.unit()],
            };
            let p = warped(&warp, bernstein_point([3, 3], &surface.points, uv));
            let d = Point3::new(p[0], p[1], p[2]) - o;
            let line = Ray::new(o, d).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(&made, &line);
            let signs: i32 = roots.iter().filter(|r| r.t > 0.0).map(|r| i32::from(r.sign)).sum();
            assert_eq!(signs, 1, "{n}: a ray at {p:?} comes out once more than it goes in: {roots:?}");
            let local = Ray::new(o + d * 0.9, d);
            assert_eq!(side_of(&made, local.origin), Side::In);
            assert_eq!(side_of(&made, o + d * 1.1), Side::Out);
        }
    }
}

fn side_of(made: &DeformedSurface, p: Point3) -> Side {
    made.side(&LocalPoint::new(p))
}

#[test]
fn triangles_nurbs_and_formulas_are_deformed_too() {
    let mut rng = TestRng::new(3);
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 120.0, from: 0.0, to: 2.0 };
    let steps = || vec![DeformStep::Warp(twist.clone())];
    // A triangle of degree 1: S = u A + v B.
    let corners = [Point3::ORIGIN, Point3::new(1.5, 0.5, 0.0), Point3::new(0.0, 2.0, 1.0)];
    let triangle = DeformSource::Triangular(TriangularPatch::new(2, &corners).unwrap());
    let triangle = DeformedSurface::new(triangle, steps()).unwrap().unwrap();
    // A quarter of a cylinder about y.
    let rows = [0.0, 2.0].map(|y| [[1.0, y, 0.0, 1.0], [1.0, y, 1.0, 1.0], [0.0, y, 1.0, 2.0]]).concat();
    let data = NurbsData { degree: [2, 1], size: [3, 2], points: rows.clone(), ..NurbsData::default() };
    let quarter = DeformSource::Nurbs(Nurbs::new(data).unwrap());
    let quarter = DeformedSurface::new(quarter, steps()).unwrap().unwrap();
    // The plane strip x = u, y = v, z = u v.
    let (mut pen, u, v) = Pen::new();
    let z = pen.times(u, v);
    let saddle = pen.made([u, v, z], [[0.0, 1.0], [0.0, 2.0]], None).unwrap();
    let saddle = DeformedSurface::new(DeformSource::Parametric(saddle), steps()).unwrap().unwrap();
    for _ in 0..100 {
        let [u, v] = [rng.unit(), rng.unit()];
        let flat = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let p = (corners[1].to_vec() * flat[0] + corners[2].to_vec() * flat[1]).to_array();
        held(&triangle, &mut rng, &[warped(&twist, p)]);
        held(&quarter, &mut rng, &[warped(&twist, bernstein_point([3, 2], &rows, [u, v]))]);
        held(&saddle, &mut rng, &[warped(&twist, [u, 2.0 * v, 2.0 * u * v])]);
    }
}

#[test]
fn a_container_that_cuts_and_a_sealed_solid_are_refused() {
    let (pen, u, v) = Pen::new();
    let half = AxisBox::new(Point3::ORIGIN, Point3::new(0.5, 1.0, 1.0)).unwrap();
    let cut = pen.made([u, v, u], [[0.0, 1.0]; 2], Some(Container::Box(half))).unwrap();
    let twist = || vec![DeformStep::Warp(Warp::Twist { axis: Vec3::Y, degrees: 9.0, from: 0.0, to: 1.0 })];
    let wrong = DeformedSurface::new(DeformSource::Parametric(cut), twist());
    assert_eq!(wrong.unwrap_err(), crate::DeformError::Cut);
    let data = SewnData { seal: 0.125, ..bulging_cube() };
    let sealed = DeformedSurface::new(DeformSource::Sewn(Sewn::new(data).unwrap()), twist());
    assert_eq!(sealed.unwrap_err(), crate::DeformError::Sealed);
}

#[test]
fn steps_of_rays_are_counted() {
    let mut rng = TestRng::new(5);
    let patch = BezierPatch::rational([4, 4], &cubic(&mut rng)).unwrap();
    Steps::take();
    let down = |x: f64, y: f64| Ray::new(Point3::new(x, y, 4.0), Vec3::new(0.0, 0.0, -1.0));
    let roots = all_roots(&patch, &down(1.5, 1.25));
    let steps = Steps::take();
    // Two cells may both prove a crossing on their common border.
    assert_eq!((steps.rays, steps.unproven), (1, 0));
    assert!(steps.proven >= roots.len() as u64);
    assert!(steps.evaluations >= 2 && steps.most == steps.total(), "{steps:?}");
}

/// The bound that docs/numerics.md states.
const MOST: u64 = 20_000;

#[test]
fn steps_have_a_bound() {
    let (mut all, mut rays) = (Steps::default(), 0);
    for case in drawn(40) {
        let mut rng = dice(31, case);
        let mut points = cubic(&mut rng);
        if rng.once_in(3) {
            // An edge that is one point.
            let first = points[0];
            points[..4].fill(first);
        }
        let patch = BezierPatch::rational([4, 4], &points).unwrap();
        let ball = sphere();
        for _ in 0..50 {
            let ends = [0.0, 1.0];
            let uv = [0, 1].map(|_| if rng.once_in(3) { rng.pick(&ends) } else { rng.unit() });
            let p = Vec3::from(bernstein_point([4, 4], &points, uv));
            // Along a slope: a tangent.
            let beside = [uv[0], uv[1] + 1e-6].map(|t| t.min(1.0));
            let slope = Vec3::from(bernstein_point([4, 4], &points, beside)) - p;
            let d = if rng.once_in(2) && slope != Vec3::ZERO { slope * 1e6 } else { rng.vector() };
            if d == Vec3::ZERO {
                continue;
            }
            for ray in [Ray::new((p - d).to_point(), d), Ray::new(Point3::new(1.0, 0.0, -3.0), Vec3::Z)] {
                let surface: &dyn TestSurface = if ray.direction == Vec3::Z { &ball } else { &patch };
                Steps::take();
                all_roots(surface, &ray);
                let steps = Steps::take();
                assert!(steps.most <= MOST, "{steps:?}: {points:?}, {ray:?}");
                all += steps;
                rays += 1;
            }
        }
    }
    println!("{rays} rays: {all:?}");
    report(rays);
}

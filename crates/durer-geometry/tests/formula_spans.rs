//! Spans of solids that are formulas, along rays that are hard for them: the laws of spans, and the
//! same solids as polynomials.
//!
//! All points named here have integer coordinates and lie on their surfaces, so that rays begin
//! exactly on them, touch them exactly, or run within them.

mod common;

use durer_formula::{Builder, Formula, NodeId, Op};
use durer_geometry::Geometry;
use durer_math::{Aabb, Affine, Point3, Ray, Vec3};
use durer_surfaces::implicit::level_set::primitives;
use durer_surfaces::{
    Accelerate, Algebraic, Axis, AxisBox, Blob, BlobComponent, BlobShape, CappedCylinder, Container,
    DynSurface, Isosurface, Julia, JuliaAlgebra, JuliaPower, JuliaSet, LevelSet, Placed, RootKind, Side,
    Sphere, Torus, Warp, superellipsoid,
};
use durer_testkit::TestRng;

/// The radius of balls; `BALL` has points with integer coordinates on them.
const R: f64 = 9.0;
const BALL: [[f64; 3]; 5] =
    [[9.0, 0.0, 0.0], [1.0, 4.0, 8.0], [4.0, 4.0, 7.0], [-6.0, 3.0, 6.0], [0.0, -9.0, 0.0]];

/// For the cylinder about y and the torus about y: a circle of radius 5 across, from -6 to 6; and a
/// tube of radius 5 around a circle of radius 10.
const TUBE: f64 = 5.0;
const WALL: [[f64; 3]; 4] = [[5.0, 1.0, 0.0], [3.0, -2.0, 4.0], [-4.0, 0.0, 3.0], [0.0, 5.0, -5.0]];
const RING: [[f64; 3]; 7] = [
    [15.0, 0.0, 0.0],
    [5.0, 4.0, 12.0],
    [9.0, 0.0, -12.0],
    [6.0, 5.0, 8.0],
    [0.0, -5.0, 10.0],
    [5.0, 0.0, 0.0],
    [-3.0, 0.0, 4.0],
];

/// A step of a formula.
fn op(b: &mut Builder, op: Op) -> NodeId {
    b.push(op).unwrap()
}

/// A formula of `x`, `y` and `z`.
fn formula(write: impl FnOnce(&mut Builder, [NodeId; 3]) -> NodeId) -> Formula {
    let mut b = Builder::new();
    let inputs = [0, 1, 2].map(|i| b.input(i).unwrap());
    let root = write(&mut b, inputs);
    b.finish(root, 3)
}

/// `Σ x² - r²`.
fn squares(b: &mut Builder, of: &[NodeId], r: f64) -> NodeId {
    let mut sum = b.constant(-r * r).unwrap();
    for &x in of {
        let square = op(b, Op::Sqr(x));
        sum = op(b, Op::Add(sum, square));
    }
    sum
}

/// The distance from a point or an axis, less `r`.
fn distance(b: &mut Builder, of: &[NodeId], r: f64) -> NodeId {
    let square = squares(b, of, 0.0);
    let root = op(b, Op::Sqrt(square));
    let r = b.constant(r).unwrap();
    op(b, Op::Sub(root, r))
}

fn cuboid(x: f64, y: f64, z: f64) -> Container {
    Container::Box(AxisBox::new(Point3::new(-x, -y, -z), Point3::new(x, y, z)).unwrap())
}

fn around(f: &Formula, container: Container) -> Isosurface {
    Isosurface::new(f, 0.0, container).unwrap()
}

fn as_torus(b: &mut Builder, [x, y, z]: [NodeId; 3]) -> NodeId {
    let off = distance(b, &[x, z], 10.0);
    squares(b, &[off, y], TUBE)
}

fn as_quartic(b: &mut Builder, [x, y, z]: [NodeId; 3]) -> NodeId {
    let sum = squares(b, &[x, y, z], 0.0);
    let k = b.constant(100.0 - TUBE * TUBE).unwrap();
    let left = op(b, Op::Add(sum, k));
    let left = op(b, Op::Sqr(left));
    let rho = squares(b, &[x, z], 0.0);
    let factor = b.constant(400.0).unwrap();
    let right = op(b, Op::Mul(factor, rho));
    op(b, Op::Sub(left, right))
}

fn enlarged(surface: impl Algebraic + 'static, by: f64) -> DynSurface {
    DynSurface::new(Placed::new(surface, Affine::scaling(by, by, by).unwrap()))
}

fn component(centre: Point3, radius: f64, strength: f64) -> BlobComponent {
    BlobComponent { shape: BlobShape::Ball(centre), radius, strength, place: Affine::IDENTITY }
}

fn julia(iterations: u32, algebra: JuliaAlgebra, power: JuliaPower) -> JuliaSet {
    let (c, normal) = ([0.0; 4], [0.0, 0.0, 0.0, 1.0]);
    JuliaSet::new(&Julia { c, algebra, power, iterations, radius: 1.0, normal, distance: 0.0 }).unwrap()
}

fn deformed(solid: LevelSet, warp: &Warp) -> Isosurface {
    solid.deformed(warp).unwrap().surface().unwrap().unwrap()
}

/// A formula's solid and the same solid in exact numbers.
struct Pair {
    name: &'static str,
    formula: Geometry,
    exact: Geometry,
    on: &'static [[f64; 3]],
    /// The greatest number of points in which a line touches it.
    touches: usize,
}

fn world<S: Accelerate + 'static>(surface: S) -> Geometry {
    let mut builder = Geometry::builder();
    builder.add(surface);
    builder.build().unwrap()
}

fn pairs() -> Vec<Pair> {
    let mut all = vec![];
    let mut pair = |name, formula: DynSurface, exact: DynSurface, on, touches| {
        all.push(Pair { name, formula: world(formula), exact: world(exact), on, touches });
    };
    let ball = || DynSurface::new(Sphere::new(Point3::ORIGIN, R).unwrap());
    let plain = formula(|b, p| squares(b, &p, R));
    let far = formula(|b, p| distance(b, &p, R));
    pair("ball in its own box", DynSurface::new(around(&plain, cuboid(R, R, R))), ball(), &BALL, 1);
    pair("ball in a larger box", DynSurface::new(around(&plain, cuboid(10.0, 11.0, 12.0))), ball(), &BALL, 1);
    let held = Container::Ball(Sphere::new(Point3::ORIGIN, R).unwrap());
    pair("ball in itself", DynSurface::new(around(&plain, held)), ball(), &BALL, 1);
    pair("ball by distance", DynSurface::new(around(&far, cuboid(10.0, 11.0, 12.0))), ball(), &BALL, 1);
    pair("superellipsoid 1 1", enlarged(superellipsoid(1.0, 1.0).unwrap(), R), ball(), &BALL, 1);
    let field = Blob::new(9.0, &[component(Point3::ORIGIN, 2.0 * R, 16.0)]).unwrap();
    pair("blob", DynSurface::new(field), ball(), &BALL, 1);
    let three = [3.0, 4.0, 9.0].map(|strength| component(Point3::ORIGIN, 2.0 * R, strength));
    pair("blob of three", DynSurface::new(Blob::new(9.0, &three).unwrap()), ball(), &BALL, 1);
    let set = julia(3, JuliaAlgebra::Quaternion, JuliaPower::Square);
    pair("julia", enlarged(set, R), ball(), &BALL, 1);
    let set = julia(2, JuliaAlgebra::Quaternion, JuliaPower::Cube);
    pair("julia of cubes", enlarged(set, R), ball(), &BALL, 1);
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 90.0, from: -4.0, to: 4.0 };
    let level = || {
        let bounds = Aabb::centred(Point3::ORIGIN, Vec3::new(R, R, R));
        LevelSet::new(primitives::ball(Point3::ORIGIN, R).unwrap(), bounds)
    };
    pair("twisted ball", DynSurface::new(deformed(level(), &twist)), ball(), &BALL, 1);
    let halves = [-1.0, 1.0].map(|side| {
        let bounds = Aabb::centred(Point3::ORIGIN, Vec3::new(R, R, R));
        let half =
            LevelSet::new(primitives::half_space(Vec3::X * side, 0.5 * side).unwrap(), Aabb::UNBOUNDED);
        let half = LevelSet::intersection(&[level(), half]).unwrap();
        assert!(half.bounds().is_bounded() && bounds.is_bounded());
        half
    });
    let both = LevelSet::union(&halves).unwrap().surface().unwrap().unwrap();
    pair("ball of two halves", DynSurface::new(both), ball(), &BALL, 1);

    let cylinder = || {
        let (base, cap) = (Point3::new(0.0, -6.0, 0.0), Point3::new(0.0, 6.0, 0.0));
        DynSurface::new(CappedCylinder::new(base, cap, TUBE).unwrap())
    };
    let wall = formula(|b, [x, _, z]| squares(b, &[x, z], TUBE));
    pair("cylinder", DynSurface::new(around(&wall, cuboid(7.0, 6.0, 8.0))), cylinder(), &WALL, 1);
    pair(
        "cylinder in its own box",
        DynSurface::new(around(&wall, cuboid(5.0, 6.0, 5.0))),
        cylinder(),
        &WALL,
        1,
    );
    let far = formula(|b, [x, _, z]| distance(b, &[x, z], TUBE));
    pair("cylinder by distance", DynSurface::new(around(&far, cuboid(7.0, 6.0, 8.0))), cylinder(), &WALL, 1);

    let torus = || DynSurface::new(Torus::new(Point3::ORIGIN, Axis::Y, 10.0, TUBE).unwrap());
    let ring = formula(as_torus);
    pair("torus", DynSurface::new(around(&ring, cuboid(16.0, 6.0, 17.0))), torus(), &RING, 3);
    pair("torus in its own box", DynSurface::new(around(&ring, cuboid(15.0, 5.0, 15.0))), torus(), &RING, 3);
    let ring = formula(as_quartic);
    pair("torus as a quartic", DynSurface::new(around(&ring, cuboid(16.0, 6.0, 17.0))), torus(), &RING, 3);
    all
}

/// Changed by an integer, by a few ulp, or by something between.
fn nudged(dice: &mut TestRng, v: Vec3) -> Vec3 {
    let mut moved = v;
    let axis = dice.below(3) as usize;
    let by = [0.0, 1.0, -1.0, 3.0, -16.0, 1e4, -1e8][dice.below(7) as usize];
    moved[axis] += by * f64::EPSILON * moved.max_abs();
    moved
}

/// A ray that begins on the surface, or passes it there: it touches it, runs in it, or leaves it.
fn ray(dice: &mut TestRng, pair: &Pair) -> Ray {
    let p = Vec3::from(pair.on[dice.below(pair.on.len() as u64) as usize]);
    let normal = match pair.on.len() {
        5 => p,
        4 => Vec3::new(p.x, 0.0, p.z),
        // Along the tube's radius, ten ρ long: ρ is 15, 13, 10 or 5.
        _ => {
            let rho = (p.x * p.x + p.z * p.z).sqrt();
            Vec3::new(p.x * (rho - 10.0), p.y * rho, p.z * (rho - 10.0))
        }
    };
    let n = normal * (1.0 / 4.0);
    let along = match dice.below(8) {
        // In the tangent plane, with integer coordinates or nearly: for a cylinder often along its
        // generator, for a torus often in the plane of its top circle.
        0 if pair.on.len() == 4 => Vec3::Y,
        0 | 1 => n.cross(Vec3::Y),
        2 => n.cross(Vec3::X),
        3 => n.cross(Vec3::Z),
        4 => {
            let tangent = n.cross(dice.vector());
            tangent - n * (tangent.dot(n) / n.dot(n))
        }
        5 => normal,
        6 => -normal,
        _ => dice.vector(),
    };
    let along = if along.max_abs() > 0.0 { along } else { Vec3::new(0.0, 1.0, 0.0) };
    let along = if dice.below(2) == 0 { nudged(dice, along) } else { along };
    let back = [0.0, 0.0, 1.0, 4.0, -2.0, 1024.0][dice.below(6) as usize];
    let origin = p - along * back;
    let origin = if dice.below(2) == 0 { nudged(dice, origin) } else { origin };
    let ray = Ray::new(origin.to_point(), along);
    match dice.below(5) {
        0 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
        1 => ray.with_range(f64::NEG_INFINITY, back),
        2 => ray.with_range(back, f64::INFINITY),
        3 => ray.with_range(back, back + 1.0),
        _ => ray,
    }
}

/// The midpoint of an interval of the ray, if the interval is so long that it cannot hide a
/// tangent.
fn middle(ray: &Ray, a: f64, b: f64) -> Option<Point3> {
    let reach = 64.0 / ray.direction.length();
    let at = -ray.origin.to_vec().dot(ray.direction) / ray.direction.dot(ray.direction);
    let (a, b) = (a.max(at - reach), b.min(at + reach));
    ((b - a) * ray.direction.length() > 1e-2).then(|| ray.at(0.5 * (a + b)))
}

fn check(pair: &Pair, ray: &Ray) -> Result<(usize, usize), String> {
    let spans = pair.formula.spans(ray);
    let mut at = ray.t_min;
    // Deep inside or outside: where the exact solid has one side all around.
    let side = |p: Point3| {
        let n = Vec3::new(1e-4, 1e-4, 1e-4);
        let sides = [1.0, -1.0].map(|s| pair.exact.side(p + n * s));
        let axes =
            [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|v| pair.exact.side(p + v * 1e-4));
        (sides.iter().chain(&axes).all(|&s| s == sides[0])).then_some(sides[0])
    };
    for span in &spans {
        let ordered = at <= span.t_in && span.t_in <= span.t_out && span.t_out <= ray.t_max;
        if !(ordered && span.t_in.is_finite() && span.t_out.is_finite()) {
            return Err("out of order or endless".into());
        }
        if let Some(p) = middle(ray, at, span.t_in)
            && side(p) == Some(Side::In)
        {
            return Err(format!("a gap before {span:?} is inside"));
        }
        if let Some(p) = middle(ray, span.t_in, span.t_out)
            && side(p) == Some(Side::Out)
        {
            return Err(format!("{span:?} is outside"));
        }
        at = span.t_out;
    }
    if let Some(p) = middle(ray, at, ray.t_max)
        && side(p) == Some(Side::In)
    {
        return Err(format!("behind {at} it is inside"));
    }
    let hits = pair.formula.all(ray);
    let clusters = hits.iter().filter(|h| h.kind == RootKind::Cluster).count();
    // Where the line certainly crosses, an end of a very short chord may be a crossing, too.
    let whole = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
    let crossings = pair.exact.all(&whole).iter().filter(|h| h.kind == RootKind::Simple).count();
    if clusters > pair.touches.max(crossings) {
        return Err(format!("{clusters} clusters"));
    }
    let apart = hits.windows(2).all(|w| w[0].t <= w[1].t && w[0].t_lo <= w[1].t_hi);
    if !apart {
        return Err("crossings are out of order".into());
    }
    Ok((spans.len(), clusters))
}

#[test]
fn spans_of_formulas_are_bounded_and_clusters_are_no_more_than_tangents() {
    let count: u64 = std::env::var("DURER_LAWS").ok().and_then(|x| x.parse().ok()).unwrap_or(1) * 1200;
    let mut faults = vec![];
    for pair in pairs() {
        let (mut spans, mut clusters, mut wrong) = (0, 0, 0);
        for seed in 0..count {
            let ray = ray(&mut TestRng::new(seed), &pair);
            match check(&pair, &ray) {
                Ok((s, c)) => (spans, clusters) = (spans + s, clusters + c),
                Err(fault) => {
                    wrong += 1;
                    if wrong <= 4 {
                        let hits = pair.formula.all(&ray);
                        let hits: Vec<_> =
                            hits.iter().map(|h| (h.t, h.t_lo, h.t_hi, h.kind)).take(6).collect();
                        faults.push(format!(
                            "{} {seed}: {fault}: {ray:?}\n   {:?}\n   exact {:?}\n   {hits:?}",
                            pair.name,
                            pair.formula.spans(&ray),
                            pair.exact.spans(&ray)
                        ));
                    }
                }
            }
        }
        println!("{}: {spans} spans, {clusters} clusters, {wrong} wrong", pair.name);
        assert!(spans > 100, "{}: {spans} spans", pair.name);
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

/// A range that ends just before a crossing or just behind it, also with an origin so far away that
/// one ulp of `t` is a large part of the set.
#[test]
fn ranges_that_end_beside_a_crossing_are_told_by_narrow_brackets() {
    let julia = Julia {
        c: [-1.0, 0.25, 0.0, 0.0],
        algebra: JuliaAlgebra::Quaternion,
        power: JuliaPower::Cube,
        iterations: 3,
        radius: 2.5,
        normal: [0.0, 0.0, 0.0, 1.0],
        distance: -0.25,
    };
    let rows = [[8.0, 0.0, 0.0], [0.0, 64.0, 0.0], [0.0, 0.0, 1.0 / 512.0]];
    let place = Affine::new(rows, Point3::new(1.0, 0.0, 125.0)).unwrap();
    let parts =
        [(-0.3, 1.0), (0.4, 0.7)].map(|(x, strength)| component(Point3::new(x, 0.0, 0.0), 1.0, strength));
    let worlds = [
        Geometry::builder().with(Placed::new(JuliaSet::new(&julia).unwrap(), place)).build().unwrap(),
        Geometry::builder().with(Placed::new(Blob::new(0.3, &parts).unwrap(), place)).build().unwrap(),
    ];
    let mut beside = 0;
    for world in &worlds {
        for i in 0..400 {
            let far = [1e3, 1e6, 805_306_367.0][i % 3];
            let offset = |i: usize, n: usize| (i % n) as f64 / n as f64 - 0.5;
            let origin = Point3::new(-far, 40.0 * offset(i, 29), 125.0 + offset(i, 31) / 512.0);
            let mut ray = Ray::new(origin, Vec3::new(0.5, 0.0, 0.0));
            for hit in world.all(&ray) {
                for (t_min, t_max) in [
                    (hit.t_hi.next_up(), f64::INFINITY),
                    (hit.t_hi, f64::INFINITY),
                    (0.0, hit.t_lo.next_down()),
                    (0.0, hit.t_lo),
                    (hit.t_hi.next_up(), hit.t_hi.next_up().next_up()),
                ] {
                    (ray.t_min, ray.t_max) = (t_min, t_max);
                    let all = world.all(&ray);
                    assert_eq!(world.any(&ray), !all.is_empty(), "{ray:?}");
                    assert_eq!(world.closest(&ray).map(|hit| hit.t), all.first().map(|hit| hit.t), "{ray:?}");
                    beside += 1;
                }
            }
        }
    }
    assert!(beside > 2000, "{beside}");
}

//! The laws for the named quadrics, the sector, and surfaces made from surfaces.

use crate::laws::{
    self, Exact, ExactBody, ExactForm, Feature, Tally, TestRng, all_roots, check_many, exact3,
};
use crate::quadric::axial::{Axial, Wall};
use crate::*;
use durer_math::{Point3, Vec3};

/// A whole quadric or a piece of it, from its wall's polynomial.
fn canonical(wall: &ExactForm, ends: Option<[f64; 2]>, open: bool, size: f64, convex: bool) -> ExactBody {
    let mut faces = vec![wall.clone()];
    if let Some([from, to]) = ends {
        faces.push(ExactForm::half_space(exact3([0.0, 0.0, -1.0]), exact3([0.0, 0.0, from])));
        faces.push(ExactForm::half_space(exact3([0.0, 0.0, 1.0]), exact3([0.0, 0.0, to])));
    }
    ExactBody { walls: if open { 1 } else { faces.len() }, faces, size, convex: convex && !open }
}

/// Features of a canonical quadric with semi-axes `a`, `b`, `c`, and rims at the heights `ends`.
fn features([a, b, c]: [f64; 3], ends: [f64; 2]) -> Vec<Feature> {
    let points = [
        [0.0, 0.0, 0.0],
        [a, 0.0, 0.0],
        [0.0, b, 0.0],
        [0.0, 0.0, c],
        [a, 0.0, c],
        [0.0, -b, -c],
        [a, b, c],
        [-a, b, 0.0],
        [0.0, 0.0, ends[0]],
        [0.0, 0.0, ends[1]],
        [a, 0.0, ends[1]],
        [0.0, b, ends[0]],
        [2.0 * a, 0.0, 4.0],
        [a, 0.0, 1.0],
        [0.6 * a, 0.8 * b, 0.0],
        [0.0, 2.0 * b, ends[1]],
    ];
    let directions = [
        [0.0, 0.0, 1.0],
        [a, 0.0, c],
        [0.0, b, c],
        [a, b, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [-a, b, 0.0],
        [a, 0.0, -c],
        [4.0 * a, 3.0 * b, 5.0 * c],
        [0.0, 0.0, 0.0],
        [a, 0.0, 4.0],
    ];
    points.iter().flat_map(|p| directions.iter().map(move |d| Feature::new(*p, *d))).collect()
}

/// Tests the laws for a whole quadric, a solid piece, an open piece, and each of them placed.
fn each_way<W: Wall>(
    whole: &Axial<W>,
    wall: &ExactForm,
    axes: [f64; 3],
    ends: [f64; 2],
    convex: bool,
    seed: u64,
) -> Tally {
    let size = axes[0].max(axes[1]).max(axes[2]).max(ends[0].abs()).max(ends[1].abs());
    let [from, to] = ends;
    let at = features(axes, ends);
    let mut sum = Tally::default();
    let mut add = |t: Tally| {
        sum.roots += t.roots;
        sum.grazing += t.grazing;
        sum.widths.extend(t.widths);
    };
    let (solid, open) = (whole.between(from, to).unwrap(), whole.open_between(from, to).unwrap());
    // A bounded piece may be wider than the axes.
    let reach = solid.bounds().reach_from(Point3::new(0.0, 0.0, 0.5 * (from + to)));
    let reach = if reach < f64::INFINITY { reach } else { size };
    let pieces = [
        (whole.clone(), canonical(wall, None, false, size, false)),
        (solid, canonical(wall, Some(ends), false, reach, convex)),
        (open, canonical(wall, Some(ends), true, reach, false)),
    ];
    for (i, (piece, oracle)) in pieces.into_iter().enumerate() {
        add(check_many(&piece, &oracle, &at, seed + i as u64, 150));
        let map = TestRng::new(seed + i as u64).map();
        let placed: Vec<_> = at.iter().map(|f| f.placed(&map)).collect();
        add(check_many(&Placed::new(piece, map), &oracle.placed(&map), &placed, seed + i as u64, 60));
    }
    sum
}

fn enough(tally: Tally) {
    assert!(tally.grazing > 0, "no grazing root");
    enough_roots(tally);
}

/// For numbers with many bits, for which f64 rays have no exact tangents.
fn enough_roots(mut tally: Tally) {
    assert!(tally.roots > 150, "{} roots", tally.roots);
    assert!(tally.median_width() < 40.0, "median width {}", tally.median_width());
}

#[test]
fn ellipsoids_obey_the_laws() {
    for (seed, axes) in
        [[2.0, 1.0, 0.5], [1.0, 1.0, 4.0], [3.0, 3.0, 0.0625], [1024.0, 1.0, 2.0]].into_iter().enumerate()
    {
        let [a, b, c] = axes;
        let (a2, b2, c2) = (a * a, b * b, c * c);
        let k = [b2 * c2, a2 * c2, a2 * b2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -a2 * b2 * c2];
        enough(each_way(
            &Ellipsoid::new(a, b, c).unwrap(),
            &ExactForm::from_f64(k),
            axes,
            [-0.5 * c, 0.25 * c],
            true,
            10 * seed as u64,
        ));
    }
    assert_eq!(Ellipsoid::spheroid(2.0, 1.0).unwrap().wall().axes, [2.0, 2.0, 1.0]);
}

#[test]
fn hyperboloids_obey_the_laws() {
    for (seed, axes) in [[2.0, 1.0, 1.0], [0.5, 0.5, 2.0], [1.0, 16.0, 0.125]].into_iter().enumerate() {
        let [a, b, c] = axes;
        let (a2, b2, c2) = (a * a, b * b, c * c);
        let seed = 10 * seed as u64;
        let one = [b2 * c2, a2 * c2, -a2 * b2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -a2 * b2 * c2];
        let one = ExactForm::from_f64(one);
        enough(each_way(
            &HyperboloidOfOneSheet::new(a, b, c).unwrap(),
            &one,
            axes,
            [-c, 2.0 * c],
            false,
            seed,
        ));
        let two = [b2 * c2, a2 * c2, -a2 * b2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, a2 * b2 * c2];
        let two = ExactForm::from_f64(two);
        enough(each_way(
            &HyperboloidOfTwoSheets::new(a, b, c).unwrap(),
            &two,
            axes,
            [-2.0 * c, 3.0 * c],
            false,
            seed,
        ));
        enough(each_way(
            &HyperboloidOfTwoSheets::new(a, b, c).unwrap(),
            &two,
            axes,
            [c, 2.0 * c],
            true,
            seed + 5,
        ));
    }
}

#[test]
fn cones_obey_the_laws() {
    for (seed, axes) in [[2.0, 1.0, 1.0], [0.5, 0.5, 2.0], [1.0, 16.0, 0.125]].into_iter().enumerate() {
        let [a, b, c] = axes;
        let (a2, b2, c2) = (a * a, b * b, c * c);
        let k = [b2 * c2, a2 * c2, -a2 * b2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let k = ExactForm::from_f64(k);
        let cone = Cone::new(a, b, c).unwrap();
        enough(each_way(&cone, &k, axes, [-c, 2.0 * c], false, 10 * seed as u64));
        enough(each_way(&cone, &k, axes, [0.0, c], true, 10 * seed as u64 + 3));
    }
}

#[test]
fn cylinders_obey_the_laws() {
    for (seed, axes) in [[2.0, 1.0, 1.0], [0.5, 0.5, 1.0], [1.0, 16.0, 1.0]].into_iter().enumerate() {
        let [a, b, _] = axes;
        let (a2, b2) = (a * a, b * b);
        let seed = 10 * seed as u64;
        let elliptic = [b2, a2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -a2 * b2];
        let elliptic = ExactForm::from_f64(elliptic);
        enough(each_way(&EllipticCylinder::new(a, b).unwrap(), &elliptic, axes, [-1.0, 2.0], true, seed));
        let hyperbolic = [b2, -a2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -a2 * b2];
        let hyperbolic = ExactForm::from_f64(hyperbolic);
        enough(each_way(
            &HyperbolicCylinder::new(a, b).unwrap(),
            &hyperbolic,
            axes,
            [-1.0, 2.0],
            false,
            seed,
        ));
    }
}

#[test]
fn the_normal_of_a_cone_is_its_axis_only_where_the_point_may_be_the_tip() {
    // Slender and large: far from the tip in the world's units, near it in units of the semi-axes.
    let large = Cone::circular(1073741824.0, 139586437120.0).unwrap();
    let rows = [[0.5, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 3.0]];
    let map = durer_math::Affine::new(rows, Point3::new(125.0, 0.125, 0.0)).unwrap();
    let ray = durer_math::Ray::new(
        Point3::new(127.4, 3.7249999999999996, -2340.0),
        Vec3::new(-819.2, -1228.8, 798720.0),
    );
    let placed = Placed::new(large, map);
    let normals = |surface: &dyn Surface, roots: Vec<Root>, ray: &durer_math::Ray| -> Vec<f64> {
        let at = |r: &Root| surface.resolve(&LocalRay::new(ray), r, Need::POINT).ng.z;
        roots.iter().map(at).collect()
    };
    let found = normals(&placed, all_roots(&placed, &ray), &ray);
    // The first crossing cannot be distinguished from the tip.
    assert!(found.len() == 2 && found[1].abs() < 0.01, "{found:?}");
    // Any distance from the tip of a cone at the origin.
    let cone = Cone::circular(1.0, 1.0).unwrap();
    for k in 1..40 {
        let r = durer_math::scale::pow2(-10 * k);
        let ray = durer_math::Ray::new(Point3::new(-4.0 * r, 0.0, r), Vec3::X);
        let found = normals(&cone, all_roots(&cone, &ray), &ray);
        assert!(
            found.len() == 2 && found.iter().all(|z| (z + 0.5_f64.sqrt()).abs() < 1e-15),
            "{k}: {found:?}"
        );
    }
    // At the tip of one half the axis is the only normal.
    let through = durer_math::Ray::new(Point3::new(-4.0, 0.0, 0.0), Vec3::X);
    let half = cone.between(0.0, 1.0).unwrap();
    assert_eq!(normals(&half, all_roots(&half, &through), &through), [-1.0]);
}

/// Rays that leave a double tip start on the requested side, wherever the surface is placed.
#[test]
fn rays_leave_a_double_tip_on_their_side() {
    let cone = |a: f64, b: f64| DynSurface::new(Cone::new(a, b, 1.0).unwrap());
    let general = |k: [f64; 10]| DynSurface::new(Quadric::new(k).unwrap());
    let surfaces = [
        cone(0.5, 0.75),
        cone(1.0, 64.0),
        DynSurface::new(Cone::new(1.0, 1.0, 2.0).unwrap().between(-2.0, 1.0).unwrap()),
        // x² + 2 y² - 3 z² + x y, and the planes of x y = 0.
        general([1.0, 2.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        general([-1.0, -2.0, 3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        general([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ];
    let far = |by: Vec3| durer_math::Affine::translation(by).unwrap();
    let mut tips = 0;
    for (seed, surface) in surfaces.iter().enumerate() {
        for i in 0..200 {
            let mut dice = laws::dice(700 + seed as u64, i);
            // There and back again, so that rounding is large beside the tip.
            let there = dice.vector() * dice.pick(&[0.0, 1.0, 1e3, 1e6]);
            let maps = match i % 3 {
                0 => [far(there), far(-there), dice.map()],
                1 => [dice.map(), far(there), dice.map()],
                _ => [dice.map(), dice.map(), far(there)],
            };
            let placed = maps.iter().fold(surface.clone(), |s, map| DynSurface::new(Placed::new(s, *map)));
            let tip = maps.iter().fold(Point3::ORIGIN, |p, map| map.point(p));
            let origin = tip - dice.vector() * 4.0;
            let ray = durer_math::Ray::new(origin, tip - origin);
            for root in all_roots(&placed, &ray) {
                let point = placed.resolve(&LocalRay::new(&ray), &root, Need::ALL);
                tips += u32::from(point.aside != Vec3::ZERO);
                assert!((0..3).all(|k| (point.p[k] - ray.at(root.t)[k]).abs() <= 2.0 * point.dp[k]));
                for (side, wanted) in
                    [(durer_math::RaySide::Front, Side::Out), (durer_math::RaySide::Back, Side::In)]
                {
                    let start = point.spawn_from(side, dice.vector());
                    let found = placed.side(&LocalPoint::new(start.origin));
                    assert_eq!(found, wanted, "{seed} {i}: {side:?} {point:?}");
                }
            }
        }
    }
    assert!(tips > 600, "{tips} tips");
}

/// The polynomial `x²/a² + sign y²/b² - z/c` (without `sign`: `x²/a² - y/b`) times its
/// denominators, exactly.
fn parabolic_wall([a, b, c]: [f64; 3], sign: Option<f64>) -> ExactForm {
    let [a, b, c] = exact3([a, b, c]);
    let (a2, b2) = (a.squared(), b.squared());
    let mut k: [Exact; 10] = core::array::from_fn(|_| Exact::zero());
    match sign {
        Some(sign) => {
            k[0] = &b2 * &c;
            k[1] = &(&a2 * &c) * &sign.into();
            k[8] = -(&a2 * &b2);
        }
        None => {
            k[0] = b;
            k[7] = -a2;
        }
    }
    ExactForm::new(k)
}

/// Semi-axes with few bits and with many, of every size.
const WILD: [[f64; 3]; 9] = [
    [2.0, 1.0, 1.0],
    [0.5, 0.5, 1.0],
    [1.0, 16.0, 1.0],
    [0.5, 5.0, 3.0],
    [0.1, 1.0 / 3.0, 0.7],
    [3.0, 2.0, 1e-3],
    [1e-3, 1.0, 123.45678],
    [3e-4, 7e-4, 1e-3],
    [1e30, 0.3e31, 1.7e29],
];

#[test]
fn parabolic_cylinders_obey_the_laws() {
    for (seed, axes) in WILD.into_iter().enumerate() {
        let wall = parabolic_wall(axes, None);
        let [a, b, c] = axes;
        let whole = ParabolicCylinder::new(a, b).unwrap();
        let enough = if seed < 4 { enough } else { enough_roots };
        enough(each_way(&whole, &wall, axes, [-c, 2.0 * c], true, 40 + 10 * seed as u64));
    }
}

#[test]
fn paraboloids_obey_the_laws() {
    for (seed, axes) in WILD.into_iter().enumerate() {
        let [a, b, c] = axes;
        let enough = if seed < 4 { enough } else { enough_roots };
        let seed = 10 * seed as u64;
        let bowl = parabolic_wall(axes, Some(1.0));
        let whole = EllipticParaboloid::new(a, b, c).unwrap();
        enough(each_way(&whole, &bowl, axes, [0.25 * c, 4.0 * c], true, seed));
        let saddle = parabolic_wall(axes, Some(-1.0));
        let whole = HyperbolicParaboloid::new(a, b, c).unwrap();
        enough(each_way(&whole, &saddle, axes, [-c, 4.0 * c], false, seed));
    }
    assert_eq!(EllipticParaboloid::circular(2.0, 3.0).unwrap().wall().axes, [2.0, 2.0, 3.0]);
}

#[test]
fn a_parabolic_cylinder_keeps_its_semi_axes_through_a_map() {
    // A map whose entries would round if 5 were multiplied into them.
    let rows = [
        [-0.047163528508317176, 0.37220940142167547, 0.35077195769907066],
        [0.761854350660014, 0.08489537269603376, 0.6658572465994852],
        [0.2520094940398525, 0.8288445552511365, 0.5800278104670793],
    ];
    let map = durer_math::Affine::new(rows, Point3::new(1000.0, 1000.0, -7.0)).unwrap();
    let piece = ParabolicCylinder::new(0.5, 5.0).unwrap().between(1.25, 1.5).unwrap();
    let piece = Placed::new(piece, map);
    let wall = parabolic_wall([0.5, 5.0, 1.0], None);
    let oracle = canonical(&wall, Some([1.25, 1.5]), false, 5.0, true).placed(&map);
    let at: Vec<_> = features([0.5, 5.0, 1.0], [1.25, 1.5]).into_iter().map(|f| f.placed(&map)).collect();
    check_many(&piece, &oracle, &at, 3, 300);
    let through = durer_math::Ray::new(
        Point3::new(1001.2849735823336, 1004.9223603270098, -1.5275298106296085),
        Vec3::new(0.40222268687226215, -0.34125492182311384, 0.5776332485252329),
    );
    assert_eq!(laws::check(&piece, &oracle, &through).unwrap().len(), 2);
    // The exact image of the y axis: z = 0 everywhere, below the piece.
    let beside = durer_math::Ray::new(Point3::new(1000.0, 1000.0, -7.0), Vec3::from(rows.map(|r| r[1])));
    assert_eq!(all_roots(&piece, &beside), []);
}

/// The faces of a sector, from its definition.
fn exact_sector(centre: Point3, r: f64, axis: Vec3, cosine: f64) -> ExactBody {
    let a = exact3(axis.to_array());
    let aa = a.iter().fold(Exact::zero(), |s, x| &s + &x.squared());
    let k = &aa * &Exact::from(cosine).squared();
    let zero = || [Exact::zero(), Exact::zero(), Exact::zero()];
    let sphere = ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let sphere = ExactForm { c: -Exact::from(r).squared(), ..sphere };
    let cone = ExactForm {
        q: core::array::from_fn(|i| {
            core::array::from_fn(|j| &(if i == j { k.clone() } else { Exact::zero() }) - &(&a[i] * &a[j]))
        }),
        b: zero(),
        c: Exact::zero(),
    };
    let half = ExactForm::half_space(a.clone().map(|x| -x), zero());
    let faces = if cosine == 0.0 { vec![sphere, half] } else { vec![sphere, cone, half] };
    let centre = exact3(centre.to_array());
    ExactBody::solid(faces.into_iter().map(|f| f.translated(&centre)).collect(), r, true)
}

#[test]
fn sectors_obey_the_laws() {
    let mut tally = Tally::default();
    for seed in 0..24 {
        let mut dice = TestRng::new(seed);
        // Axes and cosines with rational generators: 3-4-5.
        let axis = dice.pick(&[Vec3::Z, -Vec3::X, Vec3::new(1.0, 2.0, 2.0), Vec3::new(-0.5, 0.25, 1.0)]);
        let cosine = dice.pick(&[0.0, 0.6, 0.8, 0.5, 0.9990234375]);
        let r = dice.power(-3, 6) * 5.0;
        let centre = (dice.lattice(8) * 0.5).to_point();
        let sector = SphericalSector::new(centre, r, axis, cosine).unwrap();
        let mut at = vec![];
        let unit = axis * (1.0 / axis.length());
        let e = unit.cross(if axis.x == 0.0 { Vec3::X } else { Vec3::Z });
        let e = e * (1.0 / e.length());
        let sine = (1.0 - cosine * cosine).sqrt();
        for out in [e, -e, unit.cross(e)] {
            let rim = unit * cosine + out * sine;
            for d in [axis, rim, out, e, unit.cross(e), unit * sine - out * cosine, Vec3::ZERO] {
                for p in [Vec3::ZERO, unit * r, rim * r, rim * (0.5 * r), out * r] {
                    at.push(Feature { point: centre + p, direction: d });
                }
            }
        }
        let t = check_many(&sector, &exact_sector(centre, r, axis, cosine), &at, seed, 200);
        tally.roots += t.roots;
        tally.grazing += t.grazing;
        let map = dice.map();
        let placed: Vec<_> = at.into_iter().map(|f| f.placed(&map)).collect();
        check_many(
            &Placed::new(sector, map),
            &exact_sector(centre, r, axis, cosine).placed(&map),
            &placed,
            seed,
            60,
        );
    }
    assert!(tally.roots > 1000 && tally.grazing > 10);
}

/// A clipped surface: the walls stay, and the regions' faces cut.
fn clipped(mut oracle: ExactBody, regions: &[ExactBody]) -> ExactBody {
    oracle.convex = false;
    for r in regions {
        oracle.faces.extend(r.faces.iter().cloned());
    }
    oracle
}

fn exact_box(min: [f64; 3], max: [f64; 3]) -> ExactBody {
    let mut faces = vec![];
    for i in 0..3 {
        let mut n = [0.0; 3];
        n[i] = 1.0;
        faces.push(ExactForm::half_space(exact3(n.map(|x| -x)), exact3(min)));
        faces.push(ExactForm::half_space(exact3(n), exact3(max)));
    }
    ExactBody::solid(faces, 1.0, true)
}

#[test]
fn clipped_surfaces_obey_the_laws() {
    let mut roots = 0;
    for seed in 0..30 {
        let mut dice = TestRng::new(seed);
        let map = (seed % 3 == 2).then(|| dice.map());
        let (min, max) = ([-1.0, -2.0, -0.5], [1.5, 1.0, 2.0]);
        let block = Region::axis_box(min.into(), max.into()).unwrap();
        let ball = Sphere::new(Point3::new(0.0, 0.0, 2.0), 2.0).unwrap();
        let exact_ball = ExactBody::solid(
            vec![ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0, 0.0])],
            2.0,
            true,
        );
        let (regions, exact) = if seed % 2 == 0 {
            (vec![block], vec![exact_box(min, max)])
        } else {
            (vec![Region::solid(ball), block], vec![exact_ball, exact_box(min, max)])
        };
        let (regions, exact): (Vec<_>, Vec<_>) = match map {
            None => (regions, exact),
            Some(m) => (
                regions.into_iter().map(|r| r.placed(m)).collect(),
                exact.iter().map(|e| e.placed(&m)).collect(),
            ),
        };
        let mut at = features([2.0, 1.0, 1.0], [-0.5, 2.0]);
        for x in [min[0], max[0]] {
            for y in [min[1], max[1]] {
                for z in [min[2], max[2]] {
                    at.push(Feature::new([x, y, z], [x, y, z]));
                }
            }
        }
        // The rim where the sphere |x| = 2 meets the ball: z = 1, and where it meets the planes.
        at.push(Feature::new([1.5, 1.0, 0.8660254037844386], [0.0, 1.0, 0.0]));
        if let Some(m) = map {
            at = at.into_iter().map(|f| f.placed(&m)).collect();
        }
        let k = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0];
        let sphere = Sphere::new(Point3::ORIGIN, 2.0).unwrap();
        let body = ExactBody::solid(vec![ExactForm::from_f64(k)], 2.0, true);
        match map {
            None => {
                let body = clipped(body, &exact);
                roots += check_many(&Clip::new(sphere, regions.clone()), &body, &at, seed, 200).roots;
                let cone = Cone::new(2.0, 1.0, 1.0).unwrap();
                let k = [1.0, 4.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                let body = clipped(ExactBody::solid(vec![ExactForm::from_f64(k)], 1.0, false), &exact);
                roots += check_many(&Clip::new(cone, regions), &body, &at, seed, 200).roots;
            }
            Some(m) => {
                let body = clipped(body.placed(&m), &exact);
                roots += check_many(&Clip::new(Placed::new(sphere, m), regions), &body, &at, seed, 100).roots;
            }
        }
    }
    assert!(roots > 1000, "only {roots} roots");
}

#[test]
fn an_inverse_region_keeps_the_rest() {
    let sphere = Sphere::new(Point3::ORIGIN, 1.0).unwrap();
    let lower = Region::half_space(durer_math::Normal3::Z, 0.0).unwrap();
    let halves = [Clip::new(sphere, vec![lower.clone()]), Clip::new(sphere, vec![lower.inverse()])];
    let count = |d: Vec3, from: Point3| {
        let ray = durer_math::Ray::new(from, d);
        halves.each_ref().map(|h| all_roots(h, &ray).len())
    };
    assert_eq!(count(Vec3::Z, Point3::new(0.25, 0.0, -4.0)), [1, 1]);
    // On the border both halves contain the point: each is closed.
    assert_eq!(count(Vec3::X, Point3::new(-4.0, 0.0, 0.0)), [2, 2]);
    assert_eq!(count(Vec3::X, Point3::new(-4.0, 0.0, f64::from_bits(1))), [0, 2]);
}

#[test]
fn an_inverse_turns_signs_sides_and_normals() {
    let sphere = Sphere::new(Point3::ORIGIN, 1.0).unwrap();
    let form = ExactForm::from_f64([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).negated();
    let oracle = ExactBody::solid(vec![form], 1.0, false);
    let tally = check_many(&Complement(sphere), &oracle, &features([1.0, 1.0, 1.0], [-1.0, 1.0]), 7, 1000);
    assert!(tally.roots > 300);
}

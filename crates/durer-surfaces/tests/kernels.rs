//! One surface in several kernels: quadric, polynomial, formula, swept, revolution. Each
//! brackets its exact crossings, so the brackets of one crossing overlap for all kernels.

use durer_math::{Aabb, Affine, Point3, Ray, Vec3};
use durer_surfaces::algebraic::{coefficient_count, place_of};
use durer_surfaces::implicit::level_set::primitives;
use durer_surfaces::{
    AlgebraicSurface, All, Axis, AxisBox, Blob, BlobComponent, BlobShape, CappedCylinder, Cyclide, Ellipsoid,
    EllipticCylinder, LevelSet, LocalRay, Prism, Quadric, Root, RootKind, Sphere, Surface,
    SurfaceOfRevolution, Torus, Warp, superellipsoid,
};
use durer_testkit::TestRng;

/// A surface's name and its roots along a ray.
type Named = (&'static str, Box<dyn Fn(&Ray) -> Vec<Root>>);

fn named<S: Surface + 'static>(name: &'static str, surface: S) -> Named {
    let all = move |ray: &Ray| {
        let mut sink = All::default();
        surface.roots(&LocalRay::new(ray), &mut sink);
        sink.roots
    };
    (name, Box::new(all))
}

/// Rays through the cube from -2 to 2, from near and far: anywhere, along axes, through points with
/// few bits, and nearly tangent to the unit sphere.
fn ray(dice: &mut TestRng) -> Ray {
    let mut direction = dice.vector();
    let mut through = dice.vector() * 1.25;
    match dice.below(6) {
        0 => direction[dice.below(3) as usize] = 0.0,
        1 => direction = [Vec3::X, Vec3::Y, Vec3::Z][dice.below(3) as usize],
        2 => {
            let across = direction.cross(through);
            through = across * ((1.0 + dice.signed() * 1e-7) / across.length());
        }
        3 => through = through.map(|x| (x * 4.0).round() * 0.25),
        _ => {}
    }
    let back = [4.0, 5.0, 1e3, 1e7][dice.below(4) as usize] / direction.length();
    Ray::new(through.to_point() - direction * back, direction)
}

/// Compares all kernels with the first. Rays with clusters or tangents are uncertain; they are
/// counted and must be few.
fn agree(kernels: &[Named], seed: u64, count: usize) {
    let mut dice = TestRng::new(seed);
    let (mut met, mut unsure) = (0, 0);
    for _ in 0..count {
        let ray = ray(&mut dice);
        let all: Vec<_> = kernels.iter().map(|(name, roots)| (name, roots(&ray))).collect();
        // Roots that t does not separate count as uncertain, too.
        let close = |roots: &[Root]| roots.windows(2).any(|w| w[1].lo <= w[0].hi);
        if all.iter().any(|(_, roots)| close(roots) || roots.iter().any(|r| r.kind != RootKind::Simple)) {
            unsure += 1;
            continue;
        }
        let (first, expected) = &all[0];
        for (name, roots) in &all[1..] {
            let same = roots.len() == expected.len()
                && roots.iter().zip(expected).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi && a.sign == b.sign);
            assert!(same, "{name} and {first} along {ray:?}:\n {roots:?}\n {expected:?}");
        }
        met += expected.len();
    }
    println!("{met} roots, {unsure} rays unsure");
    assert!(met * 4 > count && unsure * 20 < count, "{met} roots, {unsure} of {count} rays unsure");
}

fn polynomial(order: u32, terms: &[([u32; 3], f64)]) -> AlgebraicSurface {
    let mut list = vec![0.0; coefficient_count(order)];
    for (powers, c) in terms {
        list[place_of(order, *powers)] += c;
    }
    AlgebraicSurface::new(order, &list).unwrap()
}

#[test]
fn spheres() {
    // 1 - d^2 / 4 = 3 / 4 at d = 1.
    let field = BlobComponent {
        shape: BlobShape::Ball(Point3::ORIGIN),
        radius: 2.0,
        strength: 1.0,
        place: Affine::IDENTITY,
    };
    let one = Vec3::new(1.0, 1.0, 1.0);
    let level =
        LevelSet::new(primitives::ball(Point3::ORIGIN, 1.0).unwrap(), Aabb::centred(Point3::ORIGIN, one));
    let twist = Warp::Twist { axis: Vec3::Y, degrees: 90.0, from: -0.5, to: 0.25 };
    let squares = [([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0), ([0, 0, 0], -1.0)];
    // (q - 1) (q + 1) = q^2 - 1 with q = |p|^2: a sphere, and a sphere without real points.
    let quartic = [
        ([4, 0, 0], 1.0),
        ([0, 4, 0], 1.0),
        ([0, 0, 4], 1.0),
        ([2, 2, 0], 2.0),
        ([0, 2, 2], 2.0),
        ([2, 0, 2], 2.0),
        ([0, 0, 0], -1.0),
    ];
    agree(
        &[
            named("sphere", Sphere::new(Point3::ORIGIN, 1.0).unwrap()),
            named("quadric", Quadric::new([2.0, 2.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0]).unwrap()),
            named("ellipsoid", Ellipsoid::new(1.0, 1.0, 1.0).unwrap()),
            named("polynomial of order 2", polynomial(2, &squares)),
            named("polynomial of order 4", polynomial(4, &quartic)),
            named("superellipsoid", superellipsoid(1.0, 1.0).unwrap()),
            named("blob", Blob::new(0.5625, &[field]).unwrap()),
            named("formula", level.surface().unwrap().unwrap()),
            named("twisted formula", level.deformed(&twist).unwrap().surface().unwrap().unwrap()),
        ],
        1,
        6000,
    );
}

#[test]
fn tori() {
    let (major, minor) = (0.75, 0.375);
    // (q + R^2 - r^2)^2 - 4 R^2 (x^2 + z^2) with k = R^2 - r^2.
    let (big, k) = (4.0 * major * major, major * major - minor * minor);
    let terms = [
        ([4, 0, 0], 1.0),
        ([0, 4, 0], 1.0),
        ([0, 0, 4], 1.0),
        ([2, 2, 0], 2.0),
        ([0, 2, 2], 2.0),
        ([2, 0, 2], 2.0),
        ([2, 0, 0], 2.0 * k - big),
        ([0, 2, 0], 2.0 * k),
        ([0, 0, 2], 2.0 * k - big),
        ([0, 0, 0], k * k),
    ];
    let torus = Torus::new(Point3::ORIGIN, Axis::Y, major, minor).unwrap();
    let level = LevelSet::new(primitives::torus(major, minor).unwrap(), torus.bounds());
    let other = LevelSet::new(primitives::cyclide(major, 0.0, minor).unwrap(), torus.bounds());
    agree(
        &[
            named("torus", torus),
            named("cyclide", Cyclide::new(major, 0.0, minor).unwrap()),
            named("polynomial", polynomial(4, &terms)),
            named("formula", level.surface().unwrap().unwrap()),
            named("formula of a cyclide", other.surface().unwrap().unwrap()),
        ],
        2,
        6000,
    );
}

#[test]
fn cyclides() {
    let [a, c, d] = [0.75, 0.25, 0.375];
    let cyclide = Cyclide::new(a, c, d).unwrap();
    let b2 = (a - c) * (a + c);
    // (q + b^2 - d^2)^2 - 4 (a x - c d)^2 - 4 b^2 z^2: the other form.
    let k = b2 - d * d;
    let terms = [
        ([4, 0, 0], 1.0),
        ([0, 4, 0], 1.0),
        ([0, 0, 4], 1.0),
        ([2, 2, 0], 2.0),
        ([0, 2, 2], 2.0),
        ([2, 0, 2], 2.0),
        ([2, 0, 0], 2.0 * k - 4.0 * a * a),
        ([0, 2, 0], 2.0 * k),
        ([0, 0, 2], 2.0 * k - 4.0 * b2),
        ([1, 0, 0], 8.0 * a * c * d),
        ([0, 0, 0], k * k - 4.0 * c * c * d * d),
    ];
    let level = LevelSet::new(primitives::cyclide(a, c, d).unwrap(), cyclide.bounds());
    agree(
        &[
            named("cyclide", cyclide),
            named("polynomial", polynomial(4, &terms)),
            named("formula", level.surface().unwrap().unwrap()),
        ],
        3,
        6000,
    );
}

#[test]
fn cylinders() {
    let (base, cap) = (Point3::new(0.0, 0.0, -0.5), Point3::new(0.0, 0.0, 0.75));
    let bounds = Aabb::new(Point3::new(-0.5, -0.5, -0.5), Point3::new(0.5, 0.5, 0.75));
    let level = LevelSet::new(primitives::frustum(base, 0.5, cap, 0.5).unwrap(), bounds);
    agree(
        &[
            named("cylinder", CappedCylinder::new(base, cap, 0.5).unwrap()),
            named("named cylinder", EllipticCylinder::new(0.5, 0.5).unwrap().between(-0.5, 0.75).unwrap()),
            named("formula", level.surface().unwrap().unwrap()),
        ],
        4,
        6000,
    );
}

#[test]
fn upright_cylinders() {
    let (base, cap) = (Point3::new(0.0, -0.5, 0.0), Point3::new(0.0, 0.75, 0.0));
    let turned = SurfaceOfRevolution::sor(&[[0.5, -1.0], [0.5, -0.5], [0.5, 0.75], [0.5, 1.0]]).unwrap();
    agree(&[named("cylinder", CappedCylinder::new(base, cap, 0.5).unwrap()), named("sor", turned)], 5, 6000);
}

#[test]
fn boxes() {
    let (a, b) = (Point3::new(-0.5, -0.25, -0.75), Point3::new(0.5, 0.5, 0.25));
    let outline = vec![[-0.5, -0.75], [0.5, -0.75], [0.5, 0.25], [-0.5, 0.25]];
    let level = LevelSet::new(primitives::cuboid(a, b).unwrap(), Aabb::new(a, b));
    agree(
        &[
            named("box", AxisBox::new(a, b).unwrap()),
            named("prism", Prism::linear(&[outline], -0.25, 0.5).unwrap()),
            named("formula", level.surface().unwrap().unwrap()),
        ],
        6,
        3000,
    );
}

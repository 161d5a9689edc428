//! The laws of spans: they are ordered and disjoint; their points are inside, all others outside.

mod common;

use common::{Draws, fill, ground, rays};
use durer_geometry::Geometry;
use durer_math::{Affine, Point3, Ray, Vec3};
use durer_surfaces::{
    Algebraic, AxisBox, Bezier, Complement, CurvedPrism, Disc, DynSurface, Frustum, Placed, Prism, Quadric,
    Side, Sphere, SurfaceOfRevolution,
};
use durer_testkit::TestRng;
use std::sync::Arc;

/// The midpoint of an interval of the ray, if the interval is so long that rounding does not
/// matter.
fn middle(ray: &Ray, a: f64, b: f64) -> Option<Point3> {
    let (a, b) = (a.max(-100.0), b.min(100.0));
    ((b - a) * ray.direction.length() > 1e-6).then(|| ray.at(0.5 * (a + b)))
}

fn check(world: &Geometry, ray: &Ray) -> usize {
    let spans = world.spans(ray);
    let mut at = ray.t_min;
    for (i, span) in spans.iter().enumerate() {
        assert!(at <= span.t_in && span.t_in <= span.t_out && span.t_out <= ray.t_max, "{spans:?}");
        assert!(i == 0 || at < span.t_in || spans[i - 1].t_out == at, "{spans:?}");
        assert_eq!(span.object_in.is_none(), i == 0 && span.t_in == ray.t_min && span.object_in.is_none());
        if let Some(p) = middle(ray, at, span.t_in) {
            assert_ne!(world.side(p), Side::In, "a gap of {spans:?} of {ray:?} is inside");
        }
        if let Some(p) = middle(ray, span.t_in, span.t_out) {
            assert_ne!(world.side(p), Side::Out, "a span of {spans:?} of {ray:?} is outside");
        }
        at = span.t_out;
    }
    if let Some(p) = middle(ray, at, ray.t_max) {
        assert_ne!(world.side(p), Side::In, "behind {spans:?} of {ray:?} it is inside");
    }
    // Each end is one of all crossings.
    let all = world.all(ray);
    for span in &spans {
        for (t, object) in [(span.t_in, span.object_in), (span.t_out, span.object_out)] {
            if let Some(object) = object {
                assert!(all.iter().any(|h| h.t == t && (h.t_lo..=h.t_hi).contains(&t)), "{object:?} at {t}");
            }
        }
    }
    spans.len()
}

#[test]
fn spans_are_where_the_solids_are() {
    let mut spans = 0;
    for seed in 0..8 {
        let mut builder = Geometry::builder();
        fill(&mut builder, &mut TestRng::new(seed), 40, seed % 2 == 0);
        if seed > 5 {
            builder.add(ground());
        }
        let world = builder.build().unwrap();
        for ray in rays(&mut TestRng::new(50 + seed), 200) {
            spans += check(&world, &ray);
        }
    }
    assert!(spans > 800, "{spans}");
}

#[test]
fn ranges_that_begin_and_end_inside() {
    let world = Geometry::builder().with(Sphere::new(Point3::ORIGIN, 2.0).unwrap()).build().unwrap();
    let ray = |a: f64, b: f64| Ray::new(Point3::ORIGIN, Vec3::X).with_range(a, b);
    let spans = |a: f64, b: f64| {
        let all = world.spans(&ray(a, b));
        all.iter()
            .map(|s| (s.t_in, s.t_out, s.object_in.is_some(), s.object_out.is_some()))
            .collect::<Vec<_>>()
    };
    assert_eq!(spans(-5.0, 5.0), [(-2.0, 2.0, true, true)]);
    assert_eq!(spans(-1.0, 5.0), [(-1.0, 2.0, false, true)]);
    assert_eq!(spans(-5.0, 1.0), [(-2.0, 1.0, true, false)]);
    assert_eq!(spans(-1.0, 1.0), [(-1.0, 1.0, false, false)]);
    assert_eq!(spans(2.5, 5.0), []);
    assert_eq!(spans(-5.0, -3.0), []);
    // The range itself: entering exactly at the start, leaving exactly at the start.
    assert_eq!(spans(-2.0, 1.0), [(-2.0, 1.0, true, false)]);
    assert_eq!(spans(2.0, 5.0), []);
}

#[test]
fn boxes_that_share_a_face_are_one() {
    let unit = |x: f64| AxisBox::new(Point3::new(x, 0.0, 0.0), Point3::new(x + 1.0, 1.0, 1.0)).unwrap();
    let mut builder = Geometry::builder();
    (0..10).for_each(|i| _ = builder.add(unit(f64::from(i))));
    builder.add(Disc::new(Point3::new(5.5, 0.5, 0.5), Vec3::X, 2.0).unwrap());
    let world = builder.build().unwrap();
    let spans = world.spans(&Ray::new(Point3::new(-3.0, 0.3, 0.7), Vec3::X));
    assert_eq!(spans.len(), 1);
    assert_eq!((spans[0].t_in, spans[0].t_out), (3.0, 13.0));
    assert_eq!((spans[0].object_in.map(|o| o.0), spans[0].object_out.map(|o| o.0)), (Some(0), Some(9)));
    // At a slant, too, where the crossings are rounded.
    let spans = world.spans(&Ray::new(Point3::new(-3.0, 0.1, 0.2), Vec3::new(1.0, 0.03, 0.031)));
    assert_eq!(spans.len(), 1);
    // The disc is open: it is hit, but has no inside.
    assert_eq!(world.all(&Ray::new(Point3::new(-3.0, 1.5, 0.5), Vec3::X)).len(), 1);
    assert!(world.spans(&Ray::new(Point3::new(-3.0, 1.5, 0.5), Vec3::X)).is_empty());
}

/// Spans as (begin, end, whether it is entered, whether it is left).
fn ends(world: &Geometry, ray: &Ray) -> Vec<(f64, f64, bool, bool)> {
    let spans = world.spans(ray);
    spans.iter().map(|s| (s.t_in, s.t_out, s.object_in.is_some(), s.object_out.is_some())).collect()
}

/// `a x² + b y² + c z² + w`.
fn quadric([a, b, c, w]: [f64; 4]) -> Quadric {
    Quadric::new([a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, w]).unwrap()
}

/// Found by the oracle in `tests/outside`: at the start of these ranges the ray only touches the
/// solid.
#[test]
fn ranges_that_begin_at_a_touch() {
    const INF: f64 = f64::INFINITY;
    let hyperboloid = quadric([1.0, 1.0, -1.0, -1.0]);
    let cone = quadric([1.0, 9.0, -1.0, 0.0]);
    let ball = Sphere::new(Point3::ORIGIN, 1.0).unwrap();
    let along = |o: [f64; 3], d: [f64; 3], t_min: f64| {
        Ray::new(Point3::from(o), Vec3::from(d)).with_range(t_min, INF)
    };
    let whole = |t_min: f64| vec![(t_min, INF, false, false)];
    let one = |add: &dyn Fn(&mut durer_geometry::Builder)| {
        let mut builder = Geometry::builder();
        add(&mut builder);
        let inner = Arc::new(builder.build().unwrap());
        // Within an instance, whose map rounds the rays.
        let map =
            Affine::new([[0.5, 0.25, 0.0], [0.0, 2.0, 0.0], [0.0, -1.0, 4.0]], Point3::new(2.0, 3.0, 5.0))
                .unwrap();
        let outer =
            Geometry::builder().with_instance(&inner, map, durer_geometry::EVERYTHING).build().unwrap();
        (inner, outer, map)
    };
    let check = |(inner, outer, map): &(Arc<Geometry>, Geometry, Affine),
                 ray: Ray,
                 expected: Vec<(f64, f64, bool, bool)>| {
        assert_eq!(ends(inner, &ray), expected, "{ray:?}");
        let placed =
            Ray::new(map.point(ray.origin), map.vector(ray.direction)).with_range(ray.t_min, ray.t_max);
        assert_eq!(ends(outer, &placed), expected, "placed {ray:?}");
    };
    // x² + y² - z² <= 1 along (1, t, 2t): -3t².
    let world = one(&|b| _ = b.add(DynSurface::new(hyperboloid.clone())));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 2.0], -1.0), whole(-1.0));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 2.0], 0.0), whole(0.0));
    check(&world, along([1.0, -1.0, -2.0], [0.0, 1.0, 2.0], 1.0), whole(1.0));
    // Along a generator: in the boundary all the way, and so in the closed set.
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 1.0], 0.0), whole(0.0));
    // The complement.
    let world = one(&|b| _ = b.add(Complement(DynSurface::new(hyperboloid.clone()))));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 2.0], -1.0), vec![]);
    // From the tip of a cone, inside it and outside.
    let world = one(&|b| _ = b.add(DynSurface::new(cone.clone())));
    check(&world, along([0.0, 0.0, 0.0], [0.0, 0.0, -0.348], 0.0), whole(0.0));
    check(&world, along([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0), vec![]);
    let world = one(&|b| _ = b.add(DynSurface::new(ball)));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0), vec![]);
    let world = one(&|b| _ = b.add(Complement(DynSurface::new(ball))));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0), whole(0.0));
    check(&world, along([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], -3.0), whole(-3.0));
}

/// A ray's hits do not depend on the position of its origin on the line: here every origin but one
/// is off the boundary, the directions are such that tangents, rims, edges and corners are common,
/// and all numbers are exact.
#[test]
fn spans_do_not_depend_on_the_origin() {
    fn try_solid<S: Algebraic + Clone + 'static>(solid: &S, dice: &mut TestRng, touches: &mut usize) {
        let solid = DynSurface::new(solid.clone());
        let turned = Geometry::builder().with(Complement(solid.clone())).build().unwrap();
        let world = Geometry::builder().with(solid).build().unwrap();
        for _ in 0..1500 {
            let (a, b) = (dice.grid(), dice.grid());
            if a == b {
                continue;
            }
            let d = b - a;
            for world in [&world, &turned] {
                let from = |k: f64| {
                    let ray = Ray::new(a + d * k, d).with_range(-k, f64::INFINITY);
                    let mut spans = ends(world, &ray);
                    // A range that begins where a solid ends may keep a span whose length is only
                    // rounding.
                    spans.retain(|s| s.1 - s.0 > 1e-12);
                    // In the first ray's parameter.
                    spans.iter().map(|s| (s.0 + k, s.1 + k, s.2, s.3)).collect::<Vec<_>>()
                };
                let at_origin = from(0.0);
                for k in [-2.0, 1.0, 0.125, 7.0] {
                    let other = from(k);
                    assert_eq!(
                        at_origin.len(),
                        other.len(),
                        "{at_origin:?} {other:?} from {a:?} along {d:?}"
                    );
                    for (x, y) in at_origin.iter().zip(&other) {
                        assert_eq!((x.2, x.3), (y.2, y.3), "{at_origin:?} {other:?} from {a:?} along {d:?}");
                        assert!(x.0 == y.0 || (x.0 - y.0).abs() < 1e-12, "{x:?} {y:?}");
                        assert!(x.1 == y.1 || (x.1 - y.1).abs() < 1e-12, "{x:?} {y:?}");
                    }
                }
                *touches += usize::from(world.side(a) == Side::On && at_origin.iter().all(|s| !s.2 && !s.3));
            }
        }
    }
    let (mut dice, mut touches) = (TestRng::new(5), 0);
    for r in [1.0, 2.0, 3.0] {
        try_solid(&Sphere::new(Point3::new(0.0, 0.0, 1.0 - r), r).unwrap(), &mut dice, &mut touches);
        try_solid(
            &AxisBox::new(Point3::new(-1.0, -r, 0.0), Point3::new(1.0, 0.0, r)).unwrap(),
            &mut dice,
            &mut touches,
        );
        try_solid(
            &Frustum::new(Point3::ORIGIN, r, Point3::new(0.0, 0.0, r), 0.0).unwrap(),
            &mut dice,
            &mut touches,
        );
        let map =
            Affine::new([[1.0, 1.0, 0.0], [0.0, r, 0.0], [0.0, -1.0, 2.0]], Point3::new(1.0, 0.0, -1.0))
                .unwrap();
        try_solid(&Placed::new(Sphere::new(Point3::ORIGIN, 1.0).unwrap(), map), &mut dice, &mut touches);
        for form in [
            [1.0, 1.0, -1.0, -1.0],
            [1.0, 1.0, -1.0, 0.0],
            [1.0, 0.0, -1.0, -r],
            [1.0, 1.0, 0.0, -r * r],
            [1.0, 4.0, 1.0, -4.0],
        ] {
            try_solid(&quadric(form), &mut dice, &mut touches);
        }
    }
    assert!(touches > 400, "{touches}");
}

/// Two crossings of one solid at one point, where the ray touches a corner of a rim: a range that
/// ends just before it is completely outside.
#[test]
fn a_corner_that_is_touched_behind_the_range_says_nothing() {
    let outline = [
        [[0.0, 0.0], [16.0, 48.0], [32.0, -48.0], [48.0, 0.0]],
        [[48.0, 0.0], [48.0, 0.0], [48.0, 64.0], [48.0, 64.0]],
        [[48.0, 64.0], [32.0, 64.0], [16.0, 64.0], [0.0, 64.0]],
        [[0.0, 64.0], [0.0, 48.0], [0.0, 16.0], [0.0, 0.0]],
    ];
    let prism = CurvedPrism::linear(&[outline], -48.0, 16.0).unwrap();
    let mut builder = Geometry::builder();
    builder.add(prism);
    let world = builder.build().unwrap();
    let corner = Point3::new(0.0, -48.0, 0.0);
    let mut touched = 0;
    for x in -6..=6 {
        for y in -6..=6 {
            for z in -6..=6 {
                let d = Vec3::new(f64::from(x), f64::from(y), f64::from(z));
                if d == Vec3::ZERO {
                    continue;
                }
                let o = corner - d * 1024.0;
                let mut line = Ray::new(o, d);
                line.t_min = f64::NEG_INFINITY;
                let all = world.all(&line);
                let passes_by = all.iter().all(|h| h.t_lo <= 1024.0 && h.t_hi >= 1024.0);
                touched += usize::from(passes_by && all.len() == 2);
                for (t_min, t_max) in [(0.0, 1023.5), (0.0, 1024.0), (1024.0, 2000.0), (1024.5, 1e9)] {
                    let mut ray = line;
                    (ray.t_min, ray.t_max) = (t_min, t_max);
                    let spans = world.spans(&ray);
                    assert!(
                        !passes_by || spans.iter().all(|s| s.t_in == s.t_out),
                        "{d:?} from {t_min} to {t_max}: {spans:?}"
                    );
                    assert!(
                        spans.iter().all(|s| s.t_out <= 1400.0),
                        "{d:?} from {t_min} to {t_max}: {spans:?}"
                    );
                }
            }
        }
    }
    assert!(touched > 50, "{touched}");
}

/// The ray begins, or ends, exactly on the solid, next to a tangent, and its other crossing is
/// within the bracket of that one.
#[test]
fn crossings_at_the_ends_of_a_range_are_its_own() {
    let p = |x: f64, z: f64| [x, z];
    let outline: [Bezier; 4] = [
        [p(1.0, 0.0), p(1.0, 0.5), p(0.5, 1.0), p(0.0, 1.0)],
        [p(0.0, 1.0), p(-0.5, 1.0), p(-1.0, 0.5), p(-1.0, 0.0)],
        [p(-1.0, 0.0), p(-1.0, -0.5), p(-0.5, -1.0), p(0.0, -1.0)],
        [p(0.0, -1.0), p(0.5, -1.0), p(1.0, -0.5), p(1.0, 0.0)],
    ];
    let prism = CurvedPrism::linear(&[outline], -3.0, 1.0).unwrap();
    let turn = [[-6.0, 3.0, 2.0], [3.0, 2.0, 6.0], [2.0, 6.0, -3.0]];
    let place = Affine::new(turn, Point3::new(125.0, 1.0, 0.0)).unwrap();
    let mut builder = Geometry::builder();
    builder.add(Placed::new(prism, place));
    let world = builder.build().unwrap();
    let direction = Vec3::new(-0.7382812500000001, -0.24609375000000003, 0.7382812499999999);
    let ray = Ray::new(Point3::new(124.75, -7.1875, -5.3125), direction);
    let all = world.all(&ray);
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1]);
    assert!(all[0].t == 0.0 && all[1].t < 1e-15 && all[1].t_lo < all[0].t_hi);
    let spans = world.spans(&ray);
    assert!(spans.len() == 1 && spans[0].t_out == all[1].t, "{spans:?}");
    assert_eq!(check(&world, &ray), 1);
    // In reverse it ends exactly where it leaves the solid.
    let mut back = Ray::new(ray.origin, -direction);
    (back.t_min, back.t_max) = (f64::NEG_INFINITY, 0.0);
    let all = world.all(&back);
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1]);
    let spans = world.spans(&back);
    assert!(spans.len() == 1 && spans[0].t_in == all[0].t, "{spans:?}");
}

/// The line enters a spindle beside its apex and leaves it within rounding; it comes from outside
/// and goes there; its origin is in between. That has no influence on a range that begins
/// elsewhere.
#[test]
fn a_chord_within_rounding_does_not_tell_where_a_range_begins() {
    let lemon = SurfaceOfRevolution::lemon(10_485_760.0, 0.0, 0.0, 13_631_488.0).unwrap();
    // The matrices of the scene language have their vectors in rows.
    let rows = [[-2.0, 6.0, -3.0], [6.0, 3.0, 2.0], [-3.0, 2.0, 6.0]];
    let place = Affine::new(rows, Point3::new(0.125, 0.0, -7.0)).unwrap();
    let origin = Point3::new(0.125_000_015_910_094, 1.164_153_218_269_350_2e-9, -6.999_999_992_433_004);
    let line = Ray::new(
        origin,
        Vec3::new(0.674_438_476_562_499_8, -0.079_345_703_124_999_92, -0.109_863_281_250_000_04),
    );
    let world = |inverse: bool| {
        let placed = Placed::new(lemon.clone(), place);
        let mut builder = Geometry::builder();
        if inverse {
            builder.add(Complement(placed))
        } else {
            builder.add(placed)
        };
        builder.build().unwrap()
    };
    let (inside, outside) = (world(false), world(true));
    let all = outside.all(&line.with_range(f64::NEG_INFINITY, f64::INFINITY));
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [1, -1]);
    assert!(all[1].t_lo <= all[0].t_hi);
    for (from, to) in [
        (1.0, f64::INFINITY),
        (46_642_178.790_090_51, f64::INFINITY),
        (f64::NEG_INFINITY, -1.0),
        (1e-3, 2.0),
        (-9e9, -8e9),
    ] {
        let ray = line.with_range(from, to);
        let spans = outside.spans(&ray);
        assert_eq!(spans.iter().map(|s| (s.t_in, s.t_out)).collect::<Vec<_>>(), [(from, to)]);
        assert_eq!(inside.spans(&ray), []);
    }
}

/// The ray begins exactly on a cap and leaves by a wall right behind it, nearer than rounding can
/// separate: the order of the two is exact all the same.
#[test]
fn a_corner_is_entered_before_it_is_left() {
    let outline = [
        [2.403960159251622, 1.4586917601515559],
        [1.5088666215357396, -1.270402211590544],
        [-0.4087132169759826, 0.2616196643211026],
        [-0.5820618406018658, 1.2794396685511522],
        [1.0723507483269703, -1.6286417768591765],
        [-0.13053356180147002, 0.45807670117732036],
        [-0.10487786801705745, 1.1548640086972588],
    ];
    let prism = Prism::linear(&[outline], -1_048_576.0, 0.0).unwrap();
    let rows = [[0.00390625, 0.0, 0.0], [0.0, 256.0, 0.0], [0.0, 0.0, 256.0]];
    let place = Affine::new(rows, Point3::new(-7.0, 0.0, 0.125)).unwrap();
    let mut builder = Geometry::builder();
    builder.add(Placed::new(prism, place));
    let world = builder.build().unwrap();
    let origin = Point3::new(-7.001596536003812, -268_435_456.0, 67.09963406620227);
    let ray = Ray::new(origin, Vec3::new(0.005167173761796456, 1864.545349943433, -3947.5628113825423));
    let all = world.all(&ray);
    assert_eq!(all.iter().map(|h| h.sign).collect::<Vec<_>>(), [-1, 1]);
    assert!(all.iter().all(|h| h.t_lo <= h.t && h.t <= h.t_hi && h.t < 1e-11), "{all:?}");
    assert!(world.spans(&ray).iter().all(|span| span.t_out < 1e-11));
}

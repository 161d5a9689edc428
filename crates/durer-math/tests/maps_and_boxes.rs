//! Affine maps, boxes, unit vectors and combinations against exact rationals.
#![allow(missing_docs, reason = "a test program")]
#![allow(clippy::needless_range_loop, reason = "matrices are written with their indices")]

mod common;
use common::*;
use dashu::rational::RBig;
use durer_math::scale::ldexp;
use durer_math::{Aabb, Affine, AffineError, CombinationError, Dyadic, EFloat, Normal3, Point3, U, Vec3};
use proptest::prelude::*;

type Rat33 = [[RBig; 3]; 3];

fn rats(m: [[f64; 3]; 3]) -> Rat33 {
    m.map(|r| r.map(rat))
}

fn minor(m: &Rat33, a: usize, b: usize, c: usize, d: usize) -> RBig {
    &m[a][c] * &m[b][d] - &m[a][d] * &m[b][c]
}

fn determinant(m: &Rat33) -> RBig {
    &m[0][0] * minor(m, 1, 2, 1, 2) - &m[0][1] * minor(m, 1, 2, 0, 2) + &m[0][2] * minor(m, 1, 2, 0, 1)
}

/// The exact adjugate, by the schoolbook's signs.
fn adjugate(m: &Rat33) -> Rat33 {
    let others = |i: usize| match i {
        0 => (1, 2),
        1 => (0, 2),
        _ => (0, 1),
    };
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let ((a, b), (c, d)) = (others(j), others(i));
            let x = minor(m, a, b, c, d);
            if (i + j) % 2 == 0 { x } else { -x }
        })
    })
}

fn matrix(x: impl Strategy<Value = f64> + 'static) -> impl Strategy<Value = [[f64; 3]; 3]> {
    let row = triple(x).boxed();
    [row.clone(), row.clone(), row]
}

/// Matrices of all kinds: ordinary, badly scaled, nearly singular, integer.
fn matrices() -> impl Strategy<Value = [[f64; 3]; 3]> {
    let nearly_singular = (matrix(scaled(2)), -2..=2_i32, 0..60_i32).prop_map(|(m, k, shift)| {
        let last = core::array::from_fn(|j| nudge(m[0][j] + m[1][j], k) + ldexp(m[2][j], -shift));
        [m[0], m[1], last]
    });
    prop_oneof![3 => matrix(scaled(4)), 2 => matrix(small()), 2 => matrix(scaled(100)), 3 => nearly_singular, 1 => matrix(wild())]
}

proptest! {
    #![proptest_config(cases(3_000))]

    #[test]
    fn the_inverse_is_as_close_as_it_says(m in matrices(), c in triple(number())) {
        let exact = rats(m);
        let det = determinant(&exact);
        let map = Affine::new(m, Point3::from(c));
        if det.is_zero() {
            prop_assert_eq!(map, Err(AffineError::Singular(m)));
            return Ok(());
        }
        let adj = adjugate(&exact);
        let truth = |i: usize, j: usize| &adj[i][j] / &det;
        let Ok(map) = map else {
            let too_large = (0..3).any(|i| (0..3).any(|j| abs(truth(i, j)) > rat(f64::MAX)));
            prop_assert!(too_large, "{:?} refused", m);
            return Ok(());
        };
        prop_assert_eq!(map.determinant_is_negative(), det < RBig::ZERO);
        let (inverse, error) = (map.inverse_linear(), map.inverse_error());
        for i in 0..3 {
            for j in 0..3 {
                let (x, e) = (inverse[i][j], error[i][j]);
                prop_assert!(within(&rat(x), &truth(i, j), e));
                // Half an ulp, and hardly more: correctly rounded. At the bottom of the range, a
                // few of the least number.
                let half_ulp = 0.5 * (x.abs().next_up() - x.abs());
                prop_assert!(half_ulp == 0.0 || rat(e) <= rat(half_ulp * 1.001) + rat(f64::from_bits(64)), "{x:e} {e:e}");
                if rat(x) == truth(i, j) {
                    prop_assert_eq!(e, 0.0);
                }
            }
        }
    }

    #[test]
    fn the_adjugate_is_exact_and_positive(m in matrices()) {
        let Ok(map) = Affine::new(m, Point3::ORIGIN) else { return Ok(()) };
        let (adj, det) = map.adjugate::<Dyadic>();
        prop_assert!(det.exact_sign().is_gt());
        let l = map.linear().map(|r| r.map(Dyadic::from));
        for i in 0..3 {
            for j in 0..3 {
                let entry = &(&(&l[i][0] * &adj[0][j]) + &(&l[i][1] * &adj[1][j])) + &(&l[i][2] * &adj[2][j]);
                prop_assert_eq!(&entry, if i == j { &det } else { &Dyadic::ZERO });
            }
        }
        let (_, run) = map.adjugate::<EFloat>();
        let (lo, hi) = det.to_bounds();
        prop_assert!(run.lo() <= hi && lo <= run.hi());
    }

    #[test]
    fn images_keep_their_documented_bounds(m in matrix(scaled(4)), c in triple(scaled(6)), p in triple(scaled(6))) {
        let Ok(map) = Affine::new(m, Point3::from(c)) else { return Ok(()) };
        let exact = rats(m);
        let g = rat(durer_math::gamma(3));
        let (image, vector) = (map.point(p.into()), map.vector(p.into()));
        let reach = map.linear_reach(Vec3::from(p).abs());
        for i in 0..3 {
            let row: RBig = (0..3).map(|j| &exact[i][j] * rat(p[j])).fold(RBig::ZERO, |s, x| s + x);
            let size: RBig = (0..3).map(|j| abs(&exact[i][j] * rat(p[j]))).fold(RBig::ZERO, |s, x| s + x);
            prop_assert!(abs(rat(vector[i]) - &row) <= &g * &size);
            prop_assert!(abs(rat(image[i]) - &row - rat(c[i])) <= &g * (&size + abs(rat(c[i]))));
            prop_assert!(rat(reach[i]) >= size && rat(reach[i]) <= &size * rat(1.0 + 1e-14));
        }
        // Back again, within the inverse's documented error.
        let back = map.inverse_point(image);
        let det = determinant(&exact);
        let adj = adjugate(&exact);
        let q: [RBig; 3] = [0, 1, 2].map(|i| rat(image[i]) - rat(c[i]));
        let (inverse, error) = (map.inverse_linear(), map.inverse_error());
        let inverse_reach = map.inverse_reach(Vec3::from(p).abs());
        for i in 0..3 {
            let truth: RBig = (0..3).map(|j| &adj[i][j] * &q[j]).fold(RBig::ZERO, |s, x| s + x) / &det;
            let bound: RBig = (0..3)
                .map(|j| (rat(durer_math::gamma(4)) * rat(inverse[i][j].abs()) + rat(error[i][j])) * abs(q[j].clone()))
                .fold(RBig::ZERO, |s, x| s + x);
            prop_assert!(abs(rat(back[i]) - truth) <= bound);
            let size: RBig = (0..3).map(|j| abs(&adj[i][j] / &det * rat(p[j]))).fold(RBig::ZERO, |s, x| s + x);
            prop_assert!(rat(inverse_reach[i]) >= size);
        }
        // |L v| <= norm |v|, squared to stay rational.
        let square = |v: &dyn Fn(usize) -> RBig| (0..3).map(|i| v(i) * v(i)).fold(RBig::ZERO, |s, x| s + x);
        let v2 = square(&|j| rat(p[j]));
        let lv2 = square(&|i| (0..3).map(|j| &exact[i][j] * rat(p[j])).fold(RBig::ZERO, |s, x| s + x));
        prop_assert!(lv2 <= rat(map.linear_norm()) * rat(map.linear_norm()) * &v2);
        let iv2 = square(&|i| (0..3).map(|j| &adj[i][j] * rat(p[j])).fold(RBig::ZERO, |s, x| s + x) / &det);
        prop_assert!(iv2 <= rat(map.inverse_norm()) * rat(map.inverse_norm()) * v2);
        // The Frobenius norm of the exact inverse; the lower half of the bits is rounded upward.
        let sum: RBig = (0..9).map(|i| &adj[i / 3][i % 3] / &det).map(|x| &x * &x).fold(RBig::ZERO, |s, x| s + x);
        let norm2 = rat(map.inverse_norm()) * rat(map.inverse_norm());
        prop_assert!(sum <= norm2 && norm2 <= sum * rat(1.0 + durer_math::scale::pow2(-18)));
    }

    #[test]
    fn bounds_hold_the_image_of_every_corner(m in matrices(), c in triple(number()), p in triple(number()), q in triple(number()), s in triple(0.0..=1.0_f64)) {
        let Ok(map) = Affine::new(m, Point3::from(c)) else { return Ok(()) };
        let b = Aabb::from_points([Point3::from(p), Point3::from(q)]);
        let image = map.bounds(&b);
        let mut points = b.corners().to_vec();
        points.push(Point3::from(core::array::from_fn(|i| ((1.0 - s[i]) * b.min[i] + s[i] * b.max[i]).max(b.min[i]).min(b.max[i]))));
        let exact = rats(m);
        let coordinate = |x: Point3, i: usize| (0..3).map(|j| &exact[i][j] * rat(x[j])).fold(rat(c[i]), |s, x| s + x);
        for x in &points {
            for i in 0..3 {
                let y = coordinate(*x, i);
                prop_assert!(below(image.min[i], &y) && above(image.max[i], &y));
            }
        }
        // Not vacuous: each face is within a few roundings of a corner's image.
        for i in 0..3 {
            let least = points.iter().map(|x| coordinate(*x, i)).min().expect("corners");
            let size: RBig = (0..3).map(|j| abs(exact[i][j].clone()) * rat(b.magnitude())).fold(abs(rat(c[i])), |s, x| s + x);
            // Where a term can overflow its bound saturates: still a bound, but no longer a tight
            // one.
            if size <= rat(f64::MAX / 4.0) {
                prop_assert!(&least - rat(image.min[i]) <= &size * rat(16.0 * U) + rat(1e-320));
            }
        }
    }

    /// Wherever the exact line is in the exact box, the answer covers it.
    #[test]
    fn slabs_never_miss(b in boxes(), o in triple(number()), aim in triple(-0.1..=1.1_f64), direction in directions(), k in -2..=2_i32, range in ranges()) {
        // Half of the rays are aimed at a point of the box: at its corners and faces too, by the
        // generator's rounding to them.
        let target = |i: usize| {
            let s = aim[i].clamp(0.0, 1.0);
            nudge((1.0 - s) * b.min[i] + s * b.max[i], k)
        };
        let d = direction.unwrap_or_else(|| core::array::from_fn(|i| target(i) - o[i]));
        if d.iter().any(|x| !x.is_finite()) || d == [0.0; 3] {
            return Ok(());
        }
        check_slabs(b, o, d, range)?;
    }

    /// Flat boxes, integer rays in faces, along edges and through corners; signed zeros in the
    /// direction.
    #[test]
    fn slabs_never_miss_on_a_grid(p in triple(small()), q in triple(small()), o in triple(small()), d in triple(prop_oneof![small(), Just(-0.0)])) {
        if d != [0.0; 3] {
            check_slabs(Aabb::from_points([Point3::from(p), Point3::from(q)]), o, d, (0.0, f64::INFINITY))?;
        }
    }

    #[test]
    fn unit_vectors_are_close_to_unit(v in prop_oneof![triple(number()), triple(wild()), triple(scaled(1000))]) {
        let v = Vec3::from(v);
        let Some(n) = v.normalized() else { prop_assert_eq!(v, Vec3::ZERO); return Ok(()) };
        let square: RBig = (0..3).map(|i| rat(v[i]) * rat(v[i])).fold(RBig::ZERO, |s, x| s + x);
        for i in 0..3 {
            // |n_i - v_i / |v|| <= 4 U |v_i| / |v|, by squares:
            // (n_i |v| / v_i)^2 within (1 +- 4 U)^2.
            let truth = rat(v[i]) * rat(v[i]);
            let got = rat(n[i]) * rat(n[i]) * &square;
            let tiny = rat(f64::MIN_POSITIVE) * rat(f64::MIN_POSITIVE) * &square;
            prop_assert!(abs(&got - &truth) <= &truth * rat(8.1 * U) + tiny, "{v:?} {n:?}");
        }
        prop_assert_eq!(Normal3::new(v.x, v.y, v.z).normalized(), Some(n.to_normal()));
        let (s, t) = n.orthonormal_basis();
        let near = |x: f64, y: f64| (x - y).abs() < 16.0 * U;
        prop_assert!(near(s.dot(s), 1.0) && near(t.dot(t), 1.0) && near(s.dot(t), 0.0));
        prop_assert!(near(s.dot(n), 0.0) && near(t.dot(n), 0.0));
        let c = s.cross(t);
        prop_assert!(near(c.x, n.x) && near(c.y, n.y) && near(c.z, n.z));
    }

    #[test]
    fn affine_combinations_do_not_depend_on_the_origin(p in triple(scaled(4)), q in triple(scaled(4)), r in triple(scaled(4)), s in 0.0..1.0_f64, t in 0.0..1.0_f64) {
        let points = [p, q, r].map(Point3::from);
        let weights = [1.0 - s, s * (1.0 - t), s * t];
        let mix = Point3::affine(&[(weights[0], points[0]), (weights[1], points[1]), (weights[2], points[2])]);
        let mix = mix.expect("the weights sum to 1 within their rounding");
        for i in 0..3 {
            let truth = (0..3).map(|k| rat(weights[k]) * rat(points[k][i])).fold(RBig::ZERO, |s, x| s + x);
            let size = points.iter().map(|p| p[i].abs()).fold(0.0, f64::max);
            prop_assert!(abs(rat(mix[i]) - truth) <= rat(16.0 * U * size));
        }
        let l = points[0].lerp(points[1], s);
        let truth = |i: usize| rat(p[i]) + rat(s) * (rat(q[i]) - rat(p[i]));
        prop_assert!((0..3).all(|i| abs(rat(l[i]) - truth(i)) <= rat(4.0 * U * p[i].abs().max(q[i].abs()))));
        prop_assert_eq!(points[0].lerp(points[1], 0.0), points[0]);
        prop_assert_eq!(points[0].lerp(points[1], 1.0), points[1]);
        prop_assert_eq!(Point3::affine(&[(0.25, points[0]), (0.75, points[0])]), Ok(points[0]));
        let wrong = Point3::affine(&[(0.5, points[0]), (0.5 + 1e-12, points[1])]);
        prop_assert!(matches!(wrong, Err(CombinationError::Weights(_))));
    }
}

fn boxes() -> impl Strategy<Value = Aabb> {
    let points = |p: [f64; 3], q: [f64; 3]| Aabb::from_points([Point3::from(p), Point3::from(q)]);
    let flat = (triple(number()), triple(number()), 0..3_usize).prop_map(move |(p, mut q, axis)| {
        q[axis] = p[axis];
        points(p, q)
    });
    prop_oneof![3 => (triple(number()), triple(number())).prop_map(move |(p, q)| points(p, q)), 1 => flat]
}

fn directions() -> impl Strategy<Value = Option<[f64; 3]>> {
    prop_oneof![2 => Just(None), 1 => triple(number()).prop_map(Some)]
}

fn ranges() -> impl Strategy<Value = (f64, f64)> {
    prop_oneof![
        3 => Just((0.0, f64::INFINITY)),
        1 => Just((f64::NEG_INFINITY, f64::INFINITY)),
        2 => (number(), number()).prop_map(|(a, b)| (a.min(b), a.max(b))),
    ]
}

fn check_slabs(b: Aabb, o: [f64; 3], d: [f64; 3], range: (f64, f64)) -> Result<(), TestCaseError> {
    let answer = b.slabs(Point3::from(o), Vec3::from(d), range.0, range.1);
    let finite = |x: f64| x.is_finite().then(|| rat(x));
    let (mut enter, mut leave) = (finite(range.0), finite(range.1));
    let mut misses = false;
    for i in 0..3 {
        let (lo, hi) = (rat(b.min[i]) - rat(o[i]), rat(b.max[i]) - rat(o[i]));
        if d[i] == 0.0 {
            misses |= lo > RBig::ZERO || hi < RBig::ZERO;
            continue;
        }
        let (s, t) = (lo / rat(d[i]), hi / rat(d[i]));
        let (near, far) = if s <= t { (s, t) } else { (t, s) };
        enter = Some(enter.map_or(near.clone(), |e| e.max(near)));
        leave = Some(leave.map_or(far.clone(), |l| l.min(far)));
    }
    let (Some(enter), Some(leave)) = (enter, leave) else { return Ok(()) };
    if misses || enter > leave {
        // A miss may be reported as a hit, but only by a few roundings.
        if let Some((lo, hi)) = answer.filter(|_| !misses) {
            let size = abs(enter.clone()).max(abs(leave.clone()));
            prop_assert!(rat(lo.clamp(f64::MIN, f64::MAX)) <= rat(hi.clamp(f64::MIN, f64::MAX)));
            prop_assert!(&enter - &leave <= size * rat(16.0 * U) + rat(4.0 * f64::MIN_POSITIVE));
        }
        prop_assert!(!misses || answer.is_none());
        return Ok(());
    }
    let Some((lo, hi)) = answer else {
        return Err(TestCaseError::fail(format!("false miss: {b:?} from {o:?} along {d:?} in {range:?}")));
    };
    prop_assert!(below(lo, &enter) && above(hi, &leave), "{lo:e} {hi:e} do not cover");
    // Tight: eight roundings of each end.
    let close = |x: f64, y: &RBig| {
        !x.is_finite() || abs(rat(x) - y) <= abs(y.clone()) * rat(8.0 * U) + rat(4.0 * f64::MIN_POSITIVE)
    };
    prop_assert!(close(lo, &enter) && close(hi, &leave), "{lo:e} {hi:e} are loose");
    Ok(())
}

#[test]
fn rotations_are_the_standard_ones() {
    let right = core::f64::consts::FRAC_PI_2;
    let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-15;
    let x = Affine::rotation_x(right).unwrap();
    let y = Affine::rotation_y(right).unwrap();
    let z = Affine::rotation_z(right).unwrap();
    assert!(near(x.vector(Vec3::Y), Vec3::Z));
    assert!(near(y.vector(Vec3::X), -Vec3::Z));
    assert!(near(z.vector(Vec3::X), Vec3::Y));
    for (axis, map) in [(Vec3::X, x), (Vec3::Y, y), (Vec3::Z, z)] {
        let general = Affine::rotation(axis * 7.0, right).unwrap();
        for v in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(near(general.vector(v), map.vector(v)));
        }
    }
    let third = Affine::rotation(Vec3::new(1.0, 1.0, 1.0), 4.0 * right / 3.0).unwrap();
    assert!(near(third.vector(Vec3::X), Vec3::Y) && near(third.vector(Vec3::Y), Vec3::Z));
}

#[test]
fn maps_compose_in_the_order_written() {
    let scale = Affine::scaling(2.0, 3.0, 4.0).unwrap();
    let shift = Affine::translation(Vec3::new(1.0, 1.0, 1.0)).unwrap();
    let p = Point3::new(1.0, 1.0, 1.0);
    assert_eq!(scale.then(&shift).unwrap().point(p), Point3::new(3.0, 4.0, 5.0));
    assert_eq!(shift.then(&scale).unwrap().point(p), Point3::new(4.0, 6.0, 8.0));
    assert_eq!(shift.as_translation(), Some(Vec3::new(1.0, 1.0, 1.0)));
    assert_eq!(scale.as_translation(), None);
    assert_eq!(Affine::scaling(3.0, 3.0, 3.0).unwrap().as_uniform_scale(), Some(3.0));
    assert_eq!(Affine::scaling(-3.0, -3.0, -3.0).unwrap().as_uniform_scale(), None);
    let there_and_back = scale.then(&scale.inverted().unwrap()).unwrap();
    assert!((there_and_back.point(p) - p).length() < 1e-15);
    // A normal is orthogonal to the images of its plane's vectors.
    let n = scale.normal(Normal3::new(1.0, 1.0, 0.0));
    assert!(n.dot(scale.vector(Vec3::new(1.0, -1.0, 0.0))).abs() < 1e-15);
    assert_eq!(scale.inverse_normal(n), Normal3::new(1.0, 1.0, 0.0));
}

#[test]
fn a_bad_map_is_named() {
    let bad = |rows, centre| Affine::new(rows, centre).unwrap_err().to_string();
    let mut rows = Affine::IDENTITY.linear();
    rows[1][2] = f64::NAN;
    assert!(bad(rows, Point3::ORIGIN).contains("entry (1, 2)"));
    assert!(bad(Affine::IDENTITY.linear(), Point3::new(0.0, f64::INFINITY, 0.0)).contains("axis 1"));
    let flat = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
    assert_eq!(Affine::new(flat, Point3::ORIGIN), Err(AffineError::Singular(flat)));
    // Of rank one and zero, with zeros of both signs: all cofactors are zero.
    for zero in [0.0, -0.0] {
        for (x, y) in [(1.0, zero), (-2.0, zero), (zero, zero)] {
            let flat = [[x, 2.0 * x, zero], [y, zero, zero], [zero, y, zero]];
            assert_eq!(Affine::new(flat, Point3::ORIGIN), Err(AffineError::Singular(flat)));
            assert!(Affine::scaling(zero, x, zero).is_err() && Affine::scaling(zero, zero, zero).is_err());
        }
    }
    // Singular in f64, not exactly: 0.1 * 3 is not 0.3.
    let nearly = [[0.1, 0.3, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 1.0]];
    assert!(Affine::new(nearly, Point3::ORIGIN).is_ok());
    assert!(matches!(Affine::scaling(1e-320, 1.0, 1.0), Err(AffineError::Inverse(_))));
    assert!(Affine::scaling(1e-300, 1e300, 1.0).is_ok());
    assert_eq!(Affine::rotation(Vec3::ZERO, 1.0), Err(AffineError::Axis(Vec3::ZERO)));
    assert!(matches!(Affine::rotation_x(f64::NAN), Err(AffineError::Angle(_))));
    let far = Affine::translation(Vec3::X * 1e308).unwrap();
    assert!(matches!(far.then(&far), Err(AffineError::Translation { axis: 0, .. })));
}

#[test]
fn unbounded_and_empty_boxes_are_bounds_too() {
    let o = Point3::new(1.0, 2.0, 3.0);
    assert_eq!(Aabb::UNBOUNDED.slabs(o, Vec3::X, 0.0, f64::INFINITY), Some((0.0, f64::INFINITY)));
    assert_eq!(Aabb::UNBOUNDED.slabs(o, -Vec3::X, -5.0, 5.0), Some((-5.0, 5.0)));
    assert_eq!(Aabb::EMPTY.slabs(o, Vec3::X, 0.0, f64::INFINITY), None);
    assert!(Aabb::EMPTY.is_empty() && !Aabb::EMPTY.is_bounded() && !Aabb::UNBOUNDED.is_bounded());
    let half_space =
        Aabb::new(Point3::new(5.0, f64::NEG_INFINITY, 0.0), Point3::new(f64::INFINITY, f64::INFINITY, 9.0));
    let (enter, leave) = half_space.slabs(o, Vec3::X, 0.0, f64::INFINITY).unwrap();
    assert!(enter <= 4.0 && enter > 3.999 && leave == f64::INFINITY);
    assert_eq!(half_space.slabs(o, -Vec3::X, 0.0, f64::INFINITY), None);
    let turned = Affine::rotation_z(0.5).unwrap();
    assert_eq!(turned.bounds(&Aabb::EMPTY), Aabb::EMPTY);
    let image = turned.bounds(&Aabb::UNBOUNDED);
    assert_eq!(image, Aabb::UNBOUNDED);
    assert_eq!(Aabb::EMPTY.union(half_space), half_space);
    assert!(half_space.intersection(Aabb::from_points([Point3::ORIGIN])).is_empty());
    let cube = Aabb::centred(Point3::ORIGIN, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(
        (cube.half_area(), cube.centre(), cube.widths()),
        (44.0, Point3::ORIGIN, Vec3::new(4.0, 4.0, 6.0) - Vec3::X * 2.0)
    );
    assert!(cube.encloses(&Aabb::from_points(cube.corners())) && !half_space.encloses(&cube));
    assert!(cube.reach_from(Point3::new(2.0, 2.0, 3.0)) >= 61.0_f64.sqrt());
}

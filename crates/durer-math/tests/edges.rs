//! The edge predicate against exact rationals, and parity on closed meshes.
#![allow(missing_docs, reason = "a test program")]

mod common;
use common::*;
use core::cmp::Ordering;
use dashu::rational::RBig;
use durer_math::{EdgeRay, Point3, Vec3};
use proptest::prelude::*;

type Rat3 = [RBig; 3];

fn rat3(v: [f64; 3]) -> Rat3 {
    v.map(rat)
}

fn sub(a: &Rat3, b: &Rat3) -> Rat3 {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn cross(a: &Rat3, b: &Rat3) -> Rat3 {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

fn dot(a: &Rat3, b: &Rat3) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sign(x: &RBig) -> i8 {
    x.cmp(&RBig::ZERO) as i8
}

/// The axes other than the first on which `|d|` is largest.
fn axes(d: [f64; 3]) -> [usize; 2] {
    let m = d.map(f64::abs);
    let k = (0..3).fold(0, |k, i| if m[i] > m[k] { i } else { k });
    [[1, 2], [0, 2], [0, 1]][k]
}

/// `U` and the sign by the documented rule, both exactly.
fn witness(o: [f64; 3], d: [f64; 3], v1: [f64; 3], v2: [f64; 3]) -> (RBig, i8) {
    let [ro, rd, r1, r2] = [o, d, v1, v2].map(rat3);
    let u = dot(&rd, &cross(&sub(&r2, &ro), &sub(&r1, &ro)));
    let slope = cross(&sub(&r2, &r1), &rd);
    let [a, b] = axes(d);
    let signs = [sign(&u), sign(&slope[a]), sign(&slope[b])];
    (u, signs.into_iter().find(|&s| s != 0).unwrap_or(0))
}

fn point(p: [f64; 3]) -> Point3 {
    p.into()
}

fn check_edge(o: [f64; 3], d: [f64; 3], v1: [f64; 3], v2: [f64; 3]) -> Result<(), TestCaseError> {
    let ray = EdgeRay::new(point(o), Vec3::from(d));
    let (u, expected) = witness(o, d, v1, v2);
    for edge in [ray.edge(point(v1), point(v2)), ray.exact_edge(point(v1), point(v2))] {
        prop_assert_eq!(edge.sign, expected);
        prop_assert!(!edge.value.is_finite() || within(&rat(edge.value), &u, edge.error), "{:?}", edge);
    }
    prop_assert_eq!(ray.edge(point(v2), point(v1)).sign, -expected);
    Ok(())
}

proptest! {
    #![proptest_config(cases(5_000))]

    #[test]
    fn edges_between_any_points(o in triple(number()), d in triple(number()), v1 in triple(number()), v2 in triple(number())) {
        check_edge(o, d, v1, v2)?;
    }

    #[test]
    fn edges_on_a_grid_where_ties_abound(o in triple(small()), d in triple(small()), v1 in triple(small()), v2 in triple(small())) {
        check_edge(o, d, v1, v2)?;
    }

    #[test]
    fn edges_at_the_ends_of_the_exponent_range(o in triple(wild()), d in triple(wild()), v1 in triple(wild()), v2 in triple(wild())) {
        check_edge(o, d, v1, v2)?;
    }

    /// The ray passes through a rounded point of the edge: only the last bits decide.
    #[test]
    fn edges_aimed_at(o in triple(scaled(3)), v1 in triple(scaled(3)), v2 in triple(scaled(3)), s in 0.0..1.0_f64, k in -2..=2_i32) {
        let target: [f64; 3] = core::array::from_fn(|i| nudge((1.0 - s) * v1[i] + s * v2[i], k));
        check_edge(o, core::array::from_fn(|i| target[i] - o[i]), v1, v2)?;
    }

    /// Tiny grids: every product underflows.
    #[test]
    fn edges_on_subnormal_grids(o in triple(small()), d in triple(small()), v1 in triple(small()), v2 in triple(small()), k in 900..1070_i32) {
        let shrink = |p: [f64; 3]| p.map(|x| durer_math::scale::ldexp(x, -k));
        check_edge(shrink(o), d, shrink(v1), shrink(v2))?;
        check_edge(shrink(o), shrink(d), shrink(v1), shrink(v2))?;
    }

    #[test]
    fn the_filter_is_close_to_the_rounding_it_bounds(o in triple(scaled(1)), d in triple(scaled(1)), v1 in triple(scaled(1)), v2 in triple(scaled(1))) {
        // Seven units of the permanent, and no more than 2 permille on top.
        let (_, error) = EdgeRay::new(point(o), Vec3::from(d)).filter(point(v1), point(v2));
        let [ro, rd, r1, r2] = [o, d, v1, v2].map(rat3);
        let [a, b] = [sub(&r1, &ro), sub(&r2, &ro)].map(|v| v.map(abs));
        let permanent: RBig = (0..3).map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            abs(rd[i].clone()) * (&a[j] * &b[k] + &a[k] * &b[j])
        }).fold(RBig::ZERO, |s, x| s + x);
        prop_assert!(rat(error) <= permanent * rat(7.014 * durer_math::U));
    }

    #[test]
    fn sides_of_planes(o in triple(number()), d in triple(number()), v in [triple(number()), triple(number()), triple(number())]) {
        check_side(o, d, v)?;
    }

    #[test]
    fn sides_of_planes_on_a_grid(o in triple(small()), d in triple(small()), v in [triple(small()), triple(small()), triple(small())]) {
        check_side(o, d, v)?;
    }
}

fn check_side(o: [f64; 3], d: [f64; 3], v: [[f64; 3]; 3]) -> Result<(), TestCaseError> {
    let ray = EdgeRay::new(point(o), Vec3::from(d));
    let [r0, r1, r2] = v.map(rat3);
    let n = cross(&sub(&r1, &r0), &sub(&r2, &r0));
    let [a, b] = axes(d);
    let terms = [dot(&n, &sub(&rat3(o), &r0)), n[a].clone(), n[b].clone(), dot(&n, &rat3(d))];
    let expected = terms.iter().map(sign).find(|&s| s != 0).unwrap_or(0);
    let side = ray.side(point(v[0]), point(v[1]), point(v[2]));
    prop_assert_eq!(side, expected);
    prop_assert_eq!(ray.side(point(v[0]), point(v[2]), point(v[1])), -expected);
    Ok(())
}

/// A closed mesh as unwelded triangles.
type Mesh = Vec<[Point3; 3]>;

/// The octahedron |x| + |y| + |z| = n with n^2 triangles per face, all vertices on the integer
/// grid.
fn octahedron(n: i32) -> Mesh {
    let mut mesh = Mesh::new();
    for octant in 0..8 {
        let s = [0, 1, 2].map(|i| if octant >> i & 1 == 0 { 1.0 } else { -1.0 });
        let vertex = |i: i32, j: i32| {
            let p = [i, j, n - i - j].map(f64::from);
            Point3::new(p[0] * s[0], p[1] * s[1], p[2] * s[2])
        };
        let mirrored = s[0] * s[1] * s[2] < 0.0;
        let mut push = |a, b, c| mesh.push(if mirrored { [a, c, b] } else { [a, b, c] });
        for i in 0..n {
            for j in 0..n - i {
                push(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
                if i + j + 1 < n {
                    push(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
                }
            }
        }
    }
    mesh
}

/// The cube [-n, n]^3 in squares of side 2, each cut along a diagonal that alternates.
fn cube(n: i32) -> Mesh {
    let mut mesh = Mesh::new();
    for axis in 0..3 {
        for side in [-n, n] {
            for i in (-n..n).step_by(2) {
                for j in (-n..n).step_by(2) {
                    let at = |u: i32, v: i32| {
                        let mut p = [0.0; 3];
                        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side.into(), u.into(), v.into());
                        point(p)
                    };
                    let q = [at(i, j), at(i + 2, j), at(i + 2, j + 2), at(i, j + 2)];
                    let cut = if (i + j) & 2 == 0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] };
                    for [a, b, c] in cut {
                        mesh.push(if side > 0 { [q[a], q[b], q[c]] } else { [q[a], q[c], q[b]] });
                    }
                }
            }
        }
    }
    mesh
}

/// Each triangle begins at another of its vertices, and the triangles change places: a rule by
/// index would now leak.
fn shuffled(mut mesh: Mesh, seed: u64) -> Mesh {
    let mut random = generator(seed);
    for i in (1..mesh.len()).rev() {
        mesh.swap(i, random(i as u64 + 1) as usize);
        mesh[i].rotate_left(random(3) as usize);
    }
    mesh
}

fn generator(mut state: u64) -> impl FnMut(u64) -> u64 {
    move |below| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    }
}

/// The signs (+1 leaving, -1 entering, by the outward normal) of the faces that the ray crosses at
/// `t > 0`, and of those that its line crosses at all.
fn crossings(ray: &EdgeRay, mesh: &Mesh) -> (Vec<i8>, Vec<i8>) {
    let (mut ahead, mut line) = (Vec::new(), Vec::new());
    for &[a, b, c] in mesh {
        let u = ray.edge(b, c).sign;
        if u != 0 && ray.edge(c, a).sign == u && ray.edge(a, b).sign == u {
            // The edges' sign is that of -n.d.
            line.push(-u);
            if ray.side(a, b, c) == u {
                ahead.push(-u);
            }
        }
    }
    (ahead, line)
}

/// Integer rays through vertices, along edges and in faces: parity is exact, and enters and leaves
/// balance.
fn check_parity(
    mesh: &Mesh,
    half: i32,
    inside: impl Fn([f64; 3]) -> Option<bool>,
    rays: usize,
    seed: u64,
) -> usize {
    let mut random = generator(seed);
    let mut tested = 0;
    for _ in 0..rays {
        let mut triple = |m: i32| [0; 3].map(|_: i32| f64::from(random(2 * m as u64 + 1) as i32 - m));
        let (o, target) = (triple(half + 2), triple(half));
        let d: [f64; 3] = core::array::from_fn(|i| target[i] - o[i]);
        if d == [0.0; 3] {
            continue;
        }
        let ray = EdgeRay::new(point(o), Vec3::from(d));
        let (ahead, line) = crossings(&ray, mesh);
        assert_eq!(line.len() % 2, 0, "the line through {o:?} along {d:?} crosses {} faces", line.len());
        assert_eq!(line.iter().map(|&s| i32::from(s)).sum::<i32>(), 0);
        if let Some(inside) = inside(o) {
            assert_eq!(ahead.len() % 2 == 1, inside, "from {o:?} along {d:?}: {ahead:?}");
            assert_eq!(ahead.iter().map(|&s| i32::from(s)).sum::<i32>(), i32::from(inside));
        } else {
            // The origin lies on the mesh: moved symbolically, it is inside or outside, and nothing
            // else.
            assert!((0..=1).contains(&ahead.iter().map(|&s| i32::from(s)).sum::<i32>()), "{o:?} {d:?}");
        }
        tested += 1;
    }
    tested
}

#[test]
fn integer_rays_cross_an_octahedron_an_even_number_of_times() {
    let mesh = shuffled(octahedron(4), 7);
    assert_eq!(mesh.len(), 8 * 16);
    let inside = |o: [f64; 3]| match o.iter().map(|x| x.abs()).sum::<f64>().total_cmp(&4.0) {
        Ordering::Less => Some(true),
        Ordering::Equal => None,
        Ordering::Greater => Some(false),
    };
    assert!(check_parity(&mesh, 4, inside, 24_000, 1) > 23_667);
}

#[test]
fn integer_rays_cross_a_cube_an_even_number_of_times() {
    let mesh = shuffled(cube(4), 8);
    let inside = |o: [f64; 3]| match o.iter().fold(0.0_f64, |m, x| m.max(x.abs())).total_cmp(&4.0) {
        Ordering::Less => Some(true),
        Ordering::Equal => None,
        Ordering::Greater => Some(false),
    };
    assert!(check_parity(&mesh, 4, inside, 24_000, 2) > 23_667);
}

/// The parity law on a scale where the filter and the expansions fail.
#[test]
fn parity_holds_on_a_subnormal_octahedron() {
    let shrink = |p: Point3| p.map(|x| durer_math::scale::ldexp(x, -1070));
    let mesh: Mesh = octahedron(2).into_iter().map(|t| t.map(shrink)).collect();
    let mut random = generator(3);
    for _ in 0..300 {
        let mut triple = || [0; 3].map(|_: i32| f64::from(random(7) as i32 - 3));
        let (o, d) = (triple(), triple());
        let ray = EdgeRay::new(shrink(point(o)), Vec3::from(d));
        assert_eq!(crossings(&ray, &mesh).1.len() % 2, 0);
    }
}

/// The naive rule, zero counts as positive (inclusive edges), miscounts on these rays; so the rays
/// do test ties.
#[test]
fn the_rays_of_the_parity_test_do_meet_ties() {
    let mesh = octahedron(4);
    let mut random = generator(1);
    let mut wrong = 0;
    for _ in 0..1000 {
        let mut triple = |m: i32| [0; 3].map(|_: i32| f64::from(random(2 * m as u64 + 1) as i32 - m));
        let (o, target) = (triple(6), triple(4));
        let d: [f64; 3] = core::array::from_fn(|i| target[i] - o[i]);
        let ray = EdgeRay::new(point(o), Vec3::from(d));
        let inclusive = |&[a, b, c]: &[Point3; 3]| {
            let u = [ray.edge(b, c).value, ray.edge(c, a).value, ray.edge(a, b).value];
            u.iter().all(|&x| x >= 0.0) || u.iter().all(|&x| x <= 0.0)
        };
        wrong += usize::from(d != [0.0; 3] && mesh.iter().filter(|t| inclusive(t)).count() % 2 == 1);
    }
    assert!(wrong > 100, "only {wrong} of 1000 rays meet an odd number of closed triangles");
}

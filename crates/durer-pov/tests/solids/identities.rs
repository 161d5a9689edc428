//! Identities of sets, tested on solids, crossing by crossing and bit by bit: `A - A` is empty,
//! `A | A = A`, De Morgan's laws, `A - (A - B) = A & B`.

use super::{Draws, lowered};
use durer_math::{Point3, Ray, Vec3};
use durer_scene::Lowered;
use durer_testkit::TestRng;

/// Every kind of solid, placed so that many have faces, edges and tangent planes in common.
const KINDS: [(&str, &str); 54] = [
    ("ball", "sphere { <0.5, 0, 0>, 1.25 }"),
    ("block", "box { <-1, -0.5, -1>, <1, 1, 0.5> }"),
    ("turned block", "box { <-1, -0.5, -1>, <1, 1, 0.5> rotate <20, 30, 40> }"),
    ("rod", "cylinder { -0.5*y, y, 0.75 }"),
    ("slanted rod", "cylinder { <-1, -0.5, 0>, <1, 1, 0.5>, 0.5 }"),
    ("cone", "cone { -0.5*y, 1, y, 0 }"),
    ("frustum", "cone { -0.5*y, 1, y, 0.25 }"),
    ("half-space", "plane { y, 0.25 }"),
    ("slanted half-space", "plane { <3, 4, 0>, 0.5 }"),
    ("ellipsoid", "sphere { 0, 1 scale <1.25, 0.75, 1> rotate z*30 }"),
    ("spheroid", "spheroid { 1, 0.5 }"),
    ("quadric of one sheet", "quadric { <1, 1, -1>, 0, 0, -0.25 }"),
    ("quadric of two sheets", "quadric { <1, -1, 1>, 0, 0, 0.25 }"),
    ("saddle", "quadric { <1, -1, 0>, 0, <0, 0, -1>, 0 }"),
    ("quadric, a slab", "quadric { <0, 1, 0>, 0, 0, -0.25 }"),
    ("capped paraboloid", "paraboloid { 1, 1, from 0 to 1 rotate x*-90 }"),
    ("capped hyperboloid", "hyperboloid { <0.5, 0.5, 1>, sheets 1, from -0.5 to 1 rotate x*-90 }"),
    ("capped hyperboloids", "hyperboloid { <0.5, 0.5, 0.5>, sheets 2, from -1 to 1 rotate x*-90 }"),
    ("capped elliptic cylinder", "elliptic_cylinder { <1, 0.5>, from -0.5 to 1 rotate x*-90 }"),
    ("capped hyperbolic cylinder", "hyperbolic_cylinder { <0.5, 0.5>, from -0.5 to 1 rotate x*-90 }"),
    ("capped cone", "circular_cone { 1, 1, from -1 to 1 rotate x*-90 }"),
    ("spherical sector", "spherical_sector { -0.5*y, 1.5, y, 45 }"),
    ("ring", "torus { 1, 0.25 }"),
    ("horn", "torus { 0.75, 0.75 }"),
    ("spindle", "torus { 0.5, 0.75 }"),
    ("elliptic torus", "torus { 1, 0.25 scale <1, 2, 0.75> }"),
    ("cyclide, a ring", "cyclide { 1, 0.25, 0.5 }"),
    ("cyclide, a horn", "cyclide { 1, 0.5, 0.25 }"),
    ("cyclide, a spindle", "cyclide { 0.5, 0.25, 0.75 }"),
    ("cubic", "cubic { <1,0,0,0,0, 0,0,0,0,0, 0,0,0,0,0, 1,0,0,-1,0> }"),
    ("quartic", "polynomial { 4, xyz(4,0,0): 1, xyz(0,4,0): 1, xyz(0,0,4): 1, xyz(0,0,0): -1 }"),
    (
        "sextic",
        "polynomial { 6, xyz(6,0,0): 1, xyz(0,4,0): 1, xyz(0,0,2): 1, xyz(0,2,2): 0.5, xyz(0,0,0): -1 }",
    ),
    ("lathe of lines", "lathe { linear_spline 5, <0, -0.5>, <1, -0.5>, <0.5, 0.25>, <1, 1>, <0, 1> }"),
    ("lathe", "lathe { cubic_spline 6, <0.5, -1>, <0, -1>, <1, -0.5>, <0.25, 0.25>, <0, 1>, <-0.5, 1> }"),
    (
        "sphere sweep of lines",
        "sphere_sweep { linear_spline 3, <-1, 0, 0>, 0.25, <0, 0.5, 0>, 0.5, <1, 0, 0.5>, 0 }",
    ),
    (
        "sphere sweep",
        "sphere_sweep { b_spline 5, <-1, 0, 0>, 0.5, <0, 1, 0>, 0.5, <1, 0, 0>, 0.25, <0, -1, 0.5>, 0.5, <-1, 0, 1>, 0.5 }",
    ),
    ("superellipsoid", "superellipsoid { <0.5, 0.25> }"),
    ("star", "superellipsoid { <2.5, 1> }"),
    (
        "blob",
        "blob { threshold 0.5 sphere { <-0.5, 0, 0>, 1, 1 } sphere { <0.5, 0.25, 0>, 1, 1 } cylinder { -y, y, 0.5, -0.5 } }",
    ),
    ("prism", "prism { -0.5, 1, 7, <-1, -1>, <1, -1>, <1, 0>, <0, 0>, <0, 1>, <-1, 1>, <-1, -1> }"),
    ("star prism", "prism { -0.5, 1, 6, <0, 1>, <0.5, -1>, <-1, 0.25>, <1, 0.25>, <-0.5, -1>, <0, 1> }"),
    (
        "sweep",
        "sweep { profile linear_spline 4, <-1, -1>, <1, -1>, <0, 1>, <-1, -1> path linear_spline 2, <0, -0.5, 0>, <0.25, 0.75, 1> }",
    ),
    (
        "conic sweep",
        "sweep { profile linear_spline 4, <-1, -1>, <1, -1>, <0, 1>, <-1, -1> path linear_spline 2, <0, -0.5, 0>, <0.25, 0.75, 1> size 2, 0.5, 1 }",
    ),
    ("conic prism", "prism { conic_sweep 0, 1, 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> }"),
    ("sor", "sor { 6, <0.5, -1>, <0.75, -0.5>, <1, 0>, <0.5, 0.5>, <0.75, 1>, <1, 1.5> }"),
    ("ovus", "ovus { 0.75, 0.5 }"),
    ("lemon", "lemon { -0.5*y, 0.5, y, 0.25, 1.25 }"),
    ("sponge of Menger", "ifs { menger 2 }"),
    (
        "ifs of balls",
        "ifs { sphere { 0, 1 } map { scale 0.5 translate x*0.5 } map { scale 0.6 rotate z*40 } depth 2 }",
    ),
    (
        "isosurface in a box",
        "isosurface { function { x*x + y*y*y - z } threshold 0.25 contained_by { box { <-1, -0.5, -1>, <1, 1, 0.5> } } }",
    ),
    (
        "isosurface in a ball",
        "isosurface { function { sin(2*x) + cos(3*y)*z } contained_by { sphere { 0, 1.25 } } }",
    ),
    ("Julia set", "julia_fractal { <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 5 }"),
    (
        "mesh",
        "mesh { triangle { x, y, z } triangle { y, -x, z } triangle { -x, -y, z } triangle { -y, x, z } triangle { y, x, -z } triangle { -x, y, -z } triangle { -y, -x, -z } triangle { x, -y, -z } inside_vector <0.25, 0.5, 1> }",
    ),
    ("twisted block", "deform { box { <-0.5, -0.5, -0.5>, <0.5, 1, 0.5> } twist { y, 90, from -0.5 to 1 } }"),
];

/// The hits without the names of leaves.
fn told(scene: &Lowered, ray: &Ray) -> Vec<(u64, u64, u64, i8, String)> {
    let all = scene.geometry.all(ray);
    assert_eq!(scene.geometry.closest(ray), all.first().copied(), "closest is the first of all: {ray:?}");
    assert_eq!(scene.geometry.any(ray), !all.is_empty(), "{ray:?}");
    // A range contains the hits that lie in it, also if it ends inside the body. If a formula's
    // crossings cannot be separated, the number of clusters depends on where the ray starts.
    let is_sure = all.iter().all(|h| format!("{:?}", h.kind) != "Cluster");
    for i in if is_sure { 1..all.len() } else { 0..0 } {
        let (before, after) = (&all[i - 1], &all[i]);
        let between = 0.5 * before.t_hi + 0.5 * after.t_lo;
        if before.t_hi < between && between < after.t_lo {
            for (from, to, expected) in [(ray.t_min, between, &all[..i]), (between, f64::INFINITY, &all[i..])]
            {
                let part = scene.geometry.all(&ray.with_range(from, to));
                let same = part.len() == expected.len()
                    && part
                        .iter()
                        .zip(expected)
                        .all(|(a, b)| a.sign == b.sign && a.t_lo <= b.t_hi && b.t_lo <= a.t_hi);
                assert!(same, "from {from} to {to}: {ray:?}\n {part:?}\n {all:?}");
            }
        }
    }
    let bits = f64::to_bits;
    all.iter().map(|h| (bits(h.t), bits(h.t_lo), bits(h.t_hi), h.sign, format!("{:?}", h.kind))).collect()
}

/// The exact side of a point; `None` within a billionth of a border, where rays along a face go in
/// and out by rounding.
fn side_around(scene: &Lowered, p: Point3) -> Option<String> {
    let side = scene.geometry.side(p);
    let near = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|d| [d * 1e-9, d * -1e-9]);
    let is_clear = near.into_iter().all(|d| scene.geometry.side(p + d) == side);
    is_clear.then(|| format!("{side:?}"))
}

/// Checks that between two crossings a body is exactly on the side that their signs say.
fn sides_fit(name: &str, scene: &Lowered, ray: &Ray) {
    let all = scene.geometry.all(ray);
    if all.iter().any(|h| format!("{:?}", h.kind) == "Cluster") {
        return;
    }
    let crossed: Vec<_> = all.iter().filter(|h| h.sign != 0).collect();
    // The order of crossings with overlapping brackets is unknown.
    if crossed.windows(2).any(|pair| pair[1].t_lo <= pair[0].t_hi) {
        return;
    }
    for pair in crossed.windows(2) {
        assert!(pair[0].sign == -pair[1].sign, "{name}: signs take turns: {ray:?} {all:?}");
        let middle = ray.at(0.5 * (pair[0].t + pair[1].t));
        // If two crossings are closer than the rounding of coordinates, there is no point between
        // them.
        if (pair[1].t - pair[0].t) * ray.direction.length() > 1e-6 {
            let Some(side) = side_around(scene, middle) else { continue };
            let wrong = if pair[0].sign < 0 { "Out" } else { "In" };
            assert_ne!(side, wrong, "{name}: between crossings, at {middle:?}: {ray:?} {all:?}");
        }
    }
    // Before the first crossing the body is on the side that the ray leaves there, and after the
    // last one on the other.
    let (first, last) = (crossed.first(), crossed.last());
    let before = first.filter(|h| h.t * ray.direction.length() > 1e-6).map(|h| (0.5 * h.t, h.sign < 0));
    let behind = last.map(|h| (2.0 * h.t + 1.0, h.sign > 0));
    for (t, is_outside) in before.into_iter().chain(behind) {
        let at = ray.at(t);
        let Some(side) = side_around(scene, at) else { continue };
        assert_ne!(side, if is_outside { "In" } else { "Out" }, "{name}: at {at:?}: {ray:?} {all:?}");
    }
}

/// Rays at multiples of a quarter, and some that touch the surfaces or miss them by rounding.
fn rays(dice: &mut TestRng, scenes: [&Lowered; 2], count: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    while rays.len() < count {
        let ray = dice.ray();
        rays.push(ray);
        let Some((scene, hit)) = scenes.iter().find_map(|s| Some((s, s.geometry.closest(&ray)?))) else {
            continue;
        };
        let point = scene.geometry.resolve(&ray, &hit);
        let tangent = point.ng.to_vec().cross(dice.axis());
        if tangent != Vec3::ZERO {
            rays.push(Ray::new(point.p - tangent * 4.0, tangent));
            // The coordinates rounded to few bits.
            let few = |x: f64| (x * 1024.0).round() / 1024.0;
            rays.push(Ray::new((point.p - tangent * 4.0).map(few), tangent.map(few)));
        }
    }
    rays.retain(Ray::is_valid);
    rays
}

#[test]
fn nothing_is_left_of_a_solid_without_itself() {
    let mut dice = TestRng::new(1);
    for (name, a) in KINDS {
        let (alone, empty) = (lowered(a), lowered(&format!("difference {{ {a} {a} }}")));
        let rays = rays(&mut dice, [&alone, &alone], 160);
        let mut met = 0;
        for ray in &rays {
            assert_eq!(told(&empty, ray), [], "{name}: {ray:?}");
            assert_eq!(empty.geometry.spans(ray).len(), 0, "{name}: {ray:?}");
            met += alone.geometry.all(ray).len();
        }
        assert!(met > 20, "{name}: {met}");
    }
}

/// Each kind as `A`, and some others as `B`; with `DURER_SOAK` set, all others.
#[test]
fn identities_hold_for_every_kind() {
    let mut met = 0;
    let all = std::env::var_os("DURER_SOAK").is_some();
    let ways: Vec<usize> = if all { (0..KINDS.len()).collect() } else { vec![1, 7, 19] };
    for (i, &(a_name, a)) in KINDS.iter().enumerate() {
        for way in &ways {
            let (b_name, b) = KINDS[(i + way) % KINDS.len()];
            met += identities((a_name, a), (b_name, b), (i * 100 + way) as u64);
        }
    }
    assert!(met > 3_000, "only {met} crossings");
}

fn identities((a_name, a): (&str, &str), (b_name, b): (&str, &str), seed: u64) -> usize {
    let name = format!("A: {a_name}, B: {b_name}");
    let not = |s: &str| format!("object {{ {s} inverse }}");
    let (not_a, not_b) = (not(a), not(b));
    let body = |text: String| lowered(&text);
    let (own, other) = (lowered(a), lowered(b));
    let once = body(format!("merge {{ {a} }}"));
    let twice = body(format!("merge {{ {a} {a} }}"));
    let either = body(format!("merge {{ {a} {b} }}"));
    let morgan = body(format!("intersection {{ {not_a} {not_b} inverse }}"));
    let both = body(format!("intersection {{ {a} {b} }}"));
    let less_less = body(format!("difference {{ {a} difference {{ {a} {b} }} }}"));
    let neither = body(format!("merge {{ {a} {b} inverse }}"));
    let outside = body(format!("intersection {{ {not_a} {not_b} }}"));
    let split = body(format!("merge {{ difference {{ {a} {b} }} intersection {{ {a} {b} }} }}"));
    let mut dice = TestRng::new(seed);
    let mut met = 0;
    let rays = rays(&mut dice, [&own, &other], 36);
    let (count, mut unsure) = (rays.len(), 0);
    for ray in rays {
        // Crossings that a formula cannot separate near a tangent form a cluster, and the result of
        // a tie with it is undefined.
        if is_unsure(&own, &ray) || is_unsure(&other, &ray) {
            unsure += 1;
            continue;
        }
        let alone = told(&once, &ray);
        assert_eq!(told(&twice, &ray), alone, "A|A = A, {name}: {ray:?}");
        assert_eq!(told(&either, &ray), told(&morgan, &ray), "A|B = -(-A & -B), {name}: {ray:?}");
        assert_eq!(told(&neither, &ray), told(&outside, &ray), "-(A|B) = -A & -B, {name}: {ray:?}");
        let met_both = told(&both, &ray);
        assert_eq!(told(&less_less, &ray), met_both, "A-(A-B) = A&B, {name}: {ray:?}");
        if are_apart(&own, &other, &ray) {
            assert_eq!(told(&split, &ray), alone, "(A-B)|(A&B) = A, {name}: {ray:?}");
        }
        for (of, scene) in
            [("A", &own), ("B", &other), ("A|B", &either), ("A&B", &both), ("A-(A-B)", &less_less)]
        {
            sides_fit(&format!("{of}, {name}"), scene, &ray);
        }
        met += met_both.len() + alone.len();
    }
    assert!(unsure * 4 < count, "{name}: {unsure} of {count} rays meet clusters");
    met
}

/// Whether some crossings of the line could not be separated.
fn is_unsure(scene: &Lowered, ray: &Ray) -> bool {
    let line = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
    scene.geometry.all(&line).iter().any(|h| format!("{:?}", h.kind) == "Cluster")
}

/// Whether every crossing of one solid is farther from those of the other than the brackets are
/// wide.
fn are_apart(a: &Lowered, b: &Lowered, ray: &Ray) -> bool {
    let line = Ray::new(ray.origin, ray.direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
    let (a, b) = (a.geometry.all(&line), b.geometry.all(&line));
    a.iter().all(|x| x.sign != 0 && b.iter().all(|y| y.sign != 0 && (x.t_hi < y.t_lo || y.t_hi < x.t_lo)))
}

#[test]
fn bodies_that_touch_fuse() {
    // Twenty-seven blocks with common faces and edges form one solid. So do two halves of a ball
    // and of a ring, and the pieces of a mesh.
    let mut blocks = String::from("merge {");
    for i in 0..27 {
        let [x, y, z] = [i % 3, i / 3 % 3, i / 9].map(|k| f64::from(k) * 0.5 - 0.75);
        blocks += &format!(" box {{ <{x}, {y}, {z}>, <{}, {}, {}> }}", x + 0.5, y + 0.5, z + 0.5);
    }
    let halves = |of: &str| {
        format!(
            "merge {{ intersection {{ {of} plane {{ x, 0 }} }} intersection {{ {of} plane {{ -x, 0 }} }} }}"
        )
    };
    let prism = |points: &str| format!("prism {{ -0.5, 0.5, 4, {points} }}");
    let mesh = KINDS.iter().find(|k| k.0 == "mesh").unwrap().1;
    let ring = "torus { 1, 0.25 }";
    for (fused, whole) in [
        (blocks + " }", "box { -0.75, 0.75 }".to_owned()),
        (halves("sphere { 0, 1 }"), "sphere { 0, 1 }".to_owned()),
        (halves(ring), ring.to_owned()),
        (halves(mesh), mesh.to_owned()),
        (halves("superellipsoid { <0.5, 0.5> }"), "superellipsoid { <0.5, 0.5> }".to_owned()),
        (
            format!(
                "merge {{ {} {} }}",
                prism("<-1, -1>, <1, -1>, <1, 1>, <-1, -1>"),
                prism("<-1, -1>, <1, 1>, <-1, 1>, <-1, -1>")
            ),
            "prism { -0.5, 0.5, 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> }".to_owned(),
        ),
    ] {
        let (fused_scene, whole_scene) = (lowered(&fused), lowered(&whole));
        let mut dice = TestRng::new(11);
        let mut met = 0;
        for ray in rays(&mut dice, [&whole_scene, &whole_scene], 600) {
            let signs = |scene: &Lowered| {
                let mut all: Vec<_> =
                    scene.geometry.all(&ray).iter().map(|h| (h.sign, h.t_lo, h.t_hi)).collect();
                // At a corner in a seam, a touch and two crossings within rounding are both
                // allowed.
                while let Some(i) = all.windows(2).position(|w| w[0].0 != w[1].0 && w[0].2 >= w[1].1) {
                    all.drain(i..i + 2);
                }
                all.retain(|h| h.0 != 0);
                all
            };
            let (found, expected) = (signs(&fused_scene), signs(&whole_scene));
            // A line in a seam lies in a face of each part, so it is undefined which points of the
            // border are kept.
            let in_seam = ray.origin.x == 0.0 && ray.direction.x == 0.0;
            if in_seam && fused.contains("plane") {
                continue;
            }
            let same = found.len() == expected.len()
                && found.iter().zip(&expected).all(|(a, b)| a.0 == b.0 && a.1 <= b.2 && b.1 <= a.2);
            assert!(same, "{fused}: {ray:?}\n found {found:?}\n expected {expected:?}");
            met += found.len();
        }
        assert!(met > 100, "{fused}: {met}");
    }
    // Balls that touch each other and a plane in single points remain separate.
    let touching = lowered("merge { sphere { -x, 1 } sphere { x, 1 } plane { y, -1 } }");
    let along = Ray::new(Point3::new(-4.0, 0.0, 0.0), Vec3::X);
    assert_eq!(told(&touching, &along).len(), 2, "one body at the point where they touch");
    let down = Ray::new(Point3::new(-1.0, 4.0, 0.0), -Vec3::Y);
    assert_eq!(told(&touching, &down).len(), 1, "from the ball straight into the ground");
}

#[test]
fn differences_nest_a_hundred_deep() {
    // A - (B - (C - ...)) of ever smaller solids of one kind: shells.
    for shape in ["sphere { 0, 1", "superellipsoid { <0.5, 0.5>", "torus { 1, 0.5", "mesh"] {
        let mut text = String::new();
        let mesh = KINDS.iter().find(|k| k.0 == "mesh").unwrap().1.trim_end_matches('}');
        let shape = if shape == "mesh" { mesh } else { shape };
        let scale = |i: i32| {
            if shape.starts_with("torus") {
                format!("scale <1, {0}, 1>", f64::from(101 - i) / 101.0)
            } else {
                format!("scale {}", f64::from(101 - i) / 101.0)
            }
        };
        for i in 0..100 {
            text += &format!("difference {{ {shape} {} }} ", scale(i));
        }
        text += &format!("{shape} {} }} {}", scale(100), "}".repeat(100));
        let nested = lowered(&text);
        let from = Point3::new(1.0 / 1024.0, 8.0, 3.0 / 2048.0);
        let ray = if shape.starts_with("torus") {
            Ray::new(Point3::new(1.0, 8.0, 1.0 / 64.0), -Vec3::Y)
        } else {
            Ray::new(from, -Vec3::Y)
        };
        let all = nested.geometry.all(&ray);
        assert_eq!(all.len(), 202, "{shape}");
        assert!(all.iter().enumerate().all(|(i, h)| h.sign == if i % 2 == 0 { -1 } else { 1 }), "{shape}");
        sides_fit(shape, &nested, &ray);
    }
}

//! Volumes by chords: for a uniform bundle of parallel lines, the lengths inside a solid add up to
//! its volume, whatever the direction (M. W. Crofton, 1868, and B. Cavalieri before him). The
//! expected values are closed forms.

use super::{Draws, lowered};
use core::f64::consts::PI;
use durer_math::{Point3, Ray, Vec3};
use durer_testkit::TestRng;

/// The number of bundles, each with a direction of its own.
const BUNDLES: u32 = 24;
/// The number of lines of a bundle along each side of a square grid. Each line is at a random place
/// of its cell.
const LINES: u32 = 48;

/// The volume measured by chords, and its standard error over the bundles.
fn volume(text: &str, seed: u64) -> (f64, f64) {
    let scene = lowered(text);
    let bounds = scene.geometry.bounds();
    let (centre, half) = if bounds.is_bounded() {
        (bounds.centre(), bounds.widths() * 0.5)
    } else {
        (Point3::ORIGIN, Vec3::new(1.5, 1.5, 1.5))
    };
    let mut dice = TestRng::new(seed);
    let estimates: Vec<f64> = (0..BUNDLES)
        .map(|_| {
            let d = dice.direction();
            let (u, v) = d.orthonormal_basis();
            // The projection of the box.
            let [width, height] = [u, v].map(|axis| axis.abs().dot(half));
            let n = f64::from(LINES);
            let mut inside = 0.0;
            for i in 0..LINES * LINES {
                let mut at = |k: u32| (f64::from(k) + dice.unit()) * (2.0 / n) - 1.0;
                let (x, y) = (at(i % LINES) * width, at(i / LINES) * height);
                let ray = Ray::new(centre + u * x + v * y - d * (2.0 * half.length()), d);
                inside += scene.geometry.spans(&ray).iter().map(|s| s.t_out - s.t_in).sum::<f64>();
            }
            inside * (4.0 * width * height / (n * n))
        })
        .collect();
    let n = f64::from(BUNDLES);
    let mean = estimates.iter().sum::<f64>() / n;
    let variance = estimates.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Checks that the volumes are within three standard errors. These are so small that a deviation of
/// one percent would be noticed.
fn check(solids: &[(&str, String, f64)]) {
    let mut wrong = String::new();
    for (i, (name, text, exact)) in solids.iter().enumerate() {
        let (found, error) = volume(text, i as u64);
        if (found - exact).abs() > 3.0 * error || 3.0 * error > 0.0075 * exact {
            wrong += &format!(
                "{name}: {found} +- {error}, exactly {exact}: {:.1} errors\n",
                (found - exact) / error
            );
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

fn cube(x: f64) -> f64 {
    x * x * x
}

fn ball(r: f64) -> f64 {
    4.0 / 3.0 * PI * cube(r)
}

/// The volume of the part of a ball above a plane, with height h.
fn cap(r: f64, h: f64) -> f64 {
    PI * h * h * (r - h / 3.0)
}

/// The volume of a frustum with radii a and b at its ends.
fn frustum(a: f64, b: f64, h: f64) -> f64 {
    PI * h / 3.0 * (a * a + a * b + b * b)
}

fn ring(major: f64, minor: f64) -> f64 {
    2.0 * PI * PI * major * minor * minor
}

/// The volume of the solid under a `sor`'s curve: the square of the radius is the cubic with the
/// given ends and slopes.
fn sor(points: &[(f64, f64)]) -> f64 {
    let slope = |i: usize| {
        2.0 * points[i].0 * (points[i + 1].0 - points[i - 1].0) / (points[i + 1].1 - points[i - 1].1)
    };
    let piece = |i: usize| {
        let h = points[i + 1].1 - points[i].1;
        let squares = points[i].0 * points[i].0 + points[i + 1].0 * points[i + 1].0;
        PI * (h * squares / 2.0 + h * h * (slope(i) - slope(i + 1)) / 12.0)
    };
    (1..points.len() - 2).map(piece).sum()
}

const OCTAHEDRON: &str = "mesh { triangle { x, y, z } triangle { y, -x, z } triangle { -x, -y, z } triangle { -y, x, z } triangle { y, x, -z } triangle { -x, y, -z } triangle { -y, -x, -z } triangle { x, -y, -z } inside_vector <0.25, 0.5, 1> }";
/// 8 G(5/4)^3 / G(7/4).
const ROUNDED_CUBE: f64 = 6.481_987_351_786_384;

#[test]
fn thirty_solids_have_their_volumes() {
    let s = |text: &str| text.to_owned();
    let points = [(0.5, -1.0), (0.75, -0.5), (1.0, 0.0), (0.5, 0.5), (0.75, 1.0), (1.0, 1.5)];
    // The field falls to the threshold where (1 - q)^2 = 1/4.
    let drop = 0.5_f64.sqrt();
    let planes =
        "plane { x, 1 } plane { -x, 1 } plane { y, 1 } plane { -y, 1 } plane { z, 1 } plane { -z, 1 }";
    check(&[
        ("ball", s("sphere { <1, 2, 3>, 1.5 }"), ball(1.5)),
        ("block", s("box { <-1, -0.5, -1>, <1, 1, 0.5> }"), 4.5),
        ("sheared block", s("box { 0, 1 matrix <1, 0.5, 0, 0, 1, 0.25, 0.5, 0, 2, 1, 1, 1> }"), 2.0625),
        ("ellipsoid", s("sphere { 0, 1 scale <1.5, 0.5, 1> rotate <10, 20, 30> }"), ball(1.0) * 0.75),
        ("rod", s("cylinder { <-1, 0, 0.5>, <1, 1, 0.5>, 0.5 }"), PI * 0.25 * 5.0_f64.sqrt()),
        ("cone", s("cone { 0, 1, 2*y, 0 }"), frustum(1.0, 0.0, 2.0)),
        ("frustum", s("cone { 0, 1, <1, 1, 0>, 0.25 }"), frustum(1.0, 0.25, 2.0_f64.sqrt())),
        ("quadric", s("quadric { <1, 4, 1>, 0, 0, -1 }"), ball(1.0) * 0.5),
        ("spheroid", s("spheroid { 1, 0.5 }"), ball(1.0) * 0.5),
        ("paraboloid", s("paraboloid { 1, 1, from 0 to 2 }"), PI * 2.0),
        (
            "hyperboloid of one sheet",
            s("hyperboloid { <0.5, 0.5, 1>, sheets 1, from -1 to 1 }"),
            PI * 0.25 * (2.0 + 2.0 / 3.0),
        ),
        (
            "hyperboloid of two sheets",
            s("hyperboloid { <0.5, 0.5, 0.5>, sheets 2, from 0 to 1 }"),
            PI * 0.25 * (4.0 * 0.875 / 3.0 - 0.5),
        ),
        ("elliptic cone", s("elliptic_cone { <1, 0.5, 1>, from 0 to 1 }"), PI * 0.5 / 3.0),
        ("elliptic cylinder", s("elliptic_cylinder { <1, 0.5>, from -0.5 to 1 }"), PI * 0.5 * 1.5),
        ("spherical sector", s("spherical_sector { 0, 1.5, y, 60 }"), 2.0 / 3.0 * PI * cube(1.5) * 0.5),
        ("ring", s("torus { 1, 0.25 }"), ring(1.0, 0.25)),
        ("horn", s("torus { 0.75, 0.75 }"), ring(0.75, 0.75)),
        // Points that are inside twice count as outside, so the formula of the ring holds.
        ("spindle", s("torus { 0.5, 0.75 }"), ring(0.5, 0.75)),
        ("round cyclide", s("cyclide { 1, 0, 0.5 }"), ring(1.0, 0.5)),
        (
            "quartic",
            s("polynomial { 4, xyz(4,0,0): 1, xyz(0,4,0): 1, xyz(0,0,4): 1, xyz(0,0,0): -1 }"),
            ROUNDED_CUBE,
        ),
        // 4 G(1 + e/2)^2 / G(1 + e) . n B(n/2, n + 1)
        ("superellipsoid", s("superellipsoid { <0.5, 0.25> }"), 7.121_656_527_106_981),
        ("star", s("superellipsoid { <2.5, 1> }"), 2.060_082_974_779_301_7),
        ("blob", s("blob { threshold 0.25 sphere { -x, 1, 1 } sphere { 2*x, 0.5, 1 } }"), ball(drop) * 1.125),
        ("L", s("prism { 0, 1.5, 7, <0, 0>, <2, 0>, <2, 1>, <1, 1>, <1, 2>, <0, 2>, <0, 0> }"), 4.5),
        (
            "nut",
            s(
                "prism { 0, 0.5, 10, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1>, <0.5, 0>, <0, 0.5>, <-0.5, 0>, <0, -0.5>, <0.5, 0> }",
            ),
            1.75,
        ),
        (
            "cut pyramid",
            s("prism { conic_sweep 0.5, 1, 4, <-1, -1>, <1, -1>, <0, 1>, <-1, -1> }"),
            2.0 * 0.875 / 3.0,
        ),
        (
            "sor",
            s("sor { 6, <0.5, -1>, <0.75, -0.5>, <1, 0>, <0.5, 0.5>, <0.75, 1>, <1, 1.5> }"),
            sor(&points),
        ),
        // Integrals of the squared radius over the three pieces.
        ("egg", s("ovus { 1, 0.5 }"), 4.913_542_145_556_145),
        ("barrel", s("lemon { 0, 0.5, 1.5*y, 0.25, 1.25 }"), 1.489_553_099_816_038),
        ("lemon", s("lemon { 0, 0, 2*y, 0, 1.25 }"), 0.895_307_304_333_939),
        ("sponge of Menger", s("ifs { menger 2 }"), 8.0 * 400.0 / 729.0),
        ("tetrahedron of Sierpinski", s("ifs { sierpinski 2 }"), 2.0 / 3.0),
        ("octahedron", s(OCTAHEDRON), 4.0 / 3.0),
        (
            "polyhedron",
            format!("intersection {{ {planes} plane {{ <1, 1, 1>, 0.57735026918962576 }} }}"),
            8.0 - 4.0 / 3.0,
        ),
        (
            "isosurface",
            s("isosurface { function { x*x + y*y*4 + z*z - 1 } contained_by { box { -1, 1 } } }"),
            ball(1.0) * 0.5,
        ),
        (
            "isosurface, cut by its box",
            s("isosurface { function { x*x + z*z - 1 } contained_by { box { <-1, -0.5, -1>, 1 } } }"),
            PI * 1.5,
        ),
        // z_n = p^(2^n) stays in the unit ball if p is there.
        ("Julia set", s("julia_fractal { <0, 0, 0, 0> quaternion sqr max_iteration 4 }"), ball(1.0)),
        (
            "twisted block",
            s("deform { box { <-0.5, 0, -0.5>, <0.5, 2, 0.5> } twist { y, 120, from 0 to 2 } }"),
            2.0,
        ),
        (
            "tapered block",
            s("deform { box { <-0.5, 0, -0.5>, <0.5, 1, 0.5> } taper { y, 0.5, from 0 to 1 } }"),
            7.0 / 12.0,
        ),
    ]);
}

/// The points and derivatives of a cubic Bezier curve at the five nodes of Gauss and Legendre's
/// rule, with the weights. The rule is exact for polynomials of degree 9.
fn gauss([a, b, c, d]: [[f64; 2]; 4]) -> [([f64; 2], [f64; 2], f64); 5] {
    let root = (10.0_f64 / 7.0).sqrt();
    let (near, far) = ((5.0 - 2.0 * root).sqrt() / 3.0, (5.0 + 2.0 * root).sqrt() / 3.0);
    let (more, less) = ((322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0, (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0);
    [(0.0, 128.0 / 225.0), (near, more), (-near, more), (far, less), (-far, less)].map(|(x, weight)| {
        let (t, u) = (0.5 + 0.5 * x, 0.5 - 0.5 * x);
        let at =
            |i: usize| u * u * u * a[i] + 3.0 * u * u * t * b[i] + 3.0 * u * t * t * c[i] + t * t * t * d[i];
        let slope =
            |i: usize| 3.0 * (u * u * (b[i] - a[i]) + 2.0 * u * t * (c[i] - b[i]) + t * t * (d[i] - c[i]));
        ([at(0), at(1)], [slope(0), slope(1)], 0.5 * weight)
    })
}

/// The points in the order of the scene language.
fn listed(points: &[[f64; 2]]) -> String {
    points.iter().map(|[a, b]| format!(", <{a}, {b}>")).collect()
}

#[test]
fn swept_solids_have_their_volumes() {
    let s = |text: &str| text.to_owned();
    // An egg-shaped closed curve of two cubics.
    let egg = [
        [1.0, -0.5],
        [2.0, -0.5],
        [2.0, 0.75],
        [1.25, 0.75],
        [1.25, 0.75],
        [0.5, 0.75],
        [0.25, -0.5],
        [1.0, -0.5],
    ];
    let pieces = [[egg[0], egg[1], egg[2], egg[3]], [egg[4], egg[5], egg[6], egg[7]]];
    let integral = |f: fn([f64; 2], [f64; 2]) -> f64| -> f64 {
        pieces.iter().flat_map(|p| gauss(*p)).map(|(at, slope, weight)| weight * f(at, slope)).sum()
    };
    // G. Green's theorem, and P. Guldin's for the solid of revolution.
    let (area, turned) = (integral(|[a, _], [_, db]| a * db), integral(|[a, _], [_, db]| PI * a * a * db));
    // Catmull and Rom's cubics through the same number of points, as Bezier pieces.
    let through = [[1.0, -0.75], [1.5, 0.0], [1.0, 0.75], [0.5, 0.0]];
    let catmull: f64 = (0..4)
        .flat_map(|i| {
            let [p, q, r, t] = [3, 0, 1, 2].map(|k| through[(i + k) % 4]);
            let towards = |from: [f64; 2], a: [f64; 2], b: [f64; 2], sign: f64| {
                [0, 1].map(|k| from[k] + sign * (b[k] - a[k]) / 6.0)
            };
            gauss([q, towards(q, p, r, 1.0), towards(r, q, t, -1.0), r])
        })
        .map(|([r, _], [_, dy], weight)| weight * PI * r * r * dy)
        .sum();
    let round = [3, 0, 1, 2, 3, 0, 1].map(|k: usize| through[k]);
    // The tangent cone of two balls touches them at this sine from the planes across its axis.
    let sine: f64 = 0.5 / 2.0;
    let cosine = (1.0 - sine * sine).sqrt();
    let drop = frustum(cosine, 0.5 * cosine, 2.0 * cosine * cosine)
        + cap(1.0, 1.0 + sine)
        + cap(0.5, 0.5 * (1.0 - sine));
    let hexagon = "linear_spline 7, <1, 0>, <0.5, 1>, <-0.5, 1>, <-1, 0>, <-0.5, -1>, <0.5, -1>, <1, 0>";
    let path = "path linear_spline 2, <-0.5, 0, 0.25>, <0.5, 1, 0.75>";
    check(&[
        (
            "lathe of a square",
            s("lathe { linear_spline 5, <1, 0>, <2, 0>, <2, 1>, <1, 1>, <1, 0> }"),
            3.0 * PI,
        ),
        ("lathe of a triangle", s("lathe { linear_spline 4, <1, 0>, <2, 0>, <1.5, 1>, <1, 0> }"), 1.5 * PI),
        (
            "lathe of lines to the axis",
            s("lathe { linear_spline 4, <0, 0>, <1, 0>, <0.5, 1>, <0, 1> }"),
            frustum(1.0, 0.5, 1.0),
        ),
        (
            "lathe of a parabola",
            s(
                "lathe { bezier_spline 8, <0, 0>, <0.5, 0>, <1, 0.75>, <1.5, 2.25>, <1.5, 2.25>, <1, 2.25>, <0.5, 2.25>, <0, 2.25> }",
            ),
            PI * 2.25 * 2.25 / 2.0,
        ),
        ("lathe of Bezier curves", format!("lathe {{ bezier_spline 8{} }}", listed(&egg)), turned),
        ("lathe of cubics", format!("lathe {{ cubic_spline 7{} }}", listed(&round)), catmull),
        (
            "capsule",
            s("sphere_sweep { linear_spline 2, <-1, 0, 0>, 0.5, <0.5, 0, 2>, 0.5 }"),
            PI * 0.25 * 2.5 + ball(0.5),
        ),
        ("drop", s("sphere_sweep { linear_spline 2, 0, 1, 2*x, 0.5 }"), drop),
        ("ball in a ball", s("sphere_sweep { linear_spline 2, 0, 1, 0.25*x, 0.5 }"), ball(1.0)),
        (
            "straight B-spline",
            s("sphere_sweep { b_spline 4, -3*y, 0.5, -y, 0.5, y, 0.5, 3*y, 0.5 }"),
            PI * 0.25 * 2.0 + ball(0.5),
        ),
        ("sweep", format!("sweep {{ profile {hexagon} {path} }}"), 3.0 * 1.5),
        (
            "conic sweep",
            format!("sweep {{ profile {hexagon} {path} size 2, 0.5, 1.5 up z }}"),
            3.0 * 1.5 * 3.25 / 3.0,
        ),
        (
            "sweep of Bezier curves",
            format!("sweep {{ profile bezier_spline 8{} {path} size 2, 1, 0.5 }}", listed(&egg)),
            area * 1.5 * 1.75 / 3.0,
        ),
        ("sponge", s("ifs { menger 2 }"), 8.0 * (20.0 / 27.0) * (20.0 / 27.0)),
        ("tetrahedra", s("ifs { sierpinski 2 }"), 8.0 / 3.0 / 4.0),
    ]);
}

#[test]
fn thirty_trees_have_their_volumes() {
    let s = |text: &str| text.to_owned();
    let lens = 2.0 * cap(1.0, 0.5);
    let mut holes = String::from("difference { box { -1, 1 }");
    for i in 0..9 {
        let (x, z) = (f64::from(i % 3) * 0.5 - 0.5, f64::from(i / 3) * 0.5 - 0.5);
        holes += &format!(" cylinder {{ <{x}, -2, {z}>, <{x}, 2, {z}>, 0.2 }}");
    }
    holes += " }";
    let mut shells = String::new();
    let mut left = ball(1.0 / 10.0);
    for i in (2..=10).rev() {
        shells += &format!("difference {{ sphere {{ 0, {} }} ", f64::from(i) / 10.0);
    }
    shells += "sphere { 0, 0.1 }";
    shells += &"}".repeat(9);
    for i in 2..=10 {
        left = ball(f64::from(i) / 10.0) - left;
    }
    let planes =
        "plane { x, 1 } plane { -x, 1 } plane { y, 1 } plane { -y, 1 } plane { z, 1 } plane { -z, 1 }";
    check(&[
        ("half a ball", s("intersection { sphere { 0, 1 } plane { <3, 4, 0>, 0 } }"), ball(1.0) / 2.0),
        ("a cap", s("intersection { sphere { 0, 1 } plane { -y, -0.5 } }"), cap(1.0, 0.5)),
        ("a lens", s("intersection { sphere { -0.5*x, 1 } sphere { 0.5*x, 1 } }"), lens),
        ("two balls", s("merge { sphere { -0.5*x, 1 } sphere { 0.5*x, 1 } }"), 2.0 * ball(1.0) - lens),
        ("a moon", s("difference { sphere { -0.5*x, 1 } sphere { 0.5*x, 1 } }"), ball(1.0) - lens),
        ("a shell", s("difference { sphere { 0, 1 } sphere { 0, 0.75 } }"), ball(1.0) - ball(0.75)),
        ("shells", shells, left),
        ("a block with holes", holes, 8.0 - 9.0 * PI * 0.04 * 2.0),
        ("two rods", s("intersection { cylinder { -2*x, 2*x, 1 } cylinder { -2*y, 2*y, 1 } }"), 16.0 / 3.0),
        (
            "three rods",
            s(
                "intersection { cylinder { -2*x, 2*x, 1 } cylinder { -2*y, 2*y, 1 } cylinder { -2*z, 2*z, 1 } }",
            ),
            8.0 * (2.0 - 2.0_f64.sqrt()),
        ),
        (
            "a cross of rods",
            s("merge { cylinder { -2*x, 2*x, 1 } cylinder { -2*y, 2*y, 1 } }"),
            8.0 * PI - 16.0 / 3.0,
        ),
        (
            "a napkin ring",
            s("difference { sphere { 0, 1 } cylinder { -2*y, 2*y, 0.6 } }"),
            PI / 6.0 * cube(1.6),
        ),
        (
            "a block without an eighth of a ball",
            s("difference { box { 0, 1 } sphere { 0, 1 } }"),
            1.0 - ball(1.0) / 8.0,
        ),
        (
            "a cross of blocks",
            s(
                "merge { box { <-1.5, -0.5, -0.5>, <1.5, 0.5, 0.5> } box { <-0.5, -1.5, -0.5>, <0.5, 1.5, 0.5> } box { <-0.5, -0.5, -1.5>, <0.5, 0.5, 1.5> } }",
            ),
            7.0,
        ),
        (
            "blocks side by side",
            s("merge { box { 0, 1 } box { <1, 0, 0>, <2, 1, 1> } box { <0, 1, 0>, <1, 2, 1> } }"),
            3.0,
        ),
        (
            "a block less what is left of it",
            s("difference { box { -1, 1 } difference { box { -1, 1 } sphere { 0, 1 } } }"),
            ball(1.0),
        ),
        (
            "half a ring",
            s("intersection { torus { 1, 0.25 } plane { <1, 0, 1>, 0 } }"),
            ring(1.0, 0.25) / 2.0,
        ),
        (
            "a ring, sliced",
            s("difference { torus { 1, 0.25 } box { <0, -1, 0>, <2, 1, 2> } }"),
            ring(1.0, 0.25) * 0.75,
        ),
        (
            "links",
            s("merge { torus { 1, 0.25 } torus { 1, 0.25 rotate x*90 translate x } }"),
            2.0 * ring(1.0, 0.25),
        ),
        (
            "a bored cone",
            s("difference { cone { 0, 1, 2*y, 0 } cylinder { -y, 3*y, 0.5 } }"),
            frustum(1.0, 0.5, 1.0) - PI * 0.25,
        ),
        (
            "an eighth of a superellipsoid",
            s("intersection { superellipsoid { <0.5, 0.25> } plane { x, 0 } plane { y, 0 } plane { z, 0 } }"),
            7.121_656_527_106_981 / 8.0,
        ),
        (
            "half a blob",
            s("difference { blob { threshold 0.25 sphere { 0, 1, 1 } } box { <-2, 0, -2>, 2 } }"),
            ball(0.5_f64.sqrt()) / 2.0,
        ),
        (
            "an L with a step",
            s(
                "difference { prism { 0, 1.5, 7, <0, 0>, <2, 0>, <2, 1>, <1, 1>, <1, 2>, <0, 2>, <0, 0> } box { <1, 0.5, -1>, <3, 2, 3> } }",
            ),
            4.5 - 1.0,
        ),
        (
            "half a sor",
            s(
                "intersection { sor { 6, <0.5, -1>, <0.75, -0.5>, <1, 0>, <0.5, 0.5>, <0.75, 1>, <1, 1.5> } plane { z, 0 } }",
            ),
            0.5 * sor(&[(0.5, -1.0), (0.75, -0.5), (1.0, 0.0), (0.5, 0.5), (0.75, 1.0), (1.0, 1.5)]),
        ),
        (
            "an octahedron around a hollow",
            format!("difference {{ {OCTAHEDRON} sphere {{ 0, 0.5 }} }}"),
            4.0 / 3.0 - ball(0.5),
        ),
        (
            "a block of planes, and an octahedron",
            format!("intersection {{ {planes} object {{ {OCTAHEDRON} scale 2 }} }}"),
            8.0 * (8.0 / 6.0 - 3.0 / 6.0),
        ),
        (
            "a quarter of an egg",
            s("difference { ovus { 1, 0.5 } plane { x, 0 } plane { z, 0 } }"),
            4.913_542_145_556_145 / 4.0,
        ),
        (
            "half a lemon",
            s("intersection { lemon { 0, 0, 2*y, 0, 1.25 } plane { y, 1 } }"),
            0.895_307_304_333_939 / 2.0,
        ),
        (
            "an isosurface less a ball",
            s(
                "difference { isosurface { function { x*x + y*y + z*z - 1 } contained_by { box { -1, 1 } } } sphere { 0, 0.5 } }",
            ),
            ball(1.0) - ball(0.5),
        ),
        (
            "half a quartic",
            s(
                "difference { polynomial { 4, xyz(4,0,0): 1, xyz(0,4,0): 1, xyz(0,0,4): 1, xyz(0,0,0): -1 } plane { <1, 1, 0>, 0 } }",
            ),
            ROUNDED_CUBE / 2.0,
        ),
        (
            "half a Julia set",
            s(
                "intersection { julia_fractal { <0, 0, 0, 0> quaternion sqr max_iteration 4 } plane { y, 0 } }",
            ),
            ball(1.0) / 2.0,
        ),
        (
            "half a twisted block",
            s(
                "intersection { deform { box { <-0.5, 0, -0.5>, <0.5, 2, 0.5> } twist { y, 120, from 0 to 2 } } plane { y, 1 } }",
            ),
            1.0,
        ),
        (
            "a tent",
            s(
                "intersection { box { -1, 1 } plane { <1, 1, 0>, 0.70710678118654752 } plane { <-1, 1, 0>, 0.70710678118654752 } }",
            ),
            2.0 * (2.0 + 1.0),
        ),
    ]);
}

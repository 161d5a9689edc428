//! Tests of parametric surfaces. Spheres, tori and cylinders are held to the kernels of these
//! solids, whose brackets rest on exact arithmetic; polynomials to Bezier patches.

mod deformed;
mod sweeps;

use super::*;
use crate::laws::{TestRng, TestSurface, all_roots, dice, drawn, report};
use crate::{All, Axis, AxisBox, BezierPatch, CappedCylinder, RootKind, Sphere, Steps, Torus};
use durer_formula::Function;
use durer_formula::{Builder, NodeId, Op};
use durer_math::U;
use durer_math::{Point3, Ray, Vec3};

const PI: f64 = core::f64::consts::PI;

/// Writes formulas.
struct Pen(Builder);

impl Pen {
    fn new() -> (Self, NodeId, NodeId) {
        let mut b = Builder::new();
        let (u, v) = (b.input(0).unwrap(), b.input(1).unwrap());
        (Self(b), u, v)
    }

    fn op(&mut self, op: Op) -> NodeId {
        self.0.push(op).unwrap()
    }

    fn of(&mut self, f: Function, a: NodeId) -> NodeId {
        self.op(Op::Function(f, a))
    }

    fn times(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Mul(a, b))
    }

    fn plus(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.op(Op::Add(a, b))
    }

    fn number(&mut self, x: f64) -> NodeId {
        self.0.constant(x).unwrap()
    }

    fn made(
        &self,
        roots: [NodeId; 3],
        domain: [[f64; 2]; 2],
        held: Option<Container>,
    ) -> Result<Parametric, ParametricError> {
        let formulas = roots.map(|root| self.0.finish(root, 2));
        Parametric::new(formulas.each_ref(), domain, held.as_ref())
    }
}

/// The unit sphere: poles at y = 1 and -1, the seam at z = 0, x > 0.
fn sphere() -> Parametric {
    let (mut p, u, v) = Pen::new();
    let (su, cu) = (p.of(Function::Sin, u), p.of(Function::Cos, u));
    let (sv, y) = (p.of(Function::Sin, v), p.of(Function::Cos, v));
    let (x, z) = (p.times(sv, cu), p.times(sv, su));
    p.made([x, y, z], [[0.0, 2.0 * PI], [0.0, PI]], None).unwrap()
}

/// The torus about y with these radii.
fn torus(major: f64, minor: f64) -> Parametric {
    let (mut p, u, v) = Pen::new();
    let (major, minor) = (p.number(major), p.number(minor));
    let (su, cu) = (p.of(Function::Sin, u), p.of(Function::Cos, u));
    let (sv, cv) = (p.of(Function::Sin, v), p.of(Function::Cos, v));
    let across = p.times(minor, cv);
    let r = p.plus(major, across);
    let (x, y, z) = (p.times(r, cu), p.times(minor, sv), p.times(r, su));
    p.made([x, y, z], [[0.0, 2.0 * PI], [-PI, PI]], None).unwrap()
}

/// A Moebius strip: x = (1 + v/2 cos(u/2)) cos u, y = v/2 sin(u/2), so S(2 pi, v) = S(0, -v).
fn moebius() -> Parametric {
    let (mut p, u, v) = Pen::new();
    let (half, one) = (p.number(0.5), p.number(1.0));
    let (u2, v2) = (p.times(half, u), p.times(half, v));
    let (s2, c2) = (p.of(Function::Sin, u2), p.of(Function::Cos, u2));
    let (su, cu) = (p.of(Function::Sin, u), p.of(Function::Cos, u));
    let (out, y) = (p.times(v2, c2), p.times(v2, s2));
    let r = p.plus(one, out);
    let (x, z) = (p.times(r, cu), p.times(r, su));
    p.made([x, y, z], [[0.0, 2.0 * PI], [-1.0, 1.0]], None).unwrap()
}

/// What was seen of rays.
#[derive(Debug, Default)]
struct Tally {
    rays: u64,
    roots: u64,
    uncertain: u64,
    widths: Vec<f64>,
}

impl Tally {
    fn tell(&mut self) -> f64 {
        self.widths.sort_by(f64::total_cmp);
        let median = self.widths.get(self.widths.len() / 2).copied().unwrap_or(0.0);
        println!("{} rays, {} roots, {} uncertain, {median} ulp", self.rays, self.roots, self.uncertain);
        report(self.rays);
        median
    }
}

/// The crossings are those of another kernel: each of its simple ones is one of ours or, near a
/// tangent or a pole, in an uncertain one; ours are among its own.
fn compare(ours: &dyn TestSurface, exact: &dyn TestSurface, ray: &Ray, tally: &mut Tally) {
    let (found, wanted) = (all_roots(ours, ray), all_roots(exact, ray));
    let told = || format!("{ray:?}\n  {found:?}\n  {wanted:?}");
    tally.rays += 1;
    let size = ours.bounds().magnitude() / ray.direction.max_abs();
    let overlaps = |a: &Root, b: &Root| a.lo <= b.hi && b.lo <= a.hi;
    let mut used = vec![0; wanted.len()];
    for root in &found {
        tally.roots += 1;
        assert!(root.lo <= root.t && root.t <= root.hi, "{}", told());
        if root.kind != RootKind::Simple {
            tally.uncertain += 1;
            continue;
        }
        tally.widths.push((root.hi - root.lo) / (2.0 * U * root.t.abs().max(size)));
        let fits = (0..wanted.len()).filter(|&k| overlaps(root, &wanted[k]));
        let best = fits.min_by_key(|&k| used[k]);
        let k = best.unwrap_or_else(|| panic!("an extra crossing {root:?} {}", told()));
        used[k] += 1;
        assert!(used[k] == 1 || wanted[k].kind != RootKind::Simple, "twice {root:?} {}", told());
    }
    for (want, used) in wanted.iter().zip(used) {
        let uncertain = || found.iter().any(|r| r.kind != RootKind::Simple && overlaps(r, want));
        assert!(used > 0 || want.kind != RootKind::Simple || uncertain(), "missing {want:?} {}", told());
    }
    assert!(found.windows(2).all(|w| w[0].t <= w[1].t), "{}", told());
}

/// A ray at a point, along a tangent, nearly so, or anywhere.
fn aimed(dice: &mut TestRng, target: Vec3, normal: Vec3) -> Ray {
    let tangent = normal.cross(dice.vector());
    let direction = match dice.below(6) {
        0 => tangent,
        1 => tangent + normal * (tangent.length() * dice.scale(-40, -4)),
        2 => dice.lattice(3),
        3 => dice.pick(&[Vec3::X, Vec3::Y, Vec3::Z]),
        _ => dice.vector(),
    };
    let direction = if direction == Vec3::ZERO { Vec3::Z } else { direction };
    let back = dice.pick(&[0.5, 1.0, 3.0, 1000.0]);
    Ray::new((target - direction * back).to_point(), direction).with_range(-1e9, 1e9)
}

/// The sine and cosine of an angle that is often a multiple of a right one.
fn angle(dice: &mut TestRng) -> (f64, f64) {
    let quarters = |dice: &mut TestRng| dice.integer(0, 8) * (PI / 4.0);
    let angle = match dice.below(4) {
        0 => quarters(dice),
        1 => quarters(dice) + dice.scale(-50, -10),
        _ => dice.between(-PI, PI),
    };
    (Function::Sin.of(angle), Function::Cos.of(angle))
}

#[test]
fn a_parametric_sphere_is_a_sphere() {
    let (ours, exact) = (sphere(), Sphere::new(Point3::ORIGIN, 1.0).unwrap());
    let mut tally = Tally::default();
    for case in drawn(1500) {
        let mut dice = dice(1, case);
        let ((sa, ca), (sb, cb)) = (angle(&mut dice), angle(&mut dice));
        let p = Vec3::new(sb * ca, cb, sb * sa);
        let target = if dice.once_in(4) { p * dice.unit() } else { p };
        let ray = aimed(&mut dice, target, p);
        if ray.is_valid() {
            compare(&ours, &exact, &ray, &mut tally);
        }
    }
    let median = tally.tell();
    assert!(median < 64.0, "{median}");
}

#[test]
fn a_parametric_torus_is_a_torus() {
    let (ours, exact) = (torus(1.0, 0.25), Torus::new(Point3::ORIGIN, Axis::Y, 1.0, 0.25).unwrap());
    let mut tally = Tally::default();
    for case in drawn(1200) {
        let mut dice = dice(2, case);
        let ((sa, ca), (sb, cb)) = (angle(&mut dice), angle(&mut dice));
        let n = Vec3::new(cb * ca, sb, cb * sa);
        let p = Vec3::new(ca, 0.0, sa) + n * 0.25;
        let ray = aimed(&mut dice, p, n);
        if ray.is_valid() {
            compare(&ours, &exact, &ray, &mut tally);
        }
    }
    let median = tally.tell();
    assert!(median < 64.0, "{median}");
}

/// A line enters a torus as often as it leaves it, so the signs of all crossings add up to zero, also
/// if some are unproven.
#[test]
fn signs_add_up_along_tangents() {
    let ours = torus(1.0, 0.25);
    let (mut rays, mut off) = (0, Vec::new());
    for case in drawn(4000) {
        let mut dice = dice(3, case);
        let ((sa, ca), (sb, cb)) = (angle(&mut dice), angle(&mut dice));
        let n = Vec3::new(cb * ca, sb, cb * sa);
        let p = Vec3::new(ca, 0.0, sa) + n * 0.25;
        let direction = n.cross(dice.vector());
        if direction == Vec3::ZERO {
            continue;
        }
        let back = dice.pick(&[0.5, 3.0, 1000.0, 1e6]);
        let ray = Ray::new((p - direction * back).to_point(), direction).with_range(-1e9, 1e9);
        rays += 1;
        let found = all_roots(&ours, &ray);
        if found.iter().map(|root| i32::from(root.sign)).sum::<i32>() != 0 {
            off.push((ray, found));
        }
    }
    println!("{} of {rays} do not add up", off.len());
    report(rays);
    assert!(off.is_empty(), "{:?}", off[0]);
}

/// `r = v² / 2`, `y = -3 v`: slopes along `u` vanish at the tip, to second order. 1024 pieces end there.
#[test]
fn a_ray_through_a_tip_takes_a_bounded_number_of_steps() {
    let (mut p, u, v) = Pen::new();
    let (sin, cos) = (p.of(Function::Sin, u), p.of(Function::Cos, u));
    let (half, three) = (p.number(-0.5), p.number(-3.0));
    let square = p.times(v, v);
    let r = p.times(square, half);
    let (x, y, z) = (p.times(r, cos), p.times(three, v), p.times(r, sin));
    let spike = p.made([x, y, z], [[0.0, 2.0 * PI], [0.0, 1.0]], None).unwrap();
    for direction in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 2.0, 3.0)] {
        Steps::take();
        let roots = all_roots(&spike, &Ray::new((direction * -2.0).to_point(), direction));
        let steps = Steps::take().total();
        assert!(roots.iter().any(|root| root.lo <= 2.0 && root.hi >= 2.0), "{direction:?}: {roots:?}");
        // A cut halves `v` three times, and at most 48 halvings are left.
        println!("{direction:?}: {steps} steps");
        assert!(steps <= 1024 * 16, "{direction:?}: {steps}");
    }
}

#[test]
fn a_parametric_cylinder_is_a_cylinder() {
    let (mut p, u, v) = Pen::new();
    let (z, x) = (p.of(Function::Sin, u), p.of(Function::Cos, u));
    let ours = p.made([x, v, z], [[0.0, 2.0 * PI], [-1.0, 2.0]], None).unwrap();
    let (base, cap) = (Point3::new(0.0, -1.0, 0.0), Point3::new(0.0, 2.0, 0.0));
    let exact = CappedCylinder::open(base, cap, 1.0).unwrap();
    let mut tally = Tally::default();
    for case in drawn(1000) {
        let mut dice = dice(3, case);
        let (sa, ca) = angle(&mut dice);
        let any = dice.between(-1.0, 2.0);
        let y = dice.pick(&[-0.5, 0.0, 1.5, any]);
        let n = Vec3::new(ca, 0.0, sa);
        let ray = aimed(&mut dice, n + Vec3::Y * y, n);
        // Along the axis it is met everywhere or nowhere.
        if ray.is_valid() && ray.direction.x.abs() + ray.direction.z.abs() > 1e-3 * ray.direction.y.abs() {
            compare(&ours, &exact, &ray, &mut tally);
        }
    }
    let median = tally.tell();
    assert!(median < 64.0, "{median}");
}

/// The Bernstein polynomials of `n` points.
fn basis(p: &mut Pen, t: NodeId, n: usize) -> Vec<NodeId> {
    let one = p.number(1.0);
    let s = p.op(Op::Sub(one, t));
    let mut all = Vec::new();
    for i in 0..n {
        let mut b = p.number((0..i).fold(1.0, |c, k| c * (n - 1 - k) as f64 / (k + 1) as f64));
        for k in 0..n - 1 {
            b = p.times(b, if k < i { t } else { s });
        }
        all.push(b);
    }
    all
}

/// A net's surface by formulas.
fn of_net(size: [usize; 2], points: &[Point3]) -> Result<Parametric, ParametricError> {
    let (mut p, u, v) = Pen::new();
    let (bu, bv) = (basis(&mut p, u, size[0]), basis(&mut p, v, size[1]));
    let roots = [0, 1, 2].map(|axis| {
        let mut sum = p.number(0.0);
        for (k, point) in points.iter().enumerate() {
            let weight = p.times(bu[k % size[0]], bv[k / size[0]]);
            let c = p.number(point[axis]);
            let term = p.times(c, weight);
            sum = p.plus(sum, term);
        }
        sum
    });
    p.made(roots, [[0.0, 1.0]; 2], None)
}

#[test]
fn polynomials_are_their_bezier_patches() {
    let mut tally = Tally::default();
    for case in drawn(24) {
        let mut dice = dice(4, case);
        let size = dice.pick(&[[2, 2], [3, 3], [4, 4], [2, 4]]);
        let points: Vec<Point3> = (0..size[0] * size[1])
            .map(|k| {
                let flat = Vec3::new((k % size[0]) as f64, (k / size[0]) as f64, 0.0) * 4.0;
                ((flat + dice.lattice(6)) * 0.125).to_point()
            })
            .collect();
        let (Ok(patch), Ok(ours)) = (BezierPatch::new(size, &points), of_net(size, &points)) else {
            continue;
        };
        for _ in 0..16 {
            let uv = [dice.unit(), dice.unit()];
            let uv = if dice.once_in(4) { uv.map(|x| (x * 4.0).round() / 4.0) } else { uv };
            let jets = ours.sheet.faces[0].tape.jet(uv);
            let of = |f: &dyn Fn(usize) -> f64| Vec3::new(f(0), f(1), f(2));
            let normal = of(&|c| jets[c].d.d[0]).cross(of(&|c| jets[c].d.d[1]));
            let ray = aimed(&mut dice, of(&|c| jets[c].v), normal);
            // On the border both may count what is within rounding of it.
            let inner = |r: &Root| r.tag.iter().all(|x| (1e-9..1.0 - 1e-9).contains(x));
            if ray.is_valid() && all_roots(&patch, &ray).iter().all(inner) {
                compare(&ours, &patch, &ray, &mut tally);
            }
        }
    }
    tally.tell();
    assert!(tally.rays > 50, "{}", tally.rays);
}

#[test]
fn rays_through_the_seam_of_a_moebius_strip_meet_it_once() {
    let strip = moebius();
    for case in drawn(2000) {
        let mut dice = dice(5, case);
        let z = dice.pick(&[0.0, 0.0, 1e-17, -1e-17, 1e-16, -1e-16, 3e-16]);
        let target = Vec3::new(dice.between(0.55, 1.45), 0.0, z);
        // Near the seam the strip is almost in the plane y = 0.
        let direction = Vec3::new(dice.between(-0.2, 0.2), 1.0, dice.between(-0.2, 0.2));
        let ray = Ray::new((target - direction).to_point(), direction);
        let mut near = all_roots(&strip, &ray);
        near.retain(|r| (r.t - 1.0).abs() < 0.1);
        assert_eq!(near.len(), 1, "{ray:?} {near:?}");
        assert_eq!(near[0].kind, RootKind::Simple, "{ray:?} {near:?}");
    }
}

/// A map goes on at a seam if it is periodic: not at a turned seam, at a corner, a pole or a border.
/// `(2 u^3 - 4 u + 2 u^2 v - 1.5 u v^2, -3 u^2 v, -2.5 v - 2 u v^2)` over a square of width 2. The side
/// `v = 0` goes along the x axis and back: at `u = 0.21` and at `u = 1.3` it is at the same place.
fn folded() -> Parametric {
    let (mut p, u, v) = Pen::new();
    let [two, four, three, half] = [2.0, -4.0, -3.0, -1.5].map(|x| p.number(x));
    let (uu, vv, more) = (p.times(u, u), p.times(v, v), p.number(-2.5));
    let (cube, line) = (p.times(uu, u), p.times(four, u));
    let (cube, uuv, uvv) = (p.times(two, cube), p.times(uu, v), p.times(u, vv));
    let (bent, held, y) = (p.times(two, uuv), p.times(half, uvv), p.times(three, uuv));
    let (x, more_x) = (p.plus(cube, line), p.plus(bent, held));
    let x = p.plus(x, more_x);
    let (down, twice) = (p.times(more, v), p.times(two, uvv));
    let z = p.op(Op::Sub(down, twice));
    p.made([x, y, z], [[0.0, 2.0], [0.0, 2.0]], None).unwrap()
}

#[test]
fn sheets_that_share_a_border_are_both_met() {
    let surface = folded();
    let met = |o, [x, y, z]: [f64; 3]| {
        let ray = Ray::new(Point3::from(o), Vec3::new(x, y, z)).with_range(0.0, 600.0);
        all_roots(&surface, &ray)
    };
    // Through the border, and on to a touch.
    let roots = met([-3.4375, 0.0, 7.8125], [0.0537109375, 0.0, -0.1611328125]);
    let mut signs: Vec<i8> = roots.iter().map(|root| root.sign).collect();
    signs[..2].sort_unstable();
    assert_eq!(signs, [-1, 1, 0], "{roots:?}");
    // Through one sheet at the border, and beside it almost in the other one.
    let roots = met(
        [-80.81835937499999, -2.197265625, -117.1875],
        [0.15687942504882812, 0.004291534423828125, 0.2288818359375],
    );
    let kinds: Vec<RootKind> = roots.iter().map(|root| root.kind).collect();
    assert_eq!(kinds, [RootKind::Grazing, RootKind::Simple], "{roots:?}");
}

#[test]
fn seams_are_where_a_map_is_periodic() {
    let seams = |it: &Parametric| it.sheet.faces[0].has_seam;
    assert_eq!(seams(&torus(1.0, 0.25)), [true, true]);
    assert_eq!(seams(&sphere()), [true, false]);
    assert_eq!(seams(&moebius()), [false, false]);
    // A loop with a corner.
    let (mut p, u, v) = Pen::new();
    let (minus, one) = (p.number(-1.0), p.number(1.0));
    let rest = p.times(minus, u);
    let rest = p.plus(one, rest);
    let x = p.times(u, rest);
    let y = p.times(x, u);
    let corner = p.made([x, y, v], [[0.0, 1.0]; 2], None).unwrap();
    assert_eq!(seams(&corner), [false, false]);
}

#[test]
fn rays_from_inside_never_escape_through_seams_and_poles() {
    let (ball, ring) = (sphere(), torus(1.0, 0.25));
    for case in drawn(300) {
        let mut dice = dice(6, case);
        let ((sa, ca), (sb, cb)) = (angle(&mut dice), angle(&mut dice));
        let origin = if dice.once_in(2) { Vec3::ZERO } else { dice.vector() * 0.3 };
        let ray = Ray::new(origin.to_point(), Vec3::new(sb * ca, cb, sb * sa) - origin);
        let roots = all_roots(&ball, &ray);
        assert_eq!(roots.len(), 1, "{ray:?} {roots:?}");
        // From the circle in the middle of the tube.
        let ray = Ray::new(Point3::new(ca, 0.0, sa), Vec3::new(cb * ca, sb, cb * sa));
        assert!(!all_roots(&ring, &ray).is_empty(), "{ray:?}");
    }
}

fn block(a: [f64; 3], b: [f64; 3]) -> Option<Container> {
    Some(Container::Box(AxisBox::new(Point3::from(a), Point3::from(b)).unwrap()))
}

#[test]
fn a_container_cuts() {
    // The plane y = 0, far and wide.
    let (mut p, u, v) = Pen::new();
    let zero = p.number(0.0);
    let domain = [[-100.0, 90.0], [-80.0, 70.0]];
    let ball = |y: f64| Some(Container::Ball(Sphere::new(Point3::new(1.0, y, 0.0), 2.0).unwrap()));
    let round = p.made([u, zero, v], domain, ball(0.5)).unwrap();
    let square = p.made([u, zero, v], domain, block([-1.0, -1.0, -2.0], [3.0, 1.0, 2.0])).unwrap();
    for case in drawn(1000) {
        let mut dice = dice(7, case);
        let (x, z) = (dice.between(-2.0, 4.0), dice.between(-3.0, 3.0));
        let ray = Ray::new(Point3::new(x, 1.0, z), Vec3::new(0.0, -1.0, 0.0));
        let inside = (x - 1.0) * (x - 1.0) + 0.25 + z * z < 4.0;
        assert_eq!(all_roots(&round, &ray).len(), usize::from(inside), "{x} {z}");
        let inside = (-1.0..=3.0).contains(&x) && (-2.0..=2.0).contains(&z);
        assert_eq!(all_roots(&square, &ray).len(), usize::from(inside), "{x} {z}");
    }
    assert_eq!(p.made([u, zero, v], domain, ball(9.0)), Err(ParametricError::Nothing));
}

fn down(x: f64, z: f64) -> Ray {
    Ray::new(Point3::new(x, 20.0, z), Vec3::new(0.0, -1.0, 0.0))
}

#[test]
fn formulas_with_poles_have_their_surface() {
    // y = 1 / u.
    let (mut p, u, v) = Pen::new();
    let one = p.number(1.0);
    let pole = p.op(Op::Div(one, u));
    for domain in [[[-2.0, 2.0], [-2.0, 2.0]], [[-1.9, 2.0], [-1.7, 2.0]]] {
        let held = block([-2.0, -10.0, -2.0], [2.0, 10.0, 2.0]);
        let hyperbola = p.made([u, pole, v], domain, held).unwrap();
        for k in 1..200 {
            let x = f64::from(k - 100) / 53.0;
            let roots = all_roots(&hyperbola, &down(x, 0.3));
            assert_eq!(roots.len(), usize::from(x != 0.0 && 1.0 / x.abs() <= 10.0), "{x} {roots:?}");
        }
    }
}

#[test]
fn formulas_with_kinks_and_rims_have_their_surface() {
    // y = |u|.
    let (mut p, u, v) = Pen::new();
    let kink = p.op(Op::Abs(u));
    let roof = p.made([u, kink, v], [[-1.9, 2.0], [-2.0, 2.0]], None).unwrap();
    for k in 0..101 {
        let x = f64::from(k - 50) / 50.0;
        let roots = all_roots(&roof, &down(x, 0.1));
        assert_eq!(roots.len(), 1, "{x} {roots:?}");
        assert!(roots[0].lo <= 20.0 - x.abs() && 20.0 - x.abs() <= roots[0].hi, "{x} {roots:?}");
    }
    // A hemisphere: y = sqrt(1 - u^2 - v^2), undefined beyond the rim.
    let one = p.number(1.0);
    let (uu, vv) = (p.op(Op::Sqr(u)), p.op(Op::Sqr(v)));
    let sum = p.plus(uu, vv);
    let rest = p.op(Op::Sub(one, sum));
    let y = p.op(Op::Sqrt(rest));
    let dome = p.made([u, y, v], [[-1.0, 1.0]; 2], None).unwrap();
    for case in drawn(500) {
        let mut dice = dice(8, case);
        let (x, z) = (dice.between(-1.1, 1.1), dice.between(-1.1, 1.1));
        let roots = all_roots(&dome, &down(x, z));
        assert_eq!(roots.len(), usize::from(x * x + z * z < 1.0), "{x} {z} {roots:?}");
    }
}

#[test]
fn points_are_within_their_bounds_and_rays_leave_them() {
    let shapes = [sphere(), torus(1.0, 0.25)];
    let mut seen = 0;
    for case in drawn(300) {
        let mut dice = dice(9, case);
        let shape = &shapes[case as usize % 2];
        let ray = Ray::new((dice.vector() * 3.0).to_point(), dice.vector());
        if !ray.is_valid() {
            continue;
        }
        let local = LocalRay::new(&ray);
        let mut all = All::default();
        shape.roots(&local, &mut all);
        for root in all.roots.iter().filter(|r| r.kind == RootKind::Simple) {
            let p = shape.resolve(&local, root, Need::ALL);
            seen += 1;
            assert!(p.ng.to_vec().length() > 0.999 && p.dp.is_finite(), "{p:?}");
            let away = (p.p - ray.at(root.t)).abs() - p.dp;
            let rounding = 64.0 * U * (3.0 + root.t.abs() * ray.direction.max_abs());
            assert!((0..3).all(|k| away[k] < rounding), "{p:?} {root:?} {ray:?}");
            if case % 2 == 0 {
                assert!(p.p.to_vec().cross(p.ng.to_vec()).length() < 1e-9, "{p:?}");
            }
            for sign in [1.0, -1.0] {
                let near = all_roots(shape, &p.spawn(p.ng.to_vec() * sign));
                let first = near.first().map_or(f64::INFINITY, |r| r.lo);
                assert!(p.bend.is_infinite() || first > 2.0 * p.off, "{p:?} {near:?} {ray:?}");
            }
        }
    }
    assert!(seen > 20);
    // At the poles the normal is the limit.
    let ray = Ray::new(Point3::new(0.0, 3.0, 0.0), Vec3::new(0.0, -1.0, 0.0));
    let local = LocalRay::new(&ray);
    let mut all = All::default();
    shapes[0].roots(&local, &mut all);
    assert_eq!(all.roots.len(), 2, "{:?}", all.roots);
    for (root, y) in all.roots.iter().zip([1.0, -1.0]) {
        let p = shapes[0].resolve(&local, root, Need::ALL);
        assert!((p.p.y - y).abs() < 1e-12 && p.ng.to_vec().cross(Vec3::Y).length() < 1e-6, "{p:?}");
    }
}

#[test]
fn powers_of_two_change_nothing() {
    let made = |by: f64| {
        let (mut p, u, v) = Pen::new();
        let (s, e) = (p.of(Function::Sin, u), p.of(Function::Exp, v));
        let w = p.times(s, e);
        let k = p.number(by);
        let all = [u, w, v].map(|x| p.times(k, x));
        p.made(all, [[-3.0, 3.0], [-1.0, 1.0]], None).unwrap()
    };
    let plain = made(1.0);
    for k in [-200, -40, 30, 150] {
        let by = durer_math::scale::ldexp(1.0, k);
        let large = made(by);
        for case in drawn(40) {
            let mut dice = dice(10, case);
            let ray = Ray::new((dice.vector() * 3.0).to_point(), dice.vector()).with_range(-1e9, 1e9);
            let (o, d) = (ray.origin.to_vec() * by, ray.direction * by);
            let other = Ray::new(o.to_point(), d).with_range(-1e9, 1e9);
            let (a, b) = (all_roots(&plain, &ray), all_roots(&large, &other));
            let told = |roots: &[Root]| roots.iter().map(|r| (r.kind, r.sign)).collect::<Vec<_>>();
            assert_eq!(told(&a), told(&b), "2^{k} {ray:?}");
            assert!(a.iter().zip(&b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi), "2^{k} {a:?} {b:?}");
        }
    }
}

#[test]
fn bad_surfaces_are_named() {
    let (mut p, u, v) = Pen::new();
    let with = |p: &Pen, domain| p.made([u, v, u], domain, None).unwrap_err().to_string();
    assert_eq!(
        with(&p, [[1.0, 0.0], [0.0, 1.0]]),
        "parametric: u must go from a number to a greater one, got 1 to 0"
    );
    assert!(with(&p, [[0.0, 1.0], [0.0, f64::NAN]]).contains("v must go from"));
    assert!(with(&p, [[f64::NEG_INFINITY, 1.0], [0.0, 1.0]]).contains("u must go from"));
    let (three, two) = (p.0.finish(u, 3), p.0.finish(v, 2));
    assert_eq!(
        Parametric::new([&two, &three, &two], [[0.0, 1.0]; 2], None).unwrap_err().to_string(),
        "parametric: its functions have two arguments, u and v; that of y has 3"
    );
    let domain = [[0.5, 1.7], [0.0, 1.0]];
    let floor = p.of(Function::Floor, u);
    assert!(matches!(p.made([u, floor, v], domain, None), Err(ParametricError::Jump { .. })));
    let minus = p.number(-1.0);
    let none = p.op(Op::Sqrt(minus));
    assert_eq!(p.made([u, none, v], domain, None), Err(ParametricError::Nothing));
    assert_eq!(p.made([minus, minus, minus], domain, None), Err(ParametricError::Nothing));
    // Unbounded without a container.
    let one = p.number(1.0);
    let shifted = p.op(Op::Sub(u, one));
    let pole = p.op(Op::Div(one, shifted));
    let made = p.made([u, pole, v], domain, None);
    assert!(matches!(made, Err(ParametricError::Unbounded { .. })), "{made:?}");
}

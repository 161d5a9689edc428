//! The gauge against multi-precision arithmetic; its crossings, points and sides against that and
//! against the tape.

use super::gauge::{Sample, VALUE};
use super::{Answer, Gauge};
use crate::implicit::{Isosurface, superellipsoid};
use crate::laws::{self, TestRng};
use crate::{All, Any, Closest, LocalPoint, LocalRay, Need, Root, RootKind, Side, Surface};
use astro_float::{BigFloat, Consts, RoundingMode};
use durer_math::{Isa, Point3, Ray, RaySide, U, Vec3};

pub(in crate::implicit) const P: usize = 320;
pub(in crate::implicit) const RM: RoundingMode = RoundingMode::ToEven;

/// Exponents: ordinary ones, those of the tests' polynomials, those at both ends.
const SHAPES: [(f64, f64); 14] = [
    (1.0, 1.0),
    (0.25, 0.25),
    (0.5, 1.4),
    (1.7, 0.3),
    (2.0, 2.0),
    (2.0, 1.0),
    (1.0, 2.0),
    (0.05, 0.05),
    (2.0, 0.0625),
    (0.0625, 2.0),
    (1.9999, 0.01),
    (0.0078125, 0.0078125),
    (1.3, 1.1),
    (0.7, 0.9),
];

pub(in crate::implicit) fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, P)
}

/// `sign * x`, as f64.
pub(in crate::implicit) fn number(x: &BigFloat) -> f64 {
    x.to_string().parse().unwrap_or(f64::NAN)
}

/// Multi-precision arithmetic with its constants.
pub(in crate::implicit) struct Exact(Consts);

impl Exact {
    pub(in crate::implicit) fn new() -> Self {
        Self(Consts::new().unwrap())
    }

    fn pow(&mut self, x: &BigFloat, y: &BigFloat) -> BigFloat {
        if x.is_zero() {
            return big(0.0);
        }
        x.ln(P, RM, &mut self.0).mul(y, P, RM).exp(P, RM, &mut self.0)
    }

    /// The gauge at a point, and the sizes of the gradient's parts.
    pub(in crate::implicit) fn gauge(
        &mut self,
        (e, n): (f64, f64),
        x: &[BigFloat; 3],
    ) -> (BigFloat, [BigFloat; 3]) {
        let one = big(1.0);
        let (p, q) = (big(2.0).div(&big(e), P, RM), big(2.0).div(&big(n), P, RM));
        let [x, y, z] = [0, 1, 2].map(|i| x[i].abs());
        let sum = self.pow(&x, &p).add(&self.pow(&y, &p), P, RM);
        let across = self.pow(&sum, &one.div(&p, P, RM));
        let sum = self.pow(&across, &q).add(&self.pow(&z, &q), P, RM);
        let value = self.pow(&sum, &one.div(&q, P, RM));
        let mut part = |a: &BigFloat, b: &BigFloat, p: &BigFloat| {
            let ratio = a.div(b, P, RM);
            self.pow(&ratio, &p.sub(&one, P, RM))
        };
        let outer = part(&across, &value, &q);
        let gradient = [
            part(&x, &across, &p).mul(&outer, P, RM),
            part(&y, &across, &p).mul(&outer, P, RM),
            part(&z, &value, &q),
        ];
        (value, gradient)
    }

    /// Whether the ray's exact point at `t` is outside (1), inside (-1) or on the surface.
    fn side(&mut self, shape: (f64, f64), ray: &Ray, t: f64) -> i32 {
        let wide = 2500;
        let x = [0, 1, 2].map(|i| {
            let way = big(t).mul(&big(ray.direction[i]), wide, RM);
            big(ray.origin[i]).add(&way, wide, RM)
        });
        let (value, _) = self.gauge(shape, &x);
        value.cmp(&big(1.0)).map_or(0, |o| o.signum() as i32)
    }
}

/// A number within 1, often 0, 1, tiny, or next to another of the two.
pub(in crate::implicit) fn coordinate(dice: &mut TestRng) -> f64 {
    let x = match dice.below(8) {
        0 => 0.0,
        1 => 1.0,
        2 => dice.scale(-70, 0),
        3 => 1.0 - dice.scale(-50, 0),
        _ => dice.unit(),
    };
    if dice.once_in(2) { -x } else { x }
}

/// A point near the surface, as near as `far`.
fn near_surface(dice: &mut TestRng, shape: (f64, f64), far: f64) -> Vec3 {
    let x = loop {
        let mut x = Vec3::new(coordinate(dice), coordinate(dice), coordinate(dice));
        if dice.once_in(6) {
            x.y = x.x;
        }
        if dice.once_in(6) {
            x.z = x.x;
        }
        if x != Vec3::ZERO {
            break x;
        }
    };
    let gauge = Gauge::new(shape.0, shape.1).unwrap();
    let mut sample = Sample::new();
    gauge.sample(Isa::detect(), &Vec3::splat(x), &mut sample);
    x * ((1.0 + far * (2.0 * dice.unit() - 1.0)) / sample.value.0[0])
}

/// Rays at the surface: through it anywhere, all but tangent, through its edges and along the axes,
/// from near and far, in all kinds of ranges.
fn aimed(dice: &mut TestRng, shape: (f64, f64)) -> Ray {
    let far = dice.pick(&[0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3]);
    let through = near_surface(dice, shape, far);
    let mut direction = Vec3::new(coordinate(dice), coordinate(dice), coordinate(dice));
    match dice.below(5) {
        // In the tangent plane.
        0 | 1 => {
            let gauge = Gauge::new(shape.0, shape.1).unwrap();
            let mut sample = Sample::new();
            gauge.sample(Isa::detect(), &Vec3::splat(through), &mut sample);
            let n = sample.gradient.lane(0);
            direction = n.cross(direction) + n * dice.pick(&[0.0, 1e-12, 1e-7, 1e-3]);
        }
        2 => direction = Vec3::from([0, 1, 2].map(|i| f64::from(u8::from(i == dice.below(3))))),
        3 => direction = through * dice.pick(&[1.0, -0.5]),
        _ => {}
    }
    if direction.max_abs() < 1e-200 {
        direction = Vec3::new(0.3, -0.2, 0.9);
    }
    let direction = direction * dice.pick(&[1.0, 1e-6, 1e9]);
    let length = direction.length();
    let back = dice.pick(&[0.0, 0.5, 3.0, 10.0, 1e3, 1e6]) * dice.unit() / length;
    let ray = Ray::new(through.to_point() - direction * back, direction);
    match dice.below(4) {
        0 => ray.with_range(f64::NEG_INFINITY, f64::INFINITY),
        1 => ray.with_range(back * dice.unit(), back * (0.5 + dice.unit())),
        _ => ray,
    }
}

fn of_the_tape(surface: &Isosurface, ray: &LocalRay<'_>) -> Vec<Root> {
    let mut sink = All::default();
    surface.roots_of_the_tape(ray, &mut sink);
    sink.roots
}

#[test]
fn values_and_gradients_keep_their_bounds() {
    let (mut exact, mut dice) = (Exact::new(), TestRng::new(1));
    let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
    for round in 0..700 {
        let shape = SHAPES[round % SHAPES.len()];
        let gauge = Gauge::new(shape.0, shape.1).unwrap();
        let far = dice.pick(&[0.0, 1e-3, 0.7]);
        let x = near_surface(&mut dice, shape, far);
        let mut sample = Sample::new();
        gauge.sample(Isa::detect(), &Vec3::splat(x), &mut sample);
        // A coordinate's least size is that of the gauge's own.
        let floored = x.to_array().map(|x| big(x.abs().max(durer_math::scale::pow2(-64))));
        let (value, gradient) = exact.gauge(shape, &floored);
        let error = number(&big(sample.value.0[0]).sub(&value, P, RM).div(&value, P, RM).abs());
        assert!(error <= VALUE, "{shape:?} {x:?}: {} u", error / U);
        worst = worst.max(error);
        for i in 0..3 {
            let (got, want) = (sample.gradient.lane(0)[i], &gradient[i]);
            assert!(got == 0.0 || x[i] == 0.0 || got.signum() == x[i].signum());
            // Crossings that small do not count, and may be lost.
            if number(want) < durer_math::scale::pow2(-60) || x[i].abs() < durer_math::scale::pow2(-63) {
                assert!(
                    got.abs() < durer_math::scale::pow2(-59) || x[i].abs() < durer_math::scale::pow2(-63)
                );
                continue;
            }
            let error = number(&big(got.abs()).sub(want, P, RM).div(want, P, RM).abs());
            assert!(error <= gauge.turn, "{shape:?} {x:?} {i}: {got:e} {want} {} u", error / U);
            turned = turned.max(error / gauge.turn);
        }
    }
    println!("value: at most {:.1} u; gradient: at most {turned:.3} of its bound", worst / U);
}

#[test]
fn all_paths_give_the_same_bits() {
    let mut dice = TestRng::new(2);
    for round in 0..200 {
        let shape = SHAPES[round % SHAPES.len()];
        let gauge = Gauge::new(shape.0, shape.1).unwrap();
        let x = Vec3::splat(near_surface(&mut dice, shape, 0.5));
        let bits = |isa| {
            let mut sample = Sample::new();
            gauge.sample(isa, &x, &mut sample);
            let n = sample.gradient;
            [sample.value, n.x, n.y, n.z].map(|x| x.0.map(f64::to_bits))
        };
        assert!(Isa::available().all(|isa| bits(isa) == bits(Isa::REFERENCE)));
    }
}

/// Brackets overlap one by one where all roots are certain; what is not certain to one of the two
/// is a touch, or near an end of the range.
#[test]
fn the_crossings_are_those_of_the_tape() {
    let mut all_rays = 0;
    for (number, shape) in SHAPES.into_iter().enumerate() {
        let surface = superellipsoid(shape.0, shape.1).unwrap();
        let gauge = surface.gauge.clone().unwrap();
        let (mut told, mut met, mut rays) = (0, 0, 0);
        for case in laws::drawn(1_000) {
            let mut dice = laws::dice(3 + number as u64, case);
            let ray = aimed(&mut dice, shape);
            if !ray.is_valid() {
                continue;
            }
            let rough = dice.once_in(2);
            let local = LocalRay::new(&ray);
            let local = if rough { local.roughly() } else { local };
            rays += 1;
            let mut sink = All::default();
            if gauge.roots(&local, &mut sink) != Answer::All {
                assert!(sink.roots.is_empty(), "{shape:?} {ray:?}: shown before it was known");
                continue;
            }
            told += 1;
            let (a, b) = (sink.roots, of_the_tape(&surface, &local));
            met += a.len();
            assert!(
                a.iter().all(|r| r.kind == RootKind::Simple && r.lo <= r.t && r.t <= r.hi),
                "{ray:?}: {a:?}"
            );
            // A root of one that may lie beyond the range's end is one that the other may have left
            // out.
            let sure = |r: &&Root| r.lo >= ray.t_min && r.hi <= ray.t_max;
            let certain = |r: &&Root| sure(r) && r.kind == RootKind::Simple;
            let meets = |r: &Root, of: &[Root]| of.iter().any(|o| o.lo <= r.hi && r.lo <= o.hi);
            for root in b.iter().filter(certain) {
                assert!(meets(root, &a), "{shape:?} {ray:?} {rough}: lost {root:?} of {b:?}, has {a:?}");
            }
            for root in a.iter().filter(sure) {
                assert!(meets(root, &b), "{shape:?} {ray:?} {rough}: {root:?} of {a:?} is none of {b:?}");
            }
            let signs: Vec<_> = a.iter().map(|r| r.sign).collect();
            assert!(matches!(signs.as_slice(), [] | [-1] | [1] | [-1, 1]), "{ray:?}: {a:?}");
            // Whoever asks less is told the same.
            let (mut closest, mut any) = (Closest::default(), Any::default());
            assert_eq!(
                (gauge.roots(&local, &mut closest), gauge.roots(&local, &mut any)),
                (Answer::All, Answer::All)
            );
            assert_eq!((closest.root, any.hit), (a.first().copied(), !a.is_empty()));
        }
        println!("{shape:?}: {told} of {rays} rays, {met} crossings");
        assert!(told * 10 >= rays * 7 && met > 300, "{shape:?}: {told} of {rays} rays, {met}");
        all_rays += rays;
    }
    laws::report(all_rays);
}

#[test]
fn nearly_every_ray_of_a_picture_is_told_without_the_tape() {
    let mut dice = TestRng::new(4);
    for shape in SHAPES {
        let gauge = Gauge::new(shape.0, shape.1).unwrap();
        let mut open = 0;
        for _ in 0..4_000 {
            let eye = Vec3::new(dice.between(-4.0, 4.0), dice.between(-4.0, 4.0), -5.0);
            let at = Vec3::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
            let ray = Ray::new(eye.to_point(), at - eye);
            open += usize::from(
                gauge.roots(&LocalRay::new(&ray).roughly(), &mut Closest::default()) != Answer::All,
            );
        }
        println!("{shape:?}: {open} of 4000 ask the tape");
        assert!(open <= 8, "{shape:?}: {open}");
    }
}

#[test]
fn brackets_have_certain_signs_at_their_ends() {
    let mut exact = Exact::new();
    let (mut rays, mut roots, mut widths) = (0, 0, Vec::new());
    for case in laws::drawn(700) {
        let mut dice = laws::dice(5, case);
        let shape = SHAPES[(case % SHAPES.len() as u64) as usize];
        let gauge = Gauge::new(shape.0, shape.1).unwrap();
        let ray = aimed(&mut dice, shape);
        if !ray.is_valid() {
            continue;
        }
        rays += 1;
        let rough = dice.once_in(2);
        let local = LocalRay::new(&ray);
        let local = if rough { local.roughly() } else { local };
        let mut sink = All::default();
        gauge.roots(&local, &mut sink);
        for root in &sink.roots {
            let (lo, hi) = (exact.side(shape, &ray, root.lo), exact.side(shape, &ray, root.hi));
            let sign = i32::from(root.sign);
            assert_eq!((lo, hi), (-sign, sign), "{shape:?} {ray:?}: {root:?}");
            roots += 1;
            if !rough {
                let size = (root.t.abs() * ray.direction.length()).max(1.0);
                widths.push((root.hi - root.lo) * ray.direction.length() / (size * f64::EPSILON));
            }
        }
    }
    laws::report(rays);
    widths.sort_by(f64::total_cmp);
    println!("{roots} roots, widths of narrow ones: median {:.1} ulp", widths[widths.len() / 2]);
    assert!(roots > 600 && widths[widths.len() / 2] < 2000.0);
}

#[test]
fn rays_leave_what_they_were_spawned_on() {
    let (mut exact, mut dice) = (Exact::new(), TestRng::new(6));
    let (mut spawned, mut alone) = (0, 0);
    let surfaces = SHAPES.map(|(e, n)| superellipsoid(e, n).unwrap());
    for round in 0..700 {
        let shape = SHAPES[round % SHAPES.len()];
        let surface = &surfaces[round % SHAPES.len()];
        let gauge = surface.gauge.clone().unwrap();
        let through = near_surface(&mut dice, shape, 0.3);
        let direction = Vec3::new(coordinate(&mut dice), coordinate(&mut dice), 0.37 - dice.unit());
        let ray = Ray::new(through.to_point() - direction * 3.0, direction);
        let local = LocalRay::new(&ray);
        let local = if dice.once_in(2) { local.roughly() } else { local };
        let mut sink = All::default();
        surface.roots(&local, &mut sink);
        for root in sink.roots.iter().filter(|r| r.kind == RootKind::Simple) {
            let point = surface.resolve(&local, root, Need::ALL);
            let length = point.ng.to_vec().length();
            assert!((length - 1.0).abs() < 1e-12 && point.off < 1e-9, "{shape:?} {point:?}");
            for (side, way) in [(RaySide::Front, 1.0), (RaySide::Back, -1.0)] {
                let wild = Vec3::new(coordinate(&mut dice), coordinate(&mut dice), coordinate(&mut dice));
                let out = point.spawn_from(side, point.ng.to_vec() * way + wild * 0.9);
                let truth = exact.side(shape, &Ray::new(out.origin, Vec3::X), 0.0);
                assert_eq!(f64::from(truth), way, "{shape:?} {ray:?}: {point:?}, {out:?}");
                let local = LocalRay::new(&out).from_side(Some(side)).roughly();
                let mut met = All::default();
                surface.roots(&local, &mut met);
                // From inside there is one way out; from outside a convex solid is not met again by
                // a ray that goes away from it.
                let leaves = out.direction.dot(point.ng.to_vec()) * way > 1e-6;
                if side == RaySide::Back || leaves {
                    let expected = usize::from(side == RaySide::Back);
                    assert_eq!(
                        met.roots.len(),
                        expected,
                        "{shape:?} {out:?} from {point:?}: {:?}",
                        met.roots
                    );
                }
                spawned += 1;
                alone += usize::from(gauge.roots(&local, &mut All::default()) == Answer::All);
            }
        }
    }
    println!("{alone} of {spawned} without the tape");
    assert!(spawned > 1_500 && alone * 100 > spawned * 95, "{alone} of {spawned}");
}

/// The surface leaves the tangent plane by no more than `bend` says, and its normal turns by no
/// more.
#[test]
fn the_bend_bounds_the_curvature() {
    let mut dice = TestRng::new(7);
    let mut told = 0;
    for round in 0..4_000 {
        let shape = SHAPES[round % SHAPES.len()];
        let gauge = Gauge::new(shape.0, shape.1).unwrap();
        let near = near_surface(&mut dice, shape, 0.0).to_point();
        let Some(foot) = gauge.foot(near, (1e-9, 1e-9)) else { continue };
        let way = 256.0 * U * (1.0 + dice.unit());
        let aside = foot.n.cross(Vec3::new(coordinate(&mut dice), coordinate(&mut dice), 0.3));
        let Some(other) = gauge.foot(foot.p + aside * (way / aside.length()), (1e-9, 1e-9)) else { continue };
        let apart = other.p - foot.p;
        let height = foot.n.dot(apart).abs();
        let most = 0.5 * foot.bend * apart.dot(apart) + foot.off + other.off;
        assert!(height <= most, "{shape:?} {:?}: {height:e} {most:e}", foot.p);
        let turned = (foot.n - other.n).length();
        assert!(
            turned <= foot.bend * apart.length() + 1e-12,
            "{shape:?} {:?} {:?} {turned} {:e}",
            foot.p,
            other.p,
            foot.bend
        );
        told += 1;
    }
    assert!(told > 3_000, "{told}");
}

#[test]
fn a_point_is_inside_where_the_gauge_is_below_one() {
    let (mut exact, mut dice) = (Exact::new(), TestRng::new(8));
    let surfaces = SHAPES.map(|(e, n)| superellipsoid(e, n).unwrap());
    let mut told = 0;
    for round in 0..1_000 {
        let (shape, surface) = (SHAPES[round % SHAPES.len()], &surfaces[round % SHAPES.len()]);
        let far = dice.pick(&[1e-15, 1e-12, 1e-6, 0.5]);
        let p = near_surface(&mut dice, shape, far).to_point();
        let truth = exact.side(shape, &Ray::new(p, Vec3::X), 0.0);
        let side = surface.side(&LocalPoint::new(p));
        match side {
            Side::In => assert_eq!(truth, -1, "{shape:?} {p:?}"),
            Side::Out => assert_eq!(truth, 1, "{shape:?} {p:?}"),
            Side::On => {}
        }
        told += usize::from(side != Side::On);
    }
    assert!(told > 500, "{told}");
}

#[test]
fn what_has_dents_has_no_gauge() {
    for (e, n) in [(2.0_f64.next_up(), 1.0), (1.0, 2.5), (3.0, 3.0), (1e-3, 1.0), (1.0, 1e-9)] {
        assert!(Gauge::new(e, n).is_none() && superellipsoid(e, n).unwrap().gauge.is_none());
    }
    let origin = Point3::ORIGIN;
    let along = Ray::new(origin - Vec3::X * 4.0, Vec3::X);
    let mut sink = All::default();
    assert_eq!(Gauge::new(2.0, 2.0).unwrap().roots(&LocalRay::new(&along), &mut sink), Answer::All);
    assert!(sink.roots.iter().map(|r| r.t).eq([3.0, 5.0]), "{:?}", sink.roots);
}

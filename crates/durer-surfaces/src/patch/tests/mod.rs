//! Tests of patches.

mod creases;
mod flat;
mod poles;
mod sewn;
mod triangular;
mod trims;
mod witness;

use super::*;
use crate::laws::{Exact, TestRng, all_roots, drawn, report};
use crate::{All, LocalRay, RootKind, Surface};
use durer_math::{Ray, U, Vec3};
use witness::{Place, Witness};

/// What was seen.
#[derive(Debug, Default)]
struct Tally {
    rays: u64,
    untested: u64,
    roots: u64,
    uncertain: u64,
    outside: u64,
    /// In ulp of the distance or the size.
    widths: Vec<f64>,
}

impl Tally {
    /// Prints what was seen. The median width of brackets.
    fn tell(&mut self) -> f64 {
        self.widths.sort_by(f64::total_cmp);
        let median = self.widths.get(self.widths.len() / 2).copied().unwrap_or(0.0);
        let Self { rays, untested, roots, uncertain, outside, .. } = self;
        println!(
            "{rays} rays, {untested} not tested, {roots} roots, {uncertain} uncertain, {outside} beside, {median} ulp"
        );
        // Half of the rays aim at edges.
        assert!(*outside * 25 < *roots, "too many roots beside an edge");
        // Touches aside, double-double decides all of them.
        assert!(*uncertain * 25 <= *roots, "too many uncertain roots");
        median
    }
}

/// A surface of one face that is tested.
trait Subject: Surface + Patches + core::fmt::Debug {
    const IS_TRIANGLE: bool;

    fn witness(&self, ray: &Ray) -> Witness;

    /// What a failure shows of it.
    fn shown(&self) -> String;

    /// Whether a crossing is surely on it.
    fn has(place: &Place) -> bool {
        let one = Exact::from(1.0);
        (0..2).all(|k| place.low[k].sign().is_ge() && (&one - &place.high[k]).sign().is_ge())
            && (!Self::IS_TRIANGLE || (&(&one - &place.high[0]) - &place.high[1]).sign().is_ge())
    }
}

impl Subject for BezierPatch {
    const IS_TRIANGLE: bool = false;

    fn witness(&self, ray: &Ray) -> Witness {
        Witness::new(self.size(), self.points(), ray)
    }

    fn shown(&self) -> String {
        format!("{:?} {:?}", self.size(), self.points())
    }
}

fn within(place: &Place, uv: [f64; 2], room: f64) -> bool {
    (0..2).all(|k| {
        let (low, high) = (place.low[k].to_f64(), place.high[k].to_f64());
        uv[k] >= low - room && uv[k] <= high + room
    })
}

/// Every proven crossing is found once, and nothing else is called a crossing.
fn check<P: Subject>(patch: &P, ray: &Ray, tally: &mut Tally) {
    let roots = all_roots(patch, ray);
    let witness = patch.witness(ray);
    let Some(places) = witness.places() else {
        tally.untested += 1;
        return;
    };
    tally.rays += 1;
    let told = || {
        let places: Vec<_> = places
            .iter()
            .map(|p| {
                let at = [0, 1].map(|k| (p.low[k].to_f64(), p.high[k].to_f64()));
                (at, p.proven, p.sign)
            })
            .collect();
        format!("{roots:?}\n  exact {places:?}\n  {ray:?}\n  {}", patch.shown())
    };
    let mut used = vec![0; places.len()];
    for root in &roots {
        tally.roots += 1;
        assert!(root.lo <= root.t && root.t <= root.hi, "t is not in its bracket: {}", told());
        if root.kind != RootKind::Simple {
            tally.uncertain += 1;
            continue;
        }
        let unit = root.t.abs().max(patch.bounds().magnitude() / ray.direction.length());
        tally.widths.push((root.hi - root.lo) / (2.0 * U * unit));
        // Crossings near each other have different brackets or different parameters.
        // Where the bracket is wide, the parameters are off by about as much.
        let wide = 8.0 * (root.hi - root.lo) * ray.direction.length() / patch.bounds().magnitude();
        let fits: Vec<usize> = (0..places.len())
            .filter(|&k| {
                within(&places[k], root.tag, 1e-7 + wide) && witness.fits(&places[k], root.lo, root.hi)
            })
            .collect();
        let near = |k: &usize| {
            let at = [0, 1].map(|i| places[*k].low[i].to_f64() - root.tag[i]);
            at[0].abs().max(at[1].abs())
        };
        let Some(k) = fits.into_iter().min_by(|a, b| near(a).total_cmp(&near(b))) else {
            // Just outside of an edge, by less than it is known.
            let on_edge = root.tag.iter().any(|x| *x == 0.0 || *x == 1.0)
                || P::IS_TRIANGLE && root.tag[0] + root.tag[1] >= 1.0 - 4.0 * U;
            assert!(on_edge, "an extra crossing {root:?}: {}", told());
            tally.outside += 1;
            continue;
        };
        used[k] += 1;
        assert!(used[k] == 1, "a crossing is found twice {root:?}: {}", told());
        assert!(
            !places[k].proven || places[k].sign == root.sign,
            "the sign of {root:?} is wrong: {}",
            told()
        );
    }
    for (place, used) in places.iter().zip(&used) {
        let uncertain =
            || roots.iter().any(|r| r.kind != RootKind::Simple && witness.fits(place, r.lo, r.hi));
        if place.proven && P::has(place) && *used == 0 {
            assert!(uncertain(), "a crossing is missing at {place:?}: {}", told());
        }
    }
    assert!(roots.windows(2).all(|w| w[0].t <= w[1].t), "roots do not ascend: {}", told());
}

/// A net of small numbers, now and then with a collapsed edge or equal points.
fn net(dice: &mut TestRng, size: [usize; 2], weights: bool) -> Vec<[f64; 4]> {
    let wild = dice.once_in(2);
    let [nu, nv] = size;
    let mut points = Vec::new();
    for j in 0..nv {
        for i in 0..nu {
            let flat = Vec3::new(i as f64, j as f64, 0.0) * 4.0;
            let p = flat + if wild { dice.lattice(8) } else { dice.vector() * 6.0 };
            let w = if weights { dice.pick(&[1.0, 1.0, 0.5, 2.0, 3.0, 0.25]) } else { 1.0 };
            points.push([p.x * 0.125, p.y * 0.125, p.z * 0.125, w]);
        }
    }
    match dice.below(8) {
        0 => (1..nu).for_each(|i| points[i] = points[0]),
        1 => (0..nv).for_each(|j| points[j * nu + nu - 1] = points[nu - 1]),
        2 => points[1] = points[0],
        _ => {}
    }
    points
}

/// A ray at a corner, an edge, the middle or anywhere; along a tangent or not.
fn aimed<P: Subject>(dice: &mut TestRng, patch: &P) -> Ray {
    let parameter = |dice: &mut TestRng| match dice.below(5) {
        0 => 0.0,
        1 => 1.0,
        2 => 0.5,
        3 => dice.integer(0, 16) / 16.0,
        _ => dice.unit(),
    };
    let mut uv = [parameter(dice), parameter(dice)];
    if P::IS_TRIANGLE && uv[0] + uv[1] > 1.0 {
        uv = if dice.once_in(2) { [1.0 - uv[0], 1.0 - uv[1]] } else { [uv[0], 1.0 - uv[0]] };
    }
    let shell = patch.shell();
    let jet = shell.faces[0].jet(uv);
    let scale = durer_math::scale::ldexp(1.0, shell.scale);
    let target = shell.centre + jet.p * scale;
    let tangent = jet.pu * dice.between(-1.0, 1.0) + jet.pv * dice.between(-1.0, 1.0);
    let direction = match dice.below(6) {
        0 => tangent,
        1 => tangent + dice.vector() * (tangent.length() * dice.scale(-40, -4)),
        2 => dice.lattice(4),
        3 => dice.pick(&[Vec3::X, Vec3::Y, Vec3::Z]),
        _ => dice.vector(),
    };
    let direction = if direction == Vec3::ZERO { Vec3::Z } else { direction };
    let back = dice.pick(&[0.0, 1.0, 1.0, 3.0, 1000.0]);
    Ray::new(target - direction * back, direction).with_range(-1e9, 1e9)
}

fn run(seed: u64, count: u64, rays: u64, size: impl Fn(&mut TestRng) -> [usize; 2], weights: bool) -> Tally {
    let mut tally = Tally::default();
    for case in drawn(count) {
        let mut dice = crate::laws::dice(seed, case);
        let size = size(&mut dice);
        let points = net(&mut dice, size, weights);
        let Ok(patch) = BezierPatch::rational(size, &points) else { continue };
        for _ in 0..rays {
            let ray = aimed(&mut dice, &patch);
            if ray.is_valid() {
                check(&patch, &ray, &mut tally);
            }
        }
    }
    report(tally.rays);
    tally
}

#[test]
fn bicubic_patches_have_their_exact_crossings() {
    let mut tally = run(1, 20, 8, |_| [4, 4], false);
    let median = tally.tell();
    assert!(tally.rays > 100 && tally.roots > 100, "{}", tally.rays);
    assert!(median < 32.0, "{median}");
}

#[test]
fn patches_of_other_degrees_have_their_exact_crossings() {
    let size = |dice: &mut TestRng| [2 + dice.below(4) as usize, 2 + dice.below(5) as usize];
    let mut tally = run(2, 25, 6, size, false);
    tally.tell();
    assert!(tally.rays > 90 && tally.roots > 90);
}

#[test]
fn rational_patches_have_their_exact_crossings() {
    let size = |dice: &mut TestRng| [2 + dice.below(3) as usize, 2 + dice.below(3) as usize];
    let mut tally = run(3, 25, 6, size, true);
    tally.tell();
    assert!(tally.rays > 90 && tally.roots > 90);
}

#[test]
fn a_saddle_is_met_once() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    let patch = BezierPatch::new([2, 2], &corners.map(Point3::from)).unwrap();
    for (x, y) in [(0.5, 0.25), (0.0, 0.0), (1.0, 1.0), (1.0, 0.5), (0.5, 0.5), (0.25, 0.75)] {
        let ray = Ray::new(Point3::new(x, y, 2.0), Vec3::new(0.0, 0.0, -1.0));
        let roots = all_roots(&patch, &ray);
        assert_eq!(roots.len(), 1, "{x} {y} {roots:?}");
        let t = 2.0 - x * y;
        assert!(roots[0].lo <= t && t <= roots[0].hi, "{x} {y} {roots:?}");
        assert!(roots[0].hi - roots[0].lo < 64.0 * f64::EPSILON, "{x} {y} {roots:?}");
        assert_eq!(roots[0].sign, -1);
    }
}

/// Weights that are all the same change nothing.
#[test]
fn equal_weights_are_no_weights() {
    let mut dice = crate::laws::dice(5, 0);
    let points = net(&mut dice, [4, 4], false);
    let heavy: Vec<_> = points.iter().map(|&[x, y, z, _]| [x, y, z, 3.0]).collect();
    let [plain, heavy] = [&points, &heavy].map(|p| BezierPatch::rational([4, 4], p).unwrap());
    for _ in 0..50 {
        let ray = aimed(&mut dice, &plain);
        let (a, b) = (all_roots(&plain, &ray), all_roots(&heavy, &ray));
        if a.iter().chain(&b).all(|r| r.kind == RootKind::Simple) {
            assert_eq!(a.len(), b.len(), "{ray:?}");
            assert!(a.iter().zip(&b).all(|(a, b)| a.lo <= b.hi && b.lo <= a.hi), "{a:?} {b:?}");
        }
    }
}

/// A cube's surface in six patches, each point moved: neighbours share their edges' points.
fn closed_body(dice: &mut TestRng) -> Vec<BezierPatch> {
    let mut moved = std::collections::HashMap::new();
    let mut patches = Vec::new();
    for axis in 0..3 {
        for end in [0, 3] {
            let mut points = Vec::new();
            for j in 0..4 {
                for i in 0..4 {
                    let mut at = [0; 3];
                    (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (end, i, j);
                    let p = moved.entry(at).or_insert_with(|| {
                        let p = Vec3::from(at.map(|k| f64::from(k) / 1.5 - 1.0));
                        (p * dice.between(0.7, 1.1) + dice.vector() * 0.1).to_point()
                    });
                    points.push(*p);
                }
            }
            patches.push(BezierPatch::new([4, 4], &points).unwrap());
        }
    }
    patches
}

#[test]
fn rays_from_inside_never_escape_through_seams() {
    let mut rays = 0_u64;
    for case in drawn(40) {
        let mut dice = crate::laws::dice(7, case);
        let body = closed_body(&mut dice);
        for _ in 0..500 {
            let patch = &body[dice.below(6) as usize];
            let side = dice.pick(&[0.0, 1.0]);
            let any = [dice.unit(), dice.unit()];
            let along = dice.pick(&[0.0, 1.0, 0.5, 0.25, any[0], any[1]]);
            let uv = if dice.once_in(2) { [side, along] } else { [along, side] };
            let scale = durer_math::scale::ldexp(1.0, patch.shell.scale);
            let target = patch.shell.centre + patch.shell.faces[0].jet(uv).p * scale;
            let origin = (dice.vector() * 0.1).to_point();
            let ray = Ray::new(origin, target - origin);
            let hits: usize = body.iter().map(|patch| all_roots(patch, &ray).len()).sum();
            assert!(hits > 0, "{ray:?} escapes from body {case}");
            rays += 1;
        }
    }
    report(rays);
}

#[test]
fn powers_of_two_change_nothing() {
    for case in drawn(20) {
        let mut dice = crate::laws::dice(11, case);
        let points = net(&mut dice, [4, 4], false);
        let Ok(patch) = BezierPatch::rational([4, 4], &points) else { continue };
        for k in [-400, -100, 60, 150] {
            let by = |x: f64| durer_math::scale::ldexp(x, k);
            let scaled: Vec<_> = points.iter().map(|&[x, y, z, w]| [by(x), by(y), by(z), w]).collect();
            let large = BezierPatch::rational([4, 4], &scaled).unwrap();
            for _ in 0..8 {
                let ray = aimed(&mut dice, &patch);
                let (o, d) = (ray.origin.to_vec().map(by).to_point(), ray.direction.map(by));
                let other = Ray::new(o, d).with_range(-1e9, 1e9);
                let (a, b) = (all_roots(&patch, &ray), all_roots(&large, &other));
                let plain =
                    |roots: &[Root]| roots.iter().map(|r| (r.t, r.lo, r.hi, r.tag)).collect::<Vec<_>>();
                assert_eq!(plain(&a), plain(&b), "2^{k} {ray:?}");
            }
        }
    }
}

#[test]
fn points_are_within_their_bounds_and_rays_leave_them() {
    for case in drawn(60) {
        let mut dice = crate::laws::dice(13, case);
        let points = net(&mut dice, [4, 4], case % 2 == 1);
        let Ok(patch) = BezierPatch::rational([4, 4], &points) else { continue };
        for _ in 0..12 {
            let ray = aimed(&mut dice, &patch);
            let local = LocalRay::new(&ray);
            let mut all = All::default();
            patch.roots(&local, &mut all);
            for root in all.roots.iter().filter(|r| r.kind == RootKind::Simple) {
                let p = patch.resolve(&local, root, Need::ALL);
                let size = patch.bounds().magnitude() + root.t.abs() * ray.direction.max_abs();
                assert!(p.ng.to_vec().length() > 0.999 && p.dp.is_finite(), "{p:?}");
                let away = (p.p - ray.at(root.t)).abs() - p.dp;
                assert!((0..3).all(|k| away[k] < 8.0 * U * size), "{p:?} {root:?} {ray:?}");
                // A ray that leaves along the normal does not meet its start again.
                for sign in [1.0, -1.0] {
                    let out = p.spawn(p.ng.to_vec() * sign);
                    let near = all_roots(&patch, &out);
                    let first = near.first().map_or(f64::INFINITY, |r| r.lo);
                    assert!(p.bend.is_infinite() || first > 2.0 * p.off, "{p:?} {near:?} {ray:?}");
                }
            }
        }
    }
}

#[test]
fn bad_nets_are_named() {
    let points = vec![[0.0, 0.0, 0.0, 1.0]; 16];
    let with = |k: usize, p: [f64; 4]| {
        let mut all: Vec<_> = (0..16).map(|i| [f64::from(i), 0.0, 1.0, 1.0]).collect();
        all[k] = p;
        BezierPatch::rational([4, 4], &all).unwrap_err().to_string()
    };
    assert_eq!(BezierPatch::rational([4, 4], &points), Err(PatchError::Nothing));
    assert_eq!(BezierPatch::rational([1, 16], &points), Err(PatchError::Size([1, 16])));
    assert_eq!(BezierPatch::rational([4, 5], &points), Err(PatchError::Count { size: [4, 5], len: 16 }));
    assert_eq!(with(2, [0.0, f64::NAN, 0.0, 1.0]), "patch: point 3 must be finite, got <0, NaN, 0>");
    assert_eq!(
        with(0, [0.0, 0.0, 0.0, 0.0]),
        "patch: the weight of point 1 must be positive and finite, got 0"
    );
    assert!(with(0, [1e90, 0.0, 0.0, 1.0]).contains("too large"));
}

/// A circle of four arcs about the y axis, with this radius, height and weight.
fn round(r: f64, y: f64, w: f64) -> Vec<[f64; 4]> {
    let h = w * 0.5_f64.sqrt();
    let at = |x: f64, z: f64, w: f64| [x * r, y, z * r, w];
    vec![
        at(1.0, 0.0, w),
        at(1.0, 1.0, h),
        at(0.0, 1.0, w),
        at(-1.0, 1.0, h),
        at(-1.0, 0.0, w),
        at(-1.0, -1.0, h),
        at(0.0, -1.0, w),
        at(1.0, -1.0, h),
        at(1.0, 0.0, w),
    ]
}

/// Patches are searched a little beyond their edges: a crossing less than a rounding from an edge may
/// be proven on the edge of one patch and within the other.
#[test]
fn a_ray_through_a_seam_of_a_tube_crosses_it_once() {
    let circle = [
        (1.0, 0.0, 1.0),
        (1.0, 1.0, 1.0),
        (0.0, 1.0, 2.0),
        (-1.0, 1.0, 1.0),
        (-1.0, 0.0, 1.0),
        (-1.0, -1.0, 1.0),
        (0.0, -1.0, 2.0),
        (1.0, -1.0, 1.0),
        (1.0, 0.0, 1.0),
    ];
    let points = [-1.0, 1.0].map(|y| circle.map(|(x, z, w)| [x, y, z, w])).concat();
    let around = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let data = NurbsData {
        degree: [2, 1],
        size: [9, 2],
        points,
        knots: [around, vec![0.0, 0.0, 1.0, 1.0]],
        ..NurbsData::default()
    };
    let tube = Nurbs::new(data).unwrap();
    let found = Ray::new(
        Point3::new(12.728884204533264, -5.874030458443029, 6.019401330923719),
        Vec3::new(-2.1315703333504676, 1.0977790370535552, -0.8405455465494965),
    );
    assert_eq!(all_roots(&tube, &found).len(), 1);
    for case in drawn(2000) {
        let mut dice = crate::laws::dice(31, case);
        let (x, z) = dice.pick(&[(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]);
        let at = Point3::new(x, dice.between(-0.5, 0.5), z);
        let mut direction = dice.vector();
        // Not along the tube: both crossings lie within its ends, and the origin outside.
        direction.y = dice.between(-0.2, 0.2) * (direction.x.abs() + direction.z.abs());
        let way = dice.between(3.0, 9.0) / direction.length();
        let ray = Ray::new(at - direction * way, direction);
        let roots = all_roots(&tube, &ray);
        if roots.iter().all(|root| root.kind == RootKind::Simple) {
            let signs: Vec<i8> = roots.iter().map(|root| root.sign).collect();
            assert!(signs == [-1, 1] || signs == [1, -1], "{case}: {ray:?} {roots:?}");
        }
    }
}

fn sphere_data() -> NurbsData {
    let h = 0.5_f64.sqrt();
    let rows = [
        round(0.0, -1.0, 1.0),
        round(1.0, -1.0, h),
        round(1.0, 0.0, 1.0),
        round(1.0, 1.0, h),
        round(0.0, 1.0, 1.0),
    ];
    NurbsData {
        degree: [2, 2],
        size: [9, 5],
        points: rows.concat(),
        knots: [
            vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
            vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0],
        ],
        ..NurbsData::default()
    }
}

fn sphere() -> Nurbs {
    Nurbs::new(sphere_data()).unwrap()
}

#[test]
fn a_sphere_of_rational_patches_is_a_sphere() {
    let sphere = sphere();
    assert_eq!(sphere.patches(), 8);
    let mut dice = crate::laws::dice(17, 0);
    let (mut exact, mut simple) = (0, 0);
    for _ in 0..4000 {
        let origin = dice.vector() * 3.0;
        let aim = match dice.below(4) {
            0 => dice.vector() * 0.9,
            1 => Vec3::new(dice.between(-0.9, 0.9), 0.0, 0.0),
            2 => Vec3::new(0.0, dice.between(-0.9, 0.9), 0.0),
            _ => Vec3::ZERO,
        };
        if aim.length() > 0.99 || origin.length() < 1.01 {
            continue;
        }
        let ray = Ray::new(origin.to_point(), aim - origin);
        let roots = all_roots(&sphere, &ray);
        let (a, b) = (ray.direction.length_squared(), origin.dot(ray.direction));
        let c = origin.length_squared() - 1.0;
        let root = (b * b - a * c).sqrt();
        let want = [(-b - root) / a, (-b + root) / a];
        assert_eq!(roots.len(), 2, "{ray:?} {roots:?} {want:?}");
        for (root, t) in roots.iter().zip(want) {
            // Its weights are rounded, so the surface is a sphere within some roundings.
            assert!((root.t - t).abs() < 1e-12, "{root:?} {t}");
            simple += u32::from(root.kind == RootKind::Simple);
            exact += 1;
        }
    }
    println!("{exact} crossings, {simple} of them proven");
    assert!(simple * 100 > exact * 97);
}

#[test]
fn rays_from_inside_a_rational_sphere_never_escape() {
    let sphere = sphere();
    for case in drawn(4000) {
        let mut dice = crate::laws::dice(19, case);
        let origin = dice.vector() * 0.3;
        // At poles and at the edges between patches.
        let (sin, cos) = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][dice.below(4) as usize];
        let tilt = dice.between(-1.5, 1.5);
        let aim = match dice.below(4) {
            0 => Vec3::new(0.0, dice.pick(&[-1.0, 1.0]), 0.0),
            1 => Vec3::new(dice.between(-1.0, 1.0), 0.0, dice.between(-1.0, 1.0)),
            _ => Vec3::new(cos * tilt, 1.0, sin * tilt),
        };
        if aim == Vec3::ZERO {
            continue;
        }
        let from = if dice.once_in(2) { Vec3::ZERO } else { origin };
        let ray = Ray::new(from.to_point(), aim - from);
        let roots = all_roots(&sphere, &ray);
        assert!(!roots.is_empty(), "{ray:?}");
    }
}

#[test]
fn nurbs_without_inner_knots_are_their_bezier_patches() {
    let mut dice = crate::laws::dice(23, 0);
    for _ in 0..30 {
        let points = net(&mut dice, [4, 3], true);
        let Ok(patch) = BezierPatch::rational([4, 3], &points) else { continue };
        let data = NurbsData { degree: [3, 2], size: [4, 3], points, ..NurbsData::default() };
        let nurbs = Nurbs::new(data).unwrap();
        for _ in 0..10 {
            let ray = aimed(&mut dice, &patch);
            assert_eq!(all_roots(&patch, &ray), all_roots(&nurbs, &ray));
        }
    }
}

#[test]
fn a_b_spline_without_ends_goes_round() {
    // A tube: eight points about the y axis, twice.
    let ring = |y: f64| {
        (0..8).map(move |k| {
            let [x, z] = [
                [1.0, 0.0],
                [1.0, 1.0],
                [0.0, 1.0],
                [-1.0, 1.0],
                [-1.0, 0.0],
                [-1.0, -1.0],
                [0.0, -1.0],
                [1.0, -1.0],
            ][k];
            [x, y, z, 1.0]
        })
    };
    let points: Vec<_> = ring(-1.0).chain(ring(1.0)).collect();
    let data =
        NurbsData { degree: [3, 1], size: [8, 2], points, periodic: [true, false], ..NurbsData::default() };
    let tube = Nurbs::new(data).unwrap();
    assert_eq!(tube.patches(), 8);
    let mut dice = crate::laws::dice(29, 0);
    for _ in 0..2000 {
        let from = Vec3::new(dice.between(-0.3, 0.3), dice.between(-0.5, 0.5), dice.between(-0.3, 0.3));
        let aim = if dice.once_in(2) { dice.lattice(2) } else { dice.vector() };
        let ray = Ray::new(from.to_point(), Vec3::new(aim.x, aim.y * 0.1, aim.z));
        if (aim.x, aim.z) == (0.0, 0.0) || aim.x.abs() + aim.z.abs() < 0.4 * aim.y.abs() {
            continue;
        }
        let roots = all_roots(&tube, &ray);
        assert_eq!(roots.len(), 1, "{ray:?} {roots:?}");
    }
}

#[test]
fn bad_nurbs_are_named() {
    let plain = NurbsData {
        degree: [2, 1],
        size: [4, 2],
        points: (0..8).map(|i| [f64::from(i % 4), f64::from(i / 4), 0.0, 1.0]).collect(),
        ..NurbsData::default()
    };
    assert!(Nurbs::new(plain.clone()).is_ok());
    let with = |change: &dyn Fn(&mut NurbsData)| {
        let mut data = plain.clone();
        change(&mut data);
        Nurbs::new(data).unwrap_err().to_string()
    };
    assert_eq!(with(&|d| d.degree[0] = 40), "nurbs: the degree along u must be 1 to 9, got 40");
    assert_eq!(with(&|d| d.degree[1] = 2), "nurbs: degree 2 needs 3 points along v at least, got 2");
    assert_eq!(with(&|d| d.knots[0] = vec![0.0; 4]), "nurbs: 7 knots are needed along u, got 4");
    assert_eq!(
        with(&|d| d.knots[0] = vec![0.0, 0.0, 0.0, 2.0, 1.0, 3.0, 3.0]),
        "nurbs: knots must be finite and must not decrease, but knot 5 along u is 1"
    );
    assert_eq!(
        with(&|d| d.knots[1] = vec![0.0, 0.0, 0.0, 1.0]),
        "nurbs: the knot 0 along v occurs 3 times, but may occur at most 2 times"
    );
    assert_eq!(
        with(&|d| d.points[5][3] = -1.0),
        "nurbs: the weight of point 2 of row 2 must be positive and finite, got -1"
    );
    assert!(with(&|d| d.points[0][0] = f64::NAN).contains("point 1 of row 1 must be finite"));
}

//! The laws, tested against exact arithmetic that shares no code with the kernel, and against other
//! surfaces.

use super::*;
use crate::laws::{
    self, Exact, Feature, TestRng, a_reversed_ray_meets_the_same, aim, all_roots,
    closest_is_the_first_of_all, exact3, powers_of_two_change_nothing, real_roots,
};
use crate::{CappedCylinder, Placed, RootKind, Sphere};
use core::cmp::Ordering;
use durer_math::{Ray, RaySide};

/// The coefficients in `u` of a piece, times 6.
fn powers(spline: SweepSpline, p: &[[f64; 4]]) -> [Vec<Exact>; 4] {
    let rows: &[&[f64]] = match spline {
        SweepSpline::Linear => &[&[6.0, 0.0], &[-6.0, 6.0]],
        SweepSpline::BSpline => {
            &[&[1.0, 4.0, 1.0, 0.0], &[-3.0, 0.0, 3.0, 0.0], &[3.0, -6.0, 3.0, 0.0], &[-1.0, 3.0, -3.0, 1.0]]
        }
        SweepSpline::Cubic => &[
            &[0.0, 6.0, 0.0, 0.0],
            &[-3.0, 0.0, 3.0, 0.0],
            &[6.0, -15.0, 12.0, -3.0],
            &[-3.0, 9.0, -9.0, 3.0],
        ],
    };
    [0, 1, 2, 3].map(|axis| {
        let sum = |row: &&[f64]| {
            row.iter()
                .zip(p)
                .fold(Exact::zero(), |sum, (&m, p)| &sum + &(&Exact::from(m) * &Exact::from(p[axis])))
        };
        rows.iter().map(sum).collect()
    })
}

fn windows(sweep: &SphereSweep) -> impl Iterator<Item = &[[f64; 4]]> {
    sweep.spheres().windows(sweep.spline().least())
}

fn value(p: &[Exact], x: &Exact) -> Exact {
    p.iter().rev().fold(Exact::zero(), |sum, a| &(&sum * x) + a)
}

/// The side of a point: the sign of the least `|p - c|² - r²`.
fn exact_side(sweep: &SphereSweep, point: &[Exact; 3]) -> Ordering {
    let six = Exact::from(6.0);
    let mut told = Ordering::Greater;
    for p in windows(sweep) {
        let mut curve = powers(sweep.spline(), p);
        let mut g = vec![Exact::zero(); 2 * curve[0].len() - 1];
        for axis in 0..4 {
            if axis < 3 {
                curve[axis][0] = &curve[axis][0] - &(&point[axis] * &six);
            }
            for (i, a) in curve[axis].iter().enumerate() {
                for (j, b) in curve[axis].iter().enumerate() {
                    let term = a * b;
                    g[i + j] = if axis < 3 { &g[i + j] + &term } else { &g[i + j] - &term };
                }
            }
        }
        let (zero, one) = (Exact::zero(), Exact::from(1.0));
        let mut places = vec![zero.clone(), one.clone()];
        if g.iter().any(|a| a.sign().is_ne()) {
            for root in real_roots(&g) {
                if root.cmp_exact(&zero).is_ge() && root.cmp_exact(&one).is_le() {
                    told = told.min(Ordering::Equal);
                    let place = root.about(1500);
                    let place = if place.sign().is_lt() { zero.clone() } else { place };
                    places.push(if (&place - &one).sign().is_gt() { one.clone() } else { place });
                }
            }
        }
        places.sort_by(|a, b| (a - b).sign());
        for pair in places.windows(2) {
            let middle = (&pair[0] + &pair[1]).shifted(-1);
            told = told.min(value(&g, &middle).sign());
        }
        told = told.min(value(&g, &zero).sign()).min(value(&g, &one).sign());
    }
    told
}

/// The spans of a line, by trying very many balls: the beginnings and ends.
fn tried(sweep: &SphereSweep, ray: &Ray) -> Vec<(f64, f64)> {
    let count = 4000;
    let mut out: Vec<(f64, f64)> = vec![];
    let d = ray.direction;
    for p in windows(sweep) {
        let c = powers(sweep.spline(), p).map(|c| c.iter().map(|c| c.to_f64() / 6.0).collect::<Vec<_>>());
        for i in 0..=count {
            let u = f64::from(i) / f64::from(count);
            let at = |c: &[f64]| c.iter().rev().fold(0.0, |sum, a| sum * u + a);
            let (to, r) = (Point3::new(at(&c[0]), at(&c[1]), at(&c[2])) - ray.origin, at(&c[3]));
            let m = to.dot(d) / d.dot(d);
            let e = to - d * m;
            let disc = (r * r - e.dot(e)) / d.dot(d);
            if disc > 0.0 {
                out.push((m - disc.sqrt(), m + disc.sqrt()));
            }
        }
    }
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut spans: Vec<(f64, f64)> = vec![];
    for (from, to) in out {
        match spans.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => spans.push((from, to)),
        }
    }
    spans
}

#[derive(Default)]
struct Counts {
    roots: u64,
    grazing: u64,
    widths: Vec<f64>,
    spawned: u64,
}

/// Every bracket holds a change of sides, and only one; between brackets the side stays.
fn check(sweep: &SphereSweep, ray: &Ray, counts: &mut Counts) -> Result<(), String> {
    let roots = all_roots(sweep, ray);
    let told = || format!("{ray:?}\n  {roots:?}\n  {sweep:?}");
    let at = |t: f64| {
        let t = Exact::from(t);
        let (o, d) = (exact3(ray.origin.to_array()), exact3(ray.direction.to_array()));
        [0, 1, 2].map(|i| &o[i] + &(&d[i] * &t))
    };
    let size = sweep.bounds().widths().max_abs();
    let length = ray.direction.length();
    let mut inside = false;
    for root in &roots {
        if !(root.lo <= root.t && root.t <= root.hi) {
            return Err(format!("t is not in its bracket: {}", told()));
        }
        let unit = root.t.abs().max(size / length);
        counts.widths.push((root.hi - root.lo) / (unit.next_up() - unit));
        if root.kind == RootKind::Grazing {
            counts.grazing += 1;
            continue;
        }
        if root.kind != RootKind::Simple || (root.sign < 0) == inside {
            return Err(format!("kind or sign is wrong: {}", told()));
        }
        inside = root.sign < 0;
        let [before, after] = [root.lo, root.hi].map(|t| exact_side(sweep, &at(t)));
        let (out, within) = if inside { (before, after) } else { (after, before) };
        // Of a span that is shorter than its brackets both ends are outside.
        let holds = roots.iter().filter(|r| r.lo <= root.hi && root.lo <= r.hi).count();
        let thin = root.lo.next_up() >= root.hi || holds > 1;
        if !(thin || out.is_ge() && within.is_le()) {
            return Err(format!("sides {before:?} {after:?} of {root:?}: {}", told()));
        }
        counts.roots += 1;
    }
    if inside {
        return Err(format!("a line ends inside: {}", told()));
    }
    // The number of spans: the tried ones are narrower by a little.
    let solid: Vec<_> = roots.iter().filter(|r| r.sign != 0).collect();
    let found: Vec<(f64, f64)> = solid.chunks(2).map(|c| (c[0].t, c[1].t)).collect();
    let room = size / length * 1e-3;
    let far = ray.origin.to_vec().max_abs() > 1e4 * size;
    for (from, to) in tried(sweep, ray) {
        // Rounding makes a span of a touch: only what is inside exactly can be missing.
        let is_found = far || found.iter().any(|f| f.0 <= from + room * 1e-6 && to <= f.1 + room * 1e-6);
        if !is_found && exact_side(sweep, &at(0.5 * (from + to))).is_lt() {
            return Err(format!("{from} to {to} is missing: {}", told()));
        }
    }
    for pair in solid.windows(2).filter(|pair| pair[0].sign > 0) {
        // Where brackets do not tell.
        let gap = 0.5 * (pair[0].t + pair[1].t);
        if pair[0].hi < gap && gap < pair[1].lo && exact_side(sweep, &at(gap)).is_lt() {
            return Err(format!("{gap} is inside: {}", told()));
        }
    }
    closest_is_the_first_of_all(sweep, ray, &roots)?;
    a_reversed_ray_meets_the_same(sweep, ray, &roots)?;
    powers_of_two_change_nothing(sweep, ray, &roots)?;
    for root in roots.iter().filter(|r| r.kind == RootKind::Simple) {
        let local = LocalRay::new(ray);
        let point = sweep.resolve(&local, root, Need::ALL);
        if !point.p.is_finite() || (point.ng.to_vec().length() - 1.0).abs() > 1e-12 {
            return Err(format!("{point:?}: {}", told()));
        }
        let exact = at(root.t);
        for (k, exact) in exact.iter().enumerate() {
            let away = (&Exact::from(point.p[k]) - exact).to_f64().abs();
            let width = (root.hi - root.lo) * ray.direction[k].abs();
            if away > point.dp[k] + width {
                return Err(format!("{point:?} is {away} off on axis {k}: {}", told()));
            }
        }
        for (side, wanted) in [(RaySide::Front, Ordering::Greater), (RaySide::Back, Ordering::Less)] {
            let start = point.spawn_from(side, ray.direction);
            let is = exact_side(sweep, &exact3(start.origin.to_array()));
            if is != wanted {
                return Err(format!("a ray from {side:?} starts at {is:?}: {point:?} {root:?} {}", told()));
            }
            counts.spawned += 1;
            // Its hits are those of the exact ray.
            let mut sink = crate::All::default();
            let local = LocalRay::new(&start).from_side(Some(side));
            sweep.roots(&local, &mut sink);
            let first = sink.roots.iter().find(|r| r.sign != 0).map_or(1, |r| r.sign);
            let leads_out = sink.roots.iter().any(|r| r.sign != 0);
            if leads_out && (first < 0) != (side == RaySide::Front) || !leads_out && side == RaySide::Back {
                return Err(format!("a ray from {side:?} meets {:?}: {}", sink.roots, told()));
            }
        }
    }
    Ok(())
}

fn sweeps() -> Vec<SphereSweep> {
    let linear = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::Linear, s).unwrap();
    let b = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::BSpline, s).unwrap();
    let cubic = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::Cubic, s).unwrap();
    let wave = [
        [-3.0, 0.0, 0.5, 0.5],
        [-2.0, 1.0, 0.0, 0.25],
        [-0.5, -1.0, 0.25, 0.5],
        [0.5, 1.5, -0.5, 0.375],
        [1.0, -0.5, 0.5, 0.125],
        [3.0, 0.0, 0.0, 1.0],
    ];
    let knot = [
        [1.0, 0.0, 0.0, 0.5],
        [0.0, 1.0, 0.25, 0.5],
        [-1.0, 0.0, 0.0, 0.375],
        [0.0, -1.0, -0.25, 0.5],
        [1.0, 0.0, 0.0, 0.5],
        [0.0, 1.0, 0.25, 0.5],
        [-1.0, 0.0, 0.0, 0.375],
    ];
    vec![
        linear(&[[0.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]]),
        linear(&[[0.0, 0.0, 0.0, 1.0], [2.0, 1.0, 0.5, 0.0]]),
        linear(&[[0.0, 0.0, 0.0, 1.0], [0.5, 0.25, 0.0, 2.0]]),
        linear(&[[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 0.0], [2.0, 2.0, 1.0, -0.5]]),
        linear(&wave),
        b(&wave),
        cubic(&wave),
        b(&knot),
        cubic(&knot),
        // A cusp, repeated points, a thin one.
        cubic(&[[0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.25], [0.0, 1.0, 0.0, 0.5]]),
        b(&[[0.0; 4], [0.0; 4], [1.0, 1.0, 0.0, 1.0], [2.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0]]),
        b(&wave.map(|[x, y, z, r]| [x, y, z, r * 0.001])),
        cubic(&wave.map(|[x, y, z, r]| [1000.0 + x, y, z, r])),
    ]
}

/// Points of the surface and directions there.
fn features(sweep: &SphereSweep) -> Vec<Feature> {
    let mut out = vec![];
    for p in windows(sweep) {
        let c = powers(sweep.spline(), p).map(|c| c.iter().map(|c| c.to_f64() / 6.0).collect::<Vec<_>>());
        for u in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let at = |c: &[f64]| c.iter().rev().fold(0.0, |sum, a| sum * u + a);
            let slope = |c: &[f64]| {
                c.iter().enumerate().skip(1).rev().fold(0.0, |sum, (k, a)| sum * u + k as f64 * a)
            };
            let (centre, r) = (Vec3::new(at(&c[0]), at(&c[1]), at(&c[2])), at(&c[3]));
            let way = Vec3::new(slope(&c[0]), slope(&c[1]), slope(&c[2]));
            for n in [Vec3::X, Vec3::Y, -Vec3::Z] {
                let across = way.cross(n);
                let radial = if across.length() > 0.0 { across * (1.0 / across.length()) } else { n };
                for (n, direction) in
                    [(radial, way), (radial, radial.cross(way)), (n, way), (n, Vec3::Y + Vec3::Z)]
                {
                    if direction != Vec3::ZERO {
                        out.push(Feature { point: (centre + n * r).to_point(), direction });
                    }
                }
            }
        }
    }
    out
}

#[test]
fn crossings_are_those_of_the_union_of_balls() {
    let mut counts = Counts::default();
    let mut rays = 0;
    for (seed, sweep) in sweeps().iter().enumerate() {
        let features = features(sweep);
        for i in laws::drawn(40) {
            let size = sweep.bounds().widths().max_abs();
            let ray = aim(&mut laws::dice(seed as u64, i), &features, size);
            if !ray.is_valid() || ray.t_min.is_finite() || ray.t_max.is_finite() {
                continue;
            }
            check(sweep, &ray, &mut counts).unwrap_or_else(|e| panic!("{seed} {i}: {e}"));
            rays += 1;
        }
    }
    laws::report(rays);
    counts.widths.sort_by(f64::total_cmp);
    let median = counts.widths[counts.widths.len() / 2];
    let widest = counts.widths[counts.widths.len() - 1];
    let Counts { roots, grazing, spawned, .. } = counts;
    println!("{rays} rays {roots} roots {grazing} grazing {spawned} spawned; ulp {median} {widest}");
    assert!(
        rays > 100 && roots > 200 && median < 100.0 && widest <= 96.0,
        "{rays} {roots} {median} {widest}"
    );
}

#[test]
fn a_straight_sweep_is_a_cylinder_with_two_balls() {
    let (a, b, r) = (Point3::new(-1.0, 0.5, 0.25), Point3::new(2.0, 1.0, -0.5), 0.75);
    let spheres = [[a.x, a.y, a.z, r], [b.x, b.y, b.z, r]];
    let mut met = 0;
    for case in 0..400 {
        let mut dice = laws::dice(77, case);
        let map = dice.map();
        let sweep = Placed::new(SphereSweep::new(SweepSpline::Linear, &spheres).unwrap(), map);
        let wall = Placed::new(CappedCylinder::open(a, b, r).unwrap(), map);
        let balls = [a, b].map(|c| Placed::new(Sphere::new(c, r).unwrap(), map));
        let target = map.point(Point3::new(0.5, 0.75, 0.0)) + map.vector(dice.vector());
        let direction = dice.vector();
        let far = dice.pick(&[1.0, 10.0, 1e6]);
        let ray = Ray::new(target - direction * far, direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
        let ray = if ray.is_valid() { ray } else { continue };
        let mut parts = all_roots(&wall, &ray);
        parts.extend(balls.iter().flat_map(|ball| all_roots(ball, &ray)));
        let found = all_roots(&sweep, &ray);
        for root in &found {
            assert!(parts.iter().any(|p| p.lo <= root.hi && root.lo <= p.hi), "{ray:?} {root:?} {parts:?}");
        }
        let (first, last) =
            parts.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.lo), b.max(p.hi)));
        assert_eq!(found.len(), if parts.is_empty() { 0 } else { 2 }, "{ray:?} {found:?} {parts:?}");
        if let [entry, exit] = found[..] {
            assert!(entry.hi >= first && exit.lo <= last && exit.hi >= last - 1e-9 * last.abs().max(1.0));
            met += 1;
        }
    }
    assert!(met > 100, "{met}");
}

#[test]
fn ranges_that_meet_share_no_crossing_and_lose_none() {
    let mut split = 0;
    for (seed, sweep) in sweeps().iter().enumerate() {
        let features = features(sweep);
        let size = sweep.bounds().widths().max_abs();
        for i in 0..20 {
            let mut dice = laws::dice(500 + seed as u64, i);
            let ray = aim(&mut dice, &features, size).with_range(f64::NEG_INFINITY, f64::INFINITY);
            if !ray.is_valid() {
                continue;
            }
            let whole = all_roots(sweep, &ray);
            for root in whole.iter().filter(|r| r.kind == RootKind::Simple) {
                for t in [root.lo, root.t, root.hi, 0.5 * (root.lo + root.hi)] {
                    let before = all_roots(sweep, &ray.with_range(f64::NEG_INFINITY, t));
                    let after = all_roots(sweep, &ray.with_range(t, f64::INFINITY));
                    let count = before.len() + after.len();
                    let at = |t: f64| {
                        let t = Exact::from(t);
                        let (o, d) = (exact3(ray.origin.to_array()), exact3(ray.direction.to_array()));
                        [0, 1, 2].map(|i| &o[i] + &(&d[i] * &t))
                    };
                    // A crossing exactly there belongs to both.
                    let both = usize::from(exact_side(sweep, &at(t)).is_eq());
                    assert_eq!(
                        count,
                        whole.len() + both,
                        "{t} {ray:?} {whole:?} {before:?} {after:?} {sweep:?}"
                    );
                    split += 1;
                }
            }
        }
    }
    assert!(split > 300, "{split}");
}

#[test]
fn sides_of_points_are_exact() {
    let mut on = 0;
    for (seed, sweep) in sweeps().iter().enumerate() {
        let features = features(sweep);
        let mut dice = TestRng::new(900 + seed as u64);
        for _ in 0..60 {
            let f = dice.pick(&features);
            let p = if dice.once_in(3) { f.point + dice.vector() * dice.scale(-60, 1) } else { f.point };
            let is = match sweep.side(&LocalPoint::new(p)) {
                Side::In => Ordering::Less,
                Side::On => Ordering::Equal,
                Side::Out => Ordering::Greater,
            };
            assert_eq!(is, exact_side(sweep, &exact3(p.to_array())), "{p:?} {sweep:?}");
            on += u32::from(is.is_eq());
        }
    }
    assert!(on > 30, "{on}");
}

#[test]
fn radii_of_both_signs_shrink_to_a_point_between() {
    let balls = [[-2.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, -1.0]];
    let sweep = SphereSweep::new(SweepSpline::Linear, &balls).unwrap();
    // No ball about (c, 0, 0) of radius |c| / 2 comes near the first line.
    for (x, y, count) in [(0.0, 0.5, 0), (-2.0, 0.0, 2), (2.0, 0.0, 2)] {
        let ray = Ray::new(Point3::new(x, y, -9.0), Vec3::Z);
        assert_eq!(all_roots(&sweep, &ray).len(), count, "{x} {y}");
    }
}

#[test]
fn a_line_of_points_and_bad_numbers_are_refused() {
    let new = SphereSweep::new;
    let linear = SweepSpline::Linear;
    let few = SphereSweepError::TooFew { what: "a linear_spline", least: 2, len: 1 };
    assert_eq!(new(linear, &[[0.0; 4]]), Err(few));
    assert_eq!(new(linear, &[[0.0; 4], [1.0, 0.0, 0.0, 0.0]]), Err(SphereSweepError::Nothing));
    let nan = new(linear, &[[0.0; 4], [1.0, 0.0, 0.0, f64::NAN]]);
    assert!(matches!(nan, Err(SphereSweepError::Radius { sphere: 1, .. })), "{nan:?}");
    let far = new(linear, &[[0.0; 4], [f64::INFINITY, 0.0, 0.0, 1.0]]);
    assert!(matches!(far, Err(SphereSweepError::Centre { sphere: 1, .. })), "{far:?}");
    let large = new(linear, &[[0.0; 4], [1e300, 0.0, 0.0, 1.0]]);
    assert_eq!(large, Err(SphereSweepError::TooLarge(1e300)));
}

/// Sweeps whose radius changes its sign, or is zero for a moment: two cones with a common tip. The tips,
/// and the directions of both cones there.
fn with_double_tips() -> Vec<(SphereSweep, Point3, [Vec3; 2])> {
    let linear = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::Linear, s).unwrap();
    let b = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::BSpline, s).unwrap();
    let cubic = |s: &[[f64; 4]]| SphereSweep::new(SweepSpline::Cubic, s).unwrap();
    let both = |x: f64, y: f64, z: f64| [Vec3::new(x, y, z), Vec3::new(-x, -y, -z)];
    let straight = |r: f64| [-3.0, -1.0, 1.0, 3.0].map(|x: f64| [2.0 * x, x, 0.5 * x, r * x]);
    let bent = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(0.25, 1.0, 0.5)];
    let knee = |r: f64| linear(&[[-2.0, 0.0, 0.0, r], [0.0; 4], [0.5, 2.0, 1.0, r]]);
    vec![
        (linear(&[[-2.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, -1.0]]), Point3::ORIGIN, both(1.0, 0.0, 0.0)),
        (linear(&[[-2.0, 1.0, 0.0, 0.125], [2.0, -1.0, 0.0, -0.125]]), Point3::ORIGIN, both(2.0, -1.0, 0.0)),
        (linear(&[[-2.0, 1.0, 0.0, 2.0], [2.0, -1.0, 0.0, -2.0]]), Point3::ORIGIN, both(2.0, -1.0, 0.0)),
        (b(&straight(0.5)), Point3::ORIGIN, both(2.0, 1.0, 0.5)),
        (cubic(&straight(-0.25)), Point3::ORIGIN, both(2.0, 1.0, 0.5)),
        (knee(0.5), Point3::ORIGIN, bent),
        (knee(1.0), Point3::ORIGIN, bent),
        (
            linear(&[[1.0, 2.0, 3.0, 0.75], [2.0, 2.5, 3.0, 0.0], [3.0, 3.0, 3.0, 0.25]]),
            Point3::new(2.0, 2.5, 3.0),
            both(2.0, 1.0, 0.0),
        ),
    ]
}

/// A ray that leaves the surface at a double tip starts on the requested side, and whatever the
/// side, its crossings are those of the exact ray.
#[test]
fn rays_that_leave_a_double_tip_start_on_their_side() {
    let (mut counts, mut rays, mut placed_starts) = (Counts::default(), 0, 0);
    let (mut broken, mut near) = (vec![], 0);
    for (seed, (sweep, tip, ways)) in with_double_tips().iter().enumerate() {
        let size = sweep.bounds().widths().max_abs();
        for i in laws::drawn(60) {
            let mut dice = laws::dice(1200 + seed as u64, i);
            let off = dice.vector() * dice.pick(&[0.0, 1.0]) * dice.scale(-60, -20);
            let direction = match dice.below(4) {
                0 => dice.vector(),
                1 => dice.lattice(3),
                2 => dice.pick(ways) + dice.vector() * dice.scale(-50, -2),
                _ => dice.pick(ways).cross(dice.vector()),
            };
            let back = dice.pick(&[1.0, 4.0, 64.0]);
            let ray = Ray::new(*tip + off - direction * back, direction)
                .with_range(f64::NEG_INFINITY, f64::INFINITY);
            if !ray.is_valid() {
                continue;
            }
            rays += 1;
            if let Err(e) = check(sweep, &ray, &mut counts) {
                broken.push(format!("{seed} {i}: {e}"));
            }
            // Where the sweep is placed somewhere else, too.
            let map = dice.map();
            let placed = Placed::new(sweep.clone(), map);
            let there = Ray::new(map.point(ray.origin), map.vector(ray.direction));
            if !there.is_valid() {
                continue;
            }
            let local = LocalRay::new(&there);
            for root in all_roots(&placed, &there).iter().filter(|r| r.kind == RootKind::Simple) {
                let point = placed.resolve(&local, root, Need::ALL);
                for (side, wanted) in [(RaySide::Front, Side::Out), (RaySide::Back, Side::In)] {
                    let start = point.spawn_from(side, there.direction);
                    let is = placed.side(&LocalPoint::new(start.origin));
                    // So far away, or stretched so much, rounding is larger than what a tip leaves.
                    let is_far = map.inverse_norm() * point.p.to_vec().max_abs() > 512.0 * size
                        || map.inverse_norm() * map.linear_norm() > 16.0;
                    if is != wanted && !is_far {
                        broken.push(format!("{seed} {i}: placed {side:?} starts {is:?} {point:?} {map:?}"));
                    }
                    near += u32::from(!is_far);
                    // The exact side of the start decides in any case.
                    let mut sink = crate::All::default();
                    placed.roots(&LocalRay::new(&start).from_side(Some(side)), &mut sink);
                    let first = sink.roots.iter().find(|r| r.sign != 0).map(|r| r.sign > 0);
                    if first.unwrap_or(false) != (is == Side::In) {
                        broken.push(format!(
                            "{seed} {i}: {side:?} from {is:?} meets {:?} {start:?} {map:?}",
                            sink.roots
                        ));
                    }
                    placed_starts += 1;
                }
            }
        }
    }
    laws::report(rays);
    println!(
        "{rays} rays, {} roots, {placed_starts} starts, {near} near, {} broken",
        counts.roots,
        broken.len()
    );
    for b in broken.iter().take(40) {
        println!("{}", b.chars().take(2500).collect::<String>());
    }
    assert!(broken.is_empty());
}

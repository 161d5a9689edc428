//! The laws that every surface must obey, as plain functions named by sentences. [`check`] tests
//! them all.
//!
//! To test a surface, give an [`Oracle`] (its exact description, usually an [`ExactBody`]), a few
//! [`Feature`]s at which rays are aimed, and call [`check_many`] once. Oracles are exact: they use
//! big integers and share no code with the kernels. A surface without one, such as that of a
//! formula, is held to the laws that need none: [`check_alone`].

pub use durer_testkit::{
    Clipped, Crossing, Exact, ExactBody, ExactForm, ExactLine, Feature, LineCache, Oracle, RealRoot, Surd,
    TestRng, ZeroOracle, aim, dice, drawn, exact, exact_polynomial, exact3, near, real_root, real_roots,
    report, test_rng,
};

use crate::{
    Accelerate, All, Any, Closest, LocalPoint, LocalRay, Need, Root, RootKind, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::{Aabb, Ray, RaySide, U, Vec3};

/// The reason why a law does not hold.
pub type Broken = String;

macro_rules! ensure {
    ($test:expr, $($message:tt)*) => {
        // A comparison with NaN is false, and so breaks the law.
        let holds: bool = $test;
        if !holds {
            return Err(format!($($message)*));
        }
    };
}

/// A surface under test, as a trait object, so that the laws and each surface's kernel are compiled
/// once.
pub trait TestSurface: Surface + core::fmt::Debug {
    /// Passes the roots to any sink.
    fn send(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink);
}

impl<S: Surface + core::fmt::Debug> TestSurface for S {
    fn send(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        self.roots(ray, sink);
    }
}

/// All roots of a surface.
pub fn all_roots(surface: &dyn TestSurface, ray: &Ray) -> Vec<Root> {
    let mut sink = All::default();
    surface.send(&LocalRay::new(ray), &mut sink);
    sink.roots
}

/// Tests every law that one ray can test. Returns the roots.
pub fn check(surface: &dyn TestSurface, oracle: &dyn Oracle, ray: &Ray) -> Result<Vec<Root>, Broken> {
    let oracle = &exact::Cached::new(oracle);
    let roots = roots_are_the_exact_crossings(surface, oracle, ray, None)?;
    closest_is_the_first_of_all(surface, ray, &roots)?;
    brackets_are_narrow(surface, oracle, ray, &roots)?;
    a_reversed_ray_meets_the_same(surface, ray, &roots)?;
    powers_of_two_change_nothing(surface, ray, &roots)?;
    for (i, root) in roots.iter().enumerate() {
        // Beyond 2^450 sizes squares leave the range of f64.
        let far = ray.at(root.t).to_vec().max_abs() > oracle.size() * durer_math::scale::ldexp(1.0, 450);
        if root.kind != RootKind::Cluster && !far {
            points_are_within_their_bounds(surface, oracle, ray, root, &roots[..i])?;
        }
    }
    Ok(roots)
}

/// Tests the laws that need no oracle: roots ascend and lie in their brackets, which reach into the
/// ray's range, all queries agree, points are well formed, and a ray that leaves a solid's surface starts
/// on the requested side. At an edge that is the side of one face, and not of the solid, so rays
/// should not aim at edges exactly. Returns the roots.
pub fn check_alone(surface: &dyn TestSurface, ray: &Ray) -> Result<Vec<Root>, Broken> {
    let roots = all_roots(surface, ray);
    for root in &roots {
        ensure!(root.lo <= root.t && root.t <= root.hi, "t is not in its bracket: {root:?}");
        ensure!(ray.t_min <= root.hi && root.lo <= ray.t_max, "a root is not in the range: {root:?}");
    }
    for pair in roots.windows(2) {
        ensure!(pair[0].t <= pair[1].t, "roots do not ascend: {pair:?}");
    }
    closest_is_the_first_of_all(surface, ray, &roots)?;
    for root in roots.iter().filter(|root| root.kind == RootKind::Simple) {
        let point = surface.resolve(&LocalRay::new(ray), root, Need::ALL);
        is_well_formed(&point)?;
        if surface.solidity() == Solidity::Open {
            continue;
        }
        for (from, side) in [(RaySide::Front, Side::Out), (RaySide::Back, Side::In)] {
            let start = point.spawn_from(from, ray.direction).origin;
            let found = surface.side(&LocalPoint::new(start));
            ensure!(found == side, "a ray from {from:?} starts {found:?}: {point:?}");
        }
    }
    Ok(roots)
}

/// Draws `count` rays at `features` and checks all laws for each; see [`drawn`].
///
/// # Panics
///
/// If a law is broken: with the law, the seed and the ray.
pub fn check_many(
    surface: &dyn TestSurface,
    oracle: &dyn Oracle,
    features: &[Feature],
    seed: u64,
    count: u64,
) -> Tally {
    let mut tally = Tally::default();
    for i in drawn(count) {
        let ray = aim(&mut dice(seed, i), features, oracle.size());
        if !ray.is_valid() {
            continue;
        }
        match check(surface, oracle, &ray) {
            Ok(roots) => {
                tally.rays += 1;
                tally.roots += roots.len() as u64;
                tally.grazing += roots.iter().filter(|r| r.kind == RootKind::Grazing).count() as u64;
                for root in &roots {
                    tally.widths.push(width(surface, oracle, &ray, root));
                }
            }
            Err(broken) => panic!("{broken}\n  ray {i} of seed {seed}: {ray:?}\n  surface: {surface:?}"),
        }
    }
    report(tally.rays);
    tally
}

/// How many rays were tested.
///
/// A test should check these numbers: a law that met no root proves nothing.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Rays.
    pub rays: u64,
    /// Roots.
    pub roots: u64,
    /// Grazing roots.
    pub grazing: u64,
    /// Widths of brackets, in ulp of `max(|t|, size / |d|)`.
    pub widths: Vec<f64>,
}

impl Tally {
    /// The median width.
    pub fn median_width(&mut self) -> f64 {
        self.widths.sort_by(f64::total_cmp);
        self.widths.get(self.widths.len() / 2).copied().unwrap_or(0.0)
    }
}

/// The width of a bracket, in ulp of `max(|t|, size / |d|)`. The size of an unbounded surface is
/// that of the part up to the crossing.
pub fn width(surface: &dyn TestSurface, oracle: &dyn Oracle, ray: &Ray, root: &Root) -> f64 {
    let k = exponent(ray.direction.max_abs());
    let length = ray.direction.map(|x| durer_math::scale::ldexp(x, -k)).length();
    let place = ray.at(root.t).to_vec().max_abs();
    let seen = if surface.bounds().is_bounded() || place == f64::INFINITY { 0.0 } else { place };
    let size = oracle.size() + seen;
    let unit = root.t.abs().max(durer_math::scale::ldexp(size / length, -k));
    (root.hi - root.lo) / (unit.next_up() - unit)
}

/// P1, P2, P3, P6: no crossing is missing, extra or doubled; each lies in its bracket, in order,
/// with its sign and kind.
pub fn roots_are_the_exact_crossings(
    surface: &dyn TestSurface,
    oracle: &dyn Oracle,
    ray: &Ray,
    source: Option<(RaySide, u32)>,
) -> Result<Vec<Root>, Broken> {
    let mut sink = All::default();
    let mut local = LocalRay::new(ray).from_side(source.map(|(side, _)| side));
    local.source_face = source.map_or(0, |(_, face)| face);
    surface.send(&local, &mut sink);
    let roots = sink.roots;
    let line = ExactLine::new(ray);
    if !oracle.knows(&line) {
        return Ok(roots);
    }
    let inside = |t: &Surd| {
        (!ray.t_min.is_finite() || t.cmp_exact(&ray.t_min.into()).is_ge())
            && (!ray.t_max.is_finite() || t.cmp_exact(&ray.t_max.into()).is_le())
    };
    // Crossings whose t or point is beyond the range of f64 cannot be compared.
    let most = Exact::from(f64::MAX / ray.direction.max_abs().max(1.0)).shifted(-16);
    let exact: Vec<Crossing> = oracle
        .crossings(&line)
        .into_iter()
        .filter(|c| inside(&c.t) && c.t.cmp_exact(&most).is_le() && c.t.cmp_exact(&-most.clone()).is_ge())
        .collect();
    let mut seen = roots.clone();
    seen.retain(|r| (&Exact::from(r.t).abs() - &most).sign().is_le());
    let told = || {
        let exact: Vec<_> = exact.iter().map(|c| (c.t.about(2200).to_f64(), c.sign, c.grazing)).collect();
        format!("\n  found {roots:?}\n  exact {exact:?}")
    };
    ensure!(seen.len() == exact.len(), "{} roots, but {} crossings{}", seen.len(), exact.len(), told());
    for (root, crossing) in seen.iter().zip(&exact) {
        ensure!(
            root.t.is_finite() && root.lo <= root.t && root.t <= root.hi,
            "t is not in its bracket{}",
            told()
        );
        let above = !root.lo.is_finite() || crossing.t.cmp_exact(&root.lo.into()).is_ge();
        let below = !root.hi.is_finite() || crossing.t.cmp_exact(&root.hi.into()).is_le();
        ensure!(above && below, "the crossing is not in the bracket{}", told());
        ensure!(
            root.kind == if crossing.grazing { RootKind::Grazing } else { RootKind::Simple },
            "the kind is wrong{}",
            told()
        );
        ensure!(root.sign == crossing.sign, "the sign is wrong{}", told());
    }
    ensure!(roots.windows(2).all(|w| w[0].t <= w[1].t), "roots do not ascend{}", told());
    Ok(roots)
}

/// The parts of a surface have the roots of the whole, each within the part's box. Returns how many
/// parts were tested and how many roots they have.
pub fn parts_are_the_whole<S: TestSurface + Accelerate>(
    surface: &S,
    ray: &Ray,
) -> Result<(usize, usize), Broken> {
    let local = LocalRay::new(ray);
    let (mut sink, mut parts, mut astray) = (All::default(), 0, None);
    surface.parts(&mut |bounds, part| {
        let before = sink.roots.len();
        surface.part_roots(part, &local, &mut sink);
        for root in &sink.roots[before..] {
            let p = surface.resolve(&local, root, Need::POINT);
            if !bounds.expanded(p.dp).contains(p.p) {
                astray = Some(format!("{p:?} of {part:?} is not in {bounds:?}"));
            }
        }
        parts += 1;
    });
    ensure!(astray.is_none(), "{astray:?}: {ray:?} {surface:?}");
    // A single part passes them on as the whole does, which may know their exact order.
    if parts > 1 {
        sink.roots.sort_by(Root::order);
    }
    let whole = all_roots(surface, ray);
    ensure!(sink.roots == whole, "the parts have {:?}, the whole {whole:?}: {ray:?} {surface:?}", sink.roots);
    Ok((parts, whole.len()))
}

/// P3: closest is the least of all, and any reports whether there is one.
pub fn closest_is_the_first_of_all(
    surface: &dyn TestSurface,
    ray: &Ray,
    roots: &[Root],
) -> Result<(), Broken> {
    let (mut closest, mut any) = (Closest::default(), Any::default());
    surface.send(&LocalRay::new(ray), &mut closest);
    surface.send(&LocalRay::new(ray), &mut any);
    // Of roots with equal t the first: they are in the exact order.
    let least = roots.iter().copied().min_by(|a, b| a.t.total_cmp(&b.t));
    ensure!(closest.root == least, "closest {:?} is not the least {least:?}", closest.root);
    ensure!(any.hit != roots.is_empty(), "any says {}, all has {}", any.hit, roots.len());
    Ok(())
}

/// P8: a bracket is at most 96 ulp of `max(|t|, size / |d|)` wide, where a bounded surface's size is
/// its reach from the middle of its bounds.
///
/// In a kernel's frame the reach is in `[1, 2)` and `|d|` in `[1, 2√3)`. Solvers end where a bracket
/// is at most `48 U max(|t|, |s|, 1/2)` wide, and `U |t|` is less than an ulp. A crossing is no
/// farther from the point at `s = 0` than the reach, so `|s| <= reach / |d|`; and `24 U` is at most
/// `24 · 2√3 U < 84 U` of `reach / |d|`. The rest is for the outward roundings of `t`.
pub fn brackets_are_narrow(
    surface: &dyn TestSurface,
    oracle: &dyn Oracle,
    ray: &Ray,
    roots: &[Root],
) -> Result<(), Broken> {
    for root in roots {
        // A point, or an end of the bracket, is beyond the range of f64.
        if !ray.at(root.t).is_finite() || root.t.abs() == f64::MAX {
            continue;
        }
        let width = width(surface, oracle, ray, root);
        ensure!(width <= 96.0, "a bracket is {width} ulp wide: {root:?}");
    }
    Ok(())
}

/// P7: a reversed ray meets the same crossings, in the opposite order.
pub fn a_reversed_ray_meets_the_same(
    surface: &dyn TestSurface,
    ray: &Ray,
    roots: &[Root],
) -> Result<(), Broken> {
    let back = Ray::new(ray.origin, -ray.direction).with_range(-ray.t_max, -ray.t_min);
    let reversed = all_roots(surface, &back);
    ensure!(reversed.len() == roots.len(), "backwards {} roots, forwards {}", reversed.len(), roots.len());
    for (a, b) in roots.iter().zip(reversed.iter().rev()) {
        ensure!(
            a.sign == -b.sign && a.kind == b.kind && a.lo <= -b.lo && -b.hi <= a.hi,
            "backwards {b:?}, forwards {a:?}"
        );
    }
    Ok(())
}

/// P7: scaling the direction by a power of two divides every `t` by it, bit for bit.
pub fn powers_of_two_change_nothing(
    surface: &dyn TestSurface,
    ray: &Ray,
    roots: &[Root],
) -> Result<(), Broken> {
    let scaled = Ray::new(ray.origin, ray.direction * 8.0).with_range(ray.t_min * 0.125, ray.t_max * 0.125);
    // Subnormal numbers are rounded outward once more.
    let exact = |x: f64| x == 0.0 || (x * 0.125 * 8.0 == x && (x * 0.125).abs() >= f64::MIN_POSITIVE);
    let lossless = ray.direction.to_array().iter().all(|&x| (x * 8.0).is_finite() && x * 8.0 * 0.125 == x)
        && (ray.t_min.is_infinite() || exact(ray.t_min))
        && (ray.t_max.is_infinite() || exact(ray.t_max))
        && roots.iter().all(|r| [r.t, r.lo, r.hi, r.s].into_iter().all(|x| x.is_finite() && exact(x)));
    if lossless {
        let expected: Vec<Root> =
            roots.iter().map(|r| Root { t: r.t * 0.125, lo: r.lo * 0.125, hi: r.hi * 0.125, ..*r }).collect();
        let mut found = all_roots(surface, &scaled);
        if found.iter().any(|r| [r.t, r.lo, r.hi].into_iter().any(f64::is_subnormal)) {
            return Ok(());
        }
        // A crossing beyond the greatest f64 may be no root.
        found.retain(|r| (r.hi * 8.0).is_finite() && (r.lo * 8.0).is_finite());
        ensure!(found == expected, "eight times the direction: {found:?}, expected {expected:?}");
    }
    Ok(())
}

/// P4, P5, P11, P12: the point is within `dp` of the exact one and in the bounds; its normal is the
/// surface's; spawned rays start on the requested side, and their hits are those of the exact ray.
///
/// `earlier` are the roots before this one.
pub fn points_are_within_their_bounds(
    surface: &dyn TestSurface,
    oracle: &dyn Oracle,
    ray: &Ray,
    root: &Root,
    earlier: &[Root],
) -> Result<(), Broken> {
    let line = ExactLine::new(ray);
    let holds = |root: &Root, c: &Crossing| {
        c.t.cmp_exact(&root.lo.into()).is_ge() && c.t.cmp_exact(&root.hi.into()).is_le()
    };
    // If t does not separate some crossings, those with the root's sign, in their order.
    let mut found = oracle.crossings(&line);
    found.retain(|c| c.sign == root.sign && holds(root, c));
    let before = |first: &Crossing| earlier.iter().filter(|r| r.sign == root.sign && holds(r, first)).count();
    let rank = found.first().map_or(0, before).min(found.len().saturating_sub(1));
    let Some(exact) = found.into_iter().nth(rank) else {
        return Err("no crossing in the bracket".into());
    };
    let point = surface.resolve(&LocalRay::new(ray), root, Need::ALL);
    is_well_formed(&point)?;
    // A crossing within 2^-640 of the surface's size nearly always suffices; only otherwise it is
    // computed to the digits that always suffice.
    let digits = 640 + i64::from(exponent(ray.direction.max_abs()) - exponent(oracle.size()));
    let near = exact.t.about(digits.max(64));
    let errors = ray.direction.to_array().map(|d| Exact::from(d).abs().shifted(-digits.max(64)));
    let place = surface.bounds();
    let far = || line.at(&exact.t.about(2400));
    let mut truth = line.at(&near);
    let decided = point_is_near(&point, &truth, &errors, &place).is_ok();
    if !decided {
        truth = far();
        // The oracle itself is precise to 2^-2400.
        let known = [0; 3].map(|_| Exact::from(-1.0).shifted(-1100));
        point_is_near(&point, &truth, &known, &place)?;
    }
    let normal = |mut truth: [Exact; 3]| {
        normal_is_the_exact_one(oracle, root, &truth, &point).or_else(|_| {
            truth = far();
            normal_is_the_exact_one(oracle, root, &truth, &point)
        })
    };
    // If the surface curves within the spacing of the coordinates, these cannot resolve its sides.
    let spacing = point.p.to_vec().max_abs() * durer_math::scale::ldexp(1.0, -50);
    if point.bend.is_finite() && point.bend * spacing > 1.0 / 64.0 {
        return normal(truth);
    }
    for (side, expected) in [(RaySide::Front, Ordering::Greater), (RaySide::Back, Ordering::Less)] {
        let n = point.ng.to_vec();
        let leaving = point.spawn_from(side, if side == RaySide::Front { n } else { -n });
        let at = exact3(leaving.origin.to_array());
        ensure!(
            // The sign of a single polynomial does not give the sides of a tip.
            point.bend == f64::INFINITY || oracle.face_side(root.face, &at) == expected,
            "a ray for the {side:?} starts on the wrong side: off {}, {point:?}",
            point.off
        );
        roots_are_the_exact_crossings(surface, oracle, &leaving, None)?;
        // The side of the whole surface follows only if it has one face, or is that face here.
        if let Some(solid) = oracle.side(&at) {
            let told = surface.side(&LocalPoint::new(leaving.origin));
            let expected = match solid {
                Ordering::Less => Side::In,
                Ordering::Equal => Side::On,
                Ordering::Greater => Side::Out,
            };
            ensure!(told == expected, "side says {told:?}, exactly it is {expected:?}");
            let consistent =
                (solid == Ordering::Greater) == (side == RaySide::Front) && solid != Ordering::Equal;
            if consistent {
                roots_are_the_exact_crossings(surface, oracle, &leaving, Some((side, root.face)))?;
                let met = all_roots(surface, &leaving);
                ensure!(
                    !(oracle.is_convex() && side == RaySide::Front) || met.is_empty(),
                    "a ray that leaves a convex solid meets it again: {met:?}"
                );
            }
        } else {
            ensure!(surface.solidity() == Solidity::Open, "the oracle knows no inside, the surface does");
        }
    }
    normal(truth)
}

/// Tests that a point is at most `dp` from a crossing and the crossing is in the bounds. `truth` is
/// at most `errors` from the crossing.
///
/// Negative errors loosen the test by as much instead.
fn point_is_near(
    point: &SurfacePoint,
    truth: &[Exact; 3],
    errors: &[Exact; 3],
    bounds: &Aabb,
) -> Result<(), Broken> {
    for (i, (exact, slack)) in truth.iter().zip(errors).enumerate() {
        let error = (exact - &point.p[i].into()).abs();
        ensure!(
            (&(&error + slack) - &Exact::from(point.dp[i])).sign().is_le(),
            "p misses the crossing by {} along axis {i}, dp is {}: {point:?}",
            error.to_f64(),
            point.dp[i]
        );
        for (end, outward) in [(bounds.min[i], -1.0), (bounds.max[i], 1.0)] {
            if !end.is_finite() {
                continue;
            }
            let beyond = &(exact - &end.into()) * &Exact::from(outward);
            ensure!(
                (&beyond + slack).sign().is_le(),
                "the crossing is {} beyond {end}, an end of the bounds along axis {i}: {point:?}",
                beyond.to_f64()
            );
        }
    }
    Ok(())
}

/// No number is NaN, lengths are correct, tangents are tangent.
fn is_well_formed(point: &SurfacePoint) -> Result<(), Broken> {
    let n = point.ng.to_vec();
    ensure!(point.p.is_finite() && point.dp.is_finite(), "the point is not finite: {point:?}");
    ensure!(point.off.is_finite() && point.off > 0.0, "off is not positive: {point:?}");
    ensure!((n.length() - 1.0).abs() < 8.0 * U, "the normal's length is not one: {point:?}");
    ensure!(point.ns.dot(n) > 0.0, "the shading normal is on the other side: {point:?}");
    ensure!(point.uv.iter().all(|x| x.is_finite()), "uv is not finite: {point:?}");
    for v in [point.dpdu, point.dpdv] {
        let size = exponent(v.max_abs().max(f64::MIN_POSITIVE));
        let unit: Vec3 = v.map(|x| durer_math::scale::ldexp(x, -size));
        ensure!(v.is_finite(), "a tangent is not finite: {point:?}");
        // Tangents are for shading: half the digits suffice. A tip has none.
        ensure!(
            point.bend == f64::INFINITY || n.dot(unit).abs() < 1e-6,
            "a tangent is not tangent by {}: {point:?}",
            n.dot(unit)
        );
    }
    ensure!(point.dndu.is_finite() && point.dndv.is_finite(), "dn is not finite: {point:?}");
    Ok(())
}

/// The normal agrees with the exact gradient, unless the point is so close to a tip that it has
/// none.
fn normal_is_the_exact_one(
    oracle: &dyn Oracle,
    root: &Root,
    truth: &[Exact; 3],
    point: &SurfacePoint,
) -> Result<(), Broken> {
    let g = oracle.face_normal(root.face, truth);
    let length = g.length();
    if length > 0.0 && length.is_finite() && point.bend.is_finite() {
        let error = (g * (1.0 / length) - point.ng.to_vec()).length();
        // The normal rotates by at most `bend` times the distance to the exact point.
        let turn = if point.bend == 0.0 { 0.0 } else { point.bend * point.dp.length() * 4.0 };
        ensure!(
            error <= turn + 64.0 * U || turn > 0.1,
            "the normal is off by {error}, bend allows {turn}: {point:?}"
        );
    }
    Ok(())
}

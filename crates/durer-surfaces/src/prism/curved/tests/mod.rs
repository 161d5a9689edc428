//! The laws, tested against exact crossings that share no code with the kernel; and the laws of
//! rays through joints and rims.

mod swept;

use super::*;
use crate::laws::{self, Feature, Oracle, TestRng, aim, all_roots, exact3};
use crate::prism::outline::Point;
use crate::prism::tests::Obeyed;
use crate::{All, RootKind};
use durer_math::{Affine, Ray};
use swept::Swept;

/// A round outline of four pieces.
fn round(at: Point, r: f64, k: f64) -> Vec<Bezier> {
    let p = |x: f64, z: f64| [at[0] + r * x, at[1] + r * z];
    vec![
        [p(1.0, 0.0), p(1.0, k), p(k, 1.0), p(0.0, 1.0)],
        [p(0.0, 1.0), p(-k, 1.0), p(-1.0, k), p(-1.0, 0.0)],
        [p(-1.0, 0.0), p(-1.0, -k), p(-k, -1.0), p(0.0, -1.0)],
        [p(0.0, -1.0), p(k, -1.0), p(1.0, -k), p(1.0, 0.0)],
    ]
}

/// Half a disc: straight edges and curves with corners between them.
fn half() -> Vec<Bezier> {
    vec![
        [[-2.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
        [[2.0, 0.0], [2.0, 3.0], [-2.0, 3.0], [-2.0, 0.0]],
    ]
}

fn sets() -> Vec<(Vec<Vec<Bezier>>, bool)> {
    let wave = [
        [0.0, -4.0],
        [-3.0, -2.0],
        [0.0, -1.0],
        [3.0, -2.0],
        [2.0, 2.0],
        [0.0, 1.0],
        [-2.0, 3.0],
        [-3.0, -2.0],
        [1.0, 1.0],
    ];
    let eight = [[2.0, -2.0], [-2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [2.0, -2.0], [-2.0, -2.0], [1.0, 0.0]];
    let arcs = [[-1.0, 3.0], [-2.0, -2.0], [3.0, -1.0], [2.0, 2.0], [-1.0, 3.0], [-2.0, -2.0]];
    vec![
        (vec![round([0.0; 2], 3.0, 0.5625)], false),
        (vec![round([0.0; 2], 3.0, 0.5625), round([0.5, -0.25], 1.0, 0.5)], false),
        (vec![half()], false),
        (vec![Spline::Cubic.pieces(&wave)], false),
        (vec![Spline::Quadratic.pieces(&arcs)], false),
        (vec![Spline::Cubic.pieces(&eight)], true),
        (vec![round([0.0; 2], 2.0, 0.75), round([1.0, 0.5], 2.0, 0.5)], true),
    ]
}

fn cases() -> Vec<(CurvedPrism, Swept)> {
    let mut out = vec![];
    for (outlines, tangled) in sets() {
        for (sweep, low, high) in [
            (Sweep::Linear, -1.0, 2.0),
            (Sweep::Linear, 0.25, 0.375),
            (Sweep::Conic, 0.5, 1.0),
            (Sweep::Conic, 0.0, 1.0),
            (Sweep::Conic, -1.0, 0.5),
        ] {
            // The heights in the other order make no difference.
            let prism = CurvedPrism::new(&outlines, high, low, sweep).unwrap();
            assert_eq!(prism.inside_is_left.is_none(), tangled, "{outlines:?}");
            out.push((prism, Swept::new(outlines.clone(), low, high, sweep)));
        }
    }
    out
}

/// Points of the walls, with tangents and rulings. At few-bit parameters of curves with few-bit
/// control points all of these are exact.
fn features(oracle: &Swept) -> Vec<Feature> {
    let mut out = vec![];
    let heights = [oracle.low, oracle.high, 0.5 * oracle.low + 0.5 * oracle.high];
    for b in oracle.pieces() {
        for u in [0.0, 0.25, 0.5, 0.625, 1.0] {
            let v = 1.0 - u;
            let [x, z] = [0, 1].map(|k| {
                v * v * v * b[0][k] + 3.0 * u * v * (v * b[1][k] + u * b[2][k]) + u * u * u * b[3][k]
            });
            let d = |i: usize, k: usize| b[i + 1][k] - b[i][k];
            let [sx, sz] = [0, 1].map(|k| v * v * d(0, k) + 2.0 * u * v * d(1, k) + u * u * d(2, k));
            for y in heights {
                let w = if oracle.sweep == Sweep::Linear { 1.0 } else { y };
                let ruling = if oracle.sweep == Sweep::Linear { Vec3::Y } else { Vec3::new(x, 1.0, z) };
                let point = Point3::new(x * w, y, z * w);
                for direction in [
                    Vec3::new(sx, 0.0, sz),
                    Vec3::new(sx, 0.5, sz) + ruling * 0.25,
                    ruling,
                    Vec3::new(sz, 0.25, -sx),
                ] {
                    out.push(Feature { point, direction });
                }
            }
        }
    }
    out
}

#[test]
fn curved_prisms_obey_the_laws_off_their_joints() {
    let mut obeyed = Obeyed::default();
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let features = features(oracle);
        for i in laws::drawn(4) {
            let ray = aim(&mut laws::dice(seed as u64, i), &features, oracle.size());
            // The next test covers rays that meet a joint exactly.
            let broken = |e| panic!("{e}\n{seed} {i} {ray:?}\n{prism:?}");
            obeyed.count(prism, oracle, &ray).unwrap_or_else(broken);
        }
    }
    let Obeyed { rays, roots, clear } = obeyed;
    laws::report(rays);
    assert!(rays > 60 && roots > 60 && clear > 30, "{rays} {roots} {clear}");
}

#[test]
fn a_range_shorter_than_the_bracket_keeps_the_bounds_of_points() {
    let profile = vec![vec![
        [[-2.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [2.0, 0.0]],
        [[2.0, 0.0], [2.0, 3.0], [-2.0, 3.0], [-2.0, 0.0]],
    ]];
    let prism = CurvedPrism::new(&profile, 0.0, 1.0, Sweep::Conic).unwrap();
    let oracle = Swept::new(profile, 0.0, 1.0, Sweep::Conic);
    // The bracket is [0, 0], the kernel's own parameter of the crossing 3e-21.
    let direction = Vec3::new(21621.113345076585, -31007.694140711843, -8591.657224116916);
    let ray = Ray::new(Point3::new(0.0, 0.5, 1.125), direction).with_range(0.0, 0.0);
    laws::check(&prism, &oracle, &ray).unwrap();
}

#[test]
fn rays_through_joints_and_rims_go_in_as_often_as_out() {
    let mut through = 0;
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let features = features(oracle);
        let mut dice = TestRng::new(100 + seed as u64);
        for _ in 0..300 {
            let f = dice.pick(&features);
            let target = if dice.once_in(4) { dice.lattice(6).to_point() } else { f.point };
            let direction = match dice.below(3) {
                0 => f.direction,
                1 => dice.pick(&features).point - target,
                _ => dice.lattice(4),
            };
            if direction == Vec3::ZERO {
                continue;
            }
            let back = dice.pick(&[4.0, 1024.0, 1048576.0]);
            let ray =
                Ray::new(target - direction * back, direction).with_range(f64::NEG_INFINITY, f64::INFINITY);
            let roots = all_roots(prism, &ray);
            let (ins, outs) =
                (roots.iter().filter(|r| r.sign < 0).count(), roots.iter().filter(|r| r.sign > 0).count());
            assert!(
                ins == outs && roots.iter().all(|r| (r.sign == 0) == (r.kind == RootKind::Grazing)),
                "{roots:?} for {ray:?} and {prism:?}"
            );
            through += usize::from(ins > 0);
            // From the inside outward.
            let from = (dice.lattice(12) * 0.5).to_point();
            let at = exact3(from.to_array());
            if oracle.side(&at) != Some(Ordering::Equal) {
                let outward = Ray::new(from, f.point - from);
                if outward.is_valid() {
                    let inside = oracle.side(&at) == Some(Ordering::Less);
                    let met = all_roots(prism, &outward).iter().filter(|r| r.sign != 0).count();
                    assert_eq!(
                        met % 2 == 1,
                        inside,
                        "{met} from {from:?} along {:?}: {prism:?}",
                        outward.direction
                    );
                }
            }
        }
    }
    assert!(through > 1000, "{through}");
}

#[test]
fn beside_a_crossing_of_outlines_walls_are_met_in_their_order() {
    let outlines = vec![round([0.0; 2], 2.0, 0.75), round([1.0, 0.5], 2.0, 0.5)];
    let prism = CurvedPrism::linear(&outlines, -1.0, 1.0).unwrap();
    let oracle = Swept::new(outlines, -1.0, 1.0, Sweep::Linear);
    // Where the two cross each other, in f64.
    let crossings = [
        [-0.245_676_154_133_823_1, 1.995_083_175_442_483_8],
        [1.745_324_803_520_545_8, -1.322_975_631_290_527_4],
    ];
    let (mut dice, mut close) = (TestRng::new(12), 0);
    for _ in 0..400 {
        let [x, z] = dice.pick(&crossings);
        let d = Vec3::new(dice.between(-1.0, 1.0), dice.between(-0.02, 0.02), dice.between(-1.0, 1.0));
        let ray = Ray::new(Point3::new(x, 0.0, z) - d * dice.between(0.5, 30.0), d)
            .with_range(f64::NEG_INFINITY, f64::INFINITY);
        let exact = oracle.crossings(&laws::ExactLine::new(&ray));
        for root in all_roots(&prism, &ray) {
            let held = |c: &&laws::Crossing| {
                c.t.cmp_exact(&root.lo.into()).is_ge() && c.t.cmp_exact(&root.hi.into()).is_le()
            };
            close += usize::from(exact.iter().filter(held).count() > 1);
            let told = exact.iter().filter(held).any(|c| c.sign == root.sign);
            assert!(told, "{root:?} of {ray:?}");
        }
    }
    assert!(close > 300, "{close}");
}

#[test]
fn sides_are_exact() {
    let mut told = [0; 3];
    for (seed, (prism, oracle)) in cases().iter().enumerate() {
        let mut dice = TestRng::new(200 + seed as u64);
        let features = features(oracle);
        for _ in 0..150 {
            let p = match dice.below(3) {
                0 => dice.pick(&features).point,
                1 => {
                    dice.pick(&features).point
                        + (dice.pick(&features).point - dice.pick(&features).point) * 0.25
                }
                _ => prism.bounds.centre() + dice.lattice(16) * (prism.bounds.widths().y / 32.0),
            };
            let p =
                if dice.once_in(3) { Point3::new(dice.nudge(p.x, 1), dice.nudge(p.y, 1), p.z) } else { p };
            let expected = oracle.side(&exact3(p.to_array())).unwrap();
            let found = prism.side(&LocalPoint::new(p));
            let expected = [Side::In, Side::On, Side::Out][(expected as i8 + 1) as usize];
            assert_eq!(found, expected, "{p:?} of {prism:?}");
            told[expected as usize] += 1;
        }
    }
    assert!(told.iter().all(|&n| n > 150), "{told:?}");
}

#[test]
fn parts_together_are_the_whole() {
    let (mut parts, mut met) = (0, 0);
    for (seed, (prism, oracle)) in cases().into_iter().enumerate() {
        let mut dice = TestRng::new(300 + seed as u64);
        let prism = if dice.once_in(3) { prism.without_caps() } else { prism };
        let features = features(&oracle);
        for _ in 0..100 {
            let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
            let ray = if dice.once_in(2) {
                Ray::new(ray.origin, dice.pick(&features).point - ray.origin)
            } else {
                ray
            };
            let (asked, roots) = laws::parts_are_the_whole(&prism, &ray).unwrap_or_else(|e| panic!("{e}"));
            (parts, met) = (parts + asked, met + roots);
        }
    }
    assert!(parts > 10_000 && met > 1000, "{parts} {met}");
}

#[test]
fn straight_pieces_make_the_straight_prism() {
    let corners = [[-3.0, -3.0], [3.0, -2.0], [2.0, 3.0], [-3.0, 3.0]];
    let edge = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        [a, a, b, b]
    };
    let pieces = vec![(0..4).map(edge).collect::<Vec<Bezier>>()];
    let mut dice = TestRng::new(7);
    let mut met = 0;
    for (curved, straight) in [
        (CurvedPrism::linear(&pieces, -1.0, 2.0), crate::Prism::linear(&[corners], -1.0, 2.0)),
        (CurvedPrism::conic(&pieces, -1.0, 2.0), crate::Prism::conic(&[corners], -1.0, 2.0)),
    ] {
        let (curved, straight) = (curved.unwrap(), straight.unwrap());
        assert!(curved.inside_is_left.is_some());
        assert_eq!(curved.bounds(), straight.bounds());
        for _ in 0..1000 {
            let from = (dice.vector() * 9.0).to_point();
            let ray = Ray::new(from, (dice.vector() * 3.0).to_point() - from);
            let (a, b) = (all_roots(&curved, &ray), all_roots(&straight, &ray));
            assert_eq!(a.len(), b.len(), "{ray:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!(a.sign == b.sign && a.face == b.face && a.lo <= b.hi && b.lo <= a.hi, "{a:?} {b:?}");
            }
            met += a.len();
        }
    }
    assert!(met > 500, "{met}");
}

#[test]
fn without_caps_the_walls_stay() {
    for (outlines, _) in sets() {
        let prism = CurvedPrism::linear(&outlines, 0.0, 1.0).unwrap();
        let open = prism.clone().without_caps();
        assert_eq!(open.solidity(), Solidity::Open);
        let mut dice = TestRng::new(8);
        for _ in 0..100 {
            let ray = Ray::new((dice.vector() * 9.0).to_point(), dice.vector());
            let mut closed = all_roots(&prism, &ray);
            closed.retain(|r| r.face == 0);
            assert_eq!(all_roots(&open, &ray), closed);
        }
    }
}

#[test]
fn bad_curved_prisms_are_named() {
    let ring = round([0.0; 2], 1.0, 0.5);
    assert_eq!(CurvedPrism::linear(&[] as &[Vec<Bezier>], 0.0, 1.0), Err(PrismError::Empty));
    assert_eq!(CurvedPrism::linear(&[&ring], 1.0, 1.0), Err(PrismError::Heights(1.0, 1.0)));
    assert_eq!(CurvedPrism::conic(&[&ring], 1.0, 1e308), Err(PrismError::TooLarge(1e308)));
    assert_eq!(
        CurvedPrism::linear(&[&ring, &ring[1..].to_vec()], 0.0, 1.0),
        Err(PrismError::Gap { outline: 1, piece: 2 })
    );
    assert_eq!(
        CurvedPrism::linear(&[[[[1.0, 1.0]; 4]]], 0.0, 1.0),
        Err(PrismError::TooShort { outline: 0, len: 1 })
    );
    let mut far = ring.clone();
    far[1][1] = [f64::NAN, 0.0];
    assert!(matches!(CurvedPrism::linear(&[far], 0.0, 1.0), Err(PrismError::Point { .. })));
}

/// Under a placement whose inverse is rounded, a ray along the sweep crosses the walls where f64
/// gives no information: the bracket contains all numbers.
#[test]
fn along_the_sweep_who_looks_finds_what_who_measures_finds() {
    let affine =
        Affine::new([[2.0, -3.0, -3.0], [2.0, 0.0, 2.0], [-3.0, 2.0, 0.0]], Point3::new(-7.0, 1.0, 1.0));
    let affine = affine.expect("a placement");
    let prism = CurvedPrism::linear(&[round([0.0; 2], 1.0, 0.5)], -1.0, 8.0).expect("a prism");
    // From a point of a wall along the sweep, rounded.
    let mut dice = TestRng::new(23);
    let mut met = 0;
    for _ in 0..2000 {
        let at = dice.below(4) as f64 * 0.25;
        let (u, v) = (at, 1.0 - at);
        let k = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
        let piece = round([0.0; 2], 1.0, 0.5)[dice.below(4) as usize];
        let [x, z] = [0, 1].map(|i| (0..4).map(|j| k[j] * piece[j][i]).sum::<f64>());
        let start = affine.point(Point3::new(x, dice.below(8) as f64 * 0.5, z));
        let along = affine.vector(Vec3::Y);
        let size = dice.between(1.0, 1e6) * if dice.once_in(2) { -1.0 } else { 1.0 };
        let ray = Ray::new(start, along.map(|e| e * size)).with_range(0.0, f64::INFINITY);
        let [fine, rough] = [LocalRay::new(&ray), LocalRay::new(&ray).roughly()].map(|ray| {
            let mut all = All::default();
            prism.all_roots(&ray.through(&affine), &mut all);
            all.roots.iter().map(|root| (root.sign, root.face)).collect::<Vec<_>>()
        });
        assert_eq!(fine, rough, "{ray:?}");
        met += usize::from(fine.iter().any(|&(_, face)| face == 0));
    }
    assert!(met > 100, "{met} of these met a wall");
}

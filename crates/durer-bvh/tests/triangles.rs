//! Answers that the triangles' filter calls certain are true.
//!
//! Vertices, origins and directions are integers, so `U`, `V`, `W` and the crossing's parameter are
//! exact in 128 bits. Rays are aimed at vertices, edges and interiors; meshes are soups, fans and
//! folded sheets, large and small in their scene; scenes are scaled by powers of two.

mod common;

use common::Draws;
use core::cmp::Ordering;
use durer_bvh::{Bvh, Frame, Leaf, Ray64, Settings};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Isa, Point3, Vec3};
use durer_testkit::TestRng;

type Place = [i64; 3];
type Triangle = [Place; 3];

fn minus(a: Place, b: Place) -> [i128; 3] {
    [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]))
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Where the line `o + t d` crosses a triangle, edges included.
#[derive(Clone, Copy)]
struct Crossing {
    /// `t = over / under`, `under > 0`.
    over: i128,
    under: i128,
    /// It touches no edge.
    inside: bool,
}

impl Crossing {
    fn of(v: &Triangle, o: Place, d: Place) -> Option<Self> {
        let d = minus(d, [0; 3]);
        let [a, b, c] = v.map(|v| minus(v, o));
        let side = |p, q| dot(d, cross(q, p));
        let sides = [side(b, c), side(c, a), side(a, b)];
        if sides.iter().any(|&s| s > 0) && sides.iter().any(|&s| s < 0) {
            return None;
        }
        let normal = cross(minus(v[1], v[0]), minus(v[2], v[0]));
        let (over, under) = (dot(a, normal), dot(d, normal));
        if under == 0 {
            return None;
        }
        let (over, under) = if under < 0 { (-over, -under) } else { (over, under) };
        Some(Self { over, under, inside: !sides.contains(&0) })
    }

    fn order(&self, other: &Self) -> Ordering {
        // Below 2^84 and 2^63 each: the integer parts are compared first, then the remainders.
        let split = |c: &Self| (c.over.div_euclid(c.under), c.over.rem_euclid(c.under));
        let ((a, p), (b, q)) = (split(self), split(other));
        a.cmp(&b).then_with(|| (p * other.under).cmp(&(q * self.under)))
    }

    /// A number not below `t`.
    fn above(&self) -> f64 {
        let t = self.over as f64 / self.under as f64;
        t + 4.0 * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
    }
}

/// Triangles, none of them degenerate, some of which share edges and vertices.
fn scene(dice: &mut TestRng, grid: i64) -> Vec<Triangle> {
    // From triangles as large as the scene to triangles at the resolution of f32.
    let spread = 1 + (grid >> dice.below(22));
    let corner = |dice: &mut TestRng, about: Place, size: i64| -> Place {
        core::array::from_fn(|i| (about[i] + dice.about(size)).clamp(-grid, grid))
    };
    let mut triangles: Vec<Triangle> = Vec::new();
    let most = [1, 3, 40, 300][dice.below(4) as usize];
    for _ in 0..1 + dice.below(most) {
        let next = match triangles.last() {
            // A neighbour across an edge, or around a vertex.
            Some(&[a, b, c]) if dice.below(3) > 0 => {
                let size = 1 + dice.below(spread as u64) as i64;
                let new = corner(dice, c, size);
                if dice.below(2) == 0 { [c, b, new] } else { [a, c, new] }
            }
            _ => {
                let about = corner(dice, [0; 3], grid);
                // Some are large beside the others.
                let size = if dice.below(6) == 0 { grid } else { 1 + dice.below(spread as u64) as i64 };
                [about, corner(dice, about, size), corner(dice, about, size)]
            }
        };
        if cross(minus(next[1], next[0]), minus(next[2], next[0])) != [0; 3] {
            triangles.push(next);
        }
    }
    triangles
}

fn point(p: Place, k: i32) -> Point3 {
    Point3::from(p.map(|x| scale2(x as f64, k)))
}

/// A ray from an integer point at a vertex, at the middle of an edge or at an inner point.
fn aim(dice: &mut TestRng, v: &Triangle, grid: i64) -> (Place, Place) {
    // Twice the target, so that midpoints are integers.
    let [a, b, c] = *v;
    let target: Place = match dice.below(4) {
        0 => a.map(|x| 2 * x),
        1 => [0, 1, 2].map(|i| a[i] + b[i]),
        2 => [0, 1, 2].map(|i| a[i] + (b[i] + c[i]) / 2),
        _ => [0, 1, 2].map(|i| 2 * c[i] + dice.about(1)),
    };
    let size = [1, 9, if grid <= 1 << 20 { grid } else { 5 }][dice.below(3) as usize];
    let mut d: Place = core::array::from_fn(|_| dice.about(size));
    if d == [0; 3] {
        d = [1, 0, 0];
    }
    let steps = dice.below(40) as i64 - 4;
    ([0, 1, 2].map(|i| (target[i] - 2 * steps * d[i]) / 2), d)
}

#[test]
fn what_the_filter_says_for_certain_is_true() {
    assert_eq!(the_filter_is_right(1500, &Settings::GOOD), 0);
}

#[test]
fn trees_that_were_built_fast_show_the_same() {
    assert_eq!(the_filter_is_right(1500, &Settings::FAST), 0);
}

#[test]
fn triangles_that_stand_in_several_leaves_are_shown_once() {
    let shared = the_filter_is_right(1500, &Settings::BEST);
    assert!(shared > 1000, "{shared} more references than triangles");
}

/// Returns how many more references than triangles there were.
fn the_filter_is_right(seeds: u64, settings: &Settings) -> usize {
    let (mut offered, mut hits, mut trusted, mut known) = (0_u64, 0_u64, 0_u64, 0_u64);
    let mut shared = 0;
    for seed in 0..seeds {
        let mut dice = TestRng::new(seed);
        // f32 holds the coordinates of the first three.
        let grid = [6, 1000, 1 << 20, 1 << 26][seed as usize % 4];
        // Rays of the first two exponents use the f32 setup.
        let k = [0, -30, 250, -500][dice.below(4) as usize];
        let triangles = scene(&mut dice, grid);
        if triangles.is_empty() {
            continue;
        }
        // Half of the scenes are far from the origin: sides and parameters do not change.
        let place = common::place(&mut TestRng::new(!seed), 50);
        let point = |p: Place| point([0, 1, 2].map(|i| p[i] + place[i]), k);
        let corners = |n: u32| triangles[n as usize].map(point);
        let all = triangles.iter().flatten().map(|&v| point(v));
        let bounds = Aabb::from_points(all);
        let frame = Frame::around(&bounds);
        let entry = |n: usize| frame.entry(&Aabb::from_points(corners(n as u32)), 0, n as u32);
        let entries = (0..triangles.len()).map(entry).collect();
        let (tree, order) = Bvh::build(&frame, entries, &[Some(&corners)], settings);
        shared += tree.stats().entries - triangles.len();
        let number = |leaf: Leaf| {
            assert_eq!(leaf.count, 1, "triangles are shown one by one");
            order[0][leaf.first as usize]
        };
        tree.validate(|_, slot| Aabb::from_points(corners(order[0][slot as usize]))).expect("a valid tree");
        for _ in 0..30 {
            let one = triangles[dice.below(triangles.len() as u64) as usize];
            let (o, d) = aim(&mut dice, &one, grid);
            let direction = Vec3::from(d.map(|x| x as f64));
            let e = exponent(direction.max_abs());
            // Converts t to the tree ray's parameter: the origin was scaled by 2^k, the direction
            // by 2^-e.
            let clock = |t: f64| scale2(t, k + e);
            let line = Ray64 {
                origin: point(o),
                direction: direction.scale2(-e),
                origin_error: Vec3::ZERO,
                direction_error: Vec3::ZERO,
                t_min: 0.0,
                t_max: f64::INFINITY,
                inner: (0.0, f64::INFINITY),
            };
            let met: Vec<Option<Crossing>> =
                triangles.iter().map(|v| Crossing::of(v, o, d).filter(|c| c.over >= 0)).collect();
            let best = met.iter().flatten().min_by(|a, b| a.order(b));
            for isa in Isa::available() {
                let mut shown = Vec::new();
                tree.each(isa, &line, |leaf| {
                    shown.push(number(leaf));
                    let kept = tree.corners(&leaf);
                    known += u64::from(kept.is_some());
                    assert!(kept.is_none_or(|kept| kept == corners(number(leaf))));
                    false
                });
                for (n, _) in met.iter().enumerate().filter(|(_, c)| c.is_some()) {
                    assert!(
                        shown.contains(&(n as u32)),
                        "seed {seed}, {isa:?}: {n} is not shown to {line:?}"
                    );
                }
                let times = |n: u32| shown.iter().filter(|&&m| m == n).count();
                assert!(shown.iter().all(|&n| times(n) == 1));

                let mut asked = Vec::new();
                let sure = tree.any(
                    isa,
                    &line,
                    |_| true,
                    |leaf| {
                        asked.push(number(leaf));
                        false
                    },
                );
                let inside = met.iter().flatten().any(|c| c.inside);
                assert!(!sure || inside, "seed {seed}, {isa:?}: {line:?} is said to hit, but does not");
                if !sure {
                    let missing = (0..met.len()).find(|&n| met[n].is_some() && !asked.contains(&(n as u32)));
                    assert_eq!(missing, None, "seed {seed}, {isa:?}: not asked");
                }
                trusted += u64::from(sure);

                let mut found: Option<Crossing> = None;
                tree.closest(
                    isa,
                    &line,
                    |_| true,
                    |leaf| {
                        let n = number(leaf);
                        offered += 1;
                        if let Some(c) = met[n as usize]
                            && found.is_none_or(|f| c.order(&f).is_lt())
                        {
                            found = Some(c);
                        }
                        found.map_or(f64::INFINITY, |f| clock(f.above()))
                    },
                );
                hits += u64::from(best.is_some());
                match (found, best) {
                    (None, None) => {}
                    (Some(a), Some(b)) => assert!(a.order(b).is_eq(), "seed {seed}, {isa:?}: not the first"),
                    _ => panic!("seed {seed}, {isa:?}: {:?}, but {:?}", found.is_some(), best.is_some()),
                }
            }
        }
    }
    assert!(hits > 50_000 && trusted > hits / 10, "{hits} hits, {trusted} rays certain of one");
    assert!(known > hits, "corners of {known} triangles, {hits} hits");
    assert!(offered < 4 * hits, "{offered} questions for {hits} hits");
    shared
}

/// The cost of a mesh does not depend on what else the tree holds, or could hold.
#[test]
fn triangles_fill_their_blocks_beside_other_things() {
    let mut dice = TestRng::new(5);
    let corner = |i: i64, j: i64, dice: &mut TestRng| [8 * i, 8 * j, dice.about(3)];
    let heights: Vec<Place> = (0..40 * 40).map(|n| corner(n / 40, n % 40, &mut dice)).collect();
    let at = |i: usize, j: usize| heights[40 * i + j];
    let cells = (0..39 * 39).map(|n| (n / 39, n % 39));
    let triangles: Vec<Triangle> = cells
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    let corners = |n: u32| triangles[n as usize].map(|v| point(v, 0));
    let frame = Frame::around(&Aabb::from_points(heights.iter().map(|&v| point(v, 0))));
    let entries = |kind: u32| -> Vec<_> {
        let entry = |n: usize| frame.entry(&Aabb::from_points(corners(n as u32)), kind, n as u32);
        (0..triangles.len()).map(entry).collect()
    };
    let (alone, order) = Bvh::build(&frame, entries(0), &[Some(&corners)], &Settings::GOOD);
    let (among, other) = Bvh::build(&frame, entries(1), &[None, Some(&corners), None], &Settings::GOOD);
    assert_eq!(order[0], other[1]);
    assert_eq!(alone.stats().leaves, among.stats().leaves);
    assert_eq!((alone.blocks(), among.blocks()), (alone.stats().leaves, among.stats().leaves));
    // One more box beside them changes one leaf, not all.
    let mut more = entries(1);
    more.push(frame.entry(&Aabb::from_points(corners(0)), 0, 0));
    let (mixed, _) = Bvh::build(&frame, more, &[None, Some(&corners), None], &Settings::GOOD);
    assert!(mixed.blocks() < alone.blocks() + alone.blocks() / 8, "{} {}", mixed.blocks(), alone.blocks());
}

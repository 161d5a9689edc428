//! Surfaces of noise against exact arithmetic: the definition of the noise, written once more in
//! numbers without rounding.

use durer_formula::noise::NoiseTable;
use durer_formula::{Builder, Formula, Op};
use durer_math::{Dyadic, Point3, Ray, Ring, Vec3};
use durer_surfaces::{All, AxisBox, Container, Isosurface, LocalRay, RootKind, Surface};
use durer_testkit::TestRng;
use std::cmp::Ordering;

fn number(x: f64) -> Dyadic {
    Dyadic::exact(x)
}

/// The greatest integer that is at most `x`, which is small.
fn floor(x: &Dyadic) -> f64 {
    let near = x.to_f64().floor();
    if number(near) > *x { near - 1.0 } else { near }
}

/// A table of noise: any numbers will do.
fn numbers() -> ([[f64; 4]; 256], [u16; 4096]) {
    let mut dice = TestRng::new(78);
    let points = core::array::from_fn(|_| [0.5, 1.0, 1.0, 1.0].map(|most: f64| most * dice.signed()));
    // A permutation: multiplication by an odd number.
    (points, core::array::from_fn(|i| (i * 1237 + 411) as u16 % 4096))
}

fn table() -> &'static NoiseTable {
    let (points, order) = numbers();
    NoiseTable::shared(&points, &order).unwrap()
}

/// The value and the slopes of a point of the lattice, of a table or of durer's own noise.
fn corner(is_table: bool, p: [f64; 3]) -> [f64; 4] {
    if is_table {
        let (points, order) = numbers();
        let [x, y, z] = p.map(|x| (x + 10_000.0).rem_euclid(4096.0) as usize);
        let next = |k: usize| usize::from(order[k % 4096]);
        return points[next(next(next(x) ^ y) ^ z) % 256];
    }
    let mut hash = 0_u32;
    for (x, prime) in p.into_iter().zip([0x9e37_79b1_u32, 0x85eb_ca77, 0xc2b2_ae3d]) {
        hash ^= (x as i64 as u32).wrapping_mul(prime);
    }
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    let [v, gx, gy, gz] = (hash ^ hash >> 16).to_le_bytes().map(f64::from);
    let slope = |g: f64| (2.0 * g - 255.0) / 256.0;
    [(v - 132.0) / 256.0, slope(gx), slope(gy), slope(gz)]
}

fn noise(is_table: bool, p: &[Dyadic; 3]) -> Dyadic {
    let whole = [0, 1, 2].map(|i| floor(&p[i]));
    let t = [0, 1, 2].map(|i| p[i].clone() - number(whole[i]));
    let mut sum = Dyadic::ZERO;
    for bits in 0..8_u32 {
        let upper = [0, 1, 2].map(|i| f64::from(bits >> i & 1));
        let [v, slopes @ ..] = corner(is_table, [0, 1, 2].map(|i| whole[i] + upper[i]));
        let (mut weight, mut value) = (number(1.0), number(v));
        for i in 0..3 {
            let f = t[i].clone().square() * (number(3.0) - number(2.0) * t[i].clone());
            weight = weight * if upper[i] == 1.0 { f } else { number(1.0) - f };
            value = value + number(slopes[i]) * (t[i].clone() - number(upper[i]));
        }
        sum = sum + weight * value;
    }
    sum
}

/// `x^2 + y^2 + z^2 - 1 + n(k p)/2`.
fn bumpy(k: f64) -> Formula {
    let mut b = Builder::new();
    let mut write = || {
        let p = [b.input(0)?, b.input(1)?, b.input(2)?];
        let (k, one, half) = (b.constant(k)?, b.constant(1.0)?, b.constant(0.5)?);
        let scaled = [b.push(Op::Mul(k, p[0]))?, b.push(Op::Mul(k, p[1]))?, b.push(Op::Mul(k, p[2]))?];
        let noise = b.push(Op::Noise(None, scaled))?;
        let mut sum = b.push(Op::Mul(half, noise))?;
        for x in p {
            let square = b.push(Op::Sqr(x))?;
            sum = b.push(Op::Add(sum, square))?;
        }
        b.push(Op::Sub(sum, one))
    };
    let root = write().unwrap();
    b.finish(root, 3)
}

/// The exact sign of the formula at the exact point `o + t d`.
fn sign(is_table: bool, k: f64, ray: &Ray, t: f64) -> Ordering {
    let at = |i: usize| number(ray.origin[i]) + number(t) * number(ray.direction[i]);
    let p = [at(0), at(1), at(2)];
    let mut value = noise(is_table, &p.each_ref().map(|x| number(k) * x.clone())) * number(0.5) - number(1.0);
    for x in p {
        value = value + x.square();
    }
    value.exact_sign()
}

#[test]
fn brackets_hold_a_change_of_the_exact_sign_and_none_is_left_out() {
    let mut dice = TestRng::new(76);
    for (k, is_table) in [(0.7, false), (3.0, false), (11.0, false), (0.7, true), (5.0, true)] {
        let formula = bumpy(k).with_noise(is_table.then(table));
        let container = AxisBox::new(Point3::new(-2.0, -2.0, -2.0), Point3::new(2.0, 2.0, 2.0)).unwrap();
        let surface = Isosurface::new(&formula, 0.0, Container::Box(container)).unwrap();
        let (mut simple, mut clusters, mut widths) = (0, 0, Vec::new());
        for _ in 0..400 {
            let through = dice.vector() * 1.1;
            let away = dice.vector() * [1.0, 5.0, 100.0][dice.below(3) as usize];
            let ray = Ray::new(through.to_point() + away, -away);
            let ray = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
            let mut all = All::default();
            surface.roots(&LocalRay::new(&ray), &mut all);
            // The ray starts outside, changes sides at each crossing, and ends outside.
            let mut side = Ordering::Greater;
            for root in &all.roots {
                let expected = if root.sign < 0 { Ordering::Less } else { Ordering::Greater };
                if root.kind == RootKind::Cluster {
                    clusters += 1;
                } else {
                    simple += 1;
                    assert_eq!(
                        (sign(is_table, k, &ray, root.lo), sign(is_table, k, &ray, root.hi)),
                        (side, expected),
                        "{ray:?}"
                    );
                    widths.push((root.hi - root.lo) / (root.t.abs().max(1.0) * f64::EPSILON));
                }
                if root.sign != 0 {
                    side = expected;
                }
            }
            assert_eq!(side, Ordering::Greater, "{ray:?}");
            // Between the crossings the exact sign agrees with them.
            let reach = 3.0 / away.length();
            for step in 0..96 {
                let t = 1.0 + reach * (f64::from(step) / 48.0 - 1.0);
                if (ray.at(t) - Point3::ORIGIN).max_abs() > 1.99
                    || all.roots.iter().any(|r| r.lo <= t && t <= r.hi)
                {
                    continue;
                }
                let crossed: i32 = all.roots.iter().filter(|r| r.hi < t).map(|r| i32::from(r.sign)).sum();
                let expected = if crossed == 0 { Ordering::Greater } else { Ordering::Less };
                assert_eq!(sign(is_table, k, &ray, t), expected, "{ray:?} at {t}: {:?}", all.roots);
            }
        }
        widths.sort_by(f64::total_cmp);
        let median = widths[widths.len() / 2];
        println!("k {k}: {simple} simple, {clusters} clusters, median {median:.1} ulp");
        assert!(simple > 400 && clusters * 1000 < simple && median < 1000.0, "{simple} {clusters} {median}");
    }
}

#[test]
fn it_is_the_noise_of_the_tape() {
    let mut dice = TestRng::new(77);
    let mut b = Builder::new();
    let p = [b.input(0).unwrap(), b.input(1).unwrap(), b.input(2).unwrap()];
    let root = b.push(Op::Noise(None, p)).unwrap();
    let own = b.finish(root, 3);
    for i in 0..2000 {
        let is_table = i % 2 == 0;
        let formula = own.clone().with_noise(is_table.then(table));
        let Vec3 { x, y, z } = dice.vector() * 100.0;
        let (rounded, exact) =
            (formula.value(&[x, y, z]), noise(is_table, &[number(x), number(y), number(z)]).to_f64());
        assert!((rounded - exact).abs() < 80.0 * durer_math::U, "{rounded} {exact}");
    }
}

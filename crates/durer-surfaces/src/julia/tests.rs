//! The facts that balls around orbits prove about intervals, against orbits in exact arithmetic.

use super::JuliaPower;
use super::orbit::{Ball, Rule, TINY};
use crate::laws::TestRng;
use core::cmp::Ordering::{Greater, Less};
use durer_math::scale::pow2;
use durer_math::{Dyadic, F8, Ring, U};

/// `|z_N|²` of the orbit that starts at `q + v x`, times the count of numbers, exactly.
fn exact<const M: usize, const C: usize>(
    rule: &Rule<f64, M, C>,
    (q, v): (&[[f64; C]; M], &[[f64; C]; M]),
    x: f64,
) -> Dyadic {
    let of = Dyadic::exact;
    let mut all = of(0.0);
    for m in 0..M {
        let mut z: [Dyadic; C] = core::array::from_fn(|i| of(q[m][i]) + of(v[m][i]) * of(x));
        for _ in 0..rule.iterations {
            let a = z[0].clone();
            let rest = z[1..].iter().fold(of(0.0), |sum, z| sum + z.clone().square());
            let (real, factor) = match rule.power {
                JuliaPower::Square => (a.clone().square() - rest, of(2.0) * a),
                JuliaPower::Cube => {
                    let square = a.clone().square();
                    (a * (square.clone() - of(3.0) * rest.clone()), of(3.0) * square - rest)
                }
            };
            z = core::array::from_fn(|i| {
                of(rule.c[m][i]) + if i == 0 { real.clone() } else { factor.clone() * z[i].clone() }
            });
        }
        all = z.iter().fold(all, |sum, z| sum + z.clone().square());
    }
    all
}

/// Radii that are as near to the ends of stretches as f32 can tell, or nearer, and stretches that
/// are long and short beside its roundings: what it says is certain all the same, and of long ones
/// it says nearly as much as f64 does, or lanes would look in vain.
fn what_f32_says_is_so<const M: usize, const C: usize>(seed: u64) {
    let mut dice = TestRng::new(seed);
    let (mut told, mut told_fine) = ([0; 4], [0; 4]);
    let mut tried = 0;
    while tried < 1200 {
        let power = if tried % 4 == 3 { JuliaPower::Cube } else { JuliaPower::Square };
        let iterations = tried % if power == JuliaPower::Cube { 4 } else { 7 };
        let mut numbers = |size: f64| -> [[f64; C]; M] {
            core::array::from_fn(|_| core::array::from_fn(|_| dice.between(-size, size)))
        };
        let shorter = tried % 24;
        // Without iterations the start has to reach the radius by itself.
        let reach = if iterations == 0 { 2.5 } else { 1.2 };
        let (c, q, v) = (numbers(0.5), numbers(reach), numbers(pow2(-1 - shorter as i32)));
        let length = |c: &[f64; C]| c.iter().map(|c| c * c).sum::<f64>().sqrt() * (1.0 + 8.0 * U);
        let c_size = c.iter().map(length).fold(0.0, f64::max);
        let (radius, escapes) = (4.0, true);
        let mut rule = Rule { c, c_err: 0.0, c_size, power, iterations, radius, radius_err: 0.0, escapes };
        let end = (exact(&rule, (&q, &v), 1.0).to_f64() / M as f64).sqrt();
        // An orbit that leaves such a radius never comes back: R² - √2 R >= |c|.
        if !(2.25..4.0).contains(&end) {
            continue;
        }
        tried += 1;
        rule.radius = end * (1.0 + dice.between(-1.0, 1.0) * pow2(-18 - (tried % 14) as i32));
        // Eight stretches as long, one after the other, up to that end.
        let mut mids = [q; 8];
        let mut balls = [Ball::new(&[F8::ZERO; C], &[F8::ZERO; C], F8::splat(TINY), F8::splat(TINY)); M];
        for (k, mid) in mids.iter_mut().enumerate() {
            for (m, ball) in balls.iter_mut().enumerate() {
                for i in 0..C {
                    mid[m][i] -= v[m][i] * (2.0 * k as f64);
                    (ball.q[i].0[k], ball.v[i].0[k]) = (mid[m][i], v[m][i]);
                }
            }
        }
        let (coarse, fine) = (rule.rounded().known(balls.map(|ball| ball.rounded())), rule.known(balls));
        let level = Dyadic::exact(rule.radius).square() * Dyadic::exact(M as f64);
        for (k, q) in mids.iter().enumerate() {
            let values = [-1.0, -0.75, -0.25, 0.0, 0.5, 0.875, 1.0].map(|x| exact(&rule, (q, &v), x));
            for known in [&coarse, &fine] {
                let so = [
                    values.iter().all(|g| g.cmp(&level) == Greater),
                    values.iter().all(|g| g.cmp(&level) == Less),
                    values.is_sorted(),
                    values.iter().rev().is_sorted(),
                ];
                for (said, so) in [known.out, known.within, known.rises, known.falls].into_iter().zip(so) {
                    assert!(so || !said.lane(k), "{known:?}, lane {k}: {rule:?} {q:?} {v:?}");
                }
            }
        }
        if shorter < 12 {
            for (told, known) in [(&mut told, &coarse), (&mut told_fine, &fine)] {
                let all = [known.out, known.within, known.rises, known.falls];
                for (told, known) in told.iter_mut().zip(all) {
                    *told += known.count();
                }
            }
        }
    }
    for (told, fine) in told.into_iter().zip(told_fine) {
        assert!(fine > 100 && told * 20 > fine * 19, "{told} of {fine}");
    }
}

#[test]
fn what_f32_says_of_quaternions_is_so() {
    what_f32_says_is_so::<1, 4>(31);
}

#[test]
fn what_f32_says_of_hypercomplex_numbers_is_so() {
    what_f32_says_is_so::<2, 2>(32);
}

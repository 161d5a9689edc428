//! Surfaces of distances to random points against exact arithmetic: where the nearest point is at the
//! distance `r`, the surface is that of a union of balls.

use durer_formula::noise::{CellNumbers, Nearest};
use durer_formula::{Builder, Formula, Op};
use durer_math::{Dyadic, Point3, Ray, Ring};
use durer_surfaces::{All, AxisBox, Container, Isosurface, LocalRay, RootKind, Surface};
use durer_testkit::TestRng;
use std::cmp::Ordering;

/// The distance of the given rank.
fn distance(rank: usize) -> Formula {
    let mut b = Builder::new();
    let p = [0, 1, 2].map(|i| b.input(i).unwrap());
    let root = b.push(Op::Nearest(Nearest::shared(rank, 2.0, 0.0).unwrap(), p)).unwrap();
    b.finish(root, 3)
}

/// The sign of the distance of the given rank from the exact point `o + t d`, less `r`.
fn sign(rank: usize, r: f64, ray: &Ray, t: f64) -> Ordering {
    let number = |x: f64| Dyadic::exact(x);
    let at = |i: usize| number(ray.origin[i]) + number(t) * number(ray.direction[i]);
    let p = [at(0), at(1), at(2)];
    // No point farther away matters: the distances of all ranks are below 2.1.
    let cube = p.each_ref().map(|x| x.to_f64().floor());
    let mut nearer = 0;
    let mut on = false;
    for step in 0..343 {
        let own: [f64; 3] = [step % 7, step / 7 % 7, step / 49].map(f64::from);
        let own: [f64; 3] = core::array::from_fn(|i| cube[i] + own[i] - 3.0);
        let within = CellNumbers::get().of(own);
        let part = |i: usize| (p[i].clone() - number(own[i]) - number(within[i])).square();
        match (part(0) + part(1) + part(2) - number(r).square()).exact_sign() {
            Ordering::Less => nearer += 1,
            Ordering::Equal => on = true,
            Ordering::Greater => {}
        }
    }
    match (nearer > rank, on) {
        (true, _) => Ordering::Less,
        (false, false) => Ordering::Greater,
        (false, true) => Ordering::Equal,
    }
}

#[test]
fn brackets_hold_a_change_of_the_exact_sign_and_none_is_left_out() {
    let mut dice = TestRng::new(91);
    let container = AxisBox::new(Point3::new(-2.0, -2.0, -2.0), Point3::new(2.0, 2.0, 2.0)).unwrap();
    for (rank, r) in [(0, 0.3), (0, 0.6), (1, 0.7), (2, 0.9)] {
        let surface = Isosurface::new(&distance(rank), r, Container::Box(container)).unwrap();
        let (mut simple, mut clusters, mut checked) = (0, 0, 0);
        for _ in 0..120 {
            let away = dice.vector() * [1.0, 5.0, 100.0][dice.below(3) as usize];
            let ray = Ray::new((dice.vector() * 1.5).to_point() + away, -away);
            let ray = ray.with_range(f64::NEG_INFINITY, f64::INFINITY);
            let mut all = All::default();
            surface.roots(&LocalRay::new(&ray), &mut all);
            let is_within = |t: f64| (ray.at(t) - Point3::ORIGIN).max_abs() < 1.999;
            for root in all.roots.iter().filter(|root| is_within(root.lo) && is_within(root.hi)) {
                if root.kind == RootKind::Cluster {
                    clusters += 1;
                    continue;
                }
                simple += 1;
                let after = if root.sign < 0 { Ordering::Less } else { Ordering::Greater };
                let found = (sign(rank, r, &ray, root.lo), sign(rank, r, &ray, root.hi));
                assert_eq!(found, (after.reverse(), after), "{ray:?} {root:?}");
            }
            // Between the crossings the exact sign agrees with them.
            let reach = 3.0 / away.length();
            for step in 0..24 {
                let t = 1.0 + reach * (f64::from(step) / 12.0 - 1.0);
                if !is_within(t) || all.roots.iter().any(|root| root.lo <= t && t <= root.hi) {
                    continue;
                }
                let crossed: i32 =
                    all.roots.iter().filter(|root| root.hi < t).map(|root| i32::from(root.sign)).sum();
                let expected = if crossed == 0 { Ordering::Greater } else { Ordering::Less };
                assert_eq!(sign(rank, r, &ray, t), expected, "{ray:?} at {t}: {:?}", all.roots);
                checked += 1;
            }
        }
        println!("rank {rank}: {simple} simple, {clusters} clusters, {checked} between");
        assert!(simple > 100 && clusters * 100 < simple && checked > 500, "{simple} {clusters} {checked}");
    }
}

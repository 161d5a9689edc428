//! What certainty costs: the sphere's discriminant and the edge predicate, in ns per evaluation.
//!
//! `cargo run --release -p durer-math --example cost`. Each row evaluates `(o.d)^2 - d.d (o.o - 1)`
//! for 1024 rays in cache, through the feature door and outside it; "sum" keeps the compiler from
//! dropping the work, and is equal for equal bits.

use durer_math::ladder::{self, Predicate};
use durer_math::{Dd, Dyadic, EFloat, EdgeRay, Isa, Point3, Ring, Vec3};
use std::hint::black_box;
use std::time::Instant;

struct Discriminant {
    o: [f64; 3],
    d: [f64; 3],
}

impl Predicate for Discriminant {
    #[inline(always)]
    fn eval<T: Ring>(&self) -> Option<T> {
        let [ox, oy, oz] = self.o.map(T::exact);
        let [dx, dy, dz] = self.d.map(T::exact);
        let b = ox.clone() * dx.clone() + oy.clone() * dy.clone() + oz.clone() * dz.clone();
        let a = dx.square() + dy.square() + dz.square();
        let c = ox.square() + oy.square() + oz.square() - T::exact(1.0);
        Some(b.square() - a * c)
    }
}

#[inline(always)]
fn plain(p: &Discriminant) -> f64 {
    let (o, d) = (Vec3::from(p.o), Vec3::from(p.d));
    let b = o.x * d.x + o.y * d.y + o.z * d.z;
    let a = d.x * d.x + d.y * d.y + d.z * d.z;
    let c = o.x * o.x + o.y * o.y + o.z * o.z - 1.0;
    b * b - a * c
}

/// Best of several runs over all `rays`, entered through the door once per run as a leaf would be.
fn time<T>(name: &str, isa: Isa, rays: &[T], f: impl Fn(&T) -> f64 + Copy) {
    let (mut best, mut sum) = (f64::INFINITY, 0.0);
    for _ in 0..40 {
        let start = Instant::now();
        sum = isa.run(
            #[inline(always)]
            || {
                let mut sum = 0.0;
                for r in black_box(rays) {
                    sum += f(r);
                }
                sum
            },
        );
        best = best.min(start.elapsed().as_secs_f64() / rays.len() as f64);
    }
    println!("{name:28} {:>9} {:9.2} ns   (sum {sum:.6})", isa.path().name(), best * 1e9);
}

fn main() {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * durer_math::U * 2.0 - 1.0
    };
    let mut triple = || [random(), random(), random()];
    let rays: Vec<Discriminant> =
        (0..1024).map(|_| Discriminant { o: triple().map(|x| x * 3.0), d: triple() }).collect();
    let edges: Vec<[[f64; 3]; 4]> = (0..1024).map(|_| [triple(), triple(), triple(), triple()]).collect();
    for isa in [Isa::detect(), Isa::REFERENCE] {
        time("discriminant, f64", isa, &rays, plain);
        time(
            "discriminant, Run<f64>",
            isa,
            &rays,
            #[inline(always)]
            |p| p.eval::<EFloat>().map_or(0.0, |x| x.v + x.e),
        );
        time(
            "discriminant, Run<Dd>",
            isa,
            &rays,
            #[inline(always)]
            |p| p.eval::<EFloat<Dd>>().map_or(0.0, |x| x.v.hi + x.e),
        );
        time(
            "discriminant, Dyadic",
            isa,
            &rays,
            #[inline(always)]
            |p| p.eval::<Dyadic>().map_or(0.0, |x| f64::from(x.exact_sign() as i8)),
        );
        time(
            "discriminant, ladder",
            isa,
            &rays,
            #[inline(always)]
            |p| ladder::sign(p).map_or(0.0, |s| f64::from(s as i8)),
        );
        time(
            "edge, filtered",
            isa,
            &edges,
            #[inline(always)]
            |e| EdgeRay::new(Point3::from(e[0]), Vec3::from(e[1])).edge(e[2].into(), e[3].into()).value,
        );
        time(
            "edge, expansions",
            isa,
            &edges,
            #[inline(always)]
            |e| EdgeRay::new(Point3::from(e[0]), Vec3::from(e[1])).exact_edge(e[2].into(), e[3].into()).value,
        );
    }
}

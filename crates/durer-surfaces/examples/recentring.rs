//! Why a ray is re-centred before anything else: the unit sphere from far away.
//!
//! ```text
//! cargo run --release -p durer-surfaces --example recentring
//! ```
//!
//! For each distance of the ray's origin, the worst error of the first crossing's `t` over 200 000
//! rays, divided by the ray's condition number `r / h` (`h` is half the chord: near a tangent `t`
//! is that much more sensitive than the ray's own coordinates), and how many hits were lost. The
//! impact parameter is log-uniform towards grazing; the reference is computed in double-double. The
//! forms:
//!
//! - `b^2 - ac`: the algebraic form with the stable pair of roots;
//! - `Kahan`: this form with the discriminant by Kahan's fused `ab - cd`, within 1.5 ulp *of the
//!   rounded a, b, c*;
//! - `Haines et al.`: the discriminant as `r^2 - |f - (f.d) d|^2`, without fused operations (*Ray
//!   Tracing Gems*, 2019, chapter 7);
//! - `re-centred`: the form of Haines et al. after `LocalRay::recentre`;
//! - `Sphere`: the surface itself, decided exactly.

use durer_math::eft::{difference_of_products, two_diff};
use durer_math::{Dd, Point3, Ray, Vec3};
use durer_surfaces::{Closest, LocalRay, Sphere, Surface};
use durer_testkit::TestRng;

const RAYS: u32 = 200_000;

/// The first root of `a t^2 + 2 b t + c`, given the discriminant `b^2 - a c`, without cancellation.
fn first_root(a: f64, b: f64, c: f64, discriminant: f64) -> Option<f64> {
    if discriminant < 0.0 {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    Some((q / a).min(c / q))
}

fn algebraic(ray: &Ray) -> Option<f64> {
    let (o, d) = (ray.origin.to_vec(), ray.direction);
    let dot = |a: Vec3, b: Vec3| a.x * b.x + a.y * b.y + a.z * b.z;
    let (a, b, c) = (dot(d, d), dot(o, d), dot(o, o) - 1.0);
    first_root(a, b, c, b * b - a * c)
}

fn kahan(ray: &Ray) -> Option<f64> {
    let (o, d) = (ray.origin.to_vec(), ray.direction);
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
    first_root(a, b, c, difference_of_products(b, b, a, c))
}

fn haines(ray: &Ray) -> Option<f64> {
    let (o, d) = (ray.origin.to_vec(), ray.direction);
    let dot = |a: Vec3, b: Vec3| a.x * b.x + a.y * b.y + a.z * b.z;
    let (a, b) = (dot(d, d), dot(o, d));
    let foot = o - d * (b / a);
    first_root(a, b, dot(o, o) - 1.0, a * (1.0 - dot(foot, foot)))
}

fn recentred(ray: &Ray) -> Option<f64> {
    let local = LocalRay::new(ray);
    let near = local.recentre(Point3::ORIGIN, 0);
    let (o, d) = (near.o, near.d);
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
    // b is almost zero here: this is the form above, with the foot already known.
    let foot = o - d * (b / a);
    let inside = a * (1.0 - foot.dot(foot));
    first_root(a, b, c, inside).map(|s| near.t(s))
}

fn production(ray: &Ray) -> Option<f64> {
    let sphere = Sphere::new(Point3::ORIGIN, 1.0).ok()?;
    let mut closest = Closest::default();
    sphere.roots(&LocalRay::new(ray), &mut closest);
    closest.root.map(|r| r.t)
}

/// The first crossing and the condition number, in double-double; `None` for a miss.
fn reference(ray: &Ray) -> Option<(Dd, f64)> {
    let (o, d) = (ray.origin.to_array().map(Dd::from), ray.direction.to_array().map(Dd::from));
    let dot = |a: &[Dd; 3], b: &[Dd; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let a = dot(&d, &d);
    let t0 = -(dot(&o, &d) / a);
    let foot = [0, 1, 2].map(|i| o[i] + t0 * d[i]);
    let inside = Dd::ONE - dot(&foot, &foot);
    (inside.hi > 0.0).then(|| (t0 - (inside / a).sqrt(), 1.0 / inside.hi.sqrt()))
}

/// Draws of rays at a unit sphere.
trait Draws {
    fn direction(&mut self) -> Vec3;
    /// A ray from `distance` away that passes the centre at `1 - 10^-k`, k uniform in `[0, 6]`.
    fn ray(&mut self, distance: f64) -> Ray;
}

impl Draws for TestRng {
    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - Vec3::new(1.0, 1.0, 1.0);
            if let (0.01..1.0, Some(v)) = (v.length_squared(), v.normalized()) {
                return v;
            }
        }
    }

    fn ray(&mut self, distance: f64) -> Ray {
        let d = self.direction();
        let across = d.orthonormal_basis().0;
        let impact = 1.0 - durer_math::elementary::pow(10.0, -6.0 * self.unit());
        Ray::new((across * impact - d * distance).to_point(), d)
    }
}

/// A form under test.
type Form = fn(&Ray) -> Option<f64>;

fn main() {
    let forms: [(&str, Form); 5] = [
        ("b^2 - ac", algebraic),
        ("Kahan", kahan),
        ("Haines et al.", haines),
        ("re-centred", recentred),
        ("Sphere", production),
    ];
    print!("| origin distance |");
    for (name, _) in forms {
        print!(" {name} |");
    }
    println!(" u t |");
    println!("|---|{}---|", "---|".repeat(forms.len()));
    for distance in [1e2, 1e4, 1e6, 1e8] {
        let mut dice = TestRng::new(distance as u64);
        let (mut worst, mut lost, mut hits) = ([0.0_f64; 5], [0_u32; 5], 0_u32);
        for _ in 0..RAYS {
            let ray = dice.ray(distance);
            let Some((t, condition)) = reference(&ray) else { continue };
            hits += 1;
            for (i, (_, form)) in forms.iter().enumerate() {
                match form(&ray) {
                    Some(found) => {
                        let (gap, rest) = two_diff(found, t.hi);
                        worst[i] = worst[i].max((gap + (rest - t.lo)).abs() / condition);
                    }
                    None => lost[i] += 1,
                }
            }
        }
        print!("| {distance:.0e} |");
        for i in 0..forms.len() {
            print!(" {:.1e}", worst[i]);
            if lost[i] > 0 {
                print!(", {:.1} % lost", 100.0 * f64::from(lost[i]) / f64::from(hits));
            }
            print!(" |");
        }
        println!(" {:.1e} |", distance * f64::EPSILON / 2.0);
    }
}

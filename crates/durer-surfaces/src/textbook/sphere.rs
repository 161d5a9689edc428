//! The sphere, twice.

use durer_math::{Point3, Ray};

/// The parameters at which a ray's line meets a sphere: the quadratic equation as school writes it.
///
/// `|o + t d - c|^2 = r^2` is `a t^2 + b t + c0 = 0` with `a = d . d`, `b = 2 d . (o - c)`,
/// `c0 = |o - c|^2 - r^2`, so
///
/// ```text
///     t = (-b ± sqrt(b^2 - 4 a c0)) / (2 a)
/// ```
///
/// **What goes wrong.** Twice. (1) With the sphere `D` radii away `b^2` and `4 a c0` are of size
/// `4 D^2`, their difference is of size 4, and each was rounded: the discriminant is lost at about
/// `D = 1e8`, and a tenth of all hits already at `D = 1e6` (run the example `recentring`). (2) If
/// `b^2 >> 4 a c0`, one of the roots is the difference of two nearly equal numbers. For (2) there
/// is an old remedy: `q = -(b + sign(b) sqrt(..)) / 2`, `t = q / a` and `t = c0 / q`. For (1) the
/// rounding already sits in `b` and `c0`; only other coefficients help. Production moves the origin
/// of `t` to the point closest to the centre first:
/// [`LocalRay::recentre`](crate::LocalRay::recentre).
pub fn sphere_algebraic(centre: Point3, radius: f64, ray: &Ray) -> Option<[f64; 2]> {
    let (f, d) = (ray.origin - centre, ray.direction);
    let (a, b, c) = (d.dot(d), 2.0 * f.dot(d), f.dot(f) - radius * radius);
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)])
}

/// The parameters at which a ray's line meets a sphere: the foot of the perpendicular, and
/// Pythagoras.
///
/// The centre is closest to the line at `t0 = d . (c - o) / d . d`, in the point `f = o + t0 d`. If
/// `|f - c| <= r`, half the chord is `h = sqrt(r^2 - |f - c|^2)`, and `t = t0 ± h / |d|`.
///
/// E. Haines, J. Günther, T. Akenine-Möller, "Precision improvements for ray/sphere intersection", *Ray
/// Tracing Gems* (2019), chapter 7, put it so: the discriminant is a difference of lengths of the
/// sphere's size.
///
/// **What goes wrong.** Much less: no number of size `D^2` is subtracted. What is left is the
/// rounding of `f`, which is `u D` if `o + t0 d - c` is computed in that order. Production
/// subtracts first, keeps what the subtraction lost, uses one fused step (two roundings of *local*
/// size), and knows the error, so that a near-tangent ray is decided exactly:
/// [`LocalRay::recentre`](crate::LocalRay::recentre), [`Sphere`](crate::Sphere).
pub fn sphere_geometric(centre: Point3, radius: f64, ray: &Ray) -> Option<[f64; 2]> {
    let d = ray.direction;
    let t0 = d.dot(centre - ray.origin) / d.dot(d);
    let foot = (ray.origin + d * t0) - centre;
    let inside = radius * radius - foot.dot(foot);
    if inside < 0.0 {
        return None;
    }
    let half = (inside / d.dot(d)).sqrt();
    Some([t0 - half, t0 + half])
}

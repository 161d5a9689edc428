//! A surface's own coordinates, its tips, and its texture coordinates at a point.

use durer_math::eft::scale2;
use durer_math::scale::exponent;
use durer_math::{Point3, Vec3, elementary};

/// The coordinates in which a shape is computed: `y` with `x = centre + 2^scale y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point to which rays are re-centred.
    pub centre: Point3,
    /// The exponent of the unit of length; the shape's size should be about one unit.
    pub scale: i32,
    /// The radius of a ball about the centre that holds the shape, in units; infinite if there is
    /// none.
    pub reach: f64,
}

/// Surface coordinates of a face at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// The derivative of the position by u, in units of the frame.
    pub dpdu: Vec3,
    /// The derivative of the position by v, in units of the frame.
    pub dpdv: Vec3,
}

/// A point at which a face's gradient vanishes, such as the tip of a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// The outward normal, or the axis of a double tip. The form must not vanish along it.
    pub normal: Vec3,
    /// Whether the face goes on to the other side, as both halves of a cone do.
    pub is_double: bool,
}

/// Two unit vectors across a unit vector, all three right-handed: T. Duff et al., "Building an
/// orthonormal basis, revisited", *Journal of Computer Graphics Techniques* 6(1), 2017.
pub(crate) fn tangents(n: Vec3) -> (Vec3, Vec3) {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// The projection of `v` along `along` onto the plane across `n`: the tangent of a graph over
/// directions.
pub(crate) fn sheared(v: Vec3, along: Vec3, n: Vec3) -> Vec3 {
    let flat = |w: Vec3| w - n * n.dot(w);
    let w = flat(v - along * (n.dot(v) / n.dot(along)));
    let size = v.max_abs();
    // Edge-on there is no graph; then the part of v in the plane, and if that vanishes, any
    // tangent.
    if w.max_abs() <= 1e6 * size && w.max_abs() >= 1e-6 * size {
        return flat(w);
    }
    let w = flat(v);
    if w.max_abs() >= 1e-6 * size { flat(w) } else { tangents(n).0 * size.min(f64::MAX) }
}

/// Longitude and latitude: `u = φ / 2π` from the x axis, `v` from 0 at the pole -z to 1 at +z; so
/// `dpdu x dpdv` points outward.
///
/// At the poles the longitude is taken as 0.
pub(crate) fn sphere_chart(y: Vec3) -> Chart {
    const TURN: f64 = 2.0 * core::f64::consts::PI;
    const HALF: f64 = core::f64::consts::PI;
    let rho = elementary::hypot(y.x, y.y);
    let (cos, sin) = if rho > 0.0 { (y.x / rho, y.y / rho) } else { (1.0, 0.0) };
    let phi = if rho > 0.0 { elementary::atan2(y.y, y.x) } else { 0.0 };
    let u = phi / TURN;
    let latitude = elementary::atan2(y.z, rho);
    Chart {
        uv: [if u < 0.0 { u + 1.0 } else { u }, latitude / HALF + 0.5],
        // At a pole the circle of latitude has no length; a unit step east keeps the frame defined.
        dpdu: if rho > 0.0 { Vec3::new(-y.y, y.x, 0.0) * TURN } else { Vec3::Y },
        dpdv: Vec3::new(-y.z * cos, -y.z * sin, rho) * HALF,
    }
}

/// The length of a vector, at most 4 roundings below the exact one; without intermediate overflow
/// or underflow.
pub(crate) fn length(v: [f64; 3]) -> f64 {
    let v = Vec3::from(v);
    let k = exponent(v.max_abs()).max(-1000);
    durer_math::scale::ldexp(v.map(|x| scale2(x, -k)).length(), k)
}

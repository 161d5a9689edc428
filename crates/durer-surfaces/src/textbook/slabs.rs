//! The box.

use durer_math::{Point3, Ray};

/// The parameters at which a ray enters and leaves a box: the three slabs.
///
/// Between the planes `x = lo` and `x = hi` the ray is for `t` in `[(lo - o) / d, (hi - o) / d]`,
/// ordered; likewise for y and z. It is in the box while it is in all three: from the greatest
/// entry to the least exit, if that is not empty.
///
/// T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986.
///
/// **What goes wrong.** A ray across an axis has `d = 0`: the quotients are infinite, with the
/// right signs (IEEE arithmetic does that on purpose; A. Williams et al., "An efficient and robust
/// ray-box intersection algorithm", JGT 2005), except for a ray *in* a face, where `0 / 0` is NaN.
/// Rust's `min` and `max` then take the other quotient, which is infinite, for entry and exit both:
/// the ray misses the box it touches. A ray that passes exactly through an edge may be counted or
/// not, as the rounded quotients fall, and the face it is said to enter by is a matter of chance.
/// Production compares the quotients as brackets and multiplies out, exactly, where those overlap:
/// [`AxisBox`](crate::AxisBox). As a filter in a tree it must never lose a hit: T. Ize, "Robust BVH
/// ray traversal", JCGT 2(2), 2013, widens the exits by two ulp.
pub fn box_by_slabs(lo: Point3, hi: Point3, ray: &Ray) -> Option<[f64; 2]> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let (t0, t1) = ((lo[axis] - o) / d, (hi[axis] - o) / d);
        enter = enter.max(t0.min(t1));
        leave = leave.min(t0.max(t1));
    }
    (enter <= leave).then_some([enter, leave])
}

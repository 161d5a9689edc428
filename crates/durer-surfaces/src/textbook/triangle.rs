//! The triangle, twice.

use durer_math::{Point3, Ray, Vec3};

/// The parameter at which a ray meets a triangle: first its plane, then the inside test in two
/// dimensions.
///
/// 1. The normal is `n = (v1 - v0) x (v2 - v0)`, and the ray meets the plane at
///    `t = n . (v0 - o) / n . d`; if `n . d = 0` it runs beside it.
/// 2. With `p = o + t d`, drop the coordinate in which `|n|` is largest (the projection along it
///    loses least), and
/// 3. compare the signed areas of the three triangles that `p` makes with the edges: inside if none
///    is negative (all taken with the sign of the whole). Their ratios to the whole are the
///    barycentric coordinates.
///
/// D. Badouel, "An efficient ray-polygon intersection", *Graphics Gems* (1990); J. M. Snyder, A. H.
/// Barr, "Ray tracing complex models containing surface tessellations", SIGGRAPH 1987.
///
/// **What goes wrong.** `p` is rounded before it is compared with the edges. Two triangles that
/// share an edge have different planes, hence two different points `p`, and both may fall outside:
/// the ray leaks through a closed mesh. With the origin far away `o + t d` carries an error of
/// `u |o|`, which may be larger than the triangle. Production asks on which side the *ray* passes
/// each *edge*, a sign that both neighbours share, and decides it exactly:
/// [`Triangle`](crate::Triangle), [`Mesh`](crate::Mesh).
///
/// ```
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::textbook::triangle_by_plane;
/// let v = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Point3::from);
/// let down = Ray::new(Point3::new(1.0, 1.0, 3.0), Vec3::new(0.0, 0.0, -1.0));
/// assert_eq!(triangle_by_plane(&v, &down), Some(3.0));
/// ```
pub fn triangle_by_plane(v: &[Point3; 3], ray: &Ray) -> Option<f64> {
    let n = (v[1] - v[0]).cross(v[2] - v[0]);
    let slope = n.dot(ray.direction);
    if slope == 0.0 {
        return None;
    }
    let t = n.dot(v[0] - ray.origin) / slope;
    let p = ray.origin + ray.direction * t;

    // The two axes that are left, in cyclic order so that areas keep the normal's sign.
    let m = n.abs();
    let dropped = if m.x >= m.y && m.x >= m.z {
        0
    } else if m.y >= m.z {
        1
    } else {
        2
    };
    let (i, j) = ((dropped + 1) % 3, (dropped + 2) % 3);
    let area =
        |a: Point3, b: Point3, c: Point3| (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);

    let sign = n[dropped].signum();
    let inside = [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])].iter().all(|&(a, b)| sign * area(a, b, p) >= 0.0);
    (inside && ray.t_min <= t && t <= ray.t_max).then_some(t)
}

/// The parameter at which a ray meets a triangle: the signed volumes that the ray spans with the
/// edges, no division until a hit is certain.
///
/// With `a = v0 - o`, `b = v1 - o`, `c = v2 - o` the volumes (six times those of tetrahedra)
///
/// ```text
///     U = d . (c x b),   V = d . (a x c),   W = d . (b x a)
/// ```
///
/// tell on which side of each edge the ray passes. It meets the triangle if they have one sign, at
/// the point `(U v0 + V v1 + W v2) / (U + V + W)`, and `t` is the same mean of the vertices'
/// depths.
///
/// R. J. Segura, F. R. Feito, "Algorithms to test ray-triangle intersection. Comparative study",
/// WSCG 2001; A. Kensler, P. Shirley, "Optimizing ray-triangle intersection via automated search",
/// RT 2006.
///
/// **What goes wrong.** The neighbour computes `d . (b x c)` for the shared edge: exactly `-U` also
/// in f64, as long as both subtract the same origin and no compiler fuses anything. So neighbours
/// agree even on a wrong sign, and nothing leaks *between* edges; but a ray through the edge itself
/// (`U = 0`) counts for both, and around a vertex several wrong signs together can count any number
/// of times. Production takes the same three numbers, knows when to doubt their signs, finds them
/// exactly then, and breaks ties by moving the ray symbolically: [`Mesh`](crate::Mesh),
/// `durer_math::predicates`.
pub fn triangle_by_edges(v: &[Point3; 3], ray: &Ray) -> Option<f64> {
    let d = ray.direction;
    let [a, b, c] = v.map(|v| v - ray.origin);
    let volume = |p: Vec3, q: Vec3| d.dot(q.cross(p));
    let (u, v, w) = (volume(b, c), volume(c, a), volume(a, b));
    let one_sign = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    let sum = u + v + w;
    if !one_sign || sum == 0.0 {
        return None;
    }
    let p = a * (u / sum) + b * (v / sum) + c * (w / sum);
    let t = p.dot(d) / d.dot(d);
    (ray.t_min <= t && t <= ray.t_max).then_some(t)
}

//! Division of polygons into triangles.
//!
//! A convex polygon becomes a fan about its first corner, as in other readers. From other polygons
//! ears are cut off (G. H. Meisters, "Polygons have ears", American Mathematical Monthly 1975). An
//! ear is a corner whose triangle has the orientation of the polygon and contains no other corner.
//! All decisions are made in the projection along the axis that is closest to the polygon's normal
//! (the sum of M. E. Newell's products). Which triangles fill the polygon is a matter of choice. So
//! rounding in these decisions changes no vertex and leaves no gap: the outline of the triangles is
//! always that of the polygon.

use durer_math::Point3;

/// Polygons with more corners than this are divided only if they are convex, because ear cutting
/// takes quadratic time.
pub(crate) const MOST: usize = 10_000;

type P = [f64; 2];

/// Twice the signed area of a triangle.
fn turn(a: P, b: P, c: P) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The corners, projected to a plane so that they run counterclockwise.
fn flattened(corners: &[Point3]) -> Vec<P> {
    let first = corners.first().copied().unwrap_or(Point3::ORIGIN);
    let mut normal = [0.0; 3];
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let n = (a - first).cross(b - first);
        for (sum, x) in normal.iter_mut().zip(n.to_array()) {
            *sum += x;
        }
    }
    let size = |i: usize| normal[i].abs();
    let main = (1..3).fold(0, |main, i| if size(i) > size(main) { i } else { main });
    let (u, v) = ((main + 1) % 3, (main + 2) % 3);
    let (u, v) = if normal[main] < 0.0 { (v, u) } else { (u, v) };
    corners.iter().map(|p| (*p - first).to_array()).map(|p| [p[u], p[v]]).collect()
}

/// Divides a polygon of at least three corners into triangles, as indices of corners. `None` if it
/// has too many corners.
pub(crate) fn triangles(corners: &[Point3]) -> Option<Vec<[usize; 3]>> {
    let n = corners.len();
    let fan = |left: &[usize]| left.windows(2).skip(1).map(|w| [left[0], w[0], w[1]]).collect::<Vec<_>>();
    let mut left: Vec<usize> = (0..n).collect();
    if n <= 3 {
        return Some(fan(&left));
    }
    let flat = flattened(corners);
    let at = |i: usize| flat[i % n];
    if (0..n).all(|i| turn(at(i), at(i + 1), at(i + 2)) >= 0.0) && winds_once(&flat) {
        return Some(fan(&left));
    }
    if n > MOST {
        return None;
    }
    let mut cut = Vec::with_capacity(n - 2);
    let mut i = 0;
    let mut refused = 0;
    while left.len() > 3 && refused < left.len() {
        let m = left.len();
        let [a, b, c] = [left[(i + m - 1) % m], left[i % m], left[(i + 1) % m]];
        if is_ear(&flat, &left, [a, b, c]) {
            cut.push([a, b, c]);
            left.remove(i % m);
            refused = 0;
            // The corner before has changed, so it is tested again.
            i = (i % m + m - 1) % (m - 1);
        } else {
            refused += 1;
            i = (i + 1) % m;
        }
    }
    // The rest of a self-intersecting polygon has no ears.
    cut.extend(fan(&left));
    Some(cut)
}

/// Whether the sides of a polygon that always turns left make exactly one turn: then the first
/// coordinate of the side changes its sign twice.
fn winds_once(flat: &[P]) -> bool {
    let n = flat.len();
    let steps = (0..n).map(|i| flat[(i + 1) % n][0] - flat[i][0]).filter(|x| *x != 0.0);
    let signs: Vec<bool> = steps.map(|x| x > 0.0).collect();
    let changes = (0..signs.len()).filter(|&i| signs[i] != signs[(i + 1) % signs.len()]).count();
    changes <= 2
}

fn is_ear(flat: &[P], left: &[usize], [a, b, c]: [usize; 3]) -> bool {
    let [p, q, r] = [flat[a], flat[b], flat[c]];
    let area = turn(p, q, r);
    let held = |x: P| {
        turn(p, q, x) >= 0.0 && turn(q, r, x) >= 0.0 && turn(r, p, x) >= 0.0 && x != p && x != q && x != r
    };
    area > 0.0 && !left.iter().any(|&i| i != a && i != b && i != c && held(flat[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(flat: &[P]) -> Vec<Point3> {
        flat.iter().map(|p| Point3::new(p[0], 2.0, -p[1])).collect()
    }

    fn area(flat: &[P]) -> f64 {
        (2..flat.len()).map(|i| turn(flat[0], flat[i - 1], flat[i])).sum()
    }

    /// The triangles have the orientation of the polygon, and their areas add up to its own, so
    /// they cover it once. Coordinates are small integers, so areas are exact.
    fn check(flat: &[P]) {
        let cut = triangles(&points(flat)).unwrap_or_default();
        assert_eq!(cut.len(), flat.len() - 2);
        let areas: Vec<f64> = cut.iter().map(|t| turn(flat[t[0]], flat[t[1]], flat[t[2]])).collect();
        let whole = area(flat);
        assert!(areas.iter().all(|a| a * whole > 0.0), "{cut:?} {areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), whole);
    }

    #[test]
    fn triangles_cover_the_polygon_once() {
        let arrow = [[0.0, 0.0], [4.0, -3.0], [1.0, 0.0], [4.0, 3.0]];
        let comb = [
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 5.0],
            [6.0, 1.0],
            [5.0, 5.0],
            [4.0, 1.0],
            [3.0, 5.0],
            [2.0, 1.0],
            [1.0, 5.0],
        ];
        let spiral = [
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 9.0],
            [1.0, 9.0],
            [1.0, 3.0],
            [6.0, 3.0],
            [6.0, 6.0],
            [4.0, 6.0],
            [4.0, 5.0],
            [5.0, 5.0],
            [5.0, 4.0],
            [2.0, 4.0],
            [2.0, 8.0],
            [8.0, 8.0],
            [8.0, 1.0],
            [0.0, 1.0],
        ];
        for polygon in [&arrow[..], &comb, &spiral] {
            for start in 0..polygon.len() {
                let mut turned = polygon.to_vec();
                turned.rotate_left(start);
                check(&turned);
                turned.reverse();
                check(&turned);
            }
        }
    }

    #[test]
    fn convex_polygons_become_fans() {
        let cut = triangles(&points(&[[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [2.0, 2.0], [0.0, 2.0]]));
        assert_eq!(cut, Some(vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]));
    }

    /// A star drawn in one stroke always turns left, but twice, so it is not convex. It is divided
    /// into some triangles, as is a polygon without area.
    #[test]
    fn what_crosses_itself_becomes_something() {
        let star = [[0.0, 3.0], [-2.0, -3.0], [3.0, 1.0], [-3.0, 1.0], [2.0, -3.0]];
        assert_eq!(triangles(&points(&star)).map(|t| t.len()), Some(3));
        let point = [[1.0, 1.0]; 6];
        assert_eq!(triangles(&points(&point)).map(|t| t.len()), Some(4));
        let nan = [[f64::NAN; 2]; 5];
        assert_eq!(triangles(&points(&nan)).map(|t| t.len()), Some(3));
    }

    #[test]
    fn too_many_corners_are_refused_unless_convex() {
        let circle = |n: usize, dent: f64| {
            let corner = |i: usize| {
                // An arc of a parabola, closed by its chord.
                let x = i as f64 - n as f64 / 2.0;
                Point3::new(x, if i == n / 2 { dent } else { x * x }, 0.0)
            };
            (0..n).map(corner).collect::<Vec<_>>()
        };
        assert!(triangles(&circle(MOST + 1, 0.0)).is_some());
        assert!(triangles(&circle(MOST + 1, 50.0)).is_none());
    }
}

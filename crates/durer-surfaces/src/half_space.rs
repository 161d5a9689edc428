//! Half-spaces with uncertain planes, and boxes around intersections of several.

use durer_math::{Aabb, Affine, Interval, Point3, Vec3};

/// A half-space `{ p : n . p <= h }` for some `n` in `normal` and `h` in `distance`.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace {
    normal: [Interval; 3],
    distance: Interval,
}

/// A bound along one direction `d`: `d . p <= sum + residual * max(|x|, |y|, |z|)` for every point
/// `p = (x, y, z)` of the half-spaces.
#[derive(Clone, Copy, Debug)]
struct Support {
    sum: f64,
    residual: f64,
}

impl HalfSpace {
    /// The most half-spaces that [`HalfSpace::common_bounds`] uses: its time grows with the cube of
    /// their number.
    const MOST: usize = 32;

    /// The half-space `n . p <= h` of a normal and a distance that are known within intervals.
    pub(crate) fn new(normal: [Interval; 3], distance: Interval) -> Self {
        Self { normal, distance }
    }

    /// A box around the half-space, which is unbounded in all directions but one at most: it is
    /// bounded where the normal is exactly along an axis.
    pub fn bounds(&self) -> Aabb {
        let mut all = Aabb::UNBOUNDED;
        for axis in 0..3 {
            let is_zero = |k: usize| self.normal[k] == Interval::from(0.0);
            if !(is_zero((axis + 1) % 3) && is_zero((axis + 2) % 3)) {
                continue;
            }
            let n = self.normal[axis];
            let end = self.distance / n;
            if n.lo > 0.0 && !end.hi.is_nan() {
                all.max[axis] = end.hi;
            } else if n.hi < 0.0 && !end.lo.is_nan() {
                all.min[axis] = end.lo;
            }
        }
        all
    }

    /// The half-space on the other side of the same plane.
    #[must_use]
    pub fn complement(self) -> Self {
        Self { normal: self.normal.map(|x| -x), distance: -self.distance }
    }

    /// The half-space placed by `map`: with `p' = c + L p` and the adjugate `A = det(L) L^-1`,
    /// `n . p <= h` is `(A^T n) . p' <= det(L) h + (A^T n) . c` where `det(L) > 0`.
    #[must_use]
    pub fn through(&self, map: &Affine) -> Self {
        let linear = map.linear();
        let (adjugate, determinant) = adjugate(&linear.map(|row| row.map(Interval::from)));
        let turned = |x: Interval| if map.determinant_is_negative() { -x } else { x };
        let normal: [Interval; 3] = core::array::from_fn(|j| {
            turned(dot([adjugate[0][j], adjugate[1][j], adjugate[2][j]], self.normal))
        });
        let centre = map.centre();
        let shift = dot(normal, [centre.x, centre.y, centre.z].map(Interval::from));
        Self { normal, distance: turned(determinant) * self.distance + shift }
    }

    /// A box that holds the intersection of all half-spaces; unbounded if no bound is found.
    ///
    /// By the duality of linear programming the greatest `d . p` is the least `sum y_i h_i` over
    /// all `y >= 0` with `sum y_i n_i = d`, where at most three `y_i` are not zero (A. Schrijver,
    /// "Theory of Linear and Integer Programming", Wiley 1986, 7.4 and 7.5). The `y_i` are computed
    /// in f64, and any `y >= 0` gives a bound: with the residual `r = d - sum y_i n_i`,
    ///
    /// ```text
    /// d . p = sum y_i (n_i . p) + r . p <= sum y_i h_i + |r|_1 |p|_max
    /// ```
    ///
    /// The greatest of these over the six axis directions bounds `|p|_max` itself: with `H` the
    /// greatest sum and `R < 1` the greatest `|r|_1`, `|p|_max <= H / (1 - R)`.
    pub fn common_bounds(all: &[Self]) -> Aabb {
        let count = all.len().min(Self::MOST);
        let chosen: Vec<&Self> = (0..count).map(|i| &all[i * all.len() / count]).collect();
        let mut supports = [None; 6];
        for i in 0..count {
            for j in i + 1..count {
                for k in j + 1..count {
                    improve(&mut supports, [chosen[i], chosen[j], chosen[k]]);
                }
            }
        }
        let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)] = supports else {
            return Aabb::UNBOUNDED;
        };
        let supports = [a, b, c, d, e, f];
        let greatest = supports.iter().fold(f64::NEG_INFINITY, |most, s| s.sum.max(most));
        let residual = supports.iter().fold(0.0, |most, s| s.residual.max(most));
        if greatest < 0.0 {
            // No point has a coordinate of greatest magnitude.
            return Aabb::EMPTY;
        }
        let rest = Interval::from(1.0) - Interval::from(residual);
        let magnitude = Interval::from(greatest) / rest;
        if !(rest.lo > 0.0 && magnitude.hi.is_finite()) {
            return Aabb::UNBOUNDED;
        }
        let most = supports
            .map(|s| (Interval::from(s.sum) + Interval::from(s.residual) * Interval::from(magnitude.hi)).hi);
        let bounds =
            Aabb::new(Point3::new(-most[1], -most[3], -most[5]), Point3::new(most[0], most[2], most[4]));
        if bounds.is_empty() { Aabb::EMPTY } else { bounds }
    }
}

/// Takes the bounds that three half-spaces give along the axes, where they are better: `supports`
/// are those along `x`, `-x`, `y`, `-y`, `z`, `-z`.
fn improve(supports: &mut [Option<Support>; 6], three: [&HalfSpace; 3]) {
    /// A residual beyond this widens the box by more than a millionth of its distance from the
    /// origin: such `y` are not used.
    const MOST_RESIDUAL: f64 = durer_math::scale::pow2(-20);
    let normals = three.map(|s| Vec3::new(s.normal[0].mid(), s.normal[1].mid(), s.normal[2].mid()));
    let distances = three.map(|s| s.distance.mid());
    // The rows of the inverse of the matrix with the normals as columns, times its determinant.
    let [a, b, c] = normals;
    let rows = [b.cross(c), c.cross(a), a.cross(b)];
    let determinant = a.dot(rows[0]);
    for (direction, support) in supports.iter_mut().enumerate() {
        let (axis, sign) = (direction / 2, if direction % 2 == 0 { 1.0 } else { -1.0 });
        let weights = rows.map(|row| sign * row[axis] / determinant);
        let most = weights.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        // Weights that are negative by no more than rounding are zero; the residual accounts for it.
        if !(most.is_finite() && weights.iter().all(|&y| y >= -most * MOST_RESIDUAL)) {
            continue;
        }
        let weights = weights.map(|y| y.max(0.0));
        let estimate: f64 = weights.iter().zip(distances).map(|(y, h)| y * h).sum();
        if support.is_some_and(|s| s.sum <= estimate) {
            continue;
        }
        let weights = weights.map(Interval::from);
        let sum = dot(weights, three.map(|s| s.distance)).hi;
        let residual = (0..3).fold(Interval::from(0.0), |sum, i| {
            let wanted = Interval::from(if i == axis { sign } else { 0.0 });
            sum + (wanted - dot(weights, three.map(|s| s.normal[i]))).abs()
        });
        if residual.hi <= MOST_RESIDUAL && sum.is_finite() {
            *support = Some(Support { sum, residual: residual.hi });
        }
    }
}

fn dot(a: [Interval; 3], b: [Interval; 3]) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The adjugate of a matrix, and its determinant.
fn adjugate(m: &[[Interval; 3]; 3]) -> ([[Interval; 3]; 3], Interval) {
    let cofactor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let adjugate = core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i)));
    (adjugate, dot(m[0], core::array::from_fn(|j| cofactor(0, j))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accelerate, DynSurface, Placed, Plane};

    fn plane(x: f64, y: f64, z: f64, h: f64) -> HalfSpace {
        Plane::new(Vec3::new(x, y, z), h).unwrap().half_space().unwrap()
    }

    /// How far a box reaches beyond another one.
    fn excess(outer: &Aabb, inner: &Aabb) -> f64 {
        (inner.min - outer.min).max_abs().max((outer.max - inner.max).max_abs())
    }

    #[test]
    fn a_cube_of_planes_has_the_box_of_the_cube() {
        let all = [
            plane(1.0, 0.0, 0.0, 1.0),
            plane(-2.0, 0.0, 0.0, 3.0),
            plane(0.0, 1.0, 0.0, 0.5),
            plane(0.0, -1.0, 0.0, 1.0),
            plane(0.0, 0.0, 4.0, -1.0),
            plane(0.0, 0.0, -1.0, 2.0),
        ];
        let cube = Aabb::new(Point3::new(-3.0, -1.0, -2.0), Point3::new(1.0, 0.5, -1.0));
        let found = HalfSpace::common_bounds(&all);
        assert!(found.contains(cube.min) && found.contains(cube.max));
        assert!(excess(&found, &cube) < 1e-14, "{found:?}");
        assert!(!HalfSpace::common_bounds(&all[..5]).is_bounded(), "the cube is open");
        assert!(!HalfSpace::common_bounds(&[]).is_bounded());
        let none = [all[0], all[1], all[2], all[3], all[4], all[5], plane(1.0, 0.0, 0.0, -4.0)];
        assert!(HalfSpace::common_bounds(&none).is_empty());
    }

    #[test]
    fn a_tetrahedron_far_away_has_the_box_of_its_corners() {
        // x, y, z >= 1e6 and x + y + z <= 3e6 + 1.
        let far = 1e6;
        let mut all =
            vec![plane(-1.0, 0.0, 0.0, -far), plane(0.0, -1.0, 0.0, -far), plane(0.0, 0.0, -1.0, -far)];
        let length = 3.0_f64.sqrt();
        all.push(plane(1.0, 1.0, 1.0, (3.0 * far + 1.0) / length));
        let found = HalfSpace::common_bounds(&all);
        let corners = Aabb::new(Point3::new(far, far, far), Point3::new(far + 1.0, far + 1.0, far + 1.0));
        assert!(found.contains(corners.min), "{found:?}");
        assert!(excess(&found, &corners) < 1e-8, "{found:?}");
        // The complement of the last plane leaves an unbounded corner.
        all[3] = all[3].complement();
        assert!(!HalfSpace::common_bounds(&all).is_bounded());
    }

    #[test]
    fn random_polyhedra_lie_in_their_boxes() {
        let mut rng = durer_testkit::TestRng::new(7);
        let mut dice = move || rng.signed();
        let (mut bounded, mut within) = (0, 0);
        for _ in 0..300 {
            let planes: Vec<_> = (0..12)
                .map(|_| Plane::new(Vec3::new(dice(), dice(), dice()), 0.5 + 0.4 * dice()).unwrap())
                .collect();
            let map = Affine::new(
                [[dice(), dice(), dice()], [dice(), dice(), dice()], [dice(), dice(), dice()]],
                Point3::new(9.0 * dice(), dice(), 1e3 * dice()),
            )
            .unwrap();
            let placed: Vec<_> = planes.iter().map(|p| Placed::new(DynSurface::new(*p), map)).collect();
            let all: Vec<_> = placed.iter().map(|p| p.half_space().unwrap()).collect();
            let found = HalfSpace::common_bounds(&all);
            bounded += usize::from(found.is_bounded());
            for _ in 0..100 {
                let p = Point3::new(dice(), dice(), dice());
                // Well inside, so that the image's rounding does not matter.
                let is_inside =
                    |q: &Plane| q.normal().dot(p.to_vec()) < q.distance() * q.normal().length() - 1e-9;
                if planes.iter().all(is_inside) {
                    within += 1;
                    assert!(found.contains(map.point(p)), "{found:?}");
                }
            }
        }
        assert!(bounded > 250 && within > 2_000, "{bounded} {within}");
    }

    #[test]
    fn a_plane_across_an_axis_bounds_one_side() {
        let above = plane(0.0, -2.0, 0.0, 3.0).bounds();
        assert_eq!(
            (above.min.x, above.max.y, above.max.z),
            (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY)
        );
        assert!(above.min.y <= -3.0 && above.min.y > -3.0 - 1e-14, "{above:?}");
        let below = plane(0.0, -2.0, 0.0, 3.0).complement().bounds();
        assert!(below.max.y >= -3.0 && below.max.y < -3.0 + 1e-14 && below.min.y == f64::NEG_INFINITY);
        assert_eq!(plane(1e-300, 1.0, 0.0, 1.0).bounds(), Aabb::UNBOUNDED);
    }
}

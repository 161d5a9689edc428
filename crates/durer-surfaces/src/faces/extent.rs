//! The extent of a quadric solid between two planes across an axis.
//!
//! Let `y` be the coordinate across the planes and `w` the other two. There the solid is
//!
//! ```text
//!   w·M w + 2 p(y)·w + r(y) <= 0,   p(y) = b_w + y q_wy,   r(y) = c + 2 b_y y + q_yy y²
//! ```
//!
//! If `M` is positive definite a section is an ellipse around `-M⁻¹ p`, or empty:
//!
//! ```text
//!   (w + M⁻¹ p)·M (w + M⁻¹ p) <= ρ(y) = p·M⁻¹ p - r,   |w_i + (M⁻¹ p)_i| <= √(ρ (M⁻¹)_ii)
//!
//!   ρ(y) = α y² + β y + γ
//!
//!   α = q_wy·M⁻¹ q_wy - q_yy,   β = 2 (b_w·M⁻¹ q_wy - b_y),   γ = b_w·M⁻¹ b_w - c
//! ```
//!
//! If `α` is not negative, `ρ` is convex and its maximum is at an end. A paraboloid along the axis,
//! with `α = 0`, ends by itself where `ρ` vanishes. Everything is computed in intervals: the
//! coefficients include the errors of the maps applied to them, and `y` is divided into equal
//! pieces.

use super::form::Form;
use durer_math::{Aabb, Dd, EFloat, Interval, Point3};

/// The number of pieces of `y`. More pieces make boxes tighter.
const PIECES: u32 = 8;

/// A quadric solid `f <= 0`, for bounds of its extent between planes.
#[derive(Clone, Copy, Debug)]
pub struct QuadricExtent {
    /// The origin of the coordinates.
    centre: Point3,
    /// The coefficients of `x·Qx + 2 b·x + c`: the rows of `Q`, `b` and `c`.
    q: [[Interval; 3]; 3],
    b: [Interval; 3],
    c: Interval,
}

impl QuadricExtent {
    /// The solid where this form about `centre` is not positive.
    pub(crate) fn new(centre: Point3, form: &Form<EFloat<Dd>>) -> Self {
        let known = |x: &EFloat<Dd>| Interval { lo: x.lo(), hi: x.hi() };
        let [xx, yy, zz, xy, xz, yz] = form.q.each_ref().map(known);
        let q = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        Self { centre, q, b: form.b.each_ref().map(known), c: known(&form.c) }
    }

    /// The solids on both sides of the surface with the coefficients of `x²`, `y²`, `z²`, `xy`,
    /// `xz`, `yz`, `x`, `y`, `z` and 1.
    pub(crate) fn of_both_sides(coefficients: &[f64; 10]) -> [Self; 2] {
        [1.0, -1.0].map(|sign| {
            let [xx, yy, zz, xy, xz, yz, x, y, z, c] = coefficients.map(|k| Interval::from(sign * k));
            let half = Interval::from(0.5);
            let (xy, xz, yz) = (xy * half, xz * half, yz * half);
            let q = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            Self { centre: Point3::ORIGIN, q, b: [x * half, y * half, z * half], c }
        })
    }

    /// A box that holds the part of the solid in `region`.
    pub fn bounds_within(&self, region: &Aabb) -> Aabb {
        let mut found = *region;
        for axis in 0..3 {
            if found.is_empty() {
                return Aabb::EMPTY;
            }
            found = self.cut(axis, &found);
        }
        if found.is_empty() { Aabb::EMPTY } else { found }
    }

    /// The part of `region` that the sections across `axis` reach.
    fn cut(&self, axis: usize, region: &Aabb) -> Aabb {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (ii, jj, ij) = (self.q[i][i], self.q[j][j], self.q[i][j]);
        let det = ii * jj - ij.square();
        if !(ii.lo > 0.0 && det.lo > 0.0) {
            return *region;
        }
        let (over_i, over_j, over_ij) = (jj / det, ii / det, -ij / det);
        let solve = |[a, b]: [Interval; 2]| [over_i * a + over_ij * b, over_ij * a + over_j * b];
        let dot = |[a, b]: [Interval; 2], [c, d]: [Interval; 2]| a * c + b * d;
        let (fixed, slope) = ([self.b[i], self.b[j]], [self.q[i][axis], self.q[j][axis]]);
        // The centre of a section is at -(m + n y).
        let (m, n) = (solve(fixed), solve(slope));
        let alpha = dot(slope, n) - self.q[axis][axis];
        let beta = (dot(fixed, n) - self.b[axis]) * Interval::from(2.0);
        let gamma = dot(fixed, m) - self.c;
        let rho = |y: Interval| (alpha * y + beta) * y + gamma;

        let centre = Interval::from(self.centre[axis]);
        let (mut lo, mut hi) = (region.min[axis], region.max[axis]);
        if alpha == Interval::from(0.0) {
            let end = centre - gamma / beta;
            if beta.lo > 0.0 {
                lo = lo.max(end.lo);
            } else if beta.hi < 0.0 {
                hi = hi.min(end.hi);
            }
        }
        if lo > hi {
            return Aabb::EMPTY;
        }
        if !(lo.is_finite() && hi.is_finite()) {
            return *region;
        }
        let step = (hi - lo) / f64::from(PIECES);
        let mut all = Aabb::EMPTY;
        for piece in 0..PIECES {
            let from = if piece == 0 { lo } else { lo + step * f64::from(piece) };
            let to = if piece + 1 == PIECES { hi } else { lo + step * f64::from(piece + 1) };
            let y = Interval { lo: from, hi: to.max(from) } - centre;
            let most = if alpha.lo >= 0.0 {
                let at = |y: f64| rho(Interval::from(y) - centre).hi;
                at(from).max(at(to))
            } else {
                rho(y).hi
            };
            if most < 0.0 {
                continue;
            }
            let reach = |over: Interval| {
                let most = (Interval { lo: 0.0, hi: most } * over).sqrt();
                Interval { lo: -most.hi, hi: most.hi }
            };
            let at_i = reach(over_i) - (m[0] + n[0] * y) + Interval::from(self.centre[i]);
            let at_j = reach(over_j) - (m[1] + n[1] * y) + Interval::from(self.centre[j]);
            let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
            (min[axis], max[axis]) = (from, to);
            (min[i], max[i]) = (at_i.lo, at_i.hi);
            (min[j], max[j]) = (at_j.lo, at_j.hi);
            // An overflow gives no bound.
            if min.iter().chain(&max).any(|x| x.is_nan()) {
                return *region;
            }
            all = all.union(Aabb::new(min.into(), max.into()));
        }
        region.intersection(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accelerate, LocalPoint, PartId, Placed, Quadric, Side, Surface};
    use durer_math::Affine;
    use durer_testkit::TestRng;

    /// A point of the solid in the region is in the box, and boxes of solids with elliptic sections
    /// are bounded.
    #[test]
    fn boxes_hold_the_solid_in_a_slab() {
        let mut dice = TestRng::new(5);
        let (mut bounded, mut held) = (0, 0);
        for _ in 0..400 {
            let mut number = || dice.integer(-4, 4) * 0.5;
            let mut coefficients = [0.0; 10].map(|_: f64| number());
            for mixed in &mut coefficients[3..6] {
                *mixed *= 0.25;
            }
            let Ok(solid) = Quadric::new(coefficients) else { continue };
            let map = if dice.once_in(2) {
                Affine::new([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]], dice.point(4.0)).unwrap()
            } else {
                dice.map()
            };
            let placed = Placed::new(solid, map);
            let Some(extent) = placed.packet_filter(PartId(0)).quadric_extent() else { continue };
            let axis = dice.index(3);
            let (mut min, mut max) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
            (min[axis], max[axis]) = (-3.0, dice.between(-2.0, 3.0));
            let region = Aabb::new(min.into(), max.into());
            let found = extent.bounds_within(&region);
            bounded += usize::from(found.is_bounded());
            for _ in 0..200 {
                let mut point = dice.point(10.0);
                point[axis] = dice.between(min[axis], max[axis]);
                if placed.side(&LocalPoint::new(point)) == Side::In {
                    held += 1;
                    assert!(found.contains(point), "{point:?} is not in {found:?}");
                }
            }
        }
        assert!(bounded > 50 && held > 5000, "{bounded} {held}");
    }

    /// Across an axis of the quadric a box ends at the largest section, whatever the sign of the
    /// coefficients; that of a paraboloid ends at its vertex, too.
    #[test]
    fn boxes_across_an_axis_are_tight() {
        let inf = f64::INFINITY;
        let paraboloid = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0, -1.0, 1.0];
        let hyperboloid = [1.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
        let cases = [
            // (x - 1)² + y² = z
            (
                paraboloid,
                [-inf, 2.0],
                [
                    [1.0 - 2.0_f64.sqrt(), 1.0 + 2.0_f64.sqrt()],
                    [-(2.0_f64.sqrt()), 2.0_f64.sqrt()],
                    [0.0, 2.0],
                ],
            ),
            // x² + 4 y² = 1 + z²
            (
                hyperboloid,
                [-1.0, 3.0],
                [[-(10.0_f64.sqrt()), 10.0_f64.sqrt()], [-(2.5_f64.sqrt()), 2.5_f64.sqrt()], [-1.0, 3.0]],
            ),
        ];
        for (coefficients, slab, wanted) in cases {
            for k in [coefficients, coefficients.map(|x| -x)] {
                let region = Aabb::new([-inf, -inf, slab[0]].into(), [inf, inf, slab[1]].into());
                let found = QuadricExtent::of_both_sides(&k)
                    .iter()
                    .fold(region, |region, solid| solid.bounds_within(&region));
                for (axis, [low, high]) in wanted.into_iter().enumerate() {
                    let beyond = [low - found.min[axis], found.max[axis] - high];
                    assert!(beyond.iter().all(|x| (-1e-15..1e-14).contains(x)), "{axis}: {found:?}");
                }
            }
        }
    }
}

//! The packet kernel of surfaces of revolution: walls, each between two planes across the axis, and
//! the flat ends.
//!
//! ```text
//!   f(x, v, z) = α (n + v² + κ)² + β n - p(v),   n = x² + z²,   p a cubic         negative inside
//!
//!   α = 0, β = 1      x² + z² = p(v), a piece of a `sor` or a ball
//!   α = 1             (n + v² - R² - r²)² = 4R² (r² - v²), a torus
//!   α = -1, β = 4R²   4R² n = (n + v² + R² - r²)², the inner sheet of a spindle
//! ```
//!
//! A ray is clipped to its range, to the slab between the two planes, and to a cylinder a little
//! wider than the wall. There `f` is a quartic along the ray (`polynomial_roots.rs`); beyond the
//! cylinder the ray is outside. Where a ray passes from one wall to the next, both walls must agree
//! with certainty on the side it is on; otherwise it is a doubt. So the walls may be tested in any
//! order.
//!
//! **Errors.** With coordinates up to `M`, `F`, `F₁` and `F₂` bound `f`, the sum of its first
//! derivatives and the norm of its second, all with absolute values throughout. A point that is
//! wrong by `e` per axis changes `f` by at most `F₁ e`, and the coefficients along a ray, in sum,
//! by as much. The formulas round fewer than 16 times at a point, and 64 times along a ray,
//! including everything in `polynomial_roots.rs`.

mod rays;

use crate::packet::local_frame::Own;
use crate::packet::rays::NEVER;
use crate::packet::skin::Skin;
use durer_math::{F8, U, Vec3};

/// A wall between two heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RevolutionWall {
    pub(crate) alpha: f64,
    pub(crate) kappa: f64,
    pub(crate) beta: f64,
    pub(crate) p: [f64; 4],
    /// The height from which `v` is counted.
    pub(crate) at: f64,
    /// The planes between which the wall is.
    pub(crate) slab: [f64; 2],
    /// Between the planes the wall is no wider than this, and `f` is positive beyond.
    pub(crate) radius: f64,
    /// An upper bound of `|κ|` and of the terms of its sum.
    pub(crate) kappa_size: f64,
}

/// Walls, the lowest first, in coordinates in which the second is the height.
#[derive(Clone, Debug)]
pub(crate) struct RevolutionKernel {
    walls: Box<[Bounded]>,
    /// Whether the flat ends belong to the surface.
    closed: bool,
}

#[derive(Clone, Copy, Debug)]
struct Bounded {
    wall: RevolutionWall,
    /// `F` and `F₁` at points of the wall, and for everything that enters a ray's coefficients.
    near: Sizes,
    wide: Sizes,
    /// `F₂` near points of the wall.
    bend: f64,
    /// The error of the heights from rounding.
    slack: f64,
}

#[derive(Clone, Copy, Debug)]
struct Sizes {
    f: f64,
    slope: f64,
    bend: f64,
}

impl RevolutionWall {
    /// The sizes for `|x|, |z| <= m` and `|v| <= v`.
    fn sizes(&self, m: f64, v: f64) -> Sizes {
        let (alpha, beta) = (self.alpha.abs(), self.beta.abs());
        let [a, b, c, d] = self.p.map(f64::abs);
        let square = 2.0 * m * m + v * v;
        let q = square + self.kappa_size;
        let pay = 1.0 + 1.0 / 1024.0;
        let p1 = (3.0 * d * v + 2.0 * c) * v + b;
        Sizes {
            f: (alpha * q * q + 2.0 * beta * m * m + ((d * v + c) * v + b) * v + a) * pay,
            slope: (2.0 * m * (4.0 * alpha * q + 2.0 * beta) + 4.0 * alpha * q * v + p1) * pay,
            bend: (alpha * (4.0 * q + 8.0 * square) + 2.0 * beta + 6.0 * d * v + 2.0 * c) * pay,
        }
    }
}

impl RevolutionKernel {
    /// The kernel for these walls; `closed` if it has flat ends.
    pub(crate) fn new(walls: &[RevolutionWall], closed: bool) -> Self {
        let walls = walls.iter().map(|&wall| {
            let [low, high] = wall.slab.map(|y| y - wall.at);
            let far = low.abs().max(high.abs()) * (1.0 + 1.0 / 64.0);
            let m = wall.radius * (1.0 + 1.0 / 64.0);
            // A ray's coefficients are formed from a point inside and the vector from there to
            // another one, which is at most twice as long.
            let (near, wide) = (wall.sizes(m, far), wall.sizes(3.0 * m, far + (high - low)));
            let slack = (wall.slab[0].abs() + wall.slab[1].abs() + wall.at.abs()) * (4.0 * U);
            Bounded { wall, near, wide, bend: wall.sizes(m * 1.25, far + 0.25 * m).bend, slack }
        });
        Self { walls: walls.collect(), closed }
    }

    /// `f` and its gradient at points `h` of a face, with `|h|₁`.
    #[inline(always)]
    fn skin(&self, own: &Own, face: usize, h: Vec3<F8>, h1: F8) -> Skin {
        let (y, e) = (own.point(h), own.point_error(h1));
        let count = self.walls.len();
        if face >= count {
            let top = face > count;
            let Bounded { wall, slack, .. } = &self.walls[if top { count - 1 } else { 0 }];
            let up = if top { 1.0 } else { -1.0 };
            let f = (y.y - wall.slab[usize::from(top)]) * up;
            let half = own.covector(Vec3::new(F8::ZERO, F8::splat(0.5 * up), F8::ZERO));
            return Skin {
                f,
                half,
                e_f: (e + *slack) * 2.0,
                e_half: F8::splat(own.norm * (4.0 * U)),
                bend: F8::ZERO,
                room: NEVER,
            };
        }
        let Bounded { wall, near, bend, slack, .. } = &self.walls[face];
        let v = y.y - wall.at;
        let n = y.x.mul_add(y.x, y.z * y.z);
        let [p0, p1, p2, p3] = F8::splats(wall.p);
        let value = p3.mul_add(v, p2).mul_add(v, p1).mul_add(v, p0);
        let slope = (p3 * 3.0).mul_add(v, p2 * 2.0).mul_add(v, p1);
        let q = v.mul_add(v, n) + wall.kappa;
        let alpha = q * wall.alpha;
        let f = alpha.mul_add(q, F8::splat(wall.beta).mul_add(n, -value));
        // Half of (4αq + 2β) (x, 0, z) + (4αq v - p') (0, 1, 0).
        let across = alpha * 2.0 + wall.beta;
        let half = Vec3::new(across * y.x, (alpha * 2.0).mul_add(v, slope * -0.5), across * y.z);
        let e = e + (*slack + wall.radius * (4.0 * U));
        let e_half = (e * near.bend + near.slope * (16.0 * U)) * (2.0 * own.norm);
        // Doubled, so that the bound on a polynomial's first value proves the side of rays that
        // start there.
        let e_f = e * (4.0 * near.slope) + 32.0 * U * near.f;
        let bend = F8::splat(*bend * own.norm * own.norm * (1.0 + 16.0 * U));
        Skin { f, half: own.covector(half), e_f, e_half, bend, room: NEVER }
    }
}

/// `f` at height `v` and squared distance `n` from the axis.
#[inline(always)]
fn value(wall: &RevolutionWall, n: F8, v: F8) -> F8 {
    let [p0, p1, p2, p3] = F8::splats(wall.p);
    let p = p3.mul_add(v, p2).mul_add(v, p1).mul_add(v, p0);
    let q = v.mul_add(v, n) + wall.kappa;
    (q * wall.alpha).mul_add(q, F8::splat(wall.beta).mul_add(n, -p))
}

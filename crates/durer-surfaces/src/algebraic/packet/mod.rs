//! The packet kernel of algebraic surfaces.
//!
//! ```text
//!   f(y) = Σ c_ijk x^i y^j z^k      negative inside
//! ```
//!
//! Such a surface may be unbounded. So a ray is searched from its start, or from its entry into
//! what clips the surface, to its end (`rays.rs`).
//!
//! **Errors.** With `S_m` the sum of `|c_ijk|` of the terms of degree `m`, and coordinates up to
//! `M`,
//!
//! ```text
//!   F = Σ S_m M^m,   F₁ = Σ m S_m M^(m-1),   F₂ = Σ m (m-1) S_m M^(m-2)
//! ```
//!
//! bound `f`, the sum of its first derivatives and the sum of its second, all with absolute values
//! throughout. In W. G. Horner's scheme in three variables each term takes at most `4 n + 4`
//! roundings, at a point and in sum along a ray, and its derivatives take twice as many.

mod rays;

use crate::packet::local_frame::{Own, largest};
use crate::packet::rays::{NEVER, SLACK};
use crate::packet::skin::Skin;
use durer_math::{F8, U, Vec3};
use std::sync::Arc;

/// A polynomial of degree below `N`: all coefficients of degree up to `order`, by falling powers of
/// x, then of y, then of z.
#[derive(Clone, Debug)]
pub(crate) struct Terms<const N: usize> {
    pub(crate) order: u32,
    pub(crate) coefficients: Arc<[f64]>,
    /// For each total degree, the sum of the magnitudes.
    pub(crate) sizes: [f64; N],
}

/// `F`, `F₁` and `F₂`.
struct Sizes {
    f: F8,
    slope: F8,
    bend: F8,
}

/// A polynomial along eight rays while it is being built: `len` coefficients.
struct Sum<const N: usize> {
    p: [F8; N],
    len: usize,
}

impl<const N: usize> Sum<N> {
    const ZERO: Self = Self { p: [F8::ZERO; N], len: 0 };

    /// Multiplies the polynomial by `o + x v`.
    #[inline(always)]
    fn times(&mut self, o: F8, v: F8) {
        if self.len == 0 {
            return;
        }
        let n = self.len.min(N - 1);
        self.p[n] = self.p[n - 1] * v;
        for m in (1..n).rev() {
            self.p[m] = self.p[m].mul_add(o, self.p[m - 1] * v);
        }
        self.p[0] = self.p[0] * o;
        self.len = n + 1;
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for (p, q) in self.p.iter_mut().zip(&other.p).take(other.len) {
            *p += *q;
        }
        self.len = self.len.max(other.len);
    }
}

impl<const N: usize> Terms<N> {
    /// `f(o + x v)`: the coefficients of the powers of `x`.
    #[inline(always)]
    fn along(&self, o: Vec3<F8>, v: Vec3<F8>) -> [F8; N] {
        let mut list = self.coefficients.iter();
        let mut over_x = Sum::<N>::ZERO;
        for i in 0..=self.order {
            over_x.times(o.x, v.x);
            let mut over_y = Sum::<N>::ZERO;
            for j in 0..=i {
                over_y.times(o.y, v.y);
                let mut over_z = Sum::<N>::ZERO;
                for _ in 0..=j {
                    over_z.times(o.z, v.z);
                    if let Some(&c) = list.next().filter(|c| **c != 0.0) {
                        over_z.p[0] = over_z.p[0] + c;
                        over_z.len = over_z.len.max(1);
                    }
                }
                over_y.add(&over_z);
            }
            over_x.add(&over_y);
        }
        over_x.p
    }

    /// `f` and its gradient.
    #[inline(always)]
    fn at(&self, y: Vec3<F8>) -> (F8, Vec3<F8>) {
        let mut list = self.coefficients.iter();
        let (mut f, mut fx, mut fy, mut fz) = (F8::ZERO, F8::ZERO, F8::ZERO, F8::ZERO);
        for i in 0..=self.order {
            let (mut g, mut gy, mut gz) = (F8::ZERO, F8::ZERO, F8::ZERO);
            for j in 0..=i {
                let (mut h, mut hz) = (F8::ZERO, F8::ZERO);
                for _ in 0..=j {
                    hz = hz.mul_add(y.z, h);
                    h = h.mul_add(y.z, F8::splat(list.next().copied().unwrap_or(0.0)));
                }
                gy = gy.mul_add(y.y, g);
                g = g.mul_add(y.y, h);
                gz = gz.mul_add(y.y, hz);
            }
            fx = fx.mul_add(y.x, f);
            f = f.mul_add(y.x, g);
            fy = fy.mul_add(y.x, gy);
            fz = fz.mul_add(y.x, gz);
        }
        (f, Vec3::new(fx, fy, fz))
    }

    /// The sizes for coordinates up to `m`.
    #[inline(always)]
    fn sizes(&self, m: F8) -> Sizes {
        let (mut f, mut slope, mut half_bend) = (F8::ZERO, F8::ZERO, F8::ZERO);
        for size in self.sizes.iter().rev() {
            half_bend = half_bend.mul_add(m, slope);
            slope = slope.mul_add(m, f);
            f = f.mul_add(m, F8::splat(*size));
        }
        let pay = 1.0 + 1.0 / 1024.0;
        Sizes { f: f * pay, slope: slope * pay, bend: half_bend * (2.0 * pay) }
    }

    /// `f` and its gradient at points `h` of the surface, with `|h|₁`.
    #[inline(always)]
    fn skin(&self, own: &Own, h: Vec3<F8>, h1: F8) -> Skin {
        let (y, e) = (own.point(h), own.point_error(h1));
        let m = largest(y);
        let Sizes { f: size, slope, bend } = self.sizes(m + 1.0 / 64.0);
        let (f, g) = self.at(y);
        // For rays that start there, the kernel begins at a place that may be this far from the
        // start (`rays.rs`).
        let e = (e + (m + 1.0) * (128.0 * U)) * SLACK;
        let e_f = (e * slope + size * (16.0 * N as f64 * U)) * 2.0;
        let e_half = (e * bend + slope * (16.0 * N as f64 * U)) * own.norm;
        let half = own.covector(Vec3::new(g.x * 0.5, g.y * 0.5, g.z * 0.5));
        Skin { f, half, e_f, e_half, bend: bend * (own.norm * own.norm * (1.0 + 16.0 * U)), room: NEVER }
    }
}

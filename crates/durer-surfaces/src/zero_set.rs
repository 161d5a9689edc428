//! The zero set of a polynomial of your own.
//!
//! The author writes the polynomial once, over any ring, and a box around its zeros. All else
//! follows: put into it, `x = o + s d` makes it a polynomial in the ray's parameter `s` by the
//! ring's own arithmetic, over the polynomials in `s`. The gradient and the second derivatives are
//! its coefficients along a few directions, and over numbers that are known within an error they
//! are bounds.

use crate::faces::chart::{Chart, Frame};
use crate::faces::form::FLOOR;
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::{
    Accelerate, Algebraic, CentredRay, Forward, LocalPoint, LocalRay, Need, RingRay, Root, Side, Sink,
    Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Dyadic, EFloat, Isa, Point3, Ring, Vec3};
use durer_roots::quadratic::Quadratic;

/// A polynomial of a degree below `N` in x, y and z: all that a surface needs to be a [`ZeroSet`].
///
/// ```
/// use durer_math::{Aabb, Point3, Ray, Ring, Vec3};
/// use durer_surfaces::{Closest, LocalRay, Polynomial, Surface, ZeroSet};
///
/// /// x⁴ + y⁴ + z⁴ = 1.
/// #[derive(Clone, Debug)]
/// struct Pillow;
///
/// impl Polynomial<5> for Pillow {
///     fn bounds(&self) -> Aabb {
///         Aabb::new(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0))
///     }
///
///     fn value<T: Ring>(&self, [x, y, z]: [T; 3], w: T) -> T {
///         let fourth = |t: T| t.square().square();
///         fourth(x) + fourth(y) + fourth(z) - fourth(w)
///     }
/// }
///
/// let pillow = ZeroSet::new(Pillow)?;
/// let ray = Ray::new(Point3::new(0.0, 0.0, -3.0), Vec3::Z);
/// let mut closest = Closest::default();
/// pillow.roots(&LocalRay::new(&ray), &mut closest);
/// assert!(closest.root.is_some_and(|root| root.lo <= 2.0 && 2.0 <= root.hi && root.sign == -1));
/// # Ok::<(), durer_surfaces::ZeroSetError>(())
/// ```
pub trait Polynomial<const N: usize>: Send + Sync {
    /// A box that provably holds all zeros and, unless it is unbounded, all points where the
    /// polynomial is negative; [`Aabb::UNBOUNDED`] if there is none.
    fn bounds(&self) -> Aabb;

    /// The polynomial at the point `(x / w, y / w, z / w)`, times `w` to the power of its degree:
    /// each term is multiplied by `w` until its degree is that of the highest one. The inside is
    /// where it is negative.
    ///
    /// Numbers of the surface come in by [`Ring::exact`]. The surface is that of these numbers, so
    /// what is computed before from others (`r * r` in f64) is part of its definition. The value
    /// must not depend on [`Ring::sign`] or on the type `T`.
    fn value<T: Ring>(&self, p: [T; 3], w: T) -> T;

    /// The surface's name in explanations and statistics, in the singular.
    fn name(&self) -> &'static str {
        "polynomial surface"
    }
}

/// The set where a [`Polynomial`] is zero, as a solid where it is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroSet<P, const N: usize> {
    polynomial: P,
    bounds: Aabb,
    /// The unit of length is `2^scale`.
    scale: i32,
    /// The radius of a ball about the origin that holds the surface, in units.
    reach: f64,
}

/// Why a [`ZeroSet`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ZeroSetError {
    /// The box of the zeros is empty or not a number.
    #[error("zero set: its bounds are empty")]
    Bounds,
    /// Not all terms have the same degree.
    #[error("zero set: the terms must have the same degree in x, y, z and w")]
    Terms,
    /// The degree is zero, or not less than `N`.
    #[error("zero set: the degree must be from 1 to {greatest}, got {degree}")]
    Degree {
        /// The greatest possible one, `N - 1`.
        greatest: usize,
        /// The polynomial's.
        degree: usize,
    },
    /// The polynomial is zero everywhere.
    #[error("zero set: the polynomial is zero everywhere")]
    Zero,
}

/// The degree up to which one that is too high is named.
const HIGHEST: usize = 64;

impl<const N: usize, P: Polynomial<N>> ZeroSet<P, N> {
    /// The zero set of `polynomial`. Its degree, and that all terms have it, are tested in exact
    /// arithmetic at a few points.
    ///
    /// # Errors
    ///
    /// If the terms have different degrees, or the degree is not from 1 to `N - 1`, or the bounds
    /// are empty.
    pub fn new(polynomial: P) -> Result<Self, ZeroSetError> {
        let bounds = polynomial.bounds();
        if !(0..3).all(|axis| bounds.min[axis] <= bounds.max[axis]) {
            return Err(ZeroSetError::Bounds);
        }
        let degree = degree(&polynomial)?;
        if !(1..N).contains(&degree) {
            return Err(ZeroSetError::Degree { greatest: N.saturating_sub(1), degree });
        }
        let reach = if bounds.is_bounded() { bounds.reach_from(Point3::ORIGIN) } else { f64::INFINITY };
        // A power of the unit stays within a power of two that leaves room for coefficients.
        let most = 384 / degree as i32;
        let scale = if reach.is_finite() { exponent(reach).clamp(-most, most) } else { 0 };
        let reach = scale2(reach, -scale);
        Ok(Self { polynomial, bounds, scale, reach })
    }

    /// The polynomial.
    pub fn polynomial(&self) -> &P {
        &self.polynomial
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        polynomial_surface::roots(self, ray, sink);
    }

    /// The first three coefficients along a ray that is known within an error.
    #[inline(always)]
    fn bent(&self, o: [EFloat; 3], d: Vec3) -> [EFloat; 3] {
        let line = Series::<EFloat, 3>::line(&o, &d.to_array().map(EFloat::<f64>::exact));
        self.polynomial.value(line.map(|x| x.scale2(self.scale)), Series::constant(EFloat::exact(1.0))).c
    }

    /// The gradient, and the matrix of second derivatives: xx, yy, zz, xy, xz, yz.
    fn derivatives(&self, o: [EFloat; 3]) -> (Vec3, [EFloat; 6]) {
        Isa::detect().run(
            #[inline(always)]
            || {
                let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| self.bent(o, v));
                let g = axes.map(|c| c[1].value());
                let pure = axes.map(|c| c[2]);
                // f(y + s (e_i + e_j)) has the second coefficient (H_ii + H_jj) / 2 + H_ij.
                let mixed = |i: usize, j: usize, v: Vec3| self.bent(o, v)[2] - pure[i] - pure[j];
                let [xx, yy, zz] = pure.map(|c| c.scale2(1));
                let (xy, xz, yz) = (
                    mixed(0, 1, Vec3::X + Vec3::Y),
                    mixed(0, 2, Vec3::X + Vec3::Z),
                    mixed(1, 2, Vec3::Y + Vec3::Z),
                );
                (g.into(), [xx, yy, zz, xy, xz, yz])
            },
        )
    }
}

/// The degree in x, y, z and w together.
fn degree<const N: usize>(polynomial: &impl Polynomial<N>) -> Result<usize, ZeroSetError> {
    // A polynomial of a low degree that is zero at all of these, or has the right ratio at all of
    // them by chance, is not one that is met.
    const POINTS: [[f64; 4]; 5] = [
        [3.0, 5.0, 7.0, 2.0],
        [-11.0, 13.0, 4.0, 3.0],
        [17.0, -6.0, 19.0, 5.0],
        [8.0, 23.0, -9.0, 7.0],
        [-29.0, -10.0, 31.0, 11.0],
    ];
    let at = |p: [f64; 4], k: i32| {
        let [x, y, z, w] = p.map(|x| Dyadic::from(x).scale2(k));
        polynomial.value([x, y, z], w)
    };
    let mut found = None;
    for p in POINTS {
        let (one, two) = (at(p, 0), at(p, 1));
        if one.exact_sign().is_eq() {
            if two.exact_sign().is_ne() {
                return Err(ZeroSetError::Terms);
            }
            continue;
        }
        let is_degree = |m: &usize| (&two - &one.clone().scale2(*m as i32)).exact_sign().is_eq();
        let degree = (0..=HIGHEST.max(N)).find(is_degree).ok_or(ZeroSetError::Terms)?;
        if found.is_some_and(|other| other != degree) {
            return Err(ZeroSetError::Terms);
        }
        found = Some(degree);
    }
    found.ok_or(ZeroSetError::Zero)
}

/// A polynomial in the ray's parameter over a ring, up to the power `N - 1`. Coefficients from
/// `len` on are zero.
#[derive(Clone)]
struct Series<T, const N: usize> {
    c: [T; N],
    len: usize,
}

impl<T: Ring, const N: usize> Series<T, N> {
    #[inline(always)]
    fn constant(x: T) -> Self {
        let mut x = Some(x);
        Self { c: core::array::from_fn(|_| x.take().unwrap_or_else(|| T::exact(0.0))), len: N.min(1) }
    }

    /// The coordinates of a ray's points.
    #[inline(always)]
    fn line(o: &[T; 3], d: &[T; 3]) -> [Self; 3] {
        core::array::from_fn(|k| {
            let mut at = Self::constant(o[k].clone());
            if let Some(slope) = at.c.get_mut(1) {
                *slope = d[k].clone();
                at.len = 2;
            }
            at
        })
    }

    #[inline(always)]
    fn map(self, f: impl FnMut(T) -> T) -> Self {
        Self { c: self.c.map(f), len: self.len }
    }

    /// Each coefficient by those of two, where both have one.
    #[inline(always)]
    fn by_terms(self, other: Self, both: impl Fn(T, T) -> T, second: impl Fn(T) -> T) -> Self {
        let (m, n) = (self.len, other.len);
        let mut i = 0;
        let mut others = other.c.into_iter();
        let c = self.c.map(|a| {
            let b = others.next();
            let at = i;
            i += 1;
            match b {
                Some(b) if at < m && at < n => both(a, b),
                Some(b) if at < n => second(b),
                _ => a,
            }
        });
        Self { c, len: m.max(n) }
    }
}

impl<T: Ring, const N: usize> Add for Series<T, N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.by_terms(other, |a, b| a + b, |b| b)
    }
}

impl<T: Ring, const N: usize> Sub for Series<T, N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.by_terms(other, |a, b| a - b, |b| -b)
    }
}

impl<T: Ring, const N: usize> Neg for Series<T, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<T: Ring, const N: usize> Mul for Series<T, N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (m, n) = (self.len, other.len);
        let len = if m == 0 || n == 0 { 0 } else { (m + n - 1).min(N) };
        let c = core::array::from_fn(|k| {
            if k >= len {
                return T::exact(0.0);
            }
            let first = k.saturating_sub(n - 1);
            let term = |i: usize| self.c[i].clone() * other.c[k - i].clone();
            (first + 1..=k.min(m - 1)).fold(term(first), |sum, i| sum + term(i))
        });
        Self { c, len }
    }
}

impl<T: Ring, const N: usize> Ring for Series<T, N> {
    #[inline(always)]
    fn exact(x: f64) -> Self {
        Self::constant(T::exact(x))
    }

    #[inline(always)]
    fn within(x: f64, error: f64) -> Option<Self> {
        T::within(x, error).map(Self::constant)
    }

    #[inline(always)]
    fn scale2(self, exponent: i32) -> Self {
        self.map(|x| x.scale2(exponent))
    }

    /// That of a constant; other polynomials have none.
    #[inline(always)]
    fn sign(&self) -> Option<Ordering> {
        match self.len {
            0 => Some(Ordering::Equal),
            1 => self.c[0].sign(),
            _ => None,
        }
    }

    /// `c_k = Σ 2 a_i a_(k-i) + a_(k/2)²`, the sum over `i < k - i`.
    #[inline(always)]
    fn square(self) -> Self {
        let m = self.len;
        let len = if m == 0 { 0 } else { (2 * m - 1).min(N) };
        let c = core::array::from_fn(|k| {
            if k >= len {
                return T::exact(0.0);
            }
            let first = k.saturating_sub(m - 1);
            let term = |i: usize| (self.c[i].clone() * self.c[k - i].clone()).scale2(1);
            let mut sum = (k % 2 == 0).then(|| self.c[k / 2].clone().square());
            for i in first..k.div_ceil(2) {
                sum = Some(match sum {
                    Some(sum) => sum + term(i),
                    None => term(i),
                });
            }
            sum.unwrap_or_else(|| T::exact(0.0))
        });
        Self { c, len }
    }
}

impl<const N: usize, P: Polynomial<N>> PolynomialSurface<N> for ZeroSet<P, N> {
    #[inline(always)]
    fn frame(&self) -> Frame {
        Frame { centre: Point3::ORIGIN, scale: self.scale, reach: self.reach }
    }

    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; N] {
        let line = Series::<T, N>::line(&ray.o, &ray.d);
        self.polynomial.value(line.map(|x| x.scale2(self.scale)), Series::constant(ray.w.clone())).c
    }

    #[inline(always)]
    fn at<T: Ring>(&self, p: &[T; 3], w: &T) -> T {
        self.polynomial.value(p.clone().map(|x| x.scale2(self.scale)), w.clone())
    }

    #[inline(always)]
    fn stretch(&self, ray: &CentredRay<'_>) -> Option<(f64, f64)> {
        if self.reach == f64::INFINITY {
            return Some((0.0, f64::INFINITY));
        }
        let reach = self.reach * (1.0 + MARGIN) + MARGIN;
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        polynomial_surface::ball_and_slab(ray, reach, (0.0, 0.0), everywhere, MARGIN)
    }

    fn slopes(&self, y: Vec3) -> (Vec3, f64) {
        let near = y.to_array().map(|x| EFloat::with_error(x, 1.0 / 64.0));
        let (g, h) = self.derivatives(near);
        // The norm of all its numbers.
        let size = h.map(EFloat::magnitude);
        let square = |i: usize| size[i] * size[i];
        let squares = square(0) + square(1) + square(2) + 2.0 * (square(3) + square(4) + square(5));
        (g, squares.sqrt() * (1.0 + 1.0 / 1024.0) + FLOOR)
    }

    fn turn(&self, y: Vec3, v: Vec3) -> Vec3 {
        let (_, h) = self.derivatives(y.to_array().map(EFloat::<f64>::exact));
        let [xx, yy, zz, xy, xz, yz] = h.map(EFloat::value);
        Vec3::new(
            xx * v.x + xy * v.y + xz * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z,
        )
    }

    /// Longitude and latitude as seen from the origin.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        polynomial_surface::longitude_and_latitude(y, n)
    }

    fn tip(&self, y: Vec3) -> Vec3 {
        Isa::detect().run(
            #[inline(always)]
            || polynomial_surface::steepest(self, y),
        )
    }
}

/// By how much the ball around the surface is taken larger than it is, in units, so that no
/// rounding matters.
const MARGIN: f64 = 1.0 / 256.0;

impl<const N: usize, P: Polynomial<N>> Surface for ZeroSet<P, N> {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        if !ray.passes_by(Point3::ORIGIN, scale2(self.reach, self.scale)) {
            self.all_roots(ray, &mut Forward(sink));
        }
    }

    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        polynomial_surface::resolve(self, ray, root, need)
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        polynomial_surface::side(self, point)
    }
}

impl<const N: usize, P: Polynomial<N>> Accelerate for ZeroSet<P, N> {
    fn name(&self) -> &'static str {
        self.polynomial.name()
    }
}

impl<const N: usize, P: Polynomial<N>> Algebraic for ZeroSet<P, N> {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        polynomial_surface::sign_at_root(self, ray, root, q)
    }
}

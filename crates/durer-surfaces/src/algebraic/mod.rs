//! Algebraic surfaces: the zero set of any polynomial in x, y and z.
//!
//! ```text
//!   f(x, y, z) = Σ a_ijk x^i y^j z^k,   i + j + k <= n;      inside where f < 0
//! ```
//!
//! Along a ray `f` is a polynomial of degree `n`: P. Hanrahan, "Ray tracing algebraic surfaces",
//! *Computer Graphics (Proc. SIGGRAPH)* 17(3), 1983. Coefficients are listed by falling powers of x,
//! then of y, then of z, so that one pass over the list with nested Horner schemes puts a ray into `f`.

mod packet;

use self::packet::Terms;
use crate::faces::chart::{Chart, Frame};
use crate::faces::form::FLOOR;
use crate::packet::FilterSource;
use crate::polynomial_surface::{self, PolynomialSurface};
use crate::{
    Accelerate, Algebraic, CentredRay, Forward, LocalPoint, LocalRay, Need, PartId, RingRay, Root, Side,
    Sink, Solidity, Surface, SurfacePoint,
};
use core::cmp::Ordering;
use durer_math::eft::exponent;
use durer_math::scale::ldexp;
use durer_math::{Aabb, Dyadic, EFloat, Isa, Point3, Ring, Vec3};
use durer_roots::quadratic::Quadratic;
use std::sync::Arc;

/// The greatest order.
pub const MAX_ORDER: u32 = 16;

/// The zero set of a polynomial of an order from 1 to [`MAX_ORDER`], as a solid where the
/// polynomial is negative. It counts as unbounded.
#[derive(Clone, Debug, PartialEq)]
pub struct AlgebraicSurface(Fitting);

/// Kernels are made for a few orders; between them leading coefficients are zero.
#[derive(Clone, Debug, PartialEq)]
enum Fitting {
    Four(Dense<5>),
    Eight(Dense<9>),
    Sixteen(Dense<17>),
}

/// A polynomial of an order below `N`.
#[derive(Clone, Debug, PartialEq)]
struct Dense<const N: usize> {
    order: u32,
    /// In units of `2^scale`, times `2^gain`: exactly the given ones in that measure.
    coefficients: Arc<[f64]>,
    scale: i32,
    /// Of each total degree, the sum of the magnitudes.
    sizes: [f64; N],
}

/// Why an [`AlgebraicSurface`] cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AlgebraicError {
    /// The order is below 1 or above [`MAX_ORDER`].
    #[error("algebraic surface: the order must be from 1 to {MAX_ORDER}, got {0}")]
    Order(u32),
    /// The list of coefficients has the wrong length.
    #[error("algebraic surface: order {order} has {wanted} coefficients, got {found}")]
    Count {
        /// The order.
        order: u32,
        /// How many there should be.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// A coefficient is infinite or NaN.
    #[error("algebraic surface: coefficient {index} must be finite, got {value}")]
    Coefficient {
        /// Its place, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All coefficients but the constant are zero: no surface.
    #[error("algebraic surface: all coefficients but the constant are zero")]
    Constant,
}

/// How many coefficients a polynomial of an order has: `(n+1)(n+2)(n+3)/6`.
pub const fn coefficient_count(order: u32) -> usize {
    let n = order as usize;
    (n + 1) * (n + 2) * (n + 3) / 6
}

/// The powers of x, y and z in the order of the list.
pub fn powers(order: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..=order).rev().flat_map(move |i| {
        (0..=order - i).rev().flat_map(move |j| (0..=order - i - j).rev().map(move |k| [i, j, k]))
    })
}

/// The place of a term in the list.
pub const fn place_of(order: u32, [i, j, k]: [u32; 3]) -> usize {
    // Terms with a higher power of x, with a higher power of y among the rest, with a higher power
    // of z among those.
    let left = (order - i) as usize;
    let rest = left - j as usize;
    let higher_x = left * (left + 1) * (left + 2) / 6;
    higher_x + rest * (rest + 1) / 2 + (rest - k as usize)
}

impl AlgebraicSurface {
    /// The surface of `order` with these coefficients, by falling powers of x, then of y, then of
    /// z.
    pub fn new(order: u32, coefficients: &[f64]) -> Result<Self, AlgebraicError> {
        if !(1..=MAX_ORDER).contains(&order) {
            return Err(AlgebraicError::Order(order));
        }
        let (wanted, found) = (coefficient_count(order), coefficients.len());
        if found != wanted {
            return Err(AlgebraicError::Count { order, wanted, found });
        }
        if let Some(index) = coefficients.iter().position(|x| !x.is_finite()) {
            return Err(AlgebraicError::Coefficient { index, value: coefficients[index] });
        }
        if coefficients[..wanted - 1].iter().all(|&x| x == 0.0) {
            return Err(AlgebraicError::Constant);
        }
        let (order, coefficients) = trimmed(order, coefficients);
        Ok(Self(match order {
            0..=4 => Fitting::Four(Dense::new(order, &coefficients)),
            5..=8 => Fitting::Eight(Dense::new(order, &coefficients)),
            _ => Fitting::Sixteen(Dense::new(order, &coefficients)),
        }))
    }

    /// The order, which is that of the highest terms that are not zero.
    pub fn order(&self) -> u32 {
        match &self.0 {
            Fitting::Four(p) => p.order,
            Fitting::Eight(p) => p.order,
            Fitting::Sixteen(p) => p.order,
        }
    }

    #[inline(never)]
    fn all_roots(&self, ray: &LocalRay<'_>, sink: &mut dyn Sink) {
        match &self.0 {
            Fitting::Four(p) => polynomial_surface::roots(p, ray, sink),
            Fitting::Eight(p) => polynomial_surface::roots(p, ray, sink),
            Fitting::Sixteen(p) => polynomial_surface::roots(p, ray, sink),
        }
    }
}

impl<const N: usize> Dense<N> {
    fn new(order: u32, coefficients: &[f64]) -> Self {
        let (scale, coefficients) = measured(order, coefficients);
        let mut sizes = [0.0; N];
        for (c, n) in coefficients.iter().zip(powers(order)) {
            sizes[n.iter().sum::<u32>() as usize] += c.abs();
        }
        Self { order, coefficients, scale, sizes }
    }

    /// The polynomial for lanes.
    fn terms(&self) -> Terms<N> {
        let Self { order, coefficients, sizes, .. } = self;
        Terms { order: *order, coefficients: coefficients.clone(), sizes: *sizes }
    }
}

/// The order of the highest terms that are not zero, and all coefficients up to there. Higher ones
/// would leave the sign at infinity open.
fn trimmed(order: u32, coefficients: &[f64]) -> (u32, Vec<f64>) {
    let degree = |n: [u32; 3]| n.iter().sum::<u32>();
    let terms = || coefficients.iter().copied().zip(powers(order).map(degree));
    let top = terms().filter(|(c, _)| *c != 0.0).map(|(_, n)| n).max().unwrap_or(order);
    (top, terms().filter(|(_, n)| *n <= top).map(|(c, _)| c).collect())
}

/// A unit of length in which the surface is about one large, and the coefficients in it; the given
/// ones if others would not be exact.
fn measured(order: u32, coefficients: &[f64]) -> (i32, Arc<[f64]>) {
    let mut largest = [0.0_f64; MAX_ORDER as usize + 1];
    for (c, n) in coefficients.iter().zip(powers(order)) {
        let size = &mut largest[n.iter().sum::<u32>() as usize];
        *size = size.max(c.abs());
    }
    let top = order as usize;
    // Where the leading terms begin to outweigh the others.
    let balance = |d: usize| f64::from(exponent(largest[d]) - exponent(largest[top])) / (top - d) as f64;
    let scale = (0..top).filter(|&d| largest[d] > 0.0).map(balance).fold(f64::NEG_INFINITY, f64::max);
    let scale = if scale.is_finite() { scale.clamp(-200.0, 200.0) as i32 } else { 0 };
    let of = |n: [u32; 3]| scale * n.iter().sum::<u32>() as i32;
    let gain = coefficients.iter().zip(powers(order)).filter(|(c, _)| **c != 0.0);
    let gain = -gain.map(|(c, n)| exponent(*c) + of(n)).max().unwrap_or(0);
    let scaled: Arc<[f64]> =
        coefficients.iter().zip(powers(order)).map(|(&c, n)| ldexp(c, of(n) + gain)).collect();
    let exact = scaled
        .iter()
        .zip(coefficients)
        .zip(powers(order))
        .all(|((&s, &c), n)| ldexp(s, -of(n) - gain) == c && (c == 0.0 || s.abs() >= f64::MIN_POSITIVE));
    if exact { (scale, scaled) } else { (0, coefficients.into()) }
}

/// A polynomial in the ray's parameter, or a number, while it is being built: `p` with `len`
/// coefficients.
struct Sum<T, const N: usize> {
    p: [T; N],
    len: usize,
}

impl<T: Ring, const N: usize> Sum<T, N> {
    #[inline(always)]
    fn zero() -> Self {
        Self { p: core::array::from_fn(|_| T::exact(0.0)), len: 0 }
    }

    /// Times `o + s d`.
    #[inline(always)]
    fn times(&mut self, o: &T, d: &T) {
        if self.len == 0 {
            return;
        }
        let n = self.len.min(N - 1);
        self.p[n] = self.p[n - 1].clone() * d.clone();
        for m in (1..n).rev() {
            self.p[m] = self.p[m].clone() * o.clone() + self.p[m - 1].clone() * d.clone();
        }
        self.p[0] = self.p[0].clone() * o.clone();
        self.len = n + 1;
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for m in 0..other.len {
            self.p[m] = self.p[m].clone() + other.p[m].clone();
        }
        self.len = self.len.max(other.len);
    }
}

impl<const N: usize> Dense<N> {
    /// The powers of `w`.
    #[inline(always)]
    fn powers_of<T: Ring>(w: &T) -> [T; N] {
        let mut power = T::exact(1.0);
        core::array::from_fn(|_| {
            let next = power.clone() * w.clone();
            core::mem::replace(&mut power, next)
        })
    }

    /// The gradient at `y` over `w`, times w to the power of the order less one.
    fn gradient(&self, y: Vec3, w: f64) -> Vec3 {
        Isa::detect().run(
            #[inline(always)]
            || self.gradient_here(y, w),
        )
    }

    #[inline(always)]
    fn gradient_here(&self, y: Vec3, w: f64) -> Vec3 {
        let o = y.to_array().map(EFloat::exact);
        let mut g = [0.0; 3];
        for (slope, d) in g.iter_mut().zip([Vec3::X, Vec3::Y, Vec3::Z]) {
            let ray = RingRay { o, d: d.to_array().map(EFloat::<f64>::exact), w: EFloat::exact(w) };
            *slope = self.along(&ray)[1].value();
        }
        g.into()
    }
}

impl<const N: usize> PolynomialSurface<N> for Dense<N> {
    #[inline(always)]
    fn frame(&self) -> Frame {
        Frame { centre: Point3::ORIGIN, scale: self.scale, reach: f64::INFINITY }
    }

    #[inline(always)]
    fn along<T: Ring>(&self, ray: &RingRay<T>) -> [T; N] {
        let [[x, y, z], [dx, dy, dz]] = [&ray.o, &ray.d];
        let w = Self::powers_of(&ray.w);
        let n = self.order as usize;
        let mut list = self.coefficients.iter();
        let mut over_x = Sum::<T, N>::zero();
        for i in 0..=n {
            over_x.times(x, dx);
            let mut over_y = Sum::<T, N>::zero();
            for j in 0..=i {
                over_y.times(y, dy);
                let mut over_z = Sum::<T, N>::zero();
                for power in &w[..=j] {
                    over_z.times(z, dz);
                    // The power of w that makes all terms of the same degree.
                    if let Some(&c) = list.next().filter(|c| **c != 0.0) {
                        over_z.p[0] = over_z.p[0].clone() + T::exact(c) * power.clone();
                        over_z.len = over_z.len.max(1);
                    }
                }
                over_y.add(&over_z);
            }
            over_x.add(&over_y);
        }
        over_x.p
    }

    #[inline(always)]
    fn at<T: Ring>(&self, p: &[T; 3], w: &T) -> T {
        let [x, y, z] = p;
        let w = Self::powers_of(w);
        let n = self.order as usize;
        let mut list = self.coefficients.iter();
        let mut over_x = T::exact(0.0);
        for i in 0..=n {
            let mut over_y = T::exact(0.0);
            for j in 0..=i {
                let mut over_z = T::exact(0.0);
                for power in &w[..=j] {
                    over_z = over_z * z.clone();
                    if let Some(&c) = list.next().filter(|c| **c != 0.0) {
                        over_z = over_z + T::exact(c) * power.clone();
                    }
                }
                over_y = over_y * y.clone() + over_z;
            }
            over_x = over_x * x.clone() + over_y;
        }
        over_x
    }

    #[inline(always)]
    fn stretch(&self, _: &CentredRay<'_>) -> Option<(f64, f64)> {
        Some((0.0, f64::INFINITY))
    }

    fn slopes(&self, y: Vec3) -> (Vec3, f64) {
        // The second derivatives of a term of degree m are at most m (m-1) |c| M^(m-2) in sum, M
        // the largest coordinate.
        let far = y.max_abs() + 1.0 / 64.0;
        let bend = (2..N).rev().fold(0.0, |sum, m| sum * far + (m * (m - 1)) as f64 * self.sizes[m]);
        (self.gradient(y, 1.0), bend * (1.0 + 1.0 / 1024.0) + FLOOR)
    }

    fn turn(&self, y: Vec3, v: Vec3) -> Vec3 {
        // Central differences: half the digits, for shading.
        let step = (1.0 + y.max_abs()) / (1u64 << 18) as f64;
        let size = v.max_abs();
        if size == 0.0 {
            return Vec3::ZERO;
        }
        let h = v * (step / size);
        (self.gradient(y + h, 1.0) - self.gradient(y - h, 1.0)) * (size / (2.0 * step))
    }

    /// Longitude and latitude as seen from the origin.
    fn chart(&self, y: Vec3, n: Vec3) -> Chart {
        polynomial_surface::longitude_and_latitude(y, n)
    }

    fn tip(&self, y: Vec3) -> Vec3 {
        Isa::detect().run(
            #[inline(always)]
            || self.tip_here(y),
        )
    }
}

impl<const N: usize> Dense<N> {
    #[inline(always)]
    fn tip_here(&self, y: Vec3) -> Vec3 {
        // So far out the gradient itself may be beyond the range of f64; of homogeneous coordinates
        // within one it is not, and has the same direction.
        let far = exponent(y.max_abs());
        if far > 0 {
            let g = self.gradient_here(y.map(|x| ldexp(x, -far)), ldexp(1.0, -far));
            if g.is_finite() && g != Vec3::ZERO && !self.gradient_here(y, 1.0).length().is_finite() {
                let g = g.map(|x| ldexp(x, -exponent(g.max_abs())));
                return g * (1.0 / g.length());
            }
        }
        polynomial_surface::steepest(self, y)
    }
}

impl Surface for AlgebraicSurface {
    fn bounds(&self) -> Aabb {
        Aabb::UNBOUNDED
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.all_roots(ray, &mut Forward(sink));
    }

    #[inline(never)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        match &self.0 {
            Fitting::Four(p) => polynomial_surface::resolve(p, ray, root, need),
            Fitting::Eight(p) => polynomial_surface::resolve(p, ray, root, need),
            Fitting::Sixteen(p) => polynomial_surface::resolve(p, ray, root, need),
        }
    }

    fn solidity(&self) -> Solidity {
        Solidity::Solid
    }

    fn side(&self, point: &LocalPoint<'_>) -> Side {
        match &self.0 {
            Fitting::Four(p) => polynomial_surface::side(p, point),
            Fitting::Eight(p) => polynomial_surface::side(p, point),
            Fitting::Sixteen(p) => polynomial_surface::side(p, point),
        }
    }
}

impl Accelerate for AlgebraicSurface {
    fn name(&self) -> &'static str {
        "algebraic surface"
    }

    fn packet_filter(&self, _part: PartId) -> FilterSource {
        match &self.0 {
            Fitting::Four(p) => FilterSource::unbounded(p.terms(), p.scale),
            Fitting::Eight(p) => FilterSource::unbounded(p.terms(), p.scale),
            Fitting::Sixteen(p) => FilterSource::unbounded(p.terms(), p.scale),
        }
    }
}

impl Algebraic for AlgebraicSurface {
    fn sign_at_root(&self, ray: &LocalRay<'_>, root: &Root, q: &Quadratic<Dyadic>) -> Option<Ordering> {
        match &self.0 {
            Fitting::Four(p) => polynomial_surface::sign_at_root(p, ray, root, q),
            Fitting::Eight(p) => polynomial_surface::sign_at_root(p, ray, root, q),
            Fitting::Sixteen(p) => polynomial_surface::sign_at_root(p, ray, root, q),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{self, Exact, Feature, TestRng, ZeroOracle, all_roots, check_many, exact3};
    use crate::{DynSurface, LocalPoint, Placed};
    use durer_math::{Affine, Point3, Ray, RaySide};

    fn oracle(order: u32, coefficients: &[f64], size: f64) -> ZeroOracle {
        let terms = coefficients.iter().zip(powers(order)).filter(|(c, _)| **c != 0.0);
        let terms = terms.map(|(&c, n)| (Exact::from(c), n.map(|n| n as usize)));
        ZeroOracle { terms: terms.collect(), size }
    }

    fn list(order: u32, terms: &[([u32; 3], f64)]) -> Vec<f64> {
        let mut all = vec![0.0; coefficient_count(order)];
        for &(n, c) in terms {
            all[place_of(order, n)] = c;
        }
        all
    }

    #[test]
    fn the_list_has_the_order_of_the_scene_language() {
        let cubic: Vec<_> = powers(3).collect();
        assert_eq!(cubic.len(), coefficient_count(3));
        assert_eq!(&cubic[..5], &[[3, 0, 0], [2, 1, 0], [2, 0, 1], [2, 0, 0], [1, 2, 0]]);
        assert_eq!(cubic[19], [0, 0, 0]);
        for order in 1..=16 {
            assert!(powers(order).enumerate().all(|(place, n)| place_of(order, n) == place));
        }
    }

    fn obeys(order: u32, coefficients: &[f64], features: &[Feature], count: u64) -> (u64, f64) {
        let surface = AlgebraicSurface::new(order, coefficients).unwrap();
        let oracle = oracle(order, coefficients, 2.0);
        for f in features.iter().filter(|f| f.direction != Vec3::ZERO) {
            assert_eq!(oracle.value(&exact3(f.point.to_array())).sign(), Ordering::Equal);
        }
        let mut tally = check_many(&surface, &oracle, features, u64::from(order), count);
        (tally.grazing, tally.median_width())
    }

    /// Rays that leave a node, where two bodies meet or two gaps, start on the requested side.
    #[test]
    fn rays_leave_a_node_on_their_side() {
        let cone = |s: f64| vec![([2, 0, 0], s), ([0, 2, 0], s), ([0, 0, 2], -s)];
        let with = |mut terms: Vec<([u32; 3], f64)>, more: [u32; 3], c: f64| {
            terms.push((more, c));
            terms
        };
        let surfaces = [
            (3, with(cone(1.0), [3, 0, 0], 1.0)),
            (3, with(cone(-1.0), [1, 1, 1], 0.5)),
            (4, with(cone(1.0), [0, 0, 4], 1.0)),
            (3, vec![([1, 1, 0], 1.0), ([0, 0, 3], 1.0)]),
        ];
        let far = |by: Vec3| Affine::translation(by).unwrap();
        let mut tips = 0;
        for (seed, (order, terms)) in surfaces.iter().enumerate() {
            let surface = DynSurface::new(AlgebraicSurface::new(*order, &list(*order, terms)).unwrap());
            for i in 0..100 {
                let mut dice = laws::dice(900 + seed as u64, i);
                let there = dice.vector() * dice.pick(&[0.0, 1.0, 1e3, 1e6]);
                let maps = if i % 2 == 0 { [far(there), dice.map()] } else { [dice.map(), far(there)] };
                let placed =
                    maps.iter().fold(surface.clone(), |s, map| DynSurface::new(Placed::new(s, *map)));
                let node = maps.iter().fold(Point3::ORIGIN, |p, map| map.point(p));
                let origin = node - dice.vector() * 4.0;
                let ray = Ray::new(origin, node - origin);
                for root in all_roots(&placed, &ray) {
                    let point = placed.resolve(&LocalRay::new(&ray), &root, Need::ALL);
                    tips += u32::from(point.aside != Vec3::ZERO);
                    for (side, wanted) in [(RaySide::Front, Side::Out), (RaySide::Back, Side::In)] {
                        let start = point.spawn_from(side, dice.vector());
                        let found = placed.side(&LocalPoint::new(start.origin));
                        assert_eq!(found, wanted, "{seed} {i}: {side:?} {point:?}");
                    }
                }
            }
        }
        assert!(tips > 200, "{tips} tips");
    }

    /// x³ + y z² - 3 at z = 2^k, where the gradient, (3 x², z², 2 y z), leaves the range of f64 or
    /// its square does.
    #[test]
    fn normals_far_out_are_those_of_the_gradient() {
        let list = list(3, &[([3, 0, 0], 1.0), ([0, 1, 2], 1.0), ([0, 0, 0], -3.0)]);
        let surface = AlgebraicSurface::new(3, &list).unwrap();
        for k in [0, 100, 255, 256, 300, 500, 511, 512, 600, 1000] {
            let z = ldexp(1.0, k);
            let ray = Ray::new(Point3::new(1.0, 8.0, z), Vec3::new(0.0, -1.0, 0.0));
            let roots = all_roots(&surface, &ray);
            assert_eq!(roots.len(), 1, "z = 2^{k}");
            let normal = surface.resolve(&LocalRay::new(&ray), &roots[0], Need::POINT).ng.to_vec();
            // y = 2 / z², so the normal is that of (3 / z², 1, 4 / z³).
            let exact = Vec3::new(3.0 / z / z, 1.0, 4.0 / z / z / z);
            let exact = exact * (1.0 / exact.length());
            assert!((normal - exact).max_abs() <= 16.0 * f64::EPSILON, "z = 2^{k}: {normal:?}");
        }
    }

    /// The same, sheared and stretched: a normal goes along as the gradient does, not as a
    /// direction.
    #[test]
    fn normals_far_out_are_placed_as_gradients_are() {
        let list = list(3, &[([3, 0, 0], 1.0), ([0, 1, 2], 1.0), ([0, 0, 0], -3.0)]);
        let rows = [[2.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 4.0]];
        let map = Affine::new(rows, Point3::ORIGIN).unwrap();
        let surface = Placed::new(AlgebraicSurface::new(3, &list).unwrap(), map);
        for k in [0, 100, 255, 256, 300, 500] {
            let z = ldexp(1.0, k);
            let ray = Ray::new(map.point(Point3::new(1.0, 8.0, z)), map.vector(Vec3::new(0.0, -1.0, 0.0)));
            let roots = all_roots(&surface, &ray);
            assert_eq!(roots.len(), 1, "z = 2^{k}");
            let normal = surface.resolve(&LocalRay::new(&ray), &roots[0], Need::POINT).ng.to_vec();
            // The gradient of the local frame times the inverse.
            let local = Vec3::new(3.0 / z / z, 1.0, 4.0 / z / z / z);
            let inverse = map.inverse_linear();
            let column = |j: usize| (0..3).map(|i| inverse[i][j] * local[i]).sum::<f64>();
            let exact = Vec3::new(column(0), column(1), column(2));
            let exact = exact * (1.0 / exact.length());
            assert!((normal - exact).max_abs() <= 16.0 * f64::EPSILON, "z = 2^{k}: {normal:?} {exact:?}");
        }
    }

    /// A node, double lines, an order that is really lower, a quartic with singular points, a
    /// quintic, an octic.
    #[test]
    fn algebraic_surfaces_obey_the_laws() {
        let here = |p: [f64; 3]| Feature::new(p, [0.0; 3]);
        let at = |p: [f64; 3], d: [f64; 3]| Feature::new(p, d);
        // Cayley's: x² + y² - x² z + y² z + z² - 1, with four nodes.
        let cayley = list(
            3,
            &[
                ([2, 0, 0], 1.0),
                ([0, 2, 0], 1.0),
                ([2, 0, 1], -1.0),
                ([0, 2, 1], 1.0),
                ([0, 0, 2], 1.0),
                ([0, 0, 0], -1.0),
            ],
        );
        let nodes = [
            at([1.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
            at([-1.0, 0.0, 1.0], [2.0, 0.0, 0.0]),
            at([0.0, 1.0, -1.0], [0.0, 2.0, -2.0]),
            at([1.0, 0.0, 0.0], [0.0, 1.0, 1.0]),
        ];
        let (grazing, width) = obeys(3, &cayley, &nodes, 300);
        assert!(grazing > 0 && width < 48.0, "{grazing} {width}");
        // Steiner's Roman surface: x² y² + y² z² + z² x² - 2 x y z, three double lines.
        let steiner = list(4, &[([2, 2, 0], 1.0), ([0, 2, 2], 1.0), ([2, 0, 2], 1.0), ([1, 1, 1], -2.0)]);
        let lines = [
            at([0.0; 3], [1.0, 1.0, 1.0]),
            at([0.5, 0.0, 0.0], [0.0, 1.0, 0.0]),
            at([0.0, 0.0, 0.25], [1.0, 2.0, 0.0]),
            at([0.0, 0.5, 0.0], [0.0, 1.0, 0.0]),
        ];
        let (grazing, width) = obeys(4, &steiner, &lines, 300);
        assert!(grazing > 0 && width < 48.0, "{grazing} {width}");
        // A sphere of order 2 in a list of order 6, far larger than one.
        let mut ball =
            list(6, &[([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0), ([0, 0, 0], -81.0 * 1024.0)]);
        let on = [
            at([9.0 * 32.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            at([32.0, 128.0, 256.0], [4.0, -1.0, 0.0]),
            here([0.0; 3]),
        ];
        let (grazing, width) = obeys(6, &ball, &on, 200);
        assert!(grazing > 0 && width < 48.0, "{grazing} {width}");
        ball[0] = -1.0;
        obeys(6, &ball, &[here([0.0; 3])], 60);
        // The cushion x^8 + y^8 + z^8 = 1 and the Peninsula surface x² + y³ + z^5 - 1.
        let octic = list(8, &[([8, 0, 0], 1.0), ([0, 8, 0], 1.0), ([0, 0, 8], 1.0), ([0, 0, 0], -1.0)]);
        let flat = [
            at([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            at([0.0, -1.0, 0.0], [1.0, 0.0, 2.0]),
            here([0.5, 0.5, 0.5]),
        ];
        let (grazing, _) = obeys(8, &octic, &flat, 60);
        assert!(grazing > 0, "{grazing}");
        let peninsula = list(5, &[([2, 0, 0], 1.0), ([0, 3, 0], 1.0), ([0, 0, 5], 1.0), ([0, 0, 0], -1.0)]);
        obeys(
            5,
            &peninsula,
            &[at([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), at([0.0, 1.0, 0.0], [1.0, 0.0, 1.0])],
            60,
        );
    }

    #[test]
    fn an_order_of_sixteen_is_fine() {
        let high = list(16, &[([16, 0, 0], 1.0), ([0, 14, 2], -3.0), ([0, 0, 16], 2.0), ([0, 0, 0], -1.0)]);
        let surface = AlgebraicSurface::new(16, &high).unwrap();
        let ray = Ray::new(Point3::new(-3.0, 0.0, 0.0), Vec3::X);
        let found: Vec<_> = all_roots(&surface, &ray).iter().map(|r| (r.lo, r.hi, r.sign)).collect();
        assert!(
            matches!(found[..], [(a, b, -1), (c, d, 1)] if a <= 2.0 && b >= 2.0 && c <= 4.0 && d >= 4.0),
            "{found:?}"
        );
    }

    #[test]
    fn random_cubics_obey_the_laws() {
        for seed in 0..12 {
            let mut dice = TestRng::new(seed);
            let few = seed % 2 == 0;
            let k: Vec<f64> = (0..20)
                .map(|_| if few { dice.integer(-4, 4) } else { dice.between(-1.0, 1.0) * dice.scale(-8, 8) })
                .collect();
            if k[..19].iter().any(|&c| c != 0.0) {
                obeys(3, &k, &[here_is_anything(&mut dice)], 100);
            }
        }
    }

    fn here_is_anything(dice: &mut TestRng) -> Feature {
        Feature::new((dice.lattice(4) * 0.25).to_array(), [0.0; 3])
    }

    #[test]
    fn bad_numbers_are_named() {
        let new = AlgebraicSurface::new;
        assert_eq!(new(17, &[]), Err(AlgebraicError::Order(17)));
        assert_eq!(new(2, &[1.0]), Err(AlgebraicError::Count { order: 2, wanted: 10, found: 1 }));
        assert_eq!(new(1, &[0.0, 0.0, 0.0, 5.0]), Err(AlgebraicError::Constant));
        assert!(matches!(
            new(1, &[f64::NAN, 0.0, 0.0, 5.0]),
            Err(AlgebraicError::Coefficient { index: 0, .. })
        ));
    }
}

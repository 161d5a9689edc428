//! A surface placed by an affine map.
//!
//! The exact surface is `{ c + L x : x in S }`, with the surface's own numbers and the map's stored
//! ones. Rays go through the inverse, and every bracket includes its rounding; points are mapped
//! back by `L` itself.

use crate::packet::FilterSource;
use crate::point::least_step;
use crate::ray::through_inverse;
use crate::{
    Accelerate, HalfSpace, LocalPoint, LocalRay, Need, PartId, Root, Side, Sink, Solidity, Surface,
    SurfacePoint,
};
use durer_math::{Aabb, Affine, Interval, Isa, U, Vec3};

/// Covers results below the normal range.
const TINY: f64 = f64::MIN_POSITIVE;

/// The surface `S` placed by an invertible affine map.
#[derive(Clone, Debug)]
pub struct Placed<S> {
    surface: S,
    map: Affine,
}

impl<S: Surface> Placed<S> {
    /// `surface`, each of its points moved by `map`.
    pub fn new(surface: S, map: Affine) -> Self {
        Self { surface, map }
    }

    /// The surface in its own frame.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The map from the surface's frame.
    pub fn map(&self) -> &Affine {
        &self.map
    }
}

/// Surfaces placed by a map: `surface.placed(map)` is [`Placed::new`].
///
/// ```
/// use durer_math::{Affine, Point3, Vec3};
/// use durer_surfaces::{AxisBox, Place, Surface};
///
/// let block = AxisBox::new(Point3::ORIGIN, Point3::new(1.0, 2.0, 3.0))?;
/// let moved = block.placed(Affine::translation(Vec3::new(5.0, 0.0, 0.0))?);
/// assert_eq!(moved.bounds().min.x, 5.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Place: Surface + Sized {
    /// This surface, each of its points moved by `map`.
    fn placed(self, map: Affine) -> Placed<Self> {
        Placed::new(self, map)
    }
}

impl<S: Surface> Place for S {}

impl<S: Accelerate> Surface for Placed<S> {
    fn bounds(&self) -> Aabb {
        self.surface.bounds_through(&self.map)
    }

    #[inline(always)]
    fn roots<K: Sink + ?Sized>(&self, ray: &LocalRay<'_>, sink: &mut K) {
        self.surface.roots(&ray.through(&self.map), sink);
    }

    #[inline(always)]
    fn resolve(&self, ray: &LocalRay<'_>, root: &Root, need: Need) -> SurfacePoint {
        ray.resolve_through(&self.map, |local| self.surface.resolve(local, root, need))
    }

    fn solidity(&self) -> Solidity {
        self.surface.solidity()
    }

    #[inline(always)]
    fn side(&self, point: &LocalPoint<'_>) -> Side {
        self.surface.side(&point.through(&self.map))
    }
}

impl<S: Accelerate> Accelerate for Placed<S> {
    fn name(&self) -> &'static str {
        self.surface.name()
    }

    fn inner_bounds(&self) -> Aabb {
        inner_image(&self.map, &self.surface.inner_bounds())
    }

    fn half_space(&self) -> Option<HalfSpace> {
        Some(self.surface.half_space()?.through(&self.map))
    }

    fn packet_filter(&self, part: PartId) -> FilterSource {
        self.surface.packet_filter(part).placed(&self.map)
    }

    fn solid_packet_filter(&self) -> (FilterSource, Vec<PartId>) {
        let (sketch, parts) = self.surface.solid_packet_filter();
        (sketch.placed(&self.map), parts)
    }

    #[inline(always)]
    fn is_in_parts(&self) -> bool {
        self.surface.is_in_parts()
    }

    fn parts(&self, f: &mut dyn FnMut(Aabb, PartId)) {
        let mut n = 0;
        self.surface.parts(&mut |_, _| n += 1);
        if n == 1 {
            // The surface's own bound is the tighter one.
            self.surface.parts(&mut |_, id| f(self.bounds(), id));
        } else {
            self.surface.parts(&mut |b, id| f(self.map.bounds(&b), id));
        }
    }

    #[inline(always)]
    fn primitive_of(&self, part: PartId) -> u32 {
        self.surface.primitive_of(part)
    }

    #[inline(always)]
    fn part_roots<K: Sink + ?Sized>(&self, part: PartId, ray: &LocalRay<'_>, sink: &mut K) {
        self.surface.part_roots(part, &ray.through(&self.map), sink);
    }
}

/// A box within the image of a box, rounded inward; empty if the map turns the axes by other than
/// right angles.
fn inner_image(map: &Affine, inner: &Aabb) -> Aabb {
    let (linear, centre) = (map.linear(), map.centre());
    let mut image = Aabb::EMPTY;
    if inner.is_empty() {
        return image;
    }
    for i in 0..3 {
        let mut entries = (0..3).filter(|&j| linear[i][j] != 0.0);
        let (Some(j), None) = (entries.next(), entries.next()) else { return Aabb::EMPTY };
        let placed = |x: f64| match x.is_finite() {
            true => Interval::from(centre[i]) + Interval::from(linear[i][j]) * Interval::from(x),
            false => Interval::from(x * linear[i][j].signum()),
        };
        let (a, b) = (placed(inner.min[j]), placed(inner.max[j]));
        let (low, high) = if linear[i][j] > 0.0 { (a, b) } else { (b, a) };
        (image.min[i], image.max[i]) = (low.hi, high.lo);
    }
    if image.is_empty() { Aabb::EMPTY } else { image }
}

impl LocalRay<'_> {
    /// The image under `map` of the point that `resolve` finds on the ray in the surface's frame,
    /// with its bounds.
    ///
    /// Near a tip the frame may distinguish a point from the tip where the world's coordinates
    /// cannot. Rays then start from the tip, not from the tangent plane: the point is resolved
    /// again, on a ray with the error of those coordinates.
    pub fn resolve_through(
        &self,
        map: &Affine,
        mut resolve: impl FnMut(&LocalRay<'_>) -> SurfacePoint,
    ) -> SurfacePoint {
        let mut local = self.through(map);
        let (placed, room) = place(map, &resolve(&local));
        // A map within others does not widen a ray that one of them has widened.
        if room > 0.0 && !local.is_widened {
            local.is_widened = true;
            local.o_err += Vec3::new(room, room, room);
            let tip = resolve(&local);
            if tip.slack > 0.0 {
                return place(map, &tip).0;
            }
        }
        placed
    }
}

/// The image of a point of the surface, with its bounds, and the distance, in the surface's frame,
/// within which a tip may be: zero where the tangent plane proves the start.
#[inline(never)]
fn place(map: &Affine, local: &SurfacePoint) -> (SurfacePoint, f64) {
    Isa::detect().run(
        #[inline(always)]
        || place_here(map, local),
    )
}

#[inline(always)]
fn place_here(map: &Affine, local: &SurfacePoint) -> (SurfacePoint, f64) {
    let p_l = local.p.to_vec();
    let p = map.centre() + map.vector(p_l);
    let least = least_step(p);
    // |p - (c + L p_l)|: three roundings of the products' sums and one of the last sum.
    let rho = (map.linear_reach(p_l.abs()) * (3.0 * U) + p.to_vec().abs() * U) * (1.0 + 16.0 * U)
        + Vec3::new(least, least, least);
    let dp = (map.linear_reach(local.dp) + rho) * (1.0 + 4.0 * U);

    if local.bend == f64::INFINITY {
        return (place_tip(map, local, SurfacePoint::new(p, dp, 0.0, local.ng), rho), 0.0);
    }
    // Heights: a world displacement Δ changes the height over the local tangent plane by w·Δ, w =
    // L⁻ᵀ n.
    let n_l = local.ng.to_vec();
    let (w, e_w) = covector(map, n_l);
    let length = w.length();
    let ng = w * (1.0 / length);
    let reach = map.inverse_norm();
    let bend = local.bend * reach * reach;
    let (sure, slip) =
        (length * (1.0 - 8.0 * U) - (e_w.x + e_w.y + e_w.z), 4.0 * U * p.to_vec().length() + TINY);
    // What a start at this point costs when it goes through the inverse, so that its side is still
    // seen in f64.
    let offset = p - map.centre();
    let (_, e_back) = through_inverse(map, offset, offset.abs() * U);
    let stray = rho.length() + slip;
    let eta = local.off
        + w.abs().dot(rho)
        + (e_w.x + e_w.y + e_w.z) * stray
        + n_l.abs().dot(e_back) * 2.0
        + bend * stray * stray;
    let eta = eta * (1.0 + 32.0 * U);
    // off |w| - bend |L⁻¹|² off² >= η, with |L⁻¹ Δ|² <= 2 |L⁻¹|² (off² + stray²).
    let square = sure * sure - 4.0 * bend * eta;
    let (off, room) = if sure > 0.0 && square > 0.0 {
        (2.0 * eta / (sure + square.sqrt()), 0.0)
    } else {
        // The normal may turn by about one radian within 1 / bend, so a tip may be that near.
        let room = (reach * stray).max(1.0 / local.bend);
        ((4.0 * eta / bend.max(f64::MIN_POSITIVE)).sqrt().max(4.0 * eta / length), room)
    };
    let off = off * (1.0 + 32.0 * U) + TINY;

    let turned = |n: Vec3| {
        let m = covector(map, n).0;
        m * (1.0 / m.length())
    };
    let mut point = SurfacePoint::new(p, dp, off, ng.to_normal());
    point.ns = if local.ns == local.ng { point.ng } else { turned(local.ns.to_vec()).to_normal() };
    point.uv = local.uv;
    point.bend = bend / sure.max(f64::MIN_POSITIVE);
    if local.dpdu == Vec3::ZERO && local.dpdv == Vec3::ZERO {
        return (point, room);
    }
    point.dpdu = map.vector(local.dpdu);
    point.dpdv = map.vector(local.dpdv);
    let change = |dn: Vec3| {
        let m = covector(map, dn).0;
        (m - ng * ng.dot(m)) * (1.0 / length)
    };
    point.dndu = change(local.dndu);
    point.dndv = change(local.dndv);
    (point, room)
}

/// A tip: it has no tangent plane, so its normal goes along as a vector, and rays leave along it.
fn place_tip(map: &Affine, local: &SurfacePoint, mut point: SurfacePoint, rho: Vec3) -> SurfacePoint {
    let axis = map.vector(local.ng.to_vec());
    let length = axis.length();
    point.ng = (axis * (1.0 / length)).to_normal();
    point.ns = point.ng;
    // The start misses the one meant by rounding, in the world and of the axis; where that is more
    // than the tip allows, the way is longer by as much: f grows with its square.
    let reach = map.inverse_norm();
    let stray = rho.length() + 4.0 * U * point.p.to_vec().length() + 16.0 * U * map.linear_norm() * local.off;
    let factor = (reach * stray * (1.0 + 16.0 * U) / local.slack * 2.0).max(1.0);
    point.aside = map.vector(local.aside) * factor;
    point.off = local.off * length * factor * (1.0 + 32.0 * U) + TINY;
    point.bend = f64::INFINITY;
    point.slack = local.slack * factor / reach * 0.5;
    point.uv = local.uv;
    point.dpdu = map.vector(local.dpdu);
    point.dpdv = map.vector(local.dpdv);
    point
}

/// `L⁻ᵀ n` and a bound on its error.
#[inline(always)]
fn covector(map: &Affine, n: Vec3) -> (Vec3, Vec3) {
    let (m, e) = (map.inverse_linear(), map.inverse_error());
    let column = |i: usize| {
        let (c, s) = (Vec3::new(m[0][i], m[1][i], m[2][i]), Vec3::new(e[0][i], e[1][i], e[2][i]));
        // n itself is of unit length within 4 U.
        let err = (c.abs() * (8.0 * U) + s).dot(n.abs()) * (1.0 + 16.0 * U);
        (c.dot(n), err)
    };
    let ((x, ex), (y, ey), (z, ez)) = (column(0), column(1), column(2));
    (Vec3::new(x, y, z), Vec3::new(ex, ey, ez))
}

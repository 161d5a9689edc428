//! Hit points of eight rays, and how far spawned rays start from them.

use super::kernel::FacePoints;
use super::local_frame::dot;
use super::quadric::{FaceKind, taxicab};
use super::rays::{NEVER, RayLanes, SLACK};
use super::skin::{Skin, Slant};
use super::{PacketFilter, quadric};
use durer_math::{F8, M8, Point3, U, Vec3};

/// Where hit points are stored, with the fields of a [`SurfacePoint`](crate::SurfacePoint) that
/// pictures need; see there for their meaning.
#[derive(Debug)]
pub struct Points8<'a> {
    /// The points.
    pub p: &'a mut Point3<F8>,
    /// Unit geometric normals.
    pub ng: &'a mut Vec3<F8>,
    /// Unit shading normals.
    pub ns: &'a mut Vec3<F8>,
    /// A distance along the normal that certainly leaves the surface.
    pub off: &'a mut F8,
}

#[inline(always)]
fn times(v: Vec3<F8>, k: F8) -> Vec3<F8> {
    Vec3::new(v.x * k, v.y * k, v.z * k)
}

impl PacketFilter {
    /// Stores the points at `t` on face `i` for some lanes, from the data in
    /// [`Nearest`](super::Nearest), moved onto the face by one step of Newton's method. Returns the
    /// lanes for which everything is proven; the others must use the surface itself.
    ///
    /// With `|f(p)| <= η`, gradient `G` and `|Hessian| <= h`, a start at `p ± off n + τ` has
    /// `|f| >= off |G| - h (off² + |τ|²) - η`. Where `x = 4 h η / |G|²` is small,
    /// `off = η (1 + x) / |G|` is enough, since `1 - √(1 - x) <= x`. `G` is rounded: its own
    /// relative error, which may be large for slivers and near tips, must be as small as `x`. As in
    /// the scalar kernels `η` includes twice the error of `f`, so that rays from there know on
    /// which side they start.
    #[inline(never)]
    pub fn points(
        &self,
        i: usize,
        rays: &RayLanes<'_>,
        (t, tag): (&F8, &F8),
        lanes: &M8,
        points: Points8<'_>,
    ) -> M8 {
        rays.isa.run_in_lanes(
            #[inline(always)]
            || self.points_here(i, rays, (*t, *tag), *lanes, points),
        )
    }

    #[inline(always)]
    fn points_here(
        &self,
        i: usize,
        rays: &RayLanes<'_>,
        (t, tag): (F8, F8),
        lanes: M8,
        to: Points8<'_>,
    ) -> M8 {
        let first = self.first_face();
        if let Some(detail) = &self.detail
            && (i == 0 || first == 0)
        {
            let at = |h| FacePoints { face: i, tag, h, h1: taxicab(h) * SLACK };
            return self.put_points(
                rays,
                (t, lanes),
                to,
                #[inline(always)]
                |y| {
                    let mut slant = Slant { f: F8::ZERO, half: y };
                    detail.kernel.slant(rays.isa, &detail.own, &at(y), &mut slant);
                    slant
                },
                #[inline(always)]
                |y| {
                    let mut skin = Skin::NONE;
                    detail.kernel.skin(rays.isa, &detail.own, &at(y), &mut skin);
                    skin
                },
                #[inline(always)]
                |y, ng| {
                    let mut g = y;
                    match detail.kernel.shading(rays.isa, &detail.own, &mut g) {
                        true => shaded_by(g, ng, self.turned),
                        false => ng,
                    }
                },
            );
        }
        let face: &quadric::QuadricFace8 = &self.faces[(i - first).min(self.faces.len() - 1)];
        let normals = self.normals.as_deref().filter(|_| face.kind == FaceKind::Plane);
        self.put_points(
            rays,
            (t, lanes),
            to,
            #[inline(always)]
            |y| {
                let (f, half) = face.value_and_half_gradient(y);
                Slant { f, half }
            },
            #[inline(always)]
            |y| {
                let (f, half) = face.value_and_half_gradient(y);
                let y1 = taxicab(y);
                let (_, e_f) = face.at(y, y1, F8::ZERO);
                Skin {
                    f,
                    half,
                    e_f,
                    e_half: face.gradient_error(y1),
                    bend: F8::splat(face.bend),
                    room: NEVER,
                }
            },
            #[inline(always)]
            |y, ng| match normals {
                Some(normals) => shading_normal(normals, y, ng),
                None => ng,
            },
        )
    }

    #[inline(always)]
    fn put_points(
        &self,
        rays: &RayLanes<'_>,
        (t, lanes): (F8, M8),
        to: Points8<'_>,
        slant: impl Fn(Vec3<F8>) -> Slant,
        skin: impl Fn(Vec3<F8>) -> Skin,
        shade: impl Fn(Vec3<F8>, Vec3<F8>) -> Vec3<F8>,
    ) -> M8 {
        /// The greatest `x` that counts as small.
        const SMALL: f64 = 1.0 / (1u64 << 20) as f64;
        let c = self.centre;
        let (o, d) = (rays.origin, rays.direction);
        let h = Vec3::new(o.x - c.x, o.y - c.y, o.z - c.z);
        let y = Vec3::new(t.mul_add(d.x, h.x), t.mul_add(d.y, h.y), t.mul_add(d.z, h.z));
        let Slant { f, half: g } = slant(y);
        let step = f * 0.5 / dot(g, g);
        let y = Vec3::new(y.x - g.x * step, y.y - g.y * step, y.z - g.z * step);
        // The world's coordinates, and the coordinates relative to the centre again, with an error
        // of `U |y|` that the bounds of a face include.
        let p = Point3::new(y.x + c.x, y.y + c.y, y.z + c.z);
        let y = Vec3::new(p.x - c.x, p.y - c.y, p.z - c.z);
        let Skin { f, half: g, e_f, e_half, bend, room } = skin(y);
        let length = dot(g, g).sqrt();
        let gradient = length * 2.0;
        // A start is rounded at the size of `p`; `start_towards` steps that much further.
        let tau = taxicab(p.to_vec()) * (4.0 * U);
        let eta = f.abs() + e_f * 2.0 + tau * tau * (bend * 2.0);
        let x = eta * (bend * 4.0) / (gradient * gradient);
        let least =
            p.x.abs().max(p.y.abs()).max(p.z.abs()) * durer_math::scale::pow2(-500) + f64::MIN_POSITIVE;
        let off = eta / gradient * (1.0 + 2.0 * SMALL) + least;
        let mut inverse = F8::ONE / length;
        if self.turned {
            inverse = -inverse;
        }
        let ng = times(g, inverse);
        let ns = shade(y, ng);
        let ordinary = off.lt(F8::splat(f64::MAX)) & dot(ns, ns).gt(F8::splat(0.5));
        // The error of the gradient is at most √3 that of its entries.
        let steady = (e_half * (2.0 / SMALL)).le(length);
        let near = (off + tau).le(room);
        let sure = lanes & x.le(F8::splat(SMALL)) & steady & ordinary & near;
        to.p.x.set_where(sure, p.x);
        to.p.y.set_where(sure, p.y);
        to.p.z.set_where(sure, p.z);
        to.ng.set_where(sure, ng);
        to.ns.set_where(sure, ns);
        to.off.set_where(sure, off);
        sure
    }
}

/// A covector as a unit shading normal if it is on the side of `ng`; otherwise `ng`.
#[inline(always)]
fn shaded_by(g: Vec3<F8>, ng: Vec3<F8>, turned: bool) -> Vec3<F8> {
    let size = super::local_frame::largest(g);
    let g = times(g, F8::splat(if turned { -1.0 } else { 1.0 }) / size);
    let n = times(g, F8::ONE / dot(g, g).sqrt());
    dot(n, ng).gt(F8::ZERO).select3(n, ng)
}

/// The interpolated normal, of length one, on the side of `ng`.
#[inline(always)]
fn shading_normal(normals: &[Vec3; 4], y: Vec3<F8>, ng: Vec3<F8>) -> Vec3<F8> {
    let [n, nx, ny, nz] = Vec3::splats(*normals);
    let axis = |n: F8, x: F8, dy: F8, z: F8| x.mul_add(y.x, dy.mul_add(y.y, z.mul_add(y.z, n)));
    let n = Vec3::new(axis(n.x, nx.x, ny.x, nz.x), axis(n.y, nx.y, ny.y, nz.y), axis(n.z, nx.z, ny.z, nz.z));
    let inverse = F8::ONE / dot(n, n).sqrt();
    times(n, inverse.copysign(dot(n, ng)))
}

//! The packet kernel of blobs. Along a ray the fields begin and end, and between two such places
//! the sum is a polynomial of degree four.
//!
//! ```text
//!   f(y) = T - Σ S max(0, 1 - q)²      negative inside
//!
//!   w = W (y - m),   q = |w|² of a ball, |(w_x, w_y, w_z - clamp(w_z, 0, l))|² of a cylinder
//! ```
//!
//! `blob/component.rs` defines the letters and their errors. The errors here are bounded in the
//! same way, for eight rays (`rays.rs`) or eight points at a time.

mod groups;
mod rays;

use self::groups::{Group, groups};
use crate::packet::local_frame::{Own, dot, largest};
use crate::packet::rays::{NEVER, SLACK};
use crate::packet::skin::Skin;
use durer_math::scale::pow2;
use durer_math::{Aabb, F8, U, Vec3};

/// Covers results below the normal range.
const TINY: f64 = pow2(-500);
/// The bounds on second derivatives at a point hold where `q` has changed by no more than this.
const ROOM: f64 = pow2(-10);

/// The largest number of components; see [`Fields::new`]. Compared with single rays, packets take
/// nine tenths of the time with 256 components and eleven tenths with 512 (docs/performance.md).
const MOST: usize = 256;

/// One component: a term of the sum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// `W`, the largest sum of magnitudes in one of its rows, and a bound on the errors of its
    /// entries.
    pub(crate) rows: [Vec3; 3],
    pub(crate) size: f64,
    pub(crate) size_err: f64,
    /// `m`, and its error along any axis.
    pub(crate) centre: Vec3,
    pub(crate) centre_err: f64,
    /// The length of the axis; zero for a ball.
    pub(crate) length: f64,
    pub(crate) strength: f64,
    /// An upper bound of the norm of the field's second derivatives.
    pub(crate) bend: f64,
}

/// All components of a blob.
#[derive(Clone, Debug)]
pub(crate) struct Fields {
    fields: Box<[Field]>,
    groups: Box<[Group]>,
    /// The sum of the magnitudes of the strengths.
    strength: f64,
    threshold: f64,
}

impl Fields {
    /// The kernel for these fields and their bounding boxes. Neighbours in the list must be
    /// neighbours in space. `None` if there are so many fields that single rays are faster.
    pub(crate) fn new(fields: Vec<Field>, boxes: &[Aabb], threshold: f64) -> Option<Self> {
        if fields.len() > MOST || fields.len() != boxes.len() {
            return None;
        }
        let strength = fields.iter().map(|f| f.strength.abs()).sum();
        Some(Self { fields: fields.into(), groups: groups(boxes), strength, threshold })
    }

    /// `f` and its gradient at points that are known within `e`, in these coordinates.
    #[inline(always)]
    fn at(&self, y: Vec3<F8>, e: F8) -> Skin {
        let zero = F8::ZERO;
        let (mut f, mut error) = (F8::splat(self.threshold), zero);
        let mut g = Vec3::new(zero, zero, zero);
        let (mut error_g, mut bend) = (zero, zero);
        let own = largest(y);
        let mut i = 0;
        while let Some(Group { centre, radius, fields, next }) = self.groups.get(i) {
            let m = Vec3::splat(*centre);
            let z = Vec3::new(y.x - m.x, y.y - m.y, y.z - m.z);
            // The second derivatives must also hold in a small margin around a field.
            let reach = e * 2.0 + (own + centre.max_abs()) * (4.0 * U) + radius * (1.0 + ROOM);
            if dot(z, z).gt(reach * reach * SLACK).all() {
                i = *next;
                continue;
            }
            i += 1;
            for field in &self.fields[fields.clone()] {
                let m = Vec3::splat(field.centre);
                let z = Vec3::new(y.x - m.x, y.y - m.y, y.z - m.z);
                let mut w = field.turned(z);
                if field.length > 0.0 {
                    w.z = w.z.min(zero) + (w.z - field.length).max(zero);
                }
                let e_w = (e + field.centre_err + (own + field.centre.max_abs()) * U) * field.size
                    + largest(z) * (field.size_err + field.size * (4.0 * U))
                    + field.length * (8.0 * U)
                    + TINY;
                let q = dot(w, w);
                let e_q =
                    ((w.x.abs() + w.y.abs() + w.z.abs()) * 2.0 + e_w * 3.0) * e_w + (q + 1.0) * (8.0 * U);
                let left = (F8::ONE - q).max(zero);
                let near = (q - e_q).lt(F8::splat(1.0 + ROOM));
                let strength = field.strength.abs();
                f = f - left * left * field.strength;
                error += near.keep(((left * 2.0 + e_q) * e_q + left * left * (4.0 * U)) * strength);
                let by = left * (2.0 * field.strength);
                let [a, b, c] = Vec3::splats(field.rows);
                g.x += by * a.x.mul_add(w.x, b.x.mul_add(w.y, c.x * w.z));
                g.y += by * a.y.mul_add(w.x, b.y.mul_add(w.y, c.y * w.z));
                g.z += by * a.z.mul_add(w.x, b.z.mul_add(w.y, c.z * w.z));
                error_g += near.keep((e_q + e_w * 2.0 + 8.0 * U) * (6.0 * strength * field.size));
                bend += near.keep(F8::splat(field.bend));
            }
        }
        let count = self.fields.len() as f64 + 4.0;
        let rounding = count * U * (self.threshold + self.strength);
        let (e_f, e_half) = ((error + rounding + TINY) * SLACK, error_g * SLACK + rounding);
        Skin { f, half: g, e_f, e_half, bend: bend * SLACK, room: NEVER }
    }

    /// `f` and its gradient at points `h` of the surface, with `|h|₁`.
    #[inline(always)]
    fn skin(&self, own: &Own, h: Vec3<F8>, h1: F8) -> Skin {
        let y = own.point(h);
        // For rays that start there, the kernel begins at a place that may be this far from the
        // start (`rays.rs`).
        let e = own.point_error(h1) + (largest(y) + 1.0) * (128.0 * U);
        let Skin { f, half, e_f, e_half, bend, room } = self.at(y, e);
        let e_half = (e_half + largest(half) * (16.0 * U)) * own.norm;
        let bend = bend * (own.norm * own.norm * SLACK);
        // Doubled, so that rays that start there are certain of their side.
        Skin { f, half: own.covector(half), e_f: e_f * 2.0, e_half, bend, room }
    }
}

impl Field {
    /// `W v`.
    #[inline(always)]
    fn turned(&self, v: Vec3<F8>) -> Vec3<F8> {
        let [a, b, c] = Vec3::splats(self.rows);
        Vec3::new(dot(a, v), dot(b, v), dot(c, v))
    }
}

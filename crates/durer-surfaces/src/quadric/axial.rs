//! Quadrics in canonical position: centre or vertex at the origin, axis along z. Each is whole, or
//! clipped to `from <= z <= to`.
//!
//! A clipped quadric is a solid with flat ends or, if it is open, the wall alone. Each surface
//! defines its polynomial ([`Wall`]) in its own file.

use crate::faces::boolean_faces::QuadricFaces;
use crate::faces::chart::{Chart, Frame, Tip, length, sheared};
use crate::faces::form::Form;
use crate::quadric::solid::QuadricSolid;
use durer_math::eft::{exponent, scale2};
use durer_math::{Aabb, Affine, EFloat, Point3, Ring, U, Vec3, elementary};

/// Covers results below the normal range.
const TINY: f64 = f64::from_bits(16);

/// A canonical quadric, as a surface.
pub type Axial<W> = QuadricSolid<AxialShape<W>>;

/// The wall of a canonical quadric.
pub trait Wall: Clone + Copy + core::fmt::Debug + PartialEq + Send + Sync {
    /// The name of the surface.
    const NAME: &'static str;

    /// The polynomial in `y` with `x = 2^k y`, negative inside.
    fn form<T: Ring>(&self, k: i32) -> Form<T>;

    /// The approximate size of the shape.
    fn size(&self) -> f64;

    /// Upper bounds of `|x|` and `|y|` where `z` is in a range.
    fn half_widths(&self, z: [f64; 2]) -> [f64; 2];

    /// The range of `z` on the whole solid.
    fn heights(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Surface coordinates at `x` (in the wall's own frame), where the unit normal is `n`. `ends`
    /// is the range of `z`, `None` for the whole surface.
    fn chart(&self, x: Vec3, n: Vec3, ends: Option<[f64; 2]>) -> Chart;

    /// Whether there is a tip at the origin.
    fn has_tip(&self) -> bool {
        false
    }
}

/// A wall, with the range of `z` to which it is clipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialShape<W> {
    wall: W,
    ends: Option<[f64; 2]>,
    open: bool,
    frame: Frame,
}

/// Why a canonical quadric cannot exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AxialError {
    /// A semi-axis is zero, negative, infinite or NaN.
    #[error("{surface}: {name} must be finite and positive, got {value}")]
    SemiAxis {
        /// The surface.
        surface: &'static str,
        /// The semi-axis.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The ends are not finite or not in order.
    #[error("the ends must be finite and the first below the second, got from {from} to {to}")]
    Ends {
        /// The lower end.
        from: f64,
        /// The upper end.
        to: f64,
    },
}

/// Refuses semi-axes that are not finite and positive.
pub(crate) fn positive<const N: usize>(
    surface: &'static str,
    axes: [(&'static str, f64); N],
) -> Result<(), AxialError> {
    match axes.into_iter().find(|(_, x)| !(x.is_finite() && *x > 0.0)) {
        Some((name, value)) => Err(AxialError::SemiAxis { surface, name, value }),
        None => Ok(()),
    }
}

impl<W: Wall> Axial<W> {
    /// The whole surface.
    pub(crate) fn whole(wall: W) -> Self {
        Self::of(AxialShape::new(wall, None, false))
    }

    /// The wall, with the semi-axes that were given.
    pub fn wall(&self) -> W {
        self.shape().wall
    }

    /// The solid between the planes `z = from` and `z = to`, with flat ends (faces 1 and 2).
    pub fn between(&self, from: f64, to: f64) -> Result<Self, AxialError> {
        self.cut(from, to, false)
    }

    /// The wall between the planes `z = from` and `z = to`, rims included.
    pub fn open_between(&self, from: f64, to: f64) -> Result<Self, AxialError> {
        self.cut(from, to, true)
    }

    fn cut(&self, from: f64, to: f64, open: bool) -> Result<Self, AxialError> {
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(AxialError::Ends { from, to });
        }
        Ok(Self::of(AxialShape::new(self.wall(), Some([from, to]), open)))
    }
}

impl<W: Wall> AxialShape<W> {
    fn new(wall: W, ends: Option<[f64; 2]>, open: bool) -> Self {
        let origin = Frame { centre: Point3::ORIGIN, scale: 0, reach: f64::INFINITY };
        let mut shape = Self { wall, ends, open, frame: origin };
        let bounds = shape.bounds();
        // Any centre and unit are correct; these are near the middle and close to the size.
        let z = ends.map_or(0.0, |[from, to]| 0.5 * from + 0.5 * to);
        let centre = Point3::new(0.0, 0.0, z);
        let reach = if bounds.is_bounded() { bounds.reach_from(centre) } else { f64::INFINITY };
        let size = if reach < f64::INFINITY { reach } else { wall.size() };
        let scale = exponent(size).clamp(-1000, 1000);
        shape.frame = Frame { centre, scale, reach: scale2(reach, -scale) * (1.0 + 4.0 * U) };
        shape
    }
}

impl<W: Wall> QuadricFaces for AxialShape<W> {
    fn name(&self) -> &'static str {
        W::NAME
    }

    fn frame(&self) -> Frame {
        self.frame
    }

    fn faces(&self) -> usize {
        if self.ends.is_some() { 3 } else { 1 }
    }

    fn walls(&self) -> usize {
        if self.open { 1 } else { self.faces() }
    }

    #[inline(always)]
    fn form<T: Ring>(&self, face: usize) -> Form<T> {
        let (z, k) = (self.frame.centre.z, self.frame.scale);
        let unit = |x: f64| T::exact(x).scale2(-k);
        match (face, self.ends) {
            (1, Some([from, _])) => Form::half_space([0.0, 0.0, -1.0].map(T::exact), unit(from) - unit(z)),
            (2, Some([_, to])) => Form::half_space([0.0, 0.0, 1.0].map(T::exact), unit(z) - unit(to)),
            _ => self.wall.form::<T>(k).seen_from(&[T::exact(0.0), T::exact(0.0), unit(z)]),
        }
    }

    fn bounds(&self) -> Aabb {
        let [low, high] = self.wall.heights();
        let [from, to] = self.ends.unwrap_or([low, high]);
        let z = [from.max(low), to.min(high)];
        let [x, y] = self.wall.half_widths(z);
        Aabb::new(Point3::new(-x, -y, z[0]), Point3::new(x, y, z[1]))
    }

    fn bounds_through(&self, map: &Affine) -> Aabb {
        let [low, high] = self.wall.heights();
        if self.ends.is_some() || !(low.is_finite() && high.is_finite()) {
            return map.bounds(&self.bounds());
        }
        // An ellipsoid: its half-widths are the lengths of the rows of L diag(a, b, c).
        let [a, b] = self.wall.half_widths([low, high]);
        let rows = map.linear().map(|[x, y, z]| length([x * a, y * b, z * high]) * (1.0 + 8.0 * U) + TINY);
        Aabb::centred(map.centre(), Vec3::from(rows))
    }

    fn chart(&self, face: usize, y: Vec3, n: Vec3) -> Chart {
        let (z, k) = (self.frame.centre.z, self.frame.scale);
        let x = y.map(|y| scale2(y, k)) + Vec3::new(0.0, 0.0, z);
        let chart = if face == 0 {
            self.wall.chart(x, n, self.ends)
        } else {
            Chart { uv: [x.x, x.y], dpdu: Vec3::X, dpdv: Vec3::Y }
        };
        Chart { dpdu: chart.dpdu.map(|d| scale2(d, -k)), dpdv: chart.dpdv.map(|d| scale2(d, -k)), ..chart }
    }

    fn tip(&self, face: usize) -> Option<Tip> {
        let [from, to] = self.ends.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let holds_origin = from <= 0.0 && to >= 0.0;
        // If the piece starts at the tip, it ends there: the outside is below.
        let normal = if from == 0.0 { -Vec3::Z } else { Vec3::Z };
        let is_double = from < 0.0 && to > 0.0;
        (face == 0 && self.wall.has_tip() && holds_origin).then_some(Tip { normal, is_double })
    }
}

/// An upper bound of `a √f(z²/c²)` for increasing `f`, where `z` is in a range: `f` is evaluated at
/// the larger `z²/c²`.
pub(crate) fn widest(axes: [f64; 2], z: [f64; 2], c: f64, f: impl Fn(EFloat) -> EFloat) -> [f64; 2] {
    let z = z[0].abs().max(z[1].abs());
    if z == f64::INFINITY {
        return [f64::INFINITY; 2];
    }
    let ratio = EFloat::exact(z) / EFloat::exact(c);
    let root = f(ratio * ratio).sqrt();
    axes.map(|a| (EFloat::exact(a) * root).hi())
}

/// `u` around the axis, by the angle of the ellipse with semi-axes `a`, `b`, counted from x; `v`
/// along z, from 0 to 1 over a piece.
pub(crate) fn around(x: Vec3, n: Vec3, a: f64, b: f64, ends: Option<[f64; 2]>) -> Chart {
    const TURN: f64 = 2.0 * core::f64::consts::PI;
    let phi = elementary::atan2(x.y / b, x.x / a);
    let u = if phi < 0.0 { phi / TURN + 1.0 } else { phi / TURN };
    let (from, height) = ends.map_or((0.0, 1.0), |[from, to]| (from, to - from));
    let radial = Vec3::new(x.x, x.y, 0.0);
    let ahead = Vec3::new(-x.y * (a / b), x.x * (b / a), 0.0) * TURN;
    // On the axis the angle is undefined.
    let ahead = if ahead == Vec3::ZERO { Vec3::Y } else { ahead };
    let radial = if radial == Vec3::ZERO { Vec3::X } else { radial };
    Chart {
        uv: [u, (x.z - from) / height],
        dpdu: sheared(ahead, radial, n),
        dpdv: sheared(Vec3::Z * height, radial, n),
    }
}

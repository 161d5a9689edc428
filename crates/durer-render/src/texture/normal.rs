//! Perturbed normals, which make a surface look bumpy.
//!
//! In the space of its pattern, a point's unit normal `n` becomes
//!
//! ```text
//!   n - 2/15 a grad h      for a landscape with heights h and the factor a,
//!   n + a v                for a vector v,
//!   n - a (dx e + dy e x n)  for the differences of a picture's values to the right and up,
//! ```
//!
//! where `e` is the unit vector along `(-n_z, 0, n_x)`, or `x` if that is zero,
//!
//! and is then scaled to length 1. The gradient is estimated from the heights at the four corners of
//! a regular tetrahedron around the point.

use durer_math::{Affine, AffineError, F8, M8, Matrix3, Point3, Vec3};
use durer_scene::{Height, ImageValue, Normal, NormalBody};

use super::field::Pusher;
use super::lookup::Lookup;
use super::place::{Place, placement_before, warps_of};
use super::{Around, Around8, Blend, Picture, Shown};
use crate::vector::{length, unit};

/// A [`Normal`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RenderNormal {
    place: Place,
    /// From normals around it to those of its space, and back; `None` if they are the same.
    turn: Option<Box<(Matrix3, Matrix3)>>,
    keeps_slope: bool,
    /// From normals of the world to those of the texture around it, if bumps keep their slope. Only the
    /// scale within that texture counts, on a chart only its own (facts of the scene language).
    outer: Option<Box<Matrix3>>,
    body: Body,
}

#[derive(Clone, Debug, PartialEq)]
enum Body {
    Height(Box<Landscape>),
    Push(Pusher, f64),
    Picture(Picture, ImageValue, f64),
    Normals(Box<Blend<RenderNormal>>),
}

#[derive(Clone, Debug, PartialEq)]
struct Landscape {
    lookup: Lookup,
    slopes: Box<[(f64, [f64; 2])]>,
    amount: f64,
    accuracy: f64,
}

/// The factor of a landscape's slopes (a fact of the scene language).
const DEPTH: f64 = 2.0 / 15.0;

/// The corners of a regular tetrahedron at the distance 1 from its centre. The scene language's
/// stands like this.
const CORNERS: [[f64; 3]; 4] = {
    const A: f64 = 0.942_809_041_582_063_4; // 2 sqrt(2)/3
    const B: f64 = 0.816_496_580_927_726; // sqrt(2/3)
    const C: f64 = 1.0 / 3.0;
    [[A, -C, 0.0], [0.0, 1.0, 0.0], [-0.5 * A, -C, B], [-0.5 * A, -C, -B]]
};

impl RenderNormal {
    /// Prepares a normal that is placed by `around`; that space is placed in the world by `outer`.
    pub(crate) fn new(normal: &Normal, around: &Affine, outer: &Affine) -> Result<Self, AffineError> {
        let on_chart = normal.on_chart;
        let own = *normal.placement.affine();
        let local = if on_chart { own } else { own.then(around)? };
        let before = placement_before(match &normal.body {
            NormalBody::Height(height) => &height.warps,
            NormalBody::Push { warps, .. } | NormalBody::Picture { warps, .. } => warps,
            NormalBody::Normals(pattern) => warps_of(pattern),
        })?;
        // A normal on a chart is turned with its pattern, but not with what the pattern is part of, unless
        // its whole texture is on the chart (a fact of the scene language).
        let (turn, outer) = match &normal.turn {
            Some(turn) => {
                let turn = turn.affine().then(around)?.then(outer)?;
                let outer = own.inverted()?.then(&turn)?;
                (turn, outer)
            }
            None if on_chart => (own, Affine::IDENTITY),
            None => (local.then(outer)?, *outer),
        };
        let outer = (normal.keeps_slope && outer.as_translation().is_none())
            .then(|| Box::new(transposed(&outer.linear())));
        let turn = before.then(&turn)?;
        let turn = turn.as_translation().is_none().then(|| {
            let (linear, inverse) = (turn.linear(), turn.inverse_linear());
            Box::new((transposed(&linear), transposed(&inverse)))
        });
        let (place, body) = match &normal.body {
            NormalBody::Height(height) => {
                let Height { warps, value, slopes, amount, accuracy } = &**height;
                let landscape = Landscape {
                    lookup: Lookup::new(value)?,
                    slopes: slopes.clone().into(),
                    amount: *amount,
                    accuracy: *accuracy,
                };
                (Place::through(&local, warps), Body::Height(Box::new(landscape)))
            }
            NormalBody::Push { warps, push, amount } => {
                (Place::through(&local, warps), Body::Push(Pusher::new(push), *amount))
            }
            NormalBody::Picture { warps, map, value, amount } => {
                (Place::through(&local, warps), Body::Picture(Picture::new(map), *value, *amount))
            }
            NormalBody::Normals(pattern) => {
                let blend = Blend::new(pattern, |n| Self::new(n, &Affine::IDENTITY, &Affine::IDENTITY))?;
                (Place::warped(&local, pattern), Body::Normals(Box::new(blend)))
            }
        };
        Ok(Self { place: place.on_chart(on_chart), turn, keeps_slope: normal.keeps_slope, outer, body })
    }

    /// The unit normals at some points, perturbed from those around.
    pub(crate) fn perturbed(&self, p: Point3<F8>, around: &Around8, live: M8) -> Vec3<F8> {
        let n = around.normals;
        let mut all = n;
        for i in live.lanes() {
            all.set_lane(i, self.at(p.to_vec().lane(i).to_point(), n.lane(i), around.lane(i)));
        }
        all
    }

    /// The unit normal at a point, perturbed from the unit normal `n`.
    fn at(&self, p: Point3, n: Vec3, around: Around) -> Vec3 {
        unit(self.bent(p, n, around))
    }

    /// The normal at a point, perturbed from `n`. Bumps that keep their slope leave it as long as it
    /// becomes, which counts where normals are mixed (a fact of the scene language).
    fn bent(&self, p: Point3, n: Vec3, around: Around) -> Vec3 {
        let p = self.place.inside(p, around);
        let mut own = match &self.turn {
            None => n,
            Some(turn) => times(&turn.0, n),
        };
        if !self.keeps_slope {
            own = unit(own);
        } else if let Some(outer) = &self.outer {
            own = own * (1.0 / length(times(outer, n)));
        }
        let moved = match &self.body {
            Body::Height(landscape) => own - landscape.gradient(p, around) * (DEPTH * landscape.amount),
            Body::Push(pusher, amount) => own + pusher.vector(p, own) * *amount,
            Body::Picture(picture, value, amount) => {
                let [dx, dy] = picture.differences(p, *value);
                let (right, up) = sides(unit(own));
                own - (right * dx + up * dy) * *amount
            }
            Body::Normals(blend) => match blend.at(p, around) {
                Some(Shown::One(i)) => blend.entry(i).bent(p, own, around),
                Some(Shown::Two(i, k)) => {
                    let (before, after) = (blend.entry(i - 1), blend.entry(i));
                    before.bent(p, own, around) * (1.0 - k) + after.bent(p, own, around) * k
                }
                Some(Shown::Each) => (0..blend.len()).fold(Vec3::ZERO, |sum, i| {
                    sum + blend.entry(i).bent(p, own, around) * blend.part(Shown::Each, i)
                }),
                None => own,
            },
        };
        let turned = match &self.turn {
            None => moved,
            Some(turn) => times(&turn.1, moved),
        };
        if self.keeps_slope { turned } else { unit(turned) }
    }
}

impl Landscape {
    /// The gradient of the heights at a point.
    fn gradient(&self, p: Point3, at: Around) -> Vec3 {
        let mut around = Vec3::<F8>::splat(p.to_vec());
        let corner = |i: usize| Vec3::new(CORNERS[i][0], CORNERS[i][1], CORNERS[i][2]);
        for i in 0..4 {
            around.set_lane(i, p.to_vec() + corner(i) * self.accuracy);
        }
        let values = self.lookup.values(around.to_point(), &at.everywhere(), M8::first(4));
        let sum = (0..4).fold(Vec3::ZERO, |sum, i| sum + corner(i) * self.bent(values.0[i]));
        // The products of the corners with themselves add up to 4/3 of the identity.
        sum * (0.75 / self.accuracy)
    }

    /// The height for a value: between two entries of the slope map, the cubic with their heights
    /// and slopes. Slopes are relative to the distance of the entries (a fact of the scene language).
    fn bent(&self, w: f64) -> f64 {
        let (Some(first), Some(last)) = (self.slopes.first(), self.slopes.last()) else { return w };
        if w >= last.0 {
            return last.1[0];
        }
        let Some(i) = self.slopes.iter().position(|(at, _)| w <= *at).filter(|i| *i > 0) else {
            return first.1[0];
        };
        let ((from, [low, start]), (to, [high, end])) = (self.slopes[i - 1], self.slopes[i]);
        let width = to - from;
        if width <= 0.0 {
            return high;
        }
        let t = (w - from) / width;
        let rise = high - low;
        low + t * (start + t * (3.0 * rise - 2.0 * start - end + t * (start + end - 2.0 * rise)))
    }
}

/// The directions to the right and upward of a picture's bumps on a surface with the unit normal `n`
/// (a fact of the scene language).
fn sides(n: Vec3) -> (Vec3, Vec3) {
    let level = Vec3::new(-n.z, 0.0, n.x);
    let right = if level == Vec3::ZERO { Vec3::X } else { unit(level) };
    (right, right.cross(n))
}

fn times(m: &Matrix3, v: Vec3) -> Vec3 {
    let row = |r: &[f64; 3]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
    Vec3::new(row(&m[0]), row(&m[1]), row(&m[2]))
}

fn transposed(m: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| m[j][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shifts of normals by a picture in POV-Ray: a ramp to the right and one upward on a sphere, and on
    /// planes; each divided by the ramp's slope.
    #[test]
    fn sides_of_bumps_are_those_of_the_scene_language() {
        for (n, right, up) in [
            ([0.405, 0.395, -0.825], [0.8976, 0.0, 0.4409], [-0.1742, 0.9186, 0.3544]),
            ([-0.395, -0.405, -0.825], [0.9018, 0.0, -0.4320], [-0.1749, 0.9144, -0.3653]),
            ([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
            ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ] {
            let [x, y, z] = n;
            let found = sides(unit(Vec3::new(x, y, z)));
            for (found, seen) in [(found.0, right), (found.1, up)] {
                assert!((0..3).all(|i| (found[i] - seen[i]).abs() < 2e-3), "{n:?}: {found:?} {seen:?}");
            }
        }
    }
}

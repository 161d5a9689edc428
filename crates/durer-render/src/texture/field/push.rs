//! Vectors that are added to normals.

use durer_math::{F8, Point3, Vec3, noise};
use durer_scene::Push;

use super::crackle::Points;
use super::ripples::Centres;
use crate::vector::floor;

/// A [`Push`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::texture) enum Pusher {
    Bumps,
    Dents,
    Wrinkles,
    Ripples(Box<Centres>),
    Quilted(f64, f64),
    Facets(f64, Points),
}

/// The shifts of the noise for the three components of a vector.
const SHIFTS: [[f64; 3]; 3] = [[0.0; 3], super::noise::ELSEWHERE[0], super::noise::ELSEWHERE[1]];

/// The number of octaves of wrinkles.
const OCTAVES: usize = 10;

/// The factor of the random numbers of facets. With it their spread is that of POV-Ray's.
const FACET: f64 = 1.12;

impl Pusher {
    pub(in crate::texture) fn new(push: &Push) -> Self {
        match push {
            Push::Bumps => Self::Bumps,
            Push::Dents => Self::Dents,
            Push::Wrinkles => Self::Wrinkles,
            Push::Ripples(ripples) => Self::Ripples(Box::new(Centres::new(ripples))),
            &Push::Quilted(bottom, top) => Self::Quilted(bottom, top),
            &Push::Facets(size) => Self::Facets(size, Points::of_cells()),
        }
    }

    /// The vector at a point.
    pub(in crate::texture) fn vector(&self, p: Point3) -> Vec3 {
        match self {
            Self::Bumps => noise_vector(p),
            Self::Dents => {
                let v = noise_vector(p);
                let n = ((v.x + 1.052_42) * 0.489_855_82).clamp(0.0, 1.0);
                v * (n * n * n)
            }
            Self::Wrinkles => {
                let (mut sum, mut scale) = (Vec3::ZERO, 1.0);
                for _ in 0..OCTAVES {
                    let v = noise_vector((p.to_vec() * scale).to_point());
                    sum += Vec3::new(v.x.abs(), v.y.abs(), v.z.abs()) * (1.18 / scale);
                    scale *= 2.0;
                }
                sum
            }
            Self::Ripples(centres) => centres.vector(p),
            Self::Quilted(bottom, top) => {
                let half = |x: f64| x - floor(x) - 0.5;
                let v = Vec3::new(half(p.x), half(p.y), half(p.z));
                v * super::formulas::quilt_curve(crate::vector::length(v), *bottom, *top)
            }
            Self::Facets(size, points) => points.vector((p.to_vec() * (1.0 / size)).to_point()) * FACET,
        }
    }
}

/// Three different values of noise at a point.
fn noise_vector(p: Point3) -> Vec3 {
    let mut at = Vec3::<F8>::splat(p.to_vec());
    for (i, [x, y, z]) in SHIFTS.into_iter().enumerate() {
        at.set_lane(i, p.to_vec() + Vec3::new(x, y, z));
    }
    let n = noise::values([&at.x, &at.y, &at.z]).0;
    Vec3::new(n[0], n[1], n[2])
}

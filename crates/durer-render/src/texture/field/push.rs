//! Vectors that are added to normals.

use durer_math::{Point3, Vec3};
use durer_scene::Push;

use super::crackle::Points;
use super::ripples::Centres;
use crate::texture::Grains;
use crate::vector::{dot, floor};

/// A [`Push`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::texture) enum Pusher {
    Bumps(Grains),
    /// Noise, and whether its strength is the first generator's.
    Dents(Grains, bool),
    Wrinkles(Grains),
    Ripples(Box<Centres>),
    Quilted(f64, f64),
    Facets(f64, Points),
}

/// The number of octaves of wrinkles.
const OCTAVES: usize = 10;

/// The factor of a cushion's slopes, 2/sqrt(3): with it the slope at a corner is 1.
const QUILT: f64 = 1.154_700_538_379_251_5;

/// The number of random points of facets in each unit along an axis (a fact of the scene language).
const FACETS: f64 = 10.0;

impl Pusher {
    pub(in crate::texture) fn new(push: &Push) -> Self {
        match push {
            Push::Bumps => Self::Bumps(Grains::current()),
            &Push::Dents { old } => Self::Dents(Grains::current(), old),
            Push::Wrinkles => Self::Wrinkles(Grains::current()),
            Push::Ripples(ripples) => Self::Ripples(Box::new(Centres::new(ripples))),
            &Push::Quilted(bottom, top) => Self::Quilted(bottom, top),
            &Push::Facets(amount) => Self::Facets(amount, Points::of_cells()),
        }
    }

    /// The vector at a point with the unit normal `n`.
    pub(in crate::texture) fn vector(&self, p: Point3, n: Vec3) -> Vec3 {
        match self {
            Self::Bumps(grains) => grains.vector(p),
            Self::Dents(grains, old) => {
                let v = grains.vector(p);
                let n = if *old { v.x + 0.5 } else { (v.x + 1.052_42) * 0.489_855_82 };
                let n = n.clamp(0.0, 1.0);
                v * (n * n * n)
            }
            Self::Wrinkles(grains) => {
                let height = if *grains == Grains::Own { 1.18 } else { 1.0 };
                let (mut sum, mut scale) = (Vec3::ZERO, 1.0);
                for _ in 0..OCTAVES {
                    let v = grains.vector((p.to_vec() * scale).to_point());
                    sum += Vec3::new(v.x.abs(), v.y.abs(), v.z.abs()) * (height / scale);
                    scale *= 2.0;
                }
                sum
            }
            Self::Ripples(centres) => centres.vector(p),
            Self::Quilted(bottom, top) => {
                let half = |x: f64| x - floor(x) - 0.5;
                let v = Vec3::new(half(p.x), half(p.y), half(p.z));
                v * (QUILT * super::formulas::quilt_curve(crate::vector::length(v), *bottom, *top))
            }
            Self::Facets(amount, points) => {
                let v = points.vector((p.to_vec() * FACETS).to_point());
                (v - n * dot(v, n)) * *amount
            }
        }
    }
}

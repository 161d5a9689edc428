//! Vectors that are added to normals.

use durer_math::{F8, Point3, Vec3};
use durer_scene::{NoiseGenerator, Push};

use super::crackle::Points;
use super::noise::ranged;
use super::ripples::Centres;
use crate::texture::{Grains, generator_or_scene};
use crate::vector::{dot, floor, unit};

/// A [`Push`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::texture) enum Pusher {
    Bumps(Grains),
    /// Noise, and the generator of its strength.
    Dents(Grains, NoiseGenerator),
    Wrinkles(Grains),
    Ripples(Box<Centres>),
    Quilted(f64, f64),
    Facets(f64, Points),
    NormalFacets(f64, Points),
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
            &Push::Dents { generator } => Self::Dents(Grains::current(), generator_or_scene(generator)),
            Push::Wrinkles => Self::Wrinkles(Grains::current()),
            Push::Ripples(ripples) => Self::Ripples(Box::new(Centres::new(ripples))),
            &Push::Quilted(bottom, top) => Self::Quilted(bottom, top),
            &Push::Facets(amount) => Self::Facets(amount, Points::of_cells()),
            &Push::NormalFacets(width) => Self::NormalFacets(width, Points::of_cells()),
        }
    }

    /// The vector at a point with the unit normal `n`.
    pub(in crate::texture) fn vector(&self, p: Point3, n: Vec3) -> Vec3 {
        match self {
            Self::Bumps(grains) => grains.vector(p),
            Self::Dents(grains, generator) => {
                let n = ranged(grains, Vec3::<F8>::splat(p.to_vec()), *generator).0[0];
                grains.vector(p) * (n * n * n)
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
            Self::NormalFacets(width, points) => {
                let snapped = points.nearest_point((unit(n) * (1.0 / width)).to_point());
                unit(snapped.to_vec()) - n
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normals of POV-Ray: its picture of a sphere under lights along the axes, in 16 bits.
    #[test]
    fn facets_of_normals_are_those_of_the_scene_language() {
        let facets = Pusher::new(&Push::NormalFacets(0.5));
        for (n, snapped) in [
            ([0.005, -0.005, -0.999_975], [0.1680, 0.0052, -0.9858]),
            ([0.405, 0.395, -0.824_591], [0.6345, 0.4997, -0.5896]),
            ([-0.195, -0.505, -0.840_803], [-0.2507, -0.3921, -0.8851]),
            ([-0.095, 0.695, -0.712_706], [-0.0912, 0.4172, -0.9042]),
        ] {
            let [x, y, z] = n;
            let n = Vec3::new(x, y, z);
            // The place does not count, nor the normal's length.
            for (p, length) in [(Point3::new(3.0, -7.0, 0.5), 1.0), (Point3::new(0.0, 0.0, 0.0), 3.0)] {
                let found = n * length + facets.vector(p, n * length);
                assert!((0..3).all(|i| (found[i] - snapped[i]).abs() < 1e-4), "{n:?}: {found:?}");
            }
        }
    }
}

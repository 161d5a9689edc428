//! The functions that continuous patterns grow with.
//!
//! Every function is evaluated at eight points at once. Those of noise use the lanes, the others go
//! through them one by one.

mod crackle;
mod formulas;
mod fractal;
mod inside;
mod noise;
mod pavement;
mod push;
mod ripples;
mod slope;
mod tiling;

pub(super) use crackle::cell_number;
pub(crate) use noise::Stir;
pub(super) use push::Pusher;

use std::sync::Arc;

use super::cells::Cutter;
use super::{Around, Around8, Grains, Picture, RenderPigment, Sampled, generator_or_scene};
use crate::vector::{dot, floor, floor_lanes, unit};
use crackle::Points;
use durer_formula::Tape;
use durer_math::{Affine, AffineError, F8, M8, Point3, Vec3};
use durer_scene::{
    DensityGrid, Fractal, GrainKind, GridBetween, ImageValue, NoiseGenerator, Pavement, Ramp, Slope,
};
use ripples::Centres;

/// A [`Ramp`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Field {
    Gradient(Vec3),
    Spherical,
    Cylindrical,
    Planar,
    Boxed,
    Onion,
    Leopard,
    Radial,
    Marble(Option<Stir>),
    Wood(Option<Stir>),
    Spiral { arms: f64, double: bool, stir: Option<Stir> },
    Quilted(f64, f64),
    Noise(GrainKind, NoiseGenerator, Grains),
    Agate(f64, Stir),
    Cells,
    Ripples(Box<Centres>),
    Crackle(Points),
    Fractal(Fractal),
    Formula(Box<Tape>),
    Sampled(Box<Sampled>),
    Slope(Slope),
    Aoi,
    Tiling(u8),
    Pavement(Pavement),
    Pigment(Box<RenderPigment>),
    Picture(Picture, ImageValue),
    Kind(Cutter),
    Inside(inside::Volume),
    Density(Arc<DensityGrid>, GridBetween),
}

impl Field {
    pub(super) fn new(ramp: &Ramp) -> Result<Self, AffineError> {
        let stir = |turbulence: &Option<durer_scene::Turbulence>| turbulence.as_ref().map(Stir::new);
        Ok(match ramp {
            Ramp::Gradient(axis) => Self::Gradient(unit(*axis)),
            Ramp::Spherical => Self::Spherical,
            Ramp::Cylindrical => Self::Cylindrical,
            Ramp::Planar => Self::Planar,
            Ramp::Boxed => Self::Boxed,
            Ramp::Onion => Self::Onion,
            Ramp::Leopard => Self::Leopard,
            Ramp::Radial => Self::Radial,
            Ramp::Marble(turbulence) => Self::Marble(stir(turbulence)),
            Ramp::Wood(turbulence) => Self::Wood(stir(turbulence)),
            Ramp::Spiral { arms, double, turbulence } => {
                Self::Spiral { arms: *arms, double: *double, stir: stir(turbulence) }
            }
            &Ramp::Quilted(bottom, top) => Self::Quilted(bottom, top),
            Ramp::Noise(grain) => match &grain.kind {
                GrainKind::Agate(amount, turbulence) => Self::Agate(*amount, Stir::new(turbulence)),
                kind => Self::Noise(*kind, generator_or_scene(grain.generator), Grains::current()),
            },
            Ramp::Cells => Self::Cells,
            Ramp::Ripples(ripples) => Self::Ripples(Box::new(Centres::new(ripples))),
            Ramp::Crackle(crackle) => Self::Crackle(Points::new(crackle)),
            Ramp::Fractal(fractal) => Self::Fractal(*fractal),
            Ramp::Image(map, value) => Self::Picture(Picture::new(map), *value),
            Ramp::Inside(object) => Self::Inside(inside::Volume::new(object)),
            Ramp::Density(grid, between) => Self::Density(grid.clone(), *between),
            Ramp::Kind(cells) => Self::Kind(Cutter::new(*cells)),
            Ramp::Formula(formula) => Self::Formula(Box::new(Tape::new(formula))),
            Ramp::Slope(slope) => Self::Slope(*slope),
            Ramp::Aoi => Self::Aoi,
            Ramp::Tiling(number) => Self::Tiling(*number),
            Ramp::Pavement(pavement) => Self::Pavement(*pavement),
            Ramp::Sampled(function) => Self::Sampled(Box::new(Sampled::new(function)?)),
            Ramp::Pigment(pigment) => {
                Self::Pigment(Box::new(RenderPigment::new(pigment, &Affine::IDENTITY)?))
            }
        })
    }

    /// The value at a point.
    #[inline]
    pub(super) fn value(&self, p: Point3, around: Around) -> f64 {
        match self {
            Self::Gradient(axis) => part_above_1(dot(*axis, p.to_vec())),
            Self::Spherical => formulas::spherical(p),
            Self::Cylindrical => formulas::cylindrical(p),
            Self::Planar => (1.0 - p.y.abs()).max(0.0),
            Self::Boxed => formulas::boxed(p),
            Self::Onion => formulas::onion(p),
            Self::Leopard => formulas::leopard(p),
            Self::Radial => formulas::radial(p),
            &Self::Quilted(bottom, top) => formulas::quilted(p, bottom, top),
            Self::Spiral { arms, double, stir } => {
                let shift = stir.as_ref().map_or(0.0, |stir| {
                    stir.amount.x * stir.scalar(Vec3::<F8>::splat(p.to_vec()).to_point()).0[0]
                });
                formulas::spiral(p, *arms, *double, shift)
            }
            Self::Cells => cell_number(p),
            Self::Ripples(centres) => centres.value(p),
            Self::Crackle(points) => points.value(p),
            Self::Fractal(set) => fractal::value(set, p),
            Self::Pigment(pigment) => pigment.at(p, around).rgb.luminance(),
            Self::Picture(picture, value) => picture.value(p, *value),
            Self::Kind(cutter) => cutter.kind(p) as f64,
            Self::Sampled(function) => part_above_1(function.value(&p.to_array())),
            Self::Slope(slope) => slope::value(slope, p, around),
            Self::Aoi => slope::incidence(around),
            &Self::Tiling(number) => tiling::value(number, p),
            Self::Pavement(pavement) => pavement::value(pavement, p),
            Self::Inside(volume) => volume.value(p),
            Self::Density(grid, between) => grid.value(p.to_array(), *between),
            Self::Marble(None) => p.x,
            _ => {
                let p = Vec3::<F8>::splat(p.to_vec()).to_point();
                let lanes = self.values(p, &Around8::NOWHERE, M8::first(1));
                lanes.0[0]
            }
        }
    }

    /// The values at some points.
    #[inline(always)]
    pub(super) fn values(&self, p: Point3<F8>, around: &Around8, live: M8) -> F8 {
        match self {
            Self::Gradient(axis) => parts_above_1(dot(Vec3::<F8>::splat(*axis), p.to_vec())),
            _ => self.other_values(p, around, live),
        }
    }

    fn other_values(&self, p: Point3<F8>, around: &Around8, live: M8) -> F8 {
        match self {
            Self::Noise(kind, generator, grains) => noise::values(*kind, *generator, grains, p),
            Self::Agate(amount, stir) => noise::agate(*amount, stir, p, live),
            Self::Marble(stir) => noise::marble(stir.as_ref(), p),
            Self::Wood(stir) => noise::wood(stir.as_ref(), p, live),
            Self::Formula(program) => parts_above_1(program.values(&[p.x, p.y, p.z])),
            Self::Pigment(pigment) => {
                let colours = pigment.colours(p, around, live);
                by_lane(p, live, |i, _| colours.rgb.lane(i).luminance())
            }
            _ => by_lane(p, live, |i, p| self.value(p, around.lane(i))),
        }
    }
}

/// The fractional part of a number above 1; other numbers are unchanged. With a frequency this
/// makes a difference (a fact of the language).
#[inline(always)]
fn part_above_1(v: f64) -> f64 {
    if v > 1.0 { v - floor(v) } else { v }
}

/// [`part_above_1`] for eight numbers.
#[inline(always)]
fn parts_above_1(v: F8) -> F8 {
    (F8::ONE).lt(v).select(v - floor_lanes(v), v)
}

/// Calls `f` for each live lane.
#[inline(always)]
fn by_lane(p: Point3<F8>, live: M8, f: impl Fn(usize, Point3) -> f64) -> F8 {
    let mut values = F8::ZERO;
    for i in live.lanes() {
        values.0[i] = f(i, p.to_vec().lane(i).to_point());
    }
    values
}

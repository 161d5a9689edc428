//! The noise of textures: durer's own, or one that was learned from POV-Ray.

use std::cell::RefCell;
use std::sync::Arc;

use durer_formula::noise::{self, NoiseTable};
use durer_math::{F8, Point3, Vec3};
use durer_scene::{LearnedNoise, NoiseGenerator, Settings};

/// The shifts of durer's own noise for the second and the third component of vectors.
const ELSEWHERE: [[f64; 3]; 3] = [[0.0; 3], [157.0, -311.0, 89.0], [-223.0, 71.0, 439.0]];

/// A source of noise.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Grains {
    #[default]
    Own,
    Learned(Arc<LearnedNoise>),
}

thread_local! {
    /// The noise of the world that this thread is building, and its settings.
    static CURRENT: RefCell<(Grains, NoiseSettings)> = RefCell::default();
}

/// The settings of a scene about noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoiseSettings {
    /// The number of centres of waves.
    waves: u32,
    /// The generator of noise that names none of its own.
    generator: NoiseGenerator,
}

impl From<&Settings> for NoiseSettings {
    fn from(settings: &Settings) -> Self {
        Self { waves: settings.number_of_waves, generator: settings.noise_generator }
    }
}

impl Default for NoiseSettings {
    fn default() -> Self {
        Self::from(&Settings::default())
    }
}

/// Runs `build`, in which [`Grains::current`] is `grains` and the settings are these.
pub(crate) fn building_with<T>(grains: Grains, settings: NoiseSettings, build: impl FnOnce() -> T) -> T {
    let before = CURRENT.with(|current| current.replace((grains, settings)));
    let built = build();
    CURRENT.with(|current| current.replace(before));
    built
}

/// The number of centres of waves in the world that this thread is building.
pub(crate) fn number_of_waves() -> u32 {
    CURRENT.with(|current| current.borrow().1.waves)
}

/// A noise generator, or that of the world that this thread is building.
pub(crate) fn generator_or_scene(own: Option<NoiseGenerator>) -> NoiseGenerator {
    own.unwrap_or_else(|| CURRENT.with(|current| current.borrow().1.generator))
}

impl Grains {
    /// The noise of the world that this thread is building.
    pub(crate) fn current() -> Self {
        CURRENT.with(|current| current.borrow().0.clone())
    }

    /// The noise at some points, about zero.
    pub(crate) fn values(&self, p: Vec3<F8>) -> F8 {
        match self {
            Self::Own => noise::values(None, [&p.x, &p.y, &p.z]),
            Self::Learned(learned) => learned.component(0, [&p.x, &p.y, &p.z]),
        }
    }

    /// The gradient noise at some points, about zero.
    pub(crate) fn gradient_noise(&self, p: Vec3<F8>) -> F8 {
        let rows = match self {
            Self::Own => NoiseTable::own_rows(),
            Self::Learned(learned) => learned.rows(),
        };
        let [x, y, z] = [p.x, p.y, p.z].map(|x| x + F8::splat(noise::ROWS_SHIFT));
        noise::values(Some(rows), [&x, &y, &z])
    }

    /// A component of the vector noise at some points.
    fn component(&self, p: Vec3<F8>, axis: usize) -> F8 {
        match self {
            Self::Own => {
                let [x, y, z] = ELSEWHERE[axis];
                self.values(if axis == 0 { p } else { p + Vec3::<F8>::splat(Vec3::new(x, y, z)) })
            }
            Self::Learned(learned) => learned.component(axis, [&p.x, &p.y, &p.z]),
        }
    }

    /// The components of the vector noise at some points that are wanted; the others are arbitrary.
    pub(crate) fn vectors(&self, p: Vec3<F8>, wanted: [bool; 3]) -> Vec3<F8> {
        let [x, y, z] = match self {
            Self::Learned(learned) if wanted.iter().filter(|&&is_wanted| is_wanted).count() > 1 => {
                learned.vectors([&p.x, &p.y, &p.z])
            }
            _ => [0, 1, 2].map(|axis| if wanted[axis] { self.component(p, axis) } else { F8::ZERO }),
        };
        Vec3 { x, y, z }
    }

    /// The vector noise at a point.
    pub(crate) fn vector(&self, p: Point3) -> Vec3 {
        match self {
            Self::Own => {
                let mut at = Vec3::<F8>::splat(p.to_vec());
                for (i, [x, y, z]) in ELSEWHERE.into_iter().enumerate() {
                    at.set_lane(i, p.to_vec() + Vec3::new(x, y, z));
                }
                let n = noise::values(None, [&at.x, &at.y, &at.z]).0;
                Vec3::new(n[0], n[1], n[2])
            }
            Self::Learned(learned) => learned.vector(p),
        }
    }
}

//! The one door through which code gets the CPU's vector and fused instructions.
#![expect(
    unsafe_code,
    reason = "calling a function compiled for CPU features is unsafe; an Isa, or the architecture, proves them"
)]

mod masks;
mod pages;

pub(crate) use masks::bits_of_masks;
pub use pages::in_large_pages;

use std::sync::OnceLock;

/// Which instructions a computation may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Path {
    /// For CPUs without fused multiply-add.
    Unfused,
    /// Scalar code with `mul_add`: the definition that the others must equal bit for bit.
    Reference,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 F, VL, DQ and BW, with what [`Path::Avx2`] has.
    Avx512,
}

/// `DURER_ISA` asks for something that cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IsaError {
    /// No path has this name.
    #[error("DURER_ISA must be reference, unfused, avx2 or avx512, got {0:?}")]
    Unknown(String),
    /// This CPU lacks the path's instructions.
    #[error("DURER_ISA={0} asks for instructions that this CPU lacks")]
    Missing(String),
}

/// Proof that this CPU can run a [`Path`]: only detection makes one.
///
/// Everything reachable from [`Isa::run`]'s closure must be `#[inline(always)]`, or it is compiled
/// for the basic CPU and each `mul_add` in it becomes a library call: right, but slow.
///
/// ```
/// use durer_math::Isa;
/// let x = Isa::detect().run(#[inline(always)] || 0.1_f64.mul_add(10.0, -1.0));
/// assert_eq!(x, 0.1_f64.mul_add(10.0, -1.0)); // the same bits on every path
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Isa(Path);

impl Path {
    const ALL: [Self; 4] = [Self::Unfused, Self::Reference, Self::Avx2, Self::Avx512];

    /// The path's name, as in `DURER_ISA`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unfused => "unfused",
            Self::Reference => "reference",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    fn is_available(self) -> bool {
        match self {
            Self::Unfused | Self::Reference => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => {
                is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("fma")
                    && is_x86_feature_detected!("bmi1")
                    && is_x86_feature_detected!("bmi2")
                    && is_x86_feature_detected!("lzcnt")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }
}

impl Isa {
    /// The scalar definition, which runs everywhere.
    pub const REFERENCE: Self = Self(Path::Reference);

    /// The best path of this CPU, or the one that the environment variable `DURER_ISA` names. Asked
    /// once, then remembered.
    ///
    /// A name that is unknown or not available is ignored here; a program's `main` reports it by
    /// [`Isa::requested`].
    #[inline]
    pub fn detect() -> Self {
        static FOUND: OnceLock<Isa> = OnceLock::new();
        *FOUND.get_or_init(|| Self::requested().ok().flatten().unwrap_or_else(Self::best))
    }

    /// The path that `DURER_ISA` names, if it is set.
    pub fn requested() -> Result<Option<Self>, IsaError> {
        let Some(name) = std::env::var_os("DURER_ISA") else { return Ok(None) };
        let name = name.to_string_lossy().into_owned();
        let path = Path::ALL.into_iter().find(|p| p.name() == name);
        let path = path.ok_or_else(|| IsaError::Unknown(name.clone()))?;
        Self::with(path).map(Some).ok_or(IsaError::Missing(name))
    }

    fn best() -> Self {
        // On ARM64 `mul_add` is an instruction of the basic CPU: the reference is fast.
        [Path::Avx512, Path::Avx2].into_iter().find_map(Self::with).unwrap_or(Self::REFERENCE)
    }

    /// The path, if this CPU can run it: for tests that compare paths.
    pub fn with(path: Path) -> Option<Self> {
        path.is_available().then_some(Self(path))
    }

    /// All paths of this CPU.
    pub fn available() -> impl Iterator<Item = Self> {
        Path::ALL.into_iter().filter_map(Self::with)
    }

    /// Which path this is.
    #[inline(always)]
    pub const fn path(self) -> Path {
        self.0
    }

    /// Runs `f`, compiled for this path.
    #[inline(always)]
    pub fn run<R>(self, f: impl FnOnce() -> R) -> R {
        match self.0 {
            Path::Reference | Path::Unfused => f(),
            // SAFETY: an `Isa` with this path is made only by `with`, after `is_available` has seen
            // every feature that the function is compiled for on this CPU. Code that is not written
            // for lanes gains nothing from AVX-512, so both paths share one compiled copy of it.
            #[cfg(target_arch = "x86_64")]
            Path::Avx2 | Path::Avx512 => unsafe { run_avx2(f) },
            #[cfg(not(target_arch = "x86_64"))]
            Path::Avx2 | Path::Avx512 => f(),
        }
    }

    /// As [`Isa::run`], for code that is written for lanes ([`crate::lanes`]): compiled for AVX-512
    /// too.
    #[inline(always)]
    pub fn run_in_lanes<R>(self, f: impl FnOnce() -> R) -> R {
        match self.0 {
            // SAFETY: as in `run`: `is_available` has seen every feature of this path on this CPU.
            #[cfg(target_arch = "x86_64")]
            Path::Avx512 => unsafe { run_avx512(f) },
            _ => self.run(f),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx512<R>(f: impl FnOnce() -> R) -> R {
    f()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx2<R>(f: impl FnOnce() -> R) -> R {
    f()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Point3, Vec3};

    #[test]
    fn all_paths_give_the_same_bits() {
        #[inline(always)]
        fn work() -> Point3 {
            let mut v = Vec3::new(0.1, 0.7, -0.3);
            for i in 0..1000 {
                let w = Vec3::new(f64::from(i), 0.9, 1.1);
                v = v.cross(w) / (1.0 + v.length() + w.dot(v).abs());
            }
            Point3::ORIGIN + v
        }
        let definition = Isa::REFERENCE.run(work);
        assert!(definition.is_finite());
        for isa in Isa::available() {
            assert_eq!(isa.run(work), definition, "{isa:?}");
        }
    }

    #[test]
    fn the_reference_and_the_unfused_path_are_always_there() {
        assert!(Isa::available().count() >= 2);
        assert_eq!(Isa::with(Path::Reference), Some(Isa::REFERENCE));
    }
}

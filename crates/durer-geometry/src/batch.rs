//! Queries for arrays of rays, on all threads.

use crate::geometry::Geometry;
use crate::ids::EVERYTHING;
use crate::interleave::{ABREAST, Abreast};
use crate::query::Masked;
use crate::{Hit, ObjectSpan, Span};
use durer_math::Ray;
use rayon::prelude::*;

/// Answers of different lengths: those to ray `i` are `items[offsets[i]..offsets[i + 1]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Ragged<T> {
    /// The offsets, one more than there are rays.
    pub offsets: Vec<u64>,
    /// All answers, in the order of the rays.
    pub items: Vec<T>,
}

impl<T> Ragged<T> {
    /// The answers to ray `i`.
    pub fn of(&self, i: usize) -> &[T] {
        &self.items[self.offsets[i] as usize..self.offsets[i + 1] as usize]
    }

    fn gathered(parts: Vec<(Vec<u32>, Vec<T>)>) -> Self {
        let mut offsets = Vec::with_capacity(1 + parts.iter().map(|p| p.0.len()).sum::<usize>());
        let mut items = Vec::with_capacity(parts.iter().map(|p| p.1.len()).sum());
        let mut end = 0;
        offsets.push(end);
        for (lengths, mut part) in parts {
            for length in lengths {
                end += u64::from(length);
                offsets.push(end);
            }
            items.append(&mut part);
        }
        Self { offsets, items }
    }
}

/// Rays per task: enough to pay for its overhead.
const CHUNK: usize = 1024;

/// The queries of many rays, answered in the order of the rays. Made by [`Geometry::batch`] and
/// [`Masked::batch`].
///
/// The answers do not depend on the number of threads.
///
/// ```
/// use durer_geometry::Geometry;
/// use durer_math::{Point3, Ray, Vec3};
/// use durer_surfaces::Sphere;
///
/// let scene = Geometry::builder().with(Sphere::new(Point3::ORIGIN, 1.0)?).build()?;
/// let rays = [0.0, 0.5, 2.0].map(|x| Ray::new(Point3::new(x, 0.0, -3.0), Vec3::Z));
/// let hits = scene.batch(&rays).threads(2).closest();
/// assert_eq!(hits.iter().map(|hit| hit.is_some()).collect::<Vec<_>>(), [true, true, false]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    view: Masked<'a>,
    rays: &'a [Ray],
    threads: usize,
}

impl Geometry {
    /// The queries of all surfaces for these rays.
    pub fn batch<'a>(&'a self, rays: &'a [Ray]) -> Batch<'a> {
        self.masked(EVERYTHING).batch(rays)
    }
}

impl<'a> Masked<'a> {
    /// The queries of these surfaces for these rays.
    pub fn batch(self, rays: &'a [Ray]) -> Batch<'a> {
        Batch { view: self, rays, threads: 0 }
    }
}

impl<'a> Batch<'a> {
    /// How many threads work; 0, the default, means those of the thread pool that this is called
    /// from, else all processors. Where the system refuses to start threads, that pool works.
    #[must_use]
    pub fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// [`Masked::closest`] for each ray.
    pub fn closest(&self) -> Vec<Option<Hit>> {
        self.each(|view, some, hits| view.geometry.closest_abreast(some, view.mask, hits))
    }

    /// [`Masked::any`] for each ray.
    pub fn any(&self) -> Vec<bool> {
        self.each(|view, some, hits| {
            let memory = &mut Abreast::default();
            view.geometry.any_abreast(some, view.mask, memory, |_, is_met| hits.push(is_met));
        })
    }

    /// [`Masked::all`] for each ray.
    pub fn all(&self) -> Ragged<Hit> {
        self.ragged(Masked::all)
    }

    /// [`Masked::spans`] for each ray.
    pub fn spans(&self) -> Ragged<Span> {
        self.ragged(Masked::spans)
    }

    /// [`Masked::spans_by_object`] for each ray.
    pub fn spans_by_object(&self) -> Ragged<ObjectSpan> {
        self.ragged(Masked::spans_by_object)
    }

    /// One answer for each ray, in the order of the rays.
    fn each<T: Send>(&self, query: impl Fn(&Masked<'_>, &[Ray], &mut Vec<T>) + Sync) -> Vec<T> {
        let part = |rays: &[Ray]| {
            let mut answers = Vec::with_capacity(rays.len());
            rays.chunks(ABREAST).for_each(|some| query(&self.view, some, &mut answers));
            answers
        };
        let parts: Vec<Vec<T>> = self.install(|| self.rays.par_chunks(CHUNK).map(part).collect());
        let mut answers = Vec::with_capacity(self.rays.len());
        parts.into_iter().for_each(|mut part| answers.append(&mut part));
        answers
    }

    /// Several answers for each ray, in the order of the rays.
    fn ragged<T: Send>(&self, query: impl Fn(&Masked<'a>, &Ray) -> Vec<T> + Sync) -> Ragged<T> {
        let part = |rays: &[Ray]| {
            let mut lengths = Vec::with_capacity(rays.len());
            let mut items = Vec::new();
            for ray in rays {
                let mut found = query(&self.view, ray);
                lengths.push(found.len() as u32);
                items.append(&mut found);
            }
            (lengths, items)
        };
        Ragged::gathered(self.install(|| self.rays.par_chunks(CHUNK).map(part).collect()))
    }

    /// Runs `work` on the wanted threads.
    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let pool = || rayon::ThreadPoolBuilder::new().num_threads(self.threads).build().ok();
        match (self.threads > 0).then(pool).flatten() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

//! Queries for arrays of rays, on all threads.

use crate::geometry::Geometry;
use crate::ids::EVERYTHING;
use crate::interleave::{ABREAST, Abreast};
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

impl Geometry {
    /// [`Geometry::closest`] for each ray. The answers do not depend on the number of threads.
    pub fn closest_batch(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        each(rays, |some, hits| self.closest_abreast(some, hits))
    }

    /// [`Geometry::any`] for each ray.
    pub fn any_batch(&self, rays: &[Ray]) -> Vec<bool> {
        each(rays, |some, hits| {
            self.any_abreast(some, EVERYTHING, &mut Abreast::default(), |_, is_met| hits.push(is_met));
        })
    }

    /// [`Geometry::all`] for each ray.
    pub fn all_batch(&self, rays: &[Ray]) -> Ragged<Hit> {
        ragged(rays, |ray| self.all(ray))
    }

    /// [`Geometry::spans`] for each ray.
    pub fn spans_batch(&self, rays: &[Ray]) -> Ragged<Span> {
        ragged(rays, |ray| self.spans(ray))
    }

    /// [`Geometry::spans_by_object`] for each ray.
    pub fn spans_by_object_batch(&self, rays: &[Ray]) -> Ragged<ObjectSpan> {
        ragged(rays, |ray| self.spans_by_object(ray))
    }
}

/// One answer for each ray, in the order of the rays.
fn each<T: Send>(rays: &[Ray], query: impl Fn(&[Ray], &mut Vec<T>) + Sync) -> Vec<T> {
    let part = |rays: &[Ray]| {
        let mut answers = Vec::with_capacity(rays.len());
        rays.chunks(ABREAST).for_each(|some| query(some, &mut answers));
        answers
    };
    let parts: Vec<Vec<T>> = rays.par_chunks(CHUNK).map(part).collect();
    let mut answers = Vec::with_capacity(rays.len());
    parts.into_iter().for_each(|mut part| answers.append(&mut part));
    answers
}

fn ragged<T: Send>(rays: &[Ray], query: impl Fn(&Ray) -> Vec<T> + Sync) -> Ragged<T> {
    let part = |rays: &[Ray]| {
        let mut lengths = Vec::with_capacity(rays.len());
        let mut items = Vec::new();
        for ray in rays {
            let mut found = query(ray);
            lengths.push(found.len() as u32);
            items.append(&mut found);
        }
        (lengths, items)
    };
    Ragged::gathered(rays.par_chunks(CHUNK).map(part).collect())
}

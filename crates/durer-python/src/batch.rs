//! Arrays of rays in pieces: over threads, without the lock of the interpreter, and with an ear for Ctrl-C.

use crate::value_error;
use durer::math::{Point3, Ray, Vec3};
use numpy::ndarray::ArrayView2;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Rays between two looks at signals.
const PIECE: usize = 1 << 16;
/// Rays of one task.
pub(crate) const CHUNK: usize = 1024;
/// Stack of a thread. Only what is used is ever touched.
const STACK: usize = 64 << 20;

type Pools = Mutex<HashMap<(u32, usize), Arc<rayon::ThreadPool>>>;

/// The pool for this many threads; 0 is one for each processor. A forked process has pools of its
/// own, since threads do not survive a fork.
pub(crate) fn pool(threads: usize) -> PyResult<Arc<rayon::ThreadPool>> {
    static POOLS: std::sync::OnceLock<Pools> = std::sync::OnceLock::new();
    let mut pools = POOLS.get_or_init(Pools::default).lock().unwrap_or_else(PoisonError::into_inner);
    let key = (std::process::id(), threads);
    if let Some(pool) = pools.get(&key) {
        return Ok(Arc::clone(pool));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let pool = Arc::new(pool.map_err(|e| value_error(format!("cannot start threads: {e}")))?);
    pools.insert(key, Arc::clone(&pool));
    Ok(pool)
}

/// Rays in two arrays of three columns, with their ranges if they have any.
#[derive(Clone, Copy)]
pub(crate) struct Rays<'a> {
    pub(crate) origins: ArrayView2<'a, f64>,
    pub(crate) directions: ArrayView2<'a, f64>,
    pub(crate) ranges: Option<ArrayView2<'a, f64>>,
}

impl Rays<'_> {
    pub(crate) fn len(&self) -> usize {
        self.origins.nrows()
    }

    #[inline]
    pub(crate) fn get(&self, i: usize) -> Ray {
        let (o, d) = (&self.origins, &self.directions);
        let ray = Ray::new(
            Point3::new(o[[i, 0]], o[[i, 1]], o[[i, 2]]),
            Vec3::new(d[[i, 0]], d[[i, 1]], d[[i, 2]]),
        );
        match &self.ranges {
            None => ray,
            Some(ranges) => ray.with_range(ranges[[i, 0]], ranges[[i, 1]]),
        }
    }

    pub(crate) fn of(&self, range: Range<usize>) -> Vec<Ray> {
        range.map(|i| self.get(i)).collect()
    }
}

/// How a batch is run.
pub(crate) struct How<'py> {
    pub(crate) threads: usize,
    /// Called with the number of rays that were done since the last call.
    pub(crate) progress: Option<Bound<'py, PyAny>>,
}

/// Does `work` on pieces of `0..count`, and hands the answers to `gather` in order.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    count: usize,
    how: How<'_>,
    work: impl Fn(Range<usize>) -> T + Sync,
    mut gather: impl FnMut(T) + Send,
) -> PyResult<()> {
    let pool = pool(how.threads)?;
    let progress = how.progress.map(Bound::unbind);
    py.detach(|| {
        for start in (0..count).step_by(PIECE) {
            let end = count.min(start + PIECE);
            let chunks = (end - start).div_ceil(CHUNK);
            let chunk = |i: usize| {
                let first = start + i * CHUNK;
                work(first..end.min(first + CHUNK))
            };
            let answers: Vec<T> = pool.install(|| (0..chunks).into_par_iter().map(chunk).collect());
            answers.into_iter().for_each(&mut gather);
            Python::attach(|py| {
                py.check_signals()?;
                match &progress {
                    Some(progress) => progress.call1(py, (end - start,)).map(|_| ()),
                    None => Ok(()),
                }
            })?;
        }
        Ok(())
    })
}

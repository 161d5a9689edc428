//! Closest, any, all, spans and contains, from arrays to answers.

use crate::batch::{How, Rays, run};
use crate::hits::{Hits, Spans};
use crate::scene::Scene;
use crate::value_error;
use durer::geometry::Geometry;
use durer::math::{Point3, Ray};
use durer::surfaces::RootKind;
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;

type Matrix<'py> = PyReadonlyArray2<'py, f64>;
type Progress<'py> = Option<Bound<'py, PyAny>>;
type Numbers<'py> = Bound<'py, PyArray1<i64>>;

/// Calls `f` with views of the arrays. Python's side has seen to their shapes.
fn with_rays<'py, R>(
    origins: &Matrix<'py>,
    directions: &Matrix<'py>,
    ranges: Option<&Matrix<'py>>,
    f: impl FnOnce(Rays<'_>) -> PyResult<R>,
) -> PyResult<R> {
    let rays = Rays {
        origins: origins.as_array(),
        directions: directions.as_array(),
        ranges: ranges.map(|r| r.as_array()),
    };
    let (n, d) = (rays.len(), rays.directions.dim());
    let fits = rays.origins.ncols() == 3 && d == (n, 3) && rays.ranges.is_none_or(|r| r.dim() == (n, 2));
    if !fits || u32::try_from(n).is_err() {
        return Err(value_error(format!("rays of shapes {:?} and {d:?}", rays.origins.dim())));
    }
    f(rays)
}

fn line(ray: &Ray) -> [f64; 6] {
    let (o, d) = (ray.origin, ray.direction);
    [o.x, o.y, o.z, d.x, d.y, d.z]
}

fn invalid(rays: &[Ray]) -> usize {
    rays.iter().filter(|r| !r.is_valid()).count()
}

#[pyfunction]
fn closest<'py>(
    scene: &Scene,
    py: Python<'py>,
    origins: Matrix<'py>,
    directions: Matrix<'py>,
    ranges: Option<Matrix<'py>>,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<Hits> {
    let geometry = scene.geometry();
    with_rays(&origins, &directions, ranges.as_ref(), |rays| {
        let mut hits = Hits::empty(&scene.world, rays.len());
        let work = |range: std::ops::Range<usize>| {
            let rays = rays.of(range);
            let lines: Vec<_> = rays.iter().map(line).collect();
            (lines, geometry.batch(&rays).closest(), invalid(&rays))
        };
        run(py, rays.len(), How { threads, progress }, work, |(lines, found, invalid)| {
            let first = hits.lines.len() as u32;
            hits.lines.extend(lines);
            for (i, hit) in (first..).zip(found) {
                if let Some(hit) = hit {
                    hits.hits.push(hit);
                    hits.rays.push(i);
                }
            }
            hits.invalid += invalid;
        })?;
        Ok(hits)
    })
}

/// The object and the primitive of the first hit of each ray, -1 where there is none, and whether any hit is a touch: less work than
/// `closest`.
#[pyfunction]
fn closest_ids<'py>(
    scene: &Scene,
    py: Python<'py>,
    origins: Matrix<'py>,
    directions: Matrix<'py>,
    ranges: Option<Matrix<'py>>,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<(Numbers<'py>, Numbers<'py>, bool)> {
    let geometry = scene.geometry();
    with_rays(&origins, &directions, ranges.as_ref(), |rays| {
        let (mut objects, mut primitives) = (Vec::with_capacity(rays.len()), Vec::with_capacity(rays.len()));
        let mut any_touch = false;
        let work = |range: std::ops::Range<usize>| geometry.batch(&rays.of(range)).closest();
        run(py, rays.len(), How { threads, progress }, work, |found| {
            for hit in found {
                any_touch |= hit.as_ref().is_some_and(|h| h.kind == RootKind::Grazing);
                let (object, primitive) =
                    hit.map_or((-1, -1), |h| (i64::from(h.object.0), i64::from(h.primitive.0)));
                objects.push(object);
                primitives.push(primitive);
            }
        })?;
        Ok((PyArray1::from_vec(py, objects), PyArray1::from_vec(py, primitives), any_touch))
    })
}

/// Whether each ray hits anything, and how many are invalid.
#[pyfunction]
fn any<'py>(
    scene: &Scene,
    py: Python<'py>,
    origins: Matrix<'py>,
    directions: Matrix<'py>,
    ranges: Option<Matrix<'py>>,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<(Bound<'py, PyArray1<bool>>, usize)> {
    let geometry = scene.geometry();
    with_rays(&origins, &directions, ranges.as_ref(), |rays| {
        let (mut answers, mut bad) = (Vec::with_capacity(rays.len()), 0);
        let work = |range: std::ops::Range<usize>| {
            let rays = rays.of(range);
            (geometry.batch(&rays).any(), invalid(&rays))
        };
        run(py, rays.len(), How { threads, progress }, work, |(found, invalid)| {
            answers.extend(found);
            bad += invalid;
        })?;
        Ok((PyArray1::from_vec(py, answers), bad))
    })
}

#[pyfunction]
fn all<'py>(
    scene: &Scene,
    py: Python<'py>,
    origins: Matrix<'py>,
    directions: Matrix<'py>,
    ranges: Option<Matrix<'py>>,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<Hits> {
    let geometry = scene.geometry();
    with_rays(&origins, &directions, ranges.as_ref(), |rays| {
        let mut hits = Hits::empty(&scene.world, rays.len());
        let mut offsets = Vec::with_capacity(rays.len() + 1);
        offsets.push(0);
        let work = |range: std::ops::Range<usize>| {
            let rays = rays.of(range);
            let lines: Vec<_> = rays.iter().map(line).collect();
            (lines, geometry.batch(&rays).all(), invalid(&rays))
        };
        run(py, rays.len(), How { threads, progress }, work, |(lines, found, invalid)| {
            let (first, before) = (hits.lines.len() as u32, hits.hits.len() as i64);
            for (i, ends) in (first..).zip(found.offsets.windows(2)) {
                hits.rays.resize(hits.rays.len() + (ends[1] - ends[0]) as usize, i);
                offsets.push(before + ends[1] as i64);
            }
            hits.lines.extend(lines);
            hits.hits.extend(found.items);
            hits.invalid += invalid;
        })?;
        hits.offsets = Some(offsets);
        Ok(hits)
    })
}

#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "rays, what is asked of them, and how")]
fn spans<'py>(
    scene: &Scene,
    py: Python<'py>,
    origins: Matrix<'py>,
    directions: Matrix<'py>,
    ranges: Option<Matrix<'py>>,
    by_object: bool,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<Spans> {
    let geometry = scene.geometry();
    with_rays(&origins, &directions, ranges.as_ref(), |rays| {
        let mut spans = Spans { spans: Vec::new(), objects: None, offsets: vec![0], invalid: 0 };
        let how = How { threads, progress };
        if by_object {
            let mut objects = Vec::new();
            let work = |range: std::ops::Range<usize>| {
                let rays = rays.of(range);
                (geometry.batch(&rays).spans_by_object(), invalid(&rays))
            };
            run(py, rays.len(), how, work, |(found, invalid)| {
                spans.take(&found.offsets, found.items.iter().map(|s| s.span), invalid);
                objects.extend(found.items.iter().map(|s| i64::from(s.object.0)));
            })?;
            spans.objects = Some(objects);
        } else {
            let work = |range: std::ops::Range<usize>| {
                let rays = rays.of(range);
                (geometry.batch(&rays).spans(), invalid(&rays))
            };
            run(py, rays.len(), how, work, |(found, invalid)| {
                spans.take(&found.offsets, found.items.into_iter(), invalid);
            })?;
        }
        Ok(spans)
    })
}

/// Whether each point lies in or on a solid.
#[pyfunction]
fn contains<'py>(
    scene: &Scene,
    py: Python<'py>,
    points: Matrix<'py>,
    threads: usize,
    progress: Progress<'py>,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let geometry: &Geometry = scene.geometry();
    let rows = points.as_array();
    if rows.ncols() != 3 {
        return Err(value_error(format!("points of shape {:?}", rows.dim())));
    }
    let mut answers = Vec::with_capacity(rows.nrows());
    let work = |range: std::ops::Range<usize>| -> Vec<bool> {
        range.map(|i| geometry.contains(Point3::new(rows[[i, 0]], rows[[i, 1]], rows[[i, 2]]))).collect()
    };
    run(py, rows.nrows(), How { threads, progress }, work, |found| answers.extend(found))?;
    Ok(PyArray1::from_vec(py, answers))
}

impl Hits {
    fn empty(world: &Arc<durer::render::World>, rays: usize) -> Self {
        Self {
            world: Arc::clone(world),
            lines: Vec::with_capacity(rays),
            hits: Vec::new(),
            rays: Vec::new(),
            offsets: None,
            invalid: 0,
        }
    }
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(closest, module)?)?;
    module.add_function(wrap_pyfunction!(closest_ids, module)?)?;
    module.add_function(wrap_pyfunction!(any, module)?)?;
    module.add_function(wrap_pyfunction!(all, module)?)?;
    module.add_function(wrap_pyfunction!(spans, module)?)?;
    module.add_function(wrap_pyfunction!(contains, module)?)
}

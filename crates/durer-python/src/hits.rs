//! Answers as columns, which are computed at first use.

use crate::mesh::rows_of;
use durer::geometry::{Hit, Span};
use durer::math::{Point3, Ray, Vec3};
use durer::render::World;
use durer::surfaces::Need;
use numpy::PyArray1;
use numpy::PyArray2;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::Arc;

/// Stands for a hit in the columns of rays that miss.
const NO_ID: i64 = -1;
const NO_KIND: u8 = 255;

/// Hits of an array of rays. With `offsets`, all hits of each; without, one or none for each.
#[pyclass(frozen, module = "durer._native")]
pub(crate) struct Hits {
    pub(crate) world: Arc<World>,
    /// The lines of the rays, which points of hits are computed from.
    pub(crate) lines: Vec<[f64; 6]>,
    /// All hits, in the order of their rays.
    pub(crate) hits: Vec<Hit>,
    /// The ray of each.
    pub(crate) rays: Vec<u32>,
    pub(crate) offsets: Option<Vec<i64>>,
    pub(crate) invalid: usize,
}

type Column<'py, T> = Bound<'py, PyArray1<T>>;

impl Hits {
    fn rows(&self) -> usize {
        if self.offsets.is_some() { self.hits.len() } else { self.lines.len() }
    }

    /// The row of each hit.
    fn row(&self, hit: usize) -> usize {
        if self.offsets.is_some() { hit } else { self.rays[hit] as usize }
    }

    fn column<'py, T: numpy::Element + Clone>(
        &self,
        py: Python<'py>,
        missing: T,
        of: impl Fn(&Hit) -> T,
    ) -> Column<'py, T> {
        let mut column = vec![missing; self.rows()];
        self.hits.iter().enumerate().for_each(|(i, hit)| column[self.row(i)] = of(hit));
        PyArray1::from_vec(py, column)
    }

    fn ray(&self, hit: usize) -> Ray {
        let [ox, oy, oz, dx, dy, dz] = self.lines[self.rays[hit] as usize];
        Ray::new(Point3::new(ox, oy, oz), Vec3::new(dx, dy, dz))
    }
}

/// Position, its bound, normal, shading normal, uv.
type Points<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
);

#[pymethods]
impl Hits {
    /// Rows of the columns.
    #[getter]
    fn count(&self) -> usize {
        self.rows()
    }

    #[getter]
    fn ray_count(&self) -> usize {
        self.lines.len()
    }

    #[getter]
    fn invalid(&self) -> usize {
        self.invalid
    }

    fn offsets<'py>(&self, py: Python<'py>) -> Option<Column<'py, i64>> {
        self.offsets.as_ref().map(|o| PyArray1::from_slice(py, o))
    }

    fn t<'py>(&self, py: Python<'py>) -> Column<'py, f64> {
        self.column(py, f64::INFINITY, |h| h.t)
    }

    fn t_lo<'py>(&self, py: Python<'py>) -> Column<'py, f64> {
        self.column(py, f64::INFINITY, |h| h.t_lo)
    }

    fn t_hi<'py>(&self, py: Python<'py>) -> Column<'py, f64> {
        self.column(py, f64::INFINITY, |h| h.t_hi)
    }

    fn object<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        self.column(py, NO_ID, |h| i64::from(h.object.0))
    }

    fn primitive<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        self.column(py, NO_ID, |h| i64::from(h.primitive.0))
    }

    fn kind<'py>(&self, py: Python<'py>) -> Column<'py, u8> {
        self.column(py, NO_KIND, |h| h.kind as u8)
    }

    fn sign<'py>(&self, py: Python<'py>) -> Column<'py, i8> {
        self.column(py, 0, |h| h.sign)
    }

    /// The kernel's own parameters: of triangles, barycentric b1 and b2.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut rows = vec![[f64::NAN; 2]; self.rows()];
        self.hits.iter().enumerate().for_each(|(i, hit)| rows[self.row(i)] = hit.tag);
        rows_of(py, rows)
    }

    fn ray_index<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        let mut column = vec![NO_ID; self.rows()];
        self.rays.iter().enumerate().for_each(|(i, ray)| column[self.row(i)] = i64::from(*ray));
        PyArray1::from_vec(py, column)
    }

    /// The positions alone: less work than `points`, and the same bits.
    fn positions<'py>(&self, py: Python<'py>, threads: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pool = crate::batch::pool(threads)?;
        let geometry = self.world.geometry();
        let mut rows = vec![[f64::NAN; 3]; self.rows()];
        py.detach(|| {
            pool.install(|| {
                let of = |(i, hit): (usize, &Hit)| {
                    geometry.resolve_with(&self.ray(i), hit, Need::POINT).p.to_array()
                };
                let found: Vec<_> = self.hits.par_iter().enumerate().with_min_len(256).map(of).collect();
                found.into_iter().enumerate().for_each(|(i, p)| rows[self.row(i)] = p);
            });
        });
        rows_of(py, rows)
    }

    /// The points of all hits.
    fn points<'py>(&self, py: Python<'py>, threads: usize) -> PyResult<Points<'py>> {
        let pool = crate::batch::pool(threads)?;
        let geometry = self.world.geometry();
        let resolved: Vec<_> = py.detach(|| {
            pool.install(|| {
                let of = |(i, hit): (usize, &Hit)| {
                    let p = geometry.resolve_with(&self.ray(i), hit, Need::ALL);
                    (p.p.to_array(), p.dp.to_array(), p.ng.to_array(), p.ns.to_array(), p.uv)
                };
                self.hits.par_iter().enumerate().with_min_len(256).map(of).collect()
            })
        });
        let rows = self.rows();
        let empty = || vec![[f64::NAN; 3]; rows];
        let (mut position, mut bound, mut normal, mut shading) = (empty(), empty(), empty(), empty());
        let mut uv = vec![[f64::NAN; 2]; rows];
        for (i, (p, dp, ng, ns, t)) in resolved.into_iter().enumerate() {
            let row = self.row(i);
            (position[row], bound[row], normal[row], shading[row], uv[row]) = (p, dp, ng, ns, t);
        }
        Ok((
            rows_of(py, position)?,
            rows_of(py, bound)?,
            rows_of(py, normal)?,
            rows_of(py, shading)?,
            rows_of(py, uv)?,
        ))
    }
}

/// Stretches of an array of rays inside solids.
#[pyclass(frozen, module = "durer._native")]
pub(crate) struct Spans {
    pub(crate) spans: Vec<Span>,
    /// The object of each, if they are those of one object at a time.
    pub(crate) objects: Option<Vec<i64>>,
    pub(crate) offsets: Vec<i64>,
    pub(crate) invalid: usize,
}

impl Spans {
    /// Adds the answers of a piece.
    pub(crate) fn take(&mut self, offsets: &[u64], spans: impl Iterator<Item = Span>, invalid: usize) {
        let before = self.spans.len() as i64;
        self.offsets.extend(offsets[1..].iter().map(|&end| before + end as i64));
        self.spans.extend(spans);
        self.invalid += invalid;
    }

    fn column<'py, T: numpy::Element>(&self, py: Python<'py>, of: impl Fn(&Span) -> T) -> Column<'py, T> {
        PyArray1::from_vec(py, self.spans.iter().map(of).collect())
    }
}

#[pymethods]
impl Spans {
    #[getter]
    fn count(&self) -> usize {
        self.spans.len()
    }

    #[getter]
    fn invalid(&self) -> usize {
        self.invalid
    }

    fn offsets<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        PyArray1::from_slice(py, &self.offsets)
    }

    fn t_in<'py>(&self, py: Python<'py>) -> Column<'py, f64> {
        self.column(py, |s| s.t_in)
    }

    fn t_out<'py>(&self, py: Python<'py>) -> Column<'py, f64> {
        self.column(py, |s| s.t_out)
    }

    /// The object that the ray is in, if that was asked for.
    fn object<'py>(&self, py: Python<'py>) -> Option<Column<'py, i64>> {
        self.objects.as_ref().map(|o| PyArray1::from_slice(py, o))
    }

    fn object_in<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        self.column(py, |s| s.object_in.map_or(NO_ID, |id| i64::from(id.0)))
    }

    fn object_out<'py>(&self, py: Python<'py>) -> Column<'py, i64> {
        self.column(py, |s| s.object_out.map_or(NO_ID, |id| i64::from(id.0)))
    }
}

//! Cameras that make arrays of rays.

use crate::mesh::rows_of;
use crate::objects::{point, vec3};
use crate::value_error;
use durer::math::Point3;
use durer::render::camera::Camera as Lens;
use durer::scene::{Camera as CameraData, Projection};
use numpy::PyArray2;
use pyo3::prelude::*;

/// A camera by its final vectors.
#[pyclass(frozen, module = "durer._native")]
pub(crate) struct Camera {
    pub(crate) data: CameraData,
}

#[pymethods]
impl Camera {
    #[new]
    fn new(
        location: [f64; 3],
        direction: [f64; 3],
        right: [f64; 3],
        up: [f64; 3],
        orthographic: bool,
    ) -> PyResult<Self> {
        let projection = if orthographic { Projection::Orthographic } else { Projection::Perspective };
        let data = CameraData {
            projection,
            location: point(location),
            direction: vec3(direction),
            right: vec3(right),
            up: vec3(up),
            lens: None,
            normal: None,
        };
        Lens::new(&data).map_err(value_error)?;
        Ok(Self { data })
    }

    #[getter]
    fn location(&self) -> [f64; 3] {
        let p: Point3 = self.data.location;
        p.to_array()
    }

    #[getter]
    fn direction(&self) -> [f64; 3] {
        self.data.direction.to_array()
    }

    #[getter]
    fn right(&self) -> [f64; 3] {
        self.data.right.to_array()
    }

    #[getter]
    fn up(&self) -> [f64; 3] {
        self.data.up.to_array()
    }

    #[getter]
    fn is_orthographic(&self) -> bool {
        self.data.projection == Projection::Orthographic
    }

    /// Origin and direction of the rays through the middles of all pixels, row by row from the top.
    fn rays<'py>(&self, py: Python<'py>, width: u32, height: u32) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let lens = Lens::new(&self.data).map_err(value_error)?;
        let mut rows = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let ray = lens.pixel(x, y, width, height);
                let (o, d) = (ray.origin, ray.direction);
                rows.push([o.x, o.y, o.z, d.x, d.y, d.z]);
            }
        }
        rows_of(py, rows)
    }
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Camera>()
}

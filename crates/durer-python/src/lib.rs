//! The native half of the Python package `durer`: what needs speed. Its public face is the Python code in `python/durer`.
//!
//! | module | what it holds |
//! |---|---|
//! | `objects` | surfaces as scene data, one function for each kind |
//! | `formula` | functions of x, y and z from a list of steps |
//! | `scene` | a built scene: geometry, counts, pictures |
//! | `batch` | arrays of rays in pieces: threads, Ctrl-C, progress |
//! | `queries` | closest, any, all, spans and contains |
//! | `hits` | the answers, as columns |
//! | `camera` | cameras that make arrays of rays |

mod batch;
mod camera;
mod formula;
mod hits;
mod mesh;
mod objects;
mod queries;
mod scene;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// What is wrong with some input, as Python's `ValueError` with the library's own text.
pub(crate) fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

#[pymodule(gil_used = false)]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    objects::add_to(module)?;
    mesh::add_to(module)?;
    scene::add_to(module)?;
    queries::add_to(module)?;
    camera::add_to(module)?;
    module.add_class::<hits::Hits>()?;
    module.add_class::<hits::Spans>()
}

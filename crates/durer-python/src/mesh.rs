//! Meshes from arrays and files.

use crate::objects::Object;
use crate::value_error;
use durer::math::{Point3, Vec3};
use durer::mesh::Topology;
use durer::scene::{Face, Mesh, Object as SceneObject, Shape};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The direction that tells inside from outside of closed meshes: any will do; along no axis, and in no plane of two.
const INSIDE: Vec3 = Vec3::new(0.48, 0.6, 0.64);

type Triples<'py> = Option<PyReadonlyArray2<'py, i64>>;
type Rows<'py> = Option<PyReadonlyArray2<'py, f64>>;

/// Checked indices: a negative one or one that is too large is named with its face.
fn indices(what: &str, faces: &PyReadonlyArray2<'_, i64>, len: usize) -> PyResult<Vec<[u32; 3]>> {
    let rows = faces.as_array();
    let mut all = Vec::with_capacity(rows.nrows());
    for (face, row) in rows.rows().into_iter().enumerate() {
        let triple = [row[0], row[1], row[2]];
        if let Some(&bad) = triple.iter().find(|&&i| i < 0 || i as u64 >= len as u64) {
            return Err(value_error(format!("mesh: face {face} uses {what} {bad}, but there are {len}")));
        }
        all.push(triple.map(|i| i as u32));
    }
    Ok(all)
}

fn vectors(rows: &Rows<'_>) -> Vec<Vec3> {
    rows.as_ref().map_or_else(Vec::new, |rows| {
        rows.as_array().rows().into_iter().map(|r| Vec3::new(r[0], r[1], r[2])).collect()
    })
}

/// A mesh. `solid`: whether it bounds a solid; `None` asks whether it is closed. Says whether it became a solid.
#[pyfunction]
#[pyo3(signature = (vertices, faces, normals, normal_faces, uv, uv_faces, solid))]
#[expect(clippy::too_many_arguments, reason = "the lists of a mesh")]
fn mesh(
    py: Python<'_>,
    vertices: PyReadonlyArray2<'_, f64>,
    faces: PyReadonlyArray2<'_, i64>,
    normals: Rows<'_>,
    normal_faces: Triples<'_>,
    uv: Rows<'_>,
    uv_faces: Triples<'_>,
    solid: Option<bool>,
) -> PyResult<(Object, bool)> {
    let points: Vec<Point3> =
        vertices.as_array().rows().into_iter().map(|r| Point3::new(r[0], r[1], r[2])).collect();
    let corners = indices("vertex", &faces, points.len())?;
    let normals = vectors(&normals);
    let normal_corners = match &normal_faces {
        Some(faces) => Some(indices("normal", faces, normals.len())?),
        None => None,
    };
    let texture: Vec<[f64; 2]> = uv
        .as_ref()
        .map_or_else(Vec::new, |rows| rows.as_array().rows().into_iter().map(|r| [r[0], r[1]]).collect());
    let uv_corners = match &uv_faces {
        Some(faces) => indices("uv", faces, texture.len())?.into_iter().map(Some).collect(),
        None => Vec::new(),
    };
    let face = |(i, &vertices): (usize, &[u32; 3])| Face {
        vertices,
        normals: normal_corners.as_ref().map(|n| n[i]),
        texture: None,
    };
    let faces = corners.iter().enumerate().map(face).collect();
    let mut mesh =
        Mesh { vertices: points, faces, normals, uv: texture, uv_faces: uv_corners, ..Mesh::default() };
    let is_solid = solid.unwrap_or_else(|| py.detach(|| Topology::of(&mesh).is_closed));
    mesh.inside_vector = is_solid.then_some(INSIDE);
    Ok((Object(SceneObject::new(Shape::Mesh(Arc::new(mesh)))), is_solid))
}

type Arrays<'py> = (
    String,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i64>>,
    Option<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>)>,
    Option<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>)>,
);

/// What a mesh file holds: its groups as arrays; and for each placement the group's number and a matrix of three rows.
type FileContents<'py> = (Vec<Arrays<'py>>, Vec<(usize, [[f64; 4]; 3])>, Vec<String>);

pub(crate) fn rows_of<'py, T: numpy::Element, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_iter().flatten().collect::<Vec<T>>()).reshape([count, N])
}

fn arrays<'py>(py: Python<'py>, name: String, mesh: &Mesh) -> PyResult<Arrays<'py>> {
    let wide = |t: [u32; 3]| t.map(i64::from);
    let vertices = rows_of(py, mesh.vertices.iter().map(|p| p.to_array()).collect())?;
    let faces = rows_of(py, mesh.faces.iter().map(|f| wide(f.vertices)).collect())?;
    // Faces without normals in a mesh with some: all become flat.
    let normal_faces: Option<Vec<[i64; 3]>> = mesh.faces.iter().map(|f| f.normals.map(wide)).collect();
    let normals = match normal_faces {
        Some(faces) if !mesh.normals.is_empty() => {
            let normals = mesh.normals.iter().map(|n| n.to_array()).collect();
            Some((rows_of(py, normals)?, rows_of(py, faces)?))
        }
        _ => None,
    };
    let uv_faces: Option<Vec<[i64; 3]>> = mesh.uv_faces.iter().map(|f| f.map(wide)).collect();
    let uv = match uv_faces {
        Some(faces) if !faces.is_empty() => Some((rows_of(py, mesh.uv.clone())?, rows_of(py, faces)?)),
        _ => None,
    };
    Ok((name, vertices, faces, normals, uv))
}

/// The groups, placements and warnings of a mesh file.
#[pyfunction]
fn read_mesh(py: Python<'_>, path: PathBuf) -> PyResult<FileContents<'_>> {
    let model = py.detach(|| durer::mesh::read(&path)).map_err(value_error)?;
    let warnings = model.warnings.iter().map(ToString::to_string).collect();
    let placements = model
        .instances
        .iter()
        .map(|i| {
            let (linear, c) = (i.placement.linear(), i.placement.centre().to_array());
            (i.group, [0, 1, 2].map(|r| [linear[r][0], linear[r][1], linear[r][2], c[r]]))
        })
        .collect();
    let groups = model.groups.into_iter().map(|g| arrays(py, g.name, &g.mesh));
    Ok((groups.collect::<PyResult<_>>()?, placements, warnings))
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(mesh, module)?)?;
    module.add_function(wrap_pyfunction!(read_mesh, module)?)
}

//! Mesh cameras, whose rays start at the faces of meshes.

use std::rc::Rc;
use std::sync::Arc;

use durer_scene::{Distribution, Mesh, Shape};

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::object::Object;
use crate::parser::Parser;
use crate::scene_builder::placement;

/// The meshes of a mesh camera with their objects, and how rays are distributed over their faces.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraMeshes {
    meshes: Vec<(Arc<Mesh>, Rc<Object>)>,
    distribution: Distribution,
    max_distance: Option<f64>,
}

/// Smaller greatest distances mean none (a fact of the scene language).
const NO_DISTANCE: f64 = 1e-10;

impl CameraMeshes {
    /// As data of the scene.
    pub(crate) fn scene(&self) -> Result<durer_scene::MeshCamera> {
        let mut meshes = Vec::with_capacity(self.meshes.len());
        for (mesh, object) in &self.meshes {
            meshes.push((mesh.clone(), placement(&object.place, object.at)?));
        }
        Ok(durer_scene::MeshCamera {
            meshes,
            distribution: self.distribution,
            max_distance: self.max_distance,
        })
    }
}

impl Parser<'_> {
    /// Reads what stands in braces after `mesh_camera`.
    pub(crate) fn mesh_camera(&mut self) -> Result<CameraMeshes> {
        self.expect(Mark::BraceOpen)?;
        self.peek()?;
        let place = self.here();
        let rays = self.float()?;
        self.skip_comma()?;
        if !(1.0..=f64::from(u32::MAX)).contains(&rays) {
            return Err(Error::invalid(
                place,
                format!("a mesh camera has 1 ray per pixel at least, not {rays}"),
            ));
        }
        let rays = rays as u32;
        let kind = self.float()?;
        self.skip_comma()?;
        let max_distance = if self.starts_number()? { Some(self.float()?) } else { None };
        self.skip_comma()?;
        let mut meshes = Vec::new();
        while self.starts_object()? {
            let object = self.object()?;
            let Some(Shape::Mesh(mesh)) = object.shape.leaf() else {
                return Err(Error::invalid(object.at, "a mesh camera consists of meshes"));
            };
            meshes.push((mesh.clone(), object));
            self.check_memory(meshes.len() * size_of::<(Arc<Mesh>, Rc<Object>)>(), place)?;
        }
        if meshes.is_empty() {
            return Err(Error::invalid(place, "this mesh camera has no mesh"));
        }
        let smooth = self.take_word(Keyword::Smooth)?;
        self.expect(Mark::BraceClose)?;
        let invalid = |text: String| Err(Error::invalid(place, text));
        let distribution = match kind as u32 {
            0 if rays as usize > meshes.len() => {
                return invalid(format!("with distribution 0, {rays} rays per pixel need {rays} meshes"));
            }
            0 => Distribution::Each(rays),
            1 => Distribution::Joined(rays),
            2 | 3 if rays > 1 => {
                return invalid(format!("with distribution {kind}, a pixel has 1 ray, not {rays}"));
            }
            2 => Distribution::SideBySide,
            3 => Distribution::Uv { smooth },
            _ => return invalid(format!("the distribution of a mesh camera is 0, 1, 2 or 3, not {kind}")),
        };
        Ok(CameraMeshes { meshes, distribution, max_distance: max_distance.filter(|far| *far > NO_DISTANCE) })
    }
}

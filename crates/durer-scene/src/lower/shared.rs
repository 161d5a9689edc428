//! What several objects share and is built once: meshes, which are instanced for every object, and octrees of
//! isosurfaces.

use std::collections::HashMap;
use std::sync::Arc;

use durer_geometry::{Geometry, PrimitiveId};
use durer_math::Affine;
use durer_surfaces::Isosurface;

use super::{LowerErrorKind, Lowering, build, shapes};
use crate::{Mesh, Object, Shape};

/// The meshes that occur in more than one of a scene's objects, by their addresses, which do not
/// change while the scene is borrowed.
pub(super) struct Meshes {
    built: HashMap<*const Mesh, Option<Arc<Geometry>>>,
}

impl Meshes {
    pub(super) fn of(objects: &[Object]) -> Self {
        let mut counts: HashMap<*const Mesh, u32> = HashMap::new();
        for object in objects {
            if let Shape::Mesh(mesh) = &object.shape {
                *counts.entry(Arc::as_ptr(mesh)).or_default() += 1;
            }
        }
        let shared = counts.into_iter().filter(|c| c.1 > 1);
        Self { built: shared.map(|c| (c.0, None)).collect() }
    }

    /// The mesh that an object consists of, if other objects share it.
    pub(super) fn whole<'o>(&self, object: &'o Object) -> Option<&'o Arc<Mesh>> {
        match &object.shape {
            Shape::Mesh(mesh) if self.built.contains_key(&Arc::as_ptr(mesh)) => Some(mesh),
            _ => None,
        }
    }
}

/// The isosurfaces so far. Equal ones share their octree, which is long to build.
#[derive(Default)]
pub(super) struct Isosurfaces {
    built: Vec<(crate::Isosurface, Isosurface)>,
}

impl Isosurfaces {
    /// The surface of an isosurface, closed by its container.
    pub(super) fn built(&mut self, iso: &crate::Isosurface) -> shapes::Result<Isosurface> {
        if let Some((_, surface)) = self.built.iter().find(|(known, _)| known == iso) {
            return Ok(surface.clone());
        }
        let container = shapes::container(iso.container)?;
        let made = Isosurface::new(&iso.function, iso.threshold, container);
        let surface = made.map_err(shapes::shape_error)?;
        self.built.push((iso.clone(), surface.clone()));
        Ok(surface)
    }
}

impl Lowering {
    /// Adds an instance of a shared mesh, which is built at its first use.
    pub(super) fn instance(
        &mut self,
        mesh: &Arc<Mesh>,
        place: &Affine,
        primitive: PrimitiveId,
        mask: u32,
        medium: u32,
    ) -> Result<(), LowerErrorKind> {
        let known = self.shared.built.get(&Arc::as_ptr(mesh)).cloned().flatten();
        let geometry = match known {
            Some(geometry) => geometry,
            None => {
                let surface = shapes::mesh(mesh)?;
                let geometry = Arc::new(Geometry::builder().with(surface).build()?);
                self.shared.built.insert(Arc::as_ptr(mesh), Some(Arc::clone(&geometry)));
                geometry
            }
        };
        self.builder.instance_as(&geometry, *place, self.object, primitive, mask);
        let standing = place.bounds(&geometry.bounds()).intersection(self.camera);
        if mesh.inside_vector.is_some() && !standing.is_empty() {
            let mut target = build::Target {
                to: build::To::Scene(&mut self.builder, self.object, primitive, mask),
                clips: Vec::new(),
                inverse: false,
                inside: None,
                camera: self.camera,
                isosurfaces: &mut self.isosurfaces,
            };
            target.contain(&shapes::mesh(mesh)?, Some(place));
            self.around_camera.extend(target.inside.map(|inside| (medium, inside)));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_formula::{Builder, Op};
    use durer_math::Point3;

    #[test]
    fn only_equal_isosurfaces_share_an_octree() {
        let plane = |height: f64| {
            let mut b = Builder::new();
            let (y, height) = (b.input(1).unwrap(), b.constant(height).unwrap());
            let root = b.push(Op::Sub(y, height)).unwrap();
            Arc::new(b.finish(root, 3))
        };
        let cube = |size: f64| {
            let corner = |x: f64| Point3::new(x, x, x);
            crate::Container::Box(corner(-size), corner(size))
        };
        let iso = |height, threshold, size| crate::Isosurface {
            function: plane(height),
            threshold,
            container: cube(size),
        };
        let mut all = Isosurfaces::default();
        for one in [
            iso(0.0, 0.0, 1.0),
            iso(0.0, 0.0, 1.0),
            iso(0.5, 0.0, 1.0),
            iso(0.0, 0.5, 1.0),
            iso(0.0, 0.0, 2.0),
        ] {
            all.built(&one).unwrap();
        }
        // The first two are equal, and each of the others differs from them in one part.
        assert_eq!(all.built.len(), 4);
    }
}

//! The look of each primitive. Primitives are numbered only here: each primitive gets its number
//! together with its look.

use core::ops::Range;
use std::collections::HashMap;
use std::sync::Arc;

use durer_geometry::PrimitiveId;

use super::LowerErrorKind;
use crate::{Chart, Mesh, Placement, Texture};

/// The index of a [`Look`] in [`Lowered::looks`](super::Lowered::looks).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LookId(pub u32);

/// The look of a surface: its texture and the medium behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The texture, placed in the frame.
    pub texture: Arc<Texture>,
    /// From the space in which the texture is placed to the world.
    pub frame: Arc<Placement>,
    /// The index of the medium behind the surface in [`Lowered::media`](super::Lowered::media).
    pub medium: u32,
    /// Whether light from behind counts too.
    pub double_illuminate: bool,
    /// The light group of the surface.
    pub light_group: Option<u32>,
    /// Whether some light may pass.
    pub is_clear: bool,
    /// The look for rays along the normal, if it is different.
    pub inside: Option<LookId>,
    /// The texture coordinates, if the texture is shown by them.
    pub chart: Option<Arc<Chart>>,
}

/// The looks of the primitives of each object.
#[derive(Default)]
pub(super) struct PrimitiveLooks {
    /// The range of each object's primitives in `of_primitive`.
    of_object: Vec<Range<u32>>,
    of_primitive: Vec<LookId>,
}

/// The addresses of a look's texture, frame and chart, and its other members.
type LookKey =
    (*const Texture, *const Placement, Option<*const Chart>, u32, bool, Option<u32>, Option<LookId>);

/// The looks of a scene, under construction.
#[derive(Default)]
pub(super) struct LookTable {
    looks: Vec<Look>,
    /// Known looks, by the addresses of textures and frames. The looks keep these alive.
    known: HashMap<LookKey, LookId>,
    primitives: PrimitiveLooks,
    /// The range of looks of an object that consists of this mesh, with this look and these looks
    /// of its own textures.
    meshes: HashMap<(*const Mesh, LookId, Vec<LookId>), Range<u32>>,
}

impl PrimitiveLooks {
    /// The look of an object's primitive; `None` if there is no such primitive.
    #[inline]
    pub(super) fn of(&self, object: u32, primitive: u32) -> Option<LookId> {
        let looks = self.of_object.get(object as usize)?;
        let at = looks.start.checked_add(primitive).filter(|&at| at < looks.end)?;
        self.of_primitive.get(at as usize).copied()
    }

    /// The number of an object's primitives.
    pub(super) fn count(&self, object: u32) -> u32 {
        self.of_object.get(object as usize).map_or(0, |looks| looks.end - looks.start)
    }
}

impl LookTable {
    /// Starts the next object.
    pub(super) fn begin(&mut self) -> Result<(), LowerErrorKind> {
        let first = self.len()?;
        self.primitives.of_object.push(first..first);
        Ok(())
    }

    /// The number of the object's next primitive.
    pub(super) fn next(&self) -> Result<PrimitiveId, LowerErrorKind> {
        let first = self.primitives.of_object.last().map_or(0, |looks| looks.start);
        Ok(PrimitiveId(self.len()? - first))
    }

    /// Adds the object's next primitive.
    pub(super) fn push(&mut self, look: LookId) {
        self.primitives.of_primitive.push(look);
    }

    /// Ends the object.
    pub(super) fn end(&mut self) -> Result<(), LowerErrorKind> {
        let end = self.len()?;
        if let Some(looks) = self.primitives.of_object.last_mut().filter(|looks| looks.end == looks.start) {
            // An object that shares the looks of another already has its end.
            looks.end = looks.end.max(end);
        }
        Ok(())
    }

    fn len(&self) -> Result<u32, LowerErrorKind> {
        u32::try_from(self.primitives.of_primitive.len()).map_err(|_| LowerErrorKind::TooMany)
    }

    /// The index of a look. Equal looks share one.
    pub(super) fn number(&mut self, look: Look) -> LookId {
        let Look { texture, frame, medium, double_illuminate, light_group, inside, chart, .. } = &look;
        let chart = chart.as_ref().map(Arc::as_ptr);
        let (texture, frame) = (Arc::as_ptr(texture), Arc::as_ptr(frame));
        let key = (texture, frame, chart, *medium, *double_illuminate, *light_group, *inside);
        let looks = &mut self.looks;
        *self.known.entry(key).or_insert_with(|| {
            looks.push(look);
            LookId((looks.len() - 1) as u32)
        })
    }

    /// Gives the current object, which consists of this mesh alone, the range of an earlier object
    /// with the same mesh and looks, if there is one.
    pub(super) fn same_as_before(&mut self, mesh: &Arc<Mesh>, look: LookId, own: Vec<LookId>) -> bool {
        let PrimitiveLooks { of_object, of_primitive } = &mut self.primitives;
        let Some(looks) = of_object.last_mut().filter(|l| l.start as usize == of_primitive.len()) else {
            return false;
        };
        match self.meshes.entry((Arc::as_ptr(mesh), look, own)) {
            std::collections::hash_map::Entry::Occupied(known) => {
                *looks = known.get().clone();
                true
            }
            std::collections::hash_map::Entry::Vacant(new) => {
                new.insert(looks.start..looks.start.saturating_add(mesh.faces.len() as u32));
                false
            }
        }
    }

    /// All looks, and the look of each primitive.
    pub(super) fn finish(self) -> (Vec<Look>, PrimitiveLooks) {
        (self.looks, self.primitives)
    }
}

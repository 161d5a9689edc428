//! What each primitive looks like. Primitives are numbered here and nowhere else: a primitive has a
//! number because it has a look.

use core::ops::Range;
use std::collections::HashMap;
use std::sync::Arc;

use durer_geometry::PrimitiveId;

use super::LowerErrorKind;
use crate::{Mesh, Placement, Texture};

/// The number of a [`Look`] among [`Lowered::looks`](super::Lowered::looks).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LookId(pub u32);

/// What a surface looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Its texture, placed in the frame.
    pub texture: Arc<Texture>,
    /// From the space in which the texture is placed to the world.
    pub frame: Arc<Placement>,
    /// The number of the medium behind it among [`Lowered::media`](super::Lowered::media).
    pub medium: u32,
    /// Light from behind counts too.
    pub double_illuminate: bool,
    /// Some light may pass.
    pub is_clear: bool,
    /// What is seen instead where a ray goes along the normal, if that is something else.
    pub inside: Option<LookId>,
}

/// The looks of the primitives of each object.
#[derive(Default)]
pub(super) struct PrimitiveLooks {
    /// Where the looks of each object's primitives are.
    of_object: Vec<Range<u32>>,
    of_primitive: Vec<LookId>,
}

/// The looks of a scene, under construction.
#[derive(Default)]
pub(super) struct LookTable {
    looks: Vec<Look>,
    /// By the addresses of textures and frames, which the looks keep alive.
    known: HashMap<(*const Texture, *const Placement, u32, bool, Option<LookId>), LookId>,
    primitives: PrimitiveLooks,
    /// Where the looks of an object are that is this mesh, has this look, and whose faces have
    /// these.
    meshes: HashMap<(*const Mesh, LookId, Vec<LookId>), Range<u32>>,
}

impl PrimitiveLooks {
    /// What a primitive of an object looks like; `None` if there is no such primitive.
    #[inline]
    pub(super) fn of(&self, object: u32, primitive: u32) -> Option<LookId> {
        let looks = self.of_object.get(object as usize)?;
        let at = looks.start.checked_add(primitive).filter(|&at| at < looks.end)?;
        self.of_primitive.get(at as usize).copied()
    }

    /// How many primitives an object has.
    pub(super) fn count(&self, object: u32) -> u32 {
        self.of_object.get(object as usize).map_or(0, |looks| looks.end - looks.start)
    }
}

impl LookTable {
    /// Begins with the next object.
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
            // An object with the looks of another has its end already.
            looks.end = looks.end.max(end);
        }
        Ok(())
    }

    fn len(&self) -> Result<u32, LowerErrorKind> {
        u32::try_from(self.primitives.of_primitive.len()).map_err(|_| LowerErrorKind::TooMany)
    }

    /// The number of a look. Surfaces that look alike share one.
    pub(super) fn number(&mut self, look: Look) -> LookId {
        let Look { texture, frame, medium, double_illuminate, inside, .. } = &look;
        let key = (Arc::as_ptr(texture), Arc::as_ptr(frame), *medium, *double_illuminate, *inside);
        let looks = &mut self.looks;
        *self.known.entry(key).or_insert_with(|| {
            looks.push(look);
            LookId((looks.len() - 1) as u32)
        })
    }

    /// Gives the object at hand, which is this mesh and nothing else, the looks of another with the
    /// same textures, if there is one.
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

    /// All looks, and which of them each primitive has.
    pub(super) fn finish(self) -> (Vec<Look>, PrimitiveLooks) {
        (self.looks, self.primitives)
    }
}

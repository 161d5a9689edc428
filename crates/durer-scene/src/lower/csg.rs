//! CSG solids: each becomes one compound, with its leaves in the order of the text.

use std::sync::Arc;

use durer_geometry::{Compound, CompoundBuilder, CsgError, LeafId, Part, PrimitiveId, Shown};
use durer_math::Aabb;

use super::build::{Target, To};
use super::camera_media::Enclosure;
use super::{
    Context, Cutter, Flags, LowerError, LowerErrorKind, Lowering, Purpose, is_clear, join, mask_of, shapes,
    shows_through,
};
use crate::{Object, Operation, Pattern, Placement, Shape, Texture};

/// A compound under construction.
struct Work {
    csg: CompoundBuilder,
    /// Its first primitive number; the leaves' numbers follow.
    first: PrimitiveId,
    /// The medium of the whole solid.
    medium: Option<u32>,
    /// Whether light may pass a leaf.
    is_clear: bool,
}

/// How parts are combined: a union, or one of the operations without inner faces.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Boolean {
    Union,
    Csg(Operation),
}

/// How a part is lowered.
#[derive(Clone, Copy)]
struct How {
    shown: Shown,
    /// Whether its complement is needed.
    inverse: bool,
}

impl Lowering {
    /// Lowers a CSG solid. `inner` has the properties that the parts of `object` inherit.
    pub(super) fn compound<'s>(
        &mut self,
        object: &'s Object,
        around: &Context<'s>,
        inner: Context<'s>,
    ) -> Result<(), LowerError> {
        let fail = |kind: LowerErrorKind| kind.at(object.place);
        let flags = inner.flags;
        let first = self.table.next().map_err(fail)?;
        let mut work = Work { csg: Compound::builder(), first, medium: inner.medium, is_clear: false };
        let whole =
            Context { flags: Flags { inverse: false, open: false, ..flags }, clips: Vec::new(), ..inner };
        let how = How { shown: Shown::All, inverse: around.flags.inverse };
        let part = self.part_of(object, &whole, &mut work, how)?;
        // The clips of the unions around it clip it, too; its own clips are in the part.
        let part = self.cut(part, &around.clips, &mut work)?;
        let is_clipped = !around.clips.is_empty() || !object.clips.is_empty();
        let body = work.csg.build(part).map_err(|e| match e {
            CsgError::Build(e) => fail(e.into()),
            CsgError::Sheet(name) => fail(LowerErrorKind::Sheet(name)),
        })?;
        let body = Arc::new(if is_clipped { body.as_sheet() } else { body });
        let mask = if self.is_plain { durer_geometry::EVERYTHING } else { mask_of(flags, work.is_clear) };
        if !is_clipped {
            self.stand_in(&body, work.medium.unwrap_or(0));
        }
        self.builder.add_compound_as(body, self.object, first, mask);
        Ok(())
    }

    /// Records a solid in which camera rays may start.
    fn stand_in(&mut self, body: &Arc<Compound>, medium: u32) {
        let inside = Enclosure::Compound(Arc::clone(body));
        if self.camera.is_empty() || inside.holds_all(&self.camera) == Some(false) {
            return;
        }
        self.around_camera.push((medium, inside));
    }

    /// The intersection of `part` and the regions that clip it.
    fn cut(&mut self, part: Part, clips: &[Cutter<'_>], work: &mut Work) -> Result<Part, LowerError> {
        if clips.is_empty() {
            return Ok(part);
        }
        let mut parts = vec![part];
        for clip in clips {
            let around = Context { frame: Arc::clone(&clip.frame), ..Context::default() };
            let how = How { shown: Shown::None, inverse: false };
            parts.push(self.part(clip.object, &around, work, how)?);
        }
        Ok(work.csg.intersection(parts))
    }

    /// The part for an object within its surroundings.
    fn part<'s>(
        &mut self,
        object: &'s Object,
        around: &Context<'s>,
        work: &mut Work,
        how: How,
    ) -> Result<Part, LowerError> {
        let inner = if how.shown == Shown::None {
            around.clone()
        } else if object.cutaway_textures.is_some() && object.texture.is_none() && around.texture.is_none() {
            let kind = LowerErrorKind::Cutaway(
                "not supported yet on a merge, intersection or difference that is part of another one",
            );
            return Err(kind.at(object.place));
        } else {
            Context { clips: Vec::new(), ..self.inherited(object, around)? }
        };
        self.part_of(object, &inner, work, how)
    }

    /// The part for an object, with the properties that its own parts inherit.
    ///
    /// A fact of the scene language: a part's clips apply after all complements around the part, so
    /// they are never complemented themselves. Complements are therefore passed down to the leaves.
    fn part_of<'s>(
        &mut self,
        object: &'s Object,
        inner: &Context<'s>,
        work: &mut Work,
        how: How,
    ) -> Result<Part, LowerError> {
        let how = How { inverse: how.inverse != object.flags.inverse, ..how };
        let place =
            join(&object.placement, &inner.frame).map_err(|e| LowerErrorKind::from(e).at(object.place))?;
        let whole = match &object.shape {
            Shape::Union(parts) => self.parts(Boolean::Union, parts, place, inner, work, how)?,
            Shape::Csg(operation, parts) => {
                match object.cutaway_textures.as_ref().filter(|_| inner.texture.is_none()) {
                    Some(unlent) => self.cutaway((*operation, unlent), parts, place, inner, work, how)?,
                    None => self.parts(Boolean::Csg(*operation), parts, place, inner, work, how)?,
                }
            }
            _ => self.leaf_of(object, &place, inner, work, how).map_err(|k| k.at(object.place))?,
        };
        let mut clips = Vec::with_capacity(object.clips.len());
        for object in &object.clips {
            clips.push(Cutter { object, frame: Arc::clone(&inner.frame), region: None });
        }
        self.cut(whole, &clips, work)
    }

    fn parts<'s>(
        &mut self,
        operation: Boolean,
        parts: &'s [Object],
        place: Placement,
        inner: &Context<'s>,
        work: &mut Work,
        how: How,
    ) -> Result<Part, LowerError> {
        // De Morgan's laws: the complement of an intersection is the union of complements.
        let is_union = matches!(operation, Boolean::Union | Boolean::Csg(Operation::Merge));
        let any = is_union != how.inverse;
        let mut inner = Context { frame: Arc::new(place), ..inner.clone() };
        if any && let Some(unlent) = inner.unlent.take() {
            inner.texture = Some((unlent, Arc::clone(&inner.frame)));
        }
        let mut made = Vec::with_capacity(parts.len());
        for (i, part) in parts.iter().enumerate() {
            let is_taken_away = operation == Boolean::Csg(Operation::Difference) && i > 0;
            let how = How { inverse: how.inverse != is_taken_away, ..how };
            made.push(self.part(part, &inner, work, how)?);
        }
        let keeps_inner_faces = operation == Boolean::Union && self.purpose == Purpose::Pictures;
        Ok(match any {
            true if keeps_inner_faces => work.csg.union_with_inner_faces(made),
            true => work.csg.union(made),
            false => work.csg.intersection(made),
        })
    }

    /// The parts of an object with `cutaway_textures`, which share their textures.
    fn cutaway<'s>(
        &mut self,
        (operation, unlent): (Operation, &Arc<Texture>),
        parts: &'s [Object],
        place: Placement,
        inner: &Context<'s>,
        work: &mut Work,
        how: How,
    ) -> Result<Part, LowerError> {
        let frame = Arc::new(place);
        let painted = |texture: Arc<Texture>| Some((texture, Arc::clone(&frame)));
        if operation == Operation::Merge || how.inverse {
            let inner = Context { texture: painted(Arc::clone(unlent)), ..inner.clone() };
            return self.parts(Boolean::Csg(operation), parts, (*frame).clone(), &inner, work, how);
        }
        let mut made = Vec::with_capacity(parts.len());
        for (i, part) in parts.iter().enumerate() {
            let lenders = || parts.iter().enumerate().filter(|&(j, _)| j != i);
            // A subtracted part does not contain the visible points.
            let lenders = lenders().filter(|&(j, _)| operation == Operation::Intersection || j == 0);
            let lent = lent(lenders.map(|(_, lender)| lender), unlent)?;
            let texture = painted(lent.unwrap_or_else(|| Arc::clone(unlent)));
            let unlent = Some(Arc::clone(unlent));
            let inner = Context { frame: Arc::clone(&frame), texture, unlent, ..inner.clone() };
            let inverse = how.inverse != (operation == Operation::Difference && i > 0);
            made.push(self.part(part, &inner, work, How { inverse, ..how })?);
        }
        Ok(work.csg.intersection(made))
    }

    /// A leaf: one primitive, or as many as a mesh has faces.
    fn leaf_of(
        &mut self,
        object: &Object,
        place: &Placement,
        context: &Context<'_>,
        work: &mut Work,
        How { shown, inverse }: How,
    ) -> Result<Part, LowerErrorKind> {
        let leaf = if shown == Shown::None {
            Some(LeafId::default())
        } else {
            let (texture, frame) = self.texture_of(context);
            let is_clear = is_clear(object, &texture) || shows_through(&context.inside);
            work.is_clear |= is_clear;
            let medium = self.medium_of(context.medium, is_clear || context.flags.hollow, context.flags);
            if context.medium.is_none() {
                work.medium = self.common_medium;
            }
            let painted = (texture, frame);
            self.looks_of(object, place.affine(), painted, &context.inside, medium, context.flags)?
                .within(work.first)
        };
        // The leaf's number is relative to the compound's first one; `None` if it is too large.
        let leaf = leaf.ok_or(LowerErrorKind::TooMany)?;
        let mut part = None;
        let shown = if object.flags.open && shown == Shown::All { Shown::Wall } else { shown };
        let target = Target {
            to: To::Leaf(&mut work.csg, leaf, shown, &mut part),
            clips: Vec::new(),
            inverse: false,
            inside: None,
            camera: Aabb::EMPTY,
            isosurfaces: &mut self.isosurfaces,
        };
        shapes::build(object, false, place.affine(), target)?;
        let part = part.ok_or(LowerErrorKind::Sheet(object.shape.name()))?;
        Ok(if inverse { work.csg.inverse(part) } else { part })
    }
}

/// The mean of the textures of objects that hold a point; `None` if they have none.
fn lent<'s>(
    lenders: impl Iterator<Item = &'s Object>,
    default: &Arc<Texture>,
) -> Result<Option<Arc<Texture>>, LowerError> {
    let mut lent = Lent { textures: Vec::new(), is_sure: true, default };
    let mut at = None;
    for lender in lenders {
        lent.gather(lender, None, &Placement::IDENTITY, false).map_err(|kind| kind.at(lender.place))?;
        at = at.or(lender.place);
    }
    let Some(first) = lent.textures.first() else { return Ok(None) };
    if lent.textures.iter().all(|texture| texture == first) {
        return Ok(Some(Arc::clone(first)));
    }
    if !lent.is_sure {
        return Err(Lent::unsure().at(at));
    }
    Ok(Some(Arc::new(Texture::pattern(Pattern::Mean(
        lent.textures.into_iter().map(|texture| (1.0, texture)).collect(),
    )))))
}

/// The textures of the leaves that hold a point.
struct Lent<'d> {
    textures: Vec<Arc<Texture>>,
    /// Whether the weight of each one is known.
    is_sure: bool,
    default: &'d Arc<Texture>,
}

impl Lent<'_> {
    fn unsure() -> LowerErrorKind {
        LowerErrorKind::Cutaway(
            "not supported yet for these textures: all parts of a union or merge must have one texture, and the other parts the same one or none",
        )
    }

    /// Adds the textures of an object if it holds the point (or does not, if `outside`). `around`
    /// is the inherited texture; `place` maps from the space around the object to that of the
    /// textures.
    fn gather(
        &mut self,
        object: &Object,
        around: Option<&Arc<Texture>>,
        place: &Placement,
        outside: bool,
    ) -> Result<(), LowerErrorKind> {
        let moved = match &object.texture {
            Some(texture) if texture.is_uniform() || place.is_identity() => Some(Arc::clone(texture)),
            Some(texture) => {
                let mut texture = (**texture).clone();
                texture.transform(place.affine())?;
                Some(Arc::new(texture))
            }
            None => around.cloned(),
        };
        let outside = outside != object.flags.inverse;
        let (parts, operation) = match &object.shape {
            Shape::Union(parts) => (parts, Operation::Merge),
            Shape::Csg(operation, parts) => (parts, *operation),
            _ => {
                self.textures.extend(moved);
                return Ok(());
            }
        };
        let inner = join(&object.placement, place)?;
        let any = (operation == Operation::Merge) != outside;
        // A part of a union without a texture has the default one.
        let around = if any { Some(moved.unwrap_or_else(|| Arc::clone(self.default))) } else { moved };
        let first = self.textures.len();
        for (i, part) in parts.iter().enumerate() {
            let is_taken_away = operation == Operation::Difference && i > 0;
            if any || !is_taken_away {
                self.gather(part, around.as_ref(), &inner, outside != is_taken_away)?;
            }
        }
        if any && let Some((one, others)) = self.textures[first..].split_first() {
            if others.iter().any(|other| other != one) {
                return Err(Self::unsure());
            }
            if !others.is_empty() {
                self.is_sure = false;
                self.textures.truncate(first + 1);
            }
        }
        Ok(())
    }
}

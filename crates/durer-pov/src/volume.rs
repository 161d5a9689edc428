//! Solids of which parts have no volume: flat boxes, and shapes that show nothing, such as a sphere
//! of radius 0.
//!
//! In a merge, intersection or difference, a flat box counts only as its rectangle, as in POV-Ray.
//! The rectangle is seen where the other parts leave it, and it neither adds nor removes volume. A
//! shape that shows nothing is the empty set. The `inverse` of both is all of space. So every
//! object is divided in two:
//!
//! - its volume: a solid, nothing, or all of space;
//! - its sheets: the rectangles of flat boxes, clipped by the volumes of the other parts.

use std::rc::Rc;

use durer_scene as scene;
use scene::Operation;

use crate::diagnostics::Result;
use crate::object::{Object, Shape};
use crate::parser::Parser;
use crate::scene_builder::{Lights, move_lights, point, vector};

/// A set of points.
#[derive(Debug, PartialEq)]
enum Volume<T> {
    Empty,
    Space,
    Of(T),
}

/// The volumes of parts, and the sheets of each.
type VolumesAndParts = (Vec<Volume<scene::Object>>, Vec<Vec<scene::Object>>);

impl<T> Volume<T> {
    /// Applies `inverse` to nothing and to all of space; solids have a flag of their own for it.
    fn inverted(self) -> Self {
        match self {
            Self::Empty => Self::Space,
            Self::Space => Self::Empty,
            solid @ Self::Of(_) => solid,
        }
    }
}

/// An object, divided into its volume and its sheets.
pub(crate) struct Parted {
    volume: Volume<scene::Object>,
    sheets: Vec<scene::Object>,
}

impl Parted {
    /// All surfaces together; `None` if there are none.
    pub(crate) fn surfaces(self) -> Option<scene::Object> {
        let mut all = self.sheets;
        if let Volume::Of(solid) = self.volume {
            all.insert(0, solid);
        }
        if all.len() > 1 { Some(scene::Object::new(scene::Shape::Union(all))) } else { all.pop() }
    }
}

impl Parser<'_> {
    /// Divides an object into volume and sheets.
    fn parted(&mut self, object: &Object, lights: &mut Lights) -> Result<Parted> {
        if object.lacks_volume {
            return self.without_volume(object, lights);
        }
        let volume = self.emitted(object, lights)?.map_or(Volume::Empty, Volume::Of);
        Ok(Parted { volume, sheets: Vec::new() })
    }

    /// Divides an object that [lacks volume](Object::lacks_volume) somewhere.
    pub(crate) fn without_volume(&mut self, object: &Object, lights: &mut Lights) -> Result<Parted> {
        let (volume, sheets) = match &object.shape {
            Shape::Nothing => (Volume::Empty, Vec::new()),
            &Shape::FlatBox { a, b } => (Volume::Empty, vec![scene::Object::new(rectangle(a, b))]),
            Shape::Light(light) => {
                lights.push((light.clone(), object.place, self.scene.group));
                (Volume::Empty, Vec::new())
            }
            Shape::Union(parts) => {
                let first = lights.len();
                let (volumes, sheets) = self.all_parted(parts, lights)?;
                move_lights(&mut lights[first..], &object.place);
                (united(volumes), sheets.concat())
            }
            Shape::Csg(operation, parts) => {
                let (volumes, sheets) = self.all_parted(parts, lights)?;
                let sheets = clipped(*operation, &volumes, sheets);
                (combined(*operation, volumes), sheets)
            }
            Shape::Deform(solid, warps) => {
                let Some(clips) = self.clips_with_volume(object)? else {
                    return Ok(Parted { volume: Volume::Empty, sheets: Vec::new() });
                };
                let volume = Volume::Of(self.emitted_deformed(object, solid, warps, clips)?);
                return Ok(Parted { volume, sheets: Vec::new() });
            }
            _ => (Volume::Of(self.surface(object)?), Vec::new()),
        };
        let Some(clips) = self.clips_with_volume(object)? else {
            return Ok(Parted { volume: Volume::Empty, sheets: Vec::new() });
        };
        let mut shown = Vec::new();
        if !sheets.is_empty() {
            let mut sheet = self.finished_object(object, together(sheets), clips.clone())?;
            (sheet.flags.inverse, sheet.cutaway_textures) = (false, None);
            shown.push(sheet);
        }
        let volume = match volume {
            Volume::Of(shape) => Volume::Of(self.finished_object(object, shape, clips)?),
            Volume::Empty => Volume::Empty,
            Volume::Space => Volume::Space,
        };
        let volume = if object.habits.inverse { volume.inverted() } else { volume };
        Ok(Parted { volume, sheets: shown })
    }

    fn all_parted(&mut self, parts: &[Rc<Object>], lights: &mut Lights) -> Result<VolumesAndParts> {
        let (mut volumes, mut sheets) = (Vec::with_capacity(parts.len()), Vec::with_capacity(parts.len()));
        for part in parts {
            let parted = self.parted(part, lights)?;
            volumes.push(parted.volume);
            sheets.push(parted.sheets);
        }
        Ok((volumes, sheets))
    }

    /// The solids that clip an object; `None` if they leave nothing of it.
    fn clips_with_volume(&mut self, object: &Object) -> Result<Option<Vec<scene::Object>>> {
        let mut clips = Vec::with_capacity(object.clips.len());
        for clip in &object.clips {
            match self.parted(clip, &mut Lights::new())?.volume {
                Volume::Of(clip) => clips.push(clip),
                Volume::Empty => return Ok(None),
                Volume::Space => {}
            }
        }
        Ok(Some(clips))
    }
}

/// The rectangle that a box without extent along one axis has become.
fn rectangle(a: [f64; 3], b: [f64; 3]) -> scene::Shape {
    let flat = (0..3).find(|&i| a[i] == b[i]).unwrap_or(0);
    let edge = |axis: usize| {
        let mut edge = [0.0; 3];
        edge[axis] = b[axis] - a[axis];
        vector(edge)
    };
    scene::Shape::Parallelogram { corner: point(a), u: edge((flat + 1) % 3), v: edge((flat + 2) % 3) }
}

/// Combines objects into one shape.
fn together(mut objects: Vec<scene::Object>) -> scene::Shape {
    match objects.pop() {
        Some(only) if objects.is_empty() && only == scene::Object::new(only.shape.clone()) => only.shape,
        Some(last) => {
            objects.push(last);
            scene::Shape::Union(objects)
        }
        None => scene::Shape::Union(objects),
    }
}

/// The volume of a union.
fn united(parts: Vec<Volume<scene::Object>>) -> Volume<scene::Shape> {
    match combined(Operation::Merge, parts) {
        Volume::Of(scene::Shape::Csg(_, solids)) => Volume::Of(scene::Shape::Union(solids)),
        other => other,
    }
}

/// The volume of a merge, intersection or difference.
fn combined(mut operation: Operation, mut parts: Vec<Volume<scene::Object>>) -> Volume<scene::Shape> {
    if operation == Operation::Difference && parts.first() == Some(&Volume::Space) {
        // All of space without the others: the intersection of their complements.
        operation = Operation::Intersection;
        parts.remove(0);
        for part in &mut parts {
            match part {
                Volume::Of(solid) => solid.flags.inverse ^= true,
                Volume::Empty => *part = Volume::Space,
                Volume::Space => *part = Volume::Empty,
            }
        }
    }
    let mut solids = Vec::with_capacity(parts.len());
    for (i, part) in parts.into_iter().enumerate() {
        match (operation, part) {
            (_, Volume::Of(solid)) => solids.push(solid),
            (Operation::Merge, Volume::Space) => return Volume::Space,
            (Operation::Intersection, Volume::Empty) => return Volume::Empty,
            (Operation::Difference, Volume::Empty) if i == 0 => return Volume::Empty,
            (Operation::Difference, Volume::Space) => return Volume::Empty,
            (Operation::Merge | Operation::Difference, Volume::Empty)
            | (Operation::Intersection, Volume::Space) => {}
        }
    }
    match (operation, solids.is_empty()) {
        (_, false) => Volume::Of(scene::Shape::Csg(operation, solids)),
        (Operation::Intersection, true) => Volume::Space,
        (_, true) => Volume::Empty,
    }
}

/// Clips the sheets of the parts of a merge, intersection or difference by the other parts.
fn clipped(
    operation: Operation,
    volumes: &[Volume<scene::Object>],
    sheets: Vec<Vec<scene::Object>>,
) -> Vec<scene::Object> {
    let mut left = Vec::new();
    // An empty volume clips nothing, so all parts without volume are clipped by the same other
    // parts.
    let mut flat = Vec::new();
    for (i, sheets) in sheets.into_iter().enumerate().filter(|(_, sheets)| !sheets.is_empty()) {
        if volumes[i] == Volume::Empty && !keeps_inside(operation, i) {
            flat.extend(sheets);
        } else {
            left.extend(clipped_by(operation, volumes, Some(i), sheets));
        }
    }
    if !flat.is_empty() {
        left.extend(clipped_by(operation, volumes, None, flat));
    }
    left
}

/// Whether part `i` of a combination keeps the inside or the outside parts of the others.
fn keeps_inside(operation: Operation, i: usize) -> bool {
    match operation {
        Operation::Merge => false,
        Operation::Intersection => true,
        Operation::Difference => i == 0,
    }
}

/// Clips sheets by all volumes except number `own`.
fn clipped_by(
    operation: Operation,
    volumes: &[Volume<scene::Object>],
    own: Option<usize>,
    sheets: Vec<scene::Object>,
) -> Option<scene::Object> {
    let others = || volumes.iter().enumerate().filter(|(i, _)| Some(*i) != own);
    let leaves_nothing = |(i, volume): (usize, &Volume<_>)| match volume {
        Volume::Empty => keeps_inside(operation, i),
        Volume::Space => !keeps_inside(operation, i),
        Volume::Of(_) => false,
    };
    if others().any(leaves_nothing) {
        return None;
    }
    let mut shown = scene::Object::new(scene::Shape::Union(sheets));
    for (i, volume) in others() {
        if let Volume::Of(solid) = volume {
            let mut clip = solid.clone();
            clip.flags.inverse ^= !keeps_inside(operation, i);
            shown.clips.push(clip);
        }
    }
    Some(shown)
}

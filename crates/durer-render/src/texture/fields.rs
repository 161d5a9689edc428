//! Textures by the fields of a blob's components.
//!
//! ```text
//!   the part of a component's texture at p:  |f_i(p)| / Σ |f_j(p)|,   f = strength (1 - (distance / radius)²)²  within the radius
//! ```
//!
//! A fact of the scene language: what takes away from the sum shows its texture, too. The fields that reach a point are found in a tree of their boxes.

use durer_math::{Aabb, Affine, AffineError, Point3, Vec3};
use durer_scene::{BlobComponent, BlobShape, Fields};

use super::{Paint, Place};

/// Fields are looked at one by one where there are no more than so many.
const FEW: usize = 4;

/// The fields of a blob, each with a texture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Weights {
    /// The space of the blob.
    place: Place,
    /// In the order of the tree.
    fields: Box<[Field]>,
    /// Boxes around ranges of fields: the first one around all; behind each stands its first half, and where that one's own end the second.
    nodes: Box<[Node]>,
    textures: Box<[Paint]>,
}

#[derive(Clone, Debug, PartialEq)]
struct Field {
    /// The component's own frame in that of the blob.
    place: Place,
    start: Point3,
    /// To the other end of the axis, and one over the square of its length.
    axis: Vec3,
    shorter: f64,
    /// One over the square of the radius.
    closer: f64,
    strength: f64,
    texture: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    bounds: Aabb,
    /// Of the fields.
    first: u32,
    count: u32,
    /// The node to go on with where the box is missed.
    next: u32,
}

impl Weights {
    /// Makes fields ready, in whose space `around` is the placement.
    pub(super) fn new(
        fields: &Fields,
        around: &Affine,
        paint: impl Fn(&durer_scene::Texture) -> Result<Paint, AffineError>,
    ) -> Result<Self, AffineError> {
        let mut made: Vec<(Aabb, Field)> = fields
            .components
            .iter()
            .map(|(component, texture)| (reach(component), Field::new(component, *texture)))
            .collect();
        let mut nodes = Vec::new();
        divide(&mut made, 0, &mut nodes);
        Ok(Self {
            place: Place::new(&fields.placement.affine().then(around)?),
            fields: made.into_iter().map(|(_, field)| field).collect(),
            nodes: nodes.into(),
            textures: fields.textures.iter().map(|t| paint(t)).collect::<Result<_, _>>()?,
        })
    }

    /// The texture with a number.
    pub(crate) fn texture(&self, number: u32) -> &Paint {
        &self.textures[number as usize]
    }

    /// Appends the textures that are shown at a point, with their parts, which add up to 1: to each texture once, ascending.
    pub(crate) fn shown(&self, p: Point3, shown: &mut Vec<(u32, f64)>) {
        let p = self.place.inside(p);
        let first = shown.len();
        let mut sum = 0.0;
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if !node.bounds.contains(p) {
                at = node.next as usize;
                continue;
            }
            at += 1;
            if node.next as usize > at {
                continue;
            }
            for field in &self.fields[node.first as usize..(node.first + node.count) as usize] {
                let part = field.at(p).abs();
                if part > 0.0 {
                    sum += part;
                    match shown[first..].iter_mut().find(|(texture, _)| *texture == field.texture) {
                        Some((_, all)) => *all += part,
                        None => shown.push((field.texture, part)),
                    }
                }
            }
        }
        if shown.len() == first {
            // A point that rounding has put beyond all fields: the first texture is as good as any.
            shown.push((0, 1.0));
            return;
        }
        for (_, part) in &mut shown[first..] {
            *part /= sum;
        }
        shown[first..].sort_unstable_by_key(|&(texture, _)| texture);
    }
}

impl Field {
    fn new(component: &BlobComponent, texture: u32) -> Self {
        let (start, axis) = match component.shape {
            BlobShape::Ball(centre) => (centre, Vec3::ZERO),
            BlobShape::Segment(a, b) => (a, b - a),
        };
        let length = axis.dot(axis);
        Self {
            place: Place::new(&component.place),
            start,
            axis,
            shorter: if length > 0.0 { 1.0 / length } else { 0.0 },
            closer: 1.0 / (component.radius * component.radius),
            strength: component.strength,
            texture,
        }
    }

    /// The field at a point of the blob's space.
    fn at(&self, p: Point3) -> f64 {
        let v = self.place.inside(p) - self.start;
        let along = (v.dot(self.axis) * self.shorter).clamp(0.0, 1.0);
        let away = v - self.axis * along;
        let left = (1.0 - away.dot(away) * self.closer).max(0.0);
        self.strength * left * left
    }
}

/// A box around all that a field reaches, of any size if that is not finite.
fn reach(component: &BlobComponent) -> Aabb {
    component.bounds().unwrap_or(Aabb::UNBOUNDED)
}

/// Puts down the box around some fields, of which the first one has that number, and halves them, by where they are along its longest side.
fn divide(fields: &mut [(Aabb, Field)], first: u32, nodes: &mut Vec<Node>) {
    let bounds = fields.iter().fold(Aabb::EMPTY, |all, (bounds, _)| all.union(*bounds));
    let at = nodes.len();
    nodes.push(Node { bounds, first, count: fields.len() as u32, next: 0 });
    if fields.len() > FEW {
        let size = bounds.max - bounds.min;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = fields.len() / 2;
        fields.select_nth_unstable_by(middle, |(a, _), (b, _)| a.centre()[axis].total_cmp(&b.centre()[axis]));
        let (low, high) = fields.split_at_mut(middle);
        divide(low, first, nodes);
        divide(high, first + middle as u32, nodes);
    }
    nodes[at].next = nodes.len() as u32;
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::{Colour, Pigment, Placement, Rgb, Texture};
    use std::sync::Arc;

    fn blob(n: usize) -> Fields {
        let mut state = 7_u64;
        let mut dice = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut point = || Point3::new(10.0 * dice(), 10.0 * dice(), 10.0 * dice());
        let components = (0..n).map(|i| {
            let (a, b) = (point(), point());
            let shape =
                if i % 3 == 0 { BlobShape::Segment(a, a + (b - a) * 0.2) } else { BlobShape::Ball(a) };
            let place = match i % 4 {
                0 => Affine::scaling(1.0, 2.0, 0.5).unwrap(),
                _ => Affine::IDENTITY,
            };
            let strength = if i % 5 == 0 { -0.5 } else { 1.0 };
            (BlobComponent { shape, radius: 2.0, strength, place }, (i % 7) as u32)
        });
        let grey = |i: usize| {
            Texture::plain(
                Pigment::solid(Colour::opaque(Rgb::grey(i as f64))),
                durer_scene::Finish::default(),
            )
        };
        Fields {
            placement: Placement::IDENTITY,
            components: components.collect(),
            textures: (0..7).map(|i| Arc::new(grey(i))).collect(),
        }
    }

    #[test]
    fn the_tree_shows_what_all_fields_together_show() {
        for n in [1, 3, 40, 500] {
            let fields = blob(n);
            let weights =
                Weights::new(&fields, &Affine::IDENTITY, |t| Paint::new(t, &Affine::IDENTITY, Rgb::WHITE))
                    .unwrap();
            for i in 0..500 {
                let p = Point3::new(
                    f64::from(i % 10),
                    f64::from(i / 10 % 10) + 0.3,
                    f64::from(i / 100) * 2.0 + 0.1,
                );
                let mut parts = [0.0; 7];
                for field in &weights.fields {
                    parts[field.texture as usize] += field.at(p).abs();
                }
                let sum: f64 = parts.iter().sum();
                let mut shown = Vec::new();
                weights.shown(p, &mut shown);
                if sum == 0.0 {
                    assert_eq!(shown, [(0, 1.0)]);
                    continue;
                }
                assert!(shown.windows(2).all(|w| w[0].0 < w[1].0));
                for (texture, part) in parts.iter().enumerate() {
                    let told =
                        shown.iter().find(|(t, _)| *t as usize == texture).map_or(0.0, |(_, part)| *part);
                    // The same terms, in the order of the tree or not: each sum passes as many roundings as there are fields.
                    let rounding = 2.0 * (n as f64 + 2.0) * durer_math::U;
                    assert!(
                        (told - part / sum).abs() <= rounding,
                        "{n} {p:?} {texture}: {told} {}",
                        part / sum
                    );
                }
            }
        }
    }
}

//! Textures mixed by weights: those of a blob's components by the strengths of their fields, those
//! of a triangle's corners by barycentric coordinates.
//!
//! ```text
//!   the part of a texture at p:  |f_i(p)| / Σ |f_j(p)|
//!   in a triangle a b c, n = (b - a) × (c - a):  f_a = (b - p) × (c - p) . n,  and so on
//! ```
//!
//! Components that subtract from the field show their texture too (a fact of the scene language).

use std::collections::HashMap;
use std::sync::Arc;

use durer_math::{Affine, AffineError, Point3};
use durer_scene::{FieldWeights, Fields, Texture};

use super::{Place, RenderTexture};

/// Textures with functions that give their weights.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Weights {
    /// The placement of the space in which weights are computed.
    place: Place,
    by: FieldWeights,
    /// The index of each component's texture. Components without a texture have the first one.
    of: Box<[u32]>,
    textures: Box<[RenderTexture]>,
}

impl Weights {
    /// Prepares the fields in a texture with this placement; `paint` prepares a texture in the same
    /// placement.
    pub(super) fn new(
        fields: &Fields,
        around: &Affine,
        paint: impl Fn(&Texture, &Affine) -> Result<RenderTexture, AffineError>,
    ) -> Result<Self, AffineError> {
        let place = fields.placement.affine().then(around)?;
        let mut textures = vec![paint(&fields.rest, around)?];
        let mut known = HashMap::new();
        let mut of = Vec::with_capacity(fields.textures.len());
        for texture in &fields.textures {
            of.push(match texture {
                None => 0,
                Some(texture) => match known.get(&Arc::as_ptr(texture)) {
                    Some(&number) => number,
                    None => {
                        let number = textures.len() as u32;
                        textures.push(paint(texture, &place)?);
                        known.insert(Arc::as_ptr(texture), number);
                        number
                    }
                },
            });
        }
        Ok(Self {
            place: Place::new(&place),
            by: fields.by.clone(),
            of: of.into(),
            textures: textures.into(),
        })
    }

    /// The texture with an index.
    pub(crate) fn texture(&self, number: u32) -> &RenderTexture {
        &self.textures[number as usize]
    }

    /// The textures at a point with their weights, which add up to 1. Each texture occurs once; the
    /// indices ascend.
    pub(crate) fn shown(&self, p: Point3, shown: &mut Vec<(u32, f64)>) {
        shown.clear();
        let mut sum = 0.0;
        let mut take = |component: usize, value: f64| {
            let (texture, part) = (self.of.get(component).copied().unwrap_or(0), value.abs());
            sum += part;
            match shown.iter_mut().find(|(known, _)| *known == texture) {
                Some((_, all)) => *all += part,
                None => shown.push((texture, part)),
            }
        };
        let p = self.place.inside(p, super::Around::NOWHERE);
        match &self.by {
            FieldWeights::Blob(blob) => blob.fields_at(p, take),
            FieldWeights::Triangle(corners) => {
                let parts = barycentric(corners, p).into_iter().enumerate();
                parts.filter(|(_, part)| *part > 0.0).for_each(|(corner, part)| take(corner, part));
            }
        }
        if !(sum > 0.0 && sum < f64::INFINITY) {
            // No field reaches a point that is not on the surface, and a triangle may have no area.
            shown.clear();
            shown.push((0, 1.0));
            return;
        }
        for (_, part) in &mut *shown {
            *part /= sum;
        }
        shown.sort_unstable_by_key(|&(texture, _)| texture);
    }
}

/// The barycentric coordinates of a point, times the square of twice the triangle's area; negative
/// ones are replaced by 0.
fn barycentric([a, b, c]: &[Point3; 3], p: Point3) -> [f64; 3] {
    let n = (*b - *a).cross(*c - *a);
    let part = |from: Point3, to: Point3| (from - p).cross(to - p).dot(n).max(0.0);
    [part(*b, *c), part(*c, *a), part(*a, *b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Vec3;
    use durer_scene::{BlobComponent, BlobShape, Colour, Finish, Pigment, Placement, Rgb};
    use durer_surfaces::Blob;

    fn grey(v: f64) -> Arc<Texture> {
        Arc::new(Texture::plain(Pigment::solid(Colour::opaque(Rgb::grey(v))), Finish::default()))
    }

    #[test]
    fn textures_at_corners_are_shown_by_barycentric_coordinates() {
        let corners = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 3.0]].map(Point3::from);
        let fields = Fields {
            placement: Placement::IDENTITY,
            by: FieldWeights::Triangle(corners),
            textures: vec![Some(grey(0.5)), Some(grey(1.0)), Some(grey(2.0))],
            rest: grey(0.0),
        };
        let paint = |texture: &Texture, around: &Affine| {
            RenderTexture::new(texture, around, &Affine::IDENTITY, Rgb::WHITE)
        };
        let weights = Weights::new(&fields, &Affine::IDENTITY, paint).unwrap();
        let mut shown = Vec::new();
        let [a, b, c] = corners.map(Point3::to_vec);
        weights.shown((a * 0.5 + b * 0.25 + c * 0.25).to_point(), &mut shown);
        assert_eq!(shown, [(1, 0.5), (2, 0.25), (3, 0.25)]);
        weights.shown(corners[1], &mut shown);
        assert_eq!(shown, [(2, 1.0)]);
    }

    /// Each field value at the test points is a dyadic number, so all sums are exact.
    #[test]
    fn textures_are_shown_by_how_strong_their_fields_are() {
        let ball = |x: f64, strength: f64, place: Affine| BlobComponent {
            shape: BlobShape::Ball(Point3::new(x, 0.0, 0.0)),
            radius: 2.0,
            strength,
            place,
        };
        // At the origin: (1 - 1/4)² = 9/16, a subtracted half of that, zero, 9/16 of a translated
        // ball, and (1 - 0)² / 4 of a cylinder.
        let cylinder = BlobShape::Segment(Point3::new(0.0, -1.0, 0.0), Point3::new(0.0, 1.0, 0.0));
        let components = [
            ball(1.0, 1.0, Affine::IDENTITY),
            ball(-1.0, -0.5, Affine::IDENTITY),
            ball(2.0, 8.0, Affine::IDENTITY),
            ball(0.0, 1.0, Affine::translation(Vec3::new(0.0, 0.0, 1.0)).unwrap()),
            BlobComponent { shape: cylinder, radius: 1.0, strength: 0.25, place: Affine::IDENTITY },
        ];
        let red = grey(0.5);
        let textures = vec![Some(Arc::clone(&red)), Some(grey(1.0)), Some(grey(2.0)), Some(red)];
        let fields = Fields {
            placement: Placement::new(Affine::scaling(2.0, 2.0, 2.0).unwrap()),
            by: FieldWeights::Blob(Blob::new(0.25, &components).unwrap()),
            textures,
            rest: grey(0.0),
        };
        let paint = |texture: &Texture, around: &Affine| {
            RenderTexture::new(texture, around, &Affine::IDENTITY, Rgb::WHITE)
        };
        let weights =
            Weights::new(&fields, &Affine::translation(Vec3::new(0.0, 3.0, 0.0)).unwrap(), paint).unwrap();
        let mut shown = Vec::new();
        weights.shown(Point3::new(0.0, 3.0, 0.0), &mut shown);
        // The cylinder has no texture, and two balls share one.
        let (two, taken, rest) = (2.0 * 0.5625, 0.28125, 0.25);
        let sum = two + taken + rest;
        assert_eq!(shown, [(0, rest / sum), (1, two / sum), (2, taken / sum)]);
        // Far away only the blob's own texture is shown.
        weights.shown(Point3::new(0.0, 300.0, 0.0), &mut shown);
        assert_eq!(shown, [(0, 1.0)]);
    }
}

//! Textures made ready for rendering: placements inverted and joined, constants worked out.

mod brick;
mod cells;
mod checker;
mod gradient;
mod hexagon;
mod place;
mod wave;

pub(crate) use self::place::Place;

use durer_math::{Affine, AffineError, Point3};
use durer_scene::{Colour, Pattern, Pigment, PigmentBody, Rgb, Texture, TextureBody};

use crate::material::Finish;
use cells::Cutter;
use gradient::Lookup;

/// A texture of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Layers, the innermost first.
    Layers(Box<[Coat]>),
    /// Other textures by a pattern, in the space of the place.
    Pattern(Place, Box<Blend<Paint>>),
}

/// A layer of paint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coat {
    pub(crate) pigment: Shade,
    pub(crate) finish: Finish,
}

/// A pigment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shade {
    Solid(Colour),
    Colours(Place, Box<Blend<Colour>>),
    Shades(Place, Box<Blend<Shade>>),
}

/// A choice or a blend of entries by the place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Blend<T> {
    Cells(Cutter, Box<[T]>),
    Map(Lookup, Box<[(f64, T)]>),
}

/// What a pattern shows at a point.
pub(crate) enum Shown<'a, T> {
    /// One entry.
    One(&'a T),
    /// The part `k` of the second entry, and the rest of the first.
    Two(&'a T, &'a T, f64),
}

impl<T> Blend<T> {
    fn new<S>(
        pattern: &Pattern<S>,
        mut entry: impl FnMut(&S) -> Result<T, AffineError>,
    ) -> Result<Self, AffineError> {
        Ok(match pattern {
            Pattern::Cells { cells, entries } => {
                Self::Cells(Cutter::new(*cells), entries.iter().map(entry).collect::<Result<_, _>>()?)
            }
            Pattern::Map { value, entries } => Self::Map(
                Lookup::new(value),
                entries.iter().map(|(at, e)| Ok((*at, entry(e)?))).collect::<Result<_, AffineError>>()?,
            ),
        })
    }

    /// What is shown at a point; `None` only for a pattern without entries.
    #[inline]
    pub(crate) fn at(&self, p: Point3) -> Option<Shown<'_, T>> {
        match self {
            Self::Cells(cutter, entries) => {
                entries.get(cutter.kind(p)).or_else(|| entries.last()).map(Shown::One)
            }
            Self::Map(lookup, entries) => {
                let w = lookup.value(p);
                let (last_at, last) = entries.last()?;
                if w >= *last_at {
                    return Some(Shown::One(last));
                }
                // Entries need not be sorted: the first one not below `w` counts.
                let i = entries.iter().position(|(at, _)| w <= *at)?;
                let (at, entry) = &entries[i];
                if i == 0 {
                    return Some(Shown::One(entry));
                }
                let (before_at, before) = &entries[i - 1];
                let k = (w - before_at) / (at - before_at);
                Some(if at > before_at { Shown::Two(before, entry, k) } else { Shown::One(entry) })
            }
        }
    }
}

impl Shade {
    fn new(pigment: &Pigment, around: &Affine) -> Result<Self, AffineError> {
        let joined = || pigment.placement.affine().then(around);
        Ok(match &pigment.body {
            PigmentBody::Solid(colour) => Self::Solid(*colour),
            PigmentBody::Colours(pattern) => {
                Self::Colours(Place::new(&joined()?), Box::new(Blend::new(pattern, |c| Ok(*c))?))
            }
            PigmentBody::Pigments(pattern) => Self::Shades(
                Place::new(&joined()?),
                Box::new(Blend::new(pattern, |p| Self::new(p, &Affine::IDENTITY))?),
            ),
        })
    }

    /// The colour at a point.
    #[inline]
    pub(crate) fn at(&self, p: Point3) -> Colour {
        match self {
            Self::Solid(colour) => *colour,
            Self::Colours(place, blend) => match blend.at(place.inside(p)) {
                Some(Shown::One(colour)) => *colour,
                Some(Shown::Two(a, b, k)) => a.mix(*b, k),
                None => Colour::default(),
            },
            Self::Shades(place, blend) => {
                let p = place.inside(p);
                match blend.at(p) {
                    Some(Shown::One(shade)) => shade.at(p),
                    Some(Shown::Two(a, b, k)) => a.at(p).mix(b.at(p), k),
                    None => Colour::default(),
                }
            }
        }
    }
}

impl Paint {
    /// Makes a texture ready. Its own placement is joined with that of `around`, the space in which it is used.
    pub(crate) fn new(texture: &Texture, around: &Affine, ambient_light: Rgb) -> Result<Self, AffineError> {
        let joined = || match texture.placement.is_identity() {
            true => Ok(*around),
            false => texture.placement.affine().then(around),
        };
        Ok(match &texture.body {
            TextureBody::Layers(layers) => {
                let place = if texture.is_uniform() { Affine::IDENTITY } else { joined()? };
                let coat = |layer: &durer_scene::Layer| {
                    Ok(Coat {
                        pigment: Shade::new(&layer.pigment, &place)?,
                        finish: Finish::new(&layer.finish, ambient_light),
                    })
                };
                Self::Layers(layers.iter().map(coat).collect::<Result<_, AffineError>>()?)
            }
            TextureBody::Pattern(pattern) => Self::Pattern(
                Place::new(&joined()?),
                Box::new(Blend::new(pattern, |t| Self::new(t, &Affine::IDENTITY, ambient_light))?),
            ),
        })
    }

    /// Calls `f` with each stack of layers shown at a point, its weight, and the point in its space.
    pub(crate) fn each<'a>(&'a self, p: Point3, weight: f64, f: &mut impl FnMut(&'a [Coat], f64, Point3)) {
        match self {
            Self::Layers(coats) => f(coats, weight, p),
            Self::Pattern(place, blend) => {
                let p = place.inside(p);
                match blend.at(p) {
                    Some(Shown::One(paint)) => paint.each(p, weight, f),
                    Some(Shown::Two(a, b, k)) => {
                        a.each(p, weight * (1.0 - k), f);
                        b.each(p, weight * k, f);
                    }
                    None => {}
                }
            }
        }
    }

    /// What light that passes at a point is multiplied by.
    pub(crate) fn passed(&self, p: Point3) -> Rgb {
        let mut sum = Rgb::BLACK;
        self.each(p, 1.0, &mut |coats, weight, p| {
            let all = coats.iter().fold(Rgb::WHITE, |left, coat| left * coat.pigment.at(p).passed());
            sum += all * weight;
        });
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::Vec3;
    use durer_scene::{Cells, Ramp, Value};

    fn grey(v: f64) -> Colour {
        Colour::opaque(Rgb::grey(v))
    }

    fn ramp(entries: &[(f64, f64)]) -> Shade {
        let entries = entries.iter().map(|&(at, v)| (at, grey(v))).collect();
        let value = Value::new(Ramp::Gradient(Vec3::X));
        Shade::new(&Pigment::colours(Pattern::Map { value, entries }), &Affine::IDENTITY).unwrap()
    }

    fn at(shade: &Shade, x: f64) -> f64 {
        shade.at(Point3::new(x, 0.0, 0.0)).rgb.r
    }

    #[test]
    fn maps_blend_between_entries_and_hold_beyond_them() {
        let shade = ramp(&[(0.25, 1.0), (0.75, 3.0)]);
        assert_eq!([0.1, 0.25, 0.5, 0.75, 0.9].map(|x| at(&shade, x)), [1.0, 1.0, 2.0, 3.0, 3.0]);
    }

    #[test]
    fn the_first_of_two_entries_at_one_value_wins_there() {
        let shade = ramp(&[(0.0, 0.0), (0.5, 1.0), (0.5, 5.0), (1.0, 6.0)]);
        assert_eq!(at(&shade, 0.5), 1.0);
        assert!((at(&shade, 0.5 + 1e-9) - 5.0).abs() < 1e-7);
    }

    #[test]
    fn placements_of_texture_and_pigment_are_joined() {
        let checker = Pattern::Cells { cells: Cells::Checker, entries: vec![grey(0.0), grey(1.0)] };
        let mut pigment = Pigment::colours(checker);
        pigment.transform(&Affine::scaling(2.0, 2.0, 2.0).unwrap()).unwrap();
        let mut texture = Texture::plain(pigment, durer_scene::Finish::default());
        texture.transform(&Affine::translation(Vec3::new(10.0, 0.0, 0.0)).unwrap()).unwrap();
        let paint = Paint::new(&texture, &Affine::IDENTITY, Rgb::WHITE).unwrap();
        let mut seen = Vec::new();
        for x in [10.5, 11.5, 12.5, 13.5, 14.5] {
            paint.each(Point3::new(x, 0.5, 0.5), 1.0, &mut |coats, _, p| {
                seen.push(coats[0].pigment.at(p).rgb.r);
            });
        }
        assert_eq!(seen, [0.0, 0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn patterns_of_textures_split_the_weight() {
        let one =
            |v| std::sync::Arc::new(Texture::plain(Pigment::solid(grey(v)), durer_scene::Finish::default()));
        let value = Value::new(Ramp::Gradient(Vec3::X));
        let texture =
            Texture::pattern(Pattern::Map { value, entries: vec![(0.0, one(1.0)), (1.0, one(2.0))] });
        let paint = Paint::new(&texture, &Affine::IDENTITY, Rgb::WHITE).unwrap();
        let mut sum = 0.0;
        paint.each(Point3::new(0.25, 0.0, 0.0), 1.0, &mut |coats, w, p| {
            sum += w * coats[0].pigment.at(p).rgb.r;
        });
        assert_eq!(sum, 1.25);
    }
}

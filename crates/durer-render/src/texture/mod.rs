//! Textures prepared for rendering: placements combined and inverted, constants precomputed.

mod around;
mod brick;
mod cells;
mod checker;
mod field;
mod fields;
mod grains;
mod hexagon;
mod lookup;
mod normal;
mod picture;
mod place;
mod sampled;
mod square;
mod triangular;
mod warp;
mod wave;

pub(crate) use self::around::{Around, Around8};
pub(crate) use self::field::Stir;
pub(crate) use self::fields::Weights;
pub(crate) use self::grains::{Grains, NoiseSettings, building_with, generator_or_scene, number_of_waves};
pub(crate) use self::place::Place;
pub(crate) use self::sampled::Sampled;

use durer_math::lanes::LANES;
use durer_math::{Affine, AffineError, F8, Isa, M8, Point3};
use durer_scene::{Colour, Pattern, Pigment, PigmentBody, Rgb, Texture, TextureBody};

use crate::lanes::{Colour8, Rgb8};
use crate::material::Finish;
use cells::{Cutter, Kinds};
use lookup::Lookup;
pub(crate) use normal::RenderNormal;
use picture::Picture;

/// The texture of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RenderTexture {
    /// Layers, the innermost first.
    Layers(Box<[RenderLayer]>),
    /// Other textures, selected by a pattern in the space of the placement.
    Pattern(Place, Box<Blend<RenderTexture>>),
    /// Other textures, mixed by the fields of a blob.
    Fields(Box<Weights>),
}

/// A layer of a texture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RenderLayer {
    pub(crate) pigment: RenderPigment,
    pub(crate) finish: Finish,
    pub(crate) normal: Option<Box<RenderNormal>>,
}

/// A pigment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RenderPigment {
    Solid(Colour),
    Colours(Place, Box<Blend<Colour>>),
    Shades(Place, Box<Blend<RenderPigment>>),
    Picture(Place, Picture),
}

/// Entries that a pattern selects or mixes by position.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Blend<T> {
    Cells(Cutter, Box<[T]>),
    Map(Lookup, Box<[(f64, T)]>),
    Mean(Box<[(f64, T)]>),
    /// By the indices of a picture's pixels; after the last entry comes the first.
    Picture(Picture, Box<[T]>),
}

/// The entries of a pattern at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shown {
    /// One entry.
    One(usize),
    /// This entry with the weight `k`, and the entry before it with the rest.
    Two(usize, f64),
    /// Every entry with a weight of its own.
    Each,
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
                Lookup::new(value)?,
                entries.iter().map(|(at, e)| Ok((*at, entry(e)?))).collect::<Result<_, AffineError>>()?,
            ),
            Pattern::Mean(entries) => {
                let whole = entries.iter().map(|(weight, _)| weight).sum::<f64>();
                let entries = entries.iter().map(|(weight, e)| Ok((weight / whole, entry(e)?)));
                Self::Mean(entries.collect::<Result<_, AffineError>>()?)
            }
            Pattern::Image { map, entries } => {
                Self::Picture(Picture::new(map), entries.iter().map(entry).collect::<Result<_, _>>()?)
            }
            // The warps are part of the place of what shows the pattern.
            Pattern::Warped { pattern, .. } => Self::new(pattern, entry)?,
        })
    }

    /// The weight of an entry in the result.
    pub(crate) fn part(&self, shown: Shown, entry: usize) -> f64 {
        match (shown, self) {
            (Shown::One(i), _) if i == entry => 1.0,
            (Shown::Two(i, k), _) if i == entry => k,
            (Shown::Two(i, k), _) if i == entry + 1 => 1.0 - k,
            (Shown::Each, Self::Mean(entries)) => entries[entry].0,
            _ => 0.0,
        }
    }

    /// The entry with an index.
    pub(crate) fn entry(&self, i: usize) -> &T {
        match self {
            Self::Cells(_, entries) | Self::Picture(_, entries) => &entries[i],
            Self::Map(_, entries) | Self::Mean(entries) => &entries[i].1,
        }
    }

    /// The number of entries.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Cells(_, entries) | Self::Picture(_, entries) => entries.len(),
            Self::Map(_, entries) | Self::Mean(entries) => entries.len(),
        }
    }

    /// The entries at a point; `None` only for a pattern without entries.
    #[inline]
    pub(crate) fn at(&self, p: Point3, around: Around) -> Option<Shown> {
        match self {
            Self::Cells(cutter, entries) => {
                Some(Shown::One(cutter.kind(p).min(entries.len().checked_sub(1)?)))
            }
            Self::Mean(entries) => (!entries.is_empty()).then_some(Shown::Each),
            Self::Picture(picture, entries) => {
                (!entries.is_empty()).then(|| Shown::One(picture.index(p) % entries.len()))
            }
            Self::Map(lookup, entries) => looked_up(entries, lookup.value(p, around)),
        }
    }

    /// The entries at some points.
    pub(crate) fn at_lanes(&self, p: Point3<F8>, around: &Around8, live: M8) -> [Option<Shown>; LANES] {
        let mut shown = [None; LANES];
        match self {
            Self::Map(lookup, entries) => {
                let w = lookup.values(p, around, live);
                for i in live.lanes() {
                    shown[i] = looked_up(entries, w.0[i]);
                }
            }
            _ => {
                for i in live.lanes() {
                    shown[i] = self.at(p.to_vec().lane(i).to_point(), around.lane(i));
                }
            }
        }
        shown
    }
}

/// The entries of a map for the value `w`.
fn looked_up<T>(entries: &[(f64, T)], w: f64) -> Option<Shown> {
    let (last_at, _) = entries.last()?;
    if w >= *last_at {
        return Some(Shown::One(entries.len() - 1));
    }
    // Entries need not be sorted: the first one that is not below `w` is used.
    let i = entries.iter().position(|(at, _)| w <= *at)?;
    if i == 0 {
        return Some(Shown::One(i));
    }
    let (before, at) = (entries[i - 1].0, entries[i].0);
    Some(if at > before { Shown::Two(i, (w - before) / (at - before)) } else { Shown::One(i) })
}

impl<T> Blend<T> {
    /// The weighted mean of the colours of all entries.
    fn mean(&self, colour: impl Fn(&T) -> Colour) -> Colour {
        let Self::Mean(entries) = self else { return Colour::default() };
        let (mut mean, mut so_far) = (Colour::default(), 0.0);
        for (weight, entry) in entries {
            so_far += weight;
            mean = mean.mix(colour(entry), if so_far == 0.0 { 0.0 } else { weight / so_far });
        }
        mean
    }
}

impl Blend<Colour> {
    /// The colours at some points.
    #[inline(always)]
    fn colours(&self, p: Point3<F8>, around: &Around8, live: M8) -> Colour8 {
        match self {
            Self::Cells(cutter, entries) => {
                let last = entries.len().saturating_sub(1);
                let entry = |i: usize| entries.get(i.min(last)).copied().unwrap_or_default();
                match cutter.kinds(p) {
                    Kinds::Two(one) => Colour8::splat(entry(1)).or(one, Colour8::splat(entry(0))),
                    Kinds::Three(kind) => {
                        let first = Colour8::splat(entry(0)).or(kind.lt(F8::ONE), Colour8::splat(entry(1)));
                        Colour8::splat(entry(2)).or(kind.gt(F8::ONE), first)
                    }
                    Kinds::Many(kinds) => Colour8::by_lane(live, |i| entry(usize::from(kinds[i]))),
                }
            }
            Self::Picture(picture, entries) => Colour8::by_lane(live, |i| {
                let number = picture.index(p.to_vec().lane(i).to_point());
                if entries.is_empty() { Colour::default() } else { entries[number % entries.len()] }
            }),
            Self::Mean(entries) if entries.is_empty() => Colour8::splat(Colour::default()),
            Self::Mean(_) => Colour8::splat(self.mean(|colour| *colour)),
            Self::Map(lookup, entries) => {
                let w = lookup.values(p, around, live);
                let mut shown = Colour8::splat(Colour::default());
                // In reverse order, so that the first entry not below `w` is used.
                for (i, &(at, colour)) in entries.iter().enumerate().rev() {
                    let here = match i.checked_sub(1).map(|before| entries[before]) {
                        Some((before_at, before)) if at > before_at => {
                            let k = (w - F8::splat(before_at)) / (at - before_at);
                            Colour8::mixed(before, colour, k)
                        }
                        _ => Colour8::splat(colour),
                    };
                    shown = here.or(w.le(F8::splat(at)), shown);
                }
                let (last_at, last) = entries.last().copied().unwrap_or_default();
                Colour8::splat(last).or((F8::splat(last_at)).le(w), shown)
            }
        }
    }
}

impl Blend<RenderPigment> {
    /// The colours at some points.
    fn shades(&self, p: Point3<F8>, around: &Around8, live: M8) -> Colour8 {
        let shown = self.at_lanes(p, around, live);
        let mut sum = Colour8::splat(Colour { rgb: Rgb::BLACK, filter: 0.0, transmit: 0.0 });
        for entry in 0..self.len() {
            let weight = F8(shown.map(|shown| shown.map_or(0.0, |shown| self.part(shown, entry))));
            let lanes = live & !weight.equals(F8::ZERO);
            if lanes.any() {
                let colours = self.entry(entry).colours(p, around, lanes);
                sum = sum.plus(colours, weight, lanes);
            }
        }
        sum
    }
}

impl RenderPigment {
    pub(crate) fn new(pigment: &Pigment, around: &Affine) -> Result<Self, AffineError> {
        let on_chart = pigment.on_chart;
        let joined = || match on_chart {
            true => Ok(*pigment.placement.affine()),
            false => pigment.placement.affine().then(around),
        };
        Ok(match &pigment.body {
            PigmentBody::Solid(colour) => Self::Solid(*colour),
            PigmentBody::Colours(pattern) => Self::Colours(
                Place::warped(&joined()?, pattern).on_chart(on_chart),
                Box::new(Blend::new(pattern, |c| Ok(*c))?),
            ),
            PigmentBody::Pigments(pattern) => Self::Shades(
                Place::warped(&joined()?, pattern).on_chart(on_chart),
                Box::new(Blend::new(pattern, |p| Self::new(p, &Affine::IDENTITY))?),
            ),
            PigmentBody::Image(warps, map) => {
                Self::Picture(Place::through(&joined()?, warps).on_chart(on_chart), Picture::new(map))
            }
        })
    }

    /// The colour at a point.
    pub(crate) fn at(&self, p: Point3, around: Around) -> Colour {
        match self {
            Self::Solid(colour) => *colour,
            Self::Picture(place, picture) => picture.colour(place.inside(p, around)),
            Self::Colours(place, blend) => match blend.at(place.inside(p, around), around) {
                Some(Shown::One(i)) => *blend.entry(i),
                Some(Shown::Two(i, k)) => blend.entry(i - 1).mix(*blend.entry(i), k),
                Some(Shown::Each) => blend.mean(|colour| *colour),
                None => Colour::default(),
            },
            Self::Shades(place, blend) => {
                let p = place.inside(p, around);
                let shade = |i: usize| blend.entry(i).at(p, around);
                match blend.at(p, around) {
                    Some(Shown::One(i)) => shade(i),
                    Some(Shown::Two(i, k)) => shade(i - 1).mix(shade(i), k),
                    Some(Shown::Each) => blend.mean(|shade| shade.at(p, around)),
                    None => Colour::default(),
                }
            }
        }
    }

    /// Stores the colours at some points, in the given lanes.
    pub(crate) fn show(
        &self,
        isa: Isa,
        points: impl Iterator<Item = (Point3<F8>, Around8, M8)>,
        colours: &mut [Colour8],
    ) {
        if let Self::Solid(colour) = self {
            colours.fill(Colour8::splat(*colour));
            return;
        }
        isa.run_in_lanes(
            #[inline(always)]
            || {
                for ((p, around, live), colours) in points.zip(colours) {
                    *colours = self.colours(p, &around, live);
                }
            },
        );
    }

    /// The colours at some points.
    #[inline(always)]
    pub(crate) fn colours(&self, p: Point3<F8>, around: &Around8, live: M8) -> Colour8 {
        match self {
            Self::Solid(colour) => Colour8::splat(*colour),
            Self::Colours(place, blend) => blend.colours(place.inside_lanes(p, around), around, live),
            Self::Shades(place, blend) => blend.shades(place.inside_lanes(p, around), around, live),
            Self::Picture(place, picture) => {
                let p = place.inside_lanes(p, around).to_vec();
                Colour8::by_lane(live, |i| picture.colour(p.lane(i).to_point()))
            }
        }
    }
}

impl RenderTexture {
    /// Prepares a texture. Its own placement is combined with `around`, the placement of the space
    /// in which it is used; `outer` places that space in the world.
    pub(crate) fn new(
        texture: &Texture,
        around: &Affine,
        outer: &Affine,
        ambient_light: Rgb,
    ) -> Result<Self, AffineError> {
        let joined = || match texture.placement.is_identity() {
            true => Ok(*around),
            false => texture.placement.affine().then(around),
        };
        Ok(match &texture.body {
            TextureBody::Layers(layers) => {
                let place = if texture.is_uniform() { Affine::IDENTITY } else { joined()? };
                let coat = |layer: &durer_scene::Layer| {
                    Ok(RenderLayer {
                        pigment: RenderPigment::new(&layer.pigment, &place)?,
                        finish: Finish::new(&layer.finish, ambient_light),
                        normal: match &layer.normal {
                            Some(normal) => Some(Box::new(RenderNormal::new(normal, &place, outer)?)),
                            None => None,
                        },
                    })
                };
                Self::Layers(layers.iter().map(coat).collect::<Result<_, AffineError>>()?)
            }
            TextureBody::Pattern(pattern) => {
                let own = if texture.on_chart { *texture.placement.affine() } else { joined()? };
                let before = place::placement_before(place::warps_of(pattern))?;
                let world = match &texture.turn {
                    Some(turn) => before.then(turn.affine())?.then(around)?.then(outer)?,
                    None => before.then(&own)?.then(outer)?,
                };
                let part =
                    |t: &std::sync::Arc<Texture>| Self::new(t, &Affine::IDENTITY, &world, ambient_light);
                Self::Pattern(
                    Place::warped(&own, pattern).on_chart(texture.on_chart),
                    Box::new(Blend::new(pattern, part)?),
                )
            }
            TextureBody::Fields(fields) => {
                let around = joined()?;
                let paint = |t: &Texture, around: &Affine| Self::new(t, around, outer, ambient_light);
                Self::Fields(Box::new(Weights::new(fields, &around, paint)?))
            }
        })
    }

    /// The normals of the outermost layer at these points, perturbed from those of `around`.
    /// Patterns of textures do not perturb them.
    pub(crate) fn top_normal(&self, p: Point3<F8>, around: &Around8, live: M8) -> durer_math::Vec3<F8> {
        let n = around.normals;
        let Self::Layers(coats) = self else { return n };
        let Some(normal) = coats.last().and_then(|coat| coat.normal.as_ref()) else { return n };
        let mut unit = n;
        for i in live.lanes() {
            unit.set_lane(i, crate::vector::unit(n.lane(i)));
        }
        normal.perturbed(p, &Around8 { normals: unit, ..*around }, live)
    }

    /// The transmittance of the texture at these points.
    #[inline(always)]
    pub(crate) fn passed(&self, p: Point3<F8>, around: &Around8, live: M8) -> Rgb8 {
        match self {
            Self::Layers(coats) => {
                let mut left = Rgb8::WHITE;
                for coat in coats {
                    left = left * coat.pigment.colours(p, around, live).passed();
                }
                left
            }
            Self::Pattern(..) | Self::Fields(_) => {
                let mut left = Rgb8::BLACK;
                for i in live.lanes() {
                    left.set_lane(i, self.passed_at(p.to_vec().lane(i).to_point(), around.lane(i)));
                }
                left
            }
        }
    }

    /// The factor of light that passes the texture at a point.
    fn passed_at(&self, p: Point3, around: Around) -> Rgb {
        match self {
            Self::Layers(coats) => {
                coats.iter().fold(Rgb::WHITE, |left, coat| left * coat.pigment.at(p, around).passed())
            }
            Self::Pattern(place, blend) => {
                let p = place.inside(p, around);
                let passed = |i: usize| blend.entry(i).passed_at(p, around);
                match blend.at(p, around) {
                    Some(Shown::One(i)) => passed(i),
                    Some(Shown::Two(i, k)) => passed(i - 1) * (1.0 - k) + passed(i) * k,
                    Some(Shown::Each) => (0..blend.len()).fold(Rgb::BLACK, |passed, i| {
                        passed + blend.entry(i).passed_at(p, around) * blend.part(Shown::Each, i)
                    }),
                    None => Rgb::BLACK,
                }
            }
            Self::Fields(weights) => {
                let mut shown = Vec::new();
                weights.shown(p, &mut shown);
                let passed =
                    |&(texture, part): &(u32, f64)| weights.texture(texture).passed_at(p, around) * part;
                shown.iter().map(passed).fold(Rgb::BLACK, |sum, passed| sum + passed)
            }
        }
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

    fn ramp(entries: &[(f64, f64)]) -> RenderPigment {
        let entries = entries.iter().map(|&(at, v)| (at, grey(v))).collect();
        let value = Value::new(Ramp::Gradient(Vec3::X));
        RenderPigment::new(&Pigment::colours(Pattern::Map { value, entries }), &Affine::IDENTITY).unwrap()
    }

    fn at(shade: &RenderPigment, x: f64) -> f64 {
        shade.at(Point3::new(x, 0.0, 0.0), Around::NOWHERE).rgb.r
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
        let paint = RenderTexture::new(&texture, &Affine::IDENTITY, &Affine::IDENTITY, Rgb::WHITE).unwrap();
        let RenderTexture::Layers(coats) = &paint else { unreachable!() };
        let seen = [10.5, 11.5, 12.5, 13.5, 14.5].map(|x| {
            let p = Point3::new(x, 0.5, 0.5);
            let lanes = coats[0].pigment.colours(
                Vec3::<F8>::splat(p.to_vec()).to_point(),
                &Around8::NOWHERE,
                M8::ALL,
            );
            assert_eq!(lanes.rgb.lane(3), coats[0].pigment.at(p, Around::NOWHERE).rgb);
            coats[0].pigment.at(p, Around::NOWHERE).rgb.r
        });
        assert_eq!(seen, [0.0, 0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn lanes_have_the_colours_of_single_points() {
        let clear = |v: f64| Colour { rgb: Rgb::new(v, 0.5, 0.25), filter: 0.3, transmit: 0.2 };
        let entries = vec![(0.2, clear(0.0)), (0.6, clear(1.0)), (0.6, grey(0.2)), (0.8, clear(0.7))];
        let value = Value::new(Ramp::Gradient(Vec3::new(1.0, 0.2, 0.0)));
        let map = Pigment::colours(Pattern::Map { value, entries });
        let hexagon = Pattern::Cells { cells: Cells::Hexagon, entries: vec![grey(0.1), clear(0.9)] };
        let hexagon = Pigment::colours(hexagon);
        let both = Pattern::Cells { cells: Cells::Checker, entries: vec![map.clone(), hexagon.clone()] };
        for pigment in
            [map, hexagon, Pigment { body: PigmentBody::Pigments(Box::new(both)), ..Pigment::default() }]
        {
            let shade = RenderPigment::new(&pigment, &Affine::rotation_y(0.4).unwrap()).unwrap();
            for k in -50..50 {
                let x = |a: f64| F8(core::array::from_fn(|i| (f64::from(k) + 0.125 * i as f64) * a));
                let p = Point3::new(x(0.31), x(0.2), x(-0.17));
                let colours = shade.colours(p, &Around8::NOWHERE, M8::ALL);
                for i in 0..8 {
                    let want = shade.at(p.to_vec().lane(i).to_point(), Around::NOWHERE);
                    let (filter, transmit) = (colours.filter.0[i], colours.transmit.0[i]);
                    assert_eq!(Colour { rgb: colours.rgb.lane(i), filter, transmit }, want);
                }
            }
        }
    }

    #[test]
    fn patterns_of_textures_split_the_weight() {
        let one = |v| {
            let pigment = Pigment::solid(Colour { transmit: 1.0, ..grey(v) });
            std::sync::Arc::new(Texture::plain(pigment, durer_scene::Finish::default()))
        };
        let value = Value::new(Ramp::Gradient(Vec3::X));
        let texture =
            Texture::pattern(Pattern::Map { value, entries: vec![(0.0, one(1.0)), (1.0, one(2.0))] });
        let paint = RenderTexture::new(&texture, &Affine::IDENTITY, &Affine::IDENTITY, Rgb::WHITE).unwrap();
        let RenderTexture::Pattern(place, blend) = &paint else { unreachable!() };
        let p = Point3::new(0.25, 0.0, 0.0);
        let shown = blend.at(place.inside(p, Around::NOWHERE), Around::NOWHERE).unwrap();
        assert_eq!([0, 1, 2].map(|i| blend.part(shown, i)), [0.75, 0.25, 0.0]);
        assert_eq!((blend.part(Shown::One(1), 0), blend.part(Shown::One(1), 1)), (0.0, 1.0));
        assert_eq!(
            paint.passed(Vec3::<F8>::splat(p.to_vec()).to_point(), &Around8::NOWHERE, M8::ALL),
            Rgb8::WHITE
        );
    }
}

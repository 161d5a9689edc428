//! The texture builder: turns the reader's textures and patterns into scene data.

use std::sync::Arc;

use durer_scene as scene;

use crate::colour::Colour;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::normal_builder::normal;
use crate::pattern_function::changed_number;
use crate::scene_builder::{finish, placement, vector};
use crate::texture::{Body, Layer, Map, Paint, Pattern, PatternKind, Pigment, Texture, Wave};

pub(crate) fn texture(own: &Texture, at: Place) -> Result<scene::Texture> {
    match own {
        Texture::Layers(layers) => {
            let made = layers.iter().map(|layer| layer_of(layer, at)).collect::<Result<_>>()?;
            Ok(scene::Texture {
                body: scene::TextureBody::Layers(made),
                placement: scene::Placement::IDENTITY,
                on_chart: false,
                turn: None,
            })
        }
        Texture::Patterned { pattern, map } => {
            let made =
                pattern_of(pattern, map, at, |part| texture(part, at).map(Arc::new), Texture::blended)?;
            Ok(scene::Texture {
                body: scene::TextureBody::Pattern(Box::new(made)),
                placement: placement(&pattern.modifiers.place, at)?,
                on_chart: pattern.modifiers.on_chart,
                turn: pattern.modifiers.turn.as_deref().map(|turn| placement(turn, at)).transpose()?,
            })
        }
    }
}

fn layer_of(layer: &Layer, at: Place) -> Result<scene::Layer> {
    Ok(scene::Layer {
        pigment: pigment(&layer.pigment, at)?,
        finish: Arc::new(finish(&layer.finish)),
        normal: match &layer.normal {
            Some(own) => normal(own, at)?.map(Arc::new),
            None => None,
        },
    })
}

pub(crate) fn pigment(own: &Pigment, at: Place) -> Result<scene::Pigment> {
    let kind = match &own.body {
        Body::Solid(color) => return Ok(scene::Pigment::solid(scene::Colour::from_terms(*color))),
        Body::Patterned(kind) => kind.clone(),
        Body::Image(map) => {
            // Only its warps are used.
            let pattern = Pattern { kind: PatternKind::Average, modifiers: own.modifiers.clone() };
            let body = scene::PigmentBody::Image(warps_of(&pattern, at)?, Arc::clone(map));
            let (placement, on_chart) = (placement(&own.modifiers.place, at)?, own.modifiers.on_chart);
            return Ok(scene::Pigment { body, placement, on_chart });
        }
    };
    let pattern = Pattern { kind, modifiers: own.modifiers.clone() };
    let mut made = match own.paint(&pattern.kind) {
        Paint::Colors(map) => scene::Pigment::colours(pattern_of(
            &pattern,
            &map,
            at,
            |color| Ok(scene::Colour::from_terms(*color)),
            |a, b, k| blended(*a, *b, k),
        )?),
        Paint::Pigments(map) => scene::Pigment::pigments(pattern_of(
            &pattern,
            &map,
            at,
            |part| pigment(part, at),
            |a, b, k| match (&a.body, &b.body) {
                (Body::Solid(a), Body::Solid(b)) => Pigment::solid(blended(*a, *b, k)),
                _ => Pigment::blended(a, b, k),
            },
        )?),
    };
    made.placement = placement(&pattern.modifiers.place, at)?;
    made.on_chart = pattern.modifiers.on_chart;
    Ok(made)
}

/// The colour between two colours, with the weight `k` for the second.
fn blended(from: Colour, to: Colour, k: f64) -> Colour {
    core::array::from_fn(|i| from[i] + (to[i] - from[i]) * k)
}

/// A pattern of scene data: `part` converts an entry, `blend` mixes two.
pub(crate) fn pattern_of<T: Clone, U>(
    pattern: &Pattern,
    map: &Map<T>,
    at: Place,
    part: impl FnMut(&T) -> Result<U>,
    blend: impl Fn(&T, &T, f64) -> T,
) -> Result<scene::Pattern<U>> {
    let plain = plain_pattern(pattern, map, at, part, blend)?;
    let warps = warps_of(pattern, at)?;
    Ok(match warps.is_empty() {
        true => plain,
        false => scene::Pattern::Warped { warps, pattern: Box::new(plain) },
    })
}

/// The maps of the point behind the pattern's placement, in the order in which they are applied to
/// the point: the warps of the text from the last to the first, and then turbulence.
pub(crate) fn warps_of(pattern: &Pattern, at: Place) -> Result<Vec<scene::PointWarp>> {
    let modifiers = &pattern.modifiers;
    let mut warps = Vec::new();
    for (before, warp) in modifiers.warps.iter().rev() {
        warps.push(warp.clone());
        if !before.is_identity() {
            warps.push(scene::PointWarp::Placed(placement(before, at)?));
        }
    }
    if !modifiers.turbulence.is_none() && !pattern.kind.stirs_itself() {
        warps.push(scene::PointWarp::Turbulence(modifiers.turbulence.scene()));
    }
    Ok(warps)
}

/// A pattern without its warps.
fn plain_pattern<T: Clone, U>(
    pattern: &Pattern,
    map: &Map<T>,
    at: Place,
    mut part: impl FnMut(&T) -> Result<U>,
    blend: impl Fn(&T, &T, f64) -> T,
) -> Result<scene::Pattern<U>> {
    let cells = match cells_of(&pattern.kind) {
        Some(cells) => cells,
        None => {
            let entries = map.entries.iter().map(|(at, item)| Ok((*at, part(item)?)));
            let entries = entries.collect::<Result<Vec<_>>>()?;
            if pattern.kind == PatternKind::Average {
                return mean(entries, at);
            }
            if let PatternKind::Materials(map) = &pattern.kind {
                let entries = entries.into_iter().map(|(_, entry)| entry).collect();
                return Ok(scene::Pattern::Image { map: Arc::clone(map), entries });
            }
            return Ok(scene::Pattern::Map { value: value_of(pattern, at)?, entries });
        }
    };
    let entry = |number: usize| {
        let plain = |i: usize| map.entries[i].1.clone();
        if pattern.is_plain_list() {
            return plain(number);
        }
        let last = map.entries.len() - 1;
        // If the wave is undefined, the first entry is shown.
        let shown = changed_number(pattern, number).filter(|shown| !shown.is_nan()).unwrap_or(0.0);
        let shown = shown.clamp(0.0, last as f64);
        let below = shown as usize;
        let k = shown - below as f64;
        if k == 0.0 { plain(below) } else { blend(&map.entries[below].1, &map.entries[below + 1].1, k) }
    };
    let entries = (0..map.entries.len()).map(|number| part(&entry(number))).collect::<Result<_>>()?;
    Ok(scene::Pattern::Cells { cells, entries })
}

/// How the pattern of a list divides space.
fn cells_of(kind: &PatternKind) -> Option<scene::Cells> {
    Some(match kind {
        PatternKind::Checker => scene::Cells::Checker,
        PatternKind::Hexagon => scene::Cells::Hexagon,
        PatternKind::Square => scene::Cells::Square,
        PatternKind::Triangular => scene::Cells::Triangular,
        PatternKind::Brick { size, mortar } => scene::Cells::Brick { size: vector(*size), mortar: *mortar },
        _ => return None,
    })
}

fn mean<U>(entries: Vec<(f64, U)>, at: Place) -> Result<scene::Pattern<U>> {
    let whole: f64 = entries.iter().map(|(weight, _)| weight).sum();
    if whole == 0.0 {
        return Err(Error::invalid(at, "the weights of an average are zero in sum"));
    }
    Ok(scene::Pattern::Mean(entries))
}

/// The number of a pattern at each point.
pub(crate) fn value_of(pattern: &Pattern, at: Place) -> Result<scene::Value> {
    let modifiers = &pattern.modifiers;
    Ok(scene::Value {
        ramp: ramp_of(pattern, at)?,
        frequency: modifiers.frequency,
        phase: modifiers.phase,
        wave: match modifiers.wave {
            Wave::Ramp => scene::Wave::Ramp,
            Wave::Triangle => scene::Wave::Triangle,
            Wave::Sine => scene::Wave::Sine,
            Wave::Scallop => scene::Wave::Scallop,
            Wave::Cubic => scene::Wave::Cubic,
            Wave::Poly(power) => scene::Wave::Poly(power),
        },
    })
}

/// Refuses a pavement that does not exist.
fn check_pavement(pavement: &scene::Pavement, place: Place) -> Result<()> {
    let scene::Pavement { sides, tiles, pattern, .. } = *pavement;
    let patterns = scene::Pavement::patterns(sides, tiles);
    if (1..=patterns).contains(&pattern) {
        return Ok(());
    }
    let text = if patterns == 0 {
        let most = if sides == 6 { 5 } else { 6 };
        format!("the tiles of a pavement with {sides} sides have 1 to {most} cells each, not {tiles}")
    } else {
        format!("this pavement has the patterns 1 to {patterns}, not {pattern}")
    };
    Err(Error::invalid(place, text))
}

fn ramp_of(pattern: &Pattern, at: Place) -> Result<scene::Ramp> {
    let own = &pattern.modifiers.turbulence;
    let stirred = || (!own.is_none()).then(|| own.scene());
    let grain = |kind| scene::Ramp::Noise(scene::Grain { kind, generator: own.generator });
    let ripples = |waves| {
        let (frequency, phase) = (pattern.modifiers.frequency, pattern.modifiers.phase);
        scene::Ramp::Ripples(scene::Ripples { waves, frequency, phase })
    };
    let (word, place) = match &pattern.kind {
        PatternKind::Gradient(direction) => return Ok(scene::Ramp::Gradient(vector(*direction))),
        PatternKind::Ramp(ramp, place) => {
            let mut ramp = (**ramp).clone();
            match &mut ramp {
                // Turbulence moves the points of a spiral, and shifts it too (a fact of the language).
                scene::Ramp::Spiral { turbulence, .. } => *turbulence = stirred(),
                scene::Ramp::Crackle(crackle) => crackle.generator = own.generator,
                scene::Ramp::Pavement(pavement) => check_pavement(pavement, *place)?,
                _ => {}
            }
            return Ok(ramp);
        }
        PatternKind::Inside(object, _) => return Ok(scene::Ramp::Inside(Box::new((**object).clone()))),
        PatternKind::GreyOf(own) => return Ok(scene::Ramp::Pigment(Box::new(pigment(own, at)?))),
        PatternKind::Written(word, place) => (*word, *place),
        PatternKind::Checker
        | PatternKind::Hexagon
        | PatternKind::Square
        | PatternKind::Triangular
        | PatternKind::Brick { .. } => {
            let cells = cells_of(&pattern.kind);
            return cells
                .map(scene::Ramp::Kind)
                .ok_or_else(|| Error::invalid(at, "this pattern has no value"));
        }
        PatternKind::Materials(_) | PatternKind::Average => {
            return Err(Error::invalid(at, "this pattern has no value at a point"));
        }
    };
    Ok(match word {
        Keyword::Spherical => scene::Ramp::Spherical,
        Keyword::Cylindrical => scene::Ramp::Cylindrical,
        Keyword::Planar => scene::Ramp::Planar,
        Keyword::Boxed => scene::Ramp::Boxed,
        Keyword::Onion => scene::Ramp::Onion,
        Keyword::Leopard => scene::Ramp::Leopard,
        Keyword::Radial => scene::Ramp::Radial,
        Keyword::Marble => scene::Ramp::Marble(stirred()),
        Keyword::Wood => scene::Ramp::Wood(stirred()),
        Keyword::Bozo | Keyword::Bumps | Keyword::Spotted => grain(scene::GrainKind::Bozo),
        Keyword::Dents => grain(scene::GrainKind::Dents),
        Keyword::Wrinkles => grain(scene::GrainKind::Wrinkles),
        Keyword::Granite => grain(scene::GrainKind::Granite),
        Keyword::Agate => grain(scene::GrainKind::Agate(own.agate, own.scene())),
        Keyword::Cells => scene::Ramp::Cells,
        Keyword::Ripples => ripples(false),
        Keyword::Waves => ripples(true),
        _ => return Err(Error::unsupported(place, word.text())),
    })
}

//! `function { pigment { ... } }`: the colours of a pigment as functions of `x`, `y`, `z`.
//!
//! At a point a pigment shows one entry of a list, or a mixture of two neighbouring entries of a
//! map, on either side of the value `w` of a pattern:
//!
//! ```text
//!   a + (b - a) (w - w_a)/(w_b - w_a),  where w_b is the first position in the map that is not below w
//! ```
//!
//! If a map is continuous, so are the functions; where two entries have the same position, they
//! jump. Pigments without such formulas, and those of noise, are evaluated as on surfaces.

use std::sync::Arc;

use durer_formula::{Builder, Formula, FormulaError, NodeId, Op};
use durer_scene::TextureSource;

use crate::diagnostics::{Error, ErrorKind, Result};
use crate::formulas::pieces::{Knot, chosen};
use crate::noise_pattern;
use crate::parser::Parser;
use crate::pattern_function::{NOT_INVERTIBLE, has_noise, moved, written};
use crate::sampled::Called;
use crate::texture::{Body, Map, Paint, Pattern, PatternKind, Pigment};
use crate::texture_builder;

/// The components of a colour, as steps.
type Colour = [NodeId; 5];

/// Why a pigment cannot be a function.
enum Lack {
    /// No formula of its pattern is known, or it has too many steps.
    Formula,
    /// Its placement is not invertible.
    Place,
}

impl Parser<'_> {
    /// Reads `pigment { ... }`, including the word, as functions of a point: red, green, blue,
    /// filter, transmit.
    pub(crate) fn pigment_function(&mut self) -> Result<Vec<Called>> {
        let place = self.here();
        self.next()?;
        // It does not start from the default pigment (a fact of the language); the pigments inside
        // it do.
        let pigment = self.nested(|r| r.pigment_block(&Pigment::default()))?;
        let mut b = Builder::new();
        let exact: Option<[Formula; 5]> = match everywhere(&mut b, &pigment) {
            Ok(colour) => Some(colour.map(|part| b.finish(part, 3))),
            Err(Lack::Formula) => None,
            Err(Lack::Place) => return Err(Error::invalid(place, NOT_INVERTIBLE)),
        };
        let is_noisy = exact.as_ref().is_some_and(|parts| parts.iter().any(has_noise));
        self.language.noise_is_used |= is_noisy;
        let exact = match exact {
            Some(parts) if !is_noisy => return Ok(parts.map(Called::from).to_vec()),
            Some(parts) => parts.map(Some),
            None => Default::default(),
        };
        let source = Arc::new(TextureSource::Pigment(texture_builder::pigment(&pigment, place)?));
        let parts = exact.into_iter().zip(0_u8..).map(|(exact, part)| Called::texture(&source, part, exact));
        parts
            .collect::<std::result::Result<_, _>>()
            .map_err(|error: FormulaError| Error::at(place, ErrorKind::Limit, error.to_string()))
    }
}

/// The colour of a pigment at the point given by the inputs.
fn everywhere(b: &mut Builder, pigment: &Pigment) -> std::result::Result<Colour, Lack> {
    let mut axis = |number| b.input(number).map_err(|_| Lack::Formula);
    let p = [axis(0)?, axis(1)?, axis(2)?];
    shown(b, p, pigment)
}

/// The colour of a pigment at the point `p`.
fn shown(b: &mut Builder, p: [NodeId; 3], pigment: &Pigment) -> std::result::Result<Colour, Lack> {
    let kind = match &pigment.body {
        Body::Solid(colour) => return constant(b, colour),
        Body::Patterned(kind) => kind.clone(),
        Body::Image(_) => return Err(Lack::Formula),
    };
    let pattern = Pattern { kind: kind.clone(), modifiers: pigment.modifiers.clone() };
    let (value, own) = place_and_value(b, p, &pattern)?;
    if kind == PatternKind::Average {
        return Err(Lack::Formula);
    }
    match pigment.paint(&kind) {
        Paint::Colors(map) => {
            let mut entries = Vec::with_capacity(map.entries.len());
            for (_, colour) in &map.entries {
                entries.push(constant(b, colour)?);
            }
            mapped(b, &pattern, value, &map, &entries)
        }
        Paint::Pigments(map) => {
            let mut entries = Vec::with_capacity(map.entries.len());
            for (_, part) in &map.entries {
                entries.push(shown(b, own, part)?);
            }
            mapped(b, &pattern, value, &map, &entries)
        }
    }
}

fn constant(b: &mut Builder, colour: &[f64; 5]) -> std::result::Result<Colour, Lack> {
    let mut steps = Vec::with_capacity(5);
    for &part in colour {
        steps.push(b.constant(part).map_err(|_| Lack::Formula)?);
    }
    steps.try_into().map_err(|_| Lack::Formula)
}

/// The value of a pattern, and the point in its own space with its warps, where its entries are evaluated.
fn place_and_value(
    b: &mut Builder,
    p: [NodeId; 3],
    pattern: &Pattern,
) -> std::result::Result<(NodeId, [NodeId; 3]), Lack> {
    let back = pattern.modifiers.place.inverse().ok_or(Lack::Place)?;
    let own = moved(b, p, &back).map_err(|_| Lack::Formula)?;
    let own = noise_pattern::warped(b, pattern, own).ok_or(Lack::Formula)?;
    Ok((written(b, pattern, own).ok_or(Lack::Formula)?, own))
}

/// The colour that a list or map gives for a value.
fn mapped<T>(
    b: &mut Builder,
    pattern: &Pattern,
    value: NodeId,
    map: &Map<T>,
    entries: &[Colour],
) -> std::result::Result<Colour, Lack> {
    let at: Vec<f64> = map.entries.iter().map(|(at, _)| *at).collect();
    let (knots, pieces) = if pattern.is_plain_list() {
        // The value is always an integer here.
        let knots = (1..at.len()).map(|i| Knot::Jumps(i as f64 - 0.5));
        (knots.collect(), (0..at.len()).map(Piece::Plain).collect())
    } else {
        pieces_of(&at)
    };
    let mut part = |number: usize| {
        let mut parts = Vec::with_capacity(pieces.len());
        for piece in &pieces {
            parts.push(match *piece {
                Piece::Plain(i) => entries[i][number],
                Piece::Blend(i) => {
                    let (from, to) = (entries[i - 1][number], entries[i][number]);
                    if from == to {
                        from
                    } else {
                        let (start, width) = (b.constant(at[i - 1])?, b.constant(at[i])?);
                        let width = b.push(Op::Sub(width, start))?;
                        let way = b.push(Op::Sub(value, start))?;
                        let way = b.push(Op::Div(way, width))?;
                        let change = b.push(Op::Sub(to, from))?;
                        let change = b.push(Op::Mul(change, way))?;
                        b.push(Op::Add(from, change))?
                    }
                }
            });
        }
        chosen(b, value, &knots, &parts)
    };
    let mut all = Vec::with_capacity(5);
    for number in 0..5 {
        all.push(part(number).map_err(|_| Lack::Formula)?);
    }
    all.try_into().map_err(|_| Lack::Formula)
}

/// The interpolation between two knots.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    /// One entry.
    Plain(usize),
    /// A mixture of the entry before this one and this one.
    Blend(usize),
}

/// The pieces of a map with entries at these positions, which need not ascend. From the last
/// position on, the last entry is shown. Elsewhere the first entry that is not below the value ends
/// the piece.
fn pieces_of(at: &[f64]) -> (Vec<Knot>, Vec<Piece>) {
    let last = at.len() - 1;
    let (mut knots, mut pieces) = (Vec::new(), vec![Piece::Plain(0)]);
    // The position up to which the pieces go so far, and the entry there.
    let (mut end, mut reached) = (at[0], 0);
    for i in 1..at.len() {
        if at[i] <= end || end >= at[last] {
            continue;
        }
        knots.push(if reached == i - 1 { Knot::Meets(end) } else { Knot::Jumps(end) });
        pieces.push(Piece::Blend(i));
        (end, reached) = (at[i], i);
    }
    let met = reached == last && end == at[last];
    knots.push(if met { Knot::Meets(end) } else { Knot::Begins(at[last]) });
    pieces.push(Piece::Plain(last));
    (knots, pieces)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition of a map, one entry after the other: an entry and its weight; the rest is the
    /// entry before it.
    fn looked_up(at: &[f64], w: f64) -> (usize, f64) {
        let last = at.len() - 1;
        if w >= at[last] {
            return (last, 1.0);
        }
        match at.iter().position(|&at| w <= at) {
            Some(0) | None => (0, 1.0),
            Some(i) => (i, (w - at[i - 1]) / (at[i] - at[i - 1])),
        }
    }

    #[test]
    fn pieces_are_what_is_looked_up() {
        // All maps of one to five entries at quarters, sorted or not.
        for code in 0..5_usize.pow(5) {
            for length in 1..=5 {
                let at: Vec<f64> = (0..length).map(|i| (code / 5_usize.pow(i) % 5) as f64 / 4.0).collect();
                let (knots, pieces) = pieces_of(&at);
                assert!(
                    knots.windows(2).all(|pair| position(pair[0]) < position(pair[1])),
                    "{at:?}: {knots:?}"
                );
                for w in (-1..=17).map(|k| f64::from(k) / 16.0) {
                    let passed = |knot: &&Knot| match **knot {
                        Knot::Meets(x) | Knot::Begins(x) => w >= x,
                        Knot::Jumps(x) => w > x,
                    };
                    let shown = |piece: Piece| match piece {
                        Piece::Plain(i) => (i, 1.0),
                        Piece::Blend(i) => (i, (w - at[i - 1]) / (at[i] - at[i - 1])),
                    };
                    // Each entry has a different colour.
                    let colour = |(i, k): (usize, f64)| {
                        let own = |i: usize| ((i + 1) * (i + 1)) as f64;
                        if i == 0 { own(0) } else { own(i - 1) + (own(i) - own(i - 1)) * k }
                    };
                    let i = knots.iter().filter(passed).count();
                    assert_eq!(
                        colour(shown(pieces[i])),
                        colour(looked_up(&at, w)),
                        "{at:?} at {w}: {knots:?} {pieces:?}"
                    );
                    // Test both sides of a knot where they should meet.
                    if let Some(k) = knots.iter().position(|knot| matches!(knot, Knot::Meets(x) if *x == w)) {
                        assert_eq!(colour(shown(pieces[k])), colour(shown(pieces[k + 1])), "{at:?} at {w}");
                    }
                }
            }
        }
    }

    fn position(knot: Knot) -> f64 {
        match knot {
            Knot::Meets(x) | Knot::Jumps(x) | Knot::Begins(x) => x,
        }
    }
}

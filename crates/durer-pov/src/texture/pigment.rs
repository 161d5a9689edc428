//! Pigments: the colour at each point.

use std::rc::Rc;
use std::sync::Arc;

use durer_scene::{Fractal, FractalMap, Ramp};

use super::pattern::PatternModifiers;
use super::{ColorMap, Map, PatternKind};
use crate::colour::Colour;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::transform::Matrix;
use crate::value::Value;

/// The entries that a pattern selects or mixes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    Colors(Rc<ColorMap>),
    Pigments(Rc<Map<Pigment>>),
}

/// A pigment: the colour at each point.
///
/// A word for a colour or a pattern replaces the earlier colour or pattern. Everything else of the
/// pigment is kept (a fact of the language): its transformations, its frequency and the like, and
/// its map.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pigment {
    pub(crate) body: Body,
    pub(crate) modifiers: PatternModifiers,
    /// The list or map, if the text gave one.
    paint: Option<Paint>,
}

/// The contents of a pigment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Body {
    /// One colour.
    Solid(Colour),
    /// Colours or pigments, selected or mixed by a pattern.
    Patterned(PatternKind),
    /// A picture.
    Image(Arc<durer_scene::ImageMap>),
}

impl Default for Body {
    fn default() -> Self {
        Self::Solid([0.0; 5])
    }
}

impl Pigment {
    /// Makes a pigment with one colour everywhere.
    pub(crate) fn solid(colour: Colour) -> Self {
        Self { body: Body::Solid(colour), ..Self::default() }
    }

    /// Makes a pigment of pigments that a pattern selects or mixes.
    pub(crate) fn of_pigments(kind: PatternKind, map: Rc<Map<Self>>) -> Self {
        Self { body: Body::Patterned(kind), paint: Some(Paint::Pigments(map)), ..Self::default() }
    }

    pub(crate) fn transform(&mut self, by: &Matrix) {
        self.modifiers.transform(by);
    }

    /// The entries for the pattern `kind` of this pigment.
    pub(crate) fn paint(&self, kind: &PatternKind) -> Paint {
        self.paint.clone().unwrap_or_else(|| {
            let opaque = |&(at, [r, g, b]): &(f64, [f64; 3])| (at, [r, g, b, 0.0, 0.0]);
            let entries = default_map(kind).iter().map(opaque).collect();
            Paint::Colors(Rc::new(Map::new(entries, 1)))
        })
    }

    /// Turns the filter of all colours to transmittance.
    pub(crate) fn clear_filters(&mut self) {
        let clear = |colour: &mut Colour| {
            let [.., filter, transmit] = colour;
            (*filter, *transmit) = (0.0, *filter + *transmit);
        };
        if let Body::Solid(colour) = &mut self.body {
            clear(colour);
        }
        match &self.paint {
            Some(Paint::Colors(map)) => {
                let mut entries = map.entries.clone();
                entries.iter_mut().for_each(|(_, colour)| clear(colour));
                self.paint = Some(Paint::Colors(Rc::new(Map::new(entries, map.depth))));
            }
            Some(Paint::Pigments(map)) => {
                let mut entries = map.entries.clone();
                entries.iter_mut().for_each(|(_, pigment)| pigment.clear_filters());
                self.paint = Some(Paint::Pigments(Rc::new(Map::new(entries, map.depth))));
            }
            None => {}
        }
    }

    /// The nesting depth of maps.
    pub(crate) fn depth(&self) -> u32 {
        let own = match &self.body {
            Body::Solid(_) | Body::Image(_) => 0,
            Body::Patterned(PatternKind::GreyOf(pigment)) => 1 + pigment.depth(),
            Body::Patterned(_) => 1,
        };
        match &self.paint {
            Some(Paint::Pigments(map)) => map.depth.max(own),
            _ => own,
        }
    }

    /// The current pattern, if there is one.
    fn kind(&self) -> Option<&PatternKind> {
        match &self.body {
            Body::Solid(_) | Body::Image(_) => None,
            Body::Patterned(kind) => Some(kind),
        }
    }
}

/// The default colours of a list, where the text leaves them out.
fn default_list(kind: &PatternKind) -> Vec<Colour> {
    let opaque = |r, g, b| [r, g, b, 0.0, 0.0];
    match kind {
        PatternKind::Checker | PatternKind::Inside(..) => vec![opaque(0.0, 0.0, 1.0), opaque(0.0, 1.0, 0.0)],
        PatternKind::Hexagon => vec![opaque(0.0, 0.0, 1.0), opaque(0.0, 1.0, 0.0), opaque(1.0, 0.0, 0.0)],
        PatternKind::Brick { .. } => vec![opaque(0.5, 0.5, 0.5), opaque(0.6, 0.15, 0.15)],
        PatternKind::Square => {
            vec![opaque(1.0, 0.0, 0.0), opaque(0.0, 1.0, 0.0), opaque(0.0, 0.0, 1.0), opaque(1.0, 1.0, 0.0)]
        }
        PatternKind::Triangular => vec![
            opaque(1.0, 0.0, 0.0),
            opaque(0.0, 1.0, 0.0),
            opaque(0.0, 0.0, 1.0),
            opaque(1.0, 1.0, 0.0),
            opaque(0.0, 1.0, 1.0),
            opaque(1.0, 0.0, 1.0),
        ],
        _ => Vec::new(),
    }
}

/// The default map, where the text leaves it out, as in POV-Ray: for most patterns from black to
/// white.
fn default_map(kind: &PatternKind) -> &'static [(f64, [f64; 3])] {
    match kind {
        PatternKind::Written(Keyword::Marble, _) => &[
            (0.0, [0.9, 0.8, 0.8]),
            (0.9, [0.9, 0.08, 0.08]),
            (0.9, [0.0, 0.0, 0.0]),
            (1.0, [0.0, 0.0, 0.0]),
        ],
        PatternKind::Written(Keyword::Bozo, _) => &[
            (0.0, [1.0, 1.0, 1.0]),
            (0.4, [1.0, 1.0, 1.0]),
            (0.4, [0.0, 1.0, 0.0]),
            (0.6, [0.0, 1.0, 0.0]),
            (0.6, [0.0, 0.0, 1.0]),
            (0.8, [0.0, 0.0, 1.0]),
            (0.8, [1.0, 0.0, 0.0]),
            (1.0, [1.0, 0.0, 0.0]),
        ],
        PatternKind::Written(Keyword::Agate, _) => &[
            (0.0, [1.0, 1.0, 1.0]),
            (0.5, [0.95, 0.75, 0.5]),
            (0.5, [0.9, 0.7, 0.5]),
            (0.6, [0.9, 0.7, 0.4]),
            (0.6, [1.0, 0.7, 0.4]),
            (1.0, [0.6, 0.3, 0.0]),
        ],
        PatternKind::Written(Keyword::Wood, _) => &[
            (0.0, [0.666, 0.312, 0.2]),
            (0.6, [0.666, 0.312, 0.2]),
            (0.6, [0.4, 0.1333, 0.066]),
            (1.0, [0.4, 0.1333, 0.066]),
        ],
        PatternKind::Written(Keyword::Radial, _) => &[
            (0.0, [0.0, 1.0, 1.0]),
            (0.333, [1.0, 1.0, 0.0]),
            (0.666, [1.0, 0.0, 1.0]),
            (1.0, [0.0, 1.0, 1.0]),
        ],
        PatternKind::Ramp(ramp, _) if is_mandelbrot_set(ramp) => &[
            (0.001, [0.0, 0.0, 0.0]),
            (0.001, [0.0, 1.0, 1.0]),
            (0.012, [1.0, 1.0, 0.0]),
            (0.015, [1.0, 0.0, 1.0]),
            (0.1, [0.0, 1.0, 1.0]),
        ],
        _ => &[(0.0, [0.0; 3]), (1.0, [1.0; 3])],
    }
}

/// Whether a pattern is `mandel` with its own exponent. Unlike all other fractals it has colours of
/// its own.
fn is_mandelbrot_set(ramp: &Ramp) -> bool {
    matches!(ramp, Ramp::Fractal(Fractal { map: FractalMap::Power(2), constant: None, .. }))
}

impl Parser<'_> {
    /// Reads what stands in braces after `pigment`; `base` is the pigment that it changes.
    pub(crate) fn pigment_block(&mut self, base: &Pigment) -> Result<Pigment> {
        self.expect(Mark::BraceOpen)?;
        self.pigment_items(base, Mark::BraceClose).and_then(|pigment| {
            self.expect(Mark::BraceClose)?;
            Ok(pigment)
        })
    }

    /// Reads the items of a pigment up to `end`, which is not taken.
    pub(crate) fn pigment_items(&mut self, base: &Pigment, end: Mark) -> Result<Pigment> {
        let mut pigment = base.clone();
        let (mut chosen, mut on_chart) = (false, false);
        loop {
            if self.at_mark(end)? {
                // Only what follows the block does not move it.
                pigment.modifiers.on_chart |= on_chart;
                return Ok(pigment);
            }
            if let Some(by) = self.transform_item()? {
                pigment.transform(&by);
                continue;
            }
            let place = self.here();
            let pattern = self.pattern_kind(pigment.kind().cloned())?;
            let solid = pattern.is_none() && self.starts_colour()?;
            if chosen && (pattern.is_some() || solid) {
                return Err(Error::invalid(place, "this pigment has its colour or pattern already"));
            }
            chosen |= pattern.is_some() || solid;
            if let Some(kind) = pattern {
                if pigment.kind().is_none() {
                    self.set_noise_generator(&mut pigment.modifiers);
                }
                pigment.modifiers.begin(&kind);
                if let Some(list) = self.list(&kind)? {
                    pigment.paint = Some(list);
                }
                self.end_of_list(&kind)?;
                pigment.body = Body::Patterned(kind);
                continue;
            }
            if !chosen && self.take_word(Keyword::ImageMap)? {
                chosen = true;
                if pigment.kind().is_none() {
                    self.set_noise_generator(&mut pigment.modifiers);
                }
                pigment.body = Body::Image(self.nested(Self::image_block)?.map);
                continue;
            }
            if solid {
                pigment.body = Body::Solid(self.colour()?);
                continue;
            }
            let kind = match &mut pigment.body {
                Body::Solid(_) | Body::Image(_) => None,
                Body::Patterned(kind) => Some(kind),
            };
            if self.pattern_modifier(kind, &mut pigment.modifiers)? {
                continue;
            }
            if let Body::Patterned(kind) = &pigment.body
                && self.paint_item(kind, &mut pigment.paint)?
            {
                continue;
            }
            if let Some(here) = self.uv_mapping()? {
                on_chart = here;
                continue;
            }
            if self.take_word(Keyword::QuickColor)? {
                self.colour()?;
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Value(Value::Pigment(known)) => pigment = (**known).clone(),
                Item::Word(Keyword::Pigment) if !chosen => {
                    chosen = true;
                    pigment = self.nested(|r| r.pigment_block(&pigment))?;
                }
                Item::Word(Keyword::ColorMap | Keyword::PigmentMap) => {
                    return Err(Error::invalid(lexeme.place, "a map needs a pattern before it"));
                }
                _ => return Err(self.unexpected(&lexeme, "a colour or pattern")),
            }
        }
    }

    /// Reads the colours or pigments after the word of a discrete pattern; `None` for patterns with
    /// a map.
    fn list(&mut self, kind: &PatternKind) -> Result<Option<Paint>> {
        let Some(length) = kind.list_length() else { return Ok(None) };
        if self.peek_word()? == Some(Keyword::Pigment) {
            let base = self.defaults.clone();
            let mut pigments = vec![base.pigment.clone(); length];
            for pigment in &mut pigments {
                if !self.take_word(Keyword::Pigment)? {
                    break;
                }
                *pigment = self.nested(|r| r.pigment_block(&base.pigment))?;
                self.skip_comma()?;
            }
            let depth = 1 + pigments.iter().map(Pigment::depth).max().unwrap_or(0);
            return Ok(Some(Paint::Pigments(Rc::new(Map::list(pigments, self.check_map_depth(depth)?)))));
        }
        let mut colours = default_list(kind);
        for colour in colours.iter_mut().take(length) {
            if !self.starts_colour()? {
                break;
            }
            *colour = self.colour()?;
            self.skip_comma()?;
        }
        Ok(Some(Paint::Colors(Rc::new(Map::list(colours, 1)))))
    }

    /// Reads a map inside a patterned pigment.
    fn paint_item(&mut self, kind: &PatternKind, paint: &mut Option<Paint>) -> Result<bool> {
        let keyword = match self.peek_word()? {
            Some(keyword @ (Keyword::ColorMap | Keyword::PigmentMap)) => keyword,
            _ => return Ok(false),
        };
        if kind.list_length().is_some() {
            let text = format!("{} does not go with this pattern, which has a list", keyword.text());
            return Err(Error::invalid(self.here(), text));
        }
        self.next()?;
        *paint = Some(if keyword == Keyword::ColorMap {
            if *kind == PatternKind::Average {
                return Err(Error::invalid(self.here(), "average needs a pigment_map"));
            }
            Paint::Colors(self.nested(Self::color_map_block)?)
        } else {
            let is_mean = *kind == PatternKind::Average;
            Paint::Pigments(self.nested(|r| r.pigment_map_block(is_mean))?)
        });
        Ok(true)
    }
}

//! Textures: pigments, finishes, layers, materials, and the grammar of their blocks.

mod density_file;
mod finish;
mod function_images;
mod images;
mod interior;
mod maps;
mod normal;
mod pattern;
mod pigment;
mod ramps;
mod warps;

use std::rc::Rc;

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::{Kind, Mark};
use crate::parser::{Item, Parser};
use crate::transform::Matrix;
use crate::value::Value;

pub(crate) use finish::{Film, Finish};
pub(crate) use interior::{Interior, Material};
pub(crate) use maps::{ColorMap, Map};
pub(crate) use normal::{Normal, NormalKind, SlopeMap};
pub(crate) use pattern::{Pattern, PatternKind, Wave};
pub(crate) use pigment::{Body, Paint, Pigment};

/// One layer: its colour, and how it reflects light.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Layer {
    pub(crate) pigment: Pigment,
    pub(crate) finish: Finish,
    pub(crate) normal: Option<Rc<Normal>>,
}

impl Layer {
    /// Transforms the layer.
    fn transform(&mut self, by: &Matrix) {
        self.pigment.transform(by);
        if let Some(normal) = &mut self.normal {
            Rc::make_mut(normal).transform(by);
        }
    }
}

/// A whole texture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Texture {
    /// Layers, the lowest first.
    Layers(Vec<Layer>),
    /// Whole textures, selected or mixed by a pattern.
    Patterned { pattern: Pattern, map: Rc<Map<Texture>> },
}

/// The greatest number of layers of a texture; scenes use a handful.
const MOST_LAYERS: usize = 256;

/// The version since which all layers filter.
const FILTERING_LAYERS: f64 = 3.2;

impl Texture {
    /// Makes a texture of one layer.
    pub(crate) fn single(layer: Layer) -> Self {
        Self::Layers(vec![layer])
    }

    /// Transforms the texture.
    pub(crate) fn transform(&mut self, by: &Matrix) {
        match self {
            Self::Layers(layers) => layers.iter_mut().for_each(|layer| layer.transform(by)),
            Self::Patterned { pattern, .. } => pattern.modifiers.transform(by),
        }
    }

    /// Shows the texture by the surface's texture coordinates.
    pub(crate) fn put_on_chart(&mut self) {
        match self {
            Self::Patterned { pattern, .. } => pattern.modifiers.put_on_chart(),
            Self::Layers(layers) => {
                for layer in layers {
                    layer.pigment.modifiers.on_chart = true;
                    if let Some(normal) = &mut layer.normal {
                        Rc::make_mut(normal).modifiers.put_on_chart();
                    }
                }
            }
        }
    }

    /// The number of layers in this texture, including those of its parts.
    pub(crate) fn size(&self) -> usize {
        match self {
            Self::Layers(layers) => layers.len(),
            Self::Patterned { map, .. } => map.entries.iter().map(|(_, part)| part.size()).sum::<usize>() + 1,
        }
    }
}

impl Parser<'_> {
    /// Reads one or more `texture { }` blocks as layers on each other; the word `texture` comes
    /// next.
    pub(crate) fn texture_value(&mut self) -> Result<Texture> {
        let mut texture = None;
        loop {
            self.next()?;
            let next = self.nested(Self::texture_block)?;
            texture = Some(match texture {
                None => next,
                Some(below) => self.laid_on(below, next)?,
            });
            // Tested without running what follows, which may be the next statement.
            let again = if self.has_peeked() {
                self.peek_word()? == Some(Keyword::Texture)
            } else {
                self.raw() == Some(Kind::Word(Keyword::Texture))
            };
            match texture {
                Some(done) if !again => return Ok(done),
                _ => {}
            }
        }
    }

    /// Reads `uv_mapping` and its switch, if it comes next.
    pub(crate) fn uv_mapping(&mut self) -> Result<Option<bool>> {
        if self.take_word(Keyword::UvMapping)? { self.switch_value().map(Some) } else { Ok(None) }
    }

    /// Puts `above` on top of `below`.
    pub(crate) fn laid_on(&self, below: Texture, above: Texture) -> Result<Texture> {
        match (below, above) {
            (Texture::Layers(mut layers), Texture::Layers(more)) => {
                let first = layers.len();
                layers.extend(more);
                self.clear_old_filters(&mut layers[first..]);
                if layers.len() > MOST_LAYERS {
                    let text = format!("a texture has at most {MOST_LAYERS} layers");
                    return Err(Error::invalid(self.here(), text));
                }
                Ok(Texture::Layers(layers))
            }
            _ => Err(Error::invalid(self.here(), "a patterned texture cannot be layered")),
        }
    }

    /// In old scenes the layers above the innermost one do not filter: they let light pass unchanged (a fact of
    /// the language).
    fn clear_old_filters(&self, layers: &mut [Layer]) {
        if self.language.version < FILTERING_LAYERS {
            layers.iter_mut().for_each(|layer| layer.pigment.clear_filters());
        }
    }

    /// Reads what stands in braces after `texture`.
    pub(crate) fn texture_block(&mut self) -> Result<Texture> {
        self.expect(Mark::BraceOpen)?;
        let texture = self.texture_items(Mark::BraceClose)?;
        self.expect(Mark::BraceClose)?;
        Ok(texture)
    }

    /// Reads the items of a texture up to `end`, which is left there.
    pub(crate) fn texture_items(&mut self, end: Mark) -> Result<Texture> {
        let mut texture = Texture::single((*self.defaults).clone());
        let mut on_chart = false;
        if let Item::Value(Value::Texture(known)) = self.peek()? {
            texture = (**known).clone();
            self.next()?;
        }
        loop {
            if let Some(by) = self.transform_item()? {
                texture.transform(&by);
                continue;
            }
            if self.layer_item(&mut texture)? {
                continue;
            }
            if let Some(here) = self.uv_mapping()? {
                on_chart = here;
                continue;
            }
            if self.take_word(Keyword::NoBumpScale)? {
                let keeps_slope = self.switch_value()?;
                if let Texture::Layers(layers) = &mut texture {
                    for normal in layers.iter_mut().filter_map(|layer| layer.normal.as_mut()) {
                        Rc::make_mut(normal).keeps_slope = keeps_slope;
                    }
                }
                continue;
            }
            if self.take_word(Keyword::Tiles)? {
                texture = self.nested(Self::tiles)?;
                continue;
            }
            if self.take_word(Keyword::MaterialMap)? {
                texture = self.nested(Self::material_map)?;
                continue;
            }
            if let Some(kind) = self.pattern_kind(None)? {
                texture = self.patterned_texture(kind)?;
                continue;
            }
            if let Texture::Patterned { pattern, map } = &mut texture
                && (self.pattern_modifier(Some(&mut pattern.kind), &mut pattern.modifiers)?
                    || self.texture_map_item(pattern.kind == PatternKind::Average, map)?)
            {
                continue;
            }
            if self.at_mark(end)? {
                break;
            }
            let lexeme = self.next()?;
            let wanted = if end == Mark::BraceClose { "a part of a texture, or `}`" } else { "`]`" };
            return Err(self.unexpected(&lexeme, wanted));
        }
        if let Texture::Patterned { map, .. } = &texture
            && map.entries.is_empty()
        {
            return Err(Error::invalid(self.here(), "this patterned texture has no textures"));
        }
        if on_chart {
            texture.put_on_chart();
        }
        if let Texture::Layers(layers) = &mut texture
            && let [_, upper @ ..] = layers.as_mut_slice()
        {
            self.clear_old_filters(upper);
        }
        Ok(texture)
    }

    /// Reads a pigment, normal or finish into the top layer of `texture`.
    pub(crate) fn layer_item(&mut self, texture: &mut Texture) -> Result<bool> {
        enum Part {
            Pigment,
            Normal,
            Finish,
        }
        let (part, word) = match self.peek()? {
            Item::Word(Keyword::Pigment) => (Part::Pigment, true),
            Item::Word(Keyword::Normal) => (Part::Normal, true),
            Item::Word(Keyword::Finish) => (Part::Finish, true),
            Item::Value(Value::Pigment(_)) => (Part::Pigment, false),
            Item::Value(Value::Normal(_)) => (Part::Normal, false),
            Item::Value(Value::Finish(_)) => (Part::Finish, false),
            _ => return Ok(false),
        };
        let place = self.here();
        let Texture::Layers(layers) = texture else {
            return Err(Error::invalid(
                place,
                "a patterned texture has no pigment, normal or finish of its own",
            ));
        };
        let Some(top) = layers.last_mut() else { return Ok(false) };
        match part {
            Part::Pigment if word => {
                self.next()?;
                top.pigment = self.nested(|r| r.pigment_block(&top.pigment))?;
            }
            Part::Normal if word => {
                self.next()?;
                let base = top.normal.take().map_or_else(Normal::default, Rc::unwrap_or_clone);
                top.normal = Some(Rc::new(self.nested(|r| r.normal_block(&base))?));
            }
            Part::Finish if word => {
                self.next()?;
                top.finish = self.nested(|r| r.finish_block(&top.finish))?;
            }
            _ => match self.next()?.item {
                Item::Value(Value::Pigment(known)) => top.pigment = (*known).clone(),
                Item::Value(Value::Normal(known)) => top.normal = Some(known),
                Item::Value(Value::Finish(known)) => top.finish = (*known).clone(),
                _ => {}
            },
        }
        Ok(true)
    }

    /// Reads `#default { texture {} }`, a part of a texture, or `#default { camera {} }`.
    pub(crate) fn default_texture(&mut self) -> Result<()> {
        self.expect(Mark::BraceOpen)?;
        let mut texture = Texture::single((*self.defaults).clone());
        loop {
            let place = {
                self.peek()?;
                self.here()
            };
            if self.take_word(Keyword::Texture)? {
                texture = self.nested(Self::texture_block)?;
            } else if !self.layer_item(&mut texture)? {
                let lexeme = self.next()?;
                match &lexeme.item {
                    Item::Mark(Mark::BraceClose) => break,
                    Item::Word(Keyword::Camera) => self.default_camera_item()?,
                    _ => return Err(self.unexpected(&lexeme, "texture, pigment, normal, finish or camera")),
                }
            }
            match &texture {
                Texture::Layers(layers) if layers.len() == 1 => self.defaults = Rc::new(layers[0].clone()),
                _ => return Err(Error::invalid(place, "the default texture has one plain layer")),
            }
        }
        Ok(())
    }
}

//! Maps and lists: the colours, pigments or textures for the values of a pattern.

use std::rc::Rc;

use super::pattern::PatternModifiers;
use super::{Normal, NormalKind, Pattern, PatternKind, Pigment, Texture};
use crate::colour::Colour;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::limits::Charge;
use crate::parser::{Item, Parser};
use crate::value::Value;

/// POV-Ray's limit on the number of entries of a map.
const MOST_ENTRIES: usize = 256;

/// Values and their entries, in the order of the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Map<T> {
    pub(crate) entries: Vec<(f64, T)>,
    /// The nesting depth of maps, this one included.
    pub(crate) depth: u32,
    _charge: Charge,
}

/// Values and colours.
pub(crate) type ColorMap = Map<Colour>;

impl<T> Map<T> {
    pub(crate) fn new(entries: Vec<(f64, T)>, depth: u32) -> Self {
        let _charge = Charge::new(64 + entries.len() * size_of::<(f64, T)>());
        Self { entries, depth, _charge }
    }

    /// A list: the entries of a pattern that numbers its cells.
    pub(crate) fn list(items: Vec<T>, depth: u32) -> Self {
        let entries = items.into_iter().enumerate().map(|(i, item)| (i as f64, item)).collect();
        Self::new(entries, depth)
    }

    /// The entries of a mean of two, with the weight `k` for the second.
    fn mean(a: &T, b: &T, k: f64) -> Rc<Self>
    where
        T: Clone,
    {
        // What has been read is not too deep; this map stands in none that the text gives.
        Rc::new(Self::new(vec![(1.0 - k, a.clone()), (k, b.clone())], 1))
    }
}

impl Pigment {
    /// A blend of two entries of a list, with the weight `k` for the second: their mean.
    pub(crate) fn blended(a: &Self, b: &Self, k: f64) -> Self {
        Self::of_pigments(PatternKind::Average, Map::mean(a, b, k))
    }
}

impl Texture {
    /// See [`Pigment::blended`].
    pub(crate) fn blended(a: &Self, b: &Self, k: f64) -> Self {
        let pattern = Pattern { kind: PatternKind::Average, modifiers: PatternModifiers::default() };
        Self::Patterned { pattern, map: Map::mean(a, b, k) }
    }
}

impl Normal {
    /// See [`Pigment::blended`].
    pub(crate) fn blended(a: &Self, b: &Self, k: f64) -> Self {
        let kind = Some(NormalKind::Pattern(PatternKind::Average));
        Self { kind, normals: Some(Map::mean(a, b, k)), ..Self::default() }
    }
}

/// The greatest nesting depth of maps; scenes use two or three.
const DEEPEST: u32 = 32;

impl Parser<'_> {
    /// Reads entries `[value item]` in braces. In the map of a mean the value may be left out.
    pub(crate) fn map_entries<T>(
        &mut self,
        is_mean: bool,
        mut item: impl FnMut(&mut Self) -> Result<T>,
    ) -> Result<Vec<(f64, T)>> {
        let mut entries = Vec::new();
        while self.take_mark(Mark::SquareOpen)? {
            let value = if is_mean && !self.starts_number()? { 1.0 } else { self.float()? };
            self.skip_comma()?;
            entries.push((value, item(self)?));
            self.expect(Mark::SquareClose)?;
            self.skip_comma()?;
            self.check_entries(entries.len())?;
        }
        Ok(entries)
    }

    fn check_entries(&self, count: usize) -> Result<()> {
        if count > MOST_ENTRIES {
            return Err(Error::invalid(self.here(), format!("a map has at most {MOST_ENTRIES} entries")));
        }
        Ok(())
    }

    pub(crate) fn check_map_depth(&self, depth: u32) -> Result<u32> {
        if depth > DEEPEST {
            return Err(Error::invalid(
                self.here(),
                format!("maps stand in each other more than {DEEPEST} deep"),
            ));
        }
        Ok(depth)
    }

    pub(crate) fn end_of_map(&mut self, empty: bool) -> Result<()> {
        let place = self.here();
        self.expect(Mark::BraceClose)?;
        if empty { Err(Error::invalid(place, "this map has no entries")) } else { Ok(()) }
    }

    /// Reads what follows `color_map`.
    pub(crate) fn color_map_block(&mut self) -> Result<Rc<ColorMap>> {
        self.expect(Mark::BraceOpen)?;
        if let Item::Value(Value::ColorMap(known)) = self.peek()? {
            let known = known.clone();
            self.next()?;
            self.expect(Mark::BraceClose)?;
            return Ok(known);
        }
        let mut entries = Vec::new();
        while self.take_mark(Mark::SquareOpen)? {
            let first = self.float()?;
            self.skip_comma()?;
            // The old form gives an interval: [from, to color A color B].
            if self.starts_number()? && !self.starts_colour()? && !self.at_mark(Mark::Less)? {
                let last = self.float()?;
                self.skip_comma()?;
                entries.push((first, self.colour()?));
                self.skip_comma()?;
                entries.push((last, self.colour()?));
            } else {
                entries.push((first, self.colour()?));
            }
            self.expect(Mark::SquareClose)?;
            self.skip_comma()?;
            self.check_entries(entries.len())?;
        }
        self.end_of_map(entries.is_empty())?;
        Ok(Rc::new(Map::new(entries, 1)))
    }

    /// Reads what follows `pigment_map`.
    pub(crate) fn pigment_map_block(&mut self, is_mean: bool) -> Result<Rc<Map<Pigment>>> {
        self.expect(Mark::BraceOpen)?;
        if let Item::Value(Value::PigmentMap(known)) = self.peek()? {
            let known = known.clone();
            self.next()?;
            self.expect(Mark::BraceClose)?;
            return Ok(known);
        }
        let base = self.defaults.clone();
        let entries =
            self.map_entries(is_mean, |r| r.nested(|r| r.pigment_items(&base.pigment, Mark::SquareClose)))?;
        self.end_of_map(entries.is_empty())?;
        let depth = 1 + entries.iter().map(|(_, pigment)| pigment.depth()).max().unwrap_or(0);
        Ok(Rc::new(Map::new(entries, self.check_map_depth(depth)?)))
    }

    /// Reads what follows `texture_map`.
    pub(crate) fn texture_map_block(&mut self, is_mean: bool) -> Result<Rc<Map<Texture>>> {
        self.expect(Mark::BraceOpen)?;
        if let Item::Value(Value::TextureMap(known)) = self.peek()? {
            let known = known.clone();
            self.next()?;
            self.expect(Mark::BraceClose)?;
            return Ok(known);
        }
        let entries = self.map_entries(is_mean, Self::texture_entry)?;
        self.end_of_map(entries.is_empty())?;
        let depth = 1 + entries.iter().map(|(_, texture)| texture.depth()).max().unwrap_or(0);
        Ok(Rc::new(Map::new(entries, self.check_map_depth(depth)?)))
    }

    /// Reads an entry of a texture map: `texture {}` blocks, or the items of one texture, which may
    /// have a pattern of its own.
    fn texture_entry(&mut self) -> Result<Texture> {
        if self.peek_word()? == Some(Keyword::Texture) {
            return self.texture_value();
        }
        self.nested(|r| r.texture_items(Mark::SquareClose))
    }

    /// Reads a texture made of textures: the list of a discrete pattern, or the map after a
    /// gradient.
    pub(crate) fn patterned_texture(&mut self, kind: PatternKind) -> Result<Texture> {
        let mut items = Vec::new();
        let length = kind.list_length().unwrap_or(0);
        while items.len() < length && self.take_word(Keyword::Texture)? {
            items.push(self.nested(Self::texture_block)?);
            self.skip_comma()?;
        }
        if items.len() < length {
            return Err(Error::invalid(self.here(), format!("this pattern needs {length} texture blocks")));
        }
        self.end_of_list(&kind)?;
        let depth = 1 + items.iter().map(Texture::depth).max().unwrap_or(0);
        let map = Rc::new(Map::list(items, self.check_map_depth(depth)?));
        Ok(Texture::Patterned { pattern: self.plain_pattern(kind), map })
    }

    /// Reads what follows `tiles`, the old words for a checker of textures.
    pub(crate) fn tiles(&mut self) -> Result<Texture> {
        self.expect(Mark::BraceOpen)?;
        let mut items = Vec::new();
        for _ in 0..2 {
            let lexeme = self.next()?;
            if !matches!(lexeme.item, Item::Word(Keyword::Texture | Keyword::Tile2)) {
                return Err(self.unexpected(&lexeme, "texture, or tile2 and then texture"));
            }
            if matches!(lexeme.item, Item::Word(Keyword::Texture)) {
                self.put_back(lexeme);
            }
            if self.peek_word()? != Some(Keyword::Texture) {
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, "texture"));
            }
            items.push(self.texture_value()?);
        }
        self.expect(Mark::BraceClose)?;
        // The second texture is that of the checker's first cells.
        items.reverse();
        let depth = 1 + items.iter().map(Texture::depth).max().unwrap_or(0);
        let map = Rc::new(Map::list(items, self.check_map_depth(depth)?));
        Ok(Texture::Patterned { pattern: self.plain_pattern(PatternKind::Checker), map })
    }

    /// Reads what follows `material_map`: a picture, and a texture for each of its indices.
    pub(crate) fn material_map(&mut self) -> Result<Texture> {
        let mut items = Vec::new();
        let map = self.image_block_with(|r| {
            let here = r.take_word(Keyword::Texture)?;
            if here {
                items.push(r.nested(Self::texture_block)?);
                r.check_entries(items.len())?;
            }
            Ok(here)
        })?;
        if items.is_empty() {
            return Err(Error::invalid(self.here(), "a material_map needs textures"));
        }
        let depth = 1 + items.iter().map(Texture::depth).max().unwrap_or(0);
        let list = Rc::new(Map::list(items, self.check_map_depth(depth)?));
        Ok(Texture::Patterned { pattern: self.plain_pattern(PatternKind::Materials(map.map)), map: list })
    }

    /// Reads `texture_map {}` inside a patterned texture.
    pub(crate) fn texture_map_item(&mut self, is_mean: bool, map: &mut Rc<Map<Texture>>) -> Result<bool> {
        let here = self.take_word(Keyword::TextureMap)?;
        if here {
            *map = self.nested(|r| r.texture_map_block(is_mean))?;
        }
        Ok(here)
    }
}

impl Texture {
    /// The nesting depth of maps.
    fn depth(&self) -> u32 {
        match self {
            Self::Layers(layers) => layers.iter().map(|layer| layer.pigment.depth()).max().unwrap_or(0),
            Self::Patterned { map, .. } => map.depth,
        }
    }
}

//! `normal { }`: surfaces that look bumpy.

use std::rc::Rc;

use super::pattern::PatternModifiers;
use super::{Map, PatternKind};
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::transform::Matrix;
use crate::value::Value;

/// Heights and slopes at values of a pattern.
pub(crate) type SlopeMap = Map<[f64; 2]>;

/// How the normals of a surface are perturbed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Normal {
    /// The pattern; without one nothing is perturbed.
    pub(crate) kind: Option<NormalKind>,
    pub(crate) modifiers: PatternModifiers,
    pub(crate) amount: f64,
    pub(crate) accuracy: f64,
    pub(crate) keeps_slope: bool,
    pub(crate) slopes: Option<Rc<SlopeMap>>,
    pub(crate) normals: Option<Rc<Map<Normal>>>,
    /// Whether the pattern is the picture of a `bump_map`.
    pub(crate) is_bump_map: bool,
}

/// The perturbation of a normal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NormalKind {
    Pattern(PatternKind),
    /// Facets, tilted by this much.
    Facets(f64),
    /// Facets of curved surfaces: normals take the nearest of a grid of directions with this width.
    NormalFacets(f64),
}

/// The default amount of a normal.
const AMOUNT: f64 = 0.5;
/// The distance at which heights are compared, if none is given.
const ACCURACY: f64 = 0.02;

impl Default for Normal {
    fn default() -> Self {
        Self {
            kind: None,
            modifiers: PatternModifiers::default(),
            amount: AMOUNT,
            accuracy: ACCURACY,
            keeps_slope: false,
            slopes: None,
            normals: None,
            is_bump_map: false,
        }
    }
}

impl Normal {
    pub(crate) fn transform(&mut self, by: &Matrix) {
        self.modifiers.transform(by);
    }

    /// The nesting depth of maps.
    pub(crate) fn depth(&self) -> u32 {
        self.normals.as_ref().map_or(1, |map| map.depth)
    }

    fn pattern(&self) -> Option<&PatternKind> {
        match &self.kind {
            Some(NormalKind::Pattern(kind)) => Some(kind),
            _ => None,
        }
    }
}

impl Parser<'_> {
    /// Reads the block after `normal`, which changes the normal `base`.
    pub(crate) fn normal_block(&mut self, base: &Normal) -> Result<Normal> {
        self.expect(Mark::BraceOpen)?;
        let normal = self.normal_items(base, Mark::BraceClose)?;
        self.expect(Mark::BraceClose)?;
        Ok(normal)
    }

    /// Reads the items of a normal up to `end`, which is not taken.
    fn normal_items(&mut self, base: &Normal, end: Mark) -> Result<Normal> {
        let mut normal = base.clone();
        let mut on_chart = false;
        loop {
            if self.at_mark(end)? {
                normal.modifiers.on_chart |= on_chart;
                return Ok(normal);
            }
            if let Some(by) = self.transform_item()? {
                normal.transform(&by);
                continue;
            }
            let mut bump_size = None;
            if let Some(kind) = self.normal_kind(&normal, &mut bump_size)? {
                if normal.kind.is_none() {
                    self.set_noise_generator(&mut normal.modifiers);
                }
                if let NormalKind::Pattern(kind) = &kind {
                    normal.modifiers.begin(kind);
                    if let Some(list) = self.normal_list(kind, &mut normal.amount)? {
                        normal.normals = Some(list);
                    }
                    self.end_of_list(kind)?;
                }
                normal.kind = Some(kind);
                normal.is_bump_map = bump_size.is_some();
                if let Some(amount) = self.amount()?.or(bump_size.flatten()) {
                    normal.amount = amount;
                }
                continue;
            }
            if let Some(here) = self.uv_mapping()? {
                on_chart = here;
                continue;
            }
            if !self.normal_modifier(&mut normal)? {
                let lexeme = self.next()?;
                match &lexeme.item {
                    Item::Value(Value::Normal(known)) => normal = (**known).clone(),
                    Item::Word(Keyword::Normal) => normal = self.nested(|r| r.normal_block(&normal))?,
                    _ => return Err(self.unexpected(&lexeme, "a part of a normal")),
                }
            }
        }
    }

    /// Reads the word of a pattern, and what belongs to it.
    fn normal_kind(
        &mut self,
        normal: &Normal,
        bump_size: &mut Option<Option<f64>>,
    ) -> Result<Option<NormalKind>> {
        if self.take_word(Keyword::BumpMap)? {
            let place = self.here();
            let read = self.nested(Self::bump_block)?;
            *bump_size = Some(read.bump_size);
            let ramp = durer_scene::Ramp::Image(read.map, read.value);
            return Ok(Some(NormalKind::Pattern(PatternKind::Ramp(Rc::new(ramp), place))));
        }
        if !self.take_word(Keyword::Facets)? {
            let kind = self.pattern_kind(normal.pattern().cloned())?;
            return Ok(kind.map(NormalKind::Pattern));
        }
        Ok(Some(NormalKind::Facets(1.0)))
    }

    /// Reads the amount after a pattern, if there is one.
    fn amount(&mut self) -> Result<Option<f64>> {
        let comma = self.at_mark(Mark::Comma)?;
        if comma {
            self.skip_comma()?;
        }
        if comma || self.starts_number()? { self.float().map(Some) } else { Ok(None) }
    }

    /// The normal that the entries of lists and maps start from: that of the default texture.
    fn default_normal(&self) -> Normal {
        self.defaults.normal.as_ref().map_or_else(Normal::default, |normal| (**normal).clone())
    }

    /// Reads the normals after the word of a pattern with a list.
    fn normal_list(&mut self, kind: &PatternKind, amount: &mut f64) -> Result<Option<Rc<Map<Normal>>>> {
        let Some(length) = kind.list_length() else { return Ok(None) };
        if let Some(own) = self.amount()? {
            *amount = own;
        }
        if self.peek_word()? != Some(Keyword::Normal) {
            return Ok(None);
        }
        let base = self.default_normal();
        let mut normals = vec![base.clone(); length];
        for normal in &mut normals {
            if !self.take_word(Keyword::Normal)? {
                break;
            }
            *normal = self.nested(|r| r.normal_block(&base))?;
            self.skip_comma()?;
        }
        let depth = 1 + normals.iter().map(Normal::depth).max().unwrap_or(0);
        Ok(Some(Rc::new(Map::list(normals, self.check_map_depth(depth)?))))
    }

    fn normal_modifier(&mut self, normal: &mut Normal) -> Result<bool> {
        let Some(word) = self.peek_word()? else { return Ok(false) };
        let place = self.here();
        match (word, &mut normal.kind) {
            (Keyword::BumpSize, _) => {
                self.next()?;
                normal.amount = self.float()?;
            }
            (Keyword::Accuracy, _) => {
                self.next()?;
                normal.accuracy = self.float()?;
                if normal.accuracy <= 0.0 {
                    let text = format!("the accuracy of a normal must be positive, not {}", normal.accuracy);
                    return Err(Error::invalid(place, text));
                }
            }
            (Keyword::NoBumpScale, _) => {
                self.next()?;
                normal.keeps_slope = self.switch_value()?;
            }
            (Keyword::SlopeMap, _) => {
                self.next()?;
                normal.slopes = Some(self.nested(Self::slope_map_block)?);
            }
            (Keyword::NormalMap, _) => {
                self.next()?;
                let is_mean = normal.pattern() == Some(&PatternKind::Average);
                normal.normals = Some(self.nested(|r| r.normal_map_block(is_mean))?);
            }
            (
                Keyword::Coords | Keyword::Size,
                Some(kind @ (NormalKind::Facets(_) | NormalKind::NormalFacets(_))),
            ) => {
                self.next()?;
                let given = self.float()?;
                let is_size = word == Keyword::Size;
                if given <= 0.0 {
                    let name = if is_size { "size" } else { "coords" };
                    return Err(Error::invalid(
                        place,
                        format!("{name} of facets must be positive, not {given}"),
                    ));
                }
                *kind = if is_size { NormalKind::NormalFacets(given) } else { NormalKind::Facets(given) };
            }
            (_, kind) => {
                let kind = match kind {
                    Some(NormalKind::Pattern(kind)) => Some(kind),
                    _ => None,
                };
                return self.pattern_modifier(kind, &mut normal.modifiers);
            }
        }
        Ok(true)
    }

    /// Reads what follows `slope_map`.
    pub(crate) fn slope_map_block(&mut self) -> Result<Rc<SlopeMap>> {
        self.expect(Mark::BraceOpen)?;
        if let Item::Value(Value::SlopeMap(known)) = self.peek()? {
            let known = known.clone();
            self.next()?;
            self.expect(Mark::BraceClose)?;
            return Ok(known);
        }
        let entries = self.map_entries(false, |r| {
            let [height, slope, _] = r.vector()?;
            Ok([height, slope])
        })?;
        self.end_of_map(entries.is_empty())?;
        Ok(Rc::new(Map::new(entries, 1)))
    }

    /// Reads what follows `normal_map`.
    pub(crate) fn normal_map_block(&mut self, is_mean: bool) -> Result<Rc<Map<Normal>>> {
        self.expect(Mark::BraceOpen)?;
        if let Item::Value(Value::NormalMap(known)) = self.peek()? {
            let known = known.clone();
            self.next()?;
            self.expect(Mark::BraceClose)?;
            return Ok(known);
        }
        let base = self.default_normal();
        let entries =
            self.map_entries(is_mean, |r| r.nested(|r| r.normal_items(&base, Mark::SquareClose)))?;
        self.end_of_map(entries.is_empty())?;
        let depth = 1 + entries.iter().map(|(_, normal)| normal.depth()).max().unwrap_or(0);
        Ok(Rc::new(Map::new(entries, self.check_map_depth(depth)?)))
    }
}

//! `#declare` and `#local`, and the values of every kind that they declare.

use std::rc::Rc;

use crate::colour::begins_colour;
use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::{Kind, Mark};
use crate::parser::{Item, Lexeme, Parser, strayed};
use crate::scope::Reference;
use crate::strings::makes_string;
use crate::value::{Unsupported, Value};

/// A declaration of a number that may end without a semicolon: where its value is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unended {
    nesting: u64,
    braces: u64,
    frame: u64,
}

impl Parser<'_> {
    /// Reads `#declare NAME = value` or `#local`.
    pub(crate) fn declare(&mut self, local: bool, place: Place) -> Result<()> {
        let serial = self.frames.last().map_or(0, |frame| frame.serial);
        self.skip_deprecation();
        let name = match self.take_raw() {
            Some((Kind::Name(name), _)) => name,
            Some((Kind::Word(keyword), at)) => {
                let text = format!("`{}` is a word of the language and cannot be declared", keyword.text());
                return Err(Error::invalid(at, text));
            }
            _ => return Err(Error::invalid(self.here(), "expected the name of what is declared")),
        };
        let subscripts = self.raw() == Some(Kind::Mark(Mark::SquareOpen));
        let element = if subscripts { Some(self.element_reference(name)?) } else { None };
        self.expect(Mark::Equal)?;
        let outer = self.declaring.replace(name);
        let (value, is_ended) = self.declared_value()?;
        self.declaring = outer;
        // More than directives may be left of the macro that gave the value. The rest is then read
        // as if it stood after this declaration.
        let is_back = self.leave_finished_frames(serial, place)?;
        if is_back && !is_ended && !self.has_peeked() {
            // The semicolon after the call of a macro.
            self.take_raw_mark(Mark::Semicolon);
        }
        match element {
            Some(target) => self.assign_element(&target, value, place)?,
            None if local && !is_back => return Err(strayed(place)),
            None if local => self.scopes.local(name, value),
            None => self.scopes.declare(name, value),
        }
        if self.declaring.is_none() {
            self.skip_spare_semicolon();
        }
        self.check_memory(0, place)
    }

    /// Gives a variable or an array element a new value.
    pub(crate) fn assign_element(&mut self, target: &Reference, value: Value, place: Place) -> Result<()> {
        // A shared array is copied before a change.
        let depth = value.array_depth() + target.path.len() as u32;
        self.check_array_depth(depth, place)?;
        self.count_array_copy(target.name, place)?;
        let gone = || Error::invalid(place, "this variable is gone");
        let after = value.held();
        let held = self.scopes.get_mut(target).ok_or_else(gone)?;
        let before = std::mem::replace(held, value).held();
        self.scopes.element_changed(target, depth, before, after);
        Ok(())
    }

    /// Skips `deprecated`, `once` and a text before the name, which the standard files use to warn
    /// their users.
    fn skip_deprecation(&mut self) {
        let word = matches!(self.raw(), Some(Kind::Name(name)) if self.names.text(name) == "deprecated");
        let declared = matches!(self.raw_ahead(1), Some(Kind::Mark(Mark::Equal | Mark::SquareOpen)));
        if !word || declared {
            return;
        }
        self.take_raw();
        if self.raw() == Some(Kind::Word(Keyword::Once)) {
            self.take_raw();
        }
        if matches!(self.raw(), Some(Kind::Text(_))) {
            self.take_raw();
        }
    }

    /// Counts the steps and the memory that a copy of a shared array takes.
    fn count_array_copy(&mut self, name: crate::interner::Name, place: Place) -> Result<()> {
        let shared = match self.scopes.get(name) {
            Some(Value::Array(array)) if Rc::strong_count(array) > 1 => array.items.len(),
            _ => return Ok(()),
        };
        self.count_steps(shared as u64, place)?;
        self.check_memory(crate::value::Array::bytes(shared), place)
    }

    /// Reads the value of a declaration. Also returns whether its semicolon was taken, which only
    /// numbers need.
    fn declared_value(&mut self) -> Result<(Value, bool)> {
        let outer = self.begin_value();
        let value = self.value("a value to declare")?;
        self.unended = outer;
        let is_number = matches!(value, Value::Number(_));
        let is_ended = if is_number || self.has_peeked() {
            self.take_mark(Mark::Semicolon)?
        } else {
            self.take_raw_mark(Mark::Semicolon)
        };
        if is_number && !is_ended && !self.language.may_omit_semicolons() {
            let text = "a declaration of a float, vector or colour ends with `;`";
            return Err(Error::invalid(self.here(), text));
        }
        Ok((value, is_ended))
    }

    /// Begins the value of a declaration one nesting level deeper. In old versions of the language it may end
    /// without a semicolon.
    fn begin_value(&mut self) -> Option<Unended> {
        let frame = self.frames.last().map_or(0, |frame| frame.serial);
        let begun = Unended { nesting: self.nesting + 1, braces: self.braces, frame };
        std::mem::replace(&mut self.unended, self.language.may_omit_semicolons().then_some(begun))
    }

    /// Called behind an operand: puts the semicolon that a declaration lacks before a directive or the end of a
    /// macro, so that the name has its value when what follows runs.
    pub(crate) fn end_value(&mut self) {
        let Some(frame) = self.frames.last() else { return };
        let here = Unended { nesting: self.nesting, braces: self.braces, frame: frame.serial };
        if self.unended != Some(here) || self.has_peeked() {
            return;
        }
        if matches!(self.raw(), None | Some(Kind::Directive(..))) {
            self.put_back(Lexeme { item: Item::Mark(Mark::Semicolon), place: self.here() });
        }
    }

    /// Skips a further semicolon behind a declaration, also where the declaration ends its file or macro: then the
    /// semicolon stands behind the include or the call (a fact of the language).
    fn skip_spare_semicolon(&mut self) {
        while !self.has_peeked() && self.raw().is_none() {
            if !self.leave_frame() {
                return;
            }
        }
        self.take_raw_mark(Mark::Semicolon);
    }

    /// Reads a value of any kind.
    pub(crate) fn value(&mut self, wanted: &str) -> Result<Value> {
        self.nested(|r| r.any_value(wanted))
    }

    fn any_value(&mut self, wanted: &str) -> Result<Value> {
        let keyword = match self.peek()? {
            Item::Word(keyword) => *keyword,
            Item::Text(..) | Item::Value(Value::Text(_)) => {
                let place = self.here();
                let text = self.string(wanted)?;
                return self.text_value(text, place);
            }
            Item::Value(Value::Number(_)) | Item::Number(_) => return self.number_value(),
            Item::Value(Value::Function(_) | Value::VectorFunction(_) | Value::Spline(_)) => {
                // The name of a function alone is the function, and that of a spline is the spline.
                let lexeme = self.next()?;
                if let (Item::Value(value), true) =
                    (&lexeme.item, self.raw() != Some(Kind::Mark(Mark::ParenOpen)))
                {
                    return Ok(value.clone());
                }
                self.put_back(lexeme);
                return self.number_value();
            }
            Item::Value(_) => {
                let lexeme = self.next()?;
                return match lexeme.item {
                    Item::Value(Value::Unsupported(ref what)) if what.number && !self.ends_value() => {
                        Err(self.unexpected(&lexeme, wanted))
                    }
                    Item::Value(value) => Ok(value),
                    _ => Err(self.unexpected(&lexeme, wanted)),
                };
            }
            Item::Mark(_) => {
                if self.starts_number()? {
                    return self.number_value();
                }
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, wanted));
            }
            Item::Unknown(_) | Item::End => {
                if self.at_extension()? {
                    return self.block_value();
                }
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, wanted));
            }
        };
        let place = self.here();
        match keyword {
            _ if makes_string(keyword) => {
                let text = self.string(wanted)?;
                self.text_value(text, place)
            }
            _ if begins_colour(keyword) => Ok(Value::Number(crate::value::Terms::new(&self.colour()?))),
            _ if crate::functions::begins_expression(keyword) => self.number_value(),
            Keyword::Array => {
                self.next()?;
                self.array()
            }
            _ => self.block_value(),
        }
    }

    /// Whether a semicolon, comma or closing mark follows at once.
    fn ends_value(&self) -> bool {
        matches!(
            self.raw(),
            Some(Kind::Mark(
                Mark::Semicolon | Mark::Comma | Mark::ParenClose | Mark::BraceClose | Mark::SquareClose
            ))
        )
    }

    fn number_value(&mut self) -> Result<Value> {
        let place = self.here();
        let terms = self.expression()?;
        if terms.len() == 5 {
            // `Name filter 0.5` is a colour, as is `color Name`.
            let mut colour = terms.all();
            self.colour_parts(&mut colour)?;
            return Ok(Value::Number(crate::value::Terms::new(&colour)));
        }
        // An infinite number is an error only where it is used.
        if let Some(part) = terms.as_slice().iter().find(|part| part.is_nan()) {
            crate::expression::finite(*part, place)?;
        }
        Ok(Value::Number(terms))
    }

    /// Reads a value that is a word and a block, such as `pigment { }` or `sphere { }`.
    fn block_value(&mut self) -> Result<Value> {
        let braces = self.braces;
        let called = matches!(self.peek_word()?, Some(Keyword::Function | Keyword::Spline));
        match self.understood_block() {
            Err(fault) if fault.kind == ErrorKind::Unsupported => {
                self.skip_block(braces, &fault)?;
                Ok(Value::Unsupported(Rc::new(Unsupported {
                    text: fault.text,
                    place: fault.place.filter(|_| !called),
                    number: called,
                })))
            }
            result => result,
        }
    }

    fn understood_block(&mut self) -> Result<Value> {
        let keyword = self.peek_word()?;
        let place = self.here();
        let Some(keyword) = keyword else { return self.object_value() };
        let base = self.defaults.clone();
        match keyword {
            Keyword::Transform => {
                self.next()?;
                self.transform_value(place)
            }
            // Outside of a block these words start a transformation, too: #declare T = translate x
            Keyword::Translate | Keyword::Rotate | Keyword::Scale | Keyword::Matrix => {
                match self.transform_item()? {
                    Some(matrix) => Ok(Value::Transform(Rc::new(matrix))),
                    None => Err(Error::invalid(place, "expected a transform")),
                }
            }
            Keyword::Texture => Ok(Value::Texture(Rc::new(self.texture_value()?))),
            Keyword::Pigment => {
                self.next()?;
                Ok(Value::Pigment(Rc::new(self.pigment_block(&base.pigment)?)))
            }
            Keyword::Normal => {
                self.next()?;
                let base = base.normal.as_deref().cloned().unwrap_or_default();
                Ok(Value::Normal(Rc::new(self.normal_block(&base)?)))
            }
            Keyword::SlopeMap => {
                self.next()?;
                Ok(Value::SlopeMap(self.slope_map_block()?))
            }
            Keyword::NormalMap => {
                self.next()?;
                Ok(Value::NormalMap(self.normal_map_block(false)?))
            }
            Keyword::Finish => {
                self.next()?;
                Ok(Value::Finish(Rc::new(self.finish_block(&base.finish)?)))
            }
            Keyword::Interior => {
                self.next()?;
                Ok(Value::Interior(self.interior_block()?))
            }
            Keyword::Material => {
                self.next()?;
                Ok(Value::Material(Rc::new(self.material_block()?)))
            }
            Keyword::ColorMap => {
                self.next()?;
                Ok(Value::ColorMap(self.color_map_block()?))
            }
            Keyword::PigmentMap => {
                self.next()?;
                Ok(Value::PigmentMap(self.pigment_map_block(false)?))
            }
            Keyword::TextureMap => {
                self.next()?;
                Ok(Value::TextureMap(self.texture_map_block(false)?))
            }
            Keyword::Fog => {
                self.next()?;
                Ok(Value::Fog(self.fog_block()?))
            }
            Keyword::SkySphere => {
                self.next()?;
                Ok(Value::SkySphere(self.sky_sphere_block()?))
            }
            Keyword::Camera => {
                self.next()?;
                self.camera_value()
            }
            Keyword::Rainbow => {
                self.next()?;
                Ok(Value::Rainbow(self.rainbow_block()?))
            }
            Keyword::Media => {
                self.next()?;
                self.leave_out(keyword, place)?;
                let text = format!("not supported yet: {}", keyword.text());
                let what = Unsupported { text, place: Some(place), number: false };
                Ok(Value::Unsupported(Rc::new(what)))
            }
            Keyword::Function => self.function_block(),
            Keyword::Spline => Ok(Value::Spline(Rc::new(self.spline_value()?))),
            _ => self.object_value(),
        }
    }

    /// Skips the rest of a block in which something unsupported was found.
    fn skip_block(&mut self, braces: u64, fault: &Error) -> Result<()> {
        // Up to the block's opening brace, if the error came before it: function (x, y) { }
        while self.braces <= braces {
            let lexeme = self.next()?;
            match lexeme.item {
                Item::Mark(Mark::BraceClose | Mark::Semicolon) | Item::End => {
                    return Err(Box::new(fault.clone()));
                }
                _ => {}
            }
        }
        while self.braces > braces {
            match self.next()?.item {
                // A call with side effects cannot be skipped without changing the scene.
                Item::Word(Keyword::Rand | Keyword::Seed | Keyword::Trace) | Item::End => {
                    return Err(Box::new(fault.clone()));
                }
                _ => {}
            }
        }
        // The layers of one texture belong together.
        if self.raw_or_peeked_texture()? {
            self.next()?;
            return self.skip_block(braces, fault);
        }
        Ok(())
    }

    fn raw_or_peeked_texture(&mut self) -> Result<bool> {
        if self.has_peeked() {
            return Ok(self.peek_word()? == Some(Keyword::Texture));
        }
        Ok(self.raw() == Some(Kind::Word(Keyword::Texture)))
    }
}

//! Directives: conditions, loops, includes, messages. They run while tokens are read.

use std::path::PathBuf;

use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::expression::{nearly_same, same};
use crate::interner::Name;
use crate::lexer::{Directive, Kind, Mark};
use crate::messages::{Message, MessageKind};
use crate::parser::{Control, Parser};
use crate::shipped;
use crate::value::Value;

/// The number of steps that a message counts for, in addition to its letters.
const MESSAGE_STEPS: u64 = 100;

impl Parser<'_> {
    /// Runs the directive that was just taken; `block` is its entry in the table of jumps.
    pub(crate) fn run_directive(&mut self, directive: Directive, block: u32, place: Place) -> Result<()> {
        match directive {
            Directive::Declare => self.declare(false, place),
            Directive::Local => self.declare(true, place),
            Directive::Undef => self.undefine(),
            Directive::Include => self.include(place),
            Directive::Default => self.default_texture(),
            Directive::Version => self.version_directive(place),
            Directive::If | Directive::Ifdef | Directive::Ifndef => self.choose(directive, block, place),
            Directive::Switch => self.switch(block, place),
            Directive::While => self.while_loop(block, place),
            Directive::For => self.for_loop(block, place),
            Directive::Macro => self.define_macro(self.jump(block).end as usize, place),
            Directive::End => self.end(block, place),
            Directive::Break => self.leave_block(block, true),
            // Reached at the end of the branch before it, so the block is done.
            Directive::Else | Directive::Elseif => self.leave_block(block, false),
            Directive::Case | Directive::Range => self.skip_parentheses(place),
            Directive::Debug | Directive::Warning | Directive::Error => self.message(directive, place),
            // POV-Ray has ignored these since 3.0: the text is read and discarded.
            Directive::Statistics | Directive::Render => self.string("the message").map(drop),
            Directive::Fopen | Directive::Fclose | Directive::Read | Directive::Write => {
                self.file_directive(directive, place)
            }
        }
    }

    fn jump(&self, block: u32) -> crate::branches::Block {
        let blocks = self.frames.last().map(|frame| &frame.source.blocks);
        // `match_blocks` gave every block directive its entry.
        blocks.and_then(|b| b.get(block as usize)).copied().unwrap_or_default()
    }

    fn serial(&self) -> u64 {
        self.frames.last().map_or(0, |frame| frame.serial)
    }

    fn go_to(&mut self, token: usize) {
        if let Some(frame) = self.frames.last_mut() {
            frame.at = token;
        }
    }

    fn push_control(&mut self, control: Control) {
        if let Some(frame) = self.frames.last_mut() {
            frame.controls.push(control);
        }
    }

    fn token_kind(&self, token: usize) -> Option<Kind> {
        self.frames.last().and_then(|frame| frame.source.tokens.get(token)).map(|t| t.kind)
    }

    /// Reads a condition or number in parentheses after a directive; comparisons are allowed in it.
    fn parenthesised(&mut self, place: Place) -> Result<f64> {
        let serial = self.serial();
        self.expect(Mark::ParenOpen)?;
        let value = self.relation()?;
        self.expect(Mark::ParenClose)?;
        self.back_to_frame(serial, place)?;
        value
            .float()
            .ok_or_else(|| Error::invalid(place, "a condition is a float, this is a vector or colour"))
    }

    /// Reads `(NAME)` or `(NAME[i])` and returns whether that has a value.
    fn is_defined(&mut self, place: Place) -> Result<bool> {
        let serial = self.serial();
        self.expect(Mark::ParenOpen)?;
        let known = self.defined_name()?;
        self.expect(Mark::ParenClose)?;
        self.back_to_frame(serial, place)?;
        Ok(known)
    }

    fn condition(&mut self, directive: Directive, place: Place) -> Result<bool> {
        match directive {
            Directive::Ifdef => self.is_defined(place),
            Directive::Ifndef => Ok(!self.is_defined(place)?),
            _ => Ok(truth(self.parenthesised(place)?)),
        }
    }

    fn choose(&mut self, mut directive: Directive, mut block: u32, place: Place) -> Result<()> {
        loop {
            if self.condition(directive, place)? {
                self.push_control(Control::Branch);
                return Ok(());
            }
            let next = self.jump(block).next as usize;
            self.go_to(next + 1);
            match self.token_kind(next) {
                Some(Kind::Directive(Directive::Elseif, index)) => {
                    (directive, block) = (Directive::Elseif, index);
                }
                Some(Kind::Directive(Directive::Else, _)) => {
                    self.push_control(Control::Branch);
                    return Ok(());
                }
                _ => return Ok(()),
            }
        }
    }

    fn switch(&mut self, block: u32, place: Place) -> Result<()> {
        let value = self.parenthesised(place)?;
        let mut next = self.jump(block).next as usize;
        loop {
            self.go_to(next + 1);
            let Some(Kind::Directive(directive, index)) = self.token_kind(next) else { return Ok(()) };
            let chosen = match directive {
                Directive::Case => nearly_same(value, self.parenthesised(place)?),
                Directive::Range => {
                    let (first, last) = self.range(place)?;
                    value >= first && value <= last
                }
                Directive::Else => true,
                _ => return Ok(()),
            };
            if chosen {
                self.push_control(Control::Branch);
                return Ok(());
            }
            next = self.jump(index).next as usize;
        }
    }

    /// Reads `(first, last)`.
    fn range(&mut self, place: Place) -> Result<(f64, f64)> {
        let serial = self.serial();
        self.expect(Mark::ParenOpen)?;
        let first = self.float()?;
        self.skip_comma()?;
        let last = self.float()?;
        self.expect(Mark::ParenClose)?;
        self.back_to_frame(serial, place)?;
        Ok((first, last))
    }

    fn while_loop(&mut self, block: u32, place: Place) -> Result<()> {
        let serial = self.serial();
        let head = self.frames.last().map_or(0, |frame| frame.at);
        if truth(self.parenthesised(place)?) {
            self.back_to_frame(serial, place)?;
            self.push_control(Control::While(head));
        } else {
            let end = self.jump(block).end as usize;
            self.go_to(end + 1);
        }
        Ok(())
    }

    /// Reads and starts `#for (NAME, first, last [, step])`.
    fn for_loop(&mut self, block: u32, place: Place) -> Result<()> {
        let serial = self.serial();
        self.expect(Mark::ParenOpen)?;
        let Some((Kind::Name(variable), _)) = self.take_raw() else {
            return Err(Error::invalid(self.here(), "expected the name of the loop's variable"));
        };
        self.skip_comma()?;
        let first = self.float()?;
        self.skip_comma()?;
        let last = self.float()?;
        let step = if self.take_mark(Mark::Comma)? { self.float()? } else { 1.0 };
        self.expect(Mark::ParenClose)?;
        self.back_to_frame(serial, place)?;
        if step == 0.0 {
            return Err(Error::invalid(place, "the step of a #for is zero: it would never end"));
        }
        self.scopes.local(variable, Value::Number(first.into()));
        if goes_on(first, last, step) {
            let body = self.frames.last().map_or(0, |frame| frame.at);
            self.push_control(Control::For { body, variable, last, step });
        } else {
            let end = self.jump(block).end as usize;
            self.go_to(end + 1);
        }
        Ok(())
    }

    fn end(&mut self, block: u32, place: Place) -> Result<()> {
        let control = self.frames.last_mut().and_then(|frame| frame.controls.pop());
        match control {
            None => Err(Error::invalid(place, "this #end closes no open block")),
            Some(Control::Branch) => Ok(()),
            Some(Control::While(head)) => {
                let Some(Kind::Directive(_, opener)) = self.token_kind(self.jump(block).next as usize) else {
                    return Ok(());
                };
                self.go_to(head);
                self.while_loop(opener, place)
            }
            Some(Control::For { body, variable, last, step }) => {
                // The body may have changed the variable; the loop continues from its new value.
                let now = match self.scopes.get(variable) {
                    Some(Value::Number(terms)) => terms.float(),
                    _ => None,
                };
                let Some(now) = now else {
                    return Err(Error::invalid(place, "the loop's variable is no float any more"));
                };
                let value = now + step;
                if value == now {
                    return Err(Error::invalid(
                        place,
                        "the step of this #for is too small to change its variable",
                    ));
                }
                self.scopes.declare(variable, Value::Number(value.into()));
                if goes_on(value, last, step) {
                    self.go_to(body);
                    self.push_control(Control::For { body, variable, last, step });
                }
                Ok(())
            }
        }
    }

    /// Continues after the block's `#end`. If `to_loop`, the branches inside the loop are left too.
    fn leave_block(&mut self, block: u32, to_loop: bool) -> Result<()> {
        let jump = self.jump(block);
        let Some(frame) = self.frames.last_mut() else { return Ok(()) };
        if to_loop {
            let keep = frame.controls.len().saturating_sub(jump.leaves as usize);
            frame.controls.truncate(keep);
        } else {
            frame.controls.pop();
        }
        frame.at = jump.end as usize + 1;
        Ok(())
    }

    fn skip_parentheses(&mut self, place: Place) -> Result<()> {
        let mut depth = 0_usize;
        while let Some((kind, _)) = self.take_raw() {
            match kind {
                Kind::Mark(Mark::ParenOpen) => depth += 1,
                Kind::Mark(Mark::ParenClose) => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth == 0 {
                return Ok(());
            }
        }
        Err(Error::invalid(place, "these parentheses are never closed"))
    }

    fn undefine(&mut self) -> Result<()> {
        let place = self.here();
        match self.raw() {
            Some(Kind::Name(name)) if self.raw_ahead(1) != Some(Kind::Mark(Mark::SquareOpen)) => {
                self.take_raw();
                if !self.scopes.undefine(name) {
                    let text = format!("#undef of `{}`, which is not declared", self.names.text(name));
                    self.notice(place, text);
                }
            }
            Some(Kind::Name(name)) => {
                self.take_raw();
                let target = self.element_reference(name)?;
                if let Some(held) = self.scopes.get_mut(&target) {
                    *held = Value::Empty;
                }
            }
            _ => {
                self.take_raw();
                return Err(Error::invalid(self.here(), "expected the name of a variable"));
            }
        }
        self.take_raw_mark(Mark::Semicolon);
        Ok(())
    }

    fn include(&mut self, place: Place) -> Result<()> {
        let serial = self.serial();
        let name = self.file_name()?;
        let at = self.here();
        self.back_to_frame(serial, place)?;
        if let Some((path, text)) = self.written_file(&name) {
            let file = self.load_text(path, text)?;
            return self.enter_file(file, Some(place));
        }
        let Some(path) = self.library.find(&name) else {
            if let Some(text) = shipped::include(&name) {
                let path = PathBuf::from(format!("durer's own {name}"));
                let file = self.load_text(path, text.to_owned())?;
                return self.enter_file(file, Some(place));
            }
            let names = self.library.names();
            let near = crate::parser::nearest(&name, names.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!(" (did you mean \"{near}\"?)"));
            let folders = self.library.listed();
            return Err(Error::file(
                Some(at),
                format!("there is no include file \"{name}\"{near}; searched: {folders}"),
            ));
        };
        let file = self.load(path, Some(at))?;
        self.enter_file(file, Some(place))
    }

    fn message(&mut self, directive: Directive, place: Place) -> Result<()> {
        let text = self.string("the message")?;
        let kind = match directive {
            Directive::Debug => MessageKind::Debug,
            Directive::Warning => MessageKind::Warning,
            _ => return Err(Error::at(place, ErrorKind::Raised, format!("#error: {}", text.trim_end()))),
        };
        // Messages cost time where they are shown.
        self.count_steps(MESSAGE_STEPS + text.len() as u64, place)?;
        self.say(kind, place, text);
        Ok(())
    }

    fn say(&mut self, kind: MessageKind, place: Place, text: String) {
        let source = &self.sources[place.file as usize];
        let at = self.messages.locate(source, place);
        let path = source.path.clone();
        self.messages.push(place, Message { kind, path, at, text });
    }

    /// Adds a warning of the reader itself.
    pub(crate) fn notice(&mut self, place: Place, text: impl Into<String>) {
        self.say(MessageKind::Notice, place, text.into());
    }

    fn version_directive(&mut self, place: Place) -> Result<()> {
        // The word is recognised without a look at the next item, which would run a following
        // directive too early.
        if matches!(self.raw(), Some(Kind::Name(name)) if self.names.text(name) == "unofficial") {
            self.take_raw();
        }
        let version = self.operand()?;
        let version = version.float().ok_or_else(|| Error::invalid(place, "a version is a float"))?;
        self.take_raw_mark(Mark::Semicolon);
        self.set_version(version, place)
    }

    /// Reads the name after `#declare`, `defined(` and the like, with its subscripts. Returns
    /// whether it has a value.
    pub(crate) fn defined_name(&mut self) -> Result<bool> {
        match self.take_raw() {
            Some((Kind::Name(name), _)) => {
                if self.raw() == Some(Kind::Mark(Mark::SquareOpen)) && self.scopes.get(name).is_some() {
                    let target = self.element_reference(name)?;
                    return Ok(self.scopes.at(&target).is_some_and(|value| !matches!(value, Value::Empty)));
                }
                Ok(self.scopes.get(name).is_some_and(|value| !matches!(value, Value::Empty)))
            }
            // A reserved word counts as defined: the standard files test this for words of newer
            // versions.
            Some((Kind::Word(_), _)) => Ok(true),
            _ => Err(Error::invalid(self.here(), "expected a name")),
        }
    }

    /// Declares `name` before the scene is read.
    pub(crate) fn predeclare(&mut self, name: &str, value: f64) -> Option<Name> {
        let name = self.names.name(name);
        crate::keywords::Keyword::from_name(name).is_none().then(|| {
            self.scopes.declare(name, Value::Number(value.into()));
            name
        })
    }
}

/// Whether a condition holds: its value is not zero, within the language's tolerance.
pub(crate) fn truth(value: f64) -> bool {
    !same(value, 0.0)
}

fn goes_on(value: f64, last: f64, step: f64) -> bool {
    nearly_same(value, last) || if step > 0.0 { value <= last } else { value >= last }
}

//! `#fopen`, `#read`, `#write`, `#fclose`: the files that a scene opens by itself.
//!
//! Reading a scene never changes anything outside. What the scene writes is kept in memory: the
//! scene itself can read and include it, and [`crate::Read::written`] hands it to the caller, who
//! decides whether it is saved. Names lead into one folder, the scene's own or a given one, unless
//! [`crate::ReadOptions::any_file`] allows others.

use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use crate::diagnostics::{Error, Place, Result};
use crate::interner::Name;
use crate::lexer::{Directive, Kind, Mark};
use crate::parser::{Item, Parser};
use crate::source::{self, Source};
use crate::strings::{makes_string, unescape};
use crate::value::{Terms, Value};

/// A file that a scene has written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFile {
    /// Its path.
    pub path: PathBuf,
    /// Its contents.
    pub text: String,
}

/// The open files and the written ones.
#[derive(Debug, Default)]
pub(crate) struct Files {
    open: Vec<Handle>,
    pub(crate) written: Vec<WrittenFile>,
}

/// An open file.
#[derive(Debug)]
enum Handle {
    Closed,
    /// Its number among the written files.
    Writes(usize),
    /// Its tokens, and the number of the next one.
    Reads(Rc<Source>, usize),
}

/// Files that are open at the same time; scenes use one or two.
const MOST_OPEN: usize = 64;

impl Files {
    /// The contents that the scene has written to the file at `path`.
    fn contents(&self, path: &Path) -> Option<&str> {
        let file = self.written.iter().find(|file| file.path == path)?;
        Some(&file.text)
    }
}

impl Parser<'_> {
    /// The path to which a scene's own file is written.
    fn own_file(&self, name: &str, at: Place) -> Result<PathBuf> {
        let turned = name.trim().replace('\\', "/");
        let path = Path::new(&turned);
        let leaves = path.components().any(|part| !matches!(part, Component::Normal(_) | Component::CurDir));
        let folder = self.options.write_folder.as_deref().unwrap_or_else(|| self.library.home());
        if turned.is_empty() || turned.contains('\0') {
            return Err(Error::invalid(at, "a file needs a name"));
        }
        if leaves && !self.options.any_file {
            let text = format!(
                "\"{name}\" must be a relative path without `..`, so that it stays in the folder for the scene's files (--allow-io permits other paths)"
            );
            return Err(Error::file(Some(at), text));
        }
        Ok(folder.join(path))
    }

    /// The path of what the scene has written under this name, and its text.
    pub(crate) fn written_file(&self, name: &str) -> Option<(PathBuf, String)> {
        if self.files.written.is_empty() {
            return None;
        }
        let path = self.own_file(name, Place::default()).ok()?;
        let text = self.files.contents(&path)?.to_owned();
        Some((path, text))
    }

    /// Runs one of the directives for files.
    pub(crate) fn file_directive(&mut self, directive: Directive, place: Place) -> Result<()> {
        match directive {
            Directive::Fopen => self.open_file(place),
            Directive::Fclose => self.close_file(),
            Directive::Read => self.read_values(place),
            _ => self.write_values(place),
        }
    }

    fn open_file(&mut self, place: Place) -> Result<()> {
        let Some((Kind::Name(handle), _)) = self.take_raw() else {
            return Err(Error::invalid(self.here(), "expected a name for the opened file"));
        };
        let name = self.file_name()?;
        let at = self.here();
        let mode = self.take_raw();
        let word = match mode {
            Some((Kind::Word(word), _)) => word.text(),
            // The words of this directive alone.
            Some((Kind::Name(name), _)) => self.names.text(name),
            Some((Kind::Directive(directive, _), _)) => directive.text(),
            _ => "",
        };
        let opened = match word {
            "read" => self.opened_to_read(&name, at)?,
            "write" => Handle::Writes(self.opened_to_write(&name, at, false)?),
            "append" => Handle::Writes(self.opened_to_write(&name, at, true)?),
            _ => return Err(Error::invalid(self.here(), "a file is opened to read, write or append")),
        };
        let free = self.files.open.iter().position(|handle| matches!(handle, Handle::Closed));
        let number = match free {
            Some(number) => number,
            None if self.files.open.len() < MOST_OPEN => {
                self.files.open.push(Handle::Closed);
                self.files.open.len() - 1
            }
            None => {
                let text = format!("a scene has at most {MOST_OPEN} files open");
                return Err(Error::invalid(place, text));
            }
        };
        let is_over = matches!(&opened, Handle::Reads(source, _) if source.tokens.is_empty());
        self.files.open[number] = opened;
        self.scopes.declare(handle, Value::File(number));
        if is_over {
            self.forget(handle);
        }
        Ok(())
    }

    fn opened_to_read(&mut self, name: &str, at: Place) -> Result<Handle> {
        let (path, text) = match self.written_file(name) {
            Some(written) => written,
            None => {
                let Some(path) = self.library.find(name) else {
                    let folders = self.library.listed();
                    let text = format!("there is no file \"{name}\"; searched: {folders}");
                    return Err(Error::file(Some(at), text));
                };
                let text = source::read_text(&path, &self.options.limits)
                    .map_err(|why| Error::file(Some(at), format!("{}: {why}", path.display())))?;
                (path, text)
            }
        };
        self.check_memory(text.len(), at)?;
        // A place in it for messages: that of the directive. Its tokens are only values.
        let mut source = Source::new(path, text);
        let limits = &self.options.limits;
        crate::lexer::lex(&mut source, at.file, &mut self.names, limits).map_err(|mut fault| {
            fault.text = format!("{}: {}", source.path.display(), fault.text);
            fault.place = Some(at);
            fault
        })?;
        self.count_steps(source.tokens.len() as u64, at)?;
        Ok(Handle::Reads(Rc::new(source), 0))
    }

    fn opened_to_write(&mut self, name: &str, at: Place, appends: bool) -> Result<usize> {
        let path = self.own_file(name, at)?;
        let known = self.files.written.iter().position(|file| file.path == path);
        let number = known.unwrap_or(self.files.written.len());
        if known.is_none() {
            self.check_memory(self.files.written.len() * 64, at)?;
            let before = match appends && path.exists() {
                true => source::read_text(&path, &self.options.limits)
                    .map_err(|why| Error::file(Some(at), format!("{}: {why}", path.display())))?,
                false => String::new(),
            };
            crate::limits::charge_for_good(before.len() + 256);
            self.files.written.push(WrittenFile { path, text: before });
        } else if !appends {
            self.files.written[number].text.clear();
        }
        Ok(number)
    }

    /// Takes the name of an open file.
    fn open_handle(&mut self) -> Result<(Name, usize)> {
        if let Some((Kind::Name(name), at)) = self.take_raw() {
            return match self.scopes.get(name) {
                Some(Value::File(number)) => Ok((name, *number)),
                _ => {
                    let text = format!("`{}` is no open file", self.names.text(name));
                    Err(Error::invalid(at, text))
                }
            };
        }
        Err(Error::invalid(self.here(), "expected the name of an open file"))
    }

    fn close_file(&mut self) -> Result<()> {
        // A file that has been read to its end is closed already.
        let Some((Kind::Name(name), _)) = self.take_raw() else {
            return Err(Error::invalid(self.here(), "expected the name of an open file"));
        };
        self.forget(name);
        Ok(())
    }

    /// Closes a file; its name is then not defined any more.
    fn forget(&mut self, name: Name) {
        if let Some(&Value::File(number)) = self.scopes.get(name) {
            self.files.open[number] = Handle::Closed;
            self.scopes.undefine(name);
        }
    }

    /// `#read (FILE, NAME, ...)`: after the last value of the file its name is not defined any more.
    fn read_values(&mut self, place: Place) -> Result<()> {
        self.expect(Mark::ParenOpen)?;
        let (handle, number) = self.open_handle()?;
        let mut has_ended = false;
        loop {
            self.take_raw_mark(Mark::Comma);
            if self.take_raw_mark(Mark::ParenClose) {
                return Ok(());
            }
            let Some((Kind::Name(name), at)) = self.take_raw() else {
                return Err(Error::invalid(self.here(), "expected the name of a variable to read into"));
            };
            let element = match self.raw() {
                Some(Kind::Mark(Mark::SquareOpen)) => Some(self.element_reference(name)?),
                _ => None,
            };
            let Some(Handle::Reads(source, token)) = self.files.open.get(number) else {
                let why = if has_ended { "has no more values" } else { "is not open for reading" };
                return Err(Error::invalid(if has_ended { at } else { place }, format!("the file {why}")));
            };
            let mut data = Data { source: source.clone(), at: *token };
            let value = data.value(at)?;
            has_ended = data.is_over();
            let next = data.at;
            if let Some(Handle::Reads(_, token)) = self.files.open.get_mut(number) {
                *token = next;
            }
            let value = match value {
                Datum::Numbers(terms) => Value::Number(terms),
                Datum::Text(text) => self.text_value(text, at)?,
            };
            self.count_steps(1, at)?;
            match element {
                Some(target) => self.assign_element(&target, value, at)?,
                None => self.scopes.declare(name, value),
            }
            if has_ended && matches!(self.scopes.get(handle), Some(Value::File(_))) {
                self.files.open[number] = Handle::Closed;
                self.scopes.undefine(handle);
            }
        }
    }

    /// `#write (FILE, value, ...)`.
    fn write_values(&mut self, place: Place) -> Result<()> {
        self.expect(Mark::ParenOpen)?;
        let (_, number) = self.open_handle()?;
        loop {
            self.skip_comma()?;
            if self.take_mark(Mark::ParenClose)? {
                return Ok(());
            }
            let is_text = match self.peek()? {
                Item::Text(..) | Item::Value(Value::Text(_)) => true,
                Item::Word(word) => makes_string(*word),
                _ => false,
            };
            let text = if is_text { self.string("the file")? } else { shown(self.expression()?) };
            let Some(&Handle::Writes(file)) = self.files.open.get(number) else {
                return Err(Error::invalid(place, "the file is not open for writing"));
            };
            self.count_steps(1 + text.len() as u64 / 16, place)?;
            crate::limits::charge_for_good(text.len());
            self.check_memory(0, place)?;
            self.files.written[file].text += &text;
        }
    }
}

/// A value of a data file.
enum Datum {
    Numbers(Terms),
    Text(String),
}

/// The tokens of a data file.
struct Data {
    source: Rc<Source>,
    at: usize,
}

impl Data {
    fn peek(&self) -> Option<Kind> {
        self.source.tokens.get(self.at).map(|token| token.kind)
    }

    /// Whether only commas are left.
    fn is_over(&self) -> bool {
        self.source.tokens[self.at..].iter().all(|token| token.kind == Kind::Mark(Mark::Comma))
    }

    fn skip_commas(&mut self) {
        while self.peek() == Some(Kind::Mark(Mark::Comma)) {
            self.at += 1;
        }
    }

    fn number(&mut self) -> Option<f64> {
        let mut sign = 1.0;
        while let Some(Kind::Mark(mark @ (Mark::Minus | Mark::Plus))) = self.peek() {
            if mark == Mark::Minus {
                sign = -sign;
            }
            self.at += 1;
        }
        let Some(Kind::Number(index)) = self.peek() else { return None };
        self.at += 1;
        Some(sign * self.source.numbers[index as usize])
    }

    /// The next value: a number, a vector or a string.
    fn value(&mut self, at: Place) -> Result<Datum> {
        self.skip_commas();
        let wrong = |data: &Self| {
            let line = data.source.tokens.get(data.at).map_or(0, |token| token.start);
            let (line, column) = data.source.line_and_column(line as usize);
            let path = data.source.path.display();
            let text = format!("{path}:{line}:{column}: a number, vector or string is read from here");
            Error::invalid(at, text)
        };
        match self.peek() {
            Some(Kind::Text(index)) => {
                self.at += 1;
                unescape(&self.source.strings[index as usize], at).map(Datum::Text)
            }
            Some(Kind::Mark(Mark::Less)) => {
                self.at += 1;
                let mut terms = Vec::new();
                loop {
                    self.skip_commas();
                    if self.peek() == Some(Kind::Mark(Mark::Greater)) {
                        self.at += 1;
                        break;
                    }
                    terms.push(self.number().filter(|_| terms.len() < 5).ok_or_else(|| wrong(self))?);
                }
                if terms.len() < 2 {
                    return Err(wrong(self));
                }
                Ok(Datum::Numbers(Terms::new(&terms)))
            }
            _ => self.number().map(|number| Datum::Numbers(number.into())).ok_or_else(|| wrong(self)),
        }
    }
}

/// A number or vector as the language writes it into files: with six digits.
fn shown(terms: Terms) -> String {
    let parts: Vec<String> = terms.as_slice().iter().map(|part| six_digits(*part)).collect();
    if parts.len() == 1 { parts.concat() } else { format!("<{}> ", parts.join(",")) }
}

/// Formats like C's `%g`.
fn six_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let scientific = format!("{value:.5e}");
    let Some((digits, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..6).contains(&exponent) {
        let decimals = (5 - exponent) as usize;
        trimmed(&format!("{value:.decimals$}"))
    } else {
        let sign = if exponent < 0 { '-' } else { '+' };
        format!("{}e{sign}{:02}", trimmed(digits), exponent.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_c_does() {
        let shown = [1.0, 0.1, 1.0 / 3.0, 1e10, -2.5e-7, 123_456_789.0, 0.0001, 999_999.5, 100.0, 0.0];
        let wanted = "1 0.1 0.333333 1e+10 -2.5e-07 1.23457e+08 0.0001 1e+06 100 0";
        assert_eq!(shown.map(six_digits).join(" "), wanted);
        assert_eq!(super::shown(Terms::new(&[1.0, 2.0 / 3.0, 3.0])), "<1,0.666667,3> ");
    }
}

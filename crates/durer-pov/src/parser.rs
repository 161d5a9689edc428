//! The parser: the state of the reader, and the stream of tokens as the grammar sees it.
//!
//! [`Parser::next`] runs directives and expands macros, because they may stand anywhere a token
//! may. It replaces identifiers by their values.

use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

use crate::ReadOptions;
use crate::diagnostics::{Error, Place, Result};
use crate::interner::{Interner, Name};
use crate::keywords::Keyword;
use crate::lexer::{Directive, Kind, Mark, Token};
use crate::limits;
use crate::macros::Macro;
use crate::messages::Messages;
use crate::scope::Scopes;
use crate::source::{self, Library, Source};
use crate::value::{Text, Value};

/// A token for the grammar, after directives and macros.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Number(f64),
    /// A string with its escapes unresolved.
    Text(Rc<Source>, u32),
    Word(Keyword),
    Mark(Mark),
    /// The value of an identifier; for an array followed by subscripts, that of the element.
    Value(Value),
    /// An undeclared word (which may be one of durer's own; see [`crate::object::extension`]).
    Unknown(Name),
    End,
}

/// An [`Item`] and its place.
#[derive(Clone, Debug)]
pub(crate) struct Lexeme {
    pub(crate) item: Item,
    pub(crate) place: Place,
}

/// A loop or choice that is running.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Control {
    /// `#if` and its variants, `#switch`.
    Branch,
    /// `#while`, with the token of its condition.
    While(usize),
    /// `#for`, with the first token of its body.
    For { body: usize, variable: Name, last: f64, step: f64 },
}

/// A range of tokens being read: a file or a macro's body.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) source: Rc<Source>,
    pub(crate) file: u32,
    pub(crate) at: usize,
    pub(crate) end: usize,
    pub(crate) controls: Vec<Control>,
    pub(crate) serial: u64,
    /// The place of the call, and the macro's name; `None` for the scene itself.
    pub(crate) from: Option<(Option<Name>, Place)>,
}

/// The reader of one scene.
pub(crate) struct Parser<'a> {
    pub(crate) options: &'a ReadOptions,
    pub(crate) names: Interner,
    pub(crate) sources: Vec<Rc<Source>>,
    loaded: HashMap<PathBuf, u32>,
    pub(crate) library: Library,
    pub(crate) frames: Vec<Frame>,
    pub(crate) scopes: Scopes,
    /// The name that the current declaration will declare.
    pub(crate) declaring: Option<Name>,
    /// The declaration that is being read, if it may end without a semicolon.
    pub(crate) unended: Option<crate::declare::Unended>,
    pub(crate) messages: Messages<'a>,
    peeked: Option<Lexeme>,
    last: Place,
    serial: u64,
    steps: u64,
    pub(crate) nesting: u64,
    /// The number of open braces in the tokens that the grammar has taken.
    pub(crate) braces: u64,
    /// The places of these braces.
    opened: Vec<Place>,
    include_depth: u64,
    macro_depth: u64,
    pub(crate) streams: Vec<u32>,
    pub(crate) files: crate::files::Files,
    pub(crate) language: crate::settings::Language,
    /// The features of the scene that are left out of the picture.
    pub(crate) left_out: Vec<&'static str>,
    pub(crate) defaults: Rc<crate::texture::Layer>,
    pub(crate) default_camera: crate::camera::Camera,
    pub(crate) scene: crate::scene_builder::Output,
    /// The objects that the scene queries.
    pub(crate) questions: crate::object::queries::Questions,
}

impl<'a> Parser<'a> {
    pub(crate) fn new(options: &'a ReadOptions, library: Library, messages: Messages<'a>) -> Self {
        Self {
            options,
            names: Interner::new(),
            sources: Vec::new(),
            loaded: HashMap::new(),
            library,
            frames: Vec::new(),
            scopes: Scopes::default(),
            declaring: None,
            unended: None,
            messages,
            peeked: None,
            last: Place::default(),
            serial: 0,
            steps: 0,
            nesting: 0,
            braces: 0,
            opened: Vec::new(),
            include_depth: 0,
            macro_depth: 0,
            streams: Vec::new(),
            files: crate::files::Files::default(),
            language: crate::settings::Language::default(),
            left_out: Vec::new(),
            defaults: Rc::default(),
            default_camera: crate::camera::Camera::default(),
            scene: crate::scene_builder::Output::default(),
            questions: crate::object::queries::Questions::default(),
        }
    }

    /// Loads the file at `path`, or finds it among the files already loaded.
    pub(crate) fn load(&mut self, path: PathBuf, from: Option<Place>) -> Result<u32> {
        if let Some(&file) = self.loaded.get(&path) {
            return Ok(file);
        }
        let text = source::read_text(&path, &self.options.limits).map_err(|why| {
            Error::file(from, if from.is_some() { format!("{}: {why}", path.display()) } else { why })
        })?;
        let file = self.load_text(path.clone(), text)?;
        self.loaded.insert(path, file);
        Ok(file)
    }

    /// Loads `text` as the contents of the file at `path`.
    pub(crate) fn load_text(&mut self, path: PathBuf, text: String) -> Result<u32> {
        let file = self.sources.len() as u32;
        let mut source = Source::new(path, text);
        limits::charge_for_good(source.text.len());
        let mut result = crate::lexer::lex(&mut source, file, &mut self.names, &self.options.limits);
        if result.is_ok() {
            result = crate::branches::match_blocks(&mut source, file);
        }
        source.tokens.shrink_to_fit();
        source.numbers.shrink_to_fit();
        limits::charge_for_good(
            source.tokens.len() * 12 + source.numbers.len() * 8 + source.strings.len() * 32,
        );
        self.sources.push(Rc::new(source));
        result.map(|()| file)
    }

    /// Starts reading file number `file`.
    pub(crate) fn enter_file(&mut self, file: u32, from: Option<Place>) -> Result<()> {
        if let Some(place) = from {
            self.include_depth += 1;
            if self.include_depth > self.options.limits.include_depth {
                let limit = self.options.limits.include_depth;
                return Err(limits::exceeded(
                    place,
                    "include_depth",
                    limit,
                    "files include each other too deeply",
                ));
            }
            self.scopes.enter();
        }
        let source = self.sources[file as usize].clone();
        let end = source.tokens.len();
        self.push_frame(Frame {
            source,
            file,
            at: 0,
            end,
            controls: Vec::new(),
            serial: 0,
            from: from.map(|place| (None, place)),
        });
        Ok(())
    }

    /// Starts reading the body of a macro; its scope is open already.
    pub(crate) fn enter_macro(&mut self, body: &Macro, place: Place) -> Result<()> {
        self.macro_depth += 1;
        if self.macro_depth > self.options.limits.macro_depth {
            let limit = self.options.limits.macro_depth;
            return Err(limits::exceeded(place, "macro_depth", limit, "macros call each other too deeply"));
        }
        let source = self.sources[body.file as usize].clone();
        self.push_frame(Frame {
            source,
            file: body.file,
            at: body.start,
            end: body.end,
            controls: Vec::new(),
            serial: 0,
            from: Some((Some(body.name), place)),
        });
        Ok(())
    }

    fn push_frame(&mut self, mut frame: Frame) {
        self.serial += 1;
        frame.serial = self.serial;
        self.frames.push(frame);
    }

    /// Leaves the innermost frame. Returns `false` if it is the scene itself.
    pub(crate) fn leave_frame(&mut self) -> bool {
        let Some(frame) = self.frames.pop_if(|frame| frame.from.is_some()) else { return false };
        match frame.from {
            Some((Some(_), _)) => self.macro_depth -= 1,
            _ => self.include_depth -= 1,
        }
        self.scopes.leave();
        true
    }

    /// Makes the frame numbered `serial` the innermost again. The frames within it must be read to
    /// their ends.
    pub(crate) fn back_to_frame(&mut self, serial: u64, place: Place) -> Result<()> {
        if self.leave_finished_frames(serial, place)? { Ok(()) } else { Err(strayed(place)) }
    }

    /// Leaves the frames within the one numbered `serial`, until one has more left than directives.
    /// Returns whether all were left.
    pub(crate) fn leave_finished_frames(&mut self, serial: u64, place: Place) -> Result<bool> {
        loop {
            let frame = self.frames.last().ok_or_else(|| strayed(place))?;
            if frame.serial == serial {
                return Ok(true);
            }
            if self.peeked.is_some() {
                return Ok(false);
            }
            match self.raw() {
                None if self.leave_frame() => {}
                // Directives after the last value of a macro.
                Some(Kind::Directive(directive, block)) => {
                    let at = self.take_raw().map_or(place, |(_, at)| at);
                    self.count_steps(1, at)?;
                    self.run_directive(directive, block, at)?;
                }
                _ => return Ok(false),
            }
        }
    }

    /// The macro calls and includes that led here, innermost first.
    pub(crate) fn route(&self) -> Vec<(String, Place)> {
        let step = |frame: &Frame| {
            let (name, place) = frame.from?;
            Some(match name {
                Some(name) => (format!("macro {}, called", self.names.text(name)), place),
                None => (format!("file {}, included", frame.source.path.display()), place),
            })
        };
        self.frames.iter().rev().filter_map(step).collect()
    }

    /// Counts `work` steps. Every token is one step.
    pub(crate) fn count_steps(&mut self, work: u64, place: Place) -> Result<()> {
        self.steps += work;
        if self.steps > self.options.limits.steps {
            let limit = self.options.limits.steps;
            return Err(limits::exceeded(place, "steps", limit, "this scene does not come to an end"));
        }
        Ok(())
    }

    /// Fails if `more` bytes would exceed the limit.
    pub(crate) fn check_memory(&self, more: usize, place: Place) -> Result<()> {
        limits::check_memory(place, &self.options.limits, more)
    }

    /// Runs `f` one nesting level deeper. This bounds the depth of the reader's recursion.
    pub(crate) fn nested<T>(&mut self, f: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        if self.nesting >= self.options.limits.nesting {
            let limit = self.options.limits.nesting;
            return Err(limits::exceeded(self.last, "nesting", limit, "too many things inside each other"));
        }
        self.nesting += 1;
        let result = f(self);
        self.nesting -= 1;
        result
    }

    /// The next token of the innermost frame, without running, expanding or taking it.
    pub(crate) fn raw(&self) -> Option<Kind> {
        self.raw_ahead(0)
    }

    /// The token `ahead` tokens after [`Parser::raw`].
    pub(crate) fn raw_ahead(&self, ahead: usize) -> Option<Kind> {
        debug_assert!(self.peeked.is_none(), "raw tokens cannot be read after a peek");
        let frame = self.frames.last()?;
        let at = frame.at + ahead;
        (at < frame.end).then(|| frame.source.tokens[at].kind)
    }

    /// Takes the next token unchanged.
    pub(crate) fn take_raw(&mut self) -> Option<(Kind, Place)> {
        let frame = self.frames.last_mut()?;
        if frame.at >= frame.end {
            return None;
        }
        let Token { start, kind } = frame.source.tokens[frame.at];
        frame.at += 1;
        self.last = Place { file: frame.file, start };
        Some((kind, self.last))
    }

    /// Takes `mark` if it is the next unchanged token.
    pub(crate) fn take_raw_mark(&mut self, mark: Mark) -> bool {
        let here = self.peeked.is_none() && self.raw() == Some(Kind::Mark(mark));
        if here {
            self.take_raw();
        }
        here
    }

    /// Whether the grammar has already looked at the next token.
    pub(crate) fn has_peeked(&self) -> bool {
        self.peeked.is_some()
    }

    /// The place of the token that was read last.
    pub(crate) fn here(&self) -> Place {
        self.peeked.as_ref().map_or(self.last, |lexeme| lexeme.place)
    }

    /// Looks at the next token without taking it.
    pub(crate) fn peek(&mut self) -> Result<&Item> {
        if self.peeked.is_none() {
            let lexeme = self.fetch()?;
            self.peeked = Some(lexeme);
        }
        match &self.peeked {
            Some(lexeme) => Ok(&lexeme.item),
            None => Ok(&Item::End),
        }
    }

    /// Takes the next token.
    pub(crate) fn next(&mut self) -> Result<Lexeme> {
        let lexeme = match self.peeked.take() {
            Some(lexeme) => lexeme,
            None => self.fetch()?,
        };
        match lexeme.item {
            Item::Mark(Mark::BraceOpen) => {
                self.braces += 1;
                self.opened.push(lexeme.place);
            }
            Item::Mark(Mark::BraceClose) => {
                self.braces = self.braces.saturating_sub(1);
                self.opened.pop();
            }
            _ => {}
        }
        self.last = lexeme.place;
        Ok(lexeme)
    }

    /// Puts back the token that was taken last.
    pub(crate) fn put_back(&mut self, lexeme: Lexeme) {
        match lexeme.item {
            Item::Mark(Mark::BraceOpen) => {
                self.braces = self.braces.saturating_sub(1);
                self.opened.pop();
            }
            Item::Mark(Mark::BraceClose) => {
                self.braces += 1;
                self.opened.push(lexeme.place);
            }
            _ => {}
        }
        self.peeked = Some(lexeme);
    }

    fn fetch(&mut self) -> Result<Lexeme> {
        loop {
            let Some((kind, place)) = self.take_raw() else {
                if self.leave_frame() {
                    continue;
                }
                return Ok(Lexeme { item: Item::End, place: self.last });
            };
            self.count_steps(1, place)?;
            let item = match kind {
                Kind::Number(index) => Item::Number(self.top().source.numbers[index as usize]),
                Kind::Text(index) => Item::Text(self.top().source.clone(), index),
                Kind::Word(keyword) => Item::Word(keyword),
                Kind::Mark(mark) => Item::Mark(mark),
                Kind::Name(name) => match self.scopes.get(name) {
                    None => Item::Unknown(name),
                    Some(Value::Macro(body)) => {
                        let body = body.clone();
                        self.nested(|r| r.call_macro(&body, place))?;
                        continue;
                    }
                    Some(Value::Array(_)) => Item::Value(self.array_or_element(name, place)?),
                    Some(value) => Item::Value(value.clone()),
                },
                Kind::Directive(directive, block) => {
                    self.nested(|r| r.run_directive(directive, block, place))?;
                    // A directive may have looked one token too far.
                    match self.peeked.take() {
                        Some(lexeme) => return Ok(lexeme),
                        None => continue,
                    }
                }
            };
            return Ok(Lexeme { item, place });
        }
    }

    fn top(&self) -> &Frame {
        // A token was just taken from this frame.
        &self.frames[self.frames.len() - 1]
    }

    /// Whether the next token is `mark`.
    pub(crate) fn at_mark(&mut self, mark: Mark) -> Result<bool> {
        Ok(matches!(self.peek()?, Item::Mark(found) if *found == mark))
    }

    /// Takes `mark` if it comes next.
    pub(crate) fn take_mark(&mut self, mark: Mark) -> Result<bool> {
        let here = self.at_mark(mark)?;
        if here {
            self.next()?;
        }
        Ok(here)
    }

    /// Skips a comma, which is usually optional in this language.
    pub(crate) fn skip_comma(&mut self) -> Result<()> {
        self.take_mark(Mark::Comma).map(drop)
    }

    /// Takes `mark`; it is an error if another token comes next.
    pub(crate) fn expect(&mut self, mark: Mark) -> Result<()> {
        let lexeme = self.next()?;
        if matches!(lexeme.item, Item::Mark(found) if found == mark) {
            return Ok(());
        }
        Err(self.unexpected(&lexeme, &format!("`{}`", mark.text())))
    }

    /// The keyword that comes next, if one does.
    pub(crate) fn peek_word(&mut self) -> Result<Option<Keyword>> {
        Ok(match self.peek()? {
            Item::Word(keyword) => Some(*keyword),
            _ => None,
        })
    }

    /// Takes `keyword` if it comes next.
    pub(crate) fn take_word(&mut self, keyword: Keyword) -> Result<bool> {
        let here = self.peek_word()? == Some(keyword);
        if here {
            self.next()?;
        }
        Ok(here)
    }

    /// Fails with the message `what` unless a number or vector comes next.
    pub(crate) fn need(&mut self, what: &str) -> Result<()> {
        if self.starts_number()? {
            return Ok(());
        }
        let lexeme = self.next()?;
        let mut fault = self.unexpected(&lexeme, "it");
        if let Some(found) = fault.text.strip_prefix("expected it") {
            fault.text = format!("{what}{found}");
        }
        Err(fault)
    }

    /// The line and column of a place, after the file's name if that differs from the file of
    /// `beside`.
    pub(crate) fn named_place(&self, place: Place, beside: Place) -> String {
        let Some(source) = self.sources.get(place.file as usize) else { return String::new() };
        let (line, column) = source.line_and_column(place.start as usize);
        if place.file == beside.file {
            format!("{line}:{column}")
        } else {
            format!("{}:{line}:{column}", source.path.display())
        }
    }

    /// The part of a message that names the block which is still open, if the token found belongs
    /// between blocks.
    fn unclosed(&self, lexeme: &Lexeme) -> String {
        use crate::lexer::Directive;
        let between = match &lexeme.item {
            Item::End => true,
            Item::Word(Keyword::Camera | Keyword::Background | Keyword::GlobalSettings) => true,
            Item::Word(keyword) => {
                crate::object::begins_object(*keyword)
                    || Directive::ALL.iter().any(|directive| directive.text() == keyword.text())
            }
            _ => false,
        };
        // A token that belongs inside blocks gives no hint: it occurs both before and after a
        // forgotten brace.
        let Some(&open) = self.opened.last().filter(|_| between) else { return String::new() };
        let Some(source) = self.sources.get(open.file as usize) else { return String::new() };
        let before = source.text.get(..open.start as usize).unwrap_or_default().trim_end();
        let start = before.rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_').map_or(0, |at| at + 1);
        let word = &before[start..];
        let begin = if word.is_empty() { open } else { Place { file: open.file, start: start as u32 } };
        let shown = if word.is_empty() { "{".to_owned() } else { format!("{word} {{") };
        format!(": `{shown}` opened at {} is not closed", self.named_place(begin, lexeme.place))
    }

    /// The error if the next token is not `mark`, which should close what `open` opened.
    pub(crate) fn expect_closing(&mut self, mark: Mark, open: Place) -> Result<()> {
        let lexeme = self.next()?;
        if matches!(lexeme.item, Item::Mark(found) if found == mark) {
            return Ok(());
        }
        let mut fault = self.unexpected(&lexeme, &format!("`{}`", mark.text()));
        let opening = if mark == Mark::ParenClose { "(" } else { "<" };
        if fault.kind == crate::ErrorKind::Invalid && !fault.text.contains("is not closed") {
            fault.text +=
                &format!(": the `{opening}` at {} is not closed", self.named_place(open, lexeme.place));
        }
        Err(fault)
    }

    /// The error of finding `lexeme` where `wanted` was expected.
    pub(crate) fn unexpected(&self, lexeme: &Lexeme, wanted: &str) -> Box<Error> {
        let found = match &lexeme.item {
            Item::Value(Value::Unsupported(what)) => {
                let place = what.place.unwrap_or(lexeme.place);
                let mut error = Error::at(place, crate::ErrorKind::Unsupported, what.text.clone());
                error.route.push(("a value used".to_owned(), lexeme.place));
                return error;
            }
            Item::Unknown(name) => {
                let text = crate::diagnostics::shortened(self.names.text(*name));
                if self.stands_after_hash(lexeme.place) {
                    let hint = self.similar_directive(*name);
                    let hint = hint.map_or_else(String::new, |s| format!(" (did you mean `#{s}`?)"));
                    return Error::invalid(lexeme.place, format!("there is no directive `#{text}`{hint}"));
                }
                let hint = if text.starts_with("f_") && !self.has_functions() {
                    r#" (such functions are declared by #include "functions.inc")"#.to_owned()
                } else {
                    self.hint(*name)
                };
                return Error::invalid(
                    lexeme.place,
                    format!("expected {wanted}, found the undeclared `{text}`{hint}"),
                );
            }
            Item::Number(_) => "a number".to_owned(),
            Item::Text(..) => "a string".to_owned(),
            Item::Word(keyword) if crate::unsupported::is_unsupported(*keyword) => {
                return Error::unsupported(lexeme.place, keyword.text());
            }
            Item::Word(keyword) => format!("`{}`", keyword.text()),
            Item::Mark(mark) => format!("`{}`", mark.text()),
            Item::Value(value) => value.kind().to_owned(),
            Item::End => "the end of the scene".to_owned(),
        };
        let unclosed = self.unclosed(lexeme);
        Error::invalid(lexeme.place, format!("expected {wanted}, found {found}{unclosed}"))
    }

    /// Whether the token at `place` follows a `#`.
    fn stands_after_hash(&self, place: Place) -> bool {
        let source = self.sources.get(place.file as usize);
        let before = source.and_then(|source| source.text.get(..place.start as usize));
        before.is_some_and(|text| text.trim_end().ends_with('#'))
    }

    /// Whether functions.inc has been read.
    fn has_functions(&self) -> bool {
        self.loaded.keys().any(|path| path.ends_with("functions.inc"))
    }

    /// A hint at what an undeclared name may stand for: a word in other case, a name of a standard
    /// file, a misspelling.
    fn hint(&self, name: Name) -> String {
        let text = self.names.text(name);
        let words = || Keyword::ALL.iter().map(|keyword| keyword.text());
        let declared = || self.scopes.bound().map(|n| self.names.text(n));
        let did = |s: &str| format!(" (did you mean `{s}`?)");
        if let Some(file) = self.library.file_that_declares(text) {
            return format!(" (#include \"{file}\" declares it)");
        }
        if let Some(word) = words().chain(declared()).find(|w| w.eq_ignore_ascii_case(text)) {
            return did(word);
        }
        // Words of the language have no capitals, so a name with capitals was meant as a name.
        let is_name = text.contains(|c: char| c.is_ascii_uppercase());
        let misspelt = nearest(text, declared().chain(words().filter(|_| !is_name)));
        misspelt.map_or_else(String::new, did)
    }

    /// A directive of which `name` may be a misspelling.
    fn similar_directive(&self, name: Name) -> Option<&str> {
        nearest(self.names.text(name), Directive::ALL.iter().map(|directive| directive.text()))
    }

    /// Skips the rest of the blocks that were opened after `braces` were open.
    pub(crate) fn skip_to_brace_level(&mut self, braces: u64) -> Result<()> {
        while self.braces > braces {
            if let Lexeme { item: Item::End, place } = self.next()? {
                return Err(Error::invalid(place, "the scene ends inside a block: a `}` is missing"));
            }
        }
        Ok(())
    }

    /// A string as a value.
    pub(crate) fn text_value(&self, text: String, place: Place) -> Result<Value> {
        self.check_memory(text.len(), place)?;
        Ok(Value::Text(Text::new(text)))
    }
}

/// The error of a directive at `place` that ends in another macro or file.
pub(crate) fn strayed(place: Place) -> Box<Error> {
    Error::invalid(place, "this directive does not end where it began")
}

/// The word among `words` of which `wrong` may be a misspelling.
pub(crate) fn nearest<'a>(wrong: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = wrong.len() / 3;
    let near = words.map(|word| (distance(wrong, word), word));
    near.filter(|(d, _)| (1..=allowed).contains(d)).min().map(|(_, word)| word)
}

/// The edit distance of two short words: the letters to change, insert, delete or exchange with the
/// next (V. Levenshtein, *Soviet Physics Doklady* 10, 1966; F. Damerau, *Communications of the ACM*
/// 7, 1964).
fn distance(a: &str, b: &str) -> usize {
    const FAR: usize = usize::MAX;
    if a.len().abs_diff(b.len()) > 2 || a.len() > 40 {
        return FAR;
    }
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    // The row before the last one.
    let mut before = row.clone();
    for (i, x) in a.iter().enumerate() {
        let previous = row.clone();
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let change = diagonal + usize::from(!x.eq_ignore_ascii_case(y));
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
            if i > 0 && j > 0 && x.eq_ignore_ascii_case(&b[j - 1]) && y.eq_ignore_ascii_case(&a[i - 1]) {
                row[j + 1] = row[j + 1].min(before[j - 1] + 1);
            }
        }
        before = previous;
    }
    row[b.len()]
}

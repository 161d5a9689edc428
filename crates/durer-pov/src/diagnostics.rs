//! Errors: one message each, as `file:line:column: text`, with the line and a mark under the words
//! meant.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::source::Source;

/// The result type of the reader. Errors are boxed, because success is the common case.
pub(crate) type Result<T> = std::result::Result<T, Box<Error>>;

/// The place where a token begins: a file (an index into the reader's sources) and a byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) file: u32,
    pub(crate) start: u32,
}

/// The kinds of errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The text breaks the language's rules, or a value is not allowed in its place.
    Invalid,
    /// The text is valid in POV-Ray's language, but durer does not support it yet.
    Unsupported,
    /// One of the [`Limits`](crate::Limits) was reached.
    Limit,
    /// A file cannot be read.
    File,
    /// The scene itself stopped with `#error`.
    Raised,
}

/// An error while it is passed up: place and text. The file's name and lines are looked up at the
/// end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Error {
    pub(crate) place: Option<Place>,
    pub(crate) kind: ErrorKind,
    pub(crate) text: String,
    /// The macro calls, includes and objects that led here, innermost first.
    pub(crate) route: Vec<(String, Place)>,
}

impl Error {
    pub(crate) fn at(place: Place, kind: ErrorKind, text: impl Into<String>) -> Box<Self> {
        Box::new(Self { place: Some(place), kind, text: text.into(), route: Vec::new() })
    }

    pub(crate) fn invalid(place: Place, text: impl Into<String>) -> Box<Self> {
        Self::at(place, ErrorKind::Invalid, text)
    }

    pub(crate) fn unsupported(place: Place, keyword: &str) -> Box<Self> {
        Self::at(place, ErrorKind::Unsupported, format!("not supported yet: {keyword}"))
    }

    /// The error as one in the texture of an object: adds the object's own place, if that is in
    /// another file.
    pub(crate) fn of_object(mut self: Box<Self>, at: Place) -> Box<Self> {
        if self.place.is_some_and(|place| place.file != at.file) {
            self.route.push(("the texture of the object".to_owned(), at));
        }
        self
    }

    pub(crate) fn file(place: Option<Place>, text: impl Into<String>) -> Box<Self> {
        Box::new(Self { place, kind: ErrorKind::File, text: text.into(), route: Vec::new() })
    }
}

/// Why a scene could not be read, and where the reader stopped.
///
/// Its `Display` form is the whole message: place, text, the line with the words underlined, and
/// the calls and includes that led there.
#[derive(Clone, Debug, PartialEq)]
pub struct PovError {
    /// The file of the error.
    pub path: PathBuf,
    /// Line and column, both counted from 1 (columns in characters); `None` if the error concerns
    /// the whole file.
    pub at: Option<(usize, usize)>,
    /// The kind of the error.
    pub kind: ErrorKind,
    /// The message without its place.
    pub text: String,
    excerpt: String,
}

impl std::error::Error for PovError {}

impl fmt::Display for PovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some((line, column)) = self.at {
            write!(f, "{line}:{column}:")?;
        }
        write!(f, " {}", self.text)?;
        if !self.excerpt.is_empty() {
            write!(f, "\n{}", self.excerpt)?;
        }
        Ok(())
    }
}

/// A word for a message, shortened if it is longer than any plausible name.
pub(crate) fn shortened(word: &str) -> std::borrow::Cow<'_, str> {
    /// The number of letters shown.
    const MOST: usize = 60;
    match word.char_indices().nth(MOST) {
        None => word.into(),
        Some((end, _)) => format!("{}...", &word[..end]).into(),
    }
}

/// Routes longer than this are cut in the middle: a runaway recursion has a thousand equal steps.
const ROUTE_SHOWN: usize = 4;

impl PovError {
    pub(crate) fn new(fault: &Error, main: &Path, sources: &[impl AsRef<Source>]) -> Self {
        let source = |place: Place| sources.get(place.file as usize).map(AsRef::as_ref);
        let Some((place, home)) = fault.place.and_then(|p| Some((p, source(p)?))) else {
            return Self {
                path: main.to_path_buf(),
                at: None,
                kind: fault.kind,
                text: fault.text.clone(),
                excerpt: String::new(),
            };
        };
        let mut excerpt = Excerpt::new(&home.text, place.start as usize).to_string();
        for (i, (what, place)) in fault.route.iter().enumerate() {
            if i == ROUTE_SHOWN && fault.route.len() > 2 * ROUTE_SHOWN {
                let hidden = fault.route.len() - 2 * ROUTE_SHOWN;
                excerpt.push_str(&format!("\n   = ... {hidden} more"));
            }
            if i >= ROUTE_SHOWN && i + ROUTE_SHOWN < fault.route.len() {
                continue;
            }
            if let Some(from) = source(*place) {
                let (line, column) = from.line_and_column(place.start as usize);
                let path = from.path.display();
                excerpt.push_str(&format!("\n   = in {what} at {path}:{line}:{column}"));
            }
        }
        Self {
            path: home.path.clone(),
            at: Some(home.line_and_column(place.start as usize)),
            kind: fault.kind,
            text: fault.text.clone(),
            excerpt,
        }
    }
}

/// The line of an error with a mark under it, cut to the width of a terminal.
struct Excerpt {
    number: usize,
    before: String,
    marked: String,
    after: String,
}

/// The number of characters shown on either side of the marked words.
const CONTEXT: usize = 60;

impl Excerpt {
    fn new(text: &str, start: usize) -> Self {
        let start = start.min(text.len());
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let end = start + lexeme_length(&text[start..line_end]);
        let plain = |c: char| if c.is_control() { ' ' } else { c };
        let before: Vec<char> = text[line_start..start].chars().map(plain).collect();
        let after: Vec<char> = text[end..line_end].chars().map(plain).take(CONTEXT + 1).collect();
        let marked: String = text[start..end].chars().map(plain).take(CONTEXT).collect();
        let lead = if before.len() > CONTEXT { "..." } else { "" };
        let tail = if after.len() > CONTEXT { "..." } else { "" };
        let before: String = before[before.len().saturating_sub(CONTEXT)..].iter().collect();
        let after: String = after[..after.len().min(CONTEXT)].iter().collect();
        Self {
            number: 1 + text[..start].matches('\n').count(),
            before: format!("{lead}{before}"),
            marked,
            after: format!("{after}{tail}"),
        }
    }
}

impl fmt::Display for Excerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.number.to_string();
        let margin = " ".repeat(number.len());
        let line = format!("{}{}{}", self.before, self.marked, self.after);
        let indent = " ".repeat(self.before.chars().count());
        let mark = "^".repeat(self.marked.chars().count().max(1));
        write!(f, "{margin} |\n{number} | {}\n{margin} | {indent}{mark}", line.trim_end())
    }
}

/// The number of bytes of the token at the start of `text` (one line), for the mark under it.
pub(crate) fn lexeme_length(text: &str) -> usize {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut chars = text.char_indices();
    let Some((_, first)) = chars.next() else { return 0 };
    let run =
        |from: usize, of: fn(char) -> bool| text[from..].find(|c| !of(c)).map_or(text.len(), |i| from + i);
    match first {
        '"' => text[1..].find('"').map_or(text.len(), |i| i + 2),
        '#' => {
            let spaces = run(1, char::is_whitespace);
            run(spaces, |c| c.is_ascii_alphanumeric() || c == '_')
        }
        '<' | '>' | '!' if text[1..].starts_with('=') => 2,
        '/' if text[1..].starts_with('*') => 2,
        c if c.is_ascii_digit() || c == '.' => run(1, |c| c.is_ascii_digit() || c == '.').max(1),
        c if word(c) => run(0, |c| c.is_ascii_alphanumeric() || c == '_'),
        c => c.len_utf8(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_stands_under_the_word() {
        let text = "camera { }\n\tsphere { torus }\n";
        let shown = Excerpt::new(text, text.find("torus").unwrap()).to_string();
        assert_eq!(shown, "  |\n2 |  sphere { torus }\n  |           ^^^^^");
    }

    #[test]
    fn an_endless_line_is_cut() {
        let text = "x".repeat(10_000) + " torus " + &"y".repeat(10_000);
        let shown = Excerpt::new(&text, 10_001).to_string();
        assert!(shown.len() < 400, "{shown}");
        assert!(shown.contains("torus") && shown.contains("^^^^^"));
    }
}

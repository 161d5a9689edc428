//! The lexer: from text to tokens. It skips comments, looks up each word once, and converts
//! numbers.

use crate::diagnostics::{Error, Place, Result};
use crate::interner::{Interner, Name};
use crate::keywords::Keyword;
use crate::limits::{self, Limits};
use crate::source::Source;

/// A token and the byte where it begins. It takes only twelve bytes, because a mesh has millions of
/// tokens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Token {
    pub(crate) start: u32,
    pub(crate) kind: Kind,
}

/// The kind of a token. Long contents are indices into tables of the [`Source`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Number(u32),
    Text(u32),
    Word(Keyword),
    Name(Name),
    Mark(Mark),
    /// A directive, and its entry in the table of blocks, or [`NO_BLOCK`].
    Directive(Directive, u32),
}

macro_rules! spelled {
    ($(#[$doc:meta])* $name:ident { $($variant:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum $name { $($variant,)* }

        impl $name {
            /// All variants.
            #[allow(dead_code, reason = "not every such table is listed")]
            pub(crate) const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The spelling.
            pub(crate) fn text(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }

            #[allow(dead_code, reason = "not every such table is searched by spelling")]
            fn from_text(text: &str) -> Option<Self> {
                match text { $($text => Some(Self::$variant),)* _ => None }
            }
        }
    };
}

spelled! {
    /// Punctuation and operators.
    Mark {
        ParenOpen = "(", ParenClose = ")", SquareOpen = "[", SquareClose = "]",
        BraceOpen = "{", BraceClose = "}", Less = "<", Greater = ">",
        LessEqual = "<=", GreaterEqual = ">=", NotEqual = "!=", Equal = "=",
        Plus = "+", Minus = "-", Star = "*", Slash = "/", Not = "!", And = "&", Or = "|",
        Question = "?", Colon = ":", Semicolon = ";", Comma = ",", Dot = ".",
    }
}

spelled! {
    /// The words after a `#`.
    Directive {
        Declare = "declare", Local = "local", Undef = "undef", Include = "include", Default = "default",
        Version = "version", If = "if", Ifdef = "ifdef", Ifndef = "ifndef", Else = "else",
        Elseif = "elseif", Switch = "switch", Case = "case", Range = "range", Break = "break",
        While = "while", For = "for", Macro = "macro", End = "end", Debug = "debug",
        Warning = "warning", Error = "error", Statistics = "statistics", Render = "render",
        Fopen = "fopen", Fclose = "fclose", Read = "read", Write = "write",
    }
}

/// The entry of a directive that belongs to no block.
pub(crate) const NO_BLOCK: u32 = u32::MAX;

/// Fills in the tokens of `source`, which gets the file number `file`.
pub(crate) fn lex(source: &mut Source, file: u32, names: &mut Interner, limits: &Limits) -> Result<()> {
    let text = std::mem::take(&mut source.text);
    let result = Lexer { text: &text, bytes: text.as_bytes(), at: 0, file, names }.run(source, limits);
    source.text = text;
    result
}

struct Lexer<'a> {
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
    file: u32,
    names: &'a mut Interner,
}

/// Old DOS editors end a text with this byte.
const END_OF_TEXT: u8 = 0x1a;

impl<'a> Lexer<'a> {
    fn place(&self, at: usize) -> Place {
        Place { file: self.file, start: at as u32 }
    }

    fn peek(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    fn run(mut self, source: &mut Source, limits: &Limits) -> Result<()> {
        let shown = |b: &u8| b"\t\n\r\x0b\x0c".contains(b) || *b >= 0x20;
        let text_end = self.bytes.iter().position(|&b| b == END_OF_TEXT).unwrap_or(self.bytes.len());
        if let Some(at) = self.bytes[..text_end].iter().position(|b| !shown(b) || *b == 0x7f) {
            let byte = self.bytes[at];
            return Err(Error::invalid(
                self.place(at),
                format!("control character 0x{byte:02x}: this does not look like a scene file"),
            ));
        }
        self.bytes = &self.bytes[..text_end];
        self.text = &self.text[..text_end];
        while self.skip_blanks()? {
            let start = self.at;
            let Some(kind) = self.token(source)? else { continue };
            source.tokens.push(Token { start: start as u32, kind });
            if source.tokens.len().is_multiple_of(1 << 16) {
                limits::check_memory(self.place(start), limits, source.tokens.capacity() * 24)?;
            }
        }
        Ok(())
    }

    /// Skips blanks and comments. Returns `false` at the end of the text.
    fn skip_blanks(&mut self) -> Result<bool> {
        while self.at < self.bytes.len() {
            match (self.peek(0), self.peek(1)) {
                (b, _) if b.is_ascii_whitespace() || b == 0x0b => self.at += 1,
                (b'/', b'/') => {
                    let rest = &self.bytes[self.at..];
                    self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
                }
                (b'/', b'*') => self.skip_comment()?,
                _ => return Ok(true),
            }
        }
        Ok(false)
    }

    /// Skips a `/* */` comment, which may contain others.
    fn skip_comment(&mut self) -> Result<()> {
        let (start, mut depth) = (self.at, 0_usize);
        while self.at < self.bytes.len() {
            match (self.peek(0), self.peek(1)) {
                (b'/', b'*') => (depth, self.at) = (depth + 1, self.at + 2),
                (b'*', b'/') => (depth, self.at) = (depth - 1, self.at + 2),
                _ => self.at += 1,
            }
            if depth == 0 {
                return Ok(());
            }
        }
        Err(Error::invalid(self.place(start), "this comment is never closed"))
    }

    /// Reads the next token; `None` for a `#` without a meaning.
    fn token(&mut self, source: &mut Source) -> Result<Option<Kind>> {
        Ok(Some(match self.peek(0) {
            b'"' => self.string(source)?,
            b'#' => return self.directive(),
            b if b.is_ascii_alphabetic() || b == b'_' => {
                let word = self.word();
                let name = self.names.name(word);
                Keyword::from_name(name).map_or(Kind::Name(name), Kind::Word)
            }
            _ if self.at_number() => self.number(source)?,
            _ => self.mark()?,
        }))
    }

    fn at_number(&self) -> bool {
        let digit_at = |ahead| self.peek(ahead).is_ascii_digit();
        digit_at(0) || self.peek(0) == b'.' && digit_at(1)
    }

    fn word(&mut self) -> &'a str {
        let start = self.at;
        while self.peek(0).is_ascii_alphanumeric() || self.peek(0) == b'_' {
            self.at += 1;
        }
        &self.text[start..self.at]
    }

    fn digits(&mut self) {
        while self.peek(0).is_ascii_digit() {
            self.at += 1;
        }
    }

    fn number(&mut self, source: &mut Source) -> Result<Kind> {
        let start = self.at;
        self.digits();
        if self.peek(0) == b'.' {
            self.at += 1;
            self.digits();
        }
        if matches!(self.peek(0), b'e' | b'E') {
            let sign = usize::from(matches!(self.peek(1), b'+' | b'-'));
            if self.peek(1 + sign).is_ascii_digit() {
                self.at += 1 + sign;
                self.digits();
            }
        }
        match self.text[start..self.at].parse::<f64>() {
            Ok(value) if value.is_finite() => {
                source.numbers.push(value);
                Ok(Kind::Number((source.numbers.len() - 1) as u32))
            }
            _ => Err(Error::invalid(self.place(start), "this number is too large")),
        }
    }

    fn string(&mut self, source: &mut Source) -> Result<Kind> {
        let start = self.at;
        self.at += 1;
        while self.at < self.bytes.len() {
            match self.peek(0) {
                b'"' => {
                    let raw = &self.text[start + 1..self.at];
                    self.at += 1;
                    source.strings.push(raw.into());
                    return Ok(Kind::Text((source.strings.len() - 1) as u32));
                }
                b'\\' if self.at + 1 < self.bytes.len() && self.peek(1).is_ascii() => self.at += 2,
                _ => self.at += 1,
            }
        }
        Err(Error::invalid(self.place(start), "this string is never closed"))
    }

    /// Reads a `#` and the directive's word. A `#` without a directive has no meaning unless a
    /// number follows (a fact of the language): `None`.
    fn directive(&mut self) -> Result<Option<Kind>> {
        let start = self.at;
        self.at += 1;
        self.skip_blanks()?;
        if self.at_number() {
            return Err(Error::invalid(self.place(start), "`#` needs a directive after it"));
        }
        let behind = self.at;
        let directive = Directive::from_text(self.word());
        if directive.is_none() {
            self.at = behind;
        }
        Ok(directive.map(|directive| Kind::Directive(directive, NO_BLOCK)))
    }

    fn mark(&mut self) -> Result<Kind> {
        let start = self.at;
        for length in [2, 1] {
            if let Some(mark) = self.text.get(start..start + length).and_then(Mark::from_text) {
                self.at += length;
                return Ok(Kind::Mark(mark));
            }
        }
        // `at` is at the first byte of a character, since all tokens before consist of whole
        // characters.
        let found = self.text[start..].chars().next().unwrap_or(' ');
        let hint = if found == '^' { "; powers are written pow(a, b)" } else { "" };
        Err(Error::invalid(self.place(start), format!("unexpected character '{found}'{hint}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn kinds(text: &str) -> std::result::Result<Vec<Kind>, String> {
        let mut source = Source::new(PathBuf::new(), text.into());
        let mut names = Interner::new();
        lex(&mut source, 0, &mut names, &Limits::default()).map_err(|fault| fault.text)?;
        Ok(source.tokens.iter().map(|token| token.kind).collect())
    }

    #[test]
    fn numbers_have_all_their_forms() {
        let mut source = Source::new(PathBuf::new(), ".5 5. 1e-3 1.5E+2 007 3.x".into());
        lex(&mut source, 0, &mut Interner::new(), &Limits::default()).unwrap();
        assert_eq!(source.numbers, [0.5, 5.0, 1e-3, 150.0, 7.0, 3.0]);
        assert_eq!(source.tokens.len(), 7);
    }

    #[test]
    fn comments_nest() {
        assert_eq!(kinds("/* a /* b */ sphere */ ; // c").unwrap(), [Kind::Mark(Mark::Semicolon)]);
        assert_eq!(kinds("/* a /* b */"), Err("this comment is never closed".into()));
    }

    #[test]
    fn a_directive_may_stand_off_its_hash() {
        let declare = [Kind::Directive(Directive::Declare, NO_BLOCK)];
        for text in ["#  declare", "#\n declare", "# /* a */ // b\n declare", "##declare", "#declare #"] {
            assert_eq!(kinds(text).unwrap(), declare, "{text}");
        }
    }

    #[test]
    fn a_hash_before_anything_but_a_number_is_skipped() {
        let marks = [Mark::BraceClose, Mark::ParenOpen].map(Kind::Mark);
        assert_eq!(kinds("#} #(").unwrap(), marks);
        assert_eq!(kinds("#sphere").unwrap(), [Kind::Word(Keyword::Sphere)]);
        for text in ["#3", "# .5"] {
            assert_eq!(kinds(text), Err("`#` needs a directive after it".into()));
        }
    }

    #[test]
    fn noise_is_refused() {
        assert!(kinds("camera \u{0}").unwrap_err().contains("0x00"));
        assert_eq!(kinds("camera é"), Err("unexpected character 'é'".into()));
        assert_eq!(kinds("\"abc"), Err("this string is never closed".into()));
        assert_eq!(kinds("1e999"), Err("this number is too large".into()));
        assert_eq!(kinds("\"\\é\"").unwrap(), [Kind::Text(0)]);
    }

    #[test]
    fn two_letter_marks_win() {
        let marks = kinds("<=>=!=<!").unwrap();
        let expected = [Mark::LessEqual, Mark::GreaterEqual, Mark::NotEqual, Mark::Less, Mark::Not];
        assert_eq!(marks, expected.map(Kind::Mark));
    }
}

//! Lines and words of text formats, and numbers in them.

use crate::error::{ErrorKind, Location};
use std::borrow::Cow;

/// The bytes after a UTF-8 byte-order mark, which some programs write at the start of text files.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The lines of a file, numbered from 1. Invalid UTF-8 is replaced.
pub(crate) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let lines = bytes.split(|&b| b == b'\n').enumerate();
    lines.map(|(i, line)| (i + 1, String::from_utf8_lossy(line.strip_suffix(b"\r").unwrap_or(line))))
}

/// Shortens the message of a library, which may quote much of a file, to one line.
pub(crate) fn one_line(text: &str) -> String {
    let words: Vec<_> = text.split_whitespace().take(40).map(shortened).collect();
    cut(&words.join(" "), 240)
}

/// Shortens a word for a message.
pub(crate) fn shortened(word: &str) -> String {
    cut(word, 40)
}

fn cut(word: &str, most: usize) -> String {
    let clean = |c: char| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c };
    let mut short: String = word.chars().take(most).map(clean).collect();
    if word.chars().nth(most).is_some() {
        short.push('…');
    }
    short
}

/// Reads the next word as a number.
pub(crate) fn number<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    line: usize,
    expected: &'static str,
) -> Result<f64, ErrorKind> {
    let spot = Location::Line(line);
    let word = words.next().ok_or(ErrorKind::End { spot, expected })?;
    word.parse().map_err(|_| ErrorKind::Expected { spot, expected, found: shortened(word) })
}

/// Reads the next three words as numbers.
pub(crate) fn three<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    line: usize,
    expected: &'static str,
) -> Result<[f64; 3], ErrorKind> {
    let mut next = || number(words, line, expected);
    Ok([next()?, next()?, next()?])
}

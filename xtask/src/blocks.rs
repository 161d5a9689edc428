//! Blocks of POV-Ray's language, as far as they can be told without understanding it.

use std::ops::Range;

/// A block that can be replaced, and by what.
#[derive(Debug, PartialEq)]
pub(crate) struct Block {
    /// From its keyword to its closing brace.
    pub(crate) range: Range<usize>,
    pub(crate) plain: &'static str,
}

/// What stands for a block of this kind.
fn plain(keyword: &str) -> Option<&'static str> {
    const GREY: &str = "pigment { color rgb <0.6, 0.55, 0.5> }";
    const TEXTURE: &str = "texture { pigment { color rgb <0.6, 0.55, 0.5> } }";
    match keyword {
        "pigment" => Some(GREY),
        "texture" | "material" => Some(TEXTURE),
        "normal" | "sky_sphere" | "fog" | "interior" => Some(""),
        _ => None,
    }
}

/// The innermost block of a kind that can be replaced around a line and column, both counted from one.
pub(crate) fn around(text: &str, line: usize, column: usize) -> Option<Block> {
    let start: usize = text.split_inclusive('\n').take(line.checked_sub(1)?).map(str::len).sum();
    let place = start + text[start..].chars().take(column.checked_sub(1)?).map(char::len_utf8).sum::<usize>();
    // Blocks that are open: where their keyword starts, and what may stand for them.
    let mut open: Vec<(usize, Option<&'static str>)> = Vec::new();
    let mut innermost = None;
    let mut last_word = None;
    for token in tokens(text) {
        match &text[token.clone()] {
            "{" => {
                let word: Option<Range<usize>> = last_word.take();
                let kind = word.as_ref().and_then(|w| plain(&text[w.clone()]));
                open.push((word.map_or(token.start, |w| w.start), kind));
            }
            "}" => {
                let Some((start, kind)) = open.pop() else { continue };
                let range = start..token.end;
                if let Some(plain) = kind
                    && range.contains(&place)
                    && innermost.is_none()
                {
                    innermost = Some(Block { range, plain });
                }
            }
            _ => last_word = Some(token),
        }
    }
    innermost
}

/// Words and braces, outside of comments and strings.
fn tokens(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let bytes = text.as_bytes();
    let mut at = 0;
    std::iter::from_fn(move || {
        while at < bytes.len() {
            let rest = &text[at..];
            let skipped = if rest.starts_with("//") {
                rest.find('\n').unwrap_or(rest.len())
            } else if rest.starts_with("/*") {
                rest.find("*/").map_or(rest.len(), |end| end + 2)
            } else if let Some(within) = rest.strip_prefix('"') {
                within.find('"').map_or(rest.len(), |end| end + 2)
            } else {
                let first = rest.chars().next().map_or(1, char::len_utf8);
                let is_word = |c: char| c.is_alphanumeric() || c == '_';
                let word = rest.find(|c: char| !is_word(c)).unwrap_or(rest.len());
                if word > 0 || bytes[at] == b'{' || bytes[at] == b'}' {
                    let token = at..at + word.max(1);
                    at = token.end;
                    return Some(token);
                }
                first
            };
            at += skipped;
        }
        None
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_block_is_found_whatever_comments_say() {
        let text =
            "sphere { 0, 1 // texture {\n  texture { pigment { granite \"}\" } finish { phong 1 } }\n}";
        let block = around(text, 2, 23).unwrap();
        assert_eq!(&text[block.range], "pigment { granite \"}\" }");
        let block = around(text, 2, 38).unwrap();
        assert_eq!(&text[block.range], "texture { pigment { granite \"}\" } finish { phong 1 } }");
        assert_eq!(around(text, 1, 3), None);
    }
}

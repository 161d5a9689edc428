//! Blocks of POV-Ray's language, as far as they can be found without parsing it.

use std::ops::Range;

/// A block that can be replaced, and its replacement.
#[derive(Debug, PartialEq)]
pub(crate) struct Block {
    /// From its keyword to its closing brace.
    pub(crate) range: Range<usize>,
    pub(crate) plain: &'static str,
}

/// The replacement for a block of this kind.
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

/// The byte at a line and column, both counted from 1.
fn place(text: &str, line: usize, column: usize) -> Option<usize> {
    let start: usize = text.split_inclusive('\n').take(line.checked_sub(1)?).map(str::len).sum();
    Some(start + text[start..].chars().take(column.checked_sub(1)?).map(char::len_utf8).sum::<usize>())
}

/// The block whose keyword is at a line and column.
pub(crate) fn beginning_at(text: &str, line: usize, column: usize) -> Option<Range<usize>> {
    let place = place(text, line, column)?;
    let mut depth = 0_u32;
    for token in tokens(text).skip_while(|token| token.start < place) {
        match &text[token.clone()] {
            "{" => depth += 1,
            "}" if depth == 1 => return Some(place..token.end),
            "}" => depth = depth.checked_sub(1)?,
            _ => {}
        }
    }
    None
}

/// The innermost replaceable block around a line and column, both counted from 1.
pub(crate) fn around(text: &str, line: usize, column: usize) -> Option<Block> {
    let place = place(text, line, column)?;
    replaceable(text).find(|block| block.range.contains(&place))
}

/// The first replaceable block to end within the block whose keyword is at a line and column; if
/// another one encloses it, the outermost.
pub(crate) fn first_in(text: &str, line: usize, column: usize) -> Option<Block> {
    let whole = beginning_at(text, line, column)?;
    let is_in = |block: &Block| whole.start < block.range.start && block.range.end < whole.end;
    let first = replaceable(text).find(is_in)?;
    replaceable(text)
        .filter(|b| is_in(b) && b.range.start <= first.range.start && first.range.end <= b.range.end)
        .last()
}

/// The replaceable blocks, in the order of their closing braces.
fn replaceable(text: &str) -> impl Iterator<Item = Block> + '_ {
    // The open blocks: the start of each keyword, and the replacement.
    let mut open: Vec<(usize, Option<&'static str>)> = Vec::new();
    let mut last_word: Option<Range<usize>> = None;
    tokens(text).filter_map(move |token| match &text[token.clone()] {
        "{" => {
            let word = last_word.take();
            let kind = word.as_ref().and_then(|w| plain(&text[w.clone()]));
            open.push((word.map_or(token.start, |w| w.start), kind));
            None
        }
        "}" => {
            let (start, kind) = open.pop()?;
            Some(Block { range: start..token.end, plain: kind? })
        }
        _ => {
            last_word = Some(token);
            None
        }
    })
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

    #[test]
    fn an_objects_texture_is_found() {
        let text = "box { 0, 1 texture { pigment { rgb 1 } } }\nsphere { 0, 1 texture { T } }";
        assert_eq!(&text[first_in(text, 1, 1).unwrap().range], "texture { pigment { rgb 1 } }");
        assert_eq!(&text[first_in(text, 2, 1).unwrap().range], "texture { T }");
        assert_eq!(first_in("sphere { 0, 1 }", 1, 1), None);
    }

    #[test]
    fn a_block_ends_where_its_own_brace_does() {
        let text = "box { 0, 1 }\nheight_field {\n  png \"}\" texture { T } } plane { y, 0 }";
        assert_eq!(&text[beginning_at(text, 2, 1).unwrap()], "height_field {\n  png \"}\" texture { T } }");
        assert_eq!(beginning_at(text, 3, 21), None);
        assert_eq!(beginning_at("box { 0", 1, 1), None);
    }
}

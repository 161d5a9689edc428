//! The targets of directives, found once for each file, so that the reader jumps without searching.

use crate::diagnostics::{Error, Place, Result};
use crate::lexer::{Directive, Kind};
use crate::source::Source;

/// The jumps of a directive, as indices of tokens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Block {
    /// The next branch of the same block (`#else`, `#case` ...) or its `#end`; for an `#end`, its
    /// opener.
    pub(crate) next: u32,
    /// The block's `#end`.
    pub(crate) end: u32,
    /// The number of open blocks that a `#break` leaves.
    pub(crate) leaves: u32,
}

/// A block that is still open during the pass over the file.
struct Open {
    opener: Directive,
    /// The tokens of the opener and of the branches so far.
    branches: Vec<usize>,
    /// The `#break`s that leave this block, and the number of blocks that each leaves.
    breaks: Vec<(usize, u32)>,
    /// Whether an `#else` was seen: no other branch may follow it.
    closed: bool,
}

/// Finds the [`Block`] of every directive of `source` (file number `file`) that opens, divides or
/// closes a block.
pub(crate) fn match_blocks(source: &mut Source, file: u32) -> Result<()> {
    use Directive::{Break, Case, Else, Elseif, End, For, If, Ifdef, Ifndef, Macro, Range, Switch, While};
    let mut open: Vec<Open> = Vec::new();
    let mut blocks = Vec::new();
    for i in 0..source.tokens.len() {
        let Kind::Directive(directive, _) = source.tokens[i].kind else { continue };
        let place = Place { file, start: source.tokens[i].start };
        let stray =
            || Error::invalid(place, format!("#{} stands in no block it belongs to", directive.text()));
        match directive {
            If | Ifdef | Ifndef | Switch | While | For | Macro => {
                open.push(Open { opener: directive, branches: vec![i], breaks: Vec::new(), closed: false });
            }
            Else | Elseif | Case | Range => {
                let block = open.last_mut().ok_or_else(stray)?;
                let fits = match directive {
                    Elseif => matches!(block.opener, If | Ifdef | Ifndef),
                    Case | Range => block.opener == Switch,
                    _ => matches!(block.opener, If | Ifdef | Ifndef | Switch),
                };
                if !fits || block.closed {
                    return Err(stray());
                }
                block.closed = directive == Else;
                block.branches.push(i);
            }
            Break => {
                // A macro may be called from a loop, but a jump out of the macro would need to know
                // which loop.
                let around = open.iter_mut().rev().zip(1_u32..);
                let mut around =
                    around.skip_while(|(b, _)| !matches!(b.opener, Switch | While | For | Macro));
                let (block, leaves) = around.next().filter(|(b, _)| b.opener != Macro).ok_or_else(stray)?;
                block.breaks.push((i, leaves));
            }
            End => {
                let block = open.pop().ok_or_else(stray)?;
                let mut link = |at: usize, next: usize, leaves: u32| {
                    if let Kind::Directive(_, index) = &mut source.tokens[at].kind {
                        *index = blocks.len() as u32;
                        blocks.push(Block { next: next as u32, end: i as u32, leaves });
                    }
                };
                for (n, &branch) in block.branches.iter().enumerate() {
                    link(branch, block.branches.get(n + 1).copied().unwrap_or(i), 0);
                }
                for (at, leaves) in block.breaks {
                    link(at, i, leaves);
                }
                link(i, block.branches[0], 0);
            }
            _ => {}
        }
    }
    source.blocks = blocks;
    if let Some(block) = open.last() {
        let at = Place { file, start: source.tokens[block.branches[0]].start };
        return Err(Error::invalid(at, format!("this #{} has no #end", block.opener.text())));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interner::Interner;
    use crate::limits::Limits;
    use std::path::PathBuf;

    fn matched(text: &str) -> std::result::Result<Source, String> {
        let mut source = Source::new(PathBuf::new(), text.into());
        crate::lexer::lex(&mut source, 0, &mut Interner::new(), &Limits::default()).map_err(|f| f.text)?;
        match_blocks(&mut source, 0).map_err(|f| f.text)?;
        Ok(source)
    }

    #[test]
    fn branches_lead_to_the_next_and_to_the_end() {
        let source = matched("#if (1) #elseif (2) #else #end").unwrap();
        let block = |i: usize| match source.tokens[i].kind {
            Kind::Directive(_, b) => source.blocks[b as usize],
            _ => panic!("no directive"),
        };
        assert_eq!(block(0), Block { next: 4, end: 9, leaves: 0 });
        assert_eq!(block(4), Block { next: 8, end: 9, leaves: 0 });
        assert_eq!(block(8), Block { next: 9, end: 9, leaves: 0 });
        assert_eq!(block(9), Block { next: 0, end: 9, leaves: 0 });
    }

    #[test]
    fn strays_and_open_ends_are_named() {
        assert_eq!(matched("#end").unwrap_err(), "#end stands in no block it belongs to");
        assert_eq!(matched("#while (1)").unwrap_err(), "this #while has no #end");
        assert!(matched("#if (1) #else #else #end").is_err());
        assert!(matched("#macro A() #break #end").is_err());
        assert!(matched("#case (1)").is_err());
    }
}

//! The interner: words as small numbers, so that the reader compares and looks up without comparing
//! letters.

use std::collections::HashMap;

use crate::keywords::Keyword;

/// A word of the scene. Reserved words come first, in the order of [`Keyword`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Name(pub(crate) u32);

/// All words seen so far.
#[derive(Debug)]
pub(crate) struct Interner {
    known: HashMap<Box<str>, Name>,
    texts: Vec<Box<str>>,
}

impl Interner {
    /// Starts with the reserved words.
    pub(crate) fn new() -> Self {
        let mut names = Self { known: HashMap::new(), texts: Vec::new() };
        for keyword in Keyword::ALL {
            names.name(keyword.text());
        }
        // Two spellings of one word share a number.
        for (spelling, keyword) in Keyword::OTHER_SPELLINGS {
            names.known.insert((*spelling).into(), Name(*keyword as u32));
        }
        names
    }

    /// The number of `text`. A new word gets a new number.
    pub(crate) fn name(&mut self, text: &str) -> Name {
        if let Some(&name) = self.known.get(text) {
            return name;
        }
        let name = Name(self.texts.len() as u32);
        self.texts.push(text.into());
        self.known.insert(text.into(), name);
        name
    }

    /// The word itself.
    pub(crate) fn text(&self, name: Name) -> &str {
        &self.texts[name.0 as usize]
    }
}

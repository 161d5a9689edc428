//! What a scene says while it is read: `#debug`, `#warning`, and the reader's own warnings.
//!
//! A loop can say the same millions of times. A `#warning` that repeats itself is said once, and at the end how often; of one that
//! changes, the first thousand texts are told. `#debug` is what a scene prints on purpose, and is never cut.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use crate::diagnostics::Place;
use crate::source::Source;

/// What kind of message it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageKind {
    /// Text of a `#debug`, line ends included as the scene wrote them.
    Debug,
    /// Text of a `#warning`.
    Warning,
    /// The reader's own: what is odd but not wrong.
    Notice,
}

/// One message and where it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What kind of message it is.
    pub kind: MessageKind,
    /// The file.
    pub path: PathBuf,
    /// Line and column, both from 1.
    pub at: (usize, usize),
    /// The text.
    pub text: String,
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            MessageKind::Debug => f.write_str(&self.text),
            MessageKind::Warning | MessageKind::Notice => {
                let (path, (line, column)) = (self.path.display(), self.at);
                writeln!(f, "{path}:{line}:{column}: warning: {}", self.text.trim_end())
            }
        }
    }
}

/// Messages kept for the caller; all of them are streamed.
const KEPT: usize = 10_000;
/// Notices given in all: a loop can make millions.
const NOTICES: usize = 100;
/// Texts told of one `#warning`.
const TEXTS: usize = 1000;

/// What one `#warning` has said.
struct Said {
    message: Message,
    /// How often it said its last text.
    times: usize,
    texts: usize,
}

/// Collects messages and passes them on as they come.
pub(crate) struct Messages<'a> {
    pub(crate) kept: Vec<Message>,
    notices: usize,
    warnings: BTreeMap<(u32, u32), Said>,
    /// The place of the message before: loops say the same again and again, and finding a line takes a walk.
    last: Option<(Place, (usize, usize))>,
    listener: Box<dyn FnMut(&Message) + Send + 'a>,
}

impl<'a> Messages<'a> {
    pub(crate) fn new(listener: Box<dyn FnMut(&Message) + Send + 'a>) -> Self {
        Self { kept: Vec::new(), notices: 0, warnings: BTreeMap::new(), last: None, listener }
    }

    /// Line and column of `place`.
    pub(crate) fn locate(&mut self, source: &Source, place: Place) -> (usize, usize) {
        match self.last {
            Some((last, at)) if last == place => at,
            _ => {
                let at = source.line_and_column(place.start as usize);
                self.last = Some((place, at));
                at
            }
        }
    }

    pub(crate) fn push(&mut self, place: Place, mut message: Message) {
        if message.kind == MessageKind::Warning {
            match self.warnings.get_mut(&(place.file, place.start)) {
                None => {
                    let said = Said { message: message.clone(), times: 1, texts: 1 };
                    self.warnings.insert((place.file, place.start), said);
                }
                Some(said) if said.message.text == message.text => {
                    said.times += 1;
                    return;
                }
                Some(said) if said.texts >= TEXTS => {
                    said.texts += 1;
                    return;
                }
                Some(said) => {
                    let texts = said.texts + 1;
                    let before = std::mem::replace(said, Said { message: message.clone(), times: 1, texts });
                    self.count(&before);
                }
            }
        }
        if message.kind == MessageKind::Notice {
            self.notices += 1;
            if self.notices > NOTICES {
                return;
            }
            if self.notices == NOTICES {
                message.text.push_str(" (further warnings of the reader are not shown)");
            }
        }
        self.tell(message);
    }

    /// Says what was not said because it was the same again.
    pub(crate) fn finish(&mut self) {
        for said in std::mem::take(&mut self.warnings).into_values() {
            self.count(&said);
            if said.texts > TEXTS {
                let text = format!("{} more warnings from here are not shown", said.texts - TEXTS);
                self.tell(Message { text, ..said.message });
            }
        }
    }

    fn count(&mut self, said: &Said) {
        if said.times > 1 {
            let text = format!("{} (said {} times)", said.message.text.trim_end(), said.times);
            self.tell(Message { text, ..said.message.clone() });
        }
    }

    fn tell(&mut self, message: Message) {
        (self.listener)(&message);
        if self.kept.len() < KEPT {
            self.kept.push(message);
        }
    }
}

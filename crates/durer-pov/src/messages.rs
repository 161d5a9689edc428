//! Messages of a scene while it is read: `#debug`, `#warning`, and the reader's own warnings.
//!
//! A loop can give the same message millions of times. A `#warning` that repeats itself is reported
//! once, and at the end with the number of times. Of one that changes, the first thousand texts are
//! reported. `#debug` messages are printed on purpose and never cut.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use crate::diagnostics::Place;
use crate::source::Source;

/// The kinds of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageKind {
    /// The text of a `#debug`, with the line ends that the scene wrote.
    Debug,
    /// The text of a `#warning`.
    Warning,
    /// A warning of the reader: something is odd but not wrong.
    Notice,
}

/// A message and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The kind of the message.
    pub kind: MessageKind,
    /// The file.
    pub path: PathBuf,
    /// Line and column, both counted from 1.
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

/// The number of messages kept for the caller; the listener gets all of them.
const KEPT: usize = 10_000;
/// The number of notices reported in all: a loop can make millions.
const NOTICES: usize = 100;
/// The number of different texts reported for one `#warning`.
const TEXTS: usize = 1000;

/// The messages of one `#warning`.
struct Said {
    message: Message,
    /// The number of times that its last text was repeated.
    times: usize,
    texts: usize,
}

/// Collects messages and passes them to the listener as they come.
pub(crate) struct Messages<'a> {
    pub(crate) kept: Vec<Message>,
    notices: usize,
    warnings: BTreeMap<(u32, u32), Said>,
    /// The place of the last message. Loops repeat places, and finding a line takes a search.
    last: Option<(Place, (usize, usize))>,
    listener: Box<dyn FnMut(&Message) + Send + 'a>,
}

impl<'a> Messages<'a> {
    pub(crate) fn new(listener: Box<dyn FnMut(&Message) + Send + 'a>) -> Self {
        Self { kept: Vec::new(), notices: 0, warnings: BTreeMap::new(), last: None, listener }
    }

    /// The line and column of `place`.
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

    /// Reports the repetitions and the number of texts that were not reported.
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

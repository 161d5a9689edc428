//! How the command ends when it does not end well.

use std::path::PathBuf;
use std::process::ExitCode;

/// Why the command stopped: one message, one exit code.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The input is wrong. The message is complete, place and underlined text included.
    #[error("{0}")]
    Input(String),
    /// The command line is wrong.
    #[error("error: {0}\n\nFor more information, try '--help'.")]
    Usage(String),
    /// The user pressed Ctrl-C.
    #[error("interrupted; what was done is in {}", .0.display())]
    Interrupted(PathBuf),
}

impl Failure {
    /// An input error of a file: its name, then what is wrong.
    pub(crate) fn file(path: &std::path::Path, what: impl std::fmt::Display) -> Self {
        Self::Input(format!("error: {}: {what}", path.display()))
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Input(_) => 1,
            Self::Usage(_) => 2,
            Self::Interrupted(_) => 130,
        })
    }
}

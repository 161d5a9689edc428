//! Failures of the command, with their messages and exit codes.

use std::path::PathBuf;
use std::process::ExitCode;

/// Why the command failed: it prints one message and ends with one exit code.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The input is wrong. The message is complete, with place and underlined text.
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
    /// An error in a file: its name, then the message.
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

//! Output files, which get their name only when they are complete.

use crate::failure::Failure;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Writes `path` through a temporary file in the same directory. It is renamed if `write` succeeds,
/// and removed otherwise.
pub(crate) fn write_whole<E: std::fmt::Display>(
    path: &Path,
    write: impl FnOnce(File) -> Result<(), E>,
) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::file(path, "cannot write: this is a directory"));
    }
    let temporary = neighbour(path);
    let attempt = File::create(&temporary)
        .map_err(|e| e.to_string())
        .and_then(|file| write(file).map_err(|e| e.to_string()))
        .and_then(|()| std::fs::rename(&temporary, path).map_err(|e| e.to_string()));
    attempt.map_err(|e| {
        // If it cannot be removed, it could not be created either; the first error is reported.
        let _ = std::fs::remove_file(&temporary);
        Failure::file(path, format_args!("cannot write: {e}"))
    })
}

/// The name of a hidden file beside `path` that no other process uses.
fn neighbour(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

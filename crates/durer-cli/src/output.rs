//! Files that appear under their name only when they are whole.

use crate::failure::Failure;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Writes `path` through a temporary neighbour, which takes the name when `write` has succeeded and
/// is removed when it has not.
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
        // If it cannot be removed it could not be made either; the first error is the one to tell.
        let _ = std::fs::remove_file(&temporary);
        Failure::file(path, format_args!("cannot write: {e}"))
    })
}

/// A hidden name beside `path` that no other process uses.
fn neighbour(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

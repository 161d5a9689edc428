//! Saved changes of the scene's files.
//!
//! Times and sizes are compared a few times a second. That works on every system and file system,
//! and for editors that replace a file as well as for those that write into it.

use crate::session::Session;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

const PAUSE: Duration = Duration::from_millis(150);

/// When a file was changed and how large it is; `None` if there is no such file.
type Print = Option<(SystemTime, u64)>;

fn print(path: &PathBuf) -> Print {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

struct Watched {
    files: Vec<(PathBuf, Print)>,
}

impl Watched {
    fn new(mut files: Vec<PathBuf>) -> Self {
        files.sort();
        files.dedup();
        Self {
            files: files.into_iter().map(|path| (print(&path), path)).map(|(p, path)| (path, p)).collect(),
        }
    }

    /// Watches these files from now on. Of files that were watched before, changes since then are
    /// not lost.
    fn follow(&mut self, files: Vec<PathBuf>) {
        let known = std::mem::replace(self, Self::new(files)).files;
        for (path, print) in &mut self.files {
            if let Some((_, before)) = known.iter().find(|(p, _)| p == path) {
                *print = *before;
            }
        }
    }

    fn paths(&self) -> impl Iterator<Item = PathBuf> {
        self.files.iter().map(|(path, _)| path.clone())
    }

    /// Whether a file has changed since the last call; records its present state.
    fn has_changed(&mut self) -> bool {
        let mut changed = false;
        for (path, known) in &mut self.files {
            let now = print(path);
            changed |= now != *known;
            *known = now;
        }
        changed
    }
}

/// Reads the scene again whenever one of its files changes, until the program ends.
pub(crate) fn watch(session: &Session) {
    let files = session.stage().origin.files();
    let mut watched = Watched::new(files);
    loop {
        std::thread::sleep(PAUSE);
        if !watched.has_changed() {
            continue;
        }
        // A file that is being written is read when it stays as it is, and again if it was written
        // while it was read: each change is shown once.
        let loaded = loop {
            std::thread::sleep(PAUSE / 5);
            if watched.has_changed() {
                continue;
            }
            let loaded = session.file.load();
            if !watched.has_changed() {
                break loaded;
            }
        };
        match loaded {
            Ok(stage) => {
                watched.follow(stage.origin.files());
                session.replace(stage);
            }
            Err(refused) => {
                // Whatever may repair it: the files so far, and those that the message names.
                watched.follow(watched.paths().chain(refused.files).collect());
                session.refuse(refused.message);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_seen_once() {
        let path = std::env::temp_dir().join(format!("durer-view-watch-{}", std::process::id()));
        std::fs::write(&path, "a").unwrap();
        let mut watched = Watched::new(vec![path.clone(), path.clone()]);
        assert!(!watched.has_changed());
        std::fs::write(&path, "ab").unwrap();
        assert!(watched.has_changed());
        assert!(!watched.has_changed());
        std::fs::remove_file(&path).unwrap();
        assert!(watched.has_changed());
    }
}

//! Source files of a scene: the search for them, their conversion from bytes to text, and the files
//! that are refused.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::branches::Block;
use crate::lexer::Token;
use crate::limits::Limits;

/// A file, read once: its text, its tokens, and the targets of its directives.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
    pub(crate) tokens: Vec<Token>,
    pub(crate) numbers: Vec<f64>,
    /// Strings as they stand between their quotes, with escapes unresolved.
    pub(crate) strings: Vec<Box<str>>,
    pub(crate) blocks: Vec<Block>,
}

impl Source {
    /// A file of which only the text is known; [`crate::lexer::lex`] adds the tokens.
    pub(crate) fn new(path: PathBuf, text: String) -> Self {
        Self { path, text, tokens: Vec::new(), numbers: Vec::new(), strings: Vec::new(), blocks: Vec::new() }
    }

    /// The line and column of a byte, both counted from 1; columns count characters.
    pub(crate) fn line_and_column(&self, at: usize) -> (usize, usize) {
        let head = &self.text[..at.min(self.text.len())];
        let line_start = head.rfind('\n').map_or(0, |i| i + 1);
        (1 + head.matches('\n').count(), 1 + head[line_start..].chars().count())
    }
}

impl AsRef<Self> for Source {
    fn as_ref(&self) -> &Self {
        self
    }
}

/// The text of the file at `path`, or the reason in one line why it cannot be read.
///
/// The text is UTF-8 if it is valid as such, and otherwise Latin-1, as in old scenes.
pub(crate) fn read_text(path: &Path, limits: &Limits) -> Result<String, String> {
    read_bytes(path, limits, "a scene file").map(decode)
}

/// The bytes of the file at `path`, which should be `what`, or one line that says why not.
pub(crate) fn read_bytes(path: &Path, limits: &Limits, what: &str) -> Result<Vec<u8>, String> {
    let unreadable = |e: std::io::Error| format!("cannot be read: {}", plain_reason(&e));
    let about = std::fs::metadata(path).map_err(unreadable)?;
    if about.is_dir() {
        return Err(format!("is a directory, not {what}"));
    }
    if !about.is_file() {
        return Err("is not a regular file".into());
    }
    let too_long = || {
        let limit = limits.file_size;
        format!(
            "is too long: the limit `file_size` is {limit} bytes (a larger one can be given with --limit file_size=N)"
        )
    };
    if about.len() > limits.file_size {
        return Err(too_long());
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    let file = File::open(path).map_err(unreadable)?;
    file.take(limits.file_size.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    // Positions are stored in 32 bits.
    if bytes.len() as u64 > limits.file_size.min(u64::from(u32::MAX) / 2) {
        return Err(too_long());
    }
    Ok(bytes)
}

/// The system's reason without the error number.
fn plain_reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or(&text);
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_lowercase().chain(chars).collect())
}

/// Converts bytes to text: UTF-8 (with or without a byte-order mark), else Latin-1.
fn decode(bytes: Vec<u8>) -> String {
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(not_utf8) => not_utf8.as_bytes().iter().map(|&b| char::from(b)).collect(),
    };
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

/// The folders in which an installed POV-Ray has its standard include files.
fn installed_folders() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for root in ["/usr/share", "/usr/local/share", "/opt/homebrew/share"] {
        let mut here: Vec<PathBuf> = std::fs::read_dir(root)
            .into_iter()
            .flatten()
            .flatten()
            .filter(|entry| entry.file_name().to_string_lossy().starts_with("povray"))
            .map(|entry| entry.path().join("include"))
            .filter(|folder| folder.is_dir())
            .collect();
        // The newest of several versions comes first: 3.8 before 3.7.
        here.sort_by(|a, b| b.cmp(a));
        found.append(&mut here);
    }
    found
}

/// The folders to search for include files, in order.
#[derive(Debug)]
pub(crate) struct Library {
    folders: Vec<PathBuf>,
}

impl Library {
    /// The scene's folder, the given folders, then POV-Ray's own.
    pub(crate) fn new(scene: &Path, given: &[PathBuf]) -> Self {
        let home = scene.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        let mut folders = vec![home];
        folders.extend(given.iter().cloned());
        folders.extend(installed_folders());
        Self { folders }
    }

    /// The scene's own folder.
    pub(crate) fn home(&self) -> &Path {
        self.folders.first().map_or(Path::new(""), PathBuf::as_path)
    }

    /// The file called `name`: with exactly this spelling if a folder has one, else with any case
    /// of letters.
    pub(crate) fn find(&self, name: &str) -> Option<PathBuf> {
        let name = name.trim();
        if name.is_empty() {
            return None;
        }
        let turned = name.replace('\\', "/");
        let spellings = if turned == name { vec![name] } else { vec![name, &turned] };
        let places = spellings.iter().flat_map(|s| self.folders.iter().map(move |f| f.join(s)));
        let exact = places.clone().find(|path| path.exists());
        exact.or_else(|| self.folders.iter().find_map(|folder| find_any_case(folder, &turned)))
    }
}

impl Library {
    /// The folders, as listed in a message.
    pub(crate) fn listed(&self) -> String {
        let shown = |folder: &PathBuf| {
            let text = folder.display().to_string();
            if text.is_empty() { ".".to_owned() } else { text }
        };
        self.folders.iter().map(shown).collect::<Vec<_>>().join(", ")
    }

    /// The names of all files in the folders.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = self.folders.iter().filter_map(|folder| {
            let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            std::fs::read_dir(listed).ok()
        });
        let mut names: Vec<String> =
            entries.flatten().flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names.dedup();
        names
    }

    /// The standard file that declares `name`, for a hint.
    pub(crate) fn file_that_declares(&self, name: &str) -> Option<String> {
        let declares = |text: &str| {
            text.lines().any(|line| {
                let mut words = line.split(|c: char| c.is_whitespace() || c == '=' || c == '(');
                let first = words.find(|word| !word.is_empty());
                matches!(first, Some("#declare" | "#macro")) && words.find(|w| !w.is_empty()) == Some(name)
            })
        };
        let mut found: Vec<String> = installed_folders()
            .into_iter()
            .filter_map(|folder| std::fs::read_dir(folder).ok())
            .flatten()
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "inc"))
            // Names of obsolete files are not what is meant.
            .filter(|path| !path.to_string_lossy().ends_with("_old.inc"))
            .filter(|path| std::fs::read(path).is_ok_and(|b| declares(&String::from_utf8_lossy(&b))))
            .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
            .collect();
        found.sort_by_key(|file| (file.len(), file.clone()));
        found.into_iter().next()
    }
}

/// The path of `name` (with `/` between folders) under `folder`, regardless of case.
fn find_any_case(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut at = if name.starts_with('/') { PathBuf::from("/") } else { folder.to_path_buf() };
    for part in name.split('/').filter(|part| !part.is_empty() && *part != ".") {
        let exact = at.join(part);
        if exact.exists() {
            at = exact;
            continue;
        }
        let listed = if at.as_os_str().is_empty() { Path::new(".") } else { &at };
        let mut matches: Vec<_> = std::fs::read_dir(listed)
            .ok()?
            .flatten()
            .map(|entry| entry.file_name())
            .filter(|found| found.to_string_lossy().eq_ignore_ascii_case(part))
            .collect();
        matches.sort();
        at = at.join(matches.first()?);
    }
    at.is_file().then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_not_utf8_are_latin_1() {
        assert_eq!(decode(b"D\xfcrer".to_vec()), "Dürer");
        assert_eq!(decode("Dürer".as_bytes().to_vec()), "Dürer");
        assert_eq!(decode(b"\xef\xbb\xbfx".to_vec()), "x");
    }

    #[test]
    fn a_directory_is_no_scene() {
        let why = read_text(Path::new("."), &Limits::default()).unwrap_err();
        assert_eq!(why, "is a directory, not a scene file");
    }

    #[test]
    fn columns_count_characters() {
        let source = Source::new(PathBuf::new(), "é\néé x".into());
        assert_eq!(source.line_and_column(source.text.find('x').unwrap()), (2, 4));
    }
}

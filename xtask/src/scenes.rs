//! Scene files and the comment at the head of each.

use crate::Outcome;
use std::path::{Path, PathBuf};

/// A scene file. The first line of its comment is the title. A line `Equation: ...` gives the
/// surface's equation, and the rest is a description.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) path: PathBuf,
    /// The file's name without its extension.
    pub(crate) name: String,
    pub(crate) header: Header,
    /// The whole text.
    pub(crate) text: String,
}

/// The contents of the comment at the head of a scene.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Header {
    pub(crate) title: String,
    pub(crate) equations: Vec<String>,
    pub(crate) description: String,
}

/// The scenes of a folder, sorted by name; all of them or the named ones.
pub(crate) fn list(folder: &Path, names: &[String]) -> Outcome<Vec<Scene>> {
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut scenes = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if path.extension().is_some_and(|e| e == "pov") && (names.is_empty() || names.contains(&name)) {
            let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            scenes.push(Scene { name, header: header(&text), text, path });
        }
    }
    if let Some(unknown) = names.iter().find(|name| scenes.iter().all(|s| s.name != **name)) {
        return Err(format!("{}: no scene named {unknown}", folder.display()));
    }
    if scenes.is_empty() {
        return Err(format!("{}: no scenes", folder.display()));
    }
    scenes.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(scenes)
}

/// Reads the comment lines before the first line of code.
fn header(text: &str) -> Header {
    let lines = text.lines().map_while(|line| line.strip_prefix("//")).map(str::trim);
    let mut header = Header::default();
    for line in lines {
        if header.title.is_empty() {
            line.clone_into(&mut header.title);
        } else if let Some(equation) = line.strip_prefix("Equation:") {
            header.equations.push(equation.trim().to_owned());
        } else if line.is_empty() {
            if !header.description.is_empty() {
                header.description.push_str("\n\n");
            }
        } else {
            if !header.description.is_empty() && !header.description.ends_with('\n') {
                header.description.push(' ');
            }
            header.description.push_str(line);
        }
    }
    header.description.truncate(header.description.trim_end().len());
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_has_title_equation_and_words() {
        let text = "// Sphere\n//\n// Equation: |p|² = r²\n//\n// Round from\n// all sides.\n#version 3.7;\n// not this\n";
        let expected = Header {
            title: "Sphere".into(),
            equations: vec!["|p|² = r²".into()],
            description: "Round from all sides.".into(),
        };
        assert_eq!(header(text), expected);
    }
}

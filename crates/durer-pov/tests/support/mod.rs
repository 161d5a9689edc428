//! Test scenes written as text, and their results.
#![allow(dead_code, reason = "each test file uses its own part of this")]

use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use durer_pov::{MessageKind, PovError, Read, ReadOptions};

/// A temporary folder, removed when the test is over.
pub(crate) struct Folder(pub(crate) PathBuf);

static COUNT: AtomicU32 = AtomicU32::new(0);

impl Folder {
    pub(crate) fn new() -> Self {
        let name = format!("durer-pov-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }

    pub(crate) fn read(&self, name: &str) -> Result<Read, PovError> {
        durer_pov::read(&self.0.join(name), &ReadOptions::default())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A leftover in the temporary folder does not fail the test.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Reads `text` as a scene of version 3.7.
pub(crate) fn read(text: &str) -> Result<Read, PovError> {
    let folder = Folder::new();
    folder.write("scene.pov", format!("#version 3.7; global_settings {{ assumed_gamma 1 }}\n{text}"));
    folder.read("scene.pov")
}

/// The scene of `text`.
pub(crate) fn scene(text: &str) -> durer_scene::Scene {
    read(text).unwrap_or_else(|error| panic!("{error}")).scene
}

/// The `#debug` output of `text`.
pub(crate) fn debug(text: &str) -> String {
    let read = read(text).unwrap_or_else(|error| panic!("{error}"));
    let said = read.messages.iter().filter(|message| message.kind == MessageKind::Debug);
    said.map(|message| message.text.as_str()).collect()
}

/// The reader's own warnings about `text`.
pub(crate) fn notices(text: &str) -> Vec<String> {
    let read = read(text).unwrap_or_else(|error| panic!("{error}"));
    let said = read.messages.iter().filter(|message| message.kind == MessageKind::Notice);
    said.map(|message| message.text.clone()).collect()
}

/// The value of a float expression with `digits` after the point.
pub(crate) fn float(expression: &str, digits: u32) -> String {
    debug(&format!("#debug str({expression}, 0, {digits})"))
}

/// The value of a vector expression.
pub(crate) fn vector(count: u32, expression: &str) -> String {
    debug(&format!("#declare Shown = {expression}; #debug vstr({count}, Shown, \",\", 0, 4)"))
}

/// The line, column and text of the error in `text`; the scene's first line is line 1.
pub(crate) fn fault(text: &str) -> (usize, usize, String) {
    match read(text) {
        Ok(_) => panic!("this was read without a complaint: {text}"),
        Err(error) => {
            let (line, column) = error.at.unwrap_or((0, 0));
            (line.saturating_sub(1), column, error.text)
        }
    }
}

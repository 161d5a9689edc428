//! A writer for glTF files in tests.

use std::ops::Range;

/// A file under construction: lists of the document, and one buffer.
#[derive(Default)]
pub(crate) struct File {
    /// The names and items of the lists; `scene` is a single number.
    pub(crate) lists: Vec<(String, String)>,
    pub(crate) bytes: Vec<u8>,
}

impl File {
    /// Adds an item to a list.
    pub(crate) fn list(&mut self, name: &str, item: &str) {
        self.lists.push((name.into(), item.into()));
    }

    fn count(&self, name: &str) -> usize {
        self.lists.iter().filter(|l| l.0 == name).count()
    }

    /// Adds a view of new bytes and returns its number.
    pub(crate) fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let number = self.count("bufferViews");
        let stride = stride.map(|s| format!(r#", "byteStride": {s}"#)).unwrap_or_default();
        let (from, length) = (self.bytes.len(), bytes.len());
        self.list(
            "bufferViews",
            &format!(r#"{{ "buffer": 0, "byteOffset": {from}, "byteLength": {length}{stride} }}"#),
        );
        self.bytes.extend(bytes);
        number
    }

    /// Adds an accessor of new bytes and returns its number.
    pub(crate) fn accessor(&mut self, about: &str, bytes: &[u8]) -> usize {
        let view = self.view(bytes, None);
        self.list("accessors", &format!(r#"{{ "bufferView": {view}, {about} }}"#));
        self.count("accessors") - 1
    }

    /// The document; `buffer` are further members of its buffer.
    pub(crate) fn text(&self, buffer: &str) -> String {
        let mut names: Vec<&str> =
            self.lists.iter().map(|l| l.0.as_str()).filter(|n| *n != "scene").collect();
        names.sort_unstable();
        names.dedup();
        let items = |name: &str| {
            let items: Vec<_> = self.lists.iter().filter(|l| l.0 == name).map(|l| l.1.as_str()).collect();
            items.join(",\n  ")
        };
        let lists: Vec<_> = names.iter().map(|name| format!("\"{name}\": [ {} ],\n", items(name))).collect();
        let scene = self.lists.iter().find(|l| l.0 == "scene").map(|l| format!("\"scene\": {},\n", l.1));
        let length = self.bytes.len();
        format!(
            "{{ \"asset\": {{ \"version\": \"2.0\" }},\n{}{}\"buffers\": [ {{ \"byteLength\": {length}{buffer} }} ] }}",
            scene.unwrap_or_default(),
            lists.concat()
        )
    }

    /// The file with its buffer as base 64 in the text.
    pub(crate) fn data(&self) -> String {
        self.text(&format!(r#", "uri": "data:application/octet-stream;base64,{}""#, base64(&self.bytes)))
    }

    /// The file as binary.
    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(&self.text(""), &self.bytes)
    }
}

/// A binary file of a document and a buffer.
pub(crate) fn glb(text: &str, buffer: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut buffer = buffer.to_vec();
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let mut out = b"glTF".to_vec();
    let mut put = |n: usize| out.extend((n as u32).to_le_bytes());
    put(2);
    put(12 + 8 + text.len() + 8 + buffer.len());
    put(text.len());
    out.extend(b"JSON");
    out.extend(&text);
    out.extend((buffer.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(&buffer);
    out
}

pub(crate) fn floats(list: &[f32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

pub(crate) fn shorts(list: &[u16]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The ranges of numbers in a document, except those within strings.
pub(crate) fn numbers(text: &str) -> Vec<Range<usize>> {
    let is_number = |b: u8| b.is_ascii_digit() || b"+-.eE".contains(&b);
    let (mut places, mut quoted, mut at) = (Vec::new(), false, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        quoted ^= bytes[at] == b'"';
        let end = (at..bytes.len()).find(|&i| quoted || !is_number(bytes[i])).unwrap_or(bytes.len());
        if end > at && bytes[at] != b'e' {
            places.push(at..end);
        }
        at = end.max(at + 1);
    }
    places
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for three in bytes.chunks(3) {
        let bits =
            (0..3).fold(0_usize, |bits, i| bits << 8 | usize::from(three.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let letter = LETTERS[bits >> (18 - 6 * i) & 63];
            out.push(if i > three.len() { '=' } else { char::from(letter) });
        }
    }
    out
}

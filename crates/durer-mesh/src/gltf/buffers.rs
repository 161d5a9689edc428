//! Buffers: the binary chunk of the file, separate files, or base 64 within the text.

use super::item;
use crate::error::{ErrorKind, Location};
use crate::text::shortened;
use gltf::json::Buffer;
use gltf::json::buffer::View;
use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The buffers of a file. Each is read when it is first needed.
pub(super) struct Buffers<'a> {
    list: &'a [Buffer],
    chunk: Option<&'a [u8]>,
    folder: Option<&'a Path>,
    read: Vec<Option<Cow<'a, [u8]>>>,
    /// The number of bytes of this file and of the separate files read so far.
    pub(super) there: usize,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        list: &'a [Buffer],
        chunk: Option<&'a [u8]>,
        folder: Option<&'a Path>,
        there: usize,
    ) -> Self {
        Self { list, chunk, folder, read: vec![None; list.len()], there }
    }

    /// The bytes of a view.
    pub(super) fn view(
        &mut self,
        views: &[View],
        number: usize,
        asked: Location,
    ) -> Result<&[u8], ErrorKind> {
        let view = item(views, number, "bufferView", asked)?;
        let spot = Location::Element("bufferView", number);
        let buffer = view.buffer.value();
        item(self.list, buffer, "buffer", spot)?;
        let bytes = self.bytes(buffer)?;
        let (from, length) = (view.byte_offset.map_or(0, |x| x.0), view.byte_length.0);
        let room = (bytes.len() as u64).saturating_sub(from);
        if from > bytes.len() as u64 || length > room {
            let what = format!("bytes from byte {from} of buffer {buffer}");
            return Err(ErrorKind::Room { spot, what, promised: length, room });
        }
        // Both ends lie in the buffer, which is in memory, so they fit usize.
        Ok(&bytes[from as usize..(from + length) as usize])
    }

    fn bytes(&mut self, number: usize) -> Result<&[u8], ErrorKind> {
        if self.read[number].is_none() {
            let bytes = self.load(number)?;
            if let Cow::Owned(bytes) = &bytes {
                self.there = self.there.saturating_add(bytes.len());
            }
            self.read[number] = Some(bytes);
        }
        Ok(self.read[number].as_deref().unwrap_or_default())
    }

    fn load(&self, number: usize) -> Result<Cow<'a, [u8]>, ErrorKind> {
        let (buffer, spot) = (&self.list[number], Location::Element("buffer", number));
        let promised = buffer.byte_length.0;
        let bytes = match buffer.uri.as_deref() {
            None => Cow::Borrowed(match self.chunk {
                Some(chunk) if number == 0 => chunk,
                _ => return super::wrong(spot, "it has no uri, and the file has no chunk BIN for it"),
            }),
            Some(uri) if uri.get(..5).is_some_and(|s| s.eq_ignore_ascii_case("data:")) => {
                let (head, body) = uri.split_once(',').unwrap_or((uri, ""));
                if !head.ends_with(";base64") {
                    return super::wrong(spot, "its uri has data that are not base64");
                }
                Cow::Owned(base64(body.as_bytes(), spot)?)
            }
            Some(uri) => Cow::Owned(self.beside(uri, promised, spot)?),
        };
        let room = bytes.len() as u64;
        if promised > room {
            return Err(ErrorKind::Room { spot, what: "bytes".into(), promised, room });
        }
        Ok(bytes)
    }

    /// Reads a separate file, but no more bytes than the buffer declares.
    fn beside(&self, uri: &str, promised: u64, spot: Location) -> Result<Vec<u8>, ErrorKind> {
        let path = unescaped(uri);
        let Some(folder) = self.folder else {
            return super::wrong(
                spot,
                format!("'{}' is another file, and there is none in memory", shortened(uri)),
            );
        };
        if uri.contains("://") || path.is_absolute() {
            return super::wrong(spot, format!("'{}' is not a file beside this one", shortened(uri)));
        }
        let path = folder.join(path);
        let failed = |e: std::io::Error| ErrorKind::Element {
            spot,
            said: format!("'{}' cannot be read: {e}", shortened(uri)),
        };
        // A pipe is not opened, because that could wait forever.
        let about = std::fs::metadata(&path).map_err(failed)?;
        if !about.is_file() {
            return super::wrong(spot, format!("'{}' is no file", shortened(uri)));
        }
        if promised > about.len() {
            return Err(ErrorKind::Room { spot, what: "bytes".into(), promised, room: about.len() });
        }
        let mut bytes = Vec::new();
        File::open(path).and_then(|file| file.take(promised).read_to_end(&mut bytes)).map_err(failed)?;
        Ok(bytes)
    }
}

/// A relative URI as a path: `%20` becomes a space.
fn unescaped(uri: &str) -> PathBuf {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).filter(|_| first == b'%').and_then(|d| std::str::from_utf8(d).ok());
        match digits.and_then(|d| u8::from_str_radix(d, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    PathBuf::from(String::from_utf8_lossy(&bytes).into_owned())
}

/// Decodes base 64 (S. Josefsson, RFC 4648, 2006).
fn base64(text: &[u8], spot: Location) -> Result<Vec<u8>, ErrorKind> {
    let text = text.strip_suffix(b"==").or_else(|| text.strip_suffix(b"=")).unwrap_or(text);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for four in text.chunks(4) {
        let mut bits = 0_u32;
        for &letter in four {
            let six = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' | b'-' => 62,
                b'/' | b'_' => 63,
                _ => {
                    let found = shortened(&String::from_utf8_lossy(&[letter]));
                    return Err(ErrorKind::Expected { spot, expected: "base64", found });
                }
            };
            bits = bits << 6 | u32::from(six);
        }
        let count = four.len() * 6 / 8;
        if count == 0 {
            return Err(ErrorKind::End { spot, expected: "another letter of base64" });
        }
        let [_, three @ ..] = (bits << (6 * (4 - four.len()))).to_be_bytes();
        bytes.extend(&three[..count]);
    }
    Ok(bytes)
}

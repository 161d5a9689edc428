//! The container of a file: its JSON text, and the binary chunk after it.
//!
//! A `.glb` file starts with 12 bytes (`glTF`, a version, the total length). Chunks follow: a
//! length, a kind, and that many bytes. The first chunk is the text. The second, if its kind is
//! `BIN`, is the buffer without a URI. Chunks of other kinds are ignored.

use crate::error::{ErrorKind, Location};
use crate::text::{one_line, shortened};
use gltf::json::{Error, Root, Value, deserialize};

const HEADER: usize = 12;
const TEXT: &[u8] = b"JSON";
const BUFFER: &[u8] = b"BIN\0";

/// Splits a file into the text and the binary chunk.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ErrorKind> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else { return Ok((bytes, None)) };
    let end = |expected| ErrorKind::End { spot: Location::Byte(bytes.len()), expected };
    let (version, rest) = number(rest).ok_or_else(|| end("a version and a length"))?;
    if version != 2 {
        return Err(ErrorKind::Unsupported {
            spot: Location::Byte(4),
            what: format!("version {version} of glTF"),
        });
    }
    let (length, _) = number(rest).ok_or_else(|| end("a length"))?;
    promise("bytes".into(), length, bytes.len())?;
    let mut at = HEADER;
    // Bytes after the declared length do not belong to the file.
    let whole = bytes.get(..length).unwrap_or(bytes);
    let mut chunk = |kind: &'static str| {
        let head = whole.get(at..).filter(|rest| !rest.is_empty())?;
        Some(match (number(head), head.get(4..8)) {
            (Some((length, _)), Some(word)) => {
                let body = head.get(8..).unwrap_or_default();
                at += 8 + length;
                promise(format!("bytes in its chunk {kind}"), length, body.len())
                    .map(|()| (word, &body[..length]))
            }
            _ => Err(ErrorKind::End { spot: Location::Byte(whole.len()), expected: "the head of a chunk" }),
        })
    };
    let (word, text) = chunk("JSON").ok_or_else(|| end("the chunk JSON"))??;
    if word != TEXT {
        let found = shortened(&String::from_utf8_lossy(word));
        return Err(ErrorKind::Expected {
            spot: Location::Byte(HEADER + 4),
            expected: "the chunk JSON",
            found,
        });
    }
    match chunk("BIN").transpose()? {
        Some((BUFFER, buffer)) => Ok((text, Some(buffer))),
        _ => Ok((text, None)),
    }
}

fn number(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let (first, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*first) as usize, rest))
}

fn promise(what: String, promised: usize, room: usize) -> Result<(), ErrorKind> {
    if promised <= room {
        return Ok(());
    }
    Err(ErrorKind::Promise { what, promised: promised as u64, room: room as u64 })
}

/// Members that contain indices or codes.
const INDICES: [&str; 13] = [
    "NORMAL",
    "POSITION",
    "TEXCOORD_0",
    "buffer",
    "bufferView",
    "children",
    "componentType",
    "indices",
    "material",
    "mesh",
    "mode",
    "nodes",
    "scene",
];

/// Parses the text as a glTF document.
pub(super) fn parse(text: &[u8]) -> Result<Root, ErrorKind> {
    let whole = deserialize::from_slice(text).map_err(|e| said(&e))?;
    check_indices(&whole)?;
    drop(whole);
    deserialize::from_slice(text).map_err(|e| said(&e))
}

fn said(error: &Error) -> ErrorKind {
    let said = error.to_string();
    // The library puts the place at the end of its message. Before that it may quote long words of
    // the file.
    let cut = said.rfind(" at line ").unwrap_or(said.len());
    ErrorKind::Text { line: error.line(), column: error.column(), said: one_line(&said[..cut]) }
}

/// Refuses indices that do not fit 32 bits, because the library takes indices modulo 2^32.
fn check_indices(whole: &Value) -> Result<(), ErrorKind> {
    let lists = ["scene", "node", "mesh", "accessor", "bufferView"].into_iter().zip([
        "scenes",
        "nodes",
        "meshes",
        "accessors",
        "bufferViews",
    ]);
    for (kind, list) in lists {
        for (number, item) in whole[list].as_array().into_iter().flatten().enumerate() {
            if let Some(index) = too_large(item, false) {
                return super::wrong(Location::Element(kind, number), format!("{index} is no index"));
            }
        }
    }
    match too_large(&whole["scene"], true) {
        Some(index) => super::wrong(Location::Element("scene", 0), format!("{index} is no index")),
        None => Ok(()),
    }
}

/// The first index of more than 32 bits.
fn too_large(value: &Value, is_index: bool) -> Option<u64> {
    match value {
        Value::Number(number) if is_index => number.as_u64().filter(|&n| n > u64::from(u32::MAX)),
        Value::Array(items) => items.iter().find_map(|item| too_large(item, is_index)),
        Value::Object(members) => {
            members.iter().find_map(|(name, value)| too_large(value, INDICES.contains(&name.as_str())))
        }
        _ => None,
    }
}

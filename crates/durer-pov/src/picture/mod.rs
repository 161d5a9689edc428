//! Pictures, as tables of heights: 16 bits each, the top row first.
//!
//! Facts of the scene language, found by `trace` with POV-Ray 3.7:
//!
//! - Grey values of 16 bits are unchanged, those of fewer bits are stretched to 0..65535.
//! - Of a PNG of 8 bits without alpha a third of the levels come out one lower ([`of_png_grey`]).
//! - In a colour picture red is the high byte and green the low one; blue and alpha are ignored.
//! - In a picture with a palette the index is the high byte; its colours are ignored.
//! - The left half of a POT picture holds the high bytes, its right half the low bytes.

pub(crate) mod colours;
mod compressed;
mod plain;

use std::path::Path;

use crate::diagnostics::Error;
use crate::keywords::Keyword;
use crate::limits::Limits;
use crate::source;

/// The heights of a picture.
pub(crate) struct Picture {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) words: Vec<u16>,
}

/// Why there is no picture.
pub(crate) enum Fault {
    /// In words, after the file's name.
    Text(String),
    /// A limit of the reader.
    Limit(Box<Error>),
}

type Result<T> = std::result::Result<T, Fault>;

fn fault<T>(text: impl Into<String>) -> Result<T> {
    Err(Fault::Text(text.into()))
}

/// Checks the columns and rows of a picture before its pixels are read.
type MayHold<'a> = &'a dyn Fn([usize; 2]) -> std::result::Result<(), Fault>;

/// The formats that durer reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    /// PGM and PPM.
    Pnm,
    Tga,
    Gif,
    /// Fractint's continuous potentials of 16 bits: GIF files, for heights alone.
    Pot,
    Bmp,
    Jpeg,
    Tiff,
    Exr,
    Hdr,
}

impl Format {
    /// The format that a word of the scene language names.
    pub(crate) fn from_keyword(keyword: Keyword) -> Option<Self> {
        Some(match keyword {
            Keyword::Png => Self::Png,
            Keyword::Pgm | Keyword::Ppm => Self::Pnm,
            Keyword::Tga => Self::Tga,
            Keyword::Gif => Self::Gif,
            Keyword::Pot => Self::Pot,
            Keyword::Bmp => Self::Bmp,
            Keyword::Jpeg => Self::Jpeg,
            Keyword::Tiff => Self::Tiff,
            Keyword::Exr => Self::Exr,
            Keyword::Hdr => Self::Hdr,
            _ => return None,
        })
    }

    /// The format that belongs to the ending of a file's name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        let ending = name.rsplit_once('.')?.1.to_ascii_lowercase();
        Some(match ending.as_str() {
            "png" => Self::Png,
            "pgm" | "ppm" | "pnm" => Self::Pnm,
            "tga" => Self::Tga,
            "gif" => Self::Gif,
            "pot" => Self::Pot,
            "bmp" => Self::Bmp,
            "jpg" | "jpeg" => Self::Jpeg,
            "tif" | "tiff" => Self::Tiff,
            "exr" => Self::Exr,
            "hdr" => Self::Hdr,
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "a PNG file",
            Self::Pnm => "a PGM or PPM file",
            Self::Tga => "a TGA file",
            Self::Gif => "a GIF file",
            Self::Pot => "a POT file",
            Self::Bmp => "a BMP file",
            Self::Jpeg => "a JPEG file",
            Self::Tiff => "a TIFF file",
            Self::Exr => "an OpenEXR file",
            Self::Hdr => "a Radiance HDR file",
        }
    }

    /// The first bytes of every file of this format; TGA has none.
    fn is_begun_by(self, bytes: &[u8]) -> bool {
        match self {
            Self::Png => bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
            Self::Pnm => matches!(bytes, [b'P', b'2' | b'3' | b'5' | b'6', ..]),
            Self::Tga => true,
            Self::Gif | Self::Pot => bytes.starts_with(b"GIF8"),
            Self::Bmp => bytes.starts_with(b"BM"),
            Self::Jpeg => bytes.starts_with(b"\xff\xd8"),
            Self::Tiff => bytes.starts_with(b"II") || bytes.starts_with(b"MM"),
            Self::Exr => bytes.starts_with(b"\x76\x2f\x31\x01"),
            Self::Hdr => bytes.starts_with(b"#?"),
        }
    }
}

/// Reads the picture at `path`; `may_hold` returns whether that many heights may be kept.
pub(crate) fn read(path: &Path, format: Format, limits: &Limits, may_hold: MayHold<'_>) -> Result<Picture> {
    let bytes = source::read_bytes(path, limits, "a picture").map_err(Fault::Text)?;
    if bytes.is_empty() {
        return fault("is empty");
    }
    if !format.is_begun_by(&bytes) {
        return fault(format!("is not {}", format.name()));
    }
    match format {
        Format::Png => compressed::png(&bytes, may_hold),
        Format::Pnm => plain::pnm(&bytes, may_hold),
        Format::Tga => plain::tga(&bytes, may_hold),
        Format::Gif => compressed::gif(&bytes, may_hold),
        Format::Pot => compressed::pot(&bytes, may_hold),
        Format::Bmp => plain::bmp(&bytes, may_hold),
        Format::Jpeg => compressed::jpeg(&bytes, may_hold),
        Format::Tiff | Format::Exr | Format::Hdr => fault("is no picture of heights that durer reads"),
    }
}

/// The fault of a file that ends too early.
fn cut_off<T>(what: &str, wanted: usize, found: usize) -> Result<T> {
    fault(format!("ends too early: its {what} take {wanted} bytes, and {found} are there"))
}

/// The height of a grey value out of `most`.
fn of_grey(value: u32, most: u32) -> u16 {
    let most = most.max(1);
    ((value.min(most) * 65535 + most / 2) / most) as u16
}

/// The height of a grey level of a PNG of 8 bits without alpha, as POV-Ray 3.7 computes it: the
/// weighted sum of three equal channels in single precision, cut to 8 bits. So a third of the
/// levels come out one lower.
fn of_png_grey(level: u8) -> u16 {
    let grey = f32::from(level) / 255.0;
    let sum = 0.297 * grey + 0.589 * grey + 0.114 * grey;
    of_grey((sum * 255.0) as u32, 255)
}

/// The height of a colour by its red and green.
fn of_colour(red: u8, green: u8) -> u16 {
    u16::from(red) << 8 | u16::from(green)
}

/// The height of an index into a palette.
fn of_index(index: u8) -> u16 {
    u16::from(index) << 8
}

#[cfg(test)]
mod tests;

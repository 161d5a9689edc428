//! Pictures, as colours: unpacked by the crate `image`, and PNG and GIF with a palette by the
//! libraries for them, because the indices matter.

use std::io::Cursor;
use std::path::Path;

use image::{ImageFormat, ImageReader};

use super::{Fault, Format, MayHold, Result, compressed::broken, fault};
use crate::limits::Limits;
use crate::source;

/// Colours as they stand in a file, from 0 to 1: red, green, blue and opacity.
pub(crate) struct Colours {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) pixels: Pixels,
    /// The meaning of the numbers as the file states it.
    pub(crate) gamma: FileGamma,
}

pub(crate) enum Pixels {
    Plain(Vec<[f32; 4]>),
    /// A palette of 256 colours, and indices.
    Indexed(Vec<[f32; 4]>, Vec<u8>),
}

/// The meaning of the numbers of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FileGamma {
    /// Not stated; files of this format are usually encoded as sRGB.
    UsuallySrgb,
    /// Not stated; the numbers are used without conversion.
    Unknown,
    /// Light is the number to this power.
    Power(f64),
    /// Encoded as sRGB.
    Srgb,
}

/// Reads the picture at `path`; `may_hold` returns whether that many pixels may be kept.
pub(crate) fn read(path: &Path, format: Format, limits: &Limits, may_hold: MayHold<'_>) -> Result<Colours> {
    let bytes = source::read_bytes(path, limits, "a picture").map_err(Fault::Text)?;
    if bytes.is_empty() {
        return fault("is empty");
    }
    if !format.is_begun_by(&bytes) {
        return fault(format!("is not {}", format.name()));
    }
    let mut gamma = match format {
        Format::Pnm | Format::Tiff => FileGamma::Unknown,
        Format::Exr | Format::Hdr => FileGamma::Power(1.0),
        _ => FileGamma::UsuallySrgb,
    };
    if format == Format::Png {
        gamma = png_gamma(&bytes).unwrap_or(gamma);
        if let Some(mut found) = png_with_palette(&bytes, may_hold)? {
            found.gamma = gamma;
            return Ok(found);
        }
    }
    if format == Format::Gif {
        return gif(&bytes, may_hold);
    }
    let kind = match format {
        Format::Png => ImageFormat::Png,
        Format::Pnm => ImageFormat::Pnm,
        Format::Tga => ImageFormat::Tga,
        Format::Gif => ImageFormat::Gif,
        Format::Pot => return fault("holds heights, not colours"),
        Format::Bmp => ImageFormat::Bmp,
        Format::Jpeg => ImageFormat::Jpeg,
        Format::Tiff => ImageFormat::Tiff,
        Format::Exr => ImageFormat::OpenExr,
        Format::Hdr => ImageFormat::Hdr,
    };
    let size = ImageReader::with_format(Cursor::new(&bytes), kind).into_dimensions();
    let (columns, rows) = match size {
        Ok((columns, rows)) => (columns as usize, rows as usize),
        Err(error) => return broken(error),
    };
    may_hold([columns, rows])?;
    let picture = match ImageReader::with_format(Cursor::new(&bytes), kind).decode() {
        Ok(picture) => picture.into_rgba32f(),
        Err(error) => return broken(error),
    };
    let pixels = picture.pixels().map(|pixel| pixel.0).collect();
    Ok(Colours { columns, rows, pixels: Pixels::Plain(pixels), gamma })
}

/// The meaning of a PNG file's numbers by its chunks.
fn png_gamma(bytes: &[u8]) -> Option<FileGamma> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_ignore_text_chunk(true);
    let info = decoder.read_header_info().ok()?;
    if info.srgb.is_some() {
        return Some(FileGamma::Srgb);
    }
    let stored = info.gama_chunk.map(|gamma| f64::from(gamma.into_value()))?;
    (stored > 0.0).then(|| FileGamma::Power(1.0 / stored))
}

/// A PNG file with a palette; `None` for any other.
fn png_with_palette(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Option<Colours>> {
    use png::{ColorType, Decoder, Transformations};
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::IDENTITY);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let (columns, rows) = match decoder.read_header_info() {
        Ok(info) if info.color_type == ColorType::Indexed => (info.width as usize, info.height as usize),
        Ok(_) => return Ok(None),
        Err(error) => return broken(error),
    };
    may_hold([columns, rows])?;
    let mut reader = match decoder.read_info() {
        Ok(reader) => reader,
        Err(error) => return broken(error),
    };
    let Some(size) = reader.output_buffer_size() else { return fault("is too large") };
    let mut all = vec![0; size];
    if let Err(error) = reader.next_frame(&mut all) {
        return broken(error);
    }
    let (_, depth) = reader.output_color_type();
    let bits = depth as usize;
    if bits > 8 || rows == 0 || size < rows {
        return fault("has a palette of more than 256 colours");
    }
    let most = ((1_u16 << bits) - 1) as u8;
    let mut indices = Vec::with_capacity(columns * rows);
    for row in all.chunks_exact(size / rows).take(rows) {
        indices.extend((0..columns).map(|n| row[n * bits / 8] >> (8 - bits - n * bits % 8) & most));
    }
    let info = reader.info();
    let mut palette = vec![[0.0, 0.0, 0.0, 1.0]; 256];
    let colours = info.palette.as_deref().unwrap_or_default().chunks_exact(3);
    let part = |byte: u8| f32::from(byte) / 255.0;
    for (to, from) in palette.iter_mut().zip(colours) {
        *to = [part(from[0]), part(from[1]), part(from[2]), 1.0];
    }
    for (to, &opacity) in palette.iter_mut().zip(info.trns.as_deref().unwrap_or_default()) {
        to[3] = part(opacity);
    }
    Ok(Some(Colours { columns, rows, pixels: Pixels::Indexed(palette, indices), gamma: FileGamma::Unknown }))
}

/// The first picture of a GIF file.
fn gif(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Colours> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = match options.read_info(Cursor::new(bytes)) {
        Ok(decoder) => decoder,
        Err(error) => return broken(error),
    };
    let (columns, rows) = match decoder.next_frame_info() {
        Ok(Some(frame)) => (usize::from(frame.width), usize::from(frame.height)),
        Ok(None) => return fault("has no picture"),
        Err(error) => return broken(error),
    };
    may_hold([columns, rows])?;
    let mut indices = vec![0; columns * rows];
    if let Err(error) = decoder.read_into_buffer(&mut indices) {
        return broken(error);
    }
    let mut palette = vec![[0.0, 0.0, 0.0, 1.0]; 256];
    let colours = match decoder.palette() {
        Ok(colours) => colours.to_vec(),
        Err(error) => return broken(error),
    };
    for (to, from) in palette.iter_mut().zip(colours.chunks_exact(3)) {
        let part = |byte: u8| f32::from(byte) / 255.0;
        *to = [part(from[0]), part(from[1]), part(from[2]), 1.0];
    }
    Ok(Colours { columns, rows, pixels: Pixels::Indexed(palette, indices), gamma: FileGamma::UsuallySrgb })
}

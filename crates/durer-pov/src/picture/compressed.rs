//! PNG, GIF and JPEG, unpacked by the libraries for them.

use std::io::Cursor;

use super::{Fault, MayHold, Picture, Result, fault, of_colour, of_grey, of_index, of_png_grey};

/// Bytes that a decoder may take beside the picture.
const DECODER: usize = 1 << 30;

pub(super) fn broken<T>(error: impl std::fmt::Display) -> Result<T> {
    let text = error.to_string();
    fault(format!("cannot be unpacked: {}", text.trim_end_matches('.')))
}

/// PNG of any kind.
pub(super) fn png(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    use png::{BitDepth, ColorType, Decoder, Limits, Transformations};
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: DECODER });
    decoder.set_transformations(Transformations::IDENTITY);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let info = match decoder.read_header_info() {
        Ok(info) => info,
        Err(error) => return broken(error),
    };
    let (columns, rows) = (info.width as usize, info.height as usize);
    may_hold([columns, rows])?;
    let mut reader = match decoder.read_info() {
        Ok(reader) => reader,
        Err(error) => return broken(error),
    };
    let (colour, depth) = reader.output_color_type();
    let is_interlaced = reader.info().interlaced;
    let channels = colour.samples();
    let heights = |row: &[u8], words: &mut Vec<u16>| match (colour, depth) {
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::One | BitDepth::Two | BitDepth::Four) => {
            let bits = depth as usize;
            let most = (1_u8 << bits) - 1;
            words.extend((0..columns).map(|n| {
                let value = row[n * bits / 8] >> (8 - bits - n * bits % 8) & most;
                if colour == ColorType::Indexed {
                    of_index(value)
                } else {
                    of_grey(value.into(), most.into())
                }
            }));
        }
        (ColorType::Indexed, _) => words.extend(row.iter().map(|&index| of_index(index))),
        (ColorType::Grayscale | ColorType::GrayscaleAlpha, BitDepth::Sixteen) => {
            words.extend(row.chunks_exact(2 * channels).map(|p| u16::from_be_bytes([p[0], p[1]])));
        }
        (ColorType::Grayscale, _) => words.extend(row.iter().map(|&level| of_png_grey(level))),
        (ColorType::GrayscaleAlpha, _) => {
            words.extend(row.chunks_exact(channels).map(|p| of_grey(p[0].into(), 255)));
        }
        (_, BitDepth::Sixteen) => {
            words.extend(row.chunks_exact(2 * channels).map(|p| of_colour(p[0], p[2])));
        }
        _ => words.extend(row.chunks_exact(channels).map(|p| of_colour(p[0], p[1]))),
    };
    let mut words = Vec::with_capacity(columns * rows);
    if is_interlaced {
        let Some(size) = reader.output_buffer_size() else { return fault("is too large") };
        let mut all = vec![0; size];
        if let Err(error) = reader.next_frame(&mut all) {
            return broken(error);
        }
        let line = size / rows;
        all.chunks_exact(line).for_each(|row| heights(row, &mut words));
    } else {
        loop {
            match reader.next_row() {
                Ok(Some(row)) => heights(row.data(), &mut words),
                Ok(None) => break,
                Err(error) => return broken(error),
            }
        }
    }
    Ok(Picture { columns, rows, words })
}

/// The first picture of a GIF file.
pub(super) fn gif(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
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
    let words = indices.into_iter().map(of_index).collect();
    Ok(Picture { columns, rows, words })
}

/// POT: a GIF file twice as wide as the picture.
pub(super) fn pot(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    let Picture { columns: whole, rows, words } = gif(bytes, may_hold)?;
    let columns = whole / 2;
    if columns == 0 {
        return fault("is no POT file: it has only one column");
    }
    let row = |row: &[u16]| -> Vec<u16> {
        row.iter().zip(&row[columns..]).take(columns).map(|(high, low)| high | low >> 8).collect()
    };
    let words = words.chunks_exact(whole).flat_map(row).collect();
    Ok(Picture { columns, rows, words })
}

/// JPEG.
pub(super) fn jpeg(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    use zune_jpeg::JpegDecoder;
    use zune_jpeg::zune_core::bytestream::ZCursor;
    use zune_jpeg::zune_core::colorspace::ColorSpace;
    use zune_jpeg::zune_core::options::DecoderOptions;
    let options =
        DecoderOptions::default().set_strict_mode(true).set_max_width(65_535).set_max_height(65_535);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    if let Err(error) = decoder.decode_headers() {
        return broken(error);
    }
    let Some(info) = decoder.info() else { return fault("has no header") };
    let (columns, rows) = (usize::from(info.width), usize::from(info.height));
    may_hold([columns, rows])?;
    let is_grey = info.components == 1;
    let colours = if is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
    decoder.set_options(options.jpeg_set_out_colorspace(colours));
    let pixels = decoder.decode().map_err(|error| Fault::Text(format!("cannot be unpacked: {error}")))?;
    let words: Vec<u16> = if is_grey {
        pixels.iter().map(|&value| of_grey(value.into(), 255)).collect()
    } else {
        pixels.chunks_exact(3).map(|p| of_colour(p[0], p[1])).collect()
    };
    if words.len() != columns * rows {
        return fault(format!("is not whole: of {} pixels {} are there", columns * rows, words.len()));
    }
    Ok(Picture { columns, rows, words })
}

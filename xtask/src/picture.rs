//! Pictures in memory: eight bits of red, green and blue per pixel.

use crate::Outcome;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

/// An 8-bit RGB picture, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// Reads a PNG. 16 bits become 8, grey becomes three channels, alpha is dropped.
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let fail = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let file = File::open(path).map_err(|e| fail(&e))?;
        let mut decoder = png::Decoder::new(BufReader::new(file));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|e| fail(&e))?;
        let size = reader.output_buffer_size().ok_or_else(|| fail(&"too large"))?;
        let mut bytes = vec![0; size];
        let frame = reader.next_frame(&mut bytes).map_err(|e| fail(&e))?;
        let samples = frame.color_type.samples();
        let pixels = bytes[..frame.buffer_size()]
            .chunks_exact(samples)
            .map(|p| if samples < 3 { [p[0]; 3] } else { [p[0], p[1], p[2]] })
            .collect();
        Ok(Self { width: frame.width, height: frame.height, pixels })
    }

    /// Writes a PNG.
    pub(crate) fn write(&self, path: &Path) -> Outcome {
        let fail = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let file = File::create(path).map_err(|e| fail(&e))?;
        let mut encoder = png::Encoder::new(BufWriter::new(file), self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header().map_err(|e| fail(&e))?;
        writer.write_image_data(self.pixels.as_flattened()).map_err(|e| fail(&e))
    }

    /// Whether the picture shows nothing: all pixels are within `contrast` of each other in every
    /// channel.
    pub(crate) fn is_blank(&self, contrast: u8) -> bool {
        (0..3).all(|c| {
            let channel = || self.pixels.iter().map(|p| p[c]);
            channel().max().unwrap_or(0) - channel().min().unwrap_or(0) <= contrast
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_survives_the_file() {
        let pixels = (0..12).map(|i| [i, 255 - i, 7 * i]).collect();
        let picture = Picture { width: 4, height: 3, pixels };
        let path = std::env::temp_dir().join(format!("durer-xtask-{}.png", std::process::id()));
        picture.write(&path).unwrap();
        assert_eq!(Picture::read(&path).unwrap(), picture);
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn one_visible_pixel_makes_a_picture_not_blank() {
        let mut picture = Picture { width: 2, height: 2, pixels: vec![[10; 3]; 4] };
        assert!(picture.is_blank(8));
        picture.pixels[3] = [10, 30, 10];
        assert!(!picture.is_blank(8));
    }
}

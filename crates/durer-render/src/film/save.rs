//! Saving a film as a file. The file is written under a temporary name in the same directory and
//! then renamed, so a half-written picture never has the picture's name.

use super::gamma::Bytes;
use super::{Colours, Depth, Film};
use durer_math::kernels::in_large_pages;
use durer_scene::Rgb;
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The kinds of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// PNG: sRGB, with an alpha channel if any pixel is clear.
    Png(Bits),
    /// OpenEXR: light as 32-bit floats.
    Exr,
    /// Portable pixmap (binary): sRGB, clear pixels black.
    Ppm(Bits),
}

/// The number of bits of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bits {
    /// 8 bits.
    #[default]
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Why a picture could not be saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The extension of the file's name names no known format.
    #[error("{}: the name of a picture must end in .png, .exr or .ppm", .0.display())]
    Ending(PathBuf),
    /// Writing failed.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The cause.
        #[source]
        source: io::Error,
    },
}

impl FileFormat {
    /// The format that the extension of a file's name stands for; case does not matter.
    pub fn of(path: &Path, bits: Bits) -> Result<Self, SaveError> {
        let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match ending.as_deref() {
            Some("png") => Ok(Self::Png(bits)),
            Some("exr") => Ok(Self::Exr),
            Some("ppm") => Ok(Self::Ppm(bits)),
            _ => Err(SaveError::Ending(path.to_owned())),
        }
    }

    /// The least depth of a film with which a file of this format loses nothing.
    pub fn depth(self) -> Depth {
        match self {
            Self::Png(Bits::Eight) | Self::Ppm(Bits::Eight) => Depth::Bytes,
            Self::Png(Bits::Sixteen) | Self::Ppm(Bits::Sixteen) | Self::Exr => Depth::Numbers,
        }
    }
}

impl Film {
    /// Writes the picture to `path`. A file with that name is replaced atomically, once the new
    /// file is complete. If anything fails, the old file is left as it was.
    pub fn save(&self, path: &Path, format: FileFormat) -> Result<(), SaveError> {
        let failed = |source| SaveError::Io { path: path.to_owned(), source };
        let mut name = std::ffi::OsString::from(".");
        name.push(path.file_name().ok_or_else(|| failed(io::ErrorKind::InvalidFilename.into()))?);
        name.push(format!(".{}.part", std::process::id()));
        let part = path.with_file_name(name);
        let written = self.write(&part, format).and_then(|()| fs::rename(&part, path));
        if written.is_err() {
            // Nothing more can be done if this fails too; the first error is reported.
            let _ = fs::remove_file(&part);
        }
        written.map_err(failed)
    }

    fn write(&self, path: &Path, format: FileFormat) -> io::Result<()> {
        let mut out = BufWriter::new(File::create(path)?);
        match format {
            FileFormat::Png(bits) => self.write_png(&mut out, bits)?,
            FileFormat::Ppm(bits) => self.write_ppm(&mut out, bits)?,
            FileFormat::Exr => self.write_exr(&mut out)?,
        }
        out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
    }

    /// The channels as integers of the given size, most significant byte first.
    pub(super) fn bytes(&self, bits: Bits, with_alpha: bool) -> Cow<'_, [u8]> {
        let opaque = match (bits, &self.colours) {
            (Bits::Sixteen, _) => return Cow::Owned(self.words(with_alpha)),
            (Bits::Eight, Colours::Bytes(colours, _)) => Cow::Borrowed(colours.as_flattened()),
            (Bits::Eight, Colours::Numbers(colours)) => {
                let mut bytes = vec![0; 3 * colours.len()];
                in_large_pages(&bytes);
                Bytes::new(self.encoding).of_all(colours.as_flattened(), &mut bytes);
                Cow::Owned(bytes)
            }
        };
        if !with_alpha {
            return opaque;
        }
        let pixels = opaque.as_chunks::<3>().0.iter().zip(&self.rendered);
        pixels.flat_map(|(&[r, g, b], &rendered)| [r, g, b, if rendered { 255 } else { 0 }]).collect()
    }

    /// The channels as 16-bit integers.
    fn words(&self, with_alpha: bool) -> Vec<u8> {
        let channels = if with_alpha { 4 } else { 3 };
        let mut bytes = Vec::with_capacity(self.rendered.len() * channels * 2);
        for pixel in self.pixels() {
            let Rgb { r, g, b } = pixel.rgb;
            let [r, g, b] = [r, g, b].map(|v| self.encoding.file(v));
            for v in &[r, g, b, pixel.alpha][..channels] {
                bytes.extend(((v * 65535.0 + 0.5) as u16).to_be_bytes());
            }
        }
        bytes
    }

    /// Writes a PNG file.
    pub fn write_png(&self, out: &mut impl Write, bits: Bits) -> io::Result<()> {
        let with_alpha = !self.is_complete();
        let mut encoder = png::Encoder::new(out, self.width, self.height);
        encoder.set_color(if with_alpha { png::ColorType::Rgba } else { png::ColorType::Rgb });
        encoder.set_depth(match bits {
            Bits::Eight => png::BitDepth::Eight,
            Bits::Sixteen => png::BitDepth::Sixteen,
        });
        // With the encoder's default, compression took 4 % of the time of a simple picture.
        encoder.set_compression(png::Compression::Fastest);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.bytes(bits, with_alpha))?;
        Ok(writer.finish()?)
    }

    /// Writes a binary PPM file.
    pub fn write_ppm(&self, out: &mut impl Write, bits: Bits) -> io::Result<()> {
        let most = match bits {
            Bits::Eight => 255,
            Bits::Sixteen => 65535,
        };
        write!(out, "P6\n{} {}\n{most}\n", self.width, self.height)?;
        out.write_all(&self.bytes(bits, false))
    }

    /// Writes an OpenEXR file.
    pub fn write_exr(&self, out: &mut (impl Write + io::Seek)) -> io::Result<()> {
        use exr::prelude::{Encoding, Image, LineOrder, SpecificChannels, WritableImage};
        // Without an order, compressed blocks are written as threads finish them.
        let encoding = Encoding { line_order: LineOrder::Increasing, ..Encoding::default() };
        let size = (self.width as usize, self.height as usize);
        let at = |p: exr::math::Vec2<usize>| {
            let pixel = self.at(p.y() * self.width as usize + p.x());
            let Rgb { r, g, b } = pixel.rgb;
            ([r, g, b].map(|v| self.encoding.light(v) as f32), pixel.alpha as f32)
        };
        let written = if self.is_complete() {
            let channels = SpecificChannels::rgb(|p| {
                let ([r, g, b], _) = at(p);
                (r, g, b)
            });
            Image::from_encoded_channels(size, encoding, channels).write().to_buffered(&mut *out)
        } else {
            let channels = SpecificChannels::rgba(|p| {
                // The format wants colours multiplied by the opacity.
                let ([r, g, b], a) = at(p);
                (r * a, g * a, b * a, a)
            });
            Image::from_encoded_channels(size, encoding, channels).write().to_buffered(&mut *out)
        };
        written.map_err(|e| match e {
            exr::error::Error::Io(e) => e,
            other => io::Error::other(other),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Encoding;
    use crate::settings::Region;

    #[test]
    fn the_same_film_is_the_same_file() {
        let mut film = Film::new(300, 200, Encoding::Srgb, Depth::Numbers);
        for (i, (x, y)) in (0..200).flat_map(|y| (0..300).map(move |x| (x, y))).enumerate() {
            film.set(x, y, Rgb::grey((i * i % 977) as f64 / 977.0));
        }
        film.set(300, 0, Rgb::WHITE); // outside
        let file = || {
            let mut file = io::Cursor::new(Vec::new());
            film.write_exr(&mut file).unwrap();
            file.into_inner()
        };
        let first = file();
        assert!((0..10).all(|_| file() == first));
    }

    fn film() -> Film {
        let mut film = Film::new(2, 1, Encoding::Srgb, Depth::Numbers);
        film.put(Region { x0: 0, y0: 0, x1: 2, y1: 1 }, &[Rgb::new(1.0, 0.5, 0.0), Rgb::grey(0.25)]);
        film
    }

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("durer-film-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_ppm_is_what_it_says() {
        let mut bytes = Vec::new();
        film().write_ppm(&mut bytes, Bits::Eight).unwrap();
        assert_eq!(bytes, b"P6\n2 1\n255\n\xff\x80\x00\x40\x40\x40");
        bytes.clear();
        film().write_ppm(&mut bytes, Bits::Sixteen).unwrap();
        assert_eq!(&bytes[..], b"P6\n2 1\n65535\n\xff\xff\x80\x00\x00\x00\x40\x00\x40\x00\x40\x00");
    }

    #[test]
    fn a_png_reads_back() {
        for (bits, film, want) in [
            (Bits::Eight, film(), &b"\xff\x80\x00\x40\x40\x40"[..]),
            (Bits::Eight, Film::new(1, 1, Encoding::Srgb, Depth::Numbers), &b"\0\0\0\0"[..]),
            (Bits::Sixteen, film(), &b"\xff\xff\x80\x00\x00\x00\x40\x00\x40\x00\x40\x00"[..]),
        ] {
            let mut bytes = Vec::new();
            film.write_png(&mut bytes, bits).unwrap();
            let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
            let mut image = vec![0; reader.output_buffer_size().unwrap()];
            let frame = reader.next_frame(&mut image).unwrap();
            assert_eq!(&image[..frame.buffer_size()], want);
        }
    }

    #[test]
    fn an_exr_holds_light() {
        let folder = folder("exr");
        let path = folder.join("a.exr");
        film().save(&path, FileFormat::Exr).unwrap();
        let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let red = image.layer_data.channel_data.list.iter().find(|c| c.name.eq("R")).unwrap();
        let values: Vec<f32> = red.sample_data.values_as_f32().collect();
        assert_eq!(values[0], 1.0);
        assert!((f64::from(values[1]) - Encoding::Srgb.light(0.25)).abs() < 1e-7);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn nothing_but_the_picture_is_left() {
        let folder = folder("left");
        film().save(&folder.join("a.png"), FileFormat::Png(Bits::Eight)).unwrap();
        let missing = folder.join("no such folder").join("b.png");
        assert!(matches!(film().save(&missing, FileFormat::Png(Bits::Eight)), Err(SaveError::Io { .. })));
        let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(names, ["a.png"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn endings_name_formats() {
        let of = |name: &str| FileFormat::of(Path::new(name), Bits::Eight);
        assert_eq!(of("a.PNG").unwrap(), FileFormat::Png(Bits::Eight));
        assert_eq!(of("b/c.exr").unwrap(), FileFormat::Exr);
        assert!(matches!(of("a.jpg"), Err(SaveError::Ending(_))));
        assert!(matches!(of("png"), Err(SaveError::Ending(_))));
    }
}

//! The film holds a picture in memory until it is saved as a file.

mod gamma;
mod save;

pub use self::gamma::{Bytes, Encoding};
pub use self::save::{Bits, FileFormat, SaveError};

use crate::settings::Region;
use durer_math::kernels::in_large_pages;
use durer_scene::Rgb;

/// A picture, row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    encoding: Encoding,
    /// Red, green and blue of each pixel.
    colours: Colours,
    /// Which pixels were rendered.
    rendered: Vec<bool>,
}

/// How much of each colour a film keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// The scene's own colour values, in full.
    #[default]
    Numbers,
    /// Only the bytes of an 8-bit file. This takes an eighth of the memory, and an 8-bit file that
    /// is saved from it is the same.
    Bytes,
}

#[derive(Clone, Debug, PartialEq)]
enum Colours {
    Numbers(Vec<[f64; 3]>),
    Bytes(Vec<[u8; 3]>, Box<Bytes>),
}

/// A pixel: its colour in the scene's own values, not multiplied by the opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Its colour.
    pub rgb: Rgb,
    /// 1 for a pixel that was rendered, 0 for one that was not.
    pub alpha: f64,
}

impl Film {
    /// Makes an empty film: every pixel is clear.
    pub fn new(width: u32, height: u32, encoding: Encoding, depth: Depth) -> Self {
        let size = width as usize * height as usize;
        // Plain numbers rather than a type of our own: the allocator provides zeroed memory, so
        // zeros need not be written.
        let colours = match depth {
            Depth::Numbers => {
                let colours = vec![[0.0; 3]; size];
                in_large_pages(&colours);
                Colours::Numbers(colours)
            }
            Depth::Bytes => Colours::Bytes(vec![[0; 3]; size], Box::new(Bytes::new(encoding))),
        };
        Self { width, height, encoding, colours, rendered: vec![false; size] }
    }

    /// The number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// How the film's colour values relate to light.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// All pixels, row by row from the top. If the film keeps only bytes, the colours are computed
    /// back from the bytes.
    pub fn pixels(&self) -> impl Iterator<Item = Pixel> {
        (0..self.rendered.len()).map(|i| self.at(i))
    }

    /// Pixel number `i`, counted row by row.
    fn at(&self, i: usize) -> Pixel {
        let [r, g, b] = match &self.colours {
            Colours::Numbers(colours) => colours[i],
            Colours::Bytes(colours, table) => colours[i].map(|byte| table.number(byte)),
        };
        Pixel { rgb: Rgb::new(r, g, b), alpha: if self.rendered[i] { 1.0 } else { 0.0 } }
    }

    /// The pixel in column `x` and row `y`; `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Pixel> {
        (x < self.width && y < self.height).then(|| self.at(y as usize * self.width as usize + x as usize))
    }

    /// The colour of a pixel as light: red, green and blue. Useful for measurements and linear
    /// files.
    pub fn light(&self, x: u32, y: u32) -> Option<[f64; 3]> {
        let rgb = self.pixel(x, y)?.rgb;
        Some([rgb.r, rgb.g, rgb.b].map(|v| self.encoding.light(v)))
    }

    /// Whether every pixel was rendered.
    pub fn is_complete(&self) -> bool {
        // All pixels of a chunk are tested without an early exit, which lets the compiler vectorise
        // the loop.
        let all = |part: &[bool]| part.iter().fold(true, |all, &rendered| all & rendered);
        self.rendered.chunks(256).all(all)
    }

    /// Stores the colour of the pixel in column `x` and row `y`; outside the picture nothing
    /// happens.
    pub fn set(&mut self, x: u32, y: u32, colour: Rgb) {
        if x < self.width && y < self.height {
            self.put(Region { x0: x, y0: y, x1: x + 1, y1: y + 1 }, &[colour]);
        }
    }

    /// Stores the pixels of `region`, row by row. There may be fewer pixels than the region has.
    pub(crate) fn put(&mut self, region: Region, pixels: &[Rgb]) {
        let columns = (region.x1 - region.x0) as usize;
        for (row, from) in (region.y0..region.y1).zip(pixels.chunks(columns)) {
            let start = row as usize * self.width as usize + region.x0 as usize;
            let places = start..start + from.len();
            match &mut self.colours {
                Colours::Numbers(colours) => {
                    for (colour, rgb) in colours[places.clone()].iter_mut().zip(from) {
                        *colour = [rgb.r, rgb.g, rgb.b];
                    }
                }
                Colours::Bytes(colours, table) => table.of_colours(from, &mut colours[places.clone()]),
            }
            self.rendered[places].fill(true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_numbers() {
        let colours: Vec<_> =
            (0..64).map(|i| Rgb::new(f64::from(i) / 60.0, 0.003 * f64::from(i), -0.1)).collect();
        for encoding in [Encoding::Linear, Encoding::Power(2.2), Encoding::Power(0.7), Encoding::Srgb] {
            let [numbers, bytes] = [Depth::Numbers, Depth::Bytes].map(|depth| {
                let mut film = Film::new(9, 9, encoding, depth);
                film.put(Region { x0: 1, y0: 0, x1: 9, y1: 8 }, &colours);
                film
            });
            assert_eq!(numbers.bytes(Bits::Eight, true), bytes.bytes(Bits::Eight, true));
            assert_eq!(numbers.bytes(Bits::Eight, false), bytes.bytes(Bits::Eight, false));
            // The colour values for bytes are written as those bytes.
            let mut again = Film::new(9, 9, encoding, Depth::Numbers);
            again.put(
                Region { x0: 0, y0: 0, x1: 9, y1: 9 },
                &bytes.pixels().map(|p| p.rgb).collect::<Vec<_>>(),
            );
            assert_eq!(again.bytes(Bits::Eight, false), bytes.bytes(Bits::Eight, false), "{encoding:?}");
        }
    }

    #[test]
    fn tiles_land_where_they_belong() {
        let mut film = Film::new(4, 3, Encoding::Linear, Depth::Numbers);
        let tile = Region { x0: 1, y0: 1, x1: 3, y1: 3 };
        film.put(tile, &[1.0, 2.0, 3.0, 4.0].map(Rgb::grey));
        let value = |x, y| film.pixel(x, y).map(|p| (p.rgb.r, p.alpha));
        assert_eq!(
            [value(0, 0), value(1, 1), value(2, 1)],
            [Some((0.0, 0.0)), Some((1.0, 1.0)), Some((2.0, 1.0))]
        );
        assert_eq!(
            [value(2, 2), value(3, 2), value(4, 0), value(0, 3)],
            [Some((4.0, 1.0)), Some((0.0, 0.0)), None, None]
        );
        assert!(!film.is_complete());
    }
}

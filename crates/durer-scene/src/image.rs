//! Pictures as parts of textures.

use std::sync::Arc;

use crate::Colour;

/// A picture: the colours of its pixels, and for a picture with a palette their numbers in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    columns: usize,
    rows: usize,
    pixels: Pixels,
}

#[derive(Clone, Debug, PartialEq)]
enum Pixels {
    /// Red, green, blue, filter, transmit.
    Colours(Vec<[f32; 5]>),
    Indexed(Vec<Colour>, Vec<u8>),
}

impl Image {
    /// Makes a picture of colours, row by row from the top left; `None` if their number is not
    /// `columns * rows`, or zero.
    pub fn from_colours(columns: usize, rows: usize, colours: Vec<[f32; 5]>) -> Option<Self> {
        let fits = !colours.is_empty() && columns.checked_mul(rows) == Some(colours.len());
        fits.then_some(Self { columns, rows, pixels: Pixels::Colours(colours) })
    }

    /// Makes a picture of indices into a palette, row by row from the top left; `None` if their
    /// number is not `columns * rows`, or zero, or the palette has not 256 colours.
    pub fn from_indices(columns: usize, rows: usize, palette: Vec<Colour>, indices: Vec<u8>) -> Option<Self> {
        let fits = !indices.is_empty() && columns.checked_mul(rows) == Some(indices.len());
        let whole = palette.len() == 256;
        (fits && whole).then_some(Self { columns, rows, pixels: Pixels::Indexed(palette, indices) })
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Whether it has a palette.
    pub fn has_palette(&self) -> bool {
        matches!(self.pixels, Pixels::Indexed(..))
    }

    /// Whether no light passes at any pixel.
    pub fn is_opaque(&self) -> bool {
        match &self.pixels {
            Pixels::Colours(colours) => colours.iter().all(|c| c[3] == 0.0 && c[4] == 0.0),
            Pixels::Indexed(palette, _) => palette.iter().all(|c| c.filter == 0.0 && c.transmit == 0.0),
        }
    }

    /// The colour of the pixel in a column, and a row counted from the top; both inside the picture.
    pub fn colour(&self, column: usize, row: usize) -> Colour {
        let at = row * self.columns + column;
        match &self.pixels {
            Pixels::Colours(colours) => Colour::from_terms(colours[at].map(f64::from)),
            Pixels::Indexed(palette, indices) => palette[usize::from(indices[at])],
        }
    }

    /// The index of the pixel in the palette; without a palette, its red as a number from 0 to 255.
    pub fn index(&self, column: usize, row: usize) -> usize {
        let at = row * self.columns + column;
        match &self.pixels {
            Pixels::Colours(colours) => (colours[at][0].clamp(0.0, 1.0) * 255.0) as usize,
            Pixels::Indexed(_, indices) => usize::from(indices[at]),
        }
    }
}

/// A picture in space.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageMap {
    /// The picture.
    pub image: Arc<Image>,
    /// How it lies in space.
    pub layout: Layout,
    /// Whether it is there once, and not repeated side by side.
    pub once: bool,
    /// The interpolation between the centres of pixels.
    pub between: Between,
}

/// How a picture lies in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// On the unit square of the xy plane, and extended along z.
    #[default]
    Flat,
    /// On a sphere about the origin, by longitude around y and latitude.
    Sphere,
    /// Around the y axis, one unit high.
    Cylinder,
    /// On tori with the major radius 1 about the y axis.
    Torus,
}

/// The interpolation between the centres of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// The nearest pixel.
    #[default]
    Nearest,
    /// A mixture of four pixels that is linear along both axes.
    Linear,
    /// A mixture of 16 pixels that is cubic along both axes.
    Cubic,
    /// A mixture of four pixels by their distances.
    Distance,
}

/// The number that a picture gives at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageValue {
    /// The grey value of the colour.
    Grey,
    /// The index in the palette, divided by 255; for bumps the index itself.
    Index,
    /// The opacity.
    Alpha,
}

//! The settings of a rendering.

use crate::film::Depth;

/// The settings of a rendering: size, anti-aliasing, region, threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// The number of columns; at least 1.
    pub width: u32,
    /// The number of rows; at least 1.
    pub height: u32,
    /// How the rays of pixels are chosen.
    pub anti_aliasing: AntiAliasing,
    /// The part of the picture to render; all of it if absent.
    pub region: Option<Region>,
    /// How much of each colour the film keeps.
    pub depth: Depth,
    /// The number of threads. If absent, it is the number of processors, or the size of the
    /// surrounding thread pool. The picture does not depend on it.
    pub threads: Option<usize>,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            anti_aliasing: AntiAliasing::Off,
            region: None,
            depth: Depth::Numbers,
            threads: None,
        }
    }
}

/// The pixels with `x0 <= x < x1` and `y0 <= y < y1`, counted from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The first column.
    pub x0: u32,
    /// The first row.
    pub y0: u32,
    /// The column after the last.
    pub x1: u32,
    /// The row after the last.
    pub y1: u32,
}

impl Region {
    /// The part of this region that lies in a picture of this size; it may be empty.
    #[must_use]
    pub fn within(self, width: u32, height: u32) -> Self {
        let (x1, y1) = (self.x1.min(width), self.y1.min(height));
        Self { x0: self.x0.min(x1), y0: self.y0.min(y1), x1, y1 }
    }

    /// The number of pixels.
    pub fn pixels(self) -> u64 {
        u64::from(self.x1.saturating_sub(self.x0)) * u64::from(self.y1.saturating_sub(self.y0))
    }
}

/// How the rays of pixels are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AntiAliasing {
    /// One ray through the middle of each pixel.
    Off,
    /// `depth x depth` more rays for pixels that differ from their left or upper neighbour.
    Method1 {
        /// The least difference for more rays: the sum of the differences of all channels as a
        /// screen of gamma 2.5 shows them.
        threshold: f64,
        /// Rays per pixel along each axis.
        depth: u32,
    },
    /// Pixels are divided into four where their corners differ, recursively.
    Method2 {
        /// The least difference for a division, as for `Method1`.
        threshold: f64,
        /// The greatest number of divisions.
        depth: u32,
    },
    /// `n x n` rays for every pixel, evenly spread.
    Grid(
        /// Rays per pixel along each axis.
        u32,
    ),
}

impl AntiAliasing {
    /// The default threshold of both methods.
    pub const THRESHOLD: f64 = 0.3;
    /// The default depth of both methods.
    pub const DEPTH: u32 = 3;
    /// The greatest depth. 512 rays along a pixel's side are more than any use needs.
    pub const MAX_DEPTH: u32 = 9;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_cut_to_the_picture() {
        let region = Region { x0: 5, y0: 2, x1: 50, y1: 4 };
        assert_eq!(region.within(10, 10), Region { x0: 5, y0: 2, x1: 10, y1: 4 });
        assert_eq!(region.within(10, 10).pixels(), 10);
        assert_eq!(region.within(3, 3).pixels(), 0);
    }
}

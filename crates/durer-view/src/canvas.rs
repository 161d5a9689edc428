//! The pixels so far as a browser shows them, and what each browser has seen of them.
//!
//! The picture is divided into tiles. Each tile has a version, which grows with every change, and
//! each browser has a list of the versions that were sent to it. So what is kept for a browser has
//! a fixed size, and a slow browser skips what is out of date.

use durer_render::Region;

/// Tiles are squares of this many pixels.
pub(crate) const TILE: u32 = 32;

/// The spacing of the pixels that a pass has computed: columns and rows.
pub(crate) type Step = (u32, u32);

/// The picture as bytes.
#[derive(Debug)]
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    rgb: Vec<[u8; 3]>,
    tiles: Vec<Tile>,
    version: u64,
}

#[derive(Clone, Copy, Debug)]
struct Tile {
    version: u64,
    /// The generation of the picture that its pixels belong to.
    generation: u64,
    step: Step,
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let tiles = width.div_ceil(TILE) as usize * height.div_ceil(TILE) as usize;
        Self {
            width,
            height,
            rgb: vec![[0; 3]; width as usize * height as usize],
            tiles: vec![Tile { version: 0, generation: 0, step: (1, 1) }; tiles],
            version: 0,
        }
    }

    /// Stores colours of pixels.
    pub(crate) fn put(&mut self, pixels: &[(u32, u32)], colours: &[[u8; 3]]) {
        for (&(x, y), &colour) in pixels.iter().zip(colours) {
            self.rgb[y as usize * self.width as usize + x as usize] = colour;
        }
    }

    /// Marks the tiles of a region as changed in this generation. Every `step`-th pixel of them is
    /// known.
    pub(crate) fn mark(&mut self, region: Region, step: Step, generation: u64) {
        self.version += 1;
        let columns = self.width.div_ceil(TILE);
        for ty in region.y0 / TILE..region.y1.div_ceil(TILE) {
            for tx in region.x0 / TILE..region.x1.div_ceil(TILE) {
                let tile = &mut self.tiles[(ty * columns + tx) as usize];
                *tile = Tile { version: self.version, generation, step };
            }
        }
    }

    /// Appends tiles that differ from those in `seen`, until the message has `enough` bytes, and
    /// notes them in `seen`. Each tile is its place (`x`, `y` as 16 bits, least significant byte
    /// first), its size and its step (columns, rows; one byte each), and the colours of every
    /// `step`-th pixel, row by row. Returns the newest generation among them.
    pub(crate) fn news(&self, seen: &mut Seen, enough: usize, message: &mut Vec<u8>) -> u64 {
        let mut generation = 0;
        seen.0.resize(self.tiles.len(), 0);
        for (i, (tile, seen)) in self.tiles.iter().zip(&mut seen.0).enumerate() {
            if tile.version == *seen {
                continue;
            }
            if message.len() >= enough {
                break;
            }
            *seen = tile.version;
            generation = generation.max(tile.generation);
            self.append(i, tile.step, message);
        }
        generation
    }

    /// Appends all tiles so far, coarsely, for a browser that has seen none. Returns the newest
    /// generation among them.
    pub(crate) fn preview(&self, message: &mut Vec<u8>) -> u64 {
        let mut generation = 0;
        for (i, tile) in self.tiles.iter().enumerate().filter(|(_, tile)| tile.version > 0) {
            generation = generation.max(tile.generation);
            self.append(i, (8, 8), message);
        }
        generation
    }

    /// Appends every `step`-th pixel of a tile.
    fn append(&self, tile: usize, step: Step, message: &mut Vec<u8>) {
        let columns = self.width.div_ceil(TILE);
        let (x0, y0) = (tile as u32 % columns * TILE, tile as u32 / columns * TILE);
        let (x1, y1) = ((x0 + TILE).min(self.width), (y0 + TILE).min(self.height));
        message.extend((x0 as u16).to_le_bytes());
        message.extend((y0 as u16).to_le_bytes());
        message.extend([x1 - x0, y1 - y0, step.0, step.1].map(|n| n as u8));
        for y in (y0..y1).step_by(step.1 as usize) {
            let row = y as usize * self.width as usize;
            for x in (x0..x1).step_by(step.0 as usize) {
                message.extend(self.rgb[row + x as usize]);
            }
        }
    }
}

/// The versions of the tiles that a browser has.
#[derive(Debug, Default)]
pub(crate) struct Seen(Vec<u64>);

/// The regions of a picture, `side` pixels wide and high, row by row.
pub(crate) fn regions(width: u32, height: u32, side: u32) -> Vec<Region> {
    let mut regions = Vec::new();
    for y0 in (0..height).step_by(side as usize) {
        for x0 in (0..width).step_by(side as usize) {
            regions.push(Region { x0, y0, x1: (x0 + side).min(width), y1: (y0 + side).min(height) });
        }
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_browser_gets_each_change_once() {
        let mut canvas = Canvas::new(70, 40);
        let mut seen = Seen::default();
        let mut message = Vec::new();
        canvas.news(&mut seen, 1 << 20, &mut message);
        assert!(message.is_empty());
        canvas.put(&[(64, 32)], &[[1, 2, 3]]);
        canvas.mark(Region { x0: 64, y0: 32, x1: 70, y1: 40 }, (8, 8), 7);
        assert_eq!(canvas.news(&mut seen, 1 << 20, &mut message), 7);
        assert_eq!(message, [64, 0, 32, 0, 6, 8, 8, 8, 1, 2, 3]);
        message.clear();
        canvas.news(&mut seen, 1 << 20, &mut message);
        assert!(message.is_empty());
    }

    #[test]
    fn messages_are_bounded_and_nothing_is_lost() {
        let mut canvas = Canvas::new(320, 320);
        canvas.mark(Region { x0: 0, y0: 0, x1: 320, y1: 320 }, (1, 1), 1);
        let (mut seen, mut bytes, mut messages) = (Seen::default(), 0, 0);
        loop {
            let mut message = Vec::new();
            canvas.news(&mut seen, 10_000, &mut message);
            if message.is_empty() {
                break;
            }
            assert!(message.len() < 10_000 + 3 * 32 * 32 + 8);
            bytes += message.len();
            messages += 1;
        }
        assert_eq!((bytes, messages > 20), (100 * (8 + 3 * 32 * 32), true));
    }

    #[test]
    fn a_late_browser_first_sees_everything_coarsely() {
        let mut canvas = Canvas::new(64, 32);
        let mut message = Vec::new();
        assert_eq!((canvas.preview(&mut message), message.len()), (0, 0));
        canvas.mark(Region { x0: 0, y0: 0, x1: 64, y1: 32 }, (1, 1), 3);
        assert_eq!((canvas.preview(&mut message), message.len()), (3, 2 * (8 + 16 * 3)));
    }

    #[test]
    fn regions_cover_each_pixel_once() {
        let all: u64 = regions(100, 71, 32).into_iter().map(Region::pixels).sum();
        assert_eq!(all, 7100);
    }
}

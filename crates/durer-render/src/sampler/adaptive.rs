//! The scene language's two methods of adaptive anti-aliasing.

use super::jitter::random;
use super::{ENOUGH, Look, Place, in_blocks, middle};
use crate::settings::Region;
use durer_math::elementary;
use durer_scene::Rgb;

/// The gamma of the screen for which colours are compared.
const SCREEN_GAMMA: f64 = 2.5;

/// The colour as the screen shows it.
fn shown(c: Rgb) -> Rgb {
    c.map(|v| if v > 0.0 { elementary::pow(v.min(1.0), 1.0 / SCREEN_GAMMA) } else { 0.0 })
}

/// The sum of the differences of all channels of two shown colours.
fn difference(a: Rgb, b: Rgb) -> f64 {
    let d = a.zip(b, |a, b| (a - b).abs());
    d.r + d.g + d.b
}

/// The non-recursive method. The middle of each pixel is compared with the middles of its left and
/// upper neighbours. Both pixels of a pair that differs get `depth x depth` more rays, jittered,
/// which are averaged with the middle.
///
/// Neighbours outside the tile are traced again for comparison, and a pixel at the tile's right or
/// lower side is also compared with the middle beyond it. So the picture does not depend on its
/// division into tiles.
pub(super) fn method1(
    threshold: f64,
    depth: u32,
    tile: Region,
    (width, height): (u32, u32),
    pixels: &mut Vec<Rgb>,
    look: &mut impl Look,
) -> Option<()> {
    let (columns, rows) = ((tile.x1 - tile.x0) as usize, (tile.y1 - tile.y0) as usize);
    // One more pixel on every side. At the edge of the picture, its outermost pixels are repeated.
    let place = |first: u32, i: usize, size: u32| {
        (f64::from(first) + i as f64 - 0.5).clamp(0.5, f64::from(size) - 0.5)
    };
    let order = in_blocks(columns + 2, rows + 2);
    let places: Vec<_> = order
        .iter()
        .map(|&(x, y)| Place { x: place(tile.x0, x, width), y: place(tile.y0, y, height) })
        .collect();
    let mut colours = Vec::new();
    look(&places, &mut colours)?;
    let stride = columns + 2;
    let mut middles = vec![(Rgb::BLACK, Rgb::BLACK); stride * (rows + 2)];
    for (&(x, y), &colour) in order.iter().zip(&colours) {
        middles[y * stride + x] = (colour, shown(colour));
    }
    // The pixels from this one on wait for the colours of their additional rays.
    let mut first = 0;
    let (mut rough, mut places) = (Vec::new(), Vec::new());
    let mut row = Vec::new();
    for number in 0..columns * rows {
        let (x, y) = (number % columns, number / columns);
        let at = (y + 1) * stride + x + 1;
        let (colour, here) = middles[at];
        let around = [at - 1, at + 1, at - stride, at + stride];
        row.push(colour);
        if around.iter().any(|&i| difference(here, middles[i].1) >= threshold) {
            rough.push(number);
            finer(depth, tile.x0 + x as u32, tile.y0 + y as u32, &mut places);
        }
        if places.len() >= ENOUGH || number + 1 == columns * rows {
            look(&places, &mut colours)?;
            for (&number, colours) in rough.iter().zip(colours.chunks((depth * depth) as usize)) {
                let sum = colours.iter().fold(row[number - first], |sum, &c| sum + c);
                row[number - first] = sum * (1.0 / f64::from(depth * depth + 1));
            }
            pixels.append(&mut row);
            rough.clear();
            places.clear();
            first = number + 1;
        }
    }
    Some(())
}

/// Adds the places of a pixel's additional rays.
fn finer(depth: u32, x: u32, y: u32, places: &mut Vec<Place>) {
    let per = 1.0 / f64::from(depth);
    for j in 0..depth {
        for i in 0..depth {
            let (pixel, sample) = (u64::from(y) << 32 | u64::from(x), u64::from(j * depth + i));
            let shift = |dimension| random(pixel, sample, dimension) - 0.5;
            places.push(Place {
                x: f64::from(x) + (middle(i) + shift(0)) * per,
                y: f64::from(y) + (middle(j) + shift(1)) * per,
            });
        }
    }
}

/// The recursive method. A pixel is the mean of its corners, or of its four quarters if any two
/// corners differ.
///
/// Corners are jittered by up to half a cell of the finest grid. The shift depends on the corner's
/// position, so that neighbours share it.
pub(super) fn method2(
    threshold: f64,
    depth: u32,
    tile: Region,
    pixels: &mut Vec<Rgb>,
    look: &mut impl Look,
) -> Option<()> {
    /// The number of corners that are stored at once.
    const MOST: usize = 1 << 18;
    let cells = 1_usize << depth;
    let columns = (tile.x1 - tile.x0) as usize;
    let side = columns * cells + 1;
    let together = (MOST / (side * cells)).clamp(1, (tile.y1 - tile.y0) as usize) as u32;
    let mut corners = Corners { threshold, side, known: Vec::new(), colours: Vec::new(), asked: Vec::new() };
    let mut seen = Vec::new();
    let mut y0 = tile.y0;
    while y0 < tile.y1 {
        let rows = together.min(tile.y1 - y0) as usize;
        corners.forget(rows * cells + 1);
        let mut squares = in_blocks(columns, rows);
        squares.iter_mut().for_each(|(i, j)| (*i, *j) = (*i * cells, *j * cells));
        let mut size = cells;
        // All squares of one size, then those of half the size into which some of them were
        // divided.
        while !squares.is_empty() {
            for &(i, j) in &squares {
                for (i, j) in [(i, j), (i + size, j), (i, j + size), (i + size, j + size)] {
                    corners.ask(i, j);
                }
            }
            let (left, top) = (u64::from(tile.x0) * cells as u64, u64::from(y0) * cells as u64);
            let place = |&(i, j): &(usize, usize)| {
                let (x, y) = (left + i as u64, top + j as u64);
                let shift = |dimension| random(x, y, dimension) - 0.5;
                let per = 1.0 / cells as f64;
                Place { x: (x as f64 + shift(0)) * per, y: (y as f64 + shift(1)) * per }
            };
            let places: Vec<_> = corners.asked.drain(..).map(|at| place(&at)).collect();
            look(&places, &mut seen)?;
            corners.colours.extend(seen.iter().map(|&c| (c, shown(c))));
            squares.retain(|&(i, j)| corners.is_cut(i, j, size));
            size /= 2;
            squares = squares
                .iter()
                .flat_map(|&(i, j)| [(i, j), (i + size, j), (i, j + size), (i + size, j + size)])
                .collect();
        }
        for y in 0..rows {
            pixels.extend((0..columns).map(|x| corners.mean(x * cells, y * cells, cells)));
        }
        y0 += rows as u32;
    }
    Some(())
}

/// The corners of the finest cells of some pixels.
struct Corners {
    threshold: f64,
    /// The number of corners in a row.
    side: usize,
    /// For each corner, one more than the index of its colour, or 0.
    known: Vec<u32>,
    /// The colour, and the colour as the screen shows it.
    colours: Vec<(Rgb, Rgb)>,
    /// The corners whose colours are requested next.
    asked: Vec<(usize, usize)>,
}

impl Corners {
    fn forget(&mut self, rows: usize) {
        self.known.clear();
        self.known.resize(self.side * rows, 0);
        self.colours.clear();
    }

    fn ask(&mut self, i: usize, j: usize) {
        let known = &mut self.known[j * self.side + i];
        if *known == 0 {
            self.asked.push((i, j));
            *known = (self.colours.len() + self.asked.len()) as u32;
        }
    }

    /// The corners of the square of `size` cells whose upper left corner is (i, j).
    fn around(&self, i: usize, j: usize, size: usize) -> [(Rgb, Rgb); 4] {
        let at = |i, j| self.colours[self.known[j * self.side + i] as usize - 1];
        [at(i, j), at(i + size, j), at(i, j + size), at(i + size, j + size)]
    }

    /// Whether a square is divided into four.
    fn is_cut(&self, i: usize, j: usize, size: usize) -> bool {
        let corners = self.around(i, j, size);
        let differ = |a: usize| (a + 1..4).any(|b| difference(corners[a].1, corners[b].1) >= self.threshold);
        size > 1 && (0..3).any(differ)
    }

    /// The mean over a square.
    fn mean(&self, i: usize, j: usize, size: usize) -> Rgb {
        if self.is_cut(i, j, size) {
            let half = size / 2;
            let upper = self.mean(i, j, half) + self.mean(i + half, j, half);
            let lower = self.mean(i, j + half, half) + self.mean(i + half, j + half, half);
            return (upper + lower) * 0.25;
        }
        let corners = self.around(i, j, size);
        (corners[0].0 + corners[1].0 + corners[2].0 + corners[3].0) * 0.25
    }
}

//! The scene language's two ways to spend rays where pixels differ.

use super::jitter::random;
use super::middle;
use crate::settings::Region;
use durer_math::elementary;
use durer_scene::Rgb;

/// Colours are compared as a screen shows them.
const SCREEN_GAMMA: f64 = 2.5;

/// What the screen shows.
fn shown(c: Rgb) -> Rgb {
    c.map(|v| if v > 0.0 { elementary::pow(v.min(1.0), 1.0 / SCREEN_GAMMA) } else { 0.0 })
}

/// The sum of the differences of all channels of two shown colours.
fn difference(a: Rgb, b: Rgb) -> f64 {
    let d = a.zip(b, |a, b| (a - b).abs());
    d.r + d.g + d.b
}

/// Non-recursive: each pixel's middle is compared with its left and its upper neighbour's; both of a pair that differs get
/// `depth x depth` more rays, jittered, which are averaged with the middle.
///
/// Neighbours outside the tile are traced once more for comparison, and a pixel at the tile's right or lower side looks at the middle beyond
/// it too, so that the picture does not depend on how it is cut.
pub(super) fn method1(
    threshold: f64,
    depth: u32,
    tile: Region,
    (width, height): (u32, u32),
    pixels: &mut Vec<Rgb>,
    look: &mut impl FnMut(f64, f64) -> Option<Rgb>,
) -> Option<()> {
    let (columns, rows) = ((tile.x1 - tile.x0) as usize, (tile.y1 - tile.y0) as usize);
    // One more pixel on every side; beyond the picture its outermost pixels are repeated.
    let mut middles = Vec::with_capacity((columns + 2) * (rows + 2));
    for y in 0..rows + 2 {
        for x in 0..columns + 2 {
            let place = |first: u32, i: usize, size: u32| {
                (f64::from(first) + i as f64 - 0.5).clamp(0.5, f64::from(size) - 0.5)
            };
            let colour = look(place(tile.x0, x, width), place(tile.y0, y, height))?;
            middles.push((colour, shown(colour)));
        }
    }
    let stride = columns + 2;
    for y in 0..rows {
        for x in 0..columns {
            let at = (y + 1) * stride + x + 1;
            let (colour, here) = middles[at];
            let around = [at - 1, at + 1, at - stride, at + stride];
            let rough = around.iter().any(|&i| difference(here, middles[i].1) >= threshold);
            pixels.push(if rough {
                finer(depth, colour, tile.x0 + x as u32, tile.y0 + y as u32, look)?
            } else {
                colour
            });
        }
    }
    Some(())
}

fn finer(
    depth: u32,
    first: Rgb,
    x: u32,
    y: u32,
    look: &mut impl FnMut(f64, f64) -> Option<Rgb>,
) -> Option<Rgb> {
    let per = 1.0 / f64::from(depth);
    let mut sum = first;
    for j in 0..depth {
        for i in 0..depth {
            let (pixel, sample) = (u64::from(y) << 32 | u64::from(x), u64::from(j * depth + i));
            let shift = |dimension| random(pixel, sample, dimension) - 0.5;
            sum += look(
                f64::from(x) + (middle(i) + shift(0)) * per,
                f64::from(y) + (middle(j) + shift(1)) * per,
            )?;
        }
    }
    Some(sum * (1.0 / f64::from(depth * depth + 1)))
}

/// Recursive: a pixel is the mean of its corners, or of its four quarters where any two corners differ.
///
/// Corners are jittered by up to half a cell of the finest grid; the shift depends on the corner's place, so that neighbours share it.
pub(super) fn method2(
    threshold: f64,
    depth: u32,
    tile: Region,
    pixels: &mut Vec<Rgb>,
    look: &mut impl FnMut(f64, f64) -> Option<Rgb>,
) -> Option<()> {
    let cells = 1_usize << depth;
    let columns = (tile.x1 - tile.x0) as usize;
    let mut corner = |x: u64, y: u64| {
        let shift = |dimension| random(x, y, dimension) - 0.5;
        let per = 1.0 / cells as f64;
        let colour = look((x as f64 + shift(0)) * per, (y as f64 + shift(1)) * per)?;
        Some((colour, shown(colour)))
    };
    let side = cells + 1;
    let mut known: Vec<Option<(Rgb, Rgb)>> = vec![None; side * side];
    // The lower corners of the row above, and the right ones of the pixel before, serve again.
    let mut above: Vec<Option<(Rgb, Rgb)>> = vec![None; columns * cells + 1];
    let mut left = vec![None; side];
    for y in tile.y0..tile.y1 {
        for x in tile.x0..tile.x1 {
            let first = (x - tile.x0) as usize * cells;
            known.fill(None);
            known[..side].copy_from_slice(&above[first..first + side]);
            if x > tile.x0 {
                // Its first one too: the pixel before has written its lower corner over it.
                for (row, corner) in left.iter().enumerate() {
                    known[row * side] = *corner;
                }
            }
            let mut pixel = Quarters {
                threshold,
                side,
                known: &mut known,
                corner: |i: usize, j: usize| {
                    corner(u64::from(x) * cells as u64 + i as u64, u64::from(y) * cells as u64 + j as u64)
                },
            };
            pixels.push(pixel.mean(0, 0, cells)?);
            for (row, corner) in left.iter_mut().enumerate() {
                *corner = known[row * side + cells];
            }
            above[first..first + side].copy_from_slice(&known[cells * side..]);
        }
    }
    Some(())
}

/// A pixel being cut into four.
struct Quarters<'a, F> {
    threshold: f64,
    side: usize,
    known: &'a mut [Option<(Rgb, Rgb)>],
    corner: F,
}

impl<F: FnMut(usize, usize) -> Option<(Rgb, Rgb)>> Quarters<'_, F> {
    fn at(&mut self, i: usize, j: usize) -> Option<(Rgb, Rgb)> {
        let index = j * self.side + i;
        if let Some(colour) = self.known[index] {
            return Some(colour);
        }
        self.known[index] = Some((self.corner)(i, j)?);
        self.known[index]
    }

    /// The mean over the square of `size` cells with its upper left corner at (i, j).
    fn mean(&mut self, i: usize, j: usize, size: usize) -> Option<Rgb> {
        let corners =
            [self.at(i, j)?, self.at(i + size, j)?, self.at(i, j + size)?, self.at(i + size, j + size)?];
        let differ = |a: usize| (a + 1..4).any(|b| difference(corners[a].1, corners[b].1) >= self.threshold);
        if size > 1 && (0..3).any(differ) {
            let half = size / 2;
            let upper = self.mean(i, j, half)? + self.mean(i + half, j, half)?;
            let lower = self.mean(i, j + half, half)? + self.mean(i + half, j + half, half)?;
            return Some((upper + lower) * 0.25);
        }
        Some((corners[0].0 + corners[1].0 + corners[2].0 + corners[3].0) * 0.25)
    }
}

//! Samplers choose the rays of a pixel and combine their colours.
//!
//! Every sample depends only on its position in the picture, so tiles may be rendered in any order
//! and by any thread. Many rays are requested at a time, neighbours after each other, because
//! consecutive rays are traced together.

mod adaptive;
mod jitter;

pub(crate) use self::jitter::random;

use crate::settings::{AntiAliasing, Region};
use durer_scene::Rgb;

/// A point of the picture, in pixels from the top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

/// Computes the colours at some places, in their order; `None` ends the work.
pub(crate) trait Look: FnMut(&[Place], &mut Vec<Rgb>) -> Option<()> {}
impl<F: FnMut(&[Place], &mut Vec<Rgb>) -> Option<()>> Look for F {}

/// Limits the depth of the grid and of both methods, so that no setting takes years.
fn bounded(depth: u32) -> u32 {
    depth.clamp(1, AntiAliasing::MAX_DEPTH)
}

/// No more places are added to a request with this many.
const ENOUGH: usize = 4096;

/// Neighbours are grouped in squares with this many pixels on a side.
const BLOCK: usize = 8;

/// Renders the pixels of `tile`, a part of a picture of the given size, row by row. `look` computes
/// the colours at some places, in their order.
///
/// If `look` returns `None`, the work ends and only the pixels finished before are returned.
pub(crate) fn sample_tile(
    aa: AntiAliasing,
    tile: Region,
    picture: (u32, u32),
    mut look: impl FnMut(&[Place], &mut Vec<Rgb>) -> Option<()>,
) -> Vec<Rgb> {
    let mut pixels = Vec::with_capacity(tile.pixels() as usize);
    let _: Option<()> = match aa {
        AntiAliasing::Off => grid(1, tile, &mut pixels, &mut look),
        AntiAliasing::Grid(n) => grid(n.clamp(1, 1 << AntiAliasing::MAX_DEPTH), tile, &mut pixels, &mut look),
        AntiAliasing::Method1 { threshold, depth } => {
            adaptive::method1(threshold, bounded(depth), tile, picture, &mut pixels, &mut look)
        }
        AntiAliasing::Method2 { threshold, depth } => {
            adaptive::method2(threshold, bounded(depth), tile, &mut pixels, &mut look)
        }
    };
    pixels
}

fn middle(x: u32) -> f64 {
    f64::from(x) + 0.5
}

/// The columns and rows of an area, block by block.
fn in_blocks(columns: usize, rows: usize) -> Vec<(usize, usize)> {
    let mut places = Vec::with_capacity(columns * rows);
    for y0 in (0..rows).step_by(BLOCK) {
        for x0 in (0..columns).step_by(BLOCK) {
            for y in y0..(y0 + BLOCK).min(rows) {
                places.extend((x0..(x0 + BLOCK).min(columns)).map(|x| (x, y)));
            }
        }
    }
    places
}

/// A pixel of an area.
#[derive(Clone, Copy)]
struct Cell {
    /// Its upper left corner, relative to that of the area.
    corner: Place,
    /// Its index, row by row.
    number: usize,
}

/// The pixels of an area, block by block.
fn cells(columns: usize, rows: usize) -> Vec<Cell> {
    let cell = |(x, y)| Cell { corner: Place { x: x as f64, y: y as f64 }, number: y * columns + x };
    in_blocks(columns, rows).into_iter().map(cell).collect()
}

/// The uniform grid: each pixel is the mean of `n x n` evenly spread rays.
fn grid(n: u32, tile: Region, pixels: &mut Vec<Rgb>, look: &mut impl Look) -> Option<()> {
    let per = 1.0 / f64::from(n);
    let rays = (n * n) as usize;
    let shifts: Vec<_> =
        (0..n).flat_map(|j| (0..n).map(move |i| Place { x: middle(i) * per, y: middle(j) * per })).collect();
    let columns = (tile.x1 - tile.x0) as usize;
    let (mut places, mut colours, mut strip) = (Vec::new(), Vec::new(), Vec::new());
    let mut order = Vec::new();
    let mut y0 = tile.y0;
    while y0 < tile.y1 {
        // With many rays per pixel, one row is enough.
        let rows = if rays == 1 { tile.y1 - y0 } else { 1 } as usize;
        strip.resize(columns * rows, Rgb::BLACK);
        if order.len() != strip.len() {
            order = cells(columns, rows);
        }
        for some in order.chunks(ENOUGH.div_ceil(rays)) {
            places.clear();
            if rays == 1 {
                // Sums of integers and halves of this size are exact.
                let (x, y) = (middle(tile.x0), middle(y0));
                places.extend(some.iter().map(|c| Place { x: c.corner.x + x, y: c.corner.y + y }));
                look(&places, &mut colours)?;
                for (cell, &colour) in some.iter().zip(&colours) {
                    strip[cell.number] = colour;
                }
                continue;
            }
            for Cell { corner, .. } in some {
                let (x, y) = (f64::from(tile.x0) + corner.x, f64::from(y0) + corner.y);
                places.extend(shifts.iter().map(|shift| Place { x: x + shift.x, y: y + shift.y }));
            }
            look(&places, &mut colours)?;
            for (cell, colours) in some.iter().zip(colours.chunks_exact(rays)) {
                let sum = colours.iter().fold(Rgb::BLACK, |sum, &c| sum + c);
                strip[cell.number] = sum * (per * per);
            }
        }
        pixels.append(&mut strip);
        y0 += rows as u32;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TILE: Region = Region { x0: 2, y0: 1, x1: 6, y1: 4 };

    /// Renders every place with one ray.
    fn each(
        mut look: impl FnMut(f64, f64) -> Option<Rgb>,
    ) -> impl FnMut(&[Place], &mut Vec<Rgb>) -> Option<()> {
        move |places, colours| {
            colours.clear();
            for place in places {
                colours.push(look(place.x, place.y)?);
            }
            Some(())
        }
    }

    /// A white half plane to the right of x = 3.7.
    fn edge(x: f64, _: f64) -> Option<Rgb> {
        Some(Rgb::grey(f64::from(x > 3.7)))
    }

    #[test]
    fn without_anti_aliasing_the_middle_counts() {
        let pixels = sample_tile(AntiAliasing::Off, TILE, (6, 4), each(edge));
        let row = [0.0, 0.0, 1.0, 1.0].map(Rgb::grey);
        assert_eq!(pixels, [row, row, row].concat());
    }

    #[test]
    fn a_grid_measures_areas() {
        let pixels = sample_tile(AntiAliasing::Grid(10), TILE, (6, 4), each(edge));
        assert!((pixels[1].r - 0.3).abs() < 1e-12 && pixels[0].r == 0.0 && (pixels[2].r - 1.0).abs() < 1e-12);
    }

    #[test]
    fn adaptive_methods_soften_the_edge_only() {
        for aa in [
            AntiAliasing::Method1 { threshold: 0.3, depth: 4 },
            AntiAliasing::Method2 { threshold: 0.3, depth: 4 },
        ] {
            let mut rays = 0;
            let look = each(|x, y| {
                rays += 1;
                edge(x, y)
            });
            let pixels = sample_tile(aa, Region { x0: 0, y0: 0, x1: 16, y1: 16 }, (16, 16), look);
            for row in pixels.chunks(16) {
                assert!((row[3].r - 0.3).abs() < 0.15, "{aa:?}: {}", row[3].r);
                assert_eq!((row[1].r, row[8].r), (0.0, 1.0));
            }
            assert!(rays < 16 * 16 * 8, "{aa:?}: {rays} rays");
        }
    }

    #[test]
    fn tiles_do_not_change_the_picture() {
        let wavy = |x: f64, y: f64| Some(Rgb::grey(f64::from((x * 0.7 + (y * 0.3).floor()) as i64 % 2 == 0)));
        for aa in [
            AntiAliasing::Method1 { threshold: 0.3, depth: 3 },
            AntiAliasing::Method2 { threshold: 0.3, depth: 3 },
        ] {
            let whole = sample_tile(aa, Region { x0: 0, y0: 0, x1: 8, y1: 4 }, (8, 4), each(wavy));
            let left = sample_tile(aa, Region { x0: 0, y0: 0, x1: 4, y1: 4 }, (8, 4), each(wavy));
            let right = sample_tile(aa, Region { x0: 4, y0: 0, x1: 8, y1: 4 }, (8, 4), each(wavy));
            let joined: Vec<Rgb> =
                left.chunks(4).zip(right.chunks(4)).flat_map(|(l, r)| [l, r].concat()).collect();
            assert_eq!(whole, joined, "{aa:?}");
        }
    }

    #[test]
    fn what_ends_early_leaves_finished_pixels_only() {
        for aa in [
            AntiAliasing::Off,
            AntiAliasing::Grid(3),
            AntiAliasing::Method1 { threshold: 0.3, depth: 2 },
            AntiAliasing::Method2 { threshold: 0.3, depth: 2 },
        ] {
            let whole = sample_tile(aa, TILE, (6, 4), each(edge));
            let rays = |most: usize| {
                let mut rays = 0;
                let look = each(|x, y| {
                    rays += 1;
                    edge(x, y).filter(|_| rays <= most)
                });
                let pixels = sample_tile(aa, TILE, (6, 4), look);
                assert!(whole.starts_with(&pixels), "{aa:?}: {most} rays, {} pixels", pixels.len());
                (rays, pixels.len())
            };
            let (all, _) = rays(usize::MAX);
            let done: Vec<_> = (0..=all).map(rays).map(|(_, pixels)| pixels).collect();
            assert!(done.is_sorted() && done[0] == 0 && done[all] == 12, "{aa:?}: {done:?}");
            assert!((1..all).all(|most| rays(most).0 == most + 1), "{aa:?}: it went on");
        }
    }

    #[test]
    fn blocks_cover_an_area_once() {
        let places = in_blocks(19, 10);
        assert_eq!((places.len(), places[0], places[8], places[64]), (190, (0, 0), (0, 1), (8, 0)));
        let mut sorted = places.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), 190);
    }
}

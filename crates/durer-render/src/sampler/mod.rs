//! Samplers: which rays make a pixel, and how their colours are joined.
//!
//! Every sample is a function of its place in the picture alone, so that tiles may be rendered in any order and by any thread.

mod adaptive;
mod jitter;

pub(crate) use self::jitter::random;

use crate::settings::{AntiAliasing, Region};
use durer_scene::Rgb;

/// The depth of the grid and of both methods is bounded, lest a number in a command takes years.
fn bounded(depth: u32) -> u32 {
    depth.clamp(1, AntiAliasing::MAX_DEPTH)
}

/// Renders the pixels of `tile`, a part of a picture of the given size, row by row. `look` answers with the colour at a place of the picture, measured in pixels from the top left.
///
/// Where it answers `None` the work ends: what is returned are the pixels that were finished before.
pub(crate) fn sample_tile(
    aa: AntiAliasing,
    tile: Region,
    picture: (u32, u32),
    mut look: impl FnMut(f64, f64) -> Option<Rgb>,
) -> Vec<Rgb> {
    let mut pixels = Vec::with_capacity(tile.pixels() as usize);
    let _: Option<()> = match aa {
        AntiAliasing::Off => each_pixel(tile, &mut pixels, |x, y| look(middle(x), middle(y))),
        AntiAliasing::Grid(n) => {
            let n = n.clamp(1, 1 << AntiAliasing::MAX_DEPTH);
            each_pixel(tile, &mut pixels, |x, y| grid(n, x, y, &mut look))
        }
        AntiAliasing::Method1 { threshold, depth } => {
            adaptive::method1(threshold, bounded(depth), tile, picture, &mut pixels, &mut look)
        }
        AntiAliasing::Method2 { threshold, depth } => {
            adaptive::method2(threshold, bounded(depth), tile, &mut pixels, &mut look)
        }
    };
    pixels
}

fn each_pixel(
    tile: Region,
    pixels: &mut Vec<Rgb>,
    mut pixel: impl FnMut(u32, u32) -> Option<Rgb>,
) -> Option<()> {
    for y in tile.y0..tile.y1 {
        for x in tile.x0..tile.x1 {
            pixels.push(pixel(x, y)?);
        }
    }
    Some(())
}

fn middle(x: u32) -> f64 {
    f64::from(x) + 0.5
}

/// The mean of `n x n` evenly spread rays.
fn grid(n: u32, x: u32, y: u32, look: &mut impl FnMut(f64, f64) -> Option<Rgb>) -> Option<Rgb> {
    let per = 1.0 / f64::from(n);
    let mut sum = Rgb::BLACK;
    for j in 0..n {
        for i in 0..n {
            sum += look(f64::from(x) + middle(i) * per, f64::from(y) + middle(j) * per)?;
        }
    }
    Some(sum * (per * per))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TILE: Region = Region { x0: 2, y0: 1, x1: 6, y1: 4 };

    /// A white half plane right of x = 3.7.
    fn edge(x: f64, _: f64) -> Option<Rgb> {
        Some(Rgb::grey(f64::from(x > 3.7)))
    }

    #[test]
    fn without_anti_aliasing_the_middle_counts() {
        let pixels = sample_tile(AntiAliasing::Off, TILE, (6, 4), edge);
        let row = [0.0, 0.0, 1.0, 1.0].map(Rgb::grey);
        assert_eq!(pixels, [row, row, row].concat());
    }

    #[test]
    fn a_grid_measures_areas() {
        let pixels = sample_tile(AntiAliasing::Grid(10), TILE, (6, 4), edge);
        assert!((pixels[1].r - 0.3).abs() < 1e-12 && pixels[0].r == 0.0 && (pixels[2].r - 1.0).abs() < 1e-12);
    }

    #[test]
    fn adaptive_methods_soften_the_edge_only() {
        for aa in [
            AntiAliasing::Method1 { threshold: 0.3, depth: 4 },
            AntiAliasing::Method2 { threshold: 0.3, depth: 4 },
        ] {
            let mut rays = 0;
            let pixels = sample_tile(aa, Region { x0: 0, y0: 0, x1: 16, y1: 16 }, (16, 16), |x, y| {
                rays += 1;
                edge(x, y)
            });
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
            let whole = sample_tile(aa, Region { x0: 0, y0: 0, x1: 8, y1: 4 }, (8, 4), wavy);
            let left = sample_tile(aa, Region { x0: 0, y0: 0, x1: 4, y1: 4 }, (8, 4), wavy);
            let right = sample_tile(aa, Region { x0: 4, y0: 0, x1: 8, y1: 4 }, (8, 4), wavy);
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
            let whole = sample_tile(aa, TILE, (6, 4), edge);
            let rays = |most: usize| {
                let mut rays = 0;
                let pixels = sample_tile(aa, TILE, (6, 4), |x, y| {
                    rays += 1;
                    edge(x, y).filter(|_| rays <= most)
                });
                assert!(whole.starts_with(&pixels), "{aa:?}: {most} rays, {} pixels", pixels.len());
                (rays, pixels.len())
            };
            let (all, _) = rays(usize::MAX);
            let done: Vec<_> = (0..=all).map(rays).map(|(_, pixels)| pixels).collect();
            assert!(
                done.is_sorted() && done[0] == 0 && done[all - 1] < 12 && done[all] == 12,
                "{aa:?}: {done:?}"
            );
            assert!((1..all).all(|most| rays(most).0 == most + 1), "{aa:?}: it went on");
        }
    }
}

//! Rendering of a world to a film: tiles, distributed over threads.

use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;

use crate::film::Film;
use crate::integrator::Whitted;
use crate::progress::{Progress, Status};
use crate::sampler::sample_tile;
use crate::settings::{Region, RenderSettings};
use crate::stats::RayCounts;
use crate::world::World;
use durer_surfaces::Steps;

/// Tiles are squares of this many pixels.
const TILE: u32 = 32;

/// Why no picture could be rendered.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene has no camera.
    #[error("the scene has no camera")]
    NoCamera,
    /// The picture has no pixels, or more than can be kept.
    #[error(
        "a picture of {width} x {height} pixels cannot be made: 1 to {} pixels are possible",
        MOST_PIXELS
    )]
    Size {
        /// The number of columns.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// The threads could not be started.
    #[error("threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// The most pixels a film holds: up to 25 bytes each, 6.25 GiB in all.
const MOST_PIXELS: u64 = 1 << 28;

/// A picture, complete or cancelled.
#[derive(Debug)]
pub struct Rendered {
    /// The picture. Pixels that were not rendered are clear.
    pub film: Film,
    /// Whether the work was cancelled before its end.
    pub cancelled: bool,
    /// The numbers of pixels and rays, and the time.
    pub status: Status,
}

/// Renders a picture of `world`.
///
/// The picture is the same, bit for bit, for any number of threads: every pixel depends only on its
/// position.
pub fn render(
    world: &World,
    settings: &RenderSettings,
    progress: &Progress<'_>,
) -> Result<Rendered, RenderError> {
    match settings.threads {
        None => render_here(world, settings, progress),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?
            .install(|| render_here(world, settings, progress)),
    }
}

fn render_here(
    world: &World,
    settings: &RenderSettings,
    progress: &Progress<'_>,
) -> Result<Rendered, RenderError> {
    let RenderSettings { width, height, anti_aliasing, region, depth, .. } = *settings;
    let camera = world.camera().ok_or(RenderError::NoCamera)?;
    if !(1..=MOST_PIXELS).contains(&(u64::from(width) * u64::from(height))) {
        return Err(RenderError::Size { width, height });
    }
    let whole = Region { x0: 0, y0: 0, x1: width, y1: height };
    let region = region.unwrap_or(whole).within(width, height);
    let tiles = tiles(region);
    let start = Instant::now();
    let skipped = AtomicU64::new(0);
    let shared = Mutex::new((
        Film::new(width, height, world.encoding, depth),
        Status {
            pixels_done: 0,
            pixels: region.pixels(),
            rays: RayCounts::default(),
            steps: Steps::default(),
            elapsed: core::time::Duration::ZERO,
        },
    ));
    tiles.into_par_iter().for_each_init(
        || Whitted::new(world).stopped_by(progress),
        |tracer, tile| {
            if progress.is_cancelled() {
                skipped.fetch_add(1, Ordering::Relaxed);
                return;
            }
            tracer.counts = RayCounts::default();
            // Clears the thread's counts of an earlier picture.
            Steps::take();
            let pixels = sample_tile(anti_aliasing, tile, (width, height), |places, colours| {
                tracer.look(camera, (width, height), places, colours)
            });
            let steps = Steps::take();
            if (pixels.len() as u64) < tile.pixels() {
                skipped.fetch_add(1, Ordering::Relaxed);
            }
            // A panicking thread cannot leave the data half-written.
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let (film, status) = &mut *shared;
            film.put(tile, &pixels);
            status.pixels_done += pixels.len() as u64;
            status.rays += tracer.counts;
            status.steps += steps;
            status.elapsed = start.elapsed();
            progress.tell(status);
        },
    );
    let (film, mut status) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    status.elapsed = start.elapsed();
    Ok(Rendered { film, cancelled: skipped.into_inner() > 0, status })
}

/// The tiles of a region, row by row.
fn tiles(region: Region) -> Vec<Region> {
    let mut tiles = Vec::new();
    let mut y0 = region.y0;
    while y0 < region.y1 {
        let y1 = y0.saturating_add(TILE).min(region.y1);
        let mut x0 = region.x0;
        while x0 < region.x1 {
            let x1 = x0.saturating_add(TILE).min(region.x1);
            tiles.push(Region { x0, y0, x1, y1 });
            x0 = x1;
        }
        y0 = y1;
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_each_pixel_once() {
        let region = Region { x0: 5, y0: 7, x1: 105, y1: 72 };
        let mut seen = vec![0; 200 * 200];
        for tile in tiles(region) {
            for y in tile.y0..tile.y1 {
                for x in tile.x0..tile.x1 {
                    seen[(y * 200 + x) as usize] += 1;
                }
            }
        }
        assert_eq!(seen.iter().sum::<u32>() as u64, region.pixels());
        assert_eq!(seen.iter().max(), Some(&1));
    }
}

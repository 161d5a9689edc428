//! The painter: the thread that renders, coarse pixels first.
//!
//! | pass | pixels | of all |
//! |---|---|---|
//! | 1 | every 8th of every 8th row | 1/64 |
//! | 2 | every 4th of every 2nd row | 1/8 |
//! | 3 | all | 1 |
//! | 4 | all, with anti-aliasing | |
//!
//! No pixel is computed twice in the first three passes. Every change cancels the work.

use crate::canvas::{Step, TILE, regions};
use crate::channel::{Channel, Measure, Scale};
use crate::load::Stage;
use crate::session::{Session, Work};
use durer_render::film::Bytes;
use durer_render::{AntiAliasing, PixelTracer, Progress, Region};
use durer_scene::{Lowered, Rgb};
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// The steps of the passes, and the side of the regions that one task renders.
const PASSES: [(Step, u32); 3] = [((8, 8), 128), ((4, 2), 64), ((1, 1), TILE)];

/// Paints until the program ends.
pub(crate) fn paint(session: &Session) {
    let mut generation = 0;
    let mut table = None;
    loop {
        let work = session.next_work(generation);
        generation = work.generation;
        let stage = session.stage();
        let encoding = stage.world.encoding();
        let table = match &mut table {
            Some((known, table)) if *known == encoding => table,
            other => &mut other.insert((encoding, Bytes::new(encoding))).1,
        };
        // What cannot be painted is said in the page; the painter goes on with the next change.
        // Built outside of the pool: its threads would wait for each other.
        let lowered = match work.channel {
            Channel::Picture => Ok(None),
            _ => stage.queries().map(Some),
        };
        match lowered {
            Ok(lowered) => session.pool.install(|| paint_all(session, &stage, &work, table, lowered)),
            Err(message) => session.refuse(message),
        }
    }
}

/// One generation of the picture, on all threads.
fn paint_all(session: &Session, stage: &Stage, work: &Work, table: &Bytes, lowered: Option<&Lowered>) {
    let start = Instant::now();
    let has_fourth = work.channel == Channel::Picture && work.aa != AntiAliasing::Off;
    let mut painting = Painting { session, stage, work, table, lowered, scale: None };
    for (pass, (step, side)) in (1..).zip(PASSES) {
        let before = (pass > 1).then(|| PASSES[pass as usize - 2].0);
        if !painting.pass(step, before, side) {
            return;
        }
        painting.finish(pass, pass == 3 && !has_fourth, start);
    }
    if has_fourth && painting.smooth() {
        painting.finish(4, true, start);
    }
}

struct Painting<'a> {
    session: &'a Session,
    stage: &'a Stage,
    work: &'a Work,
    table: &'a Bytes,
    /// For measurements.
    lowered: Option<&'a Lowered>,
    scale: Option<Scale>,
}

/// The values of pixels, before they become bytes.
enum Shown {
    Colours(Vec<Rgb>),
    Measures(Vec<Measure>),
}

impl Painting<'_> {
    fn is_cancelled(&self) -> bool {
        self.session.cancel.load(Ordering::Relaxed)
    }

    fn tracer(&self) -> Option<PixelTracer<'_>> {
        let stop = Progress::none().cancelled_by(&self.session.cancel);
        PixelTracer::new(&self.stage.world, self.session.file.size(), stop).ok()
    }

    /// Paints the pixels of the lattice `step` that are not in the lattice `before`. Returns false
    /// if the work was cancelled.
    fn pass(&mut self, step: Step, before: Option<Step>, side: u32) -> bool {
        let (width, height) = self.session.file.size();
        let jobs = regions(width, height, side);
        // The first pass of measurements decides their scale, so it is shown when it is complete.
        let kept = Mutex::new(Vec::new());
        let is_kept = before.is_none() && self.work.channel != Channel::Picture;
        let this = &*self;
        jobs.into_par_iter().for_each_init(
            || this.tracer(),
            |tracer, region| {
                if this.is_cancelled() {
                    return;
                }
                let pixels = lattice(region, step, before);
                let Some(shown) = this.show(tracer.as_mut(), &pixels) else { return };
                if is_kept {
                    kept.lock().unwrap_or_else(PoisonError::into_inner).push((region, pixels, shown));
                } else {
                    this.put(region, step, &pixels, &shown);
                }
            },
        );
        if self.is_cancelled() {
            return false;
        }
        if is_kept {
            let kept = kept.into_inner().unwrap_or_else(PoisonError::into_inner);
            let measures = kept.iter().filter_map(|(_, _, shown)| match shown {
                Shown::Measures(measures) => Some(measures),
                Shown::Colours(_) => None,
            });
            let measures: Vec<Measure> = measures.flatten().copied().collect();
            self.scale = Scale::of(self.work.channel, &measures);
            for (region, pixels, shown) in &kept {
                self.put(*region, step, pixels, shown);
            }
        }
        true
    }

    fn show(&self, tracer: Option<&mut PixelTracer<'_>>, pixels: &[(u32, u32)]) -> Option<Shown> {
        let Some(lowered) = self.lowered else {
            let mut colours = Vec::new();
            return tracer?.pixels(pixels, &mut colours).then_some(Shown::Colours(colours));
        };
        let mut measures = Vec::with_capacity(pixels.len());
        for &pixel in pixels {
            if self.is_cancelled() {
                return None;
            }
            let ray = self.session.ray(&self.stage.world, pixel)?;
            measures.push(self.work.channel.measure(&lowered.geometry, &ray));
        }
        Some(Shown::Measures(measures))
    }

    /// Stores pixels, unless they are out of date.
    fn put(&self, region: Region, step: Step, pixels: &[(u32, u32)], shown: &Shown) {
        let mut bytes = vec![[0; 3]; pixels.len()];
        match shown {
            Shown::Colours(colours) => self.table.of_colours(colours, &mut bytes),
            Shown::Measures(measures) => {
                for (byte, &measure) in bytes.iter_mut().zip(measures) {
                    *byte = Scale::colour(self.scale, self.work.channel, measure);
                }
            }
        }
        let mut shared = self.session.shared();
        if shared.generation != self.work.generation {
            return;
        }
        match shown {
            Shown::Colours(colours) => {
                for (&(x, y), &colour) in pixels.iter().zip(colours) {
                    shared.film.set(x, y, colour);
                }
            }
            // Where nothing is hit the film stays clear.
            Shown::Measures(measures) => {
                for (&(x, y), measure) in pixels.iter().zip(measures) {
                    if let Some([r, g, b]) = measure.values() {
                        shared.film.set(x, y, Rgb::new(r, g, b));
                    }
                }
            }
        }
        shared.canvas.put(pixels, &bytes);
        shared.canvas.mark(region, step, self.work.generation);
        shared.wake();
    }

    /// Paints the picture again with anti-aliasing. Returns false if the work was cancelled.
    fn smooth(&self) -> bool {
        let (width, height) = self.session.file.size();
        regions(width, height, TILE).into_par_iter().for_each_init(
            || self.tracer(),
            |tracer, region| {
                if self.is_cancelled() {
                    return;
                }
                let Some(colours) = tracer.as_mut().and_then(|t| t.tile(self.work.aa, region)) else {
                    return;
                };
                let pixels = lattice(region, (1, 1), None);
                self.put(region, (1, 1), &pixels, &Shown::Colours(colours));
            },
        );
        !self.is_cancelled()
    }

    /// Announces a finished pass.
    fn finish(&self, pass: u32, is_last: bool, start: Instant) {
        let mut shared = self.session.shared();
        if shared.generation == self.work.generation {
            shared.scale = self.scale;
            shared.done = (self.work.generation, pass, is_last);
            shared.took = start.elapsed();
            shared.announce();
        }
    }
}

/// The pixels of a region whose column and row are multiples of `step`, without those of `before`,
/// row by row.
fn lattice(region: Region, step: Step, before: Option<Step>) -> Vec<(u32, u32)> {
    let mut pixels = Vec::new();
    for y in (region.y0..region.y1).step_by(step.1 as usize) {
        for x in (region.x0..region.x1).step_by(step.0 as usize) {
            if !before.is_some_and(|b| x % b.0 == 0 && y % b.1 == 0) {
                pixels.push((x, y));
            }
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_passes_paint_each_pixel_once() {
        let (width, height) = (100, 70);
        let mut painted = vec![0; 7000];
        let mut counts = Vec::new();
        let mut before = None;
        for (step, side) in PASSES {
            for region in regions(width, height, side) {
                for (x, y) in lattice(region, step, before) {
                    painted[(y * width + x) as usize] += 1;
                }
            }
            before = Some(step);
            counts.push(painted.iter().sum::<u32>());
        }
        assert!(painted.iter().all(|n| *n == 1));
        assert_eq!(counts, [13 * 9, 25 * 35, 7000]);
    }
}

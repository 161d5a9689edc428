//! Progress reports of a rendering, and its cancellation.

use crate::stats::RayCounts;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use durer_surfaces::Steps;

/// How a rendering reports its progress, and how it can be cancelled.
#[derive(Clone, Copy, Default)]
pub struct Progress<'a> {
    report: Option<&'a (dyn Fn(&Status) + Sync)>,
    cancel: Option<&'a AtomicBool>,
}

/// How far the work has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Pixels rendered.
    pub pixels_done: u64,
    /// Pixels to be rendered.
    pub pixels: u64,
    /// Rays traced so far.
    pub rays: RayCounts,
    /// What rays needed on patches and other surfaces of two parameters.
    pub steps: Steps,
    /// Time since the start.
    pub elapsed: Duration,
}

impl Status {
    /// Rays of all kinds per second.
    pub fn rays_per_second(&self) -> f64 {
        let seconds = self.elapsed.as_secs_f64();
        if seconds > 0.0 { self.rays.total() as f64 / seconds } else { 0.0 }
    }

    /// An estimate of the time that is left, from the average speed so far; unknown before the
    /// first pixel.
    pub fn remaining(&self) -> Option<Duration> {
        if self.pixels_done == 0 {
            return None;
        }
        let left = self.pixels.saturating_sub(self.pixels_done) as f64 / self.pixels_done as f64;
        Duration::try_from_secs_f64(self.elapsed.as_secs_f64() * left).ok()
    }
}

impl<'a> Progress<'a> {
    /// Makes a `Progress` without reports or cancellation.
    pub fn none() -> Self {
        Self::default()
    }

    /// Calls `report` after each tile, from the thread that rendered it; one call at a time.
    #[must_use]
    pub fn reporting(mut self, report: &'a (dyn Fn(&Status) + Sync)) -> Self {
        self.report = Some(report);
        self
    }

    /// Traces no further ray once `cancel` is true. Pixels that are finished by then stay on the
    /// film; the rest is clear.
    #[must_use]
    pub fn cancelled_by(mut self, cancel: &'a AtomicBool) -> Self {
        self.cancel = Some(cancel);
        self
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }

    pub(crate) fn tell(&self, status: &Status) {
        if let Some(report) = self.report {
            report(status);
        }
    }
}

impl core::fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Progress").field("cancelled", &self.is_cancelled()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_takes_as_long_as_what_is_done() {
        let status = Status {
            pixels_done: 25,
            pixels: 100,
            rays: RayCounts { camera: 25, shadow: 25, ..RayCounts::default() },
            steps: Steps::default(),
            elapsed: Duration::from_secs(2),
        };
        assert_eq!(status.remaining(), Some(Duration::from_secs(6)));
        assert_eq!(status.rays_per_second(), 25.0);
        assert_eq!(Status { pixels_done: 0, ..status }.remaining(), None);
    }
}

//! The difference between two pictures of one scene.

use crate::Outcome;
use crate::picture::Picture;

/// A pixel agrees if no channel differs by more than this many of 255 steps.
pub(crate) const TOLERANCE: u8 = 2;

/// The share of pixels that must agree.
pub(crate) const REQUIRED: f64 = 0.99;

/// The difference of two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Difference {
    /// The share of pixels that agree within [`TOLERANCE`], 0 to 1.
    pub(crate) agreeing: f64,
    /// The largest difference of any channel, in steps of 255.
    pub(crate) worst: u8,
}

impl Difference {
    /// Whether enough pixels agree.
    pub(crate) fn passes(self) -> bool {
        self.agreeing >= REQUIRED
    }
}

/// Compares two pictures of the same size, and draws the difference (see [`highlight`]).
pub(crate) fn compare(ours: &Picture, theirs: &Picture) -> Outcome<(Difference, Picture)> {
    if (ours.width, ours.height) != (theirs.width, theirs.height) {
        let size = |p: &Picture| format!("{}x{}", p.width, p.height);
        return Err(format!("pictures of different size: {} and {}", size(ours), size(theirs)));
    }
    let distances: Vec<u8> = ours.pixels.iter().zip(&theirs.pixels).map(|(a, b)| distance(*a, *b)).collect();
    let agreeing = distances.iter().filter(|d| **d <= TOLERANCE).count();
    let difference = Difference {
        agreeing: agreeing as f64 / distances.len().max(1) as f64,
        worst: distances.iter().copied().max().unwrap_or(0),
    };
    let pixels = ours.pixels.iter().zip(distances).map(|(pixel, d)| highlight(*pixel, d)).collect();
    Ok((difference, Picture { width: ours.width, height: ours.height, pixels }))
}

/// The pixels on which two pictures differ though `theirs` agrees there with all of `again`, other
/// pictures of the same size and by the same program.
pub(crate) fn reproducible_differences(ours: &Picture, theirs: &Picture, again: &[Picture]) -> Vec<usize> {
    let differs = |other: &Picture, i: usize| differs_at(other, theirs, i);
    (0..theirs.pixels.len()).filter(|&i| differs(ours, i) && !again.iter().any(|a| differs(a, i))).collect()
}

/// Whether two pictures differ in a pixel. They do if one of them does not have it.
pub(crate) fn differs_at(a: &Picture, b: &Picture, pixel: usize) -> bool {
    match (a.pixels.get(pixel), b.pixels.get(pixel)) {
        (Some(a), Some(b)) => distance(*a, *b) > TOLERANCE,
        _ => true,
    }
}

/// The largest difference of any channel.
fn distance(a: [u8; 3], b: [u8; 3]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// A dim grey copy of pixels that agree. Pixels that differ are red, the brighter the worse.
fn highlight(pixel: [u8; 3], distance: u8) -> [u8; 3] {
    if distance <= TOLERANCE {
        let grey = pixel.iter().map(|c| u16::from(*c)).sum::<u16>() / 9;
        return [u8::try_from(grey).unwrap_or(u8::MAX); 3];
    }
    [distance.saturating_mul(4).max(96), 0, 0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(values: &[u8]) -> Picture {
        Picture { width: values.len() as u32, height: 1, pixels: values.iter().map(|v| [*v, 0, 0]).collect() }
    }

    #[test]
    fn two_steps_agree_and_three_do_not() {
        let (difference, drawn) = compare(&picture(&[10, 10, 10, 10]), &picture(&[10, 12, 13, 7])).unwrap();
        assert_eq!(difference, Difference { agreeing: 0.5, worst: 3 });
        assert!(!difference.passes());
        assert_eq!(drawn.pixels[2], [96, 0, 0]);
    }

    #[test]
    fn pixels_that_change_by_themselves_do_not_count() {
        let (ours, theirs) = (picture(&[10, 20, 30, 40]), picture(&[10, 29, 39, 40]));
        assert_eq!(reproducible_differences(&ours, &theirs, &[]), [1, 2]);
        let again = [picture(&[19, 29, 39, 40]), picture(&[10, 29, 30, 40])];
        assert_eq!(reproducible_differences(&ours, &theirs, &again), [1]);
    }

    #[test]
    fn different_sizes_are_an_error() {
        assert!(compare(&picture(&[1, 2]), &picture(&[1])).is_err());
    }
}

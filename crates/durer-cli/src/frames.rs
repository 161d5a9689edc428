//! Sequences of pictures, one for each frame, and parts of pictures, as POV-Ray counts them.

use crate::args::RenderArgs;
use crate::failure::Failure;
use clap::Args;
use durer::render::Region;
use std::path::{Path, PathBuf};

/// Which frames are rendered, and what `clock` is in each.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FrameArgs {
    /// The first frame of a sequence of pictures: `frame_number` counts from it
    #[arg(long, value_name = "N")]
    pub(crate) initial_frame: Option<u32>,
    /// The last frame of the sequence. The name of each picture ends in its number, with zeros before
    #[arg(long, value_name = "N")]
    pub(crate) final_frame: Option<u32>,
    /// `clock` in the initial frame. [default: 0]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) initial_clock: Option<f64>,
    /// `clock` in the final frame. [default: 1]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) final_clock: Option<f64>,
    /// The first frame to render of the sequence: a number, or a fraction of all frames
    #[arg(long, value_name = "N")]
    pub(crate) subset_start: Option<f64>,
    /// The last frame to render of the sequence: a number, or a fraction of all frames
    #[arg(long, value_name = "N")]
    pub(crate) subset_end: Option<f64>,
    /// Lets `clock` reach its final value in the frame after the final one.
    #[arg(long)]
    pub(crate) cyclic: bool,
}

/// One picture of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) output: PathBuf,
    pub(crate) clock: f64,
    /// The values of names that say where in the sequence it is.
    pub(crate) names: Vec<(String, f64)>,
}

/// More frames than this no sequence may have: eleven hours of film.
const MOST_FRAMES: f64 = 1_000_000.0;

impl FrameArgs {
    /// The pictures to be rendered; `None` without a sequence.
    pub(crate) fn frames(&self, output: &Path) -> Result<Option<Vec<Frame>>, Failure> {
        let (first, last) = (self.initial_frame.unwrap_or(1), self.final_frame.unwrap_or(1));
        if first == 1 && last == 1 {
            return Ok(None);
        }
        if first > last {
            let text = format!("the sequence from frame {first} to frame {last} has no frames");
            return Err(Failure::Usage(text));
        }
        let count = f64::from(last - first) + 1.0;
        // Below 1 it is a fraction, so that frame 0 of a sequence needs no subset.
        let number = |at: f64| if at < 1.0 { (at * count).floor() } else { at.floor() };
        let start = self.subset_start.map_or(f64::from(first), number).max(f64::from(first));
        let end = self.subset_end.map_or(f64::from(last), number).min(f64::from(last));
        if start > end {
            return Err(Failure::Usage("the subset of the sequence has no frames".to_owned()));
        }
        if end - start >= MOST_FRAMES {
            let text = format!("a sequence has at most {MOST_FRAMES} frames, this one {}", end - start + 1.0);
            return Err(Failure::Usage(text));
        }
        let (from, to) = (self.initial_clock.unwrap_or(0.0), self.final_clock.unwrap_or(1.0));
        let reported = if self.cyclic { f64::from(last) + 1.0 } else { f64::from(last) };
        let steps = reported - f64::from(first);
        // A sequence of one frame has no step.
        let step = if steps > 0.0 { (to - from) / steps } else { 0.0 };
        let digits = last.to_string().len();
        let frames = (start as u32..=end as u32).map(|frame| Frame {
            output: numbered(output, frame, digits),
            clock: from + step * f64::from(frame - first),
            names: [
                ("frame_number", f64::from(frame)),
                ("initial_frame", f64::from(first)),
                ("final_frame", reported),
                ("clock_delta", step),
                ("initial_clock", from),
                ("final_clock", to),
            ]
            .map(|(name, value)| (name.to_owned(), value))
            .into(),
        });
        Ok(Some(frames.collect()))
    }
}

/// `out07.png` for frame 7 of `out.png`.
fn numbered(output: &Path, frame: u32, digits: usize) -> PathBuf {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let mut name = format!("{stem}{frame:0digits$}");
    if let Some(ending) = output.extension() {
        name = format!("{name}.{}", ending.to_string_lossy());
    }
    output.with_file_name(name)
}

/// The first and the last column and row of a part of the picture: numbers from 1, or fractions of
/// the width and the height.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct PartArgs {
    /// The first column: a number from 1, or a fraction of the width.
    #[arg(long, value_name = "N")]
    start_column: Option<f64>,
    /// The last column.
    #[arg(long, value_name = "N")]
    end_column: Option<f64>,
    /// The first row: a number from 1, or a fraction of the height.
    #[arg(long, value_name = "N")]
    start_row: Option<f64>,
    /// The last row.
    #[arg(long, value_name = "N")]
    end_row: Option<f64>,
}

impl PartArgs {
    /// The part of a picture of the given size; `None` for all of it.
    fn region(&self, (width, height): (u32, u32)) -> Option<Region> {
        let all = [self.start_column, self.end_column, self.start_row, self.end_row];
        if all.iter().all(Option::is_none) {
            return None;
        }
        let first = |at: Option<f64>, size: u32| match at {
            // A fraction leads to the column behind it.
            Some(at) if at < 1.0 => (at * f64::from(size)).floor() as u32,
            Some(at) => at as u32 - 1,
            None => 0,
        };
        let end = |at: Option<f64>, size: u32| match at {
            Some(at) if at <= 1.0 => (at * f64::from(size)).floor() as u32,
            Some(at) => at as u32,
            None => size,
        };
        Some(Region {
            x0: first(self.start_column, width),
            y0: first(self.start_row, height),
            x1: end(self.end_column, width),
            y1: end(self.end_row, height),
        })
    }
}

impl RenderArgs {
    /// The part of the picture that is rendered; `None` for all of it.
    pub(crate) fn part(&self) -> Result<Option<Region>, Failure> {
        let (width, height) = self.size.size();
        let region = self.part.region((width, height)).or(self.region);
        if region.is_some_and(|region| {
            region.x0 >= region.x1 || region.y0 >= region.y1 || region.within(width, height).pixels() == 0
        }) {
            let text = format!("the region is empty, or lies outside the picture of {width}x{height}");
            return Err(Failure::Usage(text));
        }
        Ok(region)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(args: &FrameArgs) -> Vec<(String, f64)> {
        let frames = args.frames(Path::new("x/a.png")).ok().flatten().unwrap_or_default();
        frames.iter().map(|frame| (frame.output.display().to_string(), frame.clock)).collect()
    }

    /// As POV-Ray 3.7 names and times them.
    #[test]
    fn frames_have_names_and_clocks() {
        let three = FrameArgs { initial_frame: Some(1), final_frame: Some(3), ..FrameArgs::default() };
        let named = |name: &str, clock: f64| (format!("x/{name}.png"), clock);
        assert_eq!(frames(&three), [named("a1", 0.0), named("a2", 0.5), named("a3", 1.0)]);
        let part = FrameArgs {
            final_frame: Some(10),
            subset_start: Some(0.21),
            subset_end: Some(3.0),
            ..three.clone()
        };
        assert_eq!(frames(&part), [named("a02", 1.0 / 9.0), named("a03", 2.0 / 9.0)]);
        let cyclic = FrameArgs {
            final_frame: Some(2),
            initial_clock: Some(2.0),
            final_clock: Some(4.0),
            cyclic: true,
            ..three.clone()
        };
        assert_eq!(frames(&cyclic), [named("a1", 2.0), named("a2", 3.0)]);
        let one = FrameArgs { initial_frame: Some(5), final_frame: Some(5), ..three };
        assert_eq!(frames(&one), [named("a5", 0.0)]);
        assert!(frames(&FrameArgs::default()).is_empty());
        assert!(FrameArgs { initial_frame: Some(5), ..FrameArgs::default() }.frames(Path::new("a")).is_err());
    }

    #[test]
    fn parts_are_counted_from_one() {
        let part = |columns: [f64; 2], rows: [f64; 2]| {
            let part = PartArgs {
                start_column: Some(columns[0]),
                end_column: Some(columns[1]),
                start_row: Some(rows[0]),
                end_row: Some(rows[1]),
            };
            let Region { x0, y0, x1, y1 } = part.region((20, 16)).unwrap();
            [x0, x1, y0, y1]
        };
        assert_eq!(part([5.0, 8.0], [0.3, 0.6]), [4, 8, 4, 9]);
        assert_eq!(part([0.26, 0.74], [1.0, 1.0]), [5, 14, 0, 16]);
    }
}

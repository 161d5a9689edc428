//! Shapes that are swept from outlines: points in a plane, then a sweep.

use std::rc::Rc;

use super::Shape;
use crate::diagnostics::{Fault, Place, Result};
use crate::keywords::Keyword;
use crate::reader::Reader;
use durer_scene::{Prism, Sweep};

impl Reader<'_> {
    /// `[linear_spline] [linear_sweep | conic_sweep] height, height, number of points, points`.
    pub(super) fn prism(&mut self, place: Place) -> Result<Shape> {
        let mut sweep = Sweep::Linear;
        loop {
            if self.take_word(Keyword::LinearSweep)? {
                sweep = Sweep::Linear;
            } else if self.take_word(Keyword::ConicSweep)? {
                sweep = Sweep::Conic;
            } else if !self.take_word(Keyword::LinearSpline)? {
                break;
            }
        }
        let from = self.float()?;
        self.skip_comma()?;
        let to = self.float()?;
        self.skip_comma()?;
        if from == to {
            return Err(Fault::invalid(
                place,
                format!("this prism has no height: it goes from {from} to {to}"),
            ));
        }
        let count = self.point_count("a prism", 3)?;
        let outlines = self.outlines(count, place)?;
        Ok(Shape::Prism(Rc::new(Prism { outlines, heights: [from, to], sweep })))
    }

    /// How many points follow, and the comma behind it.
    fn point_count(&mut self, what: &str, least: u32) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if !(f64::from(least)..1e9).contains(&count) {
            return Err(Fault::invalid(at, format!("{what} has at least {least} points, not {count}")));
        }
        Ok(count as usize)
    }

    /// Points of outlines: each ends where its first point comes again.
    fn outlines(&mut self, count: usize, place: Place) -> Result<Vec<Vec<[f64; 2]>>> {
        let (mut outlines, mut current) = (Vec::new(), Vec::<[f64; 2]>::new());
        for n in 0..count {
            let point = self.vector2()?;
            self.skip_comma()?;
            self.check_memory(n * 32, place)?;
            if current.first() == Some(&point) {
                outlines.push(std::mem::take(&mut current));
            } else {
                current.push(point);
            }
        }
        let is_unclosed = !current.is_empty();
        if is_unclosed {
            outlines.push(current);
        }
        for (i, outline) in outlines.iter().enumerate() {
            if outline.len() < 3 {
                let (n, len) = (i + 1, outline.len());
                return Err(Fault::invalid(
                    place,
                    format!("outline {n} of this prism has {len} different points, it needs 3 at least"),
                ));
            }
        }
        if is_unclosed {
            self.notice(place, "this prism does not end at its first point: it is closed");
        }
        Ok(outlines)
    }
}

//! Patches: surfaces over the unit square, given by nets of control points.

use std::rc::Rc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;
use durer_scene::Patch;

impl Parser<'_> {
    /// `type T`, `flatness F`, `u_steps N` and `v_steps N` in any order, then
    /// `[uv_vectors four of them]` and 16 points.
    pub(super) fn bicubic_patch(&mut self, place: Place) -> Result<Shape> {
        let mut kind = None;
        loop {
            let word = self.peek_word()?;
            let at = self.here();
            match word {
                Some(word @ (Keyword::Type | Keyword::Flatness | Keyword::USteps | Keyword::VSteps)) => {
                    self.next()?;
                    let value = self.float()?;
                    self.skip_comma()?;
                    if word == Keyword::Type {
                        if value != 0.0 && value != 1.0 {
                            let text = format!("the type of a bicubic_patch is 0 or 1, not {value}");
                            return Err(Error::invalid(at, text));
                        }
                        kind = Some(value);
                    } else if !(value >= 0.0) {
                        // How finely it would be cut into triangles is not needed.
                        let text = format!("{} must not be negative: {value}", word.text());
                        return Err(Error::invalid(at, text));
                    }
                }
                _ => break,
            }
        }
        if kind.is_none() {
            return Err(Error::invalid(place, "this bicubic_patch has no type: it needs `type 0` or `type 1`"));
        }
        let uv = self.uv_corners()?;
        let points = self.net(16)?;
        self.patch([4, 4], points, uv, place)
    }

    /// Points of a net, without weights.
    fn net(&mut self, count: usize) -> Result<Vec<[f64; 4]>> {
        let mut points = Vec::with_capacity(count.min(256));
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            let [x, y, z] = self.corner()?;
            self.check_memory(n * 32, at)?;
            points.push([x, y, z, 1.0]);
        }
        Ok(points)
    }

    /// `uv_vectors` at the four corners, if they come next.
    fn uv_corners(&mut self) -> Result<[[f64; 2]; 4]> {
        let mut uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        if self.take_word(Keyword::UvVectors)? {
            for corner in &mut uv {
                *corner = self.vector2()?;
                self.skip_comma()?;
            }
        }
        Ok(uv)
    }

    /// The shape of a net.
    fn patch(
        &mut self,
        size: [usize; 2],
        points: Vec<[f64; 4]>,
        uv: [[f64; 2]; 4],
        place: Place,
    ) -> Result<Shape> {
        if points.iter().all(|p| p[..3] == points[0][..3]) {
            return Ok(self.nothing("all points of this patch are the same, so it has no surface", place));
        }
        Ok(Shape::Patch(Rc::new(Patch { size, points, uv })))
    }
}

//! `sweep { profile PROFILE, ... path PATH [size ...] [twist ...] [up ...] }`, durer's own.

use std::rc::Rc;

use durer_scene::{Curve, Spline, StraightSweep};

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;
use crate::scene_builder::{point, vector};

impl Parser<'_> {
    /// The profiles, the path and the settings of a sweep, after its opening brace.
    pub(super) fn sweep(&mut self, place: Place) -> Result<Shape> {
        let (mut outlines, mut spline, mut path) = (Vec::new(), None, None);
        let (mut sizes, mut up) = ([1.0; 2], None);
        loop {
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            if self.small_word("profile")? {
                self.profiles(&mut outlines, &mut spline, place)?;
            } else if self.small_word("path")? {
                path = Some((self.straight_path()?, at));
            } else if self.take_word(Keyword::Size)? {
                sizes = self.sweep_sizes()?;
            } else if self.small_word("twist")? {
                if self.float()? != 0.0 {
                    return Err(Error::invalid(at, "a sweep with `twist` is not supported yet"));
                }
            } else if self.take_word(Keyword::Up)? {
                up = Some(vector(self.corner()?));
            } else {
                break;
            }
        }
        let Some(spline) = spline else {
            return Err(Error::invalid(place, "this sweep has no `profile`"));
        };
        let Some((path, at)) = path else {
            return Err(Error::invalid(place, "this sweep has no `path`"));
        };
        let sweep = StraightSweep { outlines, spline, path: path.map(point), sizes, up };
        sweep.straight_path().map_err(|why| Error::invalid(at, why.to_string()))?;
        Ok(Shape::Sweep(Rc::new(sweep)))
    }

    /// One or more closed curves, separated by commas. All are of the same spline.
    fn profiles(
        &mut self,
        outlines: &mut Vec<Vec<[f64; 2]>>,
        spline: &mut Option<Spline>,
        place: Place,
    ) -> Result<()> {
        loop {
            self.peek()?;
            let at = self.here();
            let (found, more) = if self.take_word(Keyword::LinearSpline)? {
                let count = self.point_count("a profile of linear_spline", 3)?;
                (Spline::Linear, self.outlines("profile", count, at)?)
            } else if self.take_word(Keyword::BezierSpline)? {
                (Spline::Curved(Curve::Bezier), self.curves("profile", Curve::Bezier)?)
            } else if outlines.is_empty() {
                let lexeme = self.next()?;
                return Err(self.unexpected(&lexeme, "linear_spline or bezier_spline"));
            } else {
                return Ok(());
            };
            if spline.is_some_and(|spline| spline != found) {
                return Err(Error::invalid(at, "all profiles of a sweep have the same kind of spline"));
            }
            *spline = Some(found);
            outlines.extend(more);
            self.check_memory(outlines.len() * 64, place)?;
        }
    }

    /// `linear_spline 2, from, to`.
    fn straight_path(&mut self) -> Result<[[f64; 3]; 2]> {
        self.peek()?;
        let at = self.here();
        for (keyword, name) in [
            (Keyword::CubicSpline, "cubic_spline"),
            (Keyword::BSpline, "b_spline"),
            (Keyword::BezierSpline, "bezier_spline"),
        ] {
            if self.take_word(keyword)? {
                let text = format!("a sweep along a curved path ({name}) is not supported yet");
                return Err(Error::invalid(at, text));
            }
        }
        if !self.take_word(Keyword::LinearSpline)? {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "linear_spline, cubic_spline, b_spline or bezier_spline"));
        }
        if self.point_count("the path of a sweep", 2)? > 2 {
            return Err(Error::invalid(at, "a sweep along a path with corners is not supported yet"));
        }
        let from = self.corner()?;
        let to = self.corner()?;
        self.skip_comma()?;
        Ok([from, to])
    }

    /// `2, size, size`.
    fn sweep_sizes(&mut self) -> Result<[f64; 2]> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if count != 2.0 {
            let text = format!("`size` has one number for each of the 2 points of the path, not {count}");
            return Err(Error::invalid(at, text));
        }
        let start = self.float()?;
        self.skip_comma()?;
        Ok([start, self.float()?])
    }
}

//! `sweep { profile PROFILE, ... path PATH [size ...] [twist ...] [up ...] }`, durer's own.

use std::sync::Arc;

use durer_scene::{self as scene, Curve, PathSpline, PathSweep, Spline, StraightSweep, SweepData};

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;
use crate::scene_builder::{point, vector};

impl Parser<'_> {
    /// The profiles, the path and the settings of a sweep, after its opening brace.
    pub(super) fn sweep(&mut self, place: Place) -> Result<Shape> {
        let (mut outlines, mut spline, mut path) = (Vec::new(), None, None);
        let (mut sizes, mut up, mut twist) = (None, None, 0.0);
        loop {
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            if self.small_word("profile")? {
                self.profiles(&mut outlines, &mut spline, place)?;
            } else if self.small_word("path")? {
                path = Some((self.sweep_path()?, at));
            } else if self.take_word(Keyword::Size)? {
                sizes = Some((self.sweep_sizes()?, at));
            } else if self.small_word("twist")? {
                twist = self.float()?;
            } else if self.take_word(Keyword::Up)? {
                up = Some(vector(self.corner()?));
            } else {
                break;
            }
        }
        let Some(spline) = spline else {
            return Err(Error::invalid(place, "this sweep has no `profile`"));
        };
        let Some(((kind, path), at)) = path else {
            return Err(Error::invalid(place, "this sweep has no `path`"));
        };
        let sizes = match sizes {
            Some((sizes, at)) if sizes.len() != path.len() => {
                let (wanted, count) = (path.len(), sizes.len());
                let text =
                    format!("`size` has one number for each of the {wanted} points of the path, not {count}");
                return Err(Error::invalid(at, text));
            }
            Some((sizes, _)) => sizes,
            None => vec![1.0; path.len()],
        };
        if let (PathSpline::Linear, &[from, to], &[start, end], 0.0) = (kind, &path[..], &sizes[..], twist) {
            let (path, sizes) = ([from, to].map(point), [start, end]);
            let sweep = StraightSweep { outlines, spline, path, sizes, up };
            sweep.straight_path().map_err(|why| Error::invalid(at, why.to_string()))?;
            return Ok(scene::Shape::StraightSweep(Arc::new(sweep)).into());
        }
        let path = path.iter().zip(sizes).map(|(&[x, y, z], size)| [x, y, z, size]).collect();
        let outlines = outlines.iter().map(|points| match spline {
            Spline::Linear => SweepData::edges(points),
            Spline::Curved(curve) => curve.pieces(points),
        });
        let data =
            SweepData { outlines: outlines.collect(), spline: kind, path, twist: twist.to_radians(), up };
        let sweep = PathSweep::new(data).map_err(|why| Error::invalid(at, why.to_string()))?;
        Ok(scene::Shape::PathSweep(sweep).into())
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

    /// The spline of the path and its points.
    fn sweep_path(&mut self) -> Result<(PathSpline, Vec<[f64; 3]>)> {
        self.peek()?;
        let at = self.here();
        let kinds = [
            (Keyword::LinearSpline, PathSpline::Linear),
            (Keyword::CubicSpline, PathSpline::Cubic),
            (Keyword::BSpline, PathSpline::BSpline),
            (Keyword::BezierSpline, PathSpline::Bezier),
        ];
        let mut found = None;
        for (keyword, kind) in kinds {
            if found.is_none() && self.take_word(keyword)? {
                found = Some(kind);
            }
        }
        let Some(kind) = found else {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "linear_spline, cubic_spline, b_spline or bezier_spline"));
        };
        let count = self.point_count("the path of a sweep", kind.least() as u32)?;
        if kind == PathSpline::Bezier && count % 4 != 0 {
            let text = format!(
                "a path of bezier_spline has four points for each span, {count} is not a multiple of 4"
            );
            return Err(Error::invalid(at, text));
        }
        let mut points = Vec::new();
        for n in 0..count {
            self.peek()?;
            let here = self.here();
            points.push(self.corner()?);
            self.check_memory(n * 4096, here)?;
        }
        Ok((kind, points))
    }

    /// `count, size, ...`.
    fn sweep_sizes(&mut self) -> Result<Vec<f64>> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if !(1.0..1e6).contains(&count) {
            return Err(Error::invalid(
                at,
                format!("`size` has one number for each point of the path, not {count}"),
            ));
        }
        let mut sizes = Vec::new();
        for n in 0..count as usize {
            sizes.push(self.float()?);
            self.skip_comma()?;
            self.check_memory(n * 8, at)?;
        }
        Ok(sizes)
    }
}

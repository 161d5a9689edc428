//! Shapes that are swept from outlines: points in a plane, then a sweep.

use std::sync::Arc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;
use crate::scene_builder::point;
use durer_math::Point3;
use durer_scene::{self as scene, Curve, FillRule, LatheSpline, Prism, Spline, Sweep, SweepSpline};

impl Parser<'_> {
    /// `[linear_spline | quadratic_spline | cubic_spline | bezier_spline]
    /// [linear_sweep | conic_sweep] height, height, number of points, points`.
    pub(super) fn prism(&mut self, place: Place) -> Result<Shape> {
        let (mut sweep, mut spline) = (Sweep::Linear, Spline::Linear);
        loop {
            if self.take_word(Keyword::LinearSweep)? {
                sweep = Sweep::Linear;
            } else if self.take_word(Keyword::ConicSweep)? {
                sweep = Sweep::Conic;
            } else if self.take_word(Keyword::LinearSpline)? {
                spline = Spline::Linear;
            } else if self.take_word(Keyword::QuadraticSpline)? {
                spline = Spline::Curved(Curve::Quadratic);
            } else if self.take_word(Keyword::CubicSpline)? {
                spline = Spline::Curved(Curve::Cubic);
            } else if self.take_word(Keyword::BezierSpline)? {
                spline = Spline::Curved(Curve::Bezier);
            } else {
                break;
            }
        }
        let from = self.float()?;
        self.skip_comma()?;
        let to = self.float()?;
        self.skip_comma()?;
        if from == to && spline != Spline::Linear {
            return Err(Error::invalid(
                place,
                format!("this prism has no height: it goes from {from} to {to}"),
            ));
        }
        let outlines = match spline {
            Spline::Linear => {
                let count = self.point_count("a prism", 3)?;
                self.outlines("prism", count, place)?
            }
            Spline::Curved(curve) => self.curves("prism", curve)?,
        };
        if from == to {
            return Ok(self.flat_prism(&outlines, sweep, from, place));
        }
        let prism = Prism { outlines, spline, heights: [from, to], sweep };
        Ok(scene::Shape::Prism(Arc::new(prism)).into())
    }

    /// A prism of straight edges without height: a polygon.
    fn flat_prism(&mut self, outlines: &[Vec<[f64; 2]>], sweep: Sweep, y: f64, place: Place) -> Shape {
        let size = match sweep {
            Sweep::Linear => 1.0,
            Sweep::Conic => y,
        };
        if size == 0.0 {
            return self.nothing("this prism has neither volume nor area", place);
        }
        let loops = outlines
            .iter()
            .map(|points| points.iter().map(|&[x, z]| Point3::new(x * size, y, z * size)).collect());
        scene::Shape::Polygon { loops: loops.collect(), rule: FillRule::EvenOdd }.into()
    }

    /// The points of closed curves, those before and behind each curve included.
    pub(super) fn curves(&mut self, of: &str, curve: Curve) -> Result<Vec<Vec<[f64; 2]>>> {
        // The name, the least number of points, where the first point of the curve is, and how many
        // follow its last.
        let (spline, least, first, behind) = match curve {
            Curve::Quadratic => ("quadratic_spline", 5, 1, 0),
            Curve::Cubic => ("cubic_spline", 6, 1, 1),
            Curve::Bezier => ("bezier_spline", 4, 0, 0),
        };
        let name = &format!("a {of} of {spline}");
        self.peek()?;
        let at = self.here();
        let count = self.point_count(name, least)?;
        if curve == Curve::Bezier && count % 4 != 0 {
            let text = format!("{name} has four points for each piece, {count} is not a multiple of 4");
            return Err(Error::invalid(at, text));
        }
        let (mut outlines, mut current, mut start) = (Vec::new(), Vec::<[f64; 2]>::new(), at);
        for n in 0..count {
            self.peek()?;
            let here = self.here();
            if current.is_empty() {
                start = here;
            }
            let point = self.vector2()?;
            self.skip_comma()?;
            self.check_memory(n * 32, here)?;
            if curve == Curve::Bezier
                && current.len() % 4 == 0
                && current.last().is_some_and(|last| *last != point)
            {
                let [[a, b], [x, z]] = [current[current.len() - 1], point];
                let text =
                    format!("a piece of this outline ends at <{a}, {b}>, the next begins at <{x}, {z}>");
                return Err(Error::invalid(here, text));
            }
            current.push(point);
            let last = current.len() - 1;
            let closes = |last: usize| match curve {
                Curve::Bezier => last % 4 == 3 && current[last] == current[0],
                _ => last > first && current[last] == current[first],
            };
            if last >= behind && closes(last - behind) {
                // A curve from a point to itself: three other points make an outline, except of
                // Bezier pieces.
                if current.len() < least as usize {
                    let (n, len) = (outlines.len() + 1, current.len());
                    let text =
                        format!("outline {n} of this {of} has {len} points, it needs {least} at least");
                    return Err(Error::invalid(start, text));
                }
                outlines.push(std::mem::take(&mut current));
            }
        }
        if let Some([x, z]) = current.get(first).or(current.first()) {
            let n = outlines.len() + 1;
            let text = match curve {
                Curve::Cubic => {
                    format!(
                        "outline {n} of this {of} is not closed: it must return to <{x}, {z}>, followed by one more point"
                    )
                }
                _ => format!(
                    "outline {n} of this {of} is not closed: it must return to <{x}, {z}>, where it begins"
                ),
            };
            return Err(Error::invalid(start, text));
        }
        Ok(outlines)
    }

    /// `linear_spline | b_spline | cubic_spline number of spheres, centre, radius, ...
    /// [tolerance t]`.
    pub(super) fn sphere_sweep(&mut self, place: Place) -> Result<Shape> {
        let (spline, name, least) = if self.take_word(Keyword::LinearSpline)? {
            (SweepSpline::Linear, "linear_spline", 2.0)
        } else if self.take_word(Keyword::BSpline)? {
            (SweepSpline::BSpline, "b_spline", 4.0)
        } else if self.take_word(Keyword::CubicSpline)? {
            (SweepSpline::Cubic, "cubic_spline", 4.0)
        } else {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "linear_spline, b_spline or cubic_spline"));
        };
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if count.partial_cmp(&least).is_none_or(std::cmp::Ordering::is_lt) {
            let text = format!("a sphere_sweep of {name} has at least {least} spheres, not {count}");
            return Err(Error::invalid(at, text));
        }
        let mut spheres = Vec::<[f64; 4]>::new();
        for n in 0..count as usize {
            self.peek()?;
            let here = self.here();
            let [x, y, z] = self.corner()?;
            let radius = self.float()?;
            self.skip_comma()?;
            self.check_memory(n * 64, here)?;
            spheres.push([x, y, z, radius]);
        }
        // Ends are proven without one.
        if self.take_word(Keyword::Tolerance)? {
            self.float()?;
        }
        if spheres.iter().all(|sphere| sphere[3] == 0.0) {
            return Ok(self.nothing("all radii of this sphere_sweep are 0", place));
        }
        Ok(scene::Shape::SphereSweep(spline, spheres.into()).into())
    }

    /// `number of points, <radius, height>, ...`.
    pub(super) fn sor(&mut self) -> Result<Shape> {
        let count = self.point_count("a sor", 4)?;
        let mut points = Vec::<[f64; 2]>::new();
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            let [radius, height] = self.vector2()?;
            self.skip_comma()?;
            self.check_memory(n * 32, at)?;
            if radius < 0.0 {
                let text = format!("the radius of a sor's point must not be negative: {radius}");
                return Err(Error::invalid(at, text));
            }
            // The first and the last point are not on the curve.
            if let [_, .., [_, below]] = points[..]
                && n + 1 < count
                && height <= below
            {
                let text = format!("the heights of a sor ascend, but {height} comes after {below}");
                return Err(Error::invalid(at, text));
            }
            points.push([radius, height]);
        }
        Ok(scene::Shape::Sor(points.into()).into())
    }

    /// `[linear_spline | quadratic_spline | cubic_spline | bezier_spline] number of points,
    /// <radius, height>, ...`.
    pub(super) fn lathe(&mut self, place: Place) -> Result<Shape> {
        let mut spline = LatheSpline::Linear;
        loop {
            spline = if self.take_word(Keyword::LinearSpline)? {
                LatheSpline::Linear
            } else if self.take_word(Keyword::QuadraticSpline)? {
                LatheSpline::Quadratic
            } else if self.take_word(Keyword::CubicSpline)? {
                LatheSpline::Cubic
            } else if self.take_word(Keyword::BezierSpline)? {
                LatheSpline::Bezier
            } else {
                break;
            };
        }
        let name = match spline {
            LatheSpline::Linear => "a lathe",
            LatheSpline::Quadratic => "a lathe of quadratic_spline",
            LatheSpline::Cubic => "a lathe of cubic_spline",
            LatheSpline::Bezier => "a lathe of bezier_spline",
        };
        self.peek()?;
        let at = self.here();
        let count = self.point_count(name, spline.least_points() as u32)?;
        if spline == LatheSpline::Bezier && count % 4 != 0 {
            let text = format!("{name} has four points for each piece, {count} is not a multiple of 4");
            return Err(Error::invalid(at, text));
        }
        let mut points = Vec::<[f64; 2]>::new();
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            points.push(self.vector2()?);
            self.skip_comma()?;
            self.check_memory(n * 256, at)?;
        }
        if spline.is_on_axis(&points) {
            return Ok(self.nothing("this lathe sweeps no surface: its profile lies on the axis", place));
        }
        Ok(scene::Shape::Lathe(spline, points.into()).into())
    }

    /// `bottom radius, top radius`. One of them may be 0; then the other sphere is the whole solid.
    pub(super) fn ovus(&mut self, place: Place) -> Result<Shape> {
        let bottom = self.size()?;
        self.skip_comma()?;
        Ok(match (bottom, self.size()?) {
            (0.0, 0.0) => self.nothing("both radii of this ovus are 0", place),
            (bottom, top) if bottom == 0.0 || top == 0.0 => {
                scene::Shape::Sphere { centre: Point3::ORIGIN, radius: bottom.max(top) }.into()
            }
            (bottom, top) => scene::Shape::Ovus { bottom, top }.into(),
        })
    }

    /// `base, radius, apex, radius, inner radius`.
    pub(super) fn lemon(&mut self, place: Place) -> Result<Shape> {
        let base = point(self.corner()?);
        let base_radius = self.end_radius()?;
        let apex = point(self.corner()?);
        let apex_radius = self.end_radius()?;
        let inner_radius = self.radius("the lemon's inner radius")?;
        if base == apex {
            return Err(Error::invalid(place, "this lemon's ends are the same point"));
        }
        Ok(scene::Shape::Lemon { base, base_radius, apex, apex_radius, inner_radius }.into())
    }

    /// A radius that may be zero, and the comma behind it.
    fn end_radius(&mut self) -> Result<f64> {
        self.peek()?;
        let at = self.here();
        let radius = self.float()?;
        self.skip_comma()?;
        if radius < 0.0 {
            return Err(Error::invalid(
                at,
                format!("the radius of a lemon's end must not be negative: {radius}"),
            ));
        }
        Ok(radius)
    }

    /// How many points follow, and the comma behind it.
    pub(super) fn point_count(&mut self, what: &str, least: u32) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let count = self.float()?;
        self.skip_comma()?;
        if !(f64::from(least)..1e9).contains(&count) {
            return Err(Error::invalid(at, format!("{what} has at least {least} points, not {count}")));
        }
        Ok(count as usize)
    }

    /// Points of outlines: each ends where its first point comes again.
    pub(super) fn outlines(&mut self, of: &str, count: usize, place: Place) -> Result<Vec<Vec<[f64; 2]>>> {
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
                return Err(Error::invalid(
                    place,
                    format!("outline {n} of this {of} has {len} different points, it needs 3 at least"),
                ));
            }
        }
        if is_unclosed {
            let text = format!("this {of} does not end at its first point; durer closes it");
            self.notice(place, &text);
        }
        Ok(outlines)
    }
}

//! Patches: surfaces over the unit square, given by nets of control points. `bicubic_patch` is
//! POV-Ray's; `bilinear`, `patch` and `nurbs` are durer's own.

use std::sync::Arc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use durer_scene::{self as scene, NurbsData, Patch, SewnData, TriangularPatch, TrimLoop};

/// How the points of a `patch` make a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Basis {
    Bezier,
    Linear,
    BSpline,
    /// Catmull and Rom's.
    Cubic,
    Hermite,
}

/// The most points along a parameter.
const MOST_POINTS: usize = 1 << 20;

/// Uniform knots without ends: a cubic one is near its points.
fn uniform(points: usize, degree: usize) -> Vec<f64> {
    let shift = |i: usize| i as f64 - degree as f64;
    if degree == 1 {
        let end = points as f64 - 1.0;
        (0..points + 2).map(|i| shift(i).clamp(0.0, end)).collect()
    } else {
        (0..points + degree + 1).map(shift).collect()
    }
}

/// The knots of cubic Bezier pieces that share their ends.
fn joined(points: usize) -> Vec<f64> {
    let pieces = (points - 1) / 3;
    let mut knots = vec![0.0];
    knots.extend((0..=pieces).flat_map(|k| [k as f64; 3]));
    knots.push(pieces as f64);
    knots
}

/// Rows or columns of a net as cubic Bezier pieces.
///
/// Catmull and Rom's cubic from `b` to `c` has the slope `(c - a) / 2` at `b` and `(d - b) / 2` at
/// `c`; Hermite's four points are both ends and both slopes. A cubic's inner Bezier points are a
/// third of a slope from its ends.
fn pieces(basis: Basis, p: &[[f64; 4]]) -> Vec<[f64; 4]> {
    let moved = |a: &[f64; 4], b: &[f64; 4], c: &[f64; 4], by: f64| {
        [0, 1, 2, 3].map(|k| if k < 3 { a[k] + (c[k] - b[k]) * by } else { 1.0 })
    };
    let zero = [0.0; 4];
    if basis == Basis::Hermite {
        let third = 1.0 / 3.0;
        return vec![p[0], moved(&p[0], &zero, &p[2], third), moved(&p[1], &p[3], &zero, third), p[1]];
    }
    let mut out = vec![p[1]];
    for w in p.windows(4) {
        let sixth = 1.0 / 6.0;
        out.extend([moved(&w[1], &w[0], &w[2], sixth), moved(&w[2], &w[3], &w[1], sixth), w[2]]);
    }
    out
}

/// A net as one of cubic Bezier pieces, and its size.
fn as_bezier(basis: Basis, points: &[[f64; 4]], size: [usize; 2]) -> (Vec<[f64; 4]>, [usize; 2]) {
    let rows: Vec<_> = points.chunks_exact(size[0]).map(|row| pieces(basis, row)).collect();
    let width = rows[0].len();
    let columns: Vec<_> =
        (0..width).map(|i| pieces(basis, &rows.iter().map(|row| row[i]).collect::<Vec<_>>())).collect();
    let height = columns[0].len();
    let net = (0..height).flat_map(|j| columns.iter().map(move |column| column[j])).collect();
    (net, [width, height])
}

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
                    } else if value < 0.0 {
                        // How finely it would be cut into triangles is not needed.
                        let text = format!("{} must not be negative: {value}", word.text());
                        return Err(Error::invalid(at, text));
                    }
                }
                _ => break,
            }
        }
        if kind.is_none() {
            return Err(Error::invalid(
                place,
                "this bicubic_patch has no type: it needs `type 0` or `type 1`",
            ));
        }
        let uv = self.uv_corners()?;
        let points = self.net(16)?;
        self.patch([4, 4], points, uv, place)
    }

    /// Four corners, in the order in which they go round.
    pub(super) fn bilinear(&mut self, place: Place) -> Result<Shape> {
        let mut round = [[0.0; 4]; 4];
        for corner in &mut round {
            let [x, y, z] = self.corner()?;
            *corner = [x, y, z, 1.0];
        }
        let uv = self.uv_corners()?;
        let [a, b, c, d] = round;
        self.patch([2, 2], vec![a, b, d, c], uv, place)
    }

    /// `triangular N, points [uv_vectors three of them]`: N points in the first row, each row one
    /// shorter.
    fn triangular_patch(&mut self, place: Place) -> Result<Shape> {
        self.skip_comma()?;
        let side = self.whole_from("the points along a side of a triangular patch", 2, 9)?;
        let mut points = Vec::new();
        for row in 0..side {
            points.extend(self.weighted_net([side - row, 1], row)?);
        }
        let mut uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        self.uv_vectors(&mut uv)?;
        if points.iter().all(|p| p[..3] == points[0][..3]) {
            return Ok(self.nothing("all points of this patch are the same, so it has no surface", place));
        }
        Ok(scene::Shape::TriangularPatch(Arc::new(TriangularPatch { side, points, uv })).into())
    }

    /// `[bezier_spline | linear_spline | b_spline | cubic_spline | hermite] NU, NV, points`, or
    /// `triangular N, points`.
    pub(super) fn spline_patch(&mut self, place: Place) -> Result<Shape> {
        if self.take_word(Keyword::Triangular)? {
            return self.triangular_patch(place);
        }
        let (basis, name, least) = if self.take_word(Keyword::LinearSpline)? {
            (Basis::Linear, "linear_spline", 2)
        } else if self.take_word(Keyword::BSpline)? {
            (Basis::BSpline, "b_spline", 4)
        } else if self.take_word(Keyword::CubicSpline)? {
            (Basis::Cubic, "cubic_spline", 4)
        } else if self.small_word("hermite")? {
            (Basis::Hermite, "hermite", 4)
        } else {
            self.take_word(Keyword::BezierSpline)?;
            (Basis::Bezier, "bezier_spline", 2)
        };
        self.skip_comma()?;
        let most = match basis {
            Basis::Bezier => 16,
            Basis::Hermite => 4,
            _ => MOST_POINTS,
        };
        let mut size = [0; 2];
        for n in &mut size {
            *n = self.whole_from(&format!("the points along a parameter of a {name} patch"), least, most)?;
        }
        let points = self.weighted_net(size, 0)?;
        let uv = if basis == Basis::Bezier { self.uv_corners()? } else { [[0.0; 2]; 4] };
        match basis {
            Basis::Bezier => self.patch(size, points, uv, place),
            Basis::Linear | Basis::BSpline => {
                let degree = if basis == Basis::Linear { 1 } else { 3 };
                let knots = size.map(|n| uniform(n, degree));
                let data = NurbsData { degree: [degree; 2], size, points, knots, ..NurbsData::default() };
                self.checked_nurbs(data, place)
            }
            Basis::Cubic | Basis::Hermite => {
                if points.iter().any(|p| p[3] != 1.0) {
                    let text = format!("the points of a patch of {name} have no weights");
                    return Err(Error::invalid(place, text));
                }
                let (net, size) = as_bezier(basis, &points, size);
                let knots = size.map(joined);
                let data = NurbsData { degree: [3; 2], size, points: net, knots, ..NurbsData::default() };
                self.checked_nurbs(data, place)
            }
        }
    }

    /// `degree DU, DV points NU, NV, points [u_knots ...] [v_knots ...] [periodic u | v | u v]
    /// [trim { loop } ...]`.
    pub(super) fn nurbs(&mut self, place: Place) -> Result<Shape> {
        let data = self.nurbs_data(place)?;
        self.checked_nurbs(data, place)
    }

    /// `nurbs { ... } nurbs { ... } ... [seal TOL] [closed]`.
    pub(super) fn sewn(&mut self, place: Place) -> Result<Shape> {
        let mut data = SewnData::default();
        loop {
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            if self.small_word("nurbs")? {
                self.expect(Mark::BraceOpen)?;
                let surface = self.nurbs_data(at)?;
                surface.check().map_err(|why| Error::invalid(at, why.to_string()))?;
                self.expect(Mark::BraceClose)?;
                data.surfaces.push(surface);
            } else if self.small_word("seal")? {
                data.seal = self.float()?;
                if !(data.seal >= 0.0 && data.seal.is_finite()) {
                    let text = format!("the seal must be finite and not negative, not {}", data.seal);
                    return Err(Error::invalid(at, text));
                }
            } else if self.small_word("closed")? {
                data.closed = true;
            } else {
                break;
            }
        }
        // It is made here, so that an edge without a partner is named where the block is.
        data.check().map_err(|why| Error::invalid(place, why.to_string()))?;
        Ok(scene::Shape::Sewn(Arc::new(data)).into())
    }

    /// The numbers of a `nurbs`, not yet checked.
    fn nurbs_data(&mut self, place: Place) -> Result<NurbsData> {
        let mut data = NurbsData::default();
        let (mut has_degree, mut has_points) = (false, false);
        loop {
            self.skip_comma()?;
            self.peek()?;
            let at = self.here();
            if self.small_word("degree")? {
                for degree in &mut data.degree {
                    *degree = self.whole_from("a degree of a nurbs", 1, 9)?;
                }
                has_degree = true;
            } else if self.small_word("points")? {
                for n in &mut data.size {
                    *n = self.whole_from("the points along a parameter of a nurbs", 2, MOST_POINTS)?;
                }
                data.points = self.weighted_net(data.size, 0)?;
                has_points = true;
            } else if self.small_word("u_knots")? {
                data.knots[0] = self.knots()?;
            } else if self.small_word("v_knots")? {
                data.knots[1] = self.knots()?;
            } else if self.small_word("periodic")? {
                data.periodic[0] |= self.take_word(Keyword::U)?;
                data.periodic[1] |= self.take_word(Keyword::V)?;
                if data.periodic == [false; 2] {
                    let text = "periodic along what? Say `periodic u`, `periodic v` or `periodic u v`";
                    return Err(Error::invalid(at, text));
                }
            } else if self.small_word("trim")? {
                self.expect(Mark::BraceOpen)?;
                data.trims.push(self.trim_loop()?);
                self.expect(Mark::BraceClose)?;
            } else {
                break;
            }
        }
        if !has_degree || !has_points {
            let missing = if has_degree { "points NU, NV, ..." } else { "degree DU, DV" };
            return Err(Error::invalid(place, format!("this nurbs lacks `{missing}`")));
        }
        Ok(data)
    }

    /// The shape of a surface whose numbers make one.
    fn checked_nurbs(&mut self, data: NurbsData, place: Place) -> Result<Shape> {
        data.check().map_err(|why| Error::invalid(place, why.to_string()))?;
        if data.points.iter().all(|p| p[..3] == data.points[0][..3]) {
            return Ok(self.nothing("all points of this patch are the same, so it has no surface", place));
        }
        Ok(scene::Shape::Nurbs(Arc::new(data)).into())
    }

    /// `linear_spline N, <u, v>, ...`, `bezier_spline N, <u, v>, ...` or `nurbs_curve degree D, N,
    /// <u, v> or <u, v, w>, ... knots COUNT, ...`.
    fn trim_loop(&mut self) -> Result<TrimLoop> {
        self.peek()?;
        let at = self.here();
        if self.take_word(Keyword::LinearSpline)? {
            return Ok(TrimLoop::Polygon(self.plane_points()?));
        }
        if self.take_word(Keyword::BezierSpline)? {
            return Ok(TrimLoop::Bezier(self.plane_points()?));
        }
        if !self.small_word("nurbs_curve")? {
            let text = "a trim is a linear_spline, a bezier_spline or a nurbs_curve";
            return Err(Error::invalid(at, text));
        }
        if !self.small_word("degree")? {
            return Err(Error::invalid(at, "this nurbs_curve lacks `degree D`"));
        }
        let degree = self.whole_from("the degree of a nurbs_curve", 1, 9)?;
        let count = self.whole_from("the number of points of a nurbs_curve", 2, MOST_POINTS)?;
        let mut points = Vec::new();
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            self.check_memory(n * 24, at)?;
            let value = self.expression()?;
            self.skip_comma()?;
            let [u, v, w] = value.xyz();
            points.push([u, v, if value.as_slice().len() > 2 { w } else { 1.0 }]);
        }
        let knots = if self.small_word("knots")? { self.knots()? } else { Vec::new() };
        Ok(TrimLoop::Nurbs { degree, points, knots })
    }

    /// How many points of the parameters, and these.
    fn plane_points(&mut self) -> Result<Vec<[f64; 2]>> {
        let count = self.whole_from("the number of points of a trim", 3, MOST_POINTS)?;
        let mut points = Vec::new();
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            self.check_memory(n * 16, at)?;
            points.push(self.vector2()?);
            self.skip_comma()?;
        }
        Ok(points)
    }

    /// How many knots, and these.
    fn knots(&mut self) -> Result<Vec<f64>> {
        let count = self.whole_from("the number of knots", 2, MOST_POINTS)?;
        let mut knots = Vec::new();
        for n in 0..count {
            self.peek()?;
            let at = self.here();
            let knot = self.float()?;
            self.skip_comma()?;
            self.check_memory(n * 8, at)?;
            if knots.last().is_some_and(|last| knot < *last) {
                let (k, before) = (n + 1, knots[n - 1]);
                return Err(Error::invalid(
                    at,
                    format!("knots must not decrease: knot {k} is {knot} after {before}"),
                ));
            }
            knots.push(knot);
        }
        Ok(knots)
    }

    /// An integer in a range, and the comma after it.
    fn whole_from(&mut self, what: &str, least: usize, most: usize) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let n = self.float()?;
        self.skip_comma()?;
        if n.fract() != 0.0 || !(least as f64..=most as f64).contains(&n) {
            let text = format!("{what} must be a whole number from {least} to {most}, not {n}");
            return Err(Error::invalid(at, text));
        }
        Ok(n as usize)
    }

    /// Points of a net, `<x, y, z>`, or `<x, y, z, w>` with a weight, after `rows` rows.
    fn weighted_net(&mut self, [nu, nv]: [usize; 2], rows: usize) -> Result<Vec<[f64; 4]>> {
        let mut points = Vec::new();
        for n in 0..nu * nv {
            self.peek()?;
            let at = self.here();
            self.check_memory(n * 32, at)?;
            let value = self.expression()?;
            self.skip_comma()?;
            let [x, y, z] = value.xyz();
            let weight = match value.as_slice() {
                [_, _, _, w] => *w,
                more if more.len() > 4 => {
                    let text = format!("expected a point and its weight, found {} components", more.len());
                    return Err(Error::invalid(at, text));
                }
                _ => 1.0,
            };
            if !(weight > 0.0 && weight.is_finite()) {
                let (row, column) = (rows + n / nu + 1, n % nu + 1);
                let text =
                    format!("the weight of point {column} of row {row} must be positive, not {weight}");
                return Err(Error::invalid(at, text));
            }
            points.push([x, y, z, weight]);
        }
        Ok(points)
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
        self.uv_vectors(&mut uv)?;
        Ok(uv)
    }

    /// `uv_vectors`, as many as there are, if they come next.
    fn uv_vectors(&mut self, uv: &mut [[f64; 2]]) -> Result<()> {
        if self.take_word(Keyword::UvVectors)? {
            for corner in uv {
                *corner = self.vector2()?;
                self.skip_comma()?;
            }
        }
        Ok(())
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
        Ok(scene::Shape::Patch(Arc::new(Patch { size, points, uv })).into())
    }
}

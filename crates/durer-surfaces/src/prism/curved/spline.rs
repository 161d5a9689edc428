//! Splines through points, as Bezier pieces.
//!
//! ```text
//!   quadratic   p0 [p1 p2 p3 .. p1]       between p_i and p_i+1 the parabola through
//!                                         p_i-1, p_i, p_i+1 at u = -1, 0, 1
//!   cubic       p0 [p1 p2 p3 .. p1] pn    between p_i and p_i+1 the cubic with the slopes
//!                                         (p_i+1 - p_i-1) / 2 and (p_i+2 - p_i) / 2 there
//!   Bezier      [a b c d] [d e f g] ..    the curve with these control points
//! ```
//!
//! The curve consists of the points in brackets and is closed; the points before and after only
//! determine its slopes at the ends. Cubic splines are those of E. Catmull, R. Rom, "A class of
//! local interpolating splines", *Computer Aided Geometric Design* (ed. Barnhill,
//! Riesenfeld), 1974. Inner control points of a piece are rounded to f64, ends are the points
//! themselves; the exact solid is that of the rounded points.

use crate::prism::outline::Point;

/// A cubic curve by its control points: `[x, z]` each.
pub type Bezier = [Point; 4];

/// How points define a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// Parabolas; one point before the curve.
    Quadratic,
    /// Cubics; one point before the curve and one after it.
    Cubic,
    /// Four control points for each piece.
    Bezier,
}

impl Spline {
    /// The pieces of a curve. Points after the last complete piece are ignored.
    #[must_use]
    pub fn pieces(self, points: &[Point]) -> Vec<Bezier> {
        let toward =
            |from: Point, a: Point, b: Point, part: f64| [0, 1].map(|k| from[k] + part * (b[k] - a[k]));
        match self {
            Self::Quadratic => {
                let piece = |p: &[Point]| {
                    let [before, a, b] = [p[0], p[1], p[2]];
                    // The middle control point of the parabola, a + (b - before) / 4, raised by one
                    // degree.
                    let middle = toward(a, before, b, 0.25);
                    [a, toward(a, a, middle, 2.0 / 3.0), toward(b, b, middle, 2.0 / 3.0), b]
                };
                points.windows(3).map(piece).collect()
            }
            Self::Cubic => {
                let piece = |p: &[Point]| {
                    let [before, a, b, behind] = [p[0], p[1], p[2], p[3]];
                    [a, toward(a, before, b, 1.0 / 6.0), toward(b, behind, a, 1.0 / 6.0), b]
                };
                points.windows(4).map(piece).collect()
            }
            Self::Bezier => points.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(b: &Bezier, u: f64) -> Point {
        let v = 1.0 - u;
        let w = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
        [0, 1].map(|k| (0..4).map(|i| w[i] * b[i][k]).sum())
    }

    fn near(a: Point, b: Point) -> bool {
        (0..2).all(|k| (a[k] - b[k]).abs() < 1e-14)
    }

    #[test]
    fn parabolas_go_through_the_point_before_them() {
        let points = [[-1.0, 3.0], [0.5, 2.0], [4.0, 1.0], [0.0, -1.0], [0.5, 2.0]];
        let pieces = Spline::Quadratic.pieces(&points);
        assert_eq!(pieces.len(), 3);
        for (i, piece) in pieces.iter().enumerate() {
            assert_eq!((piece[0], piece[3]), (points[i + 1], points[i + 2]));
            assert!(near(at(piece, -1.0), points[i]), "{piece:?}");
        }
    }

    #[test]
    fn cubics_are_smooth_at_their_points() {
        let points = [[-1.0, 3.0], [0.5, 2.0], [4.0, 1.0], [0.0, -1.0], [0.5, 2.0], [3.0, 1.0]];
        let pieces = Spline::Cubic.pieces(&points);
        assert_eq!(pieces.len(), 3);
        for (i, piece) in pieces.iter().enumerate() {
            assert_eq!((piece[0], piece[3]), (points[i + 1], points[i + 2]));
            let slope = |a: Point, b: Point| [0, 1].map(|k| 3.0 * (b[k] - a[k]));
            let half = |a: Point, b: Point| [0, 1].map(|k| 0.5 * (b[k] - a[k]));
            assert!(near(slope(piece[0], piece[1]), half(points[i], points[i + 2])));
            assert!(near(slope(piece[2], piece[3]), half(points[i + 1], points[i + 3])));
        }
    }

    #[test]
    fn bezier_pieces_are_taken_as_they_are() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.0, 1.0],
            [-1.0, 1.0],
            [-1.0, 0.0],
            [0.0, 0.0],
        ];
        let pieces = Spline::Bezier.pieces(&points);
        assert_eq!(pieces.concat(), points);
    }
}

//! Pictures in space.
//!
//! A point has coordinates `(u, v)` in the picture, from its lower left corner; outside the unit
//! square the picture is repeated. The middle of the pixel in column `i` and row `j` (from below)
//! has `u = (i + 1/2)/columns` and `v = (j + 1/2)/rows`. Between the middles,
//!
//! ```text
//!   linear     (1 - s)(1 - t) a + s (1 - t) b + (1 - s) t c + s t d
//!   cubic      Catmull and Rom's spline through four pixels along both axes
//!   distance   the mean of four pixels, weighted by 1/distance^2
//! ```

use std::sync::Arc;

use durer_math::{Point3, Vec3};
use durer_scene::{Around, Between, Colour, ImageMap, ImageValue, Layout, Rgb, Wrap};

use super::warp::unrolled;
use crate::vector::floor;

/// An [`ImageMap`] prepared for evaluation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture(Arc<ImageMap>);

/// The colour outside a picture that is not repeated: transparent.
const CLEAR: Colour = Colour { rgb: Rgb::WHITE, filter: 0.0, transmit: 1.0 };

/// The four pixels around a point of the picture, and their weights along an axis.
struct Weights {
    first: f64,
    weights: [f64; 4],
}

impl Picture {
    pub(super) fn new(map: &Arc<ImageMap>) -> Self {
        Self(Arc::clone(map))
    }

    /// The coordinates of a point in the picture; `None` outside a picture that is not repeated.
    fn place(&self, p: Point3) -> Option<(f64, f64)> {
        let around = |around| {
            let wrap = Wrap { around, orientation: Vec3::Z, growth: 0.0 };
            unrolled(p, &wrap)
        };
        let flat = match self.0.layout {
            Layout::Flat => p,
            Layout::Sphere => around(Around::Sphere),
            Layout::Cylinder => around(Around::Cylinder),
            Layout::Torus => around(Around::Torus(1.0)),
        };
        let unit = |x: f64| (0.0..1.0).contains(&x);
        if self.0.once && !(unit(flat.x) && unit(flat.y)) {
            return None;
        }
        let within = |x: f64| if unit(x) { x } else { x - floor(x) };
        let (u, v) = (within(flat.x), within(flat.y));
        // Points without coordinates, such as infinity, are shown as the corner.
        Some(if unit(u) && unit(v) { (u, v) } else { (0.0, 0.0) })
    }

    fn size(&self) -> (f64, f64) {
        (self.0.image.columns() as f64, self.0.image.rows() as f64)
    }

    /// The column and the row, from the top, of pixel `(x, y)`, counted from below.
    fn pixel(&self, x: f64, y: f64) -> (usize, usize) {
        let (columns, rows) = self.size();
        let inside = |x: f64, n: f64| match self.0.once {
            true => x.clamp(0.0, n - 1.0),
            false => (x - floor(x / n) * n).clamp(0.0, n - 1.0),
        };
        (inside(x, columns) as usize, (rows - 1.0 - inside(y, rows)) as usize)
    }

    /// The colour at a point.
    pub(super) fn colour(&self, p: Point3) -> Colour {
        let Some((u, v)) = self.place(p) else { return CLEAR };
        let (columns, rows) = self.size();
        self.colour_at(u * columns, v * rows)
    }

    /// The colour `x` and `y` pixels from the lower left corner.
    fn colour_at(&self, x: f64, y: f64) -> Colour {
        let image = &self.0.image;
        if self.0.between == Between::Nearest {
            let (column, row) = self.pixel(floor(x), floor(y));
            return image.colour(column, row);
        }
        let mut terms = [0.0; 5];
        self.each_near(x, y, |column, row, weight| {
            let Colour { rgb, filter, transmit } = image.colour(column, row);
            let own = [rgb.r, rgb.g, rgb.b, filter, transmit];
            for (sum, own) in terms.iter_mut().zip(own) {
                *sum += own * weight;
            }
        });
        Colour::from_terms(terms)
    }

    /// The index in the palette `x` and `y` pixels from the lower left corner: between pixels the whole
    /// part of the mixed indices (a fact of the scene language).
    fn index_at(&self, x: f64, y: f64) -> f64 {
        let mut index = 0.0;
        self.each_near(x, y, |column, row, weight| index += self.0.image.index(column, row) as f64 * weight);
        index.trunc()
    }

    /// Passes the columns and rows of the pixels around a point to `visit`, with their weights.
    fn each_near(&self, x: f64, y: f64, mut visit: impl FnMut(usize, usize, f64)) {
        let mut add = |x: f64, y: f64, weight: f64| {
            if weight != 0.0 {
                let (column, row) = self.pixel(x, y);
                visit(column, row, weight);
            }
        };
        if self.0.between == Between::Nearest {
            return add(floor(x), floor(y), 1.0);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        if self.0.between == Between::Distance {
            let (left, low) = (floor(x), floor(y));
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            let squares = corners.map(|(i, j)| {
                let (dx, dy) = (x - left - i, y - low - j);
                dx * dx + dy * dy
            });
            if squares[0] == 0.0 {
                add(left, low, 1.0);
            } else {
                let weights = squares.map(|square| 1.0 / square);
                let whole: f64 = weights.iter().sum();
                for ((i, j), weight) in corners.into_iter().zip(weights) {
                    add(left + i, low + j, weight / whole);
                }
            }
        } else {
            let is_cubic = self.0.between == Between::Cubic;
            let (across, up) = (weights(x, is_cubic), weights(y, is_cubic));
            for (j, wy) in up.weights.into_iter().enumerate() {
                for (i, wx) in across.weights.into_iter().enumerate() {
                    add(across.first + i as f64, up.first + j as f64, wx * wy);
                }
            }
        }
    }

    /// The index of the pixel at a point; 0 outside a picture that is not repeated.
    pub(super) fn index(&self, p: Point3) -> usize {
        let Some((u, v)) = self.place(p) else { return 0 };
        let (columns, rows) = self.size();
        let (column, row) = self.pixel(floor(u * columns), floor(v * rows));
        self.0.image.index(column, row)
    }

    /// The differences of the value to the right and upward: those of the plane through the values
    /// at three places, the point and one pixel down to the left and to the right of it. Of a picture
    /// with a palette the value may be the index itself. (Facts of the scene language.)
    pub(super) fn differences(&self, p: Point3, value: ImageValue) -> [f64; 2] {
        let Some((u, v)) = self.place(p) else { return [0.0; 2] };
        let (columns, rows) = self.size();
        let (x, y) = (u * columns, v * rows);
        let at = |x: f64, y: f64| match value {
            ImageValue::Index if self.0.image.has_palette() => self.index_at(x, y),
            ImageValue::Index | ImageValue::Grey => self.colour_at(x, y).rgb.luminance(),
            ImageValue::Alpha => 1.0 - self.colour_at(x, y).transmit,
        };
        let (here, left, right) = (at(x, y), at(x - 1.0, y - 1.0), at(x + 1.0, y - 1.0));
        [0.5 * (right - left), here - 0.5 * (left + right)]
    }

    /// The number that the picture gives at a point; 0 outside a picture that is not repeated.
    pub(super) fn value(&self, p: Point3, value: ImageValue) -> f64 {
        if self.0.once && self.place(p).is_none() {
            return 0.0;
        }
        match value {
            ImageValue::Grey => self.colour(p).rgb.luminance(),
            ImageValue::Alpha => 1.0 - self.colour(p).transmit,
            ImageValue::Index => self.index(p) as f64 / 255.0,
        }
    }
}

/// The weights of the pixels around `x`, where middles of pixels are whole numbers.
fn weights(x: f64, is_cubic: bool) -> Weights {
    let first = floor(x) - 1.0;
    let s = x - floor(x);
    let weights = if is_cubic {
        [
            0.5 * s * (-1.0 + s * (2.0 - s)),
            1.0 + 0.5 * s * s * (-5.0 + 3.0 * s),
            0.5 * s * (1.0 + s * (4.0 - 3.0 * s)),
            0.5 * s * s * (s - 1.0),
        ]
    } else {
        [0.0, 1.0 - s, s, 0.0]
    };
    Weights { first, weights }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::Image;

    /// A picture that is white in column 3, row 3 of eight.
    fn dot(between: Between, once: bool) -> Picture {
        let mut colours = vec![[0.0_f32; 5]; 64];
        colours[3 * 8 + 3] = [1.0, 1.0, 1.0, 0.0, 0.0];
        let image = Arc::new(Image::from_colours(8, 8, colours).unwrap());
        Picture(Arc::new(ImageMap { image, layout: Layout::Flat, once, between }))
    }

    fn at(picture: &Picture, right: f64, down: f64) -> f64 {
        let p = Point3::new((3.5 + right) / 8.0, (4.5 - down) / 8.0, 7.0);
        picture.colour(p).rgb.r
    }

    #[test]
    fn between_pixels_colours_are_those_of_pov_ray() {
        // Values of `eval_pigment` in POV-Ray 3.7.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-5;
        let cubic = dot(Between::Cubic, false);
        for (right, down, want) in [
            (-1.5, 0.0, -0.0625),
            (-0.75, 0.0, 0.226_562_5),
            (0.25, 0.0, 0.867_187_5),
            (0.25, 0.25, 0.752_014_2),
            (0.75, 0.25, 0.196_472_2),
            (0.75, 0.75, 0.051_330_6),
        ] {
            assert!(close(at(&cubic, right, down), want), "{right} {down}");
        }
        let distance = dot(Between::Distance, false);
        for (right, down, want) in [
            (0.0, 0.0, 1.0),
            (0.25, 0.0, 0.826_490_9),
            (0.5, 0.25, 0.361_111_1),
            (0.1, 0.3, 0.720_443_4),
            (0.9, 0.1, 0.022_985_2),
        ] {
            assert!(close(at(&distance, right, down), want), "{right} {down}");
        }
        assert!(close(at(&dot(Between::Linear, false), 0.25, 0.25), 0.5625));
    }

    /// Values of POV-Ray: each pixel of a picture was lit alone.
    #[test]
    fn differences_are_those_of_three_places() {
        let picture = dot(Between::Nearest, false);
        let at = |right: f64, up: f64| {
            let p = Point3::new((3.6 + right) / 8.0, (4.7 + up) / 8.0, 0.0);
            let d = picture.differences(p, ImageValue::Grey);
            // White has the luminance 1 but for rounding.
            d.map(|x| (x * 1024.0).round() / 1024.0)
        };
        assert_eq!(at(0.0, 0.0), [0.0, 1.0]);
        assert_eq!(at(1.0, 1.0), [-0.5, -0.5]);
        assert_eq!(at(-1.0, 1.0), [0.5, -0.5]);
        assert_eq!((at(1.0, 0.0), at(0.0, 1.0), at(1.0, -1.0)), ([0.0; 2], [0.0; 2], [0.0; 2]));
    }

    /// Values of POV-Ray, as above: the pixels 10, 200 and 50 of a row are between pixels 0.
    #[test]
    fn differences_of_indices_are_whole() {
        let row = [0, 0, 10, 0, 200, 0, 50, 0];
        let indices = (0..64).map(|i| if i / 8 == 3 { row[i % 8] } else { 0 }).collect();
        let palette = vec![Colour::from_terms([0.0; 5]); 256];
        let image = Arc::new(Image::from_indices(8, 8, palette, indices).unwrap());
        let map =
            |between| ImageMap { image: Arc::clone(&image), layout: Layout::Flat, once: false, between };
        let up = |between, part: f64| {
            let picture = Picture(Arc::new(map(between)));
            let at = |i: u32| Point3::new((f64::from(i) + part) / 8.0, (4.0 + 7.0 / 16.0) / 8.0, 0.0);
            [1, 2, 3, 4, 5, 6, 7].map(|i| picture.differences(at(i), ImageValue::Index)[1])
        };
        assert_eq!(up(Between::Nearest, 9.0 / 16.0), [0.0, 10.0, 0.0, 200.0, 0.0, 50.0, 0.0]);
        assert_eq!(up(Between::Linear, 9.0 / 16.0), [0.0, 8.0, 11.0, 175.0, 2.0, 43.0, 0.0]);
        assert_eq!(up(Between::Distance, 9.0 / 16.0), [0.0, 9.0, 1.0, 195.0, 0.0, 48.0, 0.0]);
    }

    #[test]
    fn a_picture_is_repeated_unless_it_is_there_once() {
        let (endless, once) = (dot(Between::Nearest, false), dot(Between::Nearest, true));
        assert_eq!((at(&endless, 8.0, -16.0), at(&endless, 8.6, 0.0)), (1.0, 0.0));
        assert_eq!(once.colour(Point3::new(1.4, 0.5, 0.0)), CLEAR);
        assert_eq!(
            (at(&once, 0.4, 0.4), once.value(Point3::new(-0.1, 0.5, 0.0), ImageValue::Grey)),
            (1.0, 0.0)
        );
        assert_eq!(endless.colour(Point3::new(f64::INFINITY, 0.5, f64::NAN)).rgb.r, 0.0);
    }
}

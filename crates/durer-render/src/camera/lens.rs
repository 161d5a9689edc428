//! Lenses: the points at which rays start for focal blur.
//!
//! ```text
//!   lens        plane of focus
//!    ╷  ╲____        ╷              l   a point of the lens
//!    ●──────────●────┼──▶           P   where the ray of a pinhole meets the plane of focus
//!    ╵  ╱       P    ╵              the ray starts at l and runs through P
//! ```
//!
//! The lens is a disc whose radius is a quarter of the aperture. With 4, 7, 19 or 37 rays it is a
//! square or a hexagon of as many squares, one for each ray, and a bokeh gives it any shape. Each
//! point is moved at random, within a square of the side `1 / (2 sqrt(n))` for `n` rays. Rays also
//! start at random places within the pixel. The sizes were found from POV-Ray's pictures.
//!
//! Points in the pixel and on the disc are those of Halton's sequence (J. H. Halton, "On the
//! efficiency of certain quasi-random sequences of points", *Numerische Mathematik* 2 (1960)
//! 84-90), shifted for each place (R. Cranley and T. N. L. Patterson, "Randomization of number
//! theoretic methods for multiple integration", *SIAM J. Numer. Anal.* 13 (1976) 904-914). They
//! depend on the place alone, so the picture is the same for any number of threads.

use core::f64::consts::{FRAC_PI_4, TAU};

use durer_math::{Affine, AffineError, Point3, elementary};
use durer_scene::{Lens, Rgb};

use crate::sampler::random;
use crate::texture::{Around, RenderPigment};
use crate::vector::floor;

/// A [`Lens`] with its constants precomputed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RenderLens {
    aperture: f64,
    /// The distance of the plane of focus.
    pub(super) focus: f64,
    fewest: u32,
    most: u32,
    /// Sampling of a point ends when the squared standard error of the mean is at most this, in
    /// each channel.
    enough: f64,
    shape: Shape,
    /// The side of the square in which a point is moved at random.
    jitter: f64,
}

/// The shape of a lens of the aperture 1.
#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Disc,
    /// The centres of squares.
    Squares(Vec<[f64; 2]>),
    /// A cumulative distribution: for each cell of a grid with [`BOKEH`] columns and rows, the
    /// fraction of the light in this cell and all before it.
    Bokeh(Vec<f64>),
}

/// POV-Ray sends this many times as many rays as the variance alone requires: where half of the
/// rays are white, it stops after 97 of them with a variance of 0.03, and after about 370 with
/// 1/128.
const STRICTNESS: f64 = 4.4;

/// The number of columns and rows of cells of a bokeh.
const BOKEH: usize = 256;

/// The sums over a point's rays so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Samples {
    count: u32,
    sum: Rgb,
    squares: Rgb,
}

impl Samples {
    /// Adds the colour of a ray.
    pub(crate) fn add(&mut self, colour: Rgb) {
        self.count += 1;
        self.sum += colour;
        self.squares += Rgb::new(colour.r * colour.r, colour.g * colour.g, colour.b * colour.b);
    }

    /// The mean colour.
    pub(crate) fn mean(&self) -> Rgb {
        self.sum * (1.0 / f64::from(self.count.max(1)))
    }
}

impl RenderLens {
    /// Prepares a lens; `None` if its picture is that of a pinhole.
    pub(super) fn new(lens: &Lens) -> Result<Option<Self>, AffineError> {
        let [fewest, most] = lens.samples;
        if lens.aperture == 0.0 || most == 0 {
            return Ok(None);
        }
        let rings = |n: u32| (1..=3_u32).find(|k| 3 * k * (k + 1) + 1 == n);
        let mut jitter = 0.5 / f64::from(most).sqrt();
        let shape = match &lens.bokeh {
            Some(pigment) => bokeh(&RenderPigment::new(pigment, &Affine::IDENTITY)?),
            None if most == 4 => {
                jitter = 0.25;
                Shape::Squares(vec![[-0.125, -0.125], [0.125, -0.125], [-0.125, 0.125], [0.125, 0.125]])
            }
            None => match rings(most) {
                Some(rings) => {
                    jitter = 2.0 / f64::from(7 * (rings + 1));
                    Shape::Squares(hexagon(rings, jitter))
                }
                None => Shape::Disc,
            },
        };
        let deviations = quantile(lens.confidence);
        Ok(Some(Self {
            aperture: lens.aperture,
            focus: lens.focus,
            fewest: fewest.clamp(1, most),
            most,
            enough: lens.variance / (STRICTNESS * deviations * deviations),
            shape,
            jitter,
        }))
    }

    /// The number of rays of a point before the first check whether they are enough.
    pub(crate) fn fewest(&self) -> u32 {
        self.fewest
    }

    /// The most rays of a point.
    pub(crate) fn most(&self) -> u32 {
        self.most
    }

    /// Whether the mean of some rays is accurate enough.
    pub(crate) fn is_enough(&self, samples: &Samples) -> bool {
        if samples.count < self.fewest || samples.count < 2 {
            return samples.count >= self.most;
        }
        let n = f64::from(samples.count);
        // The squared standard error of a mean is the variance of the samples over their number.
        let error = |sum: f64, squares: f64| ((squares - sum * sum / n) / (n - 1.0)).max(0.0) / n;
        let (sum, squares) = (samples.sum, samples.squares);
        let near = |sum: f64, squares: f64| error(sum, squares) <= self.enough;
        samples.count >= self.most
            || near(sum.r, squares.r) && near(sum.g, squares.g) && near(sum.b, squares.b)
    }

    /// The shift of a ray's point of the picture in pixels, to the right and down, and its point on
    /// the lens, to the right and up. `x` and `y` are the point of the picture in pixels.
    pub(super) fn sample(&self, x: f64, y: f64, number: u32) -> ([f64; 2], [f64; 2]) {
        let place = x.to_bits().rotate_left(32) ^ y.to_bits();
        let even = |dimension: u64, base: u32| {
            let shifted = halton(number, base) + random(place, u64::MAX, dimension);
            shifted - floor(shifted)
        };
        let moved = |dimension| (random(place, u64::from(number), dimension) - 0.5) * self.jitter;
        let [u, v] = match &self.shape {
            Shape::Disc => on_disc(even(2, 2), even(3, 3)),
            Shape::Squares(middles) => {
                // Each in its turn, in another order for each place.
                let n = middles.len();
                let first = (random(place, u64::MAX, 2) * n as f64) as usize;
                // Of 7, 19 and 37, all smaller numbers are coprime to n; of 4, 1 is.
                let most = if n == 4 { 1 } else { n - 1 };
                let step = 1 + (random(place, u64::MAX, 3) * most as f64) as usize;
                middles[(first + step * (number as usize % n)) % n]
            }
            Shape::Bokeh(parts) => {
                let at = even(2, 2);
                let cell = parts.partition_point(|&part| part <= at).min(parts.len() - 1);
                let within = |cell: usize, dimension| {
                    let at = (cell as f64 + random(place, u64::from(number), dimension)) / BOKEH as f64;
                    (at - 0.5) * 0.5
                };
                // The pigment's y runs down the lens.
                [within(cell % BOKEH, 6), -within(cell / BOKEH, 7)]
            }
        };
        let shift = [even(0, 5) - 0.5, even(1, 7) - 0.5];
        (shift, [(u + moved(4)) * self.aperture, (v + moved(5)) * self.aperture])
    }
}

/// The centres of squares in rows that are shifted by half a square: `rings` around one.
fn hexagon(rings: u32, side: f64) -> Vec<[f64; 2]> {
    let rings = rings as i32;
    let height = 0.75_f64.sqrt() * side;
    let mut all = Vec::new();
    for row in -rings..=rings {
        let count = 2 * rings + 1 - row.abs();
        for i in 0..count {
            all.push([(f64::from(i) - 0.5 * f64::from(count - 1)) * side, f64::from(row) * height]);
        }
    }
    all
}

/// The shape of a pigment's brightness. One that is black everywhere leaves a square.
fn bokeh(pigment: &RenderPigment) -> Shape {
    let mut parts = Vec::with_capacity(BOKEH * BOKEH);
    let mut sum = 0.0;
    let middle = |i: usize| (i as f64 + 0.5) / BOKEH as f64;
    for cell in 0..BOKEH * BOKEH {
        let c = pigment.at(Point3::new(middle(cell % BOKEH), middle(cell / BOKEH), 0.0), Around::NOWHERE).rgb;
        sum += (0.297 * c.r + 0.589 * c.g + 0.114 * c.b).max(0.0);
        parts.push(sum);
    }
    let count = parts.len() as f64;
    for (i, part) in (1_u32..).zip(&mut parts) {
        *part = if sum > 0.0 && sum.is_finite() { *part / sum } else { f64::from(i) / count };
    }
    Shape::Bokeh(parts)
}

/// Maps the unit square to a disc of radius 1/4, preserving ratios of areas.
///
/// The map is that of P. Shirley and K. Chiu, "A low distortion map between disk and square",
/// *Journal of Graphics Tools* 2 (1997) 45-52.
fn on_disc(u: f64, v: f64) -> [f64; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let (r, angle) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, 0.25 * TAU - FRAC_PI_4 * (a / b)) };
    let (sin, cos) = elementary::sin_cos(angle);
    [0.25 * r * cos, 0.25 * r * sin]
}

/// The radical inverse of `i`: its digits in a base, mirrored at the radix point.
fn halton(mut i: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / f64::from(base));
    while i > 0 {
        value += f64::from(i % base) * digit;
        digit /= f64::from(base);
        i /= base;
    }
    value
}

/// The number of standard deviations within which a normal variable lies with this probability.
///
/// The approximation is 26.2.23 of M. Abramowitz and I. A. Stegun, *Handbook of Mathematical
/// Functions* (1964); its error is below 4.5e-4.
fn quantile(probability: f64) -> f64 {
    let outside = ((1.0 - probability) * 0.5).clamp(1e-12, 0.5);
    let t = (-2.0 * elementary::ln(outside)).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    // With the probability 0 any mean is accurate enough.
    (t - above / below).max(1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens(most: u32) -> RenderLens {
        let lens = Lens {
            aperture: 2.0,
            focus: 1.0,
            samples: [1, most],
            confidence: 0.9,
            variance: 1e-4,
            bokeh: None,
        };
        RenderLens::new(&lens).unwrap().unwrap()
    }

    #[test]
    fn points_fill_the_lens() {
        for (most, size) in [(400, 0.525), (4, 0.5), (7, 3.0 / 7.0), (19, 10.0 / 21.0), (37, 0.5)] {
            let lens = lens(most);
            let mut reach: f64 = 0.0;
            let (mut sum, mut squares) = ([0.0; 2], 0.0);
            for place in 0..100 {
                for number in 0..most {
                    let (shift, point) = lens.sample(0.5, f64::from(place) + 0.5, number);
                    assert!(shift.iter().all(|x| x.abs() <= 0.5));
                    reach = reach.max(point[0].abs());
                    (sum[0], sum[1]) = (sum[0] + point[0], sum[1] + point[1]);
                    squares += point[0] * point[0] + point[1] * point[1];
                }
            }
            let n = f64::from(most) * 100.0;
            assert!(reach <= size && reach > 0.93 * size, "{most}: {reach}");
            // Four standard deviations of the mean of points as far apart as these.
            assert!(sum.iter().all(|x| (x / n).abs() < 1.2 / n.sqrt()), "{most}: {sum:?}");
            if most == 400 {
                // A disc of radius 1/2 has the mean square 1/8; a square with side 1/20 adds 1/2400.
                assert!((squares / n - 0.125).abs() < 0.003, "{}", squares / n);
            }
        }
    }

    #[test]
    fn quantiles_are_those_of_the_table() {
        for (probability, wanted) in [(0.9, 1.6449), (0.99, 2.5758), (0.5, 0.6745)] {
            assert!((quantile(probability) - wanted).abs() < 4.5e-4);
        }
    }

    #[test]
    fn equal_colours_are_enough() {
        let lens = lens(100);
        let mut samples = Samples::default();
        samples.add(Rgb::WHITE);
        assert!(!lens.is_enough(&samples));
        samples.add(Rgb::WHITE);
        assert!(lens.is_enough(&samples) && samples.mean() == Rgb::WHITE);
        samples.add(Rgb::BLACK);
        assert!(!lens.is_enough(&samples));
    }
}

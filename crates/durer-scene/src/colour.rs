//! Colours: three channels of light, and for pigments also filter and transmit.

use core::ops::{Add, AddAssign, Mul};

/// Red, green and blue in the scene's own values: not clipped, and not yet converted to light by a
/// gamma.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb {
    /// Red.
    pub r: f64,
    /// Green.
    pub g: f64,
    /// Blue.
    pub b: f64,
}

impl Rgb {
    /// No light.
    pub const BLACK: Self = Self::grey(0.0);
    /// White: one in every channel.
    pub const WHITE: Self = Self::grey(1.0);

    /// Makes a colour from three channels.
    pub const fn new(r: f64, g: f64, b: f64) -> Self {
        Self { r, g, b }
    }

    /// The same value in every channel.
    pub const fn grey(v: f64) -> Self {
        Self { r: v, g: v, b: v }
    }

    /// Applies `f` to every channel.
    #[inline(always)]
    #[must_use]
    pub fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        Self { r: f(self.r), g: f(self.g), b: f(self.b) }
    }

    /// Applies `f` to the channels of two colours.
    #[inline(always)]
    #[must_use]
    pub fn zip(self, other: Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        Self { r: f(self.r, other.r), g: f(self.g, other.g), b: f(self.b, other.b) }
    }

    /// The greatest channel.
    #[inline(always)]
    pub fn greatest(self) -> f64 {
        self.r.max(self.g).max(self.b)
    }

    /// The brightness, with the scene language's weights 0.297, 0.589 and 0.114.
    #[inline(always)]
    pub fn luminance(self) -> f64 {
        0.297 * self.r + 0.589 * self.g + 0.114 * self.b
    }

    /// Whether every channel is exactly zero.
    #[inline(always)]
    pub fn is_black(self) -> bool {
        self.r == 0.0 && self.g == 0.0 && self.b == 0.0
    }

    /// Whether no channel is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }
}

impl Add for Rgb {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}

impl AddAssign for Rgb {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mul for Rgb {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}

impl Mul<f64> for Rgb {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        self.map(|a| a * k)
    }
}

/// A pigment's colour: what it reflects, and how much light passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Colour {
    /// Red, green and blue.
    pub rgb: Rgb,
    /// The fraction of light that passes and takes the colour.
    pub filter: f64,
    /// The fraction of light that passes unchanged.
    pub transmit: f64,
}

impl Colour {
    /// An opaque colour.
    pub const fn opaque(rgb: Rgb) -> Self {
        Self { rgb, filter: 0.0, transmit: 0.0 }
    }

    /// Makes a colour from the five terms red, green, blue, filter, transmit.
    pub const fn from_terms([r, g, b, filter, transmit]: [f64; 5]) -> Self {
        Self { rgb: Rgb::new(r, g, b), filter, transmit }
    }

    /// The factor of light that passes through: `rgb * filter + transmit`.
    #[inline(always)]
    pub fn passed(self) -> Rgb {
        self.rgb.map(|c| c * self.filter + self.transmit)
    }

    /// Interpolates all five terms from `self` (`k` = 0) to `other` (`k` = 1).
    #[inline(always)]
    #[must_use]
    pub fn mix(self, other: Self, k: f64) -> Self {
        let mix = |a: f64, b: f64| a + k * (b - a);
        Self {
            rgb: self.rgb.zip(other.rgb, mix),
            filter: mix(self.filter, other.filter),
            transmit: mix(self.transmit, other.transmit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_is_filtered_or_not() {
        let c = Colour::from_terms([1.0, 0.5, 0.0, 0.5, 0.25]);
        assert_eq!(c.passed(), Rgb::new(0.75, 0.5, 0.25));
    }

    #[test]
    fn all_five_terms_are_mixed() {
        let (a, b) = (Colour::opaque(Rgb::BLACK), Colour::from_terms([1.0, 2.0, 4.0, 0.5, 0.25]));
        assert_eq!(a.mix(b, 0.5), Colour::from_terms([0.5, 1.0, 2.0, 0.25, 0.125]));
    }
}

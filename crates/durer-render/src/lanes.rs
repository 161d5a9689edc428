//! Eight colours at a time, one a lane.

use core::ops::{Add, AddAssign, Mul};
use durer_math::{F8, M8};
use durer_scene::{Colour, Rgb};

#[inline(always)]
fn mix(a: f64, b: f64, k: F8) -> F8 {
    F8::splat(a) + k * (b - a)
}

/// Eight colours, channel by channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rgb8 {
    pub(crate) r: F8,
    pub(crate) g: F8,
    pub(crate) b: F8,
}

impl Rgb8 {
    /// No light.
    pub(crate) const BLACK: Self = Self { r: F8::ZERO, g: F8::ZERO, b: F8::ZERO };
    /// White: one in every channel.
    pub(crate) const WHITE: Self = Self { r: F8::ONE, g: F8::ONE, b: F8::ONE };

    /// The same colour in every lane.
    #[inline(always)]
    pub(crate) fn splat(c: Rgb) -> Self {
        Self { r: F8::splat(c.r), g: F8::splat(c.g), b: F8::splat(c.b) }
    }

    /// Eight greys: each number in every channel.
    #[inline(always)]
    pub(crate) fn grey(v: F8) -> Self {
        Self { r: v, g: v, b: v }
    }

    /// Applies `f` to every channel.
    #[inline(always)]
    pub(crate) fn map(self, f: impl Fn(F8) -> F8) -> Self {
        Self { r: f(self.r), g: f(self.g), b: f(self.b) }
    }

    /// Applies `f` to the channels of two colours.
    #[inline(always)]
    pub(crate) fn zip(self, o: Self, f: impl Fn(F8, F8) -> F8) -> Self {
        Self { r: f(self.r, o.r), g: f(self.g, o.g), b: f(self.b, o.b) }
    }

    /// Interpolates from `a` (`k` = 0) to `b` (`k` = 1).
    #[inline(always)]
    pub(crate) fn mixed(a: Rgb, b: Rgb, k: F8) -> Self {
        Self { r: mix(a.r, b.r, k), g: mix(a.g, b.g, k), b: mix(a.b, b.b, k) }
    }

    /// The greatest channel.
    #[inline(always)]
    pub(crate) fn greatest(self) -> F8 {
        self.r.max(self.g).max(self.b)
    }

    /// The luminance, as [`Rgb::luminance`] defines it.
    #[inline(always)]
    pub(crate) fn luminance(self) -> F8 {
        self.r * 0.297 + self.g * 0.589 + self.b * 0.114
    }

    /// The greatest magnitude of a channel.
    #[inline(always)]
    pub(crate) fn greatest_magnitude(self) -> F8 {
        self.map(F8::abs).greatest()
    }

    /// The lanes where every channel is exactly zero.
    #[inline(always)]
    pub(crate) fn is_black(self) -> M8 {
        self.r.equals(F8::ZERO) & self.g.equals(F8::ZERO) & self.b.equals(F8::ZERO)
    }

    /// Black where the mask is not set.
    #[inline(always)]
    pub(crate) fn kept(self, mask: M8) -> Self {
        self.map(
            #[inline(always)]
            |c| mask.keep(c),
        )
    }

    /// `self` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn or(self, mask: M8, no: Self) -> Self {
        self.zip(
            no,
            #[inline(always)]
            |yes, no| mask.select(yes, no),
        )
    }

    /// The colour in lane `i`.
    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Rgb {
        Rgb::new(self.r.0[i], self.g.0[i], self.b.0[i])
    }

    /// Puts a colour into lane `i`.
    #[inline(always)]
    pub(crate) fn set_lane(&mut self, i: usize, c: Rgb) {
        (self.r.0[i], self.g.0[i], self.b.0[i]) = (c.r, c.g, c.b);
    }
}

impl Add for Rgb8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { r: self.r + o.r, g: self.g + o.g, b: self.b + o.b }
    }
}

impl AddAssign for Rgb8 {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mul for Rgb8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { r: self.r * o.r, g: self.g * o.g, b: self.b * o.b }
    }
}

impl Mul<F8> for Rgb8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: F8) -> Self {
        Self { r: self.r * k, g: self.g * k, b: self.b * k }
    }
}

/// Eight colours of a pigment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour8 {
    pub(crate) rgb: Rgb8,
    pub(crate) filter: F8,
    pub(crate) transmit: F8,
}

impl Colour8 {
    /// The same colour in every lane.
    #[inline(always)]
    pub(crate) fn splat(c: Colour) -> Self {
        Self { rgb: Rgb8::splat(c.rgb), filter: F8::splat(c.filter), transmit: F8::splat(c.transmit) }
    }

    /// Calls `f` for each live lane.
    #[inline(always)]
    pub(crate) fn by_lane(live: M8, f: impl Fn(usize) -> Colour) -> Self {
        let mut all = Self::splat(Colour::default());
        for i in live.lanes() {
            let c = f(i);
            all.rgb.set_lane(i, c.rgb);
            (all.filter.0[i], all.transmit.0[i]) = (c.filter, c.transmit);
        }
        all
    }

    /// The factor of light that passes through.
    #[inline(always)]
    pub(crate) fn passed(self) -> Rgb8 {
        self.rgb.map(
            #[inline(always)]
            |c| c * self.filter + self.transmit,
        )
    }

    /// `self` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn or(self, mask: M8, no: Self) -> Self {
        Self {
            rgb: self.rgb.or(mask, no.rgb),
            filter: mask.select(self.filter, no.filter),
            transmit: mask.select(self.transmit, no.transmit),
        }
    }

    /// Adds other colours times their weights in some lanes.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self, weight: F8, lanes: M8) -> Self {
        let add = |a: F8, b: F8| lanes.select(a + b * weight, a);
        Self {
            rgb: self.rgb.zip(other.rgb, add),
            filter: add(self.filter, other.filter),
            transmit: add(self.transmit, other.transmit),
        }
    }

    /// Interpolates all five terms from `a` (`k` = 0) to `b` (`k` = 1).
    #[inline(always)]
    pub(crate) fn mixed(a: Colour, b: Colour, k: F8) -> Self {
        let (filter, transmit) = (mix(a.filter, b.filter, k), mix(a.transmit, b.transmit, k));
        Self { rgb: Rgb8::mixed(a.rgb, b.rgb, k), filter, transmit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_math::lanes::LANES;

    #[test]
    fn colours_are_those_of_the_lanes() {
        let (c, d) =
            (Colour::from_terms([0.1, 0.7, 0.3, 0.2, 0.5]), Colour::from_terms([0.9, 0.2, 0.4, 0.6, 0.1]));
        let (c8, k) = (Colour8::splat(c), F8([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.9, 1.0]));
        let mixed = Colour8::mixed(c, d, k);
        for i in 0..LANES {
            assert_eq!(c8.passed().lane(i), c.passed());
            assert_eq!(c8.rgb.luminance().0[i], c.rgb.luminance());
            assert_eq!(c8.rgb.greatest().0[i], c.rgb.greatest());
            let want = c.mix(d, k.0[i]);
            let got = (mixed.rgb.lane(i), mixed.filter.0[i], mixed.transmit.0[i]);
            assert_eq!(got, (want.rgb, want.filter, want.transmit));
        }
    }
}

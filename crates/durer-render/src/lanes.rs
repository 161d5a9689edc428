//! Masks and colours in lanes.
//!
//! A mask has a whole word for each lane: so the compiler keeps it in a vector register beside the numbers that it was made from, and choosing
//! is three operations on bits.

use core::ops::{Add, AddAssign, BitAnd, BitOr, Mul, Not};
use durer_math::lanes::LANES;
use durer_math::{F8, M8, Vec3};
use durer_scene::{Colour, Rgb};

/// Eight answers to a yes-no question: all bits of a lane are set, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(64))]
pub(crate) struct Mask([u64; LANES]);

#[inline(always)]
fn each<R>(f: impl Fn(usize) -> R) -> [R; LANES] {
    core::array::from_fn(f)
}

/// Where an answer about two numbers is yes.
macro_rules! comparisons {
    ($($(#[$doc:meta])* $name:ident $op:tt;)*) => {$(
        $(#[$doc])*
        #[inline(always)]
        pub(crate) fn $name(a: F8, b: F8) -> Mask {
            Mask(each(#[inline(always)] |i| if a.0[i] $op b.0[i] { u64::MAX } else { 0 }))
        }
    )*};
}
comparisons! {
    /// Where `a < b`.
    less <;
    /// Where `a <= b`.
    at_most <=;
    /// Where `a == b`.
    equal ==;
}

impl Mask {
    /// No lane.
    pub(crate) const NONE: Self = Self([0; LANES]);
    /// Every lane.
    pub(crate) const ALL: Self = Self([u64::MAX; LANES]);

    /// Bit `i` as lane `i`.
    #[inline(always)]
    pub(crate) fn from_bits(bits: u8) -> Self {
        Self(each(
            #[inline(always)]
            |i| 0_u64.wrapping_sub(u64::from(bits >> i & 1)),
        ))
    }

    /// Lane `i` as bit `i`.
    #[inline(always)]
    pub(crate) fn bits(self) -> u8 {
        (0..LANES).fold(
            0,
            #[inline(always)]
            |bits, i| bits | (self.0[i] as u8 & 1 << i),
        )
    }

    /// Whether lane `i` is set.
    #[inline(always)]
    pub(crate) fn has(self, i: usize) -> bool {
        self.0[i] != 0
    }

    /// Sets lane `i`.
    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize) {
        self.0[i] = u64::MAX;
    }

    /// Whether any lane is set.
    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        (0..LANES).fold(
            0,
            #[inline(always)]
            |all, i| all | self.0[i],
        ) != 0
    }

    /// The lanes that are set, ascending.
    #[inline(always)]
    pub(crate) fn lanes(self) -> Lanes {
        Lanes(self.bits())
    }

    /// `yes` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, yes: F8, no: F8) -> F8 {
        F8(each(
            #[inline(always)]
            |i| f64::from_bits(yes.0[i].to_bits() & self.0[i] | no.0[i].to_bits() & !self.0[i]),
        ))
    }

    /// As [`Mask::select`], for vectors.
    #[inline(always)]
    pub(crate) fn select3(self, yes: Vec3<F8>, no: Vec3<F8>) -> Vec3<F8> {
        Vec3::new(self.select(yes.x, no.x), self.select(yes.y, no.y), self.select(yes.z, no.z))
    }

    /// `x` where the mask is set, zero elsewhere.
    #[inline(always)]
    pub(crate) fn keep(self, x: F8) -> F8 {
        F8(each(
            #[inline(always)]
            |i| f64::from_bits(x.0[i].to_bits() & self.0[i]),
        ))
    }
}

/// The lanes of some set bits, ascending.
pub(crate) struct Lanes(pub(crate) u8);

impl Iterator for Lanes {
    type Item = usize;
    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let i = self.0.trailing_zeros() as usize;
        (self.0 != 0).then(|| {
            self.0 &= self.0 - 1;
            i
        })
    }
}

impl From<M8> for Mask {
    #[inline(always)]
    fn from(m: M8) -> Self {
        Self(each(
            #[inline(always)]
            |i| 0_u64.wrapping_sub(u64::from(m.0[i])),
        ))
    }
}

impl From<Mask> for M8 {
    #[inline(always)]
    fn from(m: Mask) -> Self {
        Self::from_bits(m.bits())
    }
}

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, o: Self) -> Self {
        Self(each(
            #[inline(always)]
            |i| self.0[i] & o.0[i],
        ))
    }
}

impl BitOr for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, o: Self) -> Self {
        Self(each(
            #[inline(always)]
            |i| self.0[i] | o.0[i],
        ))
    }
}

impl Not for Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(each(
            #[inline(always)]
            |i| !self.0[i],
        ))
    }
}

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
    /// One in every channel.
    pub(crate) const WHITE: Self = Self { r: F8::ONE, g: F8::ONE, b: F8::ONE };

    /// The same colour in every lane.
    #[inline(always)]
    pub(crate) fn splat(c: Rgb) -> Self {
        Self { r: F8::splat(c.r), g: F8::splat(c.g), b: F8::splat(c.b) }
    }

    /// The same number in every channel.
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

    /// The colours on the way from `a` (`k` = 0) to `b` (`k` = 1).
    #[inline(always)]
    pub(crate) fn mixed(a: Rgb, b: Rgb, k: F8) -> Self {
        Self { r: mix(a.r, b.r, k), g: mix(a.g, b.g, k), b: mix(a.b, b.b, k) }
    }

    /// The greatest channel.
    #[inline(always)]
    pub(crate) fn greatest(self) -> F8 {
        self.r.max(self.g).max(self.b)
    }

    /// As [`Rgb::luminance`].
    #[inline(always)]
    pub(crate) fn luminance(self) -> F8 {
        self.r * 0.297 + self.g * 0.589 + self.b * 0.114
    }

    /// Where every channel is exactly zero.
    #[inline(always)]
    pub(crate) fn is_black(self) -> Mask {
        equal(self.r, F8::ZERO) & equal(self.g, F8::ZERO) & equal(self.b, F8::ZERO)
    }

    /// Black where the mask is not set.
    #[inline(always)]
    pub(crate) fn kept(self, mask: Mask) -> Self {
        self.map(
            #[inline(always)]
            |c| mask.keep(c),
        )
    }

    /// `self` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn or(self, mask: Mask, no: Self) -> Self {
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

    /// Each lane by itself, of those that are set.
    #[inline(always)]
    pub(crate) fn by_lane(live: Mask, f: impl Fn(usize) -> Colour) -> Self {
        let mut all = Self::splat(Colour::default());
        for i in live.lanes() {
            let c = f(i);
            all.rgb.set_lane(i, c.rgb);
            (all.filter.0[i], all.transmit.0[i]) = (c.filter, c.transmit);
        }
        all
    }

    /// What light that passes through is multiplied by.
    #[inline(always)]
    pub(crate) fn passed(self) -> Rgb8 {
        self.rgb.map(
            #[inline(always)]
            |c| c * self.filter + self.transmit,
        )
    }

    /// `self` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn or(self, mask: Mask, no: Self) -> Self {
        Self {
            rgb: self.rgb.or(mask, no.rgb),
            filter: mask.select(self.filter, no.filter),
            transmit: mask.select(self.transmit, no.transmit),
        }
    }

    /// All five terms on the way from `a` (`k` = 0) to `b` (`k` = 1).
    #[inline(always)]
    pub(crate) fn mixed(a: Colour, b: Colour, k: F8) -> Self {
        let (filter, transmit) = (mix(a.filter, b.filter, k), mix(a.transmit, b.transmit, k));
        Self { rgb: Rgb8::mixed(a.rgb, b.rgb, k), filter, transmit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_and_bits_are_two_ways_to_say_the_same() {
        for bits in 0..=255_u8 {
            let mask = Mask::from_bits(bits);
            assert_eq!((mask.bits(), mask.any(), (!mask).bits()), (bits, bits != 0, !bits));
            assert_eq!(Mask::from(M8::from(mask)), mask);
            assert_eq!(M8::from(mask).bits(), bits);
            let lanes: Vec<_> = mask.lanes().collect();
            assert_eq!(lanes, (0..LANES).filter(|i| bits >> i & 1 == 1).collect::<Vec<_>>());
            let chosen = mask.select(F8::ONE, F8::ZERO);
            assert!((0..LANES).all(|i| (chosen.0[i] == 1.0) == (bits >> i & 1 == 1)));
            assert_eq!(chosen, mask.keep(F8::ONE));
        }
    }

    #[test]
    fn comparisons_are_those_of_numbers() {
        let a = F8([1.0, 2.0, 3.0, f64::NAN, 0.0, -0.0, f64::INFINITY, -1.0]);
        let b = F8([2.0, 2.0, 2.0, 2.0, -0.0, 0.0, f64::INFINITY, f64::NAN]);
        assert_eq!([less(a, b), at_most(a, b), equal(a, b)].map(Mask::bits), [0b1, 0b111_0011, 0b111_0010]);
    }

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

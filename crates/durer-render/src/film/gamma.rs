//! Conversions between the scene's colour values, light, and the values of a file.
//!
//! | the scene says | `rgb 0.5` in an sRGB file |
//! | --- | --- |
//! | `assumed_gamma 1` | 0.735 |
//! | `assumed_gamma 2.2` | 0.504 |
//! | `assumed_gamma srgb` | 0.5 |
//! | nothing, before version 3.7 | 0.5 (no correction at all) |
//!
//! The sRGB curve is that of IEC 61966-2-1 (1999).

use durer_math::lanes::LANES;
use durer_math::{Isa, elementary};
use durer_scene::{AssumedGamma, Rgb};

/// How the colour values of a film relate to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// The values are light.
    Linear,
    /// Light is the value to this power.
    Power(f64),
    /// The values are those of an sRGB file.
    Srgb,
}

impl From<AssumedGamma> for Encoding {
    fn from(gamma: AssumedGamma) -> Self {
        match gamma {
            AssumedGamma::Power(1.0) => Self::Linear,
            AssumedGamma::Power(power) => Self::Power(power),
            // The values of a scene without any gamma are written to the file unchanged.
            AssumedGamma::Srgb | AssumedGamma::None => Self::Srgb,
        }
    }
}

impl Encoding {
    /// The light for the colour value `v`.
    pub fn light(self, v: f64) -> f64 {
        match self {
            Self::Linear => v,
            Self::Power(power) => {
                if v > 0.0 {
                    elementary::pow(v, power)
                } else {
                    0.0
                }
            }
            Self::Srgb => decode(v),
        }
    }

    /// The value of an sRGB file, from 0 to 1, for the colour value `v`.
    pub fn file(self, v: f64) -> f64 {
        let value = match self {
            Self::Srgb => v,
            _ => encode(self.light(v).clamp(0.0, 1.0)),
        };
        // NaN is shown as black.
        if value > 0.0 { value.min(1.0) } else { 0.0 }
    }

    /// The colour value for the value of an sRGB file, from 0 to 1. This is the inverse of
    /// [`Encoding::file`].
    fn shown(self, value: f64) -> f64 {
        match self {
            Self::Srgb => value,
            _ => self.number(decode(value)),
        }
    }

    /// The colour value for a light. This is the inverse of [`Encoding::light`].
    fn number(self, light: f64) -> f64 {
        match self {
            Self::Linear => light,
            Self::Power(power) => elementary::pow(light, 1.0 / power),
            Self::Srgb => encode(light),
        }
    }

    /// The least colour value that is written as the byte `k` or a greater one.
    fn least(self, k: u8) -> f64 {
        let reaches = |bits| (self.file(f64::from_bits(bits)) * 255.0 + 0.5) as u8 >= k;
        // Positive f64 numbers are in the order of their bits. Rounding moves the guess by a few
        // ulps at most, so the exact end is near it.
        let guess = self.number(decode((f64::from(k) - 0.5) / 255.0)).clamp(0.0, 1.0).to_bits();
        let (mut below, mut above, mut step) = (guess, guess, 1);
        if reaches(guess) {
            below = below.saturating_sub(step);
            while reaches(below) {
                (above, step) = (below, step * 2);
                below = below.saturating_sub(step);
            }
        } else {
            above = (above + step).min(1.0_f64.to_bits());
            while !reaches(above) {
                (below, step) = (above, step * 2);
                above = (above + step).min(1.0_f64.to_bits());
            }
        }
        while above - below > 1 {
            let middle = below + (above - below) / 2;
            if reaches(middle) { above = middle } else { below = middle }
        }
        f64::from_bits(above)
    }
}

/// A table that finds the byte of an 8-bit file by comparison. For each byte it holds the least
/// colour value that is written as that byte.
#[derive(Clone, Debug, PartialEq)]
pub struct Bytes {
    /// The last entry is above every value.
    least: [f64; 257],
    /// The byte at the lower end of each cell, where the search starts.
    start: Box<[u8; 2 * CELLS]>,
    /// Whether every cell holds the lower end of one byte at most.
    is_fine: bool,
    /// The colour value for each byte.
    numbers: [f64; 256],
}

/// The number of cells of `[0, 1]`; their middles are the multiples of `1 / CELLS`. The cells are
/// so small that few hold the lower ends of two bytes, even where the sRGB curve is steep.
const CELLS: usize = 4096;

/// Adding this to a number in `[0, 1]` rounds the number to the middle of its cell. The last bits
/// of the sum are then the number of the cell.
const ROUNDER: f64 = (1_u64 << 52) as f64 / CELLS as f64;

impl Bytes {
    /// The table for an encoding.
    pub fn new(encoding: Encoding) -> Self {
        let mut least = [f64::INFINITY; 257];
        least[0] = 0.0;
        for k in 1..=255_u8 {
            least[usize::from(k)] = encoding.least(k);
        }
        let mut byte = 0;
        let mut start = Box::new([0; 2 * CELLS]);
        let mut is_fine = true;
        for (i, start) in start.iter_mut().enumerate() {
            let end = (i as f64 - 0.5) / CELLS as f64;
            let before = byte;
            while least[byte + 1] <= end {
                byte += 1;
            }
            is_fine &= byte - before <= 1;
            *start = byte as u8;
        }
        let numbers = core::array::from_fn(|k| encoding.shown(k as f64 / 255.0));
        Self { least, start, is_fine, numbers }
    }

    /// The colour value for a byte.
    pub(super) fn number(&self, byte: u8) -> f64 {
        self.numbers[usize::from(byte)]
    }

    /// Converts colour values to bytes.
    pub(super) fn of_all(&self, numbers: &[f64], bytes: &mut [u8]) {
        let (eights, rest) = numbers.as_chunks::<LANES>();
        let (byte_eights, byte_rest) = bytes.as_chunks_mut::<LANES>();
        Isa::detect().run_in_lanes(
            #[inline(always)]
            || {
                for (numbers, bytes) in eights.iter().zip(byte_eights) {
                    self.of_some(numbers, bytes);
                }
            },
        );
        for (&v, byte) in rest.iter().zip(byte_rest) {
            *byte = self.of(v);
        }
    }

    /// Converts colours to three bytes each.
    pub fn of_colours(&self, colours: &[Rgb], bytes: &mut [[u8; 3]]) {
        let (eights, rest) = colours.as_chunks::<LANES>();
        let (byte_eights, byte_rest) = bytes.as_chunks_mut::<LANES>();
        Isa::detect().run_in_lanes(
            #[inline(always)]
            || {
                let mut numbers = [0.0; 3 * LANES];
                let mut known = [0; 3 * LANES];
                self.of_some(&numbers, &mut known);
                for (colours, bytes) in eights.iter().zip(byte_eights) {
                    // Neighbours often have the same colour, the background's.
                    let mut differ = 0;
                    for (i, Rgb { r, g, b }) in colours.iter().enumerate() {
                        for (k, v) in [*r, *g, *b].into_iter().enumerate() {
                            differ |= v.to_bits() ^ numbers[3 * i + k].to_bits();
                            numbers[3 * i + k] = v;
                        }
                    }
                    if differ != 0 {
                        self.of_some(&numbers, &mut known);
                    }
                    bytes.as_flattened_mut().copy_from_slice(&known);
                }
            },
        );
        for (&Rgb { r, g, b }, bytes) in rest.iter().zip(byte_rest) {
            *bytes = [self.of(r), self.of(g), self.of(b)];
        }
    }

    /// Finds the cells in lanes and the bytes one by one.
    #[inline(always)]
    fn of_some<const N: usize>(&self, numbers: &[f64; N], bytes: &mut [u8; N]) {
        let (mut values, mut places) = ([0.0; N], [0; N]);
        for i in 0..N {
            values[i] = within(numbers[i]);
            places[i] = place(values[i]);
        }
        if self.is_fine {
            for i in 0..N {
                bytes[i] = self.near(values[i], places[i]);
            }
        } else {
            for i in 0..N {
                bytes[i] = self.from(values[i], places[i]);
            }
        }
    }

    /// The byte for the colour value `v`.
    #[inline(always)]
    pub(super) fn of(&self, v: f64) -> u8 {
        let v = within(v);
        self.from(v, place(v))
    }

    /// [`Bytes::from`] for tables where no cell holds the lower ends of two bytes.
    #[inline(always)]
    fn near(&self, v: f64, place: usize) -> u8 {
        let byte = self.start[place];
        byte + u8::from(self.least[usize::from(byte) + 1] <= v)
    }

    /// The byte for a value in the cell `place`.
    #[inline(always)]
    fn from(&self, v: f64, place: usize) -> u8 {
        let mut byte = self.start[place];
        while self.least[usize::from(byte) + 1] <= v {
            byte += 1;
        }
        byte
    }
}

/// Clamps a value to `[0, 1]`; NaN becomes 0, black.
#[inline(always)]
fn within(v: f64) -> f64 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < 1.0 { v } else { 1.0 }
}

/// The number of the cell that holds a number in `[0, 1]`.
#[inline(always)]
fn place(v: f64) -> usize {
    (v + ROUNDER).to_bits() as usize & (2 * CELLS - 1)
}

/// The sRGB curve: from light in `[0, 1]` to the file's value.
fn encode(light: f64) -> f64 {
    match light {
        ..=0.003_130_8 => 12.92 * light,
        // The formula loses a digit here.
        1.0.. => 1.0,
        _ => 1.055 * elementary::pow(light, 1.0 / 2.4) - 0.055,
    }
}

/// The inverse of [`encode`], also for values above 1.
fn decode(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { elementary::pow((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_holds() {
        let file = |gamma| Encoding::from(gamma).file(0.5);
        assert!((file(AssumedGamma::Power(1.0)) - 0.735_357).abs() < 1e-6);
        assert!((file(AssumedGamma::Power(2.2)) - 0.503_9).abs() < 5e-5);
        assert_eq!(file(AssumedGamma::Srgb), 0.5);
        assert_eq!(file(AssumedGamma::None), 0.5);
    }

    #[test]
    fn values_beyond_the_file_are_cut() {
        for encoding in [Encoding::Linear, Encoding::Power(2.2), Encoding::Srgb] {
            assert_eq!([-1.0, 0.0, 1.0, 7.0, f64::NAN].map(|v| encoding.file(v)), [0.0, 0.0, 1.0, 1.0, 0.0]);
        }
    }

    #[test]
    fn the_table_gives_the_formulas_bytes() {
        for encoding in [Encoding::Linear, Encoding::Power(2.2), Encoding::Power(0.7), Encoding::Srgb] {
            let table = Bytes::new(encoding);
            // The curve of a small power is too steep at 0.
            assert_eq!(table.is_fine, encoding != Encoding::Power(0.7), "{encoding:?}");
            let byte = |v: f64| (encoding.file(v) * 255.0 + 0.5) as u8;
            for i in -100..=40_000 {
                let v = f64::from(i) / 39_000.0;
                assert_eq!(table.of(v), byte(v), "{encoding:?} {v}");
            }
            for k in 1..=255 {
                let v = table.least[k];
                assert_eq!((table.of(v.next_down()), table.of(v)), (k as u8 - 1, k as u8));
            }
            assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|v| table.of(v)), [0, 255, 0]);
            // Many values at once, and a few that do not fill a group; values around the lower ends
            // of bytes, where the curve is steep.
            let near = |k: usize| [table.least[k].next_down(), table.least[k]];
            let numbers: Vec<f64> = (1..=255).flat_map(near).chain([f64::NAN, 7.0, -7.0, 0.0, 1.0]).collect();
            let mut bytes = vec![7; numbers.len()];
            table.of_all(&numbers, &mut bytes);
            assert_eq!(bytes, numbers.iter().map(|&v| byte(v)).collect::<Vec<_>>(), "{encoding:?}");
            // The same values as colours: eight that differ, eight equal ones, eight equal ones
            // except the last, black again, and a few that do not fill a group.
            let mut colours: Vec<Rgb> =
                numbers.as_chunks::<3>().0.iter().map(|&[r, g, b]| Rgb { r, g, b }).collect();
            let grey = Rgb { r: 0.3, g: 0.4, b: 0.5 };
            let end = colours.len() / 8 * 8;
            colours.splice(end..end, [[grey; 8], [grey; 8], [grey; 8], [Rgb::BLACK; 8]].concat());
            colours[end + 23].b = 0.7;
            let mut bytes = vec![[7; 3]; colours.len()];
            table.of_colours(&colours, &mut bytes);
            let each = |c: &Rgb| [byte(c.r), byte(c.g), byte(c.b)];
            assert_eq!(bytes, colours.iter().map(each).collect::<Vec<_>>(), "{encoding:?}");
        }
    }

    #[test]
    fn decoding_undoes_encoding() {
        for light in [0.0, 0.001, 0.01, 0.2, 0.7, 1.0] {
            assert!((decode(encode(light)) - light).abs() < 1e-9);
        }
    }
}

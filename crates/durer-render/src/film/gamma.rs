//! From the scene's numbers to light and to files.
//!
//! | the scene says | `rgb 0.5` in an sRGB file |
//! | --- | --- |
//! | `assumed_gamma 1` | 0.735 |
//! | `assumed_gamma 2.2` | 0.504 |
//! | `assumed_gamma srgb` | 0.5 |
//! | nothing, before version 3.7 | 0.5 (no correction at all) |
//!
//! The sRGB curve is that of IEC 61966-2-1 (1999).

use durer_math::elementary;
use durer_scene::AssumedGamma;

/// How the numbers of a film relate to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// They are light.
    Linear,
    /// Light is the number to this power.
    Power(f64),
    /// They are values of an sRGB file.
    Srgb,
}

impl From<AssumedGamma> for Encoding {
    fn from(gamma: AssumedGamma) -> Self {
        match gamma {
            AssumedGamma::Power(1.0) => Self::Linear,
            AssumedGamma::Power(power) => Self::Power(power),
            // A scene without any gamma writes its numbers into the file.
            AssumedGamma::Srgb | AssumedGamma::None => Self::Srgb,
        }
    }
}

impl Encoding {
    /// The light that the number `v` stands for.
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

    /// The value of an sRGB file, from 0 to 1, for the number `v`.
    pub fn file(self, v: f64) -> f64 {
        let value = match self {
            Self::Srgb => v,
            _ => encode(self.light(v).clamp(0.0, 1.0)),
        };
        // NaN is shown black.
        if value > 0.0 { value.min(1.0) } else { 0.0 }
    }
}

/// The sRGB curve: from light in `[0, 1]` to the file's value.
fn encode(light: f64) -> f64 {
    match light {
        ..=0.003_130_8 => 12.92 * light,
        // Where the formula is a digit short.
        1.0.. => 1.0,
        _ => 1.055 * elementary::pow(light, 1.0 / 2.4) - 0.055,
    }
}

/// The inverse of [`encode`], going on beyond 1.
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
    fn decoding_undoes_encoding() {
        for light in [0.0, 0.001, 0.01, 0.2, 0.7, 1.0] {
            assert!((decode(encode(light)) - light).abs() < 1e-9);
        }
    }
}

//! Functions and constants in expressions: floats, vectors, and queries of strings and arrays.

use durer_math::elementary;

use crate::diagnostics::{Error, Place, Result};
use crate::expression::{finite, same};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::transform::{self, Matrix};
use crate::value::Terms;

/// Days from 1970-01-01 to 2000-01-01, where `now` starts to count.
const DAYS_TO_2000: f64 = 10_957.0;
const SECONDS_PER_DAY: f64 = 86_400.0;

/// Whether `keyword` is a constant or function of expressions.
pub(crate) fn begins_expression(keyword: Keyword) -> bool {
    use Keyword::*;
    constant(keyword).is_some()
        || float_function(keyword).is_some()
        || needs_more(keyword)
        || matches!(
            keyword,
            Clock
                | ClockOn
                | Now
                | Version
                | Abs
                | Atan2
                | BitwiseAnd
                | BitwiseOr
                | BitwiseXor
                | Asc
                | Defined
                | Dimensions
                | DimensionSize
                | Div
                | FileExists
                | Inside
                | Max
                | MaxExtent
                | Min
                | MinExtent
                | Mod
                | Pow
                | Rand
                | Seed
                | Select
                | Strcmp
                | Strlen
                | Trace
                | Val
                | Vdot
                | Vlength
                | VaxisRotate
                | Vturbulence
                | Vcross
                | Vnormalize
                | Vrotate
        )
}

/// Functions that need something that is not supported yet: user-defined functions, noise.
fn needs_more(keyword: Keyword) -> bool {
    use Keyword::*;
    matches!(keyword, Prod | Sum)
}

fn constant(keyword: Keyword) -> Option<Terms> {
    Some(match keyword {
        Keyword::X => Terms::new(&[1.0, 0.0, 0.0]),
        Keyword::Y => Terms::new(&[0.0, 1.0, 0.0]),
        Keyword::Z => Terms::new(&[0.0, 0.0, 1.0]),
        Keyword::T => Terms::new(&[0.0, 0.0, 0.0, 1.0]),
        Keyword::U => Terms::new(&[1.0, 0.0]),
        Keyword::V => Terms::new(&[0.0, 1.0]),
        Keyword::Pi => std::f64::consts::PI.into(),
        Keyword::On | Keyword::Yes | Keyword::True => 1.0.into(),
        Keyword::Off | Keyword::No | Keyword::False => 0.0.into(),
        _ => return None,
    })
}

/// Functions of one float that are defined everywhere, or whose domain is checked by [`domain`].
fn float_function(keyword: Keyword) -> Option<fn(f64) -> f64> {
    Some(match keyword {
        Keyword::Acos => |v| elementary::acos(v.clamp(-1.0, 1.0)),
        Keyword::Acosh => elementary::acosh,
        Keyword::Asin => |v| elementary::asin(v.clamp(-1.0, 1.0)),
        Keyword::Asinh => elementary::asinh,
        Keyword::Atan => elementary::atan,
        Keyword::Atanh => elementary::atanh,
        Keyword::Ceil => f64::ceil,
        Keyword::Cos => elementary::cos,
        Keyword::Cosh => elementary::cosh,
        Keyword::Degrees => f64::to_degrees,
        Keyword::Exp => elementary::exp,
        Keyword::Floor => f64::floor,
        Keyword::Int => f64::trunc,
        Keyword::Ln => elementary::ln,
        Keyword::Log => elementary::log10,
        Keyword::Radians => f64::to_radians,
        Keyword::Sin => elementary::sin,
        Keyword::Sinh => elementary::sinh,
        Keyword::Sqrt => f64::sqrt,
        Keyword::Tan => elementary::tan,
        Keyword::Tanh => elementary::tanh,
        _ => return None,
    })
}

/// The error message if the argument `v` is outside of the domain of `keyword`.
fn domain(keyword: Keyword, v: f64) -> Option<&'static str> {
    match keyword {
        Keyword::Sqrt if v < 0.0 => Some("the square root of a negative number"),
        Keyword::Ln | Keyword::Log if v <= 0.0 => Some("the logarithm of a number that is not positive"),
        Keyword::Acosh if v < 1.0 => Some("acosh of a number below 1"),
        Keyword::Atanh if v.abs() >= 1.0 => Some("atanh of a number that is not between -1 and 1"),
        _ => None,
    }
}

fn flag(value: bool) -> Terms {
    f64::from(u8::from(value)).into()
}

impl Parser<'_> {
    /// The value of the constant or function `keyword`, which was just taken; `None` if it is
    /// neither.
    pub(crate) fn function(&mut self, keyword: Keyword, place: Place) -> Result<Option<Terms>> {
        if let Some(value) = constant(keyword) {
            return Ok(Some(value));
        }
        match keyword {
            Keyword::Clock => return Ok(Some(self.options.clock.into())),
            Keyword::ClockOn => {
                let declared = &self.options.declares;
                let in_sequence = declared.iter().any(|(name, value)| name == "final_frame" && *value > 0.0);
                return Ok(Some(flag(in_sequence || self.options.clock != 0.0)));
            }
            Keyword::Version => return Ok(Some(self.language.version.into())),
            Keyword::Now => {
                let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
                let seconds = since.map_or(0.0, |d| d.as_secs_f64());
                return Ok(Some((seconds / SECONDS_PER_DAY - DAYS_TO_2000).into()));
            }
            _ if needs_more(keyword) => return Err(Error::unsupported(place, keyword.text())),
            _ if !begins_expression(keyword) => return Ok(None),
            _ => {}
        }
        self.expect(Mark::ParenOpen)?;
        let value = match float_function(keyword) {
            Some(f) => {
                let v = self.float()?;
                if let Some(what) = domain(keyword, v) {
                    return Err(Error::invalid(place, format!("{what} ({v})")));
                }
                if matches!(keyword, Keyword::Asin | Keyword::Acos) && v.abs() > 1.0 {
                    self.notice(place, format!("{} of {v}: taken as of {}", keyword.text(), v.signum()));
                }
                f(v).into()
            }
            None => self.called(keyword, place)?,
        };
        self.expect(Mark::ParenClose)?;
        // With NaN or infinity every later decision would be arbitrary.
        for &part in value.as_slice() {
            finite(part, place)?;
        }
        Ok(Some(value))
    }

    /// Reads a float and the comma after it.
    fn argument(&mut self) -> Result<f64> {
        let value = self.float()?;
        self.skip_comma()?;
        Ok(value)
    }

    fn vector_argument(&mut self) -> Result<[f64; 3]> {
        let value = self.vector()?;
        self.skip_comma()?;
        Ok(value)
    }

    /// Reads functions of more than one float, with their parentheses.
    fn called(&mut self, keyword: Keyword, place: Place) -> Result<Terms> {
        Ok(match keyword {
            Keyword::Abs => self.expression()?.map(f64::abs),
            Keyword::Atan2 => {
                let y = self.argument()?;
                elementary::atan2(y, self.argument()?).into()
            }
            Keyword::BitwiseAnd => self.bits(|a, b| a & b)?,
            Keyword::BitwiseOr => self.bits(|a, b| a | b)?,
            Keyword::BitwiseXor => self.bits(|a, b| a ^ b)?,
            Keyword::Div | Keyword::Mod => {
                let (a, b) = (self.argument()?, self.argument()?);
                if b == 0.0 {
                    return Err(Error::invalid(place, "division by zero"));
                }
                if keyword == Keyword::Div { (a / b).trunc().into() } else { (a % b).into() }
            }
            Keyword::Pow => {
                let (a, b) = (self.argument()?, self.argument()?);
                elementary::pow(a, b).into()
            }
            Keyword::Max | Keyword::Min => {
                let mut value = self.argument()?;
                while !self.at_mark(Mark::ParenClose)? {
                    let next = self.argument()?;
                    value = if keyword == Keyword::Max { value.max(next) } else { value.min(next) };
                }
                value.into()
            }
            Keyword::Select => {
                let chosen = self.argument()?;
                let mut choices = Vec::new();
                while !self.at_mark(Mark::ParenClose)? && choices.len() < 3 {
                    choices.push(self.expression()?);
                    self.skip_comma()?;
                }
                if choices.len() < 2 {
                    return Err(Error::invalid(place, "select needs three or four arguments"));
                }
                let last = choices.len() - 1;
                if chosen < 0.0 {
                    choices[0]
                } else if chosen == 0.0 {
                    choices[1]
                } else {
                    choices[last]
                }
            }
            Keyword::Rand => self.rand(place)?.into(),
            Keyword::Seed => self.seed(place)?.into(),
            Keyword::Asc => {
                let text = self.string("a string")?;
                text.chars().next().map_or(0.0, |c| f64::from(u32::from(c))).into()
            }
            Keyword::Strlen => (self.string("a string")?.chars().count() as f64).into(),
            Keyword::Strcmp => {
                let a = self.string("a string")?;
                self.skip_comma()?;
                let b = self.string("a string")?;
                f64::from(a.cmp(&b) as i8).into()
            }
            Keyword::Val => {
                let text = self.string("a string")?;
                crate::strings::number_in(&text).into()
            }
            Keyword::FileExists => {
                let name = self.file_name()?;
                flag(self.written_file(&name).is_some() || self.library.find(&name).is_some())
            }
            Keyword::Defined => flag(self.defined_name()?),
            Keyword::Dimensions => (self.array_argument()?.sizes.len() as f64).into(),
            Keyword::DimensionSize => {
                let array = self.array_argument()?;
                self.skip_comma()?;
                let which = self.float()?;
                let index = if which >= 1.0 { which as usize - 1 } else { usize::MAX };
                let size = array.sizes.get(index);
                (*size.ok_or_else(|| Error::invalid(place, "the array has no such dimension"))? as f64).into()
            }
            Keyword::Vturbulence => {
                let (lambda, omega, octaves) = (self.argument()?, self.argument()?, self.argument()?);
                let at = self.vector()?;
                self.count_steps(10, place)?;
                let noise = self.options.noise.as_deref();
                crate::noise_pattern::vector_turbulence(noise, [lambda, omega, octaves], at).into()
            }
            Keyword::Vdot => transform::dot(self.vector_argument()?, self.vector_argument()?).into(),
            Keyword::Vlength => transform::length(self.vector_argument()?).into(),
            Keyword::Vcross => transform::cross(self.vector_argument()?, self.vector_argument()?).into(),
            Keyword::Vnormalize => {
                let v = self.vector_argument()?;
                let length = transform::length(v);
                if length == 0.0 {
                    self.notice(place, "vnormalize of a vector without length gives <0, 0, 0>");
                    v.into()
                } else {
                    v.map(|part| part / length).into()
                }
            }
            Keyword::Vrotate => {
                let v = self.vector_argument()?;
                Matrix::rotation(self.vector_argument()?).direction(v).into()
            }
            Keyword::VaxisRotate => {
                let (v, axis) = (self.vector_argument()?, self.vector_argument()?);
                Matrix::turn(axis, self.argument()?).direction(v).into()
            }
            Keyword::Trace => self.trace(place)?,
            Keyword::Inside => self.inside(place)?,
            Keyword::MinExtent => self.end_of_extent(false, place)?,
            Keyword::MaxExtent => self.end_of_extent(true, place)?,
            // `begins_expression` lists no other functions.
            _ => return Err(Error::unsupported(place, keyword.text())),
        })
    }

    fn bits(&mut self, f: fn(i64, i64) -> i64) -> Result<Terms> {
        let (a, b) = (self.argument()?, self.argument()?);
        Ok((f(a as i64, b as i64) as f64).into())
    }

    /// `seed(n)`: starts a new stream and returns its number, from 0.
    fn seed(&mut self, place: Place) -> Result<f64> {
        let seed = self.float()?;
        self.check_memory(4 * self.streams.len(), place)?;
        crate::limits::charge_for_good(4);
        self.streams.push(seed as i64 as u32);
        Ok((self.streams.len() - 1) as f64)
    }

    /// `rand(stream)`: uses the generator of the scene language, since scenes place objects with
    /// it.
    fn rand(&mut self, place: Place) -> Result<f64> {
        let stream = self.float()?;
        let known = stream >= 0.0 && same(stream, stream.round());
        let state = self.streams.get_mut(stream.round() as usize).filter(|_| known);
        let Some(state) = state else {
            return Err(Error::invalid(place, format!("no seed() gave a random stream {stream}")));
        };
        *state = state.wrapping_mul(1_812_433_253).wrapping_add(12_345);
        Ok(f64::from(*state) / f64::from(u32::MAX))
    }
}

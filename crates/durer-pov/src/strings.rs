//! Strings: literals, their escapes, and the functions that return strings.

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::value::Value;

/// Greater widths or numbers of digits are refused.
const WIDEST: f64 = 1000.0;

/// Whether `keyword` is a function that returns a string.
pub(crate) fn makes_string(keyword: Keyword) -> bool {
    use Keyword::*;
    matches!(keyword, Str | Concat | Chr | Substr | Strupr | Strlwr | Vstr | Datetime)
}

impl Parser<'_> {
    /// Reads a string; `wanted` says what it is for.
    pub(crate) fn string(&mut self, wanted: &str) -> Result<String> {
        let lexeme = self.next()?;
        match &lexeme.item {
            Item::Text(source, index) => unescape(&source.strings[*index as usize], lexeme.place),
            Item::Value(Value::Text(text)) => Ok(text.text.clone()),
            Item::Word(keyword) if makes_string(*keyword) => {
                let (keyword, place) = (*keyword, lexeme.place);
                self.nested(|r| r.string_function(keyword, place))
            }
            _ => Err(self.unexpected(&lexeme, &format!("a string for {wanted}"))),
        }
    }

    /// Reads the name of a file. In a literal, a backslash is just a backslash.
    pub(crate) fn file_name(&mut self) -> Result<String> {
        let lexeme = self.next()?;
        if let Item::Text(source, index) = &lexeme.item {
            return Ok(source.strings[*index as usize].to_string());
        }
        self.put_back(lexeme);
        self.string("the file's name")
    }

    fn string_function(&mut self, keyword: Keyword, place: Place) -> Result<String> {
        self.expect(Mark::ParenOpen)?;
        let text = match keyword {
            Keyword::Str => {
                let value = self.float()?;
                let (width, digits) = self.width_and_digits()?;
                formatted(value, width, digits)
            }
            Keyword::Vstr => {
                let count = self.float()?;
                self.skip_comma()?;
                if !(2.0..=5.0).contains(&count) {
                    return Err(Error::invalid(place, "vstr shows 2 to 5 components"));
                }
                let count = count as usize;
                let values = self.expression()?.promoted(count);
                self.skip_comma()?;
                let between = self.string("what stands between the components")?;
                let (width, digits) = self.width_and_digits()?;
                let parts: Vec<_> =
                    values.as_slice()[..count].iter().map(|&v| formatted(v, width, digits)).collect();
                parts.join(&between)
            }
            Keyword::Concat => {
                let mut text = String::new();
                while !self.at_mark(Mark::ParenClose)? {
                    text += &self.string("a part of concat")?;
                    self.check_memory(2 * text.len(), place)?;
                    self.skip_comma()?;
                }
                text
            }
            Keyword::Chr => {
                let code = self.float()?;
                let found = char::from_u32(code as u32).filter(|_| (0.0..=65535.0).contains(&code));
                found
                    .ok_or_else(|| Error::invalid(place, format!("there is no character {code}")))?
                    .to_string()
            }
            Keyword::Substr => {
                let text = self.string("substr")?;
                self.skip_comma()?;
                let first = self.float()?;
                self.skip_comma()?;
                let count = self.float()?;
                let length = text.chars().count() as f64;
                if first < 1.0 || count < 0.0 || first - 1.0 + count > length {
                    let text =
                        format!("substr: {count} characters from {first} on are not in a string of {length}");
                    return Err(Error::invalid(place, text));
                }
                text.chars().skip(first as usize - 1).take(count as usize).collect()
            }
            Keyword::Strupr => self.string("strupr")?.to_ascii_uppercase(),
            Keyword::Strlwr => self.string("strlwr")?.to_ascii_lowercase(),
            _ => {
                let days = self.float()?;
                let format = if self.take_mark(Mark::Comma)? {
                    self.string("the form of the date")?
                } else {
                    "%Y-%m-%d %H:%M:%SZ".to_owned()
                };
                date(days, &format, place)?
            }
        };
        self.expect(Mark::ParenClose)?;
        // Long strings take time.
        self.count_steps(text.len() as u64 / 16, place)?;
        Ok(text)
    }

    fn width_and_digits(&mut self) -> Result<(f64, f64)> {
        self.skip_comma()?;
        let width = self.float()?;
        self.skip_comma()?;
        let digits = self.float()?;
        if width.abs() > WIDEST || digits > WIDEST {
            return Err(Error::invalid(
                self.here(),
                format!("the width of a number and its digits after the point may be at most {WIDEST}"),
            ));
        }
        Ok((width, digits))
    }
}

/// Formats like C's `%*.*f`: a negative width pads with zeros, negative digits mean six.
fn formatted(value: f64, width: f64, digits: f64) -> String {
    let digits = if digits < 0.0 { 6 } else { digits as usize };
    let size = width.abs() as usize;
    if width < 0.0 { format!("{value:0size$.digits$}") } else { format!("{value:size$.digits$}") }
}

/// The number at the start of `text`, or 0 if there is none.
pub(crate) fn number_in(text: &str) -> f64 {
    let text = text.trim_start();
    let numeric = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E');
    let end = text.find(|c| !numeric(c)).unwrap_or(text.len()).min(400);
    let longest = (1..=end).rev().find_map(|n| text[..n].parse::<f64>().ok());
    longest.filter(|v| v.is_finite()).unwrap_or(0.0)
}

/// Resolves the escapes of a literal.
pub(crate) fn unescape(raw: &str, place: Place) -> Result<String> {
    let mut text = String::with_capacity(raw.len());
    let mut chars = raw.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            text.push(c);
            continue;
        }
        text.push(match chars.next() {
            Some('n') => '\n',
            Some('t') => '\t',
            Some('r') => '\r',
            Some('a') => '\x07',
            Some('b') => '\x08',
            Some('f') => '\x0c',
            Some('v') => '\x0b',
            Some('0') => '\0',
            Some('u') => {
                let digits: String = chars.by_ref().take(4).collect();
                let code = u32::from_str_radix(&digits, 16).ok().filter(|_| digits.len() == 4);
                let wrong =
                    || Error::invalid(place, "\\u in a string takes four hexadecimal digits of a character");
                code.and_then(char::from_u32).ok_or_else(wrong)?
            }
            Some(same @ ('\\' | '"' | '\'')) => same,
            Some(other) => {
                return Err(Error::invalid(place, format!("a string knows no escape \\{other}")));
            }
            None => '\\',
        });
    }
    Ok(text)
}

/// The time `days` after the beginning of 2000, formatted like C's strftime (its plain numeric
/// fields).
fn date(days: f64, format: &str, place: Place) -> Result<String> {
    // A million days in either direction keep the calendar within four-digit years.
    if days.abs() > 1e6 {
        return Err(Error::invalid(place, "this date is too far away"));
    }
    let seconds = (days * 86_400.0).floor() as i64;
    let (day, second) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let (year, month, date) = civil(day);
    let mut text = String::new();
    let mut chars = format.chars();
    while let Some(c) = chars.next() {
        if c != '%' {
            text.push(c);
            continue;
        }
        text += &match chars.next() {
            Some('Y') => format!("{year:04}"),
            Some('y') => format!("{:02}", year.rem_euclid(100)),
            Some('m') => format!("{month:02}"),
            Some('d') => format!("{date:02}"),
            Some('H') => format!("{:02}", second / 3600),
            Some('M') => format!("{:02}", second / 60 % 60),
            Some('S') => format!("{:02}", second % 60),
            Some('F') => format!("{year:04}-{month:02}-{date:02}"),
            Some('%') => "%".to_owned(),
            other => {
                let letter = other.map_or_else(String::new, String::from);
                return Err(Error::unsupported(place, &format!("%{letter} in datetime")));
            }
        };
    }
    Ok(text)
}

/// The year, month and day of the Gregorian calendar, `day` days after 2000-01-01.
fn civil(day: i64) -> (i64, i64, i64) {
    // Years start in March, so that the leap day is the last; 2000-03-01 is day 60.
    let since = day - 60;
    let (era, in_era) = (since.div_euclid(146_097), since.rem_euclid(146_097));
    let year = (in_era - in_era / 1460 + in_era / 36_524 - in_era / 146_096) / 365;
    let in_year = in_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * in_year + 2) / 153;
    let date = in_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    (2000 + 400 * era + year + i64::from(month <= 2), month, date)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_formatted_as_c_does() {
        assert_eq!(formatted(1.5, 8.0, 3.0), "   1.500");
        assert_eq!(formatted(12.0, -5.0, 1.0), "012.0");
        assert_eq!(formatted(2.5, 0.0, -1.0), "2.500000");
        assert_eq!(formatted(-1.0, -6.0, 1.0), "-001.0");
    }

    #[test]
    fn escapes_are_resolved() {
        assert_eq!(unescape(r#"a\tb\\c\"d\u0041"#, Place::default()).unwrap(), "a\tb\\c\"dA");
        assert!(unescape(r"\q", Place::default()).is_err());
        assert!(unescape(r"\u00", Place::default()).is_err());
    }

    #[test]
    fn dates_follow_the_calendar() {
        assert_eq!(date(0.0, "%Y-%m-%d %H:%M:%SZ", Place::default()).unwrap(), "2000-01-01 00:00:00Z");
        assert_eq!(civil(59), (2000, 2, 29));
        assert_eq!(civil(366), (2001, 1, 1));
        assert_eq!(civil(-1), (1999, 12, 31));
    }

    #[test]
    fn val_takes_what_is_a_number() {
        assert_eq!(number_in("1.5e2"), 150.0);
        assert_eq!(number_in(" 12px"), 12.0);
        assert_eq!(number_in("px"), 0.0);
    }
}

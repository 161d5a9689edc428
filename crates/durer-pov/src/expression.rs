//! Expressions: lists of one to five floats, their operators, and their components.

use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::value::{Terms, Value};

/// The largest difference at which numbers are equal in the language (a fact of POV-Ray). `=`,
/// `!=`, `<=`, `>=` and conditions have this tolerance; `<` and `>` are exact. So `(1 < 1 + 1e-11)`
/// holds, and `(1 = 1 + 1e-11)` as well.
pub(crate) const TOLERANCE: f64 = 1e-10;

/// Whether `a = b` holds in the language.
pub(crate) fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE
}

/// Whether `#case` and the end of `#for` treat `a` as equal to `b`. Here the tolerance is exclusive
/// (a fact of POV-Ray).
pub(crate) fn nearly_same(a: f64, b: f64) -> bool {
    (a - b).abs() < TOLERANCE
}

fn flag(value: bool) -> Terms {
    Terms::from(f64::from(u8::from(value)))
}

impl Parser<'_> {
    /// Reads what may stand in parentheses: sums, comparisons, `&`, `|` and `?:`.
    pub(crate) fn relation(&mut self) -> Result<Terms> {
        self.nested(|r| {
            let condition = r.logical()?;
            if !r.take_mark(Mark::Question)? {
                return Ok(condition);
            }
            let place = r.here();
            let chosen =
                condition.float().ok_or_else(|| Error::invalid(place, "the condition of `?` is no float"))?;
            let yes = r.relation()?;
            r.expect(Mark::Colon)?;
            let no = r.relation()?;
            Ok(if crate::directives::truth(chosen) { yes } else { no })
        })
    }

    /// Reads `&` and `|`, which have the same precedence, from left to right.
    fn logical(&mut self) -> Result<Terms> {
        let mut left = self.comparison()?;
        loop {
            let and = match self.peek()? {
                Item::Mark(Mark::And) => true,
                Item::Mark(Mark::Or) => false,
                _ => return Ok(left),
            };
            self.next()?;
            let right = self.comparison()?;
            let truth = crate::directives::truth;
            left = left.zip(right, |a, b| {
                f64::from(u8::from(if and { truth(a) && truth(b) } else { truth(a) || truth(b) }))
            });
        }
    }

    /// Reads comparisons, which have the same precedence, from left to right.
    fn comparison(&mut self) -> Result<Terms> {
        let mut left = match self.compared_strings()? {
            Some(holds) => holds,
            None => self.expression()?,
        };
        loop {
            let mark = match self.peek()? {
                Item::Mark(
                    mark @ (Mark::Less
                    | Mark::Greater
                    | Mark::LessEqual
                    | Mark::GreaterEqual
                    | Mark::Equal
                    | Mark::NotEqual),
                ) => *mark,
                _ => return Ok(left),
            };
            self.next()?;
            let place = self.here();
            if self.at_mark(Mark::Equal)? {
                return Err(Error::invalid(
                    place,
                    match mark {
                        Mark::Equal => "`=` compares; there is no `==`",
                        _ => "a second `=` stands here",
                    },
                ));
            }
            let right = self.expression()?;
            let (Some(a), Some(b)) = (left.float(), right.float()) else {
                return Err(Error::invalid(place, "only floats can be compared"));
            };
            left = flag(match mark {
                Mark::Less => a < b,
                Mark::Greater => a > b,
                Mark::LessEqual => a <= b || same(a, b),
                Mark::GreaterEqual => a >= b || same(a, b),
                Mark::Equal => same(a, b),
                _ => !same(a, b),
            });
        }
    }

    /// Reads the comparison of two strings, if a string comes next.
    fn compared_strings(&mut self) -> Result<Option<Terms>> {
        let is_string = match self.peek()? {
            Item::Text(..) | Item::Value(Value::Text(_)) => true,
            Item::Word(keyword) => crate::strings::makes_string(*keyword),
            _ => false,
        };
        if !is_string {
            return Ok(None);
        }
        let left = self.string("a comparison")?;
        let lexeme = self.next()?;
        let holds: fn(&str, &str) -> bool = match &lexeme.item {
            Item::Mark(Mark::Less) => |a, b| a < b,
            Item::Mark(Mark::Greater) => |a, b| a > b,
            Item::Mark(Mark::LessEqual) => |a, b| a <= b,
            Item::Mark(Mark::GreaterEqual) => |a, b| a >= b,
            Item::Mark(Mark::Equal) => |a, b| a == b,
            Item::Mark(Mark::NotEqual) => |a, b| a != b,
            _ => return Err(self.unexpected(&lexeme, "a comparison of two strings, such as `=`")),
        };
        let right = self.string("a comparison")?;
        Ok(Some(flag(holds(&left, &right))))
    }

    /// Reads sums and differences.
    pub(crate) fn expression(&mut self) -> Result<Terms> {
        let mut left = self.product()?;
        loop {
            let plus = match self.peek()? {
                Item::Mark(Mark::Plus) => true,
                Item::Mark(Mark::Minus) => false,
                _ => return Ok(left),
            };
            self.next()?;
            let right = self.product()?;
            left = if plus { left.zip(right, |a, b| a + b) } else { left.zip(right, |a, b| a - b) };
        }
    }

    /// Reads products and quotients.
    fn product(&mut self) -> Result<Terms> {
        let mut left = self.operand()?;
        loop {
            match self.peek()? {
                Item::Mark(Mark::Star) => {
                    self.next()?;
                    let right = self.operand()?;
                    left = left.zip(right, |a, b| a * b);
                }
                Item::Mark(Mark::Slash) => {
                    self.next()?;
                    let place = self.here();
                    let right = self.operand()?;
                    // A fact of the language, and a short divisor is padded with zeros.
                    let divides = left.zip(right, |_, b| f64::from(u8::from(b != 0.0)));
                    left = left.zip(right, |a, b| if b == 0.0 { f64::INFINITY } else { a / b });
                    if divides.as_slice().contains(&0.0) {
                        self.notice(place, "division by zero gives an infinite number");
                    }
                }
                _ => return Ok(left),
            }
        }
    }

    /// Reads a number, vector, identifier, call or parenthesis, with signs before it and dots after
    /// it.
    pub(crate) fn operand(&mut self) -> Result<Terms> {
        let sign = match self.peek()? {
            Item::Mark(mark @ (Mark::Minus | Mark::Plus | Mark::Not)) => Some(*mark),
            _ => None,
        };
        if let Some(mark) = sign {
            self.next()?;
            let value = self.nested(Self::operand)?;
            self.end_value();
            return Ok(match mark {
                Mark::Minus => value.map(|v| -v),
                Mark::Not => value.map(|v| f64::from(u8::from(!crate::directives::truth(v)))),
                _ => value,
            });
        }
        let mut value = self.primary()?;
        self.end_value();
        // Looks for a dot without running what follows: `#version 3.7 #end` must not run its #end
        // here.
        while self.dot_follows()? {
            value = self.part_of(value)?;
            self.end_value();
        }
        Ok(value)
    }

    fn dot_follows(&mut self) -> Result<bool> {
        use crate::lexer::Kind;
        if !self.has_peeked() {
            match self.raw() {
                Some(Kind::Mark(Mark::Dot)) => {}
                // At the end of a macro's body the dot may stand after the call.
                None => return self.take_mark(Mark::Dot),
                Some(_) => return Ok(false),
            }
        }
        self.take_mark(Mark::Dot)
    }

    /// The component of `value` that is named after a dot.
    fn part_of(&mut self, value: Terms) -> Result<Terms> {
        let lexeme = self.next()?;
        let index = match &lexeme.item {
            Item::Word(Keyword::X | Keyword::U | Keyword::Red) => 0,
            Item::Word(Keyword::Y | Keyword::V | Keyword::Green) => 1,
            Item::Word(Keyword::Z | Keyword::Blue) => 2,
            Item::Word(Keyword::T | Keyword::Filter) => 3,
            Item::Word(Keyword::Transmit) => 4,
            Item::Word(Keyword::Gray) => {
                let [r, g, b] = value.xyz();
                return Ok(Terms::from(0.297 * r + 0.589 * g + 0.114 * b));
            }
            _ => return Err(self.unexpected(&lexeme, "a part such as x, y, z or red after the dot")),
        };
        match value.as_slice().get(index) {
            Some(&part) if value.len() > 1 => Ok(part.into()),
            _ => Err(Error::invalid(lexeme.place, "this value has no such part")),
        }
    }

    fn primary(&mut self) -> Result<Terms> {
        let lexeme = self.next()?;
        match &lexeme.item {
            Item::Number(value) => Ok((*value).into()),
            Item::Value(Value::Number(terms)) => Ok(*terms),
            Item::Mark(Mark::ParenOpen) => {
                let value = self.relation()?;
                self.expect_closing(Mark::ParenClose, lexeme.place)?;
                Ok(value)
            }
            Item::Mark(Mark::Less) => self.nested(Self::vector_literal),
            Item::Value(Value::Function(formula)) => self.nested(|r| r.called_formula(formula, lexeme.place)),
            Item::Value(Value::VectorFunction(function)) => {
                self.nested(|r| r.called_vector(function, lexeme.place))
            }
            Item::Value(Value::Spline(spline)) => self.nested(|r| r.called_spline(spline, lexeme.place)),
            Item::Word(keyword) => match self.nested(|r| r.function(*keyword, lexeme.place))? {
                Some(value) => Ok(value),
                None => Err(self.unexpected(&lexeme, "a number, vector or colour")),
            },
            _ => Err(self.unexpected(&lexeme, "a number, vector or colour")),
        }
    }

    /// Reads the rest of `<a, b, ...>`.
    fn vector_literal(&mut self) -> Result<Terms> {
        let place = self.here();
        let mut values = Vec::with_capacity(5);
        loop {
            if values.len() == 5 {
                return Err(Error::invalid(
                    self.here(),
                    "a vector has at most five components: `>` should stand here",
                ));
            }
            values.push(self.float()?);
            self.skip_comma()?;
            if self.take_mark(Mark::Greater)? {
                break;
            }
            if !self.starts_number()? {
                return self.expect_closing(Mark::Greater, place).map(|()| Terms::new(&values));
            }
        }
        if values.len() == 1 {
            return Err(Error::invalid(place, "a vector has at least two components"));
        }
        Ok(Terms::new(&values))
    }

    /// Reads an expression that is one float.
    pub(crate) fn float(&mut self) -> Result<f64> {
        self.peek()?;
        let place = self.here();
        let value = self.expression()?;
        let found = value.float().ok_or_else(|| {
            let text = format!("expected a float, found {}", Value::Number(value).kind());
            Error::invalid(place, text)
        })?;
        finite(found, place)
    }

    /// Reads an expression that is a vector of three. A float stands for three equal components; a
    /// vector of two is padded with zero.
    pub(crate) fn vector(&mut self) -> Result<[f64; 3]> {
        self.peek()?;
        let place = self.here();
        let value = self.expression()?;
        if value.len() > 3 {
            let text = format!("expected a vector of three, found {} components", value.len());
            return Err(Error::invalid(place, text));
        }
        let v = value.xyz();
        for part in v {
            finite(part, place)?;
        }
        Ok(v)
    }

    /// Reads an expression that is a vector of two.
    pub(crate) fn vector2(&mut self) -> Result<[f64; 2]> {
        self.peek()?;
        let place = self.here();
        let value = self.expression()?;
        if value.len() > 3 {
            return Err(Error::invalid(place, "expected a vector of two"));
        }
        let v = value.promoted(2);
        let (a, b) = (v.as_slice()[0], v.as_slice()[1]);
        Ok([finite(a, place)?, finite(b, place)?])
    }

    /// Reads a float, or returns `absent` if none follows: for words that may stand without a
    /// number.
    pub(crate) fn float_or(&mut self, absent: f64) -> Result<f64> {
        if self.starts_number()? { self.float() } else { Ok(absent) }
    }

    /// Whether the next token can begin an expression.
    pub(crate) fn starts_number(&mut self) -> Result<bool> {
        let keyword = match self.peek()? {
            Item::Number(_)
            | Item::Value(
                Value::Number(_) | Value::Function(_) | Value::VectorFunction(_) | Value::Spline(_),
            ) => return Ok(true),
            Item::Mark(Mark::ParenOpen | Mark::Less | Mark::Minus | Mark::Plus | Mark::Not) => {
                return Ok(true);
            }
            Item::Word(keyword) => *keyword,
            _ => return Ok(false),
        };
        Ok(crate::functions::begins_expression(keyword))
    }

    /// Reads a switch such as `no_shadow on`; the word alone means `on`. A colour after it, as in
    /// `pigment { uv_mapping Tint }`, does not belong to it.
    pub(crate) fn switch_value(&mut self) -> Result<bool> {
        if matches!(self.peek()?, Item::Value(Value::Number(_))) && self.starts_colour()? {
            return Ok(true);
        }
        Ok(crate::directives::truth(self.float_or(1.0)?))
    }
}

/// Returns `value`, unless it is infinite or not a number; then it is an error.
pub(crate) fn finite(value: f64, place: crate::diagnostics::Place) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Error::invalid(place, format!("this expression is not a finite number ({value})")))
}

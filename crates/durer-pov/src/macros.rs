//! Macros: ranges of tokens with parameters.

use std::rc::Rc;

use crate::diagnostics::{Error, Place, Result};
use crate::interner::Name;
use crate::lexer::{Kind, Mark};
use crate::parser::Parser;
use crate::scope::Reference;
use crate::value::Value;

/// A macro: the range of its body, and the names of its parameters.
#[derive(Debug)]
pub(crate) struct Macro {
    pub(crate) name: Name,
    pub(crate) file: u32,
    pub(crate) start: usize,
    pub(crate) end: usize,
    parameters: Vec<Name>,
}

/// An argument of a macro: a variable of the caller, or a value.
enum Argument {
    Variable(Reference),
    Value(Value),
}

impl Parser<'_> {
    /// Reads `#macro NAME(A, B)`: stores the body, which ends at token `end`, and continues after
    /// it.
    pub(crate) fn define_macro(&mut self, end: usize, place: Place) -> Result<()> {
        let Some((Kind::Name(name), _)) = self.take_raw() else {
            return Err(Error::invalid(self.here(), "a macro needs a name that is not a reserved word"));
        };
        let mut parameters = Vec::new();
        let wrong = |r: &Self| Error::invalid(r.here(), "a macro's parameters are names in parentheses");
        if !self.take_raw_mark(Mark::ParenOpen) {
            self.take_raw();
            return Err(wrong(self));
        }
        loop {
            match self.take_raw() {
                Some((Kind::Mark(Mark::ParenClose), _)) => break,
                Some((Kind::Mark(Mark::Comma), _)) => {}
                Some((Kind::Name(parameter), _)) => parameters.push(parameter),
                _ => return Err(wrong(self)),
            }
        }
        let Some(frame) = self.frames.last_mut() else { return Ok(()) };
        if frame.at > end {
            return Err(Error::invalid(place, "this macro's parameters are never closed"));
        }
        let body = Macro { name, file: frame.file, start: frame.at, end, parameters };
        frame.at = end + 1;
        self.scopes.declare(name, Value::Macro(Rc::new(body)));
        Ok(())
    }

    /// Reads the arguments of a call and starts reading the macro's body.
    pub(crate) fn call_macro(&mut self, body: &Macro, place: Place) -> Result<()> {
        let name = self.names.text(body.name).to_owned();
        if !self.at_mark(Mark::ParenOpen)? {
            return Err(Error::invalid(
                place,
                format!("{name} is a macro: its arguments in parentheses are missing"),
            ));
        }
        self.next()?;
        let mut arguments = Vec::with_capacity(body.parameters.len());
        for _ in &body.parameters {
            let closed = if self.has_peeked() {
                self.at_mark(Mark::ParenClose)?
            } else {
                self.raw() == Some(Kind::Mark(Mark::ParenClose))
            };
            if closed {
                break;
            }
            let argument = match self.variable_argument()? {
                Some(reference) => Argument::Variable(reference),
                None => Argument::Value(self.value("a value for the macro's parameter")?),
            };
            arguments.push(argument);
            self.skip_comma()?;
        }
        let wanted = body.parameters.len();
        let plural = if wanted == 1 { "" } else { "s" };
        if arguments.len() < wanted {
            let found = arguments.len();
            let given = match found {
                0 => "none is given".to_owned(),
                1 => "1 is given".to_owned(),
                _ => format!("{found} are given"),
            };
            let missing: Vec<&str> = body.parameters[found..].iter().map(|p| self.names.text(*p)).collect();
            let verb = if missing.len() == 1 { "is" } else { "are" };
            let missing = missing.join(", ");
            let text = format!("{given}, {name} needs {wanted} argument{plural}: {missing} {verb} missing");
            return Err(Error::invalid(place, text));
        }
        if !self.take_mark(Mark::ParenClose)? {
            let text = format!("{name} has {wanted} parameter{plural}: `)` should stand here");
            return Err(Error::invalid(self.here(), text));
        }
        self.scopes.enter();
        for (&parameter, argument) in body.parameters.iter().zip(arguments) {
            match argument {
                Argument::Variable(target) => self.scopes.alias(parameter, target),
                Argument::Value(value) => self.scopes.parameter(parameter, value),
            }
        }
        self.enter_macro(body, place)
    }
}

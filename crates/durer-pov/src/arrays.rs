//! Arrays: `array[2][3]`, their elements, and the functions that inspect arrays.

use std::rc::Rc;

use crate::diagnostics::{Error, Place, Result};
use crate::interner::Name;
use crate::lexer::{Kind, Mark};
use crate::parser::Parser;
use crate::scope::Reference;
use crate::value::{Array, Value};

/// POV-Ray's limit on the number of subscripts.
const MOST_DIMENSIONS: usize = 5;

impl Parser<'_> {
    /// The array called `name`, or its element if subscripts follow.
    pub(crate) fn array_or_element(&mut self, name: Name, place: Place) -> Result<Value> {
        let gone = |r: &Self| Error::invalid(place, format!("`{}` is not declared", r.names.text(name)));
        if self.raw() != Some(Kind::Mark(Mark::SquareOpen)) {
            return self.scopes.get(name).cloned().ok_or_else(|| gone(self));
        }
        let target = self.element_reference(name)?;
        match self.scopes.at(&target) {
            Some(Value::Empty) => {
                let text = format!("this element of `{}` has no value", self.names.text(name));
                Err(Error::invalid(place, text))
            }
            Some(value) => Ok(value.clone()),
            None => Err(gone(self)),
        }
    }

    /// The element that `name` and the subscripts after it refer to.
    pub(crate) fn element_reference(&mut self, name: Name) -> Result<Reference> {
        let place = self.here();
        let gone = |r: &Self| Error::invalid(place, format!("`{}` is not declared", r.names.text(name)));
        let mut target = self.scopes.reference(name).ok_or_else(|| gone(self))?;
        while self.raw() == Some(Kind::Mark(Mark::SquareOpen)) {
            let sizes = match self.scopes.at(&target) {
                Some(Value::Array(array)) => array.sizes.clone(),
                Some(other) => {
                    let text = format!("only an array has elements, this is {}", other.kind());
                    return Err(Error::invalid(place, text));
                }
                None => return Err(gone(self)),
            };
            let mut index = 0;
            for &size in &sizes {
                if !self.take_raw_mark(Mark::SquareOpen) {
                    let text = format!("this array takes {} subscripts", sizes.len());
                    return Err(Error::invalid(place, text));
                }
                let at = self.subscript(size)?;
                index = index * size + at;
            }
            target.path.push(index);
        }
        Ok(target)
    }

    /// Reads a subscript and its closing bracket.
    fn subscript(&mut self, size: usize) -> Result<usize> {
        let value = self.nested(Self::float)?;
        let place = self.here();
        self.expect(Mark::SquareClose)?;
        // Fractions are cut off. A value slightly below an integer counts as that integer, because
        // sums of 0.1 need it.
        let index = (value + crate::expression::TOLERANCE).floor();
        if index >= 0.0 && index < size as f64 {
            return Ok(index as usize);
        }
        let text = format!("subscript {value} is outside of the array's 0 to {}", size - 1);
        Err(Error::invalid(place, text))
    }

    /// Reads what follows the word `array`: the sizes, and values in braces if there are any.
    pub(crate) fn array(&mut self) -> Result<Value> {
        let place = self.here();
        let mut sizes = Vec::new();
        let mut count = 1_usize;
        while self.take_raw_mark(Mark::SquareOpen) {
            let size = self.nested(Self::float)?;
            let at = self.here();
            self.expect(Mark::SquareClose)?;
            let whole = (size + crate::expression::TOLERANCE).trunc();
            if !(whole >= 1.0 && whole < f64::from(u32::MAX)) {
                return Err(Error::invalid(at, format!("an array cannot have the size {size}")));
            }
            count = count.saturating_mul(whole as usize);
            self.check_memory(Array::bytes(count), at)?;
            sizes.push(whole as usize);
        }
        if sizes.is_empty() || sizes.len() > MOST_DIMENSIONS {
            return Err(Error::invalid(
                place,
                format!("an array has 1 to {MOST_DIMENSIONS} sizes in brackets"),
            ));
        }
        self.count_steps(count as u64, place)?;
        let mut array = Array::new(sizes);
        if self.raw() == Some(Kind::Mark(Mark::BraceOpen)) {
            let sizes = array.sizes.clone();
            let mut items = Vec::with_capacity(array.items.len());
            self.nested(|r| r.initial_values(&sizes, &mut items))?;
            array.depth = 1 + items.iter().map(Value::array_depth).max().unwrap_or(0);
            array.items = items;
            array.recount();
        }
        self.check_array_depth(array.depth, place)?;
        Ok(Value::Array(Rc::new(array)))
    }

    /// Reads values in braces, one level of braces for each dimension.
    fn initial_values(&mut self, sizes: &[usize], items: &mut Vec<Value>) -> Result<()> {
        let Some((&size, inner)) = sizes.split_first() else { return Ok(()) };
        self.expect(Mark::BraceOpen)?;
        let stride: usize = inner.iter().product();
        for i in 0..size {
            if self.at_mark(Mark::BraceClose)? {
                // If there are fewer values than elements, the rest stays without a value.
                items.resize(items.len() + (size - i) * stride, Value::Empty);
                break;
            }
            if inner.is_empty() {
                let value = self.value("a value for the array's element")?;
                items.push(value);
            } else {
                self.nested(|r| r.initial_values(inner, items))?;
            }
            self.skip_comma()?;
        }
        self.expect(Mark::BraceClose)
    }

    /// Limits the depth of arrays within arrays.
    pub(crate) fn check_array_depth(&self, depth: u32, place: Place) -> Result<()> {
        let limit = self.options.limits.nesting;
        if u64::from(depth) > limit {
            return Err(crate::limits::exceeded(
                place,
                "nesting",
                limit,
                "too many arrays inside each other",
            ));
        }
        Ok(())
    }

    /// The variable passed to a macro, if the argument is nothing but a variable.
    pub(crate) fn variable_argument(&mut self) -> Result<Option<Reference>> {
        if self.has_peeked() {
            return Ok(None);
        }
        let Some(Kind::Name(name)) = self.raw() else { return Ok(None) };
        match self.scopes.get(name) {
            None | Some(Value::Macro(_)) => return Ok(None),
            Some(_) => {}
        }
        let ends = |kind| matches!(kind, Some(Kind::Mark(Mark::Comma | Mark::ParenClose)));
        let mut ahead = 1;
        let mut depth = 0_usize;
        loop {
            match self.raw_ahead(ahead) {
                Some(Kind::Mark(Mark::SquareOpen)) => depth += 1,
                Some(Kind::Mark(Mark::SquareClose)) => depth = depth.saturating_sub(1),
                kind if depth == 0 => {
                    if !ends(kind) {
                        return Ok(None);
                    }
                    break;
                }
                None | Some(Kind::Directive(..)) => return Ok(None),
                _ => {}
            }
            ahead += 1;
        }
        self.take_raw();
        if ahead == 1 {
            return Ok(self.scopes.reference(name));
        }
        self.element_reference(name).map(Some)
    }

    /// Reads the array in parentheses after `dimensions` or `dimension_size`.
    pub(crate) fn array_argument(&mut self) -> Result<Rc<Array>> {
        let lexeme = self.next()?;
        match lexeme.item {
            crate::parser::Item::Value(Value::Array(array)) => Ok(array),
            _ => Err(self.unexpected(&lexeme, "an array")),
        }
    }
}

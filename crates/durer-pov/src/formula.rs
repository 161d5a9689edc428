//! `function { }`: formulas of parameters, read into the steps that surfaces evaluate, and the
//! isosurfaces made of them.
//!
//! The syntax inside a function is that of POV-Ray's manual, section "User-defined functions":
//! floats, parameters, the float functions, and calls of functions declared before. Calls are
//! expanded in place, so the result contains no calls.

use std::rc::Rc;
use std::sync::Arc;

use durer_formula::{Comparison, Function};
use durer_formula::{Formula, FormulaError, NodeId, Op};
use durer_math::{Interval, Point3};
use durer_scene::{Container, Isosurface};

use crate::diagnostics::{Error, ErrorKind, Place, Result};
use crate::formulas;
use crate::interner::Name;
use crate::keywords::Keyword;
use crate::lexer::{Kind, Mark};
use crate::object::Object;
use crate::parser::{Item, Lexeme, Parser};
use crate::pattern_function::lacking;
use crate::sampled::{self, Called};
use crate::value::{Terms, Value};
use crate::vector_function::{self, VectorFunction};

/// The greatest number of parameters of a function.
const MOST_PARAMETERS: usize = 56;
/// The greatest number of steps of `sum` or `prod`.
const MOST_ROUNDS: f64 = 10_000.0;

/// The name of a parameter: a word of the language such as `x`, or any other name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parameter {
    Word(Keyword),
    Name(Name),
}

impl Called {
    /// Checks whether it can be called with this number of arguments, and with their values as far
    /// as they are known.
    pub(crate) fn check(&self, arguments: &[Option<f64>], place: Place) -> Result<()> {
        check_count(arguments.len(), self.inputs() as usize, place)?;
        self.noisy.map_or(Ok(()), |function| {
            formulas::check(function, arguments)
                .map_err(|text| Error::at(place, ErrorKind::Unsupported, text))
        })
    }
}

/// A function while it is converted from text to steps.
struct Draft {
    function: sampled::Draft,
    /// The words that are parameters, and the indices of their inputs.
    words: Vec<(Keyword, u32)>,
    /// The number of inputs, including those of loops.
    inputs: u32,
}

fn too_long(place: Place) -> impl FnOnce(FormulaError) -> Box<Error> {
    move |error| Error::at(place, ErrorKind::Limit, error.to_string())
}

/// The functions of one number.
fn function_of_one(keyword: Keyword) -> Option<Function> {
    Some(match keyword {
        Keyword::Sin => Function::Sin,
        Keyword::Cos => Function::Cos,
        Keyword::Tan => Function::Tan,
        Keyword::Asin => Function::Asin,
        Keyword::Acos => Function::Acos,
        Keyword::Atan => Function::Atan,
        Keyword::Sinh => Function::Sinh,
        Keyword::Cosh => Function::Cosh,
        Keyword::Tanh => Function::Tanh,
        Keyword::Asinh => Function::Asinh,
        Keyword::Acosh => Function::Acosh,
        Keyword::Atanh => Function::Atanh,
        Keyword::Exp => Function::Exp,
        Keyword::Ln => Function::Ln,
        Keyword::Log => Function::Log10,
        Keyword::Floor => Function::Floor,
        Keyword::Ceil => Function::Ceil,
        Keyword::Int => Function::Trunc,
        _ => return None,
    })
}

impl Draft {
    fn push(&mut self, op: Op, place: Place) -> Result<NodeId> {
        self.function.builder.push(op).map_err(too_long(place))
    }

    fn constant(&mut self, value: f64, place: Place) -> Result<NodeId> {
        self.function.builder.constant(value).map_err(too_long(place))
    }
}

impl Parser<'_> {
    /// Reads `function (a, b) { ... }`, including the word, which must give a float.
    pub(crate) fn float_function_block(&mut self) -> Result<Called> {
        let place = self.here();
        match self.function_block()? {
            Value::Function(called) => Ok(Rc::unwrap_or_clone(called)),
            _ => Err(vector_function::wants_part(place)),
        }
    }

    /// Reads `function (a, b) { ... }`, including the word, as a formula with proven bounds.
    pub(crate) fn exact_function_block(&mut self) -> Result<Formula> {
        let place = self.here();
        let called = self.float_function_block()?;
        called.exact().map_err(too_long(place))?.ok_or_else(|| lacking(place))
    }

    /// Reads the body of a function of `x`, `y` and `z`, behind its opening brace: one number.
    pub(crate) fn function_behind_brace(&mut self) -> Result<Rc<Called>> {
        let place = self.here();
        match self.nested(|r| r.function_body(&None, place))? {
            Value::Function(called) => Ok(called),
            _ => Err(vector_function::wants_part(place)),
        }
    }

    /// Reads `function (a, b) { ... }`, including the word: a function with float or vector values.
    pub(crate) fn function_block(&mut self) -> Result<Value> {
        self.next()?;
        let place = self.here();
        let parameters = self.parameters()?;
        self.expect(Mark::BraceOpen)?;
        self.nested(|r| r.function_body(&parameters, place))
    }

    /// Reads the names in parentheses as they stand: a name that is declared elsewhere may be a
    /// parameter.
    fn parameters(&mut self) -> Result<Option<Vec<Parameter>>> {
        if self.has_peeked() || !self.take_raw_mark(Mark::ParenOpen) {
            return Ok(None);
        }
        let mut names = Vec::new();
        loop {
            match self.take_raw() {
                Some((Kind::Mark(Mark::ParenClose), _)) if !names.is_empty() => return Ok(Some(names)),
                Some((Kind::Mark(Mark::Comma), _)) => {}
                Some((kind @ (Kind::Name(_) | Kind::Word(_)), at)) => {
                    let parameter = match kind {
                        Kind::Name(name) => Parameter::Name(name),
                        Kind::Word(
                            word @ (Keyword::X
                            | Keyword::Y
                            | Keyword::Z
                            | Keyword::U
                            | Keyword::V
                            | Keyword::T),
                        ) => Parameter::Word(word),
                        Kind::Word(word) => {
                            let text = format!(
                                "`{}` is a word of the language and cannot be a parameter",
                                word.text()
                            );
                            return Err(Error::invalid(at, text));
                        }
                        _ => return Err(Error::invalid(at, "expected the name of a parameter")),
                    };
                    if names.contains(&parameter) {
                        return Err(Error::invalid(at, "this function has two parameters of the same name"));
                    }
                    if names.len() == MOST_PARAMETERS {
                        return Err(Error::invalid(
                            at,
                            format!("a function has at most {MOST_PARAMETERS} parameters"),
                        ));
                    }
                    names.push(parameter);
                }
                _ => return Err(Error::invalid(self.here(), "expected the name of a parameter, or `)`")),
            }
        }
    }

    /// Reads what stands between the braces, and the closing brace.
    fn function_body(&mut self, parameters: &Option<Vec<Parameter>>, place: Place) -> Result<Value> {
        let mut draft = Draft { function: sampled::Draft::default(), words: Vec::new(), inputs: 3 };
        self.scopes.enter();
        match parameters {
            None => {
                use Keyword::{U, V, X, Y, Z};
                draft.words = vec![(X, 0), (Y, 1), (Z, 2), (U, 0), (V, 1)];
            }
            Some(names) => {
                draft.inputs = names.len() as u32;
                for (number, parameter) in (0_u32..).zip(names) {
                    match *parameter {
                        Parameter::Word(word) => draft.words.push((word, number)),
                        Parameter::Name(name) => self.scopes.parameter(name, Value::Parameter(number)),
                    }
                }
            }
        }
        // The parameters' names are removed also if the body is wrong, because a declaration may be
        // skipped.
        let read = self.named_body(draft, parameters.is_some());
        self.scopes.leave();
        let function = read?;
        self.expect(Mark::BraceClose)?;
        self.check_memory(function.held(), place)?;
        Ok(function)
    }

    /// Reads the body while its parameters have their names.
    fn named_body(&mut self, mut draft: Draft, has_parameters: bool) -> Result<Value> {
        if let Some(function) = self.vector_function(has_parameters)? {
            return Ok(Value::VectorFunction(Rc::new(function)));
        }
        let function = |called: Called| Value::Function(Rc::new(called));
        let word = self.peek_word()?;
        match word {
            Some(Keyword::Internal) => return self.internal_function().map(function),
            Some(Keyword::Pattern) => return self.pattern_function().map(function),
            Some(Keyword::Texture) => {
                let text = "not supported yet: a texture as a function: durer cannot bound its values over a box, as exact intersections require";
                return Err(Error::at(self.here(), ErrorKind::Unsupported, text));
            }
            _ => {}
        }
        let place = self.here();
        let root = self.logical_formula(&mut draft)?;
        Ok(function(draft.function.finish(root, draft.inputs).map_err(too_long(place))?))
    }

    /// Reads `&` and `|`, from left to right.
    fn logical_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        let mut left = self.compared_formula(draft)?;
        loop {
            let comparison = match self.peek()? {
                Item::Mark(Mark::And) => Comparison::And,
                Item::Mark(Mark::Or) => Comparison::Or,
                _ => return Ok(left),
            };
            let place = self.next()?.place;
            let right = self.compared_formula(draft)?;
            left = draft.push(Op::Compare(comparison, left, right), place)?;
        }
    }

    fn compared_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        let mut left = self.sum_formula(draft)?;
        loop {
            let (comparison, swapped) = match self.peek()? {
                Item::Mark(Mark::Less) => (Comparison::Less, false),
                Item::Mark(Mark::LessEqual) => (Comparison::LessEqual, false),
                Item::Mark(Mark::Greater) => (Comparison::Less, true),
                Item::Mark(Mark::GreaterEqual) => (Comparison::LessEqual, true),
                Item::Mark(Mark::Equal) => (Comparison::Equal, false),
                Item::Mark(Mark::NotEqual) => (Comparison::NotEqual, false),
                _ => return Ok(left),
            };
            let place = self.next()?.place;
            let right = self.sum_formula(draft)?;
            let (a, b) = if swapped { (right, left) } else { (left, right) };
            left = draft.push(Op::Compare(comparison, a, b), place)?;
        }
    }

    fn sum_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        let mut left = self.product_formula(draft)?;
        loop {
            let plus = match self.peek()? {
                Item::Mark(Mark::Plus) => true,
                Item::Mark(Mark::Minus) => false,
                _ => return Ok(left),
            };
            let place = self.next()?.place;
            let right = self.product_formula(draft)?;
            left = draft.push(if plus { Op::Add(left, right) } else { Op::Sub(left, right) }, place)?;
        }
    }

    fn product_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        let mut left = self.signed_formula(draft)?;
        loop {
            let times = match self.peek()? {
                Item::Mark(Mark::Star) => true,
                Item::Mark(Mark::Slash) => false,
                _ => return Ok(left),
            };
            let place = self.next()?.place;
            let right = self.signed_formula(draft)?;
            left = draft.push(if times { Op::Mul(left, right) } else { Op::Div(left, right) }, place)?;
        }
    }

    fn signed_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        self.nested(|r| {
            if r.take_mark(Mark::Minus)? {
                let place = r.here();
                let value = r.signed_formula(draft)?;
                return draft.push(Op::Neg(value), place);
            }
            if r.take_mark(Mark::Plus)? {
                return r.signed_formula(draft);
            }
            r.operand_formula(draft)
        })
    }

    fn operand_formula(&mut self, draft: &mut Draft) -> Result<NodeId> {
        let lexeme = self.next()?;
        let place = lexeme.place;
        match &lexeme.item {
            Item::Number(value) => draft.constant(*value, place),
            Item::Value(Value::Number(terms)) => match terms.float() {
                Some(value) => draft.constant(value, place),
                None => Err(Error::invalid(
                    place,
                    "a function is made of floats: put the part of this vector that is meant into a float first",
                )),
            },
            Item::Value(Value::Parameter(number)) => {
                draft.function.builder.input(*number).map_err(too_long(place))
            }
            Item::Value(Value::Function(called)) => {
                let called = called.clone();
                self.call_formula(draft, &called, place)
            }
            Item::Value(Value::VectorFunction(function)) => {
                let function = function.clone();
                self.call_part(draft, &function, place)
            }
            Item::Value(Value::Spline(spline)) => {
                let function = VectorFunction::new(
                    spline.formulas().map_err(too_long(place))?.into_iter().map(Called::from).collect(),
                );
                self.call_part(draft, &function, place)
            }
            Item::Mark(Mark::ParenOpen) => {
                let value = self.logical_formula(draft)?;
                self.expect(Mark::ParenClose)?;
                Ok(value)
            }
            Item::Word(word) => {
                if let Some(&(_, number)) = draft.words.iter().find(|(known, _)| known == word) {
                    return draft.function.builder.input(number).map_err(too_long(place));
                }
                self.word_formula(draft, *word, &lexeme)
            }
            Item::Unknown(name) if self.declaring == Some(*name) => {
                let name = crate::diagnostics::shortened(self.names.text(*name));
                let text =
                    format!("`{name}` cannot call itself: a function is written out where it is called");
                Err(Error::invalid(place, text))
            }
            _ => Err(self.unexpected(&lexeme, "a number, a parameter or a function")),
        }
    }

    /// Reads the arguments in parentheses.
    fn formula_arguments(&mut self, draft: &mut Draft) -> Result<Vec<NodeId>> {
        self.expect(Mark::ParenOpen)?;
        let mut arguments = Vec::new();
        while !self.take_mark(Mark::ParenClose)? {
            arguments.push(self.logical_formula(draft)?);
            if !self.take_mark(Mark::Comma)? {
                self.expect(Mark::ParenClose)?;
                break;
            }
            if arguments.len() > 4 * MOST_PARAMETERS {
                return Err(Error::invalid(self.here(), "too many arguments"));
            }
        }
        Ok(arguments)
    }

    fn call_formula(&mut self, draft: &mut Draft, called: &Called, place: Place) -> Result<NodeId> {
        let arguments = self.formula_arguments(draft)?;
        self.language.noise_is_used |= called.scene_noise.is_some();
        let called = &*self.as_of_now(called, place)?;
        let number = |&id| draft.function.constant_value(id).map(Interval::mid);
        let numbers: Vec<Option<f64>> = arguments.iter().map(number).collect();
        called.check(&numbers, place)?;
        draft.function.call(called, &arguments).map_err(too_long(place))
    }

    /// Reads a component of the value of a vector function: `F(x, y, z).red`.
    fn call_part(&mut self, draft: &mut Draft, function: &VectorFunction, place: Place) -> Result<NodeId> {
        let arguments = self.formula_arguments(draft)?;
        check_count(arguments.len(), function.inputs(), place)?;
        if !self.take_mark(Mark::Dot)? {
            return Err(vector_function::wants_part(place));
        }
        let is_height = self.small_word("hf")?;
        let (found, place) = if is_height {
            (function.height(), self.here())
        } else {
            let lexeme = self.next()?;
            let Item::Word(word) = lexeme.item else {
                return Err(self.unexpected(&lexeme, "a part such as x, y, z or red after the dot"));
            };
            (function.part(word), lexeme.place)
        };
        let no_such_part = || Error::invalid(place, "this value has no such part");
        let weights = found.ok_or_else(no_such_part)?;
        let mut sum = None;
        for &(weight, part) in &weights {
            let mut value = draft.function.call(part, &arguments).map_err(too_long(place))?;
            if weight != 1.0 {
                let weight = draft.constant(weight, place)?;
                value = draft.push(Op::Mul(weight, value), place)?;
            }
            sum = Some(match sum {
                Some(sum) => draft.push(Op::Add(sum, value), place)?,
                None => value,
            });
        }
        sum.ok_or_else(no_such_part)
    }

    /// Reads a word of the language inside a function.
    fn word_formula(&mut self, draft: &mut Draft, word: Keyword, lexeme: &Lexeme) -> Result<NodeId> {
        let place = lexeme.place;
        let constant = match word {
            Keyword::Pi => Some(std::f64::consts::PI),
            Keyword::True | Keyword::On | Keyword::Yes => Some(1.0),
            Keyword::False | Keyword::Off | Keyword::No => Some(0.0),
            Keyword::Clock => Some(self.options.clock),
            Keyword::Version => Some(self.language.version),
            _ => None,
        };
        if let Some(value) = constant {
            return draft.constant(value, place);
        }
        if matches!(word, Keyword::Sum | Keyword::Prod) {
            return self.loop_formula(draft, word, place);
        }
        let count = match word {
            Keyword::Abs | Keyword::Sqrt | Keyword::Sqr | Keyword::Degrees | Keyword::Radians => Some(1),
            Keyword::Atan2 | Keyword::Pow | Keyword::Mod | Keyword::Div => Some(2),
            Keyword::Min | Keyword::Max | Keyword::Select => None,
            _ if function_of_one(word).is_some() => Some(1),
            _ => {
                if crate::functions::begins_expression(word) {
                    let text = format!("`{}` cannot be used in a function", word.text());
                    return Err(Error::invalid(place, text));
                }
                return Err(self.unexpected(lexeme, "a number, a parameter or a function"));
            }
        };
        let arguments = self.formula_arguments(draft)?;
        if let Some(count) = count {
            check_count(arguments.len(), count, place)?;
        }
        let step = match (word, arguments.as_slice()) {
            (Keyword::Abs, &[a]) => Op::Abs(a),
            (Keyword::Sqrt, &[a]) => Op::Sqrt(a),
            (Keyword::Sqr, &[a]) => Op::Sqr(a),
            (Keyword::Degrees, &[a]) => {
                let factor = draft.constant(180.0 / std::f64::consts::PI, place)?;
                Op::Mul(a, factor)
            }
            (Keyword::Radians, &[a]) => {
                let factor = draft.constant(std::f64::consts::PI / 180.0, place)?;
                Op::Mul(a, factor)
            }
            (Keyword::Atan2, &[a, b]) => Op::Atan2(a, b),
            (Keyword::Pow, &[a, b]) => Op::Pow(a, b),
            (Keyword::Mod, &[a, b]) => Op::Rem(a, b),
            (Keyword::Div, &[a, b]) => Op::Function(Function::Trunc, draft.push(Op::Div(a, b), place)?),
            (Keyword::Min | Keyword::Max, &[first, ref rest @ ..]) => {
                let mut value = first;
                for &next in rest {
                    let step = if word == Keyword::Min { Op::Min(value, next) } else { Op::Max(value, next) };
                    value = draft.push(step, place)?;
                }
                return Ok(value);
            }
            (Keyword::Select, &[c, below, other]) => Op::Select([c, below, other, other]),
            (Keyword::Select, &[c, below, at, above]) => Op::Select([c, below, at, above]),
            (Keyword::Select, _) => {
                return Err(Error::invalid(place, "select needs three or four arguments"));
            }
            (_, &[a]) if let Some(function) = function_of_one(word) => Op::Function(function, a),
            _ => return Err(Error::invalid(place, format!("{} needs an argument", word.text()))),
        };
        draft.push(step, place)
    }

    /// Expands `sum(i, first, last, expression)` and `prod`.
    fn loop_formula(&mut self, draft: &mut Draft, word: Keyword, place: Place) -> Result<NodeId> {
        self.expect(Mark::ParenOpen)?;
        let variable = match self.take_raw() {
            Some((Kind::Name(name), _)) => Parameter::Name(name),
            Some((
                Kind::Word(
                    word @ (Keyword::X | Keyword::Y | Keyword::Z | Keyword::U | Keyword::V | Keyword::T),
                ),
                _,
            )) => Parameter::Word(word),
            _ => {
                let text = format!(
                    "expected the name of the loop variable, as in `{}(i, 1, 9, i * x)`",
                    word.text()
                );
                return Err(Error::invalid(self.here(), text));
            }
        };
        self.expect(Mark::Comma)?;
        let first = self.whole_bound(draft)?;
        let last = self.whole_bound(draft)?;
        if last - first > MOST_ROUNDS {
            let text = format!("the bounds of `{}` may differ by at most {MOST_ROUNDS}", word.text());
            return Err(Error::at(place, ErrorKind::Limit, text));
        }
        // Reads the expression as a function of the outer inputs and of the loop's variable.
        let number = draft.inputs;
        let mut inner =
            Draft { function: sampled::Draft::default(), words: draft.words.clone(), inputs: number + 1 };
        self.scopes.enter();
        match variable {
            Parameter::Word(word) => inner.words.insert(0, (word, number)),
            Parameter::Name(name) => self.scopes.parameter(name, Value::Parameter(number)),
        }
        let root = self.logical_formula(&mut inner);
        self.scopes.leave();
        let root = root?;
        self.expect(Mark::ParenClose)?;
        let term = inner.function.finish(root, number + 1).map_err(too_long(place))?;
        let mut arguments = Vec::new();
        for i in 0..number {
            arguments.push(draft.function.builder.input(i).map_err(too_long(place))?);
        }
        let mut value = draft.constant(if word == Keyword::Sum { 0.0 } else { 1.0 }, place)?;
        let mut at = first;
        while at <= last {
            arguments.push(draft.constant(at, place)?);
            let next = draft.function.call(&term, &arguments).map_err(too_long(place))?;
            arguments.pop();
            let step = if word == Keyword::Sum { Op::Add(value, next) } else { Op::Mul(value, next) };
            value = draft.push(step, place)?;
            at += 1.0;
        }
        Ok(value)
    }

    /// Reads a bound of a loop and its comma. It must be known when the function is read.
    fn whole_bound(&mut self, draft: &mut Draft) -> Result<f64> {
        self.peek()?;
        let place = self.here();
        let bound = self.logical_formula(draft)?;
        self.expect(Mark::Comma)?;
        let constant = draft.function.constant_value(bound);
        match constant {
            Some(value) if value.lo == value.hi => Ok(value.lo),
            _ => Err(Error::at(
                place,
                ErrorKind::Unsupported,
                "not supported yet: a loop in a function whose bounds depend on its parameters",
            )),
        }
    }

    /// Evaluates a function that is called where a float is wanted, after its name.
    pub(crate) fn called_formula(&mut self, called: &Rc<Called>, place: Place) -> Result<Terms> {
        let arguments = self.float_arguments()?;
        let called = &*self.as_of_now(called, place)?;
        let numbers: Vec<Option<f64>> = arguments.iter().copied().map(Some).collect();
        called.check(&numbers, place)?;
        self.count_steps(called.steps() as u64, place)?;
        let value = called.value(&arguments, self.texture_context());
        if value.is_nan() {
            return Err(Error::invalid(place, "this function is undefined here"));
        }
        Ok(value.into())
    }

    /// Reads floats in parentheses.
    pub(crate) fn float_arguments(&mut self) -> Result<Vec<f64>> {
        self.expect(Mark::ParenOpen)?;
        let mut arguments = Vec::new();
        while !self.take_mark(Mark::ParenClose)? {
            arguments.push(self.float()?);
            self.skip_comma()?;
            if arguments.len() > MOST_PARAMETERS {
                break;
            }
        }
        Ok(arguments)
    }

    /// Reads the items of an isosurface, after its opening brace.
    pub(crate) fn isosurface(&mut self, place: Place) -> Result<Object> {
        let mut function = None;
        let (mut threshold, mut open) = (0.0, false);
        let mut container = Container::Box(Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
        loop {
            match self.peek_word()? {
                Some(Keyword::Function) => {
                    let at = self.here();
                    let formula = self.exact_function_block()?;
                    if formula.inputs() != 3 {
                        let text = format!(
                            "the function of an isosurface has three parameters, this one has {}",
                            formula.inputs()
                        );
                        return Err(Error::invalid(at, text));
                    }
                    function = Some(Arc::new(formula));
                }
                Some(Keyword::ContainedBy) => {
                    self.next()?;
                    container = self.container()?;
                }
                Some(Keyword::Threshold) => {
                    self.next()?;
                    threshold = self.float()?;
                }
                // Roots are certain without these settings.
                Some(Keyword::Accuracy | Keyword::MaxGradient | Keyword::MaxTrace) => {
                    self.next()?;
                    self.float()?;
                }
                Some(Keyword::AllIntersections) => {
                    self.next()?;
                }
                Some(Keyword::Evaluate) => {
                    self.next()?;
                    for _ in 0..3 {
                        self.float()?;
                        self.skip_comma()?;
                    }
                }
                Some(Keyword::Open) => {
                    self.next()?;
                    open = true;
                }
                _ => break,
            }
        }
        let Some(function) = function else {
            return Err(Error::invalid(place, "this isosurface has no function"));
        };
        let surface = Isosurface { function, threshold, container };
        let mut object = Object::new(durer_scene::Shape::Isosurface(Box::new(surface)).into(), place);
        object.habits.open = open;
        Ok(object)
    }

    /// Reads `{ box { } }` or `{ sphere { } }`.
    pub(crate) fn container(&mut self) -> Result<Container> {
        let point = |[x, y, z]: [f64; 3]| Point3::new(x, y, z);
        self.expect(Mark::BraceOpen)?;
        let lexeme = self.next()?;
        let container = match lexeme.item {
            Item::Word(Keyword::Box) => {
                self.expect(Mark::BraceOpen)?;
                let (a, b) = (self.corner()?, self.vector()?);
                if (0..3).any(|i| a[i] == b[i]) {
                    return Err(Error::invalid(
                        lexeme.place,
                        "this container has no thickness: nothing is in it",
                    ));
                }
                Container::Box(point(a), point(b))
            }
            Item::Word(Keyword::Sphere) => {
                self.expect(Mark::BraceOpen)?;
                let centre = self.corner()?;
                Container::Ball(point(centre), self.radius("the container's radius")?)
            }
            _ => return Err(self.unexpected(&lexeme, "`box` or `sphere`")),
        };
        self.expect(Mark::BraceClose)?;
        self.expect(Mark::BraceClose)?;
        Ok(container)
    }
}

pub(crate) fn check_count(found: usize, wanted: usize, place: Place) -> Result<()> {
    if found == wanted {
        return Ok(());
    }
    let s = |n: usize| if n == 1 { "" } else { "s" };
    Err(Error::invalid(place, format!("this function takes {wanted} argument{}, found {found}", s(wanted))))
}

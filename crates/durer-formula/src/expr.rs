//! Formulas written with operators.

use super::{Builder, Formula, FormulaError, NodeId, Op};
use crate::{Comparison, Function};
use core::cell::RefCell;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A subexpression of a formula that is being written: see [`Formula::of`].
#[derive(Clone, Copy)]
pub struct Expr<'b> {
    steps: &'b Steps,
    node: NodeId,
}

/// The steps so far, or the first error.
struct Steps {
    builder: RefCell<Builder>,
    error: RefCell<Option<FormulaError>>,
}

impl Steps {
    fn push(&self, op: Op) -> Result<NodeId, FormulaError> {
        self.builder.borrow_mut().push(op)
    }
}

impl Formula {
    /// The formula of x, y and z that a closure writes.
    ///
    /// ```
    /// use durer_formula::Formula;
    ///
    /// let wave = Formula::of(|x, y, z| z - (3.0 * x).cos() * (-y.square()).exp())?;
    /// assert_eq!(wave.value(&[0.0, 0.0, 1.5]), 0.5);
    /// # Ok::<(), durer_formula::FormulaError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If the formula is too long.
    pub fn of<F>(write: F) -> Result<Self, FormulaError>
    where
        F: for<'b> FnOnce(Expr<'b>, Expr<'b>, Expr<'b>) -> Expr<'b>,
    {
        let mut builder = Builder::new();
        let [x, y, z] = [builder.input(0)?, builder.input(1)?, builder.input(2)?];
        let steps = Steps { builder: RefCell::new(builder), error: RefCell::new(None) };
        let at = |node| Expr { steps: &steps, node };
        let root = write(at(x), at(y), at(z)).node;
        match steps.error.take() {
            Some(error) => Err(error),
            None => Ok(steps.builder.borrow().finish(root, 3)),
        }
    }
}

impl Expr<'_> {
    /// After an error the expression stays what it was; [`Formula::of`] returns the error.
    fn then(self, op: Op) -> Self {
        match self.steps.push(op) {
            Ok(node) => Self { node, ..self },
            Err(error) => {
                self.steps.error.borrow_mut().get_or_insert(error);
                self
            }
        }
    }

    /// A number, exactly; it must be finite.
    #[must_use]
    pub fn constant(self, x: f64) -> Self {
        let made = self.steps.builder.borrow_mut().constant(x);
        match made {
            Ok(node) => Self { node, ..self },
            Err(error) => {
                self.steps.error.borrow_mut().get_or_insert(error);
                self
            }
        }
    }

    /// A function of one argument.
    #[must_use]
    pub fn function(self, function: Function) -> Self {
        self.then(Op::Function(function, self.node))
    }

    /// The square.
    #[must_use]
    pub fn square(self) -> Self {
        self.then(Op::Sqr(self.node))
    }

    /// The square root.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.then(Op::Sqrt(self.node))
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(self) -> Self {
        self.then(Op::Abs(self.node))
    }

    /// `self` to an integer power.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        self.then(Op::Powi(self.node, n))
    }

    /// Any power of a positive number.
    #[must_use]
    pub fn pow(self, exponent: Self) -> Self {
        self.then(Op::Pow(self.node, exponent.node))
    }

    /// The lesser one.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        self.then(Op::Min(self.node, other.node))
    }

    /// The greater one.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.then(Op::Max(self.node, other.node))
    }

    /// The angle of the point `(x, self)` from the x axis, from -π to π.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        self.then(Op::Atan2(self.node, x.node))
    }

    /// 1 where the comparison holds, 0 elsewhere.
    #[must_use]
    pub fn compare(self, how: Comparison, other: Self) -> Self {
        self.then(Op::Compare(how, self.node, other.node))
    }

    /// The sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.function(Function::Sin)
    }

    /// The cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.function(Function::Cos)
    }

    /// The exponential.
    #[must_use]
    pub fn exp(self) -> Self {
        self.function(Function::Exp)
    }

    /// The natural logarithm.
    #[must_use]
    pub fn ln(self) -> Self {
        self.function(Function::Ln)
    }
}

impl Neg for Expr<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.then(Op::Neg(self.node))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Expr<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.then(Op::$trait(self.node, other.node))
            }
        }

        impl $trait<f64> for Expr<'_> {
            type Output = Self;

            fn $method(self, other: f64) -> Self {
                self.$method(self.constant(other))
            }
        }

        impl<'b> $trait<Expr<'b>> for f64 {
            type Output = Expr<'b>;

            fn $method(self, other: Expr<'b>) -> Expr<'b> {
                other.constant(self).$method(other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MOST_STEPS;

    #[test]
    fn operators_write_the_formula_that_they_say() {
        let f = Formula::of(|x, y, z| (2.0 - x / y) * (z + 1.0).powi(3) - y.max(x.abs()).sqrt()).unwrap();
        let cube = |x: f64| x * x * x;
        let value = |x: f64, y: f64, z: f64| (2.0 - x / y) * cube(z + 1.0) - y.max(x.abs()).sqrt();
        for p in [[1.0, 2.0, 3.0], [-4.0, 0.5, 1.0], [9.0, 4.0, -2.0]] {
            assert_eq!(f.value(&p), value(p[0], p[1], p[2]));
        }
        assert_eq!(f.inputs(), 3);
    }

    #[test]
    fn a_formula_that_is_too_long_is_refused() {
        let long = Formula::of(|x, _, _| (0..MOST_STEPS).fold(x, |sum, i| sum + f64::from(i as u32)));
        assert!(long.is_err());
    }
}

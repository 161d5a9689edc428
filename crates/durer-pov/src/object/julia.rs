//! `julia_fractal { <a, b, c, d> quaternion|hypercomplex sqr|cube max_iteration N precision P
//! slice <a, b, c, d>, D }`.

use durer_scene::{self as scene, Julia, JuliaAlgebra, JuliaPower, MOST_ITERATIONS};

use super::Shape;
use crate::diagnostics::{Error, Result};
use crate::keywords::Keyword;
use crate::parser::Parser;

impl Parser<'_> {
    /// The items of a Julia set, after its opening brace.
    pub(crate) fn julia_fractal(&mut self) -> Result<Shape> {
        let mut set = Julia {
            c: self.vector4()?,
            algebra: JuliaAlgebra::Quaternion,
            power: JuliaPower::Square,
            iterations: 20,
            radius: 0.0,
            normal: [0.0, 0.0, 0.0, 1.0],
            distance: 0.0,
        };
        while let Some(keyword) = self.peek_word()? {
            let at = self.here();
            match keyword {
                Keyword::Quaternion => set.algebra = JuliaAlgebra::Quaternion,
                Keyword::Hypercomplex => set.algebra = JuliaAlgebra::Hypercomplex,
                Keyword::Sqr => set.power = JuliaPower::Square,
                Keyword::Cube => set.power = JuliaPower::Cube,
                Keyword::MaxIteration => {
                    self.next()?;
                    let count = self.float()?;
                    if !(0.0..=f64::from(MOST_ITERATIONS)).contains(&count) {
                        let text =
                            format!("the iterations of a Julia set are 0 to {MOST_ITERATIONS}, not {count}");
                        return Err(Error::invalid(at, text));
                    }
                    set.iterations = count as u32;
                    continue;
                }
                // Roots are certain without it.
                Keyword::Precision => {
                    self.next()?;
                    self.float()?;
                    continue;
                }
                Keyword::Slice => {
                    self.next()?;
                    set.normal = self.vector4()?;
                    self.skip_comma()?;
                    set.distance = self.float()?;
                    if set.normal[3] == 0.0 {
                        return Err(Error::invalid(
                            at,
                            "the fourth component of the slice's normal is zero: the fourth coordinate does not follow from the others",
                        ));
                    }
                    continue;
                }
                Keyword::Exp
                | Keyword::Ln
                | Keyword::Log
                | Keyword::Sin
                | Keyword::Asin
                | Keyword::Sinh
                | Keyword::Asinh
                | Keyword::Cos
                | Keyword::Acos
                | Keyword::Cosh
                | Keyword::Acosh
                | Keyword::Tan
                | Keyword::Atan
                | Keyword::Tanh
                | Keyword::Atanh => {
                    return Err(Error::unsupported(at, &format!("{} in julia_fractal", keyword.text())));
                }
                _ => break,
            }
            self.next()?;
        }
        // POV-Ray's pictures show the points whose first N, their own included, are not further out
        // than this.
        let size = set.c.iter().fold(0.0, |sum, x| sum + x * x).sqrt();
        set.radius = match set.algebra {
            JuliaAlgebra::Quaternion => (1.0 + size).min(2.0),
            JuliaAlgebra::Hypercomplex => 4.0,
        };
        set.iterations = set.iterations.saturating_sub(1);
        Ok(scene::Shape::Julia(Box::new(set)).into())
    }

    /// A vector of four; a float stands for four equal ones, missing ones are zero.
    pub(super) fn vector4(&mut self) -> Result<[f64; 4]> {
        self.peek()?;
        let place = self.here();
        let value = self.expression()?;
        if value.len() > 4 {
            return Err(Error::invalid(place, "expected a vector of four"));
        }
        let v = value.promoted(4);
        let mut out = [0.0; 4];
        for (out, &x) in out.iter_mut().zip(v.as_slice()) {
            *out = crate::expression::finite(x, place)?;
        }
        Ok(out)
    }
}

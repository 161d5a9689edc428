//! Transformations of objects, textures, lights and cameras.

use std::rc::Rc;

use durer_math::elementary;

use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::{Item, Parser};
use crate::value::Value;

/// An affine map. Points are rows and stand to the left of the matrix: its rows are the images of
/// x, y and z, then the translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Matrix {
    pub(crate) rows: [[f64; 3]; 4],
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: [f64; 3]) -> f64 {
    elementary::hypot(elementary::hypot(a[0], a[1]), a[2])
}

/// The sine and cosine of an angle in degrees; exact for multiples of 90 degrees.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    match turned.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => elementary::sin_cos(degrees.to_radians()),
    }
}

impl Matrix {
    pub(crate) const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]] };

    pub(crate) fn translation(by: [f64; 3]) -> Self {
        let mut matrix = Self::IDENTITY;
        matrix.rows[3] = by;
        matrix
    }

    pub(crate) fn scaling(by: [f64; 3]) -> Self {
        let mut matrix = Self::IDENTITY;
        for (i, part) in by.into_iter().enumerate() {
            matrix.rows[i][i] = part;
        }
        matrix
    }

    /// The rotation about x, then y, then z, in degrees.
    pub(crate) fn rotation(degrees: [f64; 3]) -> Self {
        let mut matrix = Self::IDENTITY;
        for (axis, &angle) in degrees.iter().enumerate() {
            if angle == 0.0 {
                continue;
            }
            let (sin, cos) = sin_cos_degrees(angle);
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut turn = Self::IDENTITY;
            turn.rows[i][i] = cos;
            turn.rows[i][j] = sin;
            turn.rows[j][i] = -sin;
            turn.rows[j][j] = cos;
            matrix = matrix.then(&turn);
        }
        matrix
    }

    /// The rotation about `axis` through the origin, in degrees (Rodrigues' formula); the identity
    /// if the axis has no length.
    pub(crate) fn turn(axis: [f64; 3], degrees: f64) -> Self {
        let size = length(axis);
        if size == 0.0 {
            return Self::IDENTITY;
        }
        let a = axis.map(|v| v / size);
        let (sin, cos) = sin_cos_degrees(degrees);
        let mut matrix = Self::IDENTITY;
        for (i, row) in matrix.rows[..3].iter_mut().enumerate() {
            let mut unit = [0.0; 3];
            unit[i] = 1.0;
            let side = cross(a, unit);
            for j in 0..3 {
                row[j] = unit[j] * cos + side[j] * sin + a[j] * a[i] * (1.0 - cos);
            }
        }
        matrix
    }

    /// The map `self`, followed by `next`.
    pub(crate) fn then(&self, next: &Self) -> Self {
        let [x, y, z, t] = self.rows;
        Self { rows: [next.direction(x), next.direction(y), next.direction(z), next.point(t)] }
    }

    /// The image of a direction.
    pub(crate) fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|j| v[0] * self.rows[0][j] + v[1] * self.rows[1][j] + v[2] * self.rows[2][j])
    }

    /// The image of a point.
    pub(crate) fn point(&self, v: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(v);
        std::array::from_fn(|j| turned[j] + self.rows[3][j])
    }

    /// The signed volume of the unit cube's image.
    pub(crate) fn determinant(&self) -> f64 {
        dot(cross(self.rows[0], self.rows[1]), self.rows[2])
    }

    /// The inverse map, if there is one.
    pub(crate) fn inverse(&self) -> Option<Self> {
        let [a, b, c, t] = self.rows;
        let determinant = self.determinant();
        let columns = [cross(b, c), cross(c, a), cross(a, b)].map(|v| v.map(|part| part / determinant));
        let mut rows = [[0.0; 3]; 4];
        for i in 0..3 {
            for j in 0..3 {
                rows[i][j] = columns[j][i];
            }
        }
        let mut inverse = Self { rows };
        inverse.rows[3] = inverse.direction(t).map(|v| -v);
        inverse.rows.iter().flatten().all(|v| v.is_finite()).then_some(inverse)
    }

    pub(crate) fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    fn is_sound(&self) -> bool {
        self.rows.iter().flatten().all(|v| v.is_finite()) && self.inverse().is_some()
    }
}

impl Parser<'_> {
    /// Reads one transformation, if one comes next.
    pub(crate) fn transform_item(&mut self) -> Result<Option<Matrix>> {
        let Some(keyword) = self.peek_word()? else { return Ok(None) };
        let place = self.here();
        let matrix = match keyword {
            Keyword::Translate => {
                self.next()?;
                Matrix::translation(self.vector()?)
            }
            Keyword::Rotate => {
                self.next()?;
                Matrix::rotation(self.vector()?)
            }
            Keyword::Scale => {
                self.next()?;
                let mut by = self.vector()?;
                if by.contains(&0.0) {
                    self.notice(place, "a scale of 0 is taken as 1");
                    by = by.map(|v| if v == 0.0 { 1.0 } else { v });
                }
                Matrix::scaling(by)
            }
            Keyword::Matrix => {
                self.next()?;
                self.matrix_literal(place)?
            }
            Keyword::Transform => {
                self.next()?;
                self.nested(Self::transform_block)?
            }
            _ => return Ok(None),
        };
        if !matrix.is_sound() {
            return Err(Error::invalid(
                place,
                "this transform cannot be inverted: its matrix is singular or its numbers are out of range",
            ));
        }
        Ok(Some(matrix))
    }

    /// Reads `<12 numbers>`. A column of zeros would flatten space; as in POV-Ray it gets a 1.
    fn matrix_literal(&mut self, place: Place) -> Result<Matrix> {
        self.expect(Mark::Less)?;
        let mut matrix = Matrix::IDENTITY;
        for row in &mut matrix.rows {
            for value in row {
                *value = self.float()?;
                self.skip_comma()?;
            }
        }
        self.expect(Mark::Greater)?;
        for i in 0..3 {
            if matrix.rows[..3].iter().all(|row| row[i] == 0.0) {
                matrix.rows[i][i] = 1.0;
                self.notice(place, format!("column {} of this matrix is 0: its scale is taken as 1", i + 1));
            }
        }
        Ok(matrix)
    }

    /// Reads what follows the word `transform`: an identifier, or items in braces.
    pub(crate) fn transform_block(&mut self) -> Result<Matrix> {
        if let Item::Value(Value::Transform(known)) = self.peek()? {
            let known = **known;
            self.next()?;
            return Ok(known);
        }
        self.expect(Mark::BraceOpen)?;
        let mut matrix = Matrix::IDENTITY;
        let mut inverse = false;
        loop {
            if let Some(next) = self.transform_item()? {
                matrix = matrix.then(&next);
                continue;
            }
            let lexeme = self.next()?;
            match &lexeme.item {
                Item::Mark(Mark::BraceClose) => break,
                Item::Word(Keyword::Inverse) => inverse = true,
                Item::Value(Value::Transform(known)) => matrix = matrix.then(known),
                _ => return Err(self.unexpected(&lexeme, "a transform")),
            }
        }
        if inverse { self.inverted(&matrix) } else { Ok(matrix) }
    }

    fn inverted(&self, matrix: &Matrix) -> Result<Matrix> {
        matrix.inverse().ok_or_else(|| Error::invalid(self.here(), "this transform has no inverse"))
    }

    /// Reads `transform` as a value.
    pub(crate) fn transform_value(&mut self, place: Place) -> Result<Value> {
        let matrix = self.nested(Self::transform_block)?;
        if !matrix.is_sound() {
            return Err(Error::invalid(place, "this transform is singular"));
        }
        Ok(Value::Transform(Rc::new(matrix)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_is_left_handed_and_exact_at_quarter_turns() {
        assert_eq!(Matrix::rotation([0.0, 90.0, 0.0]).direction([1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]);
        assert_eq!(Matrix::rotation([90.0, 0.0, 90.0]).direction([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        let turned = Matrix::turn([0.0, 1.0, 0.0], 90.0).direction([1.0, 0.0, 0.0]);
        assert_eq!(turned, [0.0, 0.0, -1.0]);
    }

    #[test]
    fn the_inverse_leads_back() {
        let there = Matrix::scaling([2.0, 4.0, 0.5]).then(&Matrix::translation([1.0, 2.0, 3.0]));
        let back = there.inverse().unwrap();
        assert_eq!(there.then(&back), Matrix::IDENTITY);
        assert_eq!(Matrix::scaling([1.0, 0.0, 1.0]).inverse(), None);
    }
}

//! `deform { OBJECT  twist { ... }  taper { ... }  bend { ... }  lattice { ... }  formula { ... }
//! modifiers }`.
//!
//! The deformations of an object follow each other in the order of the text. The blocks follow
//! durer's own form: numbers first, then `word value`.

use std::rc::Rc;
use std::sync::Arc;

use durer_math::{Aabb, Point3, Vec3};
use durer_scene::{Container, DeformError, Lattice, Shape as Leaf, Warp};

use super::{Object, Shape};
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;

/// More than this no solid is deformed in one block.
const MOST_WARPS: usize = 64;
/// Counts in a lattice are far below this.
const MOST_COUNT: f64 = 65535.0;

impl Parser<'_> {
    /// The solid and its warps, from the opening brace on.
    pub(crate) fn deform(&mut self, place: Place) -> Result<Shape> {
        self.expect(Mark::BraceOpen)?;
        if !self.starts_object()? {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "the object that is deformed"));
        }
        let solid = self.object()?;
        check(&solid, true)?;
        let mut warps = Vec::new();
        loop {
            self.skip_comma()?;
            let warp = if self.small_word("twist")? {
                self.warp(|r| {
                    let axis = r.side("twist { y, 90, from 0 to 1 }")?;
                    let degrees = r.number("the angle of the twist, in degrees")?;
                    let [from, to] = r.stretch("twist")?;
                    Ok(Warp::Twist { axis, degrees, from, to })
                })?
            } else if self.small_word("taper")? {
                self.warp(|r| {
                    let axis = r.side("taper { y, 0.5, from 0 to 1 }")?;
                    r.peek()?;
                    let at = r.here();
                    let factor = r.number("the factor of the taper")?;
                    if factor <= 0.0 {
                        let text = format!(
                            "the factor of a taper is greater than 0, not {factor}: at 0 it would shrink to a line"
                        );
                        return Err(Error::invalid(at, text));
                    }
                    let [from, to] = r.stretch("taper")?;
                    Ok(Warp::Taper { axis, factor, from, to })
                })?
            } else if self.small_word("bend")? {
                self.warp(|r| {
                    let axis = r.side("bend { y, x, 90, from 0 to 1 }")?;
                    r.peek()?;
                    let at = r.here();
                    let toward = r.side("bend { y, x, 90, from 0 to 1 }")?;
                    let [a, b] = [axis, toward].map(Vec3::to_array);
                    if crate::transform::cross(a, b) == [0.0; 3] {
                        let text = "the direction of a bend must not be parallel to its axis";
                        return Err(Error::invalid(at, text));
                    }
                    let degrees = r.number("the angle of the bend, in degrees")?;
                    let [from, to] = r.stretch("bend")?;
                    Ok(Warp::Bend { axis, toward, degrees, from, to })
                })?
            } else if self.small_word("lattice")? {
                self.warp(Self::lattice)?
            } else if self.small_word("formula")? {
                self.warp(Self::inverse_map)?
            } else {
                break;
            };
            warps.push(warp);
            if warps.len() > MOST_WARPS {
                return Err(Error::invalid(
                    place,
                    format!("a solid is deformed at most {MOST_WARPS} times in one block"),
                ));
            }
        }
        if warps.is_empty() {
            let lexeme = self.next()?;
            return Err(self.unexpected(
                &lexeme,
                "how it is deformed: `twist`, `taper`, `bend`, `lattice` or `formula`",
            ));
        }
        for warp in &warps {
            fits(&solid, warp)?;
        }
        Ok(Shape::Deform(solid, warps.into()))
    }

    /// The box of a lattice, how many points it has along each axis, and which of them move.
    fn lattice(&mut self) -> Result<Warp> {
        self.peek()?;
        let at = self.here();
        let corners = [self.corner()?, self.corner()?].map(Point3::from);
        let mut size = [0; 3];
        for (size, axis) in size.iter_mut().zip(["x", "y", "z"]) {
            let what = format!("how many points the lattice has along {axis}, 2 to 8");
            *size = self.count(&what)?;
        }
        let wrong = |at: Place| move |e: DeformError| Error::invalid(at, e.to_string());
        let mut lattice = Lattice::new(Aabb::from_points(corners), size).map_err(wrong(at))?;
        while self.small_word("move")? {
            self.peek()?;
            let at = self.here();
            let numbers = self.vector()?;
            self.skip_comma()?;
            let by = Vec3::from(self.vector()?);
            self.skip_comma()?;
            if numbers.iter().any(|x| x.fract() != 0.0 || !(0.0..=MOST_COUNT).contains(x)) {
                let [i, j, k] = numbers;
                let text = format!("a point of a lattice has whole numbers from 0 on, not <{i}, {j}, {k}>");
                return Err(Error::invalid(at, text));
            }
            lattice.shift(numbers.map(|x| x as usize), by).map_err(wrong(at))?;
        }
        Ok(Warp::Lattice(Arc::new(lattice)))
    }

    /// An integer and its comma.
    fn count(&mut self, what: &str) -> Result<usize> {
        self.peek()?;
        let at = self.here();
        let number = self.number(what)?;
        if number.fract() != 0.0 || !(0.0..=MOST_COUNT).contains(&number) {
            return Err(Error::invalid(at, format!("expected {what}, not {number}")));
        }
        Ok(number as usize)
    }

    /// The text in the braces of one of the words.
    fn warp(&mut self, inner: impl FnOnce(&mut Self) -> Result<Warp>) -> Result<Warp> {
        self.expect(Mark::BraceOpen)?;
        let warp = inner(self)?;
        self.skip_comma()?;
        self.expect(Mark::BraceClose)?;
        Ok(warp)
    }

    /// A direction and its comma. A float, which would be a vector elsewhere, is a forgotten axis.
    fn side(&mut self, example: &str) -> Result<Vec3> {
        self.peek()?;
        let at = self.here();
        let missing = || Error::invalid(at, format!("expected a direction, as in `{example}`"));
        if !self.starts_number()? {
            return Err(missing());
        }
        let terms = self.expression()?;
        let v = match *terms.as_slice() {
            [x, y] => [x, y, 0.0],
            [x, y, z] => [x, y, z],
            _ => return Err(missing()),
        };
        if v == [0.0; 3] {
            return Err(Error::invalid(
                at,
                format!("this direction has no length: expected one, as in `{example}`"),
            ));
        }
        self.skip_comma()?;
        Ok(Vec3::from(v))
    }

    /// A float and its comma.
    fn number(&mut self, what: &str) -> Result<f64> {
        if !self.starts_number()? {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, what));
        }
        let value = self.float()?;
        self.skip_comma()?;
        Ok(value)
    }

    /// `from a to b`.
    fn stretch(&mut self, warp: &str) -> Result<[f64; 2]> {
        if !self.small_word("from")? {
            let lexeme = self.next()?;
            return Err(self.unexpected(
                &lexeme,
                &format!("`from A to B`, the piece of the axis along which the {warp} goes"),
            ));
        }
        self.extent()
    }

    /// Three functions and their box.
    fn inverse_map(&mut self) -> Result<Warp> {
        let mut functions = Vec::with_capacity(3);
        while functions.len() < 3 {
            if self.peek_word()? != Some(Keyword::Function) {
                let lexeme = self.next()?;
                let which = ["x", "y", "z"][functions.len()];
                let text =
                    format!("the function that says which {which} a point of the deformed solid came from");
                return Err(self.unexpected(&lexeme, &text));
            }
            let at = self.here();
            let formula = self.exact_function_block()?;
            if formula.inputs() != 3 {
                let text =
                    format!("a function of a point has three parameters, this one has {}", formula.inputs());
                return Err(Error::invalid(at, text));
            }
            functions.push(formula);
            self.skip_comma()?;
        }
        let at = self.here();
        if !self.take_word(Keyword::ContainedBy)? {
            let lexeme = self.next()?;
            return Err(
                self.unexpected(&lexeme, "`contained_by { box { ... } }`, which holds the deformed solid")
            );
        }
        let Container::Box(a, b) = self.container()? else {
            return Err(Error::invalid(at, "a deformed solid is contained by a box"));
        };
        let functions: Box<[_; 3]> = functions
            .into_boxed_slice()
            .try_into()
            .map_err(|_| Error::invalid(at, "expected three functions"))?;
        Ok(Warp::Inverse { functions: Arc::from(functions), within: Aabb::from_points([a, b]) })
    }
}

/// Refuses a warp that goes the other way than an object needs: solids need to know where points
/// came from, surfaces of parameters where they go to.
fn fits(object: &Rc<Object>, warp: &Warp) -> Result<()> {
    match &object.shape {
        Shape::Union(parts) | Shape::Csg(_, parts) => parts.iter().try_for_each(|part| fits(part, warp)),
        Shape::Deform(solid, _) => fits(solid, warp),
        shape => match (warp, of_parameters(shape)) {
            (Warp::Lattice(_), None) => {
                let text = "a lattice has no inverse formula, so it deforms patches, nurbs, sewn and parametric surfaces, not this solid";
                Err(Error::invalid(object.at, text))
            }
            (Warp::Inverse { .. }, Some(name)) => {
                let text = format!(
                    "a `formula` is an inverse map, which deforms only solids: deform {name} by twist, taper, bend or lattice"
                );
                Err(Error::invalid(object.at, text))
            }
            _ => Ok(()),
        },
    }
}

/// The name of a surface that is given by parameters.
fn of_parameters(shape: &Shape) -> Option<&'static str> {
    match shape.leaf()? {
        leaf @ (Leaf::Patch(_)
        | Leaf::TriangularPatch(_)
        | Leaf::Nurbs(_)
        | Leaf::Parametric(_)
        | Leaf::Sewn(_)) => Some(leaf.name()),
        _ => None,
    }
}

/// Refuses solids without a formula. A surface given by parameters is deformed by itself, not as a
/// part of an intersection, say.
fn check(object: &Rc<Object>, alone: bool) -> Result<()> {
    let refuse = |why: &str| Err(Error::invalid(object.at, why));
    if !object.clips.is_empty() {
        return refuse("what is clipped cannot be deformed: an intersection can");
    }
    if object.habits.open {
        return refuse("what is open is no solid, so it cannot be deformed");
    }
    if let Some(name) = of_parameters(&object.shape) {
        if alone {
            return Ok(());
        }
        return refuse(&format!(
            "{name} cannot be deformed as a part of a merge, intersection or difference: deform it by itself"
        ));
    }
    let without_formula = match &object.shape {
        Shape::Union(parts) => return parts.iter().try_for_each(|part| check(part, alone)),
        Shape::Csg(_, parts) => return parts.iter().try_for_each(|part| check(part, false)),
        Shape::Deform(solid, _) => return check(solid, alone),
        Shape::Leaf(
            Leaf::Sphere { .. }
            | Leaf::Box { .. }
            | Leaf::Cylinder { .. }
            | Leaf::Cone { .. }
            | Leaf::Plane { .. }
            | Leaf::Quadric(_)
            | Leaf::Polynomial { .. }
            | Leaf::Torus { .. }
            | Leaf::Cyclide { .. }
            | Leaf::Named(_)
            | Leaf::SphericalSector { .. }
            | Leaf::Isosurface(_)
            | Leaf::Superellipsoid { .. }
            | Leaf::Blob(_),
        ) => return Ok(()),
        Shape::Textured(Leaf::Blob(_), _) => {
            return refuse("a blob whose components have textures cannot be deformed");
        }
        Shape::FlatBox { .. } => "a box without thickness",
        Shape::Nothing => "an object without a surface",
        Shape::Leaf(Leaf::SmoothTriangle(_)) => "a triangle",
        Shape::Leaf(leaf) | Shape::Textured(leaf, _) => leaf.name(),
        Shape::Light(_) => "a light",
    };
    refuse(&format!("{without_formula} has no formula here, so it cannot be deformed"))
}

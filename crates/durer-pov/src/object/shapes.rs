//! The numbers of POV-Ray's shapes.

use std::rc::Rc;

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::transform::{cross, dot, length};
use durer_scene::{MAX_ORDER, coefficient_count, place_of};

impl Parser<'_> {
    /// The numbers of the shape `keyword`, after its opening brace.
    pub(crate) fn shape(&mut self, keyword: Keyword, place: Place) -> Result<Shape> {
        Ok(match keyword {
            Keyword::Sphere => {
                let center = self.corner()?;
                Shape::Sphere { center, radius: self.radius("the sphere's radius")? }
            }
            Keyword::Box => {
                let (a, b) = (self.corner()?, self.vector()?);
                if (0..3).any(|i| a[i] == b[i]) {
                    return Err(Error::invalid(place, "this box has no thickness"));
                }
                Shape::Box { a, b }
            }
            Keyword::Cylinder => {
                let (base, cap) = (self.corner()?, self.corner()?);
                if base == cap {
                    return Err(Error::invalid(place, "this cylinder's ends are the same point"));
                }
                Shape::Cylinder { base, cap, radius: self.radius("the cylinder's radius")? }
            }
            Keyword::Cone => {
                let base = self.corner()?;
                let base_radius = self.float()?;
                self.skip_comma()?;
                let cap = self.corner()?;
                let cap_radius = self.float()?;
                if base == cap {
                    return Err(Error::invalid(place, "this cone's ends are the same point"));
                }
                let (base_radius, cap_radius) = match (base_radius, cap_radius) {
                    (a, b) if a == 0.0 && b == 0.0 => {
                        return Err(Error::invalid(place, "both of this cone's radii are zero"));
                    }
                    (a, b) if a >= 0.0 && b >= 0.0 => (a, b),
                    (a, b) if a <= 0.0 && b <= 0.0 => (-a, -b),
                    _ => return Err(Error::invalid(place, "this cone's radii have different signs")),
                };
                Shape::Cone { base, base_radius, cap, cap_radius }
            }
            Keyword::Plane => {
                let normal = self.normal("the plane's normal")?;
                Shape::Plane { normal, distance: self.float()? }
            }
            Keyword::Disc => {
                let center = self.corner()?;
                let normal = self.normal("the disc's normal")?;
                let radius = self.radius("the disc's radius")?;
                let hole = if self.take_mark(Mark::Comma)? { self.float()?.abs() } else { 0.0 };
                if hole >= radius {
                    return Err(Error::invalid(place, "the disc's hole is as large as the disc"));
                }
                Shape::Disc { center, normal, radius, hole }
            }
            Keyword::Triangle => Shape::Triangle([self.corner()?, self.corner()?, self.vector()?]),
            Keyword::SmoothTriangle => {
                let mut corners = [[0.0; 3]; 3];
                let mut normals = [[0.0; 3]; 3];
                for i in 0..3 {
                    corners[i] = self.corner()?;
                    normals[i] = self.normal("a normal of the triangle")?;
                }
                Shape::SmoothTriangle(Box::new((corners, normals)))
            }
            Keyword::Polygon => {
                let loops = self.polygon(place)?;
                let rule = self.fill_rule()?;
                Shape::Polygon(Rc::new(loops), rule)
            }
            Keyword::Mesh => self.mesh()?,
            Keyword::Mesh2 => self.mesh2()?,
            Keyword::Quadric => {
                let (squares, mixed, linear) = (self.corner()?, self.corner()?, self.corner()?);
                let constant = self.float()?;
                let [a, b, c] = squares;
                let [d, e, f] = mixed;
                let [g, h, i] = linear;
                if [squares, mixed, linear].iter().flatten().all(|v| *v == 0.0) {
                    return Err(Error::invalid(place, "this quadric's equation has no variable in it"));
                }
                Shape::Quadric(Box::new([a, b, c, d, e, f, g, h, i, constant]))
            }
            Keyword::Isosurface => self.isosurface(place)?,
            Keyword::Superellipsoid => self.superellipsoid()?,
            Keyword::Blob => self.blob(place)?,
            Keyword::JuliaFractal => self.julia_fractal()?,
            Keyword::Torus => {
                let major = self.radius("the torus's major radius")?;
                self.skip_comma()?;
                Shape::Torus { major, minor: self.radius("the torus's minor radius")? }
            }
            Keyword::Prism => self.prism(place)?,
            Keyword::Sor => self.sor()?,
            Keyword::Ovus => self.ovus()?,
            Keyword::Cubic => Shape::Polynomial(3, self.coefficients(3, place)?),
            Keyword::Quartic => Shape::Polynomial(4, self.coefficients(4, place)?),
            Keyword::Poly => {
                let order = self.order()?;
                Shape::Polynomial(order, self.coefficients(order, place)?)
            }
            Keyword::Polynomial => {
                let order = self.order()?;
                Shape::Polynomial(order, self.terms(order, place)?)
            }
            // `begins_object` lists no other shape.
            _ => return Err(Error::unsupported(place, keyword.text())),
        })
    }

    /// `<e, n>`.
    fn superellipsoid(&mut self) -> Result<Shape> {
        self.peek()?;
        let at = self.here();
        let terms = self.vector2()?;
        for exponent in terms {
            if !(1e-9..=1e9).contains(&exponent) {
                return Err(Error::invalid(
                    at,
                    format!("the exponents of a superellipsoid are between 1e-9 and 1e9, not {exponent}"),
                ));
            }
        }
        Ok(Shape::Superellipsoid { e: terms[0], n: terms[1] })
    }

    /// A point and the comma behind it.
    pub(crate) fn corner(&mut self) -> Result<[f64; 3]> {
        let v = self.vector()?;
        self.skip_comma()?;
        Ok(v)
    }

    /// The order of a polynomial and the comma behind it.
    fn order(&mut self) -> Result<u32> {
        self.peek()?;
        let at = self.here();
        let order = self.float()?;
        self.skip_comma()?;
        if order.fract() != 0.0 || !(2.0..=f64::from(MAX_ORDER)).contains(&order) {
            return Err(Error::invalid(
                at,
                format!("the order of a polynomial is a whole number from 2 to {MAX_ORDER}, not {order}"),
            ));
        }
        Ok(order as u32)
    }

    /// `<A1, A2, ...>`: all coefficients of a polynomial, by falling powers of x, then of y, then of z.
    fn coefficients(&mut self, order: u32, place: Place) -> Result<Rc<[f64]>> {
        let wanted = coefficient_count(order);
        let mut list = Vec::with_capacity(wanted);
        self.expect(Mark::Less)?;
        while !self.take_mark(Mark::Greater)? {
            self.peek()?;
            let at = self.here();
            if list.len() == wanted {
                return Err(Error::invalid(
                    at,
                    format!("a polynomial of order {order} has {wanted} coefficients, and this is one more"),
                ));
            }
            list.push(self.float()?);
            self.skip_comma()?;
        }
        if list.len() < wanted {
            let found = list.len();
            return Err(Error::invalid(
                place,
                format!("a polynomial of order {order} has {wanted} coefficients, and here are {found}"),
            ));
        }
        self.varies(&list, place)?;
        Ok(list.into())
    }

    /// `xyz(i, j, k): value, ...`: the coefficients that are not zero.
    fn terms(&mut self, order: u32, place: Place) -> Result<Rc<[f64]>> {
        let mut list = vec![0.0; coefficient_count(order)];
        while self.take_word(Keyword::Xyz)? {
            self.expect(Mark::ParenOpen)?;
            let at = self.here();
            let mut powers = [0.0; 3];
            for (n, power) in powers.iter_mut().enumerate() {
                if n > 0 {
                    self.expect(Mark::Comma)?;
                }
                *power = self.float()?;
            }
            self.expect(Mark::ParenClose)?;
            let whole = powers.iter().all(|p| p.fract() == 0.0 && *p >= 0.0);
            if !whole || powers.iter().sum::<f64>() > f64::from(order) {
                return Err(Error::invalid(
                    at,
                    format!("the powers of a term are whole numbers that add up to {order} at most"),
                ));
            }
            self.expect(Mark::Colon)?;
            list[place_of(order, powers.map(|p| p as u32))] = self.float()?;
            self.skip_comma()?;
        }
        self.varies(&list, place)?;
        Ok(list.into())
    }

    /// Refuses what has no variable in it.
    fn varies(&self, list: &[f64], place: Place) -> Result<()> {
        if list.iter().rev().skip(1).all(|c| *c == 0.0) {
            return Err(Error::invalid(place, "this polynomial has no variable in it"));
        }
        Ok(())
    }

    /// A direction and the comma behind it.
    pub(crate) fn normal(&mut self, what: &str) -> Result<[f64; 3]> {
        self.peek()?;
        let place = self.here();
        let v = self.corner()?;
        if length(v) == 0.0 {
            return Err(Error::invalid(place, format!("{what} has no length")));
        }
        Ok(v)
    }

    /// `n, points`: a loop ends where its first point comes again.
    fn polygon(&mut self, place: Place) -> Result<Vec<Vec<[f64; 3]>>> {
        let count = self.float()?;
        self.skip_comma()?;
        if !(3.0..1e9).contains(&count) {
            return Err(Error::invalid(place, "a polygon has at least three points"));
        }
        let (mut loops, mut current) = (Vec::new(), Vec::<[f64; 3]>::new());
        for n in 0..count as usize {
            let point = self.corner()?;
            self.check_memory(n * 48, place)?;
            if current.first() == Some(&point) {
                loops.push(std::mem::take(&mut current));
            } else {
                current.push(point);
            }
        }
        if !current.is_empty() {
            self.notice(place, "this polygon does not end at its first point: it is closed");
            loops.push(current);
        }
        if loops.iter().any(|points| points.len() < 3) {
            return Err(Error::invalid(place, "a loop of this polygon has fewer than three corners"));
        }
        if loops.first().is_some_and(|outline| starts_inward(outline)) {
            // The first corners stay the first.
            loops.iter_mut().for_each(|points| points[1..].reverse());
        }
        Ok(loops)
    }
}

/// Whether the first three corners of an outline that are not on one line go round the other way than all of it does. They tell which side is the front.
fn starts_inward(points: &[[f64; 3]]) -> bool {
    let from_first = |p: [f64; 3]| std::array::from_fn(|axis| p[axis] - points[0][axis]);
    let turns = |a: [f64; 3], b: [f64; 3]| cross(from_first(a), from_first(b));
    let all = points.windows(2).fold([0.0; 3], |sum, two| {
        let turn = turns(two[0], two[1]);
        std::array::from_fn(|axis| sum[axis] + turn[axis])
    });
    let first = points[2..].iter().map(|&p| turns(points[1], p)).find(|turn| turn.iter().any(|&x| x != 0.0));
    first.is_some_and(|first| dot(first, all) < 0.0)
}

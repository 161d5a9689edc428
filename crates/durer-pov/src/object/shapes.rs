//! The numbers of POV-Ray's shapes.

use super::Shape;
use crate::diagnostics::{Error, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::parser::Parser;
use crate::scene_builder::{point, unit, vector};
use crate::transform::{cross, dot, length};
use durer_math::Point3;
use durer_scene::{self as scene, MAX_ORDER, coefficient_count, place_of};

impl Parser<'_> {
    /// The numbers of the shape `keyword`, after its opening brace.
    pub(crate) fn shape(&mut self, keyword: Keyword, place: Place) -> Result<Shape> {
        Ok(match keyword {
            Keyword::Sphere => {
                self.need("a sphere needs its centre after `{`")?;
                let centre = point(self.corner()?);
                self.need("a sphere needs a radius after its centre")?;
                match self.size()? {
                    0.0 => self.nothing("this sphere has the radius 0", place),
                    radius => scene::Shape::Sphere { centre, radius }.into(),
                }
            }
            Keyword::Box => {
                self.need("a box needs two opposite corners")?;
                let a = self.corner()?;
                self.need("a box needs its second corner after the first")?;
                let b = self.vector()?;
                match (0..3).filter(|&i| a[i] == b[i]).count() {
                    0 => scene::Shape::Box { a: point(a), b: point(b) }.into(),
                    1 => Shape::FlatBox { a, b },
                    _ => self.nothing("this box has neither volume nor area", place),
                }
            }
            Keyword::Cylinder => {
                self.need("a cylinder needs the centres of its two ends")?;
                let base = point(self.corner()?);
                self.need("a cylinder needs the centre of its second end after the first")?;
                let cap = point(self.corner()?);
                self.need("a cylinder needs a radius after the centres of its ends")?;
                if base == cap {
                    return Err(Error::invalid(place, "this cylinder's ends are the same point"));
                }
                match self.size()? {
                    0.0 => self.nothing("this cylinder has the radius 0", place),
                    radius => scene::Shape::Cylinder { base, cap, radius }.into(),
                }
            }
            Keyword::Cone => {
                self.need("a cone needs the centre of its first end")?;
                let base = point(self.corner()?);
                self.need("a cone needs a radius after the centre of its first end")?;
                let base_radius = self.float()?;
                self.skip_comma()?;
                self.need("a cone needs the centre of its second end after the first radius")?;
                let cap = point(self.corner()?);
                self.need("a cone needs a radius after the centre of its second end")?;
                let cap_radius = self.float()?;
                if base == cap {
                    return Err(Error::invalid(place, "this cone's ends are the same point"));
                }
                match (base_radius, cap_radius) {
                    (0.0, 0.0) => self.nothing("both radii of this cone are 0", place),
                    (a, b) if a.min(b) < 0.0 && a.max(b) > 0.0 => {
                        return Err(Error::invalid(place, "this cone's radii have different signs"));
                    }
                    (a, b) => {
                        scene::Shape::Cone { base, base_radius: a.abs(), cap, cap_radius: b.abs() }.into()
                    }
                }
            }
            Keyword::Plane => {
                self.need("a plane needs its normal")?;
                let normal = vector(self.normal("the plane's normal")?);
                self.need("a plane needs its distance from the origin after the normal")?;
                scene::Shape::Plane { normal, distance: self.float()? }.into()
            }
            Keyword::Disc => {
                self.need("a disc needs its centre")?;
                let centre = point(self.corner()?);
                self.need("a disc needs its normal after the centre")?;
                let normal = self.corner()?;
                self.need("a disc needs a radius after its normal")?;
                let radius = self.size()?;
                self.skip_comma()?;
                let hole = if self.starts_number()? { self.size()? } else { 0.0 };
                if length(normal) == 0.0 {
                    self.nothing("the normal of this disc has no length", place)
                } else if hole >= radius {
                    self.nothing("this disc has no area", place)
                } else {
                    scene::Shape::Disc { centre, normal: vector(normal), radius, hole }.into()
                }
            }
            Keyword::Triangle => {
                let mut corners = [Point3::ORIGIN; 3];
                for (which, corner) in ["first", "second", "third"].iter().zip(&mut corners) {
                    self.need(&format!("a triangle needs three corners: the {which} is missing"))?;
                    *corner = point(self.corner()?);
                }
                scene::Shape::Triangle(corners).into()
            }
            Keyword::SmoothTriangle => {
                let mut corners = [[0.0; 3]; 3];
                let mut normals = [[0.0; 3]; 3];
                for i in 0..3 {
                    (corners[i], normals[i]) = (self.corner()?, self.corner()?);
                }
                if normals.iter().any(|&normal| length(normal) == 0.0) {
                    self.nothing("a normal of this triangle has no length", place)
                } else {
                    scene::Shape::SmoothTriangle(Box::new((corners.map(point), normals.map(unit)))).into()
                }
            }
            Keyword::Polygon => {
                let loops = self.polygon(place)?;
                let rule = self.fill_rule()?;
                if loops.is_empty() {
                    self.nothing("this polygon has no area", place)
                } else {
                    scene::Shape::Polygon { loops: loops.into(), rule }.into()
                }
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
                    self.nothing("the equation of this quadric has no variable in it", place)
                } else {
                    scene::Shape::Quadric(Box::new([a, b, c, d, e, f, g, h, i, constant])).into()
                }
            }
            Keyword::Superellipsoid => self.superellipsoid()?,
            Keyword::Blob => self.blob(place)?,
            Keyword::JuliaFractal => self.julia_fractal()?,
            Keyword::HeightField => self.height_field(place)?,
            Keyword::Torus => {
                let major = self.size()?;
                self.skip_comma()?;
                match (major, self.size()?) {
                    (_, 0.0) => self.nothing("the minor radius of this torus is 0", place),
                    (0.0, radius) => scene::Shape::Sphere { centre: Point3::ORIGIN, radius }.into(),
                    (major, minor) => scene::Shape::Torus { major, minor }.into(),
                }
            }
            Keyword::Prism => self.prism(place)?,
            Keyword::Text => self.text(place)?,
            Keyword::SphereSweep => self.sphere_sweep(place)?,
            Keyword::Sor => self.sor()?,
            Keyword::Lathe => self.lathe(place)?,
            Keyword::BicubicPatch => self.bicubic_patch(place)?,
            Keyword::Parametric => self.parametric(place)?,
            Keyword::Ovus => self.ovus(place)?,
            Keyword::Cubic => self.coefficients(3, place)?,
            Keyword::Quartic => self.coefficients(4, place)?,
            Keyword::Poly => {
                let order = self.order()?;
                self.coefficients(order, place)?
            }
            Keyword::Polynomial => {
                let order = self.order()?;
                self.terms(order, place)?
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
        Ok(scene::Shape::Superellipsoid { e: terms[0], n: terms[1] }.into())
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

    /// `<A1, A2, ...>`: all coefficients of a polynomial, by falling powers of x, then of y, then
    /// of z.
    fn coefficients(&mut self, order: u32, place: Place) -> Result<Shape> {
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
        Ok(self.zero_set(order, list, place))
    }

    /// `xyz(i, j, k): value, ...`: the coefficients that are not zero.
    fn terms(&mut self, order: u32, place: Place) -> Result<Shape> {
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
        Ok(self.zero_set(order, list, place))
    }

    /// The surface where a polynomial with these coefficients is zero.
    fn zero_set(&mut self, order: u32, coefficients: Vec<f64>, place: Place) -> Shape {
        // The constant is the last one.
        if coefficients.iter().rev().skip(1).all(|c| *c == 0.0) {
            return self.nothing("this polynomial has no variable in it", place);
        }
        scene::Shape::Polynomial { order, coefficients: coefficients.into() }.into()
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
    fn polygon(&mut self, place: Place) -> Result<Vec<Vec<Point3>>> {
        let count = self.float()?;
        self.skip_comma()?;
        if !(3.0..1e9).contains(&count) {
            return Err(Error::invalid(place, "a polygon has at least three points"));
        }
        let (mut loops, mut current) = (Vec::new(), Vec::<Point3>::new());
        for n in 0..count as usize {
            let point = point(self.corner()?);
            self.check_memory(n * 48, place)?;
            if current.first() == Some(&point) {
                loops.push(std::mem::take(&mut current));
            } else {
                current.push(point);
            }
        }
        if !current.is_empty() {
            self.notice(place, "this polygon does not end at its first point; durer closes it");
            loops.push(current);
        }
        // Where it turns back at once there is no area.
        loops.retain(|points| points.len() >= 3);
        if loops.first().is_some_and(|outline| starts_inward(outline)) {
            // The first corners stay the first.
            loops.iter_mut().for_each(|points| points[1..].reverse());
        }
        Ok(loops)
    }
}

/// Whether the first three corners of an outline that are not on one line go round the other way
/// than all of it. They decide which side is the front.
fn starts_inward(points: &[Point3]) -> bool {
    let from_first = |p: Point3| (p - points[0]).to_array();
    let turns = |a: Point3, b: Point3| cross(from_first(a), from_first(b));
    let all = points.windows(2).fold([0.0; 3], |sum, two| {
        let turn = turns(two[0], two[1]);
        std::array::from_fn(|axis| sum[axis] + turn[axis])
    });
    let first = points[2..].iter().map(|&p| turns(points[1], p)).find(|turn| turn.iter().any(|&x| x != 0.0));
    first.is_some_and(|first| dot(first, all) < 0.0)
}

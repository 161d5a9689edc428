//! The numbers of POV-Ray's shapes.

use std::rc::Rc;

use super::Shape;
use crate::diagnostics::{Fault, Place, Result};
use crate::keywords::Keyword;
use crate::lexer::Mark;
use crate::reader::Reader;
use crate::transform::length;

impl Reader<'_> {
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
                    return Err(Fault::invalid(place, "this box has no thickness"));
                }
                Shape::Box { a, b }
            }
            Keyword::Cylinder => {
                let (base, cap) = (self.corner()?, self.corner()?);
                if base == cap {
                    return Err(Fault::invalid(place, "this cylinder's ends are the same point"));
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
                    return Err(Fault::invalid(place, "this cone's ends are the same point"));
                }
                let (base_radius, cap_radius) = match (base_radius, cap_radius) {
                    (a, b) if a == 0.0 && b == 0.0 => {
                        return Err(Fault::invalid(place, "both of this cone's radii are zero"));
                    }
                    (a, b) if a >= 0.0 && b >= 0.0 => (a, b),
                    (a, b) if a <= 0.0 && b <= 0.0 => (-a, -b),
                    _ => return Err(Fault::invalid(place, "this cone's radii have different signs")),
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
                    return Err(Fault::invalid(place, "the disc's hole is as large as the disc"));
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
                    return Err(Fault::invalid(place, "this quadric's equation has no variable in it"));
                }
                Shape::Quadric(Box::new([a, b, c, d, e, f, g, h, i, constant]))
            }
            Keyword::Isosurface => self.isosurface(place)?,
            // `begins_object` lists no other shape.
            _ => return Err(Fault::unsupported(place, keyword.text())),
        })
    }

    /// A point and the comma behind it.
    pub(crate) fn corner(&mut self) -> Result<[f64; 3]> {
        let v = self.vector()?;
        self.skip_comma()?;
        Ok(v)
    }

    /// A direction and the comma behind it.
    pub(crate) fn normal(&mut self, what: &str) -> Result<[f64; 3]> {
        self.peek()?;
        let place = self.here();
        let v = self.corner()?;
        if length(v) == 0.0 {
            return Err(Fault::invalid(place, format!("{what} has no length")));
        }
        Ok(v)
    }

    /// `n, points`: a loop ends where its first point comes again.
    fn polygon(&mut self, place: Place) -> Result<Vec<Vec<[f64; 3]>>> {
        let count = self.float()?;
        self.skip_comma()?;
        if !(3.0..1e9).contains(&count) {
            return Err(Fault::invalid(place, "a polygon has at least three points"));
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
            return Err(Fault::invalid(place, "a loop of this polygon has fewer than three corners"));
        }
        Ok(loops)
    }
}

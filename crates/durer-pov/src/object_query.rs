//! Questions of expressions to objects: `trace`, `inside`, `min_extent` and `max_extent`.
//!
//! The object is lowered to a geometry of its own, which answers as exactly as for pictures. The last
//! few geometries are kept, because scenes ask one object many times in a loop.

use std::collections::VecDeque;
use std::rc::Rc;

use durer_math::{Aabb, Ray, Vec3, gamma};
use durer_scene as scene;
use scene::{Lowered, Operation};

use crate::diagnostics::{Error, Place, Result};
use crate::lexer::{Kind, Mark};
use crate::object::{Object, Shape};
use crate::parser::{Item, Parser};
use crate::scene_builder::{Lights, point, vector};
use crate::scope::Reference;
use crate::transform::{Matrix, cross, dot};
use crate::value::{Terms, Value};

/// Geometries that are kept.
const KEPT: usize = 8;
/// How many steps of the reader a question counts as.
const STEPS: u64 = 16;
/// Roundings of a computed point relative to a surface: each of the two is written (1), scaled (1),
/// rotated (3) and moved (1).
const ORIGIN_ROUNDINGS: u32 = 12;
/// POV-Ray's bounding box of an unbounded object ends here on each axis.
const UNBOUNDED: f64 = 1e10;

/// Objects that were asked lately, with their geometries. Objects without a surface have none.
pub(crate) type Queried = VecDeque<(Rc<Object>, Option<Rc<Lowered>>)>;

impl Parser<'_> {
    /// `trace(OBJECT, ORIGIN, DIRECTION [, NORMAL])`: the first point of the object's surface on the
    /// ray, and its normal in the variable NORMAL. Both are zero for a ray that misses.
    pub(crate) fn trace(&mut self, place: Place) -> Result<Terms> {
        let object = self.object_argument()?;
        let origin = self.vector_argument()?;
        let direction = self.vector()?;
        let normal = if self.take_mark(Mark::Comma)? { Some(self.normal_argument()?) } else { None };
        let found = match self.geometry_of(&object, place)? {
            Some(lowered) => first_crossing(&object, &lowered, origin, direction),
            None => None,
        };
        let (p, n) = found.unwrap_or_default();
        if let Some((variable, at)) = normal {
            self.assign_element(&variable, Value::Number(n.into()), at)?;
        }
        Ok(p.into())
    }

    /// `inside(OBJECT, POINT)`: whether the point is inside the object or on its surface.
    pub(crate) fn inside(&mut self, place: Place) -> Result<bool> {
        let object = self.object_argument()?;
        let p = self.vector()?;
        let lowered = self.geometry_of(&object, place)?;
        Ok(lowered.is_some_and(|lowered| lowered.geometry.contains(point(p))))
    }

    /// `min_extent(OBJECT)` and `max_extent(OBJECT)`: the corners of the object's bounding box.
    pub(crate) fn object_extent(&mut self, place: Place) -> Result<[[f64; 3]; 2]> {
        let object = self.object_argument()?;
        self.count_steps(STEPS.saturating_add(object.leaves), place)?;
        let bounds = self.extent_of(&object, place)?;
        if bounds.is_empty() {
            return Ok([[0.0; 3]; 2]);
        }
        if !bounds.is_bounded() {
            return Ok([[-UNBOUNDED; 3], [UNBOUNDED; 3]]);
        }
        Ok([bounds.min.to_array(), bounds.max.to_array()])
    }

    /// A declared object and the comma after it.
    fn object_argument(&mut self) -> Result<Rc<Object>> {
        let lexeme = self.next()?;
        let Item::Value(Value::Object(object)) = lexeme.item else {
            return Err(self.unexpected(&lexeme, "a declared object"));
        };
        self.skip_comma()?;
        Ok(object)
    }

    /// The variable or the array element that receives a normal.
    fn normal_argument(&mut self) -> Result<(Reference, Place)> {
        let wanted = "expected a declared variable for the normal";
        let Some((Kind::Name(name), at)) = self.take_raw() else {
            return Err(Error::invalid(self.here(), wanted));
        };
        let variable = if self.raw() == Some(Kind::Mark(Mark::SquareOpen)) {
            Some(self.element_reference(name)?)
        } else {
            self.scopes.reference(name)
        };
        let is_known = |variable: &Reference| self.scopes.at(variable).is_some();
        match variable.filter(is_known) {
            Some(variable) => Ok((variable, at)),
            None => Err(Error::invalid(at, format!("{wanted}: `{}` is none", self.names.text(name)))),
        }
    }

    /// The object's geometry; `None` if it has no surface.
    fn geometry_of(&mut self, object: &Rc<Object>, place: Place) -> Result<Option<Rc<Lowered>>> {
        self.count_steps(STEPS, place)?;
        if let Some((_, known)) = self.queried.iter().find(|(known, _)| Rc::ptr_eq(known, object)) {
            return Ok(known.clone());
        }
        self.check_memory((object.leaves as usize).saturating_mul(size_of::<scene::Object>()), place)?;
        self.count_steps(object.leaves, place)?;
        let made = self.lowered(object, place)?.map(Rc::new);
        if self.queried.len() == KEPT {
            self.queried.pop_front();
        }
        self.queried.push_back((object.clone(), made.clone()));
        Ok(made)
    }

    fn lowered(&mut self, object: &Object, place: Place) -> Result<Option<Lowered>> {
        let Some(shown) = self.emitted_with_default(object, &mut Lights::new())? else { return Ok(None) };
        let alone = scene::Scene { objects: vec![shown], ..scene::Scene::default() };
        let made = alone.lower().map_err(|why| Error::invalid(place, format!("this object: {why}")))?;
        Ok(Some(made))
    }

    /// The bounding box as POV-Ray composes it: placed boxes are boxed again, a difference has the
    /// box of its first part, and clipping does not count.
    fn extent_of(&mut self, object: &Object, place: Place) -> Result<Aabb> {
        let inner = match &object.shape {
            Shape::Light(_) | Shape::Nothing => Aabb::EMPTY,
            Shape::Union(parts) | Shape::Csg(Operation::Merge, parts) => {
                let mut all = Aabb::EMPTY;
                for part in parts {
                    all = all.union(self.extent_of(part, place)?);
                }
                all
            }
            Shape::Csg(Operation::Intersection, parts) => {
                let mut all = Aabb::UNBOUNDED;
                for part in parts {
                    let own = self.extent_of(part, place)?;
                    all = if part.habits.inverse { all } else { all.intersection(own) };
                }
                all
            }
            Shape::Csg(Operation::Difference, parts) => match parts.first() {
                Some(first) => self.extent_of(first, place)?,
                None => Aabb::EMPTY,
            },
            Shape::FlatBox { a, b } => Aabb::from_points([point(*a), point(*b)]),
            &Shape::Plane { normal, distance } => {
                return Ok(if object.place.is_identity() {
                    half_space(normal, distance)
                } else {
                    Aabb::UNBOUNDED
                });
            }
            &Shape::Sphere { center, radius } => {
                if let Some(scale) = scale_of_similarity(&object.place) {
                    let half = vector([radius * scale; 3]);
                    return Ok(Aabb::centred(point(object.place.point(center)), half));
                }
                self.extent_of_leaf(object, place)?
            }
            _ => self.extent_of_leaf(object, place)?,
        };
        Ok(placed(inner, &object.place))
    }

    /// The tight box of one surface in its own frame.
    fn extent_of_leaf(&mut self, object: &Object, place: Place) -> Result<Aabb> {
        let mut bare = object.clone();
        bare.place = Matrix::IDENTITY;
        bare.clips.clear();
        bare.habits.inverse = false;
        Ok(self.lowered(&bare, place)?.map_or(Aabb::EMPTY, |made| made.geometry.bounds()))
    }
}

/// The box of a moved box.
fn placed(inner: Aabb, by: &Matrix) -> Aabb {
    if inner.is_empty() || !inner.is_bounded() || by.is_identity() {
        return inner;
    }
    Aabb::from_points(inner.corners().map(|corner| point(by.point(corner.to_array()))))
}

/// The box of `normal . p <= distance |normal|`, which is unbounded in at least five directions.
fn half_space(normal: [f64; 3], distance: f64) -> Aabb {
    let mut all = Aabb::UNBOUNDED;
    if let Some(axis) = (0..3).find(|&axis| normal[(axis + 1) % 3] == 0.0 && normal[(axis + 2) % 3] == 0.0) {
        if normal[axis] > 0.0 {
            all.max[axis] = distance;
        } else {
            all.min[axis] = -distance;
        }
    }
    all
}

/// By how much a matrix scales all lengths, if it turns and scales without shearing.
fn scale_of_similarity(matrix: &Matrix) -> Option<f64> {
    let [x, y, z, _] = matrix.rows;
    let square = dot(x, x);
    // Rows of computed rotations, three about axes at most, are orthogonal up to this.
    let rounding = square * gamma(ORIGIN_ROUNDINGS);
    let is_close = |a: f64, b: f64| (a - b).abs() <= rounding;
    let is_similarity = is_close(dot(y, y), square)
        && is_close(dot(z, z), square)
        && [dot(x, y), dot(y, z), dot(z, x)].into_iter().all(|product| is_close(product, 0.0));
    is_similarity.then(|| square.sqrt())
}

/// The first crossing of a ray, and the normal there: outward for solids; POV-Ray's for triangles.
///
/// A surface through the origin is not seen there, as from a camera: a crossing at no greater
/// distance than the rounding of the origin's coordinates, and of the surface's numbers, is skipped.
fn first_crossing(
    object: &Object,
    lowered: &Lowered,
    origin: [f64; 3],
    direction: [f64; 3],
) -> Option<([f64; 3], [f64; 3])> {
    let ray = Ray::new(point(origin), vector(direction));
    let sum = |v: Vec3| v.x.abs() + v.y.abs() + v.z.abs();
    let rounding = gamma(ORIGIN_ROUNDINGS) * sum(vector(origin));
    lowered.geometry.all(&ray).iter().find_map(|hit| {
        let found = lowered.geometry.resolve(&ray, hit);
        let is_at_origin = hit.t_lo <= 0.0 || hit.t_lo * sum(vector(direction)) <= rounding + found.off;
        (!is_at_origin).then(|| {
            let normal = [found.ns.x, found.ns.y, found.ns.z];
            let is_reversed = leaf(object, &mut hit.primitive.clone(), &Matrix::IDENTITY)
                .is_some_and(|(shape, face, place)| is_reversed(shape, face, &place, normal));
            (found.p.to_array(), if is_reversed { normal.map(|n| -n) } else { normal })
        })
    })
}

/// The surface with a primitive's number, the primitive's number in it, and its whole placement.
fn leaf<'a>(object: &'a Object, primitive: &mut u32, around: &Matrix) -> Option<(&'a Shape, u32, Matrix)> {
    if object.lacks_volume {
        return None;
    }
    let place = object.place.then(around);
    let count = match &object.shape {
        Shape::Union(parts) | Shape::Csg(_, parts) => {
            return parts.iter().find_map(|part| leaf(part, primitive, &place));
        }
        Shape::Light(_) => 0,
        Shape::Deform(..) => return None,
        Shape::Mesh(mesh) => mesh.faces.len() as u32,
        _ => 1,
    };
    if *primitive < count {
        return Some((&object.shape, *primitive, place));
    }
    *primitive -= count;
    None
}

/// Whether POV-Ray's normal is opposite to `normal`.
///
/// The normal of a flat triangle is `(p3 - p1) x (p2 - p1)`, as its coordinates are left-handed. A
/// smooth triangle has its interpolated normals as they were given, on whatever side they are.
fn is_reversed(shape: &Shape, face: u32, place: &Matrix, normal: [f64; 3]) -> bool {
    let (corners, normals) = match shape {
        Shape::Triangle(corners) => (*corners, None),
        Shape::SmoothTriangle(both) => (both.0, Some(both.1)),
        Shape::Mesh(mesh) => {
            let Some(face) = mesh.faces.get(face as usize) else { return false };
            let corner = |i: u32| mesh.vertices[i as usize];
            (face.vertices.map(corner), face.normals.map(|all| all.map(|i| mesh.normals[i as usize])))
        }
        _ => return false,
    };
    let given = match normals {
        Some([a, b, c]) => [0, 1, 2].map(|i| a[i] + b[i] + c[i]),
        None => {
            let [a, b, c] = corners;
            let from_a = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
            cross(from_a(c), from_a(b))
        }
    };
    // A placed normal is the given one times the inverse transposed matrix.
    let [x, y, z, _] = place.rows;
    dot([dot(x, normal), dot(y, normal), dot(z, normal)], given) < 0.0
}

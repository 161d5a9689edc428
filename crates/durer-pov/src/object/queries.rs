//! Queries of the scene about its own objects: `trace`, `inside`, `min_extent` and `max_extent`.
//!
//! At its first query an object is lowered as if it were the whole scene, so the kernels give exact
//! answers. The last few objects are kept, since scenes query them in loops.
//!
//! Facts of the scene language, found by `#debug` with POV-Ray 3.7:
//!
//! - `trace` ignores surfaces on which the ray starts. The normal is the object's own and points
//!   out of solids, whatever the ray's direction. That of a flat triangle is the opposite of
//!   `cross(b - a, c - a)`, that of a smooth one is interpolated.
//! - `inside`: a clipped object contains the points that are in it and in all its clips.
//! - The extent is that of the transformed corners of a box in the object's own frame.

use std::collections::VecDeque;
use std::rc::Rc;

use durer_math::{Point3, Ray, Vec3};
use durer_scene::{self as scene, Shape as Leaf};

use super::{Object, Shape};
use crate::diagnostics::{Error, Place, Result};
use crate::limits::Charge;
use crate::parser::Parser;
use crate::scene_builder::{Lights, point, vector};
use crate::transform::{Matrix, cross, dot};
use crate::value::{Terms, Value};

/// How many objects are kept ready for rays.
const KEPT: usize = 32;

/// The steps charged for a query, in addition to those for lowering the object.
const STEPS: u64 = 20;

/// The approximate bytes of a lowered surface.
const SURFACE_BYTES: usize = 400;

/// The extent that POV-Ray gives to unbounded objects.
const UNBOUNDED: f64 = 1e10;

/// A queried object, ready for rays.
#[derive(Debug)]
struct Asked {
    object: Rc<Object>,
    /// Whether only the volume is lowered: `inside` needs other surfaces than `trace`.
    solid: bool,
    /// `None` if no surface is left.
    ready: Option<Rc<Ready>>,
    _charge: Charge,
}

#[derive(Debug)]
struct Ready {
    geometry: scene::Lowered,
    /// The kinds of the primitives' normals; empty if all are those of the kernel.
    triangles: Vec<Triangle>,
}

/// The kind of a primitive's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Triangle {
    /// The normal of the kernel.
    Not,
    /// The opposite of the kernel's normal.
    Opposite,
    /// The interpolated normal.
    Smooth,
    /// The interpolated normal, which the kernel reversed to the side of the cross product.
    SmoothTurned,
}

/// The objects that were queried last.
#[derive(Debug, Default)]
pub(crate) struct Questions(VecDeque<Asked>);

impl Parser<'_> {
    /// `trace(OBJECT, ORIGIN, DIRECTION [, NORMAL])`, between its parentheses.
    pub(crate) fn trace(&mut self, place: Place) -> Result<Terms> {
        let object = self.asked_object()?;
        let origin = self.vector()?;
        self.skip_comma()?;
        let direction = self.vector()?;
        let normal = if self.take_mark(crate::lexer::Mark::Comma)? {
            let at = self.here();
            let target = self.variable_argument()?;
            Some(target.ok_or_else(|| {
                Error::invalid(at, "trace's fourth argument is the name of a declared vector")
            })?)
        } else {
            None
        };
        self.count_steps(STEPS, place)?;
        let ready = self.ready(&object, false, place)?;
        let ray = Ray::new(point(origin), vector(direction));
        let found = ready.and_then(|ready| ready.first(&ray)).unwrap_or_default();
        if let Some(target) = normal {
            self.assign_element(&target, Value::Number(found.1.into()), place)?;
        }
        Ok(found.0.into())
    }

    /// `inside(OBJECT, POINT)`, between its parentheses.
    pub(crate) fn inside(&mut self, place: Place) -> Result<Terms> {
        let object = self.asked_object()?;
        let at = self.vector()?;
        self.count_steps(STEPS, place)?;
        if object.lacks_volume {
            return self.inside_what_lacks_volume(&object, at, place);
        }
        let ready = self.ready(&object, true, place)?;
        let holds = ready.is_some_and(|ready| ready.geometry.geometry.contains(point(at)));
        Ok(f64::from(u8::from(holds)).into())
    }

    /// Reads the object of an `object` pattern: its volume as data of the scene.
    pub(crate) fn volume_for_pattern(&mut self, place: Place) -> Result<scene::Object> {
        let object = self.asked_object()?;
        if object.lacks_volume {
            return Err(Error::invalid(
                place,
                "this object cannot be a pattern: it has parts without volume",
            ));
        }
        // It is built once here, so that errors name the object.
        self.ready(&object, true, place)?;
        let made = self.emitted(&object, &mut Lights::new()).map_err(|fault| from_here(fault, place))?;
        made.map(volume).ok_or_else(|| Error::invalid(place, "this object has no inside"))
    }

    /// `min_extent(OBJECT)` and `max_extent(OBJECT)`, between their parentheses.
    pub(crate) fn end_of_extent(&mut self, greatest: bool, place: Place) -> Result<Terms> {
        let object = self.asked_object()?;
        self.count_steps(STEPS + object.leaves, place)?;
        let extent = self.extent_of(&object, place)?;
        // A box without a point, such as that of spheres that do not meet, is no bound in POV-Ray.
        let (min, max) = if extent.is_empty() { Extent::SPACE.ends() } else { extent.ends() };
        let end = if greatest { max } else { min };
        Ok(end.map(|v| v.clamp(-UNBOUNDED, UNBOUNDED)).into())
    }

    /// Reads the object of a query, and the comma after it.
    fn asked_object(&mut self) -> Result<Rc<Object>> {
        if !self.starts_object()? {
            let lexeme = self.next()?;
            return Err(self.unexpected(&lexeme, "an object"));
        }
        let object = self.object()?;
        self.skip_comma()?;
        Ok(object)
    }

    /// An object made ready for rays, its volume alone if `solid`.
    fn ready(&mut self, object: &Rc<Object>, solid: bool, place: Place) -> Result<Option<Rc<Ready>>> {
        let asked = &mut self.questions.0;
        if let Some(at) = asked.iter().position(|a| a.solid == solid && Rc::ptr_eq(&a.object, object)) {
            if let Some(known) = asked.remove(at) {
                asked.push_front(known);
            }
            return Ok(asked.front().and_then(|known| known.ready.clone()));
        }
        self.count_steps(object.leaves, place)?;
        let bytes = (object.leaves as usize).saturating_mul(SURFACE_BYTES);
        self.check_memory(bytes, place)?;
        let made = self.emitted_for_a_question(object);
        let made = made.map_err(|fault| from_here(fault, place))?;
        let ready = match made {
            Some(made) => {
                let triangles = triangles(&made);
                let made = if solid { volume(made) } else { made };
                let alone = scene::Scene { objects: vec![made], ..scene::Scene::default() };
                let geometry = alone.lower().map_err(|fault| {
                    let at = fault.place.map_or(object.at, |p| Place { file: p.file, start: p.start });
                    from_here(Error::invalid(at, fault.kind.to_string()), place)
                })?;
                let count = geometry.primitives(0) as usize;
                let triangles = if triangles.len() == count { triangles } else { Vec::new() };
                Some(Rc::new(Ready { geometry, triangles }))
            }
            None => None,
        };
        let asked = &mut self.questions.0;
        asked.truncate(KEPT - 1);
        asked.push_front(Asked {
            object: object.clone(),
            solid,
            ready: ready.clone(),
            _charge: Charge::new(bytes),
        });
        Ok(ready)
    }

    /// Answers `inside` for objects without volume: flat boxes and empty objects contain no point,
    /// all of space contains each.
    fn inside_what_lacks_volume(&mut self, object: &Object, at: [f64; 3], place: Place) -> Result<Terms> {
        let own = object.place.inverse().map_or(at, |back| back.point(at));
        let mut within = match &object.shape {
            Shape::Union(parts) | Shape::Csg(scene::Operation::Merge, parts) => {
                self.any_holds(parts, own, place)?
            }
            Shape::Csg(scene::Operation::Intersection, parts) => {
                let mut all = true;
                for part in parts {
                    all &= self.holds(part, own, place)?;
                }
                all
            }
            Shape::Csg(scene::Operation::Difference, parts) => match parts.split_first() {
                Some((first, rest)) => self.holds(first, own, place)? && !self.any_holds(rest, own, place)?,
                None => false,
            },
            _ => false,
        };
        within ^= object.habits.inverse;
        for clip in &object.clips {
            within &= self.holds(clip, at, place)?;
        }
        Ok(f64::from(u8::from(within)).into())
    }

    fn any_holds(&mut self, parts: &[Rc<Object>], at: [f64; 3], place: Place) -> Result<bool> {
        let mut any = false;
        for part in parts {
            any |= self.holds(part, at, place)?;
        }
        Ok(any)
    }

    fn holds(&mut self, object: &Rc<Object>, at: [f64; 3], place: Place) -> Result<bool> {
        if object.lacks_volume {
            return Ok(self.inside_what_lacks_volume(object, at, place)?.float() == Some(1.0));
        }
        let ready = self.ready(object, true, place)?;
        Ok(ready.is_some_and(|ready| ready.geometry.geometry.contains(point(at))))
    }

    /// The box of an object in the space around it.
    fn extent_of(&mut self, object: &Rc<Object>, place: Place) -> Result<Extent> {
        let own = match &object.shape {
            &Shape::Leaf(Leaf::Sphere { centre, radius }) if is_similarity(&object.place) => {
                // A sphere stays one.
                let moved = object.place.point(centre.to_array());
                let radius = radius * length_of(object.place.rows[0]);
                return self.cut_extent(object, Extent::around(moved, [radius; 3]), place);
            }
            Shape::Union(parts) | Shape::Csg(scene::Operation::Merge, parts) => {
                let mut all = Extent::EMPTY;
                for part in parts {
                    all = all.with(&self.extent_of(part, place)?);
                }
                all
            }
            Shape::Csg(operation, parts) => {
                let mut all = Extent::SPACE;
                for (number, part) in parts.iter().enumerate() {
                    let away = *operation == scene::Operation::Difference && number > 0;
                    all = all.within(&match half_space(part) {
                        Some(half) if away && matches!(part.shape, Shape::Leaf(Leaf::Plane { .. })) => {
                            half.other_half()
                        }
                        Some(half) if !away => half,
                        _ if away || part.habits.inverse => continue,
                        _ => self.extent_of(part, place)?,
                    });
                }
                all
            }
            shape => self.extent_of_shape(shape, object, place)?,
        };
        let placed = own.placed(&object.place);
        self.cut_extent(object, placed, place)
    }

    /// The box of an object's clips, or of its `bounded_by`, if that is smaller than its own.
    fn cut_extent(&mut self, object: &Object, own: Extent, place: Place) -> Result<Extent> {
        let mut cut = Extent::SPACE;
        for clip in object.clips.iter().chain(&object.bounds) {
            if !clip.habits.inverse {
                cut = cut.within(&self.extent_of(clip, place)?);
            }
        }
        Ok(if cut.volume() < own.volume() { cut } else { own })
    }

    /// The box of a single shape in its own frame.
    fn extent_of_shape(&mut self, shape: &Shape, object: &Object, place: Place) -> Result<Extent> {
        match *shape {
            Shape::Nothing => return Ok(Extent::around([0.0; 3], [0.0; 3])),
            Shape::Light(_) => return Ok(Extent::SPACE),
            Shape::FlatBox { a, b } => return Ok(Extent::of([a, b])),
            _ => {}
        }
        if let Some(extent) = shape.leaf().and_then(Extent::of_leaf) {
            return Ok(extent);
        }
        // Its bounds in the kernel, from the shape alone.
        let alone = match shape {
            Shape::Deform(..) => Object { place: Matrix::IDENTITY, ..object.clone() },
            _ => Object::new(shape.clone(), object.at),
        };
        let Some(alone) = self.emitted_for_a_question(&alone)? else { return Ok(Extent::EMPTY) };
        let alone = scene::Scene { objects: vec![alone], ..scene::Scene::default() };
        let lowered = alone
            .lower()
            .map_err(|fault| from_here(Error::invalid(object.at, fault.kind.to_string()), place))?;
        let bounds = lowered.geometry.bounds();
        Ok(Extent { min: bounds.min.to_array(), max: bounds.max.to_array() })
    }
}

/// An error in a queried object, with the place of the query.
fn from_here(mut fault: Box<Error>, place: Place) -> Box<Error> {
    if fault.place != Some(place) {
        fault.route.push(("what is asked".to_owned(), place));
    }
    fault
}

impl Ready {
    /// The first point along the ray that is not where it starts, and the normal there.
    fn first(&self, ray: &Ray) -> Option<([f64; 3], [f64; 3])> {
        let geometry = &self.geometry.geometry;
        let nearest = geometry.closest(ray)?;
        let starts_there = |p: Point3, dp: Vec3| {
            // The start is an f64 point of the surface if the surface passes between it and its
            // neighbours.
            let near = |o: f64, p: f64, dp: f64| {
                let (o, p) = (o.abs().max(p.abs()), (o - p).abs());
                p <= dp + (o.next_up() - o)
            };
            near(ray.origin.x, p.x, dp.x) && near(ray.origin.y, p.y, dp.y) && near(ray.origin.z, p.z, dp.z)
        };
        let mut hit = nearest;
        let mut found = geometry.resolve(ray, &hit);
        if starts_there(found.p, found.dp) {
            let all = geometry.all(ray);
            let next = all.iter().map(|hit| (*hit, geometry.resolve(ray, hit)));
            (hit, found) = next.into_iter().find(|(_, found)| !starts_there(found.p, found.dp))?;
        }
        let turned = match self.triangles.get(hit.primitive.0 as usize) {
            None | Some(Triangle::Not) => found.ng,
            Some(Triangle::Opposite) => -found.ng,
            Some(Triangle::Smooth) => found.ns,
            Some(Triangle::SmoothTurned) => -found.ns,
        };
        let (p, n) = (found.p.to_vec().to_array(), turned.to_vec().to_array());
        // No negative zeros, which scenes would print.
        Some((p.map(|v| v + 0.0), n.map(|v| v + 0.0)))
    }
}

/// The volume of an object: `open` is removed, and clips become an intersection.
fn volume(mut object: scene::Object) -> scene::Object {
    object.flags.open = false;
    object.shape = match object.shape {
        scene::Shape::Union(parts) => scene::Shape::Union(parts.into_iter().map(volume).collect()),
        scene::Shape::Csg(operation, parts) => {
            scene::Shape::Csg(operation, parts.into_iter().map(volume).collect())
        }
        other => other,
    };
    let clips = std::mem::take(&mut object.clips);
    if clips.is_empty() || is_sheet(&object.shape) {
        return object;
    }
    let parts = std::iter::once(object).chain(clips.into_iter().map(volume)).collect();
    scene::Object::new(scene::Shape::Csg(scene::Operation::Intersection, parts))
}

fn is_sheet(shape: &scene::Shape) -> bool {
    match shape {
        scene::Shape::Triangle(_)
        | scene::Shape::SmoothTriangle(_)
        | scene::Shape::Polygon { .. }
        | scene::Shape::Parallelogram { .. }
        | scene::Shape::Disc { .. } => true,
        scene::Shape::Mesh(mesh) => mesh.inside_vector.is_none(),
        _ => false,
    }
}

/// The kinds of the primitives' normals, if there are triangles among them.
fn triangles(object: &scene::Object) -> Vec<Triangle> {
    let mut kinds = Vec::new();
    collect_triangles(object, &mut kinds);
    if kinds.iter().all(|kind| *kind == Triangle::Not) { Vec::new() } else { kinds }
}

fn collect_triangles(object: &scene::Object, kinds: &mut Vec<Triangle>) {
    let corners = |[a, b, c]: [Point3; 3]| [a, b, c].map(|p| p.to_vec().to_array());
    match &object.shape {
        scene::Shape::Union(parts) | scene::Shape::Csg(_, parts) => {
            parts.iter().for_each(|part| collect_triangles(part, kinds));
        }
        scene::Shape::Triangle(_) => kinds.push(Triangle::Opposite),
        // The kernel orients the triangle by its normals.
        scene::Shape::SmoothTriangle(_) => kinds.push(Triangle::Smooth),
        scene::Shape::HeightField(field) if field.is_smooth() => kinds.push(Triangle::Smooth),
        scene::Shape::Mesh(mesh) => kinds.extend(mesh.faces.iter().map(|face| {
            let numbers = |all: [u32; 3]| all.map(|i| i as usize);
            match face.normals {
                None if mesh.inside_vector.is_some() => Triangle::Not,
                None => Triangle::Opposite,
                Some(normals) => smooth(
                    corners(numbers(face.vertices).map(|i| mesh.vertices[i])),
                    numbers(normals).map(|i| mesh.normals[i].to_array()),
                ),
            }
        })),
        _ => kinds.push(Triangle::Not),
    }
}

/// Whether the kernel turns the interpolated normal of a mesh's face.
fn smooth([a, b, c]: [[f64; 3]; 3], normals: [[f64; 3]; 3]) -> Triangle {
    let side = |to: [f64; 3]| std::array::from_fn(|i| to[i] - a[i]);
    let across = cross(side(b), side(c));
    let sum: f64 = normals.iter().map(|n| dot(*n, across)).sum();
    if sum < 0.0 { Triangle::SmoothTurned } else { Triangle::Smooth }
}

/// A box, which may be empty or unbounded.
#[derive(Clone, Copy, Debug)]
struct Extent {
    min: [f64; 3],
    max: [f64; 3],
}

impl Extent {
    const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };
    const SPACE: Self = Self { min: [f64::NEG_INFINITY; 3], max: [f64::INFINITY; 3] };

    fn of(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let one = |p: [f64; 3]| Self { min: p, max: p };
        points.into_iter().fold(Self::EMPTY, |all, p| all.with(&one(p)))
    }

    /// The box of a surface in its own frame, if it follows directly from its numbers.
    fn of_leaf(leaf: &Leaf) -> Option<Self> {
        Some(match leaf {
            Leaf::Plane { .. } => Self::SPACE,
            &Leaf::Sphere { centre, radius } => Self::ball(centre, radius),
            &Leaf::Box { a, b } => Self::of_points([a, b]),
            &Leaf::Cylinder { base, cap, radius } => cone(base, radius, cap, radius),
            &Leaf::Cone { base, base_radius, cap, cap_radius } => cone(base, base_radius, cap, cap_radius),
            &Leaf::Disc { centre, normal, radius, .. } => disc(centre, normal, radius),
            &Leaf::Parallelogram { corner, u, v } => {
                Self::of_points([corner, corner + u, corner + v, corner + u + v])
            }
            Leaf::Triangle(corners) => Self::of_points(*corners),
            Leaf::SmoothTriangle(both) => Self::of_points(both.0),
            Leaf::Polygon { loops, .. } => Self::of_points(loops.iter().flatten().copied()),
            Leaf::Mesh(mesh) => Self::of_points(mesh.vertices.iter().copied()),
            Leaf::Torus { major, minor } => {
                let around = major.abs() + minor.abs();
                Self::around([0.0; 3], [around, minor.abs(), around])
            }
            Leaf::Superellipsoid { .. } => Self::around([0.0; 3], [1.0; 3]),
            Leaf::Isosurface(iso) => Self::of_container(iso.container),
            Leaf::Parametric(it) => it.container.map_or(Self::EMPTY, Self::of_container),
            _ => return None,
        })
    }

    fn of_points(points: impl IntoIterator<Item = Point3>) -> Self {
        Self::of(points.into_iter().map(Point3::to_array))
    }

    fn of_container(container: scene::Container) -> Self {
        match container {
            scene::Container::Box(a, b) => Self::of_points([a, b]),
            scene::Container::Ball(centre, radius) => Self::ball(centre, radius),
        }
    }

    fn ball(centre: Point3, radius: f64) -> Self {
        Self::around(centre.to_array(), [radius; 3])
    }

    fn around(middle: [f64; 3], half: [f64; 3]) -> Self {
        Self {
            min: std::array::from_fn(|i| middle[i] - half[i]),
            max: std::array::from_fn(|i| middle[i] + half[i]),
        }
    }

    fn ends(self) -> ([f64; 3], [f64; 3]) {
        (self.min, self.max)
    }

    fn with(self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    fn within(self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].max(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].min(other.max[i])),
        }
    }

    /// The box of the complement of a half-space.
    fn other_half(self) -> Self {
        let turned = |from: [f64; 3], none: f64| from.map(|v| if v.is_finite() { v } else { none });
        Self { min: turned(self.max, f64::NEG_INFINITY), max: turned(self.min, f64::INFINITY) }
    }

    fn is_empty(&self) -> bool {
        (0..3).any(|i| self.min[i] > self.max[i])
    }

    fn volume(&self) -> f64 {
        let width = |i: usize| (self.max[i] - self.min[i]).clamp(0.0, 2.0 * UNBOUNDED);
        width(0) * width(1) * width(2)
    }

    /// The box of the transformed corners.
    fn placed(self, place: &Matrix) -> Self {
        if place.is_identity() || self.is_empty() {
            return self;
        }
        if !(self.min.iter().chain(&self.max).all(|v| v.is_finite())) {
            return Self::SPACE;
        }
        let corner = |which: usize| {
            std::array::from_fn(|i| if which >> i & 1 == 0 { self.min[i] } else { self.max[i] })
        };
        Self::of((0..8).map(|which| place.point(corner(which))))
    }
}

/// The extent by which a plane across an axis, or a quadric along one, bounds an intersection, in
/// addition to its box.
fn half_space(part: &Object) -> Option<Extent> {
    if !part.place.is_identity() || !part.clips.is_empty() {
        return None;
    }
    if let Shape::Leaf(Leaf::Quadric(coefficients)) = &part.shape {
        return (!part.habits.inverse).then(|| cylinder(coefficients)).flatten();
    }
    let Shape::Leaf(Leaf::Plane { normal, distance }) = part.shape else { return None };
    let axis = (0..3).find(|&i| normal[i] != 0.0)?;
    if (0..3).any(|i| i != axis && normal[i] != 0.0) {
        return None;
    }
    let mut half = Extent::SPACE;
    if normal[axis] > 0.0 {
        half.max[axis] = distance;
    } else {
        half.min[axis] = -distance;
    }
    Some(if part.habits.inverse { half.other_half() } else { half })
}

/// The extent of `a x^2 + b y^2 + c z^2 <= r` with no negative coefficient.
fn cylinder(&[a, b, c, xy, xz, yz, x, y, z, constant]: &[f64; 10]) -> Option<Extent> {
    let squares = [a, b, c];
    let others = [xy, xz, yz, x, y, z];
    if others.iter().any(|v| *v != 0.0) || squares.iter().any(|v| *v < 0.0) || constant >= 0.0 {
        return None;
    }
    let half = squares.map(|a| (-constant / a).sqrt());
    Some(Extent::around([0.0; 3], half))
}

fn length_of(v: [f64; 3]) -> f64 {
    crate::transform::length(v)
}

/// Whether it scales all lengths equally, within rounding.
fn is_similarity(place: &Matrix) -> bool {
    let [x, y, z, _] = place.rows;
    let size = dot(x, x);
    // Rounding of three products and two sums on each side.
    let equal = |a: f64, b: f64| (a - b).abs() <= 8.0 * f64::EPSILON * size;
    equal(dot(y, y), size)
        && equal(dot(z, z), size)
        && [dot(x, y), dot(y, z), dot(z, x)].iter().all(|d| equal(*d, 0.0))
}

/// The box of a flat disc: along each axis the radius times the sine of its angle to the normal.
fn disc(centre: Point3, normal: Vec3, radius: f64) -> Extent {
    let (centre, normal) = (centre.to_array(), normal.to_array());
    let all = dot(normal, normal);
    let half = std::array::from_fn(|i| {
        let across: f64 = (0..3).filter(|&j| j != i).map(|j| normal[j] * normal[j]).sum();
        radius * (across / all).sqrt()
    });
    if all > 0.0 { Extent::around(centre, half) } else { Extent::around(centre, [radius; 3]) }
}

/// The box of a cone: that of the discs at its ends.
fn cone(base: Point3, base_radius: f64, cap: Point3, cap_radius: f64) -> Extent {
    let axis = cap - base;
    disc(base, axis, base_radius).with(&disc(cap, axis, cap_radius))
}

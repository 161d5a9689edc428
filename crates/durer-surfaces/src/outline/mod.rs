//! Outlines: surfaces as lanes see them.
//!
//! Eight rays at a time can be told from most surfaces by the same short formula, because most surfaces are made of one thing: *faces*
//! `f_i(x) = 0` of degree at most two, cut off where another `f_j` is positive. An [`Outline`] holds those polynomials in the world's frame, rounded
//! to f64 with a bound on what that lost. Its answers come in three kinds: a ray *surely misses*, it *surely meets* a certain face first, or there is
//! a *doubt*, and then the surface itself is asked. So lanes only ever save work: no decision is taken by them that the exact kernels would
//! take otherwise.
//!
//! ```text
//!   sketch     polynomials in double-double, moved by maps      (built once, `sketch.rs`)
//!   outline    the same in f64, with their errors               (`face.rs`)
//!   roots      where eight rays cross a face                    (`roots.rs`)
//!   lathe      surfaces of revolution of higher degree, in coordinates of their own    (`lathe/`, `poly.rs`, `own.rs`, `detail.rs`)
//!   algebraic  zero sets of polynomials, the same way                                   (`algebraic/`)
//!   fields     blobs, the same way                            (`fields/`)
//!   level      solids of no polynomial, a stretch at a time   (`level/`)
//!   swept      walls and caps of curved prisms, the same way        (`swept/`, `whole.rs`)
//!   meet       which face they meet first                       (`meet.rs`, `hull.rs`)
//!   operand    all crossings with solids, for bodies made of several   (`operand.rs`)
//!   point      where, and how far rays start from there         (`point.rs`)
//! ```

mod algebraic;
mod detail;
mod face;
mod fields;
mod hull;
mod lathe;
mod level;
mod loops;
mod meet;
mod offer;
mod operand;
mod own;
mod point;
mod poly;
mod rays;
mod roots;
mod sketch;
mod swept;
mod whole;

pub use self::meet::{Question, Scratch};
pub use self::operand::{Crossing8, Crossings, Sight};
pub use self::point::Points8;
pub use self::rays::{From8, Nearest, RayLanes};
pub use self::sketch::Sketch;

pub(crate) use self::algebraic::Terms;
use self::detail::Detail;
pub(crate) use self::detail::Kind8;
use self::face::Face;
pub(crate) use self::fields::{Field, Fields};
pub(crate) use self::lathe::{Lathe, LatheWall, Skin, Slant};
pub(crate) use self::level::{Ends, Level, Line8, Part, Told8, Value8};
use self::loops::Loops;
pub(crate) use self::own::largest;
pub(crate) use self::swept::{Curve, Sweep8, Swept};
use durer_math::{Point3, Vec3};

/// A surface as lanes see it. Made by [`Sketch::outline`].
#[derive(Clone, Debug)]
pub struct Outline {
    /// Coordinates are counted from here.
    centre: Point3,
    faces: Box<[Face]>,
    /// How many of them are part of the surface; the others cut it off.
    walls: usize,
    /// A ball of this radius about the centre holds the surface; infinite if there is none.
    reach: f64,
    /// The surface bounds the convex set where all faces are negative.
    convex: bool,
    /// Which faces are planes that, with the next one, bound a slab.
    slabs: Box<[bool]>,
    /// For each wall the faces that may cut off some of it, `None` if it is cut off as a whole; empty if all faces may cut all others.
    cutters: Box<[Option<Box<[u32]>>]>,
    /// Normals point to where the faces are negative.
    turned: bool,
    /// The outline only holds the surface: what meets it may still miss.
    vague: bool,
    /// See [`Outline::own_face`].
    own_face: Option<u32>,
    /// Shading normals: a value and its change along x, y and z.
    normals: Option<Box<[Vec3; 4]>>,
    /// What cuts off the first wall beside the other faces.
    loops: Option<Box<Loops<Face>>>,
    /// What lies where all of some faces are negative is cut away.
    holes: Box<[Box<[Face]>]>,
    /// What is known of a surface whose faces only hold it.
    detail: Option<Box<Detail>>,
}

impl Outline {
    /// The face of a surface's roots on the face that lanes call by a number.
    #[inline(always)]
    pub fn face_of(&self, face: u32) -> u32 {
        match &self.detail {
            Some(detail) => detail.face_of(face),
            None => self.own_face.unwrap_or(face),
        }
    }

    /// The number of the first of the faces: a container's come after that of what it holds.
    #[inline(always)]
    fn first_face(&self) -> usize {
        usize::from(self.detail.as_ref().is_some_and(|detail| detail.is_contained()))
    }

    /// If this is one part of a surface: the face that its roots have there.
    #[inline(always)]
    pub fn own_face(&self) -> Option<u32> {
        self.own_face
    }
}

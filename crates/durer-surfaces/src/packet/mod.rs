//! Packet filters: eight rays at a time against one surface.
//!
//! Most surfaces are made of *faces* `f_i(x) = 0` of degree at most two, each cut off where another
//! `f_j` is positive, so one short formula serves them all. A [`PacketFilter`] holds those
//! polynomials in the world's frame, rounded to f64 with a bound on the rounding. For each ray it
//! gives one of three answers: a certain miss, a certain first face, or *doubt*. In doubt the ray
//! is tested against the surface itself. So a filter saves work and never contradicts the exact
//! kernels.
//!
//! ```text
//!   source.rs           polynomials in double-double, moved by maps (built once)
//!   quadric.rs          the polynomials in f64, with bounds on their errors
//!   quadratic_roots.rs  where eight rays cross a face of degree two
//!   kernel.rs           the trait of kernels for surfaces that are not faces of degree two:
//!     implicit/           solids known segment by segment (formulas, Julia sets, superellipsoids)
//!     (beside their surfaces: ../revolution/packet, ../prism/packet, ../blob/packet,
//!      ../algebraic/packet)
//!     local_frame.rs      rays in the surface's own coordinates
//!     polynomial_roots.rs roots of one polynomial for each of eight rays
//!     skin.rs             values, gradients and their errors at points of a surface
//!   closest.rs          which face each ray meets first (convex.rs for convex solids)
//!   crossings.rs        all crossings with a solid, for CSG
//!   resolve.rs          hit points, and how far spawned rays start from them
//! ```

pub(crate) mod closest;
pub(crate) mod convex;
pub(crate) mod crossings;
mod implicit;
pub(crate) mod kernel;
pub(crate) mod local_frame;
mod loops;
pub(crate) mod polynomial_roots;
pub(crate) mod quadratic_roots;
pub(crate) mod quadric;
pub(crate) mod rays;
mod resolve;
pub(crate) mod sink;
pub(crate) mod skin;
mod source;

pub use self::closest::{PacketQuery, Scratch};
pub use self::crossings::{Crossing8, Crossings, SolidState8};
pub use self::rays::{From8, Nearest, RayLanes};
pub use self::resolve::Points8;
pub use self::source::FilterSource;

pub(crate) use self::implicit::{Ends, ImplicitKernel, Line8, LineExtent8, Segment8, Segments, Value8};
use self::kernel::Detail;
pub(crate) use self::local_frame::largest;
use self::loops::Loops;
use self::quadric::QuadricFace8;
pub(crate) use self::skin::{Skin, Slant};
use durer_math::{Point3, Vec3};

/// The packet filter of one surface, for eight rays at a time. [`FilterSource::build`] makes it.
#[derive(Clone, Debug)]
pub struct PacketFilter {
    /// The origin of the filter's coordinates.
    centre: Point3,
    faces: Box<[QuadricFace8]>,
    /// How many of the faces are part of the surface; the others clip it.
    walls: usize,
    /// The radius of a ball about the centre that holds the surface; infinite if there is none.
    reach: f64,
    /// The surface bounds the convex set where all faces are negative.
    convex: bool,
    /// For each face, whether it is a plane that bounds a slab together with the next face.
    slabs: Box<[bool]>,
    /// For each wall the faces that may cut off a part of it, `None` if the wall is cut off
    /// entirely. Empty if every face may cut every other.
    cutters: Box<[Option<Box<[u32]>>]>,
    /// Normals point to where the faces are negative.
    turned: bool,
    /// The filter describes only a bound: a ray that hits it may miss the surface.
    vague: bool,
    /// See [`PacketFilter::own_face`].
    own_face: Option<u32>,
    /// Shading normals: a value and its change along x, y and z.
    normals: Option<Box<[Vec3; 4]>>,
    /// Outlines that clip the first wall in addition to the other faces.
    loops: Option<Box<Loops<QuadricFace8>>>,
    /// Holes: points where all faces of one entry are negative are cut away.
    holes: Box<[Box<[QuadricFace8]>]>,
    /// The kernel of a surface whose faces only bound it.
    detail: Option<Box<Detail>>,
}

impl PacketFilter {
    /// The `Root::face` of the face with this number.
    #[inline(always)]
    pub fn face_of(&self, face: u32) -> u32 {
        match &self.detail {
            Some(detail) => detail.kernel.face_of(face),
            None => self.own_face.unwrap_or(face),
        }
    }

    /// The number of the first face: a container's faces are numbered after those of its content.
    #[inline(always)]
    fn first_face(&self) -> usize {
        usize::from(self.detail.as_ref().is_some_and(|detail| detail.is_contained()))
    }

    /// If this is one part of a surface: the `Root::face` of its roots.
    #[inline(always)]
    pub fn own_face(&self) -> Option<u32> {
        self.own_face
    }
}
